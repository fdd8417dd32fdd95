"""Effects on the way from the logged command to the machine, injected backwards: the machine has done what the record says,
so the command that would have led there through the effect is what is logged. No model takes part in it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trials.generator.effects import Context

Inverse = Callable[[np.ndarray, Context, float, np.random.Generator], np.ndarray]


def load(x, c, size, rng):
    """A constant that is added between two times."""
    s = np.linspace(0.0, 1.0, len(x))
    on, off = rng.uniform(0.15, 0.4), rng.uniform(0.55, 0.85)
    return x - rng.choice((-1.0, 1.0)) * size * c.span * ((s >= on) & (s < off))


def gain_drift(x, c, size, rng):
    """A gain that changes linearly with clock time."""
    return x / (1.0 + rng.choice((-1.0, 1.0)) * size * np.linspace(0.0, 1.0, len(x)))


def cross_coupling(x, c, size, rng):
    """A share of another column."""
    return x - rng.choice((-1.0, 1.0)) * size * c.span * c.other


def delay(x, c, size, rng):
    """The command comes late by whole samples, so it was logged early; at the end it stands."""
    early = max(round(size), 1)
    return np.concatenate((x[early:], np.full(early, x[-1])))


def backlash(x, c, size, rng):
    """A gap: the command runs ahead by half of it, in the direction of the motion."""
    moved = np.sign(np.diff(x, prepend=x[0]))
    last = np.maximum.accumulate(np.where(moved != 0.0, np.arange(len(x)), 0))
    return x + 0.5 * size * c.span * moved[last]


def dead_zone(x, c, size, rng):
    """Nothing near zero: the command jumps over the zone."""
    return x + size * c.span * np.sign(x)


def _inverse(x: np.ndarray, machine: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """The w with machine(w) = x, by interpolation; the machine's curve rises, as sizes are small."""
    w = 1.5 * np.max(np.abs(x)) * np.linspace(-1.0, 1.0, 20001)
    return np.interp(x, machine(w), w)


def even_nonlinearity(x, c, size, rng):
    """A parabola about zero."""
    largest, bend = c.keep("largest", np.max(np.abs(x))), rng.choice((-1.0, 1.0)) * size * c.span
    return _inverse(x, lambda w: w + bend * (w / largest) ** 2)


def odd_nonlinearity(x, c, size, rng):
    """A cube."""
    largest, bend = c.keep("largest", np.max(np.abs(x))), rng.choice((-1.0, 1.0)) * size * c.span
    return _inverse(x, lambda w: w + bend * (w / largest) ** 3)


CATALOGUE: dict[str, tuple[Inverse, float, float]] = {
    "load": (load, 0.05, 2.0),
    "gain_drift": (gain_drift, 0.05, 0.5),
    "cross_coupling": (cross_coupling, 0.05, 2.0),
    "delay": (delay, 2.0, 200.0),
    "backlash": (backlash, 0.05, 0.5),
    "dead_zone": (dead_zone, 0.02, 0.3),
    "even_nonlinearity": (even_nonlinearity, 0.02, 0.15),
    "odd_nonlinearity": (odd_nonlinearity, 0.02, 0.15),
}
"""Effects, each with the size at which its search begins and the largest one."""
