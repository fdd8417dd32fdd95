"""The cross-correlation of OP and PV is odd about lag 0 where a valve sticks, and even where the cause is another one
(A. Horch, A simple method for detection of stiction in control valves, Control Engineering Practice 7 (1999) 1221). It holds
for processes that do not integrate, under a controller with integral action."""

from __future__ import annotations

import numpy as np
from scipy import signal

from trials.peers.stiction.oscillation import centred

SURE = 2.0 / 3.0
"""From here on stiction; below a third none; between, no decision."""


def _crossing(r: np.ndarray) -> float:
    """Lags until the first change of sign, between samples by a straight line."""
    changed = np.flatnonzero(np.signbit(r[1:]) != np.signbit(r[:-1]))
    if len(changed) == 0:
        return float(len(r) - 1)
    k = int(changed[0])
    return k + float(r[k] / (r[k] - r[k + 1])) if r[k] != r[k + 1] else float(k)


def score(op: np.ndarray, pv: np.ndarray, integrating: bool = False) -> float:
    """The mean of the paper's two figures, 1 for an odd function and 0 for an even one:

        Δτ = |τ_l − τ_r| / (τ_l + τ_r),  Δρ = |r_0 − r_opt| / |r_0 + r_opt|,

    τ_l and τ_r the changes of sign on both sides of lag 0, r_0 the value there, r_opt the largest of its sign between them.
    """
    u, y = centred(op), centred(pv)
    if not (np.any(u) and np.any(y)):
        return 0.0
    r = signal.correlate(y, u, method="fft") / len(u)
    middle, reach = len(u) - 1, len(u) // 2
    right, left = r[middle : middle + reach], r[middle - reach + 1 : middle + 1][::-1]
    to_right, to_left = _crossing(right), _crossing(left)
    between = np.concatenate((left[: int(to_left) + 1], right[: int(to_right) + 1]))
    r0 = float(right[0])
    best = float(np.max(between * np.sign(r0))) * np.sign(r0) if r0 else 1.0
    by_lag = abs(to_left - to_right) / max(to_left + to_right, 1e-12)
    by_height = abs(r0 - best) / max(abs(r0 + best), 1e-12)
    return 0.5 * (by_lag + by_height)
