"""Friction laws of a servo axis. Each is called once in a sub-step with the speed and the drive, and answers with the
friction that opposes them; `breakaway` is what a standing axis must overcome, 0 for laws that are smooth at rest."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass


@dataclass
class Law:
    """A friction law with its state inside the function."""

    force: Callable[[float], float]
    """Friction at a speed, opposing it."""
    breakaway: float = 0.0


def coulomb(level: float) -> Law:
    """Dry friction: sign(v) F_c; a standing axis stays until the drive exceeds F_c."""
    return Law(lambda v: math.copysign(level, v), level)


def stribeck(level: float, static: float, speed: float) -> Law:
    """Dry friction that falls from F_s to F_c as the film builds up: F_c + (F_s - F_c) exp(-(v/v_s)^2)."""
    more = static - level
    return Law(lambda v: math.copysign(level + more * math.exp(-((v / speed) ** 2)), v), static)


def hyperbolic_stribeck(level: float, static: float, speed: float) -> Law:
    """The same by Hess and Soom's rational curve."""
    more = static - level
    return Law(lambda v: math.copysign(level + more / (1.0 + (v / speed) ** 2), v), static)


def viscous(factor: float, power: float = 1.0) -> Law:
    """B |v|^n sign(v)."""
    return Law(lambda v: math.copysign(factor * abs(v) ** power, v))


def tanh_friction(level: float, speed: float) -> Law:
    """Coulomb friction smoothed near rest."""
    return Law(lambda v: level * math.tanh(v / speed))


def dahl(level: float, stiffness: float, dt: float) -> Law:
    """P. R. Dahl (1968): dF/dx = s (1 - F/F_c sign(v)), solved exactly for a constant speed in the sub-step."""
    state = 0.0

    def force(v: float) -> float:
        nonlocal state
        if v != 0.0:
            end = math.copysign(level, v)
            state = end + (state - end) * math.exp(-stiffness * abs(v) * dt / level)
        return state

    return Law(force)


def lugre(level: float, static: float, speed: float, stiffness: float, damping: float, dt: float) -> Law:
    """LuGre (C. Canudas de Wit et al., IEEE TAC 40 (1995) 419): z' = v - s|v|/g(v) z, F = s z + d z'."""
    z = 0.0

    def force(v: float) -> float:
        nonlocal z
        g = level + (static - level) * math.exp(-((v / speed) ** 2))
        before = z
        if v != 0.0:
            end = math.copysign(g / stiffness, v)
            z = end + (z - end) * math.exp(-stiffness * abs(v) * dt / g)
        return stiffness * z + damping * (z - before) / dt

    return Law(force)


def maxwell_slip(level: float, stiffness: float, dt: float) -> Law:
    """Four springs in parallel that slip one after the other (W. D. Iwan, 1966)."""
    limits = [level * share for share in (0.1, 0.2, 0.3, 0.4)]
    springs = [stiffness * share for share in (0.4, 0.3, 0.2, 0.1)]
    states = [0.0] * 4

    def force(v: float) -> float:
        step = v * dt
        for i in range(4):
            f = states[i] + springs[i] * step
            states[i] = limits[i] if f > limits[i] else (-limits[i] if f < -limits[i] else f)
        return states[0] + states[1] + states[2] + states[3]

    return Law(force)
