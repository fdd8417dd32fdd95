"""Sparse regression of the residual on a polynomial library with lags: sequentially thresholded least squares
(S. L. Brunton, J. L. Proctor, J. N. Kutz, PNAS 113 (2016) 3932), its threshold chosen by the Bayesian criterion."""

from __future__ import annotations

import numpy as np

from trials.peers.common import Answer, Record

LAGS = (1, 3, 10, 30, 100, 300)
TRIES = 12


def library(record: Record) -> tuple[list[str], np.ndarray]:
    """Candidate terms, each of unit RMS."""
    t = (record.t - record.t[0]) / (record.t[-1] - record.t[0])
    names, columns = ["1", "t", "t^2"], [np.ones_like(t), t, t**2]
    signals = {"y": record.model, **record.inputs}
    for name, raw in signals.items():
        x = (raw - raw.mean()) / max(np.ptp(raw), 1e-300)
        rate = np.gradient(x)
        names += [name, f"{name}^2", f"{name}^3", f"t*{name}", f"sign d{name}", f"{name}*sign d{name}", f"|{name}|"]
        columns += [x, x**2, x**3, t * x, np.sign(rate), x * np.sign(rate), np.abs(x)]
        for lag in LAGS:
            names.append(f"{name}(-{lag})")
            columns.append(x - np.concatenate((np.full(lag, x[0]), x[:-lag])))
    matrix = np.column_stack(columns)
    scale = np.sqrt(np.mean(matrix**2, axis=0))
    kept = scale > 1e-12
    return [n for n, k in zip(names, kept) if k], matrix[:, kept] / scale[kept]


def thresholded(a: np.ndarray, b: np.ndarray, threshold: float) -> np.ndarray:
    """Least squares, small coefficients dropped, until none is small."""
    active = np.ones(a.shape[1], bool)
    solution = np.zeros(a.shape[1])
    while active.any():
        solution[:] = 0.0
        solution[active] = np.linalg.lstsq(a[:, active], b, rcond=1e-10)[0]
        small = active & (np.abs(solution) < threshold)
        if not small.any():
            break
        active &= ~small
    return solution * active


def rule_of_thumb(term: str, record: Record) -> tuple[str, str]:
    """What an engineer would call the strongest term."""
    last, first = record.output, next(iter(record.inputs), record.output)
    others = [name for name in record.inputs if name not in (first, "TA")]
    if any(term == other or term.startswith(f"{other}(") for other in others):
        return "cross_coupling", last
    if term.startswith("t*"):
        return "gain_drift", last
    if "sign d" in term:
        return "backlash", first
    if "(-" in term:
        return "lag", last
    named = {"1": "offset", "t": "drift", "t^2": "thermal_drift"}.get(term)
    if named:
        return named, last
    if term.endswith("^3"):
        return "odd_nonlinearity", last
    if term.endswith("^2") or term.startswith("|"):
        return "even_nonlinearity", last
    return "", last  # the signal itself: a gain


def solve(record: Record) -> Answer:
    """The fit of the best threshold."""
    names, a = library(record)
    train = ~record.held_out
    b = record.residual[train]
    scale = float(np.sqrt(np.mean(b**2)))
    best, least = np.zeros(a.shape[1]), np.inf
    for threshold in scale * np.geomspace(1e-3, 1.0, TRIES):
        solution = thresholded(a[train], b, threshold)
        left = float(np.mean((b - a[train] @ solution) ** 2))
        criterion = len(b) * np.log(max(left, 1e-300)) + np.count_nonzero(solution) * np.log(len(b))
        if criterion < least:
            best, least = solution, criterion
    strongest = int(np.argmax(np.abs(best))) if best.any() else -1
    name, edge = rule_of_thumb(names[strongest], record) if strongest >= 0 else ("", record.output)
    return Answer(a @ best, name, edge, int(np.count_nonzero(best)))
