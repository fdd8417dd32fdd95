"""What the detectors share: the trend taken off, the period of an oscillation and how regular it is, its half periods."""

from __future__ import annotations

import numpy as np
from scipy import signal

HARMONICS = 5.0
"""Up to so many times the frequency a signal keeps its shape; what is above counts as noise."""
FEWEST = 4
"""Half periods that make an oscillation."""


def centred(x: np.ndarray) -> np.ndarray:
    """Without its straight line, of unit spread. A signal that stands still stays zero."""
    x = signal.detrend(np.asarray(x, float))
    spread = float(np.std(x))
    return x / spread if spread > 1e-9 else np.zeros_like(x)


def period(x: np.ndarray) -> tuple[float, float]:
    """Samples of an oscillation, and its regularity: the mean of the intervals between changes of sign of the
    autocorrelation, twice, and that mean over three times their spread (N. F. Thornhill, B. Huang, H. Zhang, Detection of
    multiple oscillations in control loops, J. Process Control 13 (2003) 91). From 1 on it is regular; 0 where there is none."""
    x = centred(x)
    r = signal.correlate(x, x, method="fft")[len(x) - 1 :] / max(float(x @ x), 1e-300)
    turns = np.flatnonzero(np.signbit(r[1:]) != np.signbit(r[:-1]))[: 2 * FEWEST + 3]
    intervals = np.diff(turns)
    if len(intervals) < FEWEST:
        return 0.0, 0.0
    return 2.0 * float(np.mean(intervals)), float(np.mean(intervals)) / max(3.0 * float(np.std(intervals)), 1e-9)


def smooth(x: np.ndarray, samples: float) -> np.ndarray:
    """Without what is faster than the harmonics of an oscillation of this period, and slower than two of its periods."""
    x = centred(x)
    x = signal.sosfiltfilt(signal.butter(2, 0.5 / samples, "highpass", fs=1.0, output="sos"), x)
    high = HARMONICS / samples
    return signal.sosfiltfilt(signal.butter(2, high, fs=1.0, output="sos"), x) if high < 0.45 else x


def half_periods(x: np.ndarray, samples: float) -> list[np.ndarray]:
    """Pieces from one change of sign to the next, without those that are far shorter or longer than half a period."""
    turns = np.flatnonzero(np.signbit(x[1:]) != np.signbit(x[:-1])) + 1
    pieces = [x[first:last] for first, last in zip(turns[:-1], turns[1:])]
    return [one for one in pieces if max(0.2 * samples, 5) <= len(one) <= samples]
