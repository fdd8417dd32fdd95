"""A nonlinear loop couples the phases of its lines, which the bicoherence of PV shows (M. A. A. S. Choudhury, S. L. Shah,
N. F. Thornhill, Diagnosis of poor control-loop performance using higher-order statistics, Automatica 40 (2004) 1719).
Between linear loops, of which a nonlinearity is left to the valve alone, it tells those that stick."""

from __future__ import annotations

import numpy as np

from trials.peers.stiction.oscillation import centred

GAUSSIAN = 0.001
"""A nongaussianity index up to here: the signal is Gaussian, and nothing is asked of it."""
SURE = 0.01
"""A nonlinearity index from here on: the loop is nonlinear."""
LONGEST = 128
"""Samples of a segment; half of that where a record has too few segments."""
FEWEST = 20
CONFIDENCE = 5.991
"""The 95 % point of chi-square with two degrees of freedom."""
REGULAR = 75.0
"""Percentile of the denominator that is added to it, so that empty bins do not count as coherent (Choudhury, Shah, Thornhill,
Diagnosis of Process Nonlinearities and Valve Stiction, Springer 2008)."""


def squared(x: np.ndarray) -> tuple[np.ndarray, int]:
    """Squared bicoherence in the principal domain, and the number of segments: halves overlap, by a Hann window."""
    length = LONGEST
    while length > 32 and 2 * len(x) // length - 1 < FEWEST:
        length //= 2
    starts = range(0, len(x) - length + 1, length // 2)
    spectra = np.array([np.fft.fft((x[s : s + length] - np.mean(x[s : s + length])) * np.hanning(length)) for s in starts])
    first, second = np.meshgrid(np.arange(1, length // 2), np.arange(1, length // 2), indexing="ij")
    inside = (second <= first) & (first + second < length // 2)
    f1, f2 = first[inside], second[inside]
    product, sums = spectra[:, f1] * spectra[:, f2], spectra[:, f1 + f2]
    below = np.mean(np.abs(product) ** 2, axis=0) * np.mean(np.abs(sums) ** 2, axis=0)
    above = np.abs(np.mean(product * np.conj(sums), axis=0)) ** 2
    return above / np.maximum(below + np.percentile(below, REGULAR), 1e-300), len(spectra)


def indices(pv: np.ndarray) -> tuple[float, float]:
    """Nongaussianity: the mean of the significant squared bicoherence over what chance gives. Nonlinearity: how far its
    largest value stands out of the mean by more than two deviations."""
    x = centred(pv)
    if not np.any(x):
        return 0.0, 0.0
    values, segments = squared(x)
    critical = CONFIDENCE / (2.0 * segments)
    significant = values[values > critical]
    if len(significant) == 0:
        return 0.0, 0.0
    nongaussian = float(np.mean(significant)) - critical
    return nongaussian, max(float(np.max(values) - (np.mean(values) + 2.0 * np.std(values))), 0.0)


def score(op: np.ndarray, pv: np.ndarray, integrating: bool = False) -> float:
    """The nonlinearity index of a signal that is not Gaussian."""
    nongaussian, nonlinear = indices(pv)
    return float(np.clip(nonlinear, 0.0, 1.0)) if nongaussian > GAUSSIAN else 0.0
