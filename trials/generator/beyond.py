"""What every real machine has beside its effects, and no library: a discrepancy of the model that stays small and smooth."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from trials.generator import operators as op
from trials.generator.effects import Context, Realisation


def static_bend(x, c: Context, size, rng):
    """A smooth curve that is no polynomial: a knee of a softplus, or a piece of a sine."""
    top, bottom = c.keep("top", np.max(x)), c.keep("bottom", np.min(x))
    z = (x - 0.5 * (top + bottom)) / (0.5 * (top - bottom))
    if rng.random() < 0.5:
        sharp, at = rng.uniform(3.0, 6.0), rng.uniform(-0.4, 0.4)
        bend = np.logaddexp(0.0, sharp * (z - at)) / sharp
    else:
        bend = 0.5 * np.sin(np.pi * rng.uniform(1.2, 2.2) * z + rng.uniform(0.0, 2.0 * np.pi))
    return x + rng.choice((-1.0, 1.0)) * size * c.span * bend


def second_mode(x, c: Context, size, rng):
    """A weak mode in parallel: a pole and a zero close to each other."""
    f = 1.0 / (c.dt * c.substeps * rng.uniform(12.0, 50.0))
    return x + size * 10.0 * (op.resonance(x, c.dt, f, rng.uniform(0.03, 0.12)) - x)


def wandering_gain(x, c: Context, size, rng):
    """A gain that wanders slowly, smooth and without a trend: temperature, supply, lubrication."""
    knots = int(rng.integers(7, 14))
    levels = rng.standard_normal(knots)
    levels -= np.polyval(np.polyfit(np.arange(knots), levels, 1), np.arange(knots))
    course = CubicSpline(np.linspace(0.0, 1.0, knots), levels / np.std(levels))
    return x * (1.0 + size * course(np.linspace(0.0, 1.0, len(x))))


CATALOGUE: dict[str, tuple[Realisation, ...]] = {
    "beyond:" + function.__name__: (Realisation(function.__name__, function, start, largest),)
    for function, start, largest in ((static_bend, 0.01, 0.3), (second_mode, 0.003, 0.05), (wandering_gain, 0.01, 0.2))
}
"""The size of each is relative to the span of the signal, or to its gain."""
IN_A_LOOP = "beyond:wandering_gain"
"""The one that the amplifier of the closed loop knows."""
