"""Operators on signals of the fine clock: linear filters by exact discretisation for straight lines between sub-steps
(G. F. Franklin, J. D. Powell, M. Workman, Digital Control of Dynamic Systems, 3rd ed., 6.3), convolutions with creep
kernels, and rate-independent maps evaluated from one turning point to the next."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy import signal


def linear(x: np.ndarray, dt: float, numerator: list[float], denominator: list[float]) -> np.ndarray:
    """Response of a transfer function in s that has stood at the first value of x for ever."""
    b, a, _ = signal.cont2discrete((numerator, denominator), dt, method="foh")
    at_rest = numerator[-1] / denominator[-1]
    return signal.lfilter(np.ravel(b), a, x - x[0]) + at_rest * x[0]


def lag(x: np.ndarray, dt: float, time_constant: float) -> np.ndarray:
    """T y' + y = x."""
    return linear(x, dt, [1.0], [time_constant, 1.0]) if time_constant > 0.0 else x


def resonance(x: np.ndarray, dt: float, frequency: float, damping: float) -> np.ndarray:
    """y'' + 2 zeta w y' + w^2 y = w^2 x."""
    w = 2.0 * np.pi * frequency
    return linear(x, dt, [w * w], [1.0, 2.0 * damping * w, w * w])


def delay(x: np.ndarray, dt: float, seconds: float | np.ndarray) -> np.ndarray:
    """x(t - seconds); before the record x stood at its first value. `seconds` may change with time."""
    if isinstance(seconds, float):
        late = round(seconds / dt)  # whole sub-steps, so that no corner of the signal is cut
        return x if late == 0 else np.concatenate((np.full(late, x[0]), x[:-late]))
    t = np.arange(len(x)) * dt
    return np.interp(t - seconds, t, x)


def after_effect(x: np.ndarray, dt: float, kernel: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Superposition (Boltzmann): the sum over all past increments dx of kernel(age) dx."""
    ages = (np.arange(len(x)) + 0.5) * dt
    increments = np.diff(x, prepend=x[0])
    return signal.fftconvolve(increments, kernel(ages))[: len(x)]


def rate_limit(x: np.ndarray, dt: float, rise: float, fall: float) -> np.ndarray:
    """A follower that moves no faster than `rise` upwards and `fall` downwards."""
    y = float(x[0])
    up, down = rise * dt, fall * dt
    out = []
    for wanted in x.tolist():
        step = wanted - y
        y += up if step > up else (-down if step < -down else step)
        out.append(y)
    return np.array(out)


def soft_rate_limit(x: np.ndarray, dt: float, rate: float, sharpness: float) -> np.ndarray:
    """A slewing amplifier stage: y' = R tanh(s (x - y)/R), whose limit sets in smoothly."""
    y = float(x[0])
    gain = sharpness / rate
    steps = rate * dt
    tanh = math.tanh
    out = []
    for wanted in x.tolist():
        y += steps * tanh(gain * (wanted - y))
        out.append(y)
    return np.array(out)


def turning_points(x: np.ndarray) -> np.ndarray:
    """Indices where the signal reverses, with the first and the last index. Plateaus are no reversals, nor is what
    rounding does to them."""
    grain = 1e-10 * float(np.ptp(x)) or 1.0
    direction = np.sign(np.diff(np.round(x / grain)))
    moving = np.flatnonzero(direction)
    if len(moving) == 0:
        return np.array([0, len(x) - 1])
    flips = moving[1:][direction[moving[1:]] != direction[moving[:-1]]]
    return np.unique(np.concatenate(([0], flips, [len(x) - 1])))


def play(x: np.ndarray, radius: float, turns: np.ndarray | None = None) -> np.ndarray:
    """Play operator of half-width `radius` (M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, 1996, 2.1)."""
    turns = turning_points(x) if turns is None else turns
    out = np.empty_like(x)
    held = float(x[0])
    for first, last in zip(turns[:-1], turns[1:]):
        piece = x[first : last + 1]
        follows = np.maximum(held, piece - radius) if x[last] >= x[first] else np.minimum(held, piece + radius)
        out[first : last + 1] = follows
        held = float(follows[-1])
    return out


def smooth_backlash(x: np.ndarray, radius: float, turns: np.ndarray | None = None) -> np.ndarray:
    """Gap that closes smoothly: y' = a|x'|(x - y) + x'/2, a Duhem model (B. D. Coleman, M. L. Hodgdon, Int. J. Eng.
    Sci. 24 (1986) 897) with a = 1/(2 radius): y comes to lie `radius` behind x, and stands still just after a turn."""
    turns = turning_points(x) if turns is None else turns
    behind = np.zeros_like(x)
    for first, last in zip(turns[:-1], turns[1:]):
        travel = x[first : last + 1] - x[first]
        full = radius * float(np.sign(travel[-1]))
        behind[first : last + 1] = full + (behind[first] - full) * np.exp(-0.5 * np.abs(travel) / radius)
    return x - behind
