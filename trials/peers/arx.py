"""A linear black box between the inputs and the residual: ARX by least squares (L. Ljung, System Identification, 2nd ed.,
4.2), its order by the Bayesian criterion of the simulated error, then simulated from the inputs alone."""

from __future__ import annotations

import numpy as np
from scipy import signal

from trials.peers.common import Answer, Record

ORDERS = (1, 2, 3, 5)


def shifted(x: np.ndarray, by: int) -> np.ndarray:
    """The signal `by` samples ago."""
    return x if by == 0 else np.concatenate((np.full(by, x[0]), x[:-by]))


def fit(record: Record, order: int) -> tuple[np.ndarray, int]:
    """Denominator by one-step prediction, then numerators by least squares in simulation. Returns the simulated residual."""
    train = ~record.held_out
    r = record.residual
    drives = [record.model, *record.inputs.values()]
    drives = [(x - x[0]) / max(np.ptp(x), 1e-300) for x in drives if np.ptp(x) > 0.0]
    columns = [-shifted(r, k) for k in range(1, order + 1)]
    columns += [shifted(x, k) for x in drives for k in range(order + 1)] + [np.ones_like(r)]
    a = np.column_stack(columns)
    solution = np.linalg.lstsq(a[train], r[train], rcond=1e-10)[0]
    denominator = np.concatenate(([1.0], solution[:order]))
    poles = np.roots(denominator)
    poles = np.where(np.abs(poles) > 0.999, poles / np.maximum(np.abs(poles), 1e-9) * 0.999, poles)
    denominator = np.real(np.poly(poles))
    filtered = [signal.lfilter([1.0], denominator, shifted(x, k)) for x in drives for k in range(order + 1)]
    b = np.column_stack([*filtered, np.ones_like(r)])
    scale = np.sqrt(np.mean(b**2, axis=0)) + 1e-300
    gains = np.linalg.lstsq(b[train] / scale, r[train], rcond=1e-9)[0]
    return (b / scale) @ gains, b.shape[1] + order


def solve(record: Record) -> Answer:
    """The order that the criterion prefers."""
    train = ~record.held_out
    best, least = Answer(np.zeros_like(record.t), "", record.output, 0), np.inf
    for order in ORDERS:
        simulated, count = fit(record, order)
        left = float(np.mean((record.residual - simulated)[train] ** 2))
        criterion = train.sum() * np.log(max(left, 1e-300)) + count * np.log(train.sum())
        if np.isfinite(criterion) and criterion < least:
            best, least = Answer(simulated, "", record.output, count), criterion
    # A linear dynamic discrepancy has one name of the list at most.
    before = float(np.mean(record.residual[train] ** 2))
    after = float(np.mean((record.residual - best.correction)[train] ** 2))
    best.name = "lag" if after < 0.5 * before else ""
    return best
