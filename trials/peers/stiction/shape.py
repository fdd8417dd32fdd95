"""A sticking valve moves in steps, which the first integration behind it makes a triangle of: that of the controller in OP, or
that of an integrating process in PV. Other oscillations are sines (Q. P. He, J. Wang, M. Pottmann, S. J. Qin, A curve fitting
method for detecting valve stiction in oscillating control loops, Ind. Eng. Chem. Res. 46 (2007) 4549; the shapes are those
of M. Rossi, C. Scali, J. Process Control 15 (2005) 505)."""

from __future__ import annotations

import numpy as np

from trials.peers.stiction.oscillation import half_periods, period, smooth

SURE = 0.6
"""From here on stiction; below 0.4 none; between, no decision."""
REGULAR = 1.0
"""An oscillation is at least so regular."""
PEAKS = np.linspace(0.1, 0.9, 33)
"""Where within the half period a triangle may have its corner."""


def _left(piece: np.ndarray, shape: np.ndarray) -> float:
    """Sum of squares beside the best multiple of a shape."""
    return float(piece @ piece - (piece @ shape) ** 2 / (shape @ shape))


def score(op: np.ndarray, pv: np.ndarray, integrating: bool = False) -> float:
    """The stiction index MSE_sine / (MSE_sine + MSE_triangle), over all half periods; 0.5 where nothing oscillates."""
    x = np.asarray(pv if integrating else op, float)
    if np.std(x) < 1e-9 * max(1.0, float(np.max(np.abs(x)))):
        return 0.0
    samples, regular = max((period(one) for one in (op, pv)), key=lambda found: found[1])
    if regular < REGULAR:
        return 0.5
    sine = triangle = 0.0
    for piece in half_periods(smooth(x, samples), samples):
        at = (np.arange(len(piece)) + 0.5) / len(piece)
        sine += _left(piece, np.sin(np.pi * at))
        triangle += min(_left(piece, np.minimum(at / peak, (1.0 - at) / (1.0 - peak))) for peak in PEAKS)
    return sine / (sine + triangle) if sine + triangle > 0.0 else 0.5
