"""The search for the size of an effect that gives the effect-to-noise ratio that is wanted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def find_size(ratio: Callable[[float], float], wanted: float, start: float, least: float, most: float) -> tuple[float, float]:
    """Secant steps in logarithms, kept between two sizes whose ratios lie below and above. Returns the size and its ratio."""
    lowest, highest = np.log(least), np.log(most)
    low = high = None  # sizes whose ratios lie below and above
    at, reached, before = np.log(start), 0.0, None
    size = start
    for _ in range(8):
        size = float(np.exp(at))
        reached = max(ratio(size), 1e-12)
        miss = float(np.log(wanted / reached))
        if abs(miss) < 0.4 or (at >= highest and miss > 0.0) or (at <= lowest and miss < 0.0):
            break
        low, high = ((at, miss), high) if miss > 0.0 else (low, (at, miss))
        if low and high:
            share = np.clip(low[1] / (low[1] - high[1]), 0.2, 0.8)
            step = low[0] + share * (high[0] - low[0]) - at
        else:
            slope = 1.0 if before is None else float(np.clip((before[1] - miss) / (at - before[0]), 0.4, 3.0))
            step = float(np.clip(miss / slope, -4.0, 4.0))
        before = (at, miss)
        at = float(np.clip(at + step, lowest, highest))
    return size, reached
