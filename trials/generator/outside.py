"""Effects that are on nobody's list: what a diagnosis should call unknown."""

from __future__ import annotations

import numpy as np

from trials.generator import operators as op
from trials.generator.effects import Context, Realisation


def non_minimum_phase(x, c: Context, size, rng):
    """A right half-plane zero: the response starts in the wrong direction. (1 - a s)/(1 + b s)^2."""
    b = c.dt * c.substeps * size * 20.0
    a = b * rng.uniform(1.5, 3.0)
    return op.linear(x, c.dt, [-a, 1.0], [b * b, 2.0 * b, 1.0])


def time_varying_resonance(x, c: Context, size, rng):
    """A mode whose frequency rises by half during the record: two modes, faded over."""
    f = 1.0 / (c.dt * c.substeps * rng.uniform(15.0, 40.0))
    s = np.linspace(0.0, 1.0, len(x))
    modes = [op.resonance(x, c.dt, f * (1.0 + 0.5 * k / 4.0), 0.08) - x for k in range(5)]
    fade = [np.clip(1.0 - np.abs(4.0 * s - k), 0.0, 1.0) for k in range(5)]
    return x + 10.0 * size * sum(w * m for w, m in zip(fade, modes))


def intermittent_loss(x, c: Context, size, rng):
    """The signal is lost for random intervals and comes back late: it falls towards its mean meanwhile."""
    t = np.arange(len(x)) * c.dt
    length = t[-1]
    hole = np.zeros_like(x)
    for start in rng.uniform(0.03, 0.95, 9) * length:
        hole[(t >= start) & (t < start + rng.uniform(0.004, 0.015) * length)] = 1.0
    hole = op.lag(hole, c.dt, 0.002 * length)
    middle = c.keep("middle", 0.5 * (np.max(x) + np.min(x))) + 0.3 * c.span
    return x + size * 4.0 * hole * (middle - x)


def hidden_hysteresis(x, c: Context, size, rng):
    """Relay hysteresis of a single bistable element: a jump up at one level and down at another."""
    up = c.keep("up", np.quantile(x, rng.uniform(0.6, 0.75)))
    down = c.keep("down", np.quantile(x, rng.uniform(0.25, 0.4)))
    event = np.where(x > up, 1.0, np.where(x < down, -1.0, 0.0))
    index = np.maximum.accumulate(np.where(event != 0.0, np.arange(len(x)), 0))
    state = np.where(event[index] == 0.0, -1.0, event[index])
    return x + size * c.span * state


def spring_with_memory(x, c: Context, size, rng):
    """A cubic spring whose stiffness remembers the largest excursion so far (Mullins' effect)."""
    z = x / c.keep("largest", np.max(np.abs(x)))
    worst = np.maximum.accumulate(np.abs(z))
    return x + size * c.span * z**3 * (1.0 - 1.6 * worst)


def self_product(x, c: Context, size, rng):
    """A Volterra kernel of second order: the signal times its own past."""
    z = (x - c.keep("mean", np.mean(x))) / c.span
    past = op.lag(z, c.dt, c.dt * c.substeps * rng.uniform(20.0, 80.0))
    return x + 4.0 * size * c.span * z * (past - z)


def switching_gain(x, c: Context, size, rng):
    """A contact that changes the gain to and fro at random times."""
    t = np.linspace(0.0, 1.0, len(x))
    edges = np.sort(rng.uniform(0.03, 0.97, 10))
    state = np.searchsorted(edges, t) % 2
    return x * (1.0 + 2.0 * size * state)


def heats_faster_than_it_cools(x, c: Context, size, rng):
    """A lag with two time constants, one upwards and one downwards."""
    up = c.dt * c.substeps * 30.0 * size
    rates = (min(c.dt / up, 1.0), min(c.dt / (up * rng.uniform(4.0, 10.0)), 1.0))
    y, out = float(x[0]), []
    for wanted in x.tolist():
        d = wanted - y
        y += d * (rates[0] if d > 0.0 else rates[1])
        out.append(y)
    return np.array(out)


def parametric_pumping(x, c: Context, size, rng):
    """The gain oscillates: sidebands and no line at rest."""
    f = 1.0 / (c.dt * c.substeps * rng.uniform(25.0, 90.0))
    return x * (1.0 + 2.0 * size * np.sin(2.0 * np.pi * f * np.arange(len(x)) * c.dt + rng.uniform(0.0, 6.0)))


def noise_by_level(x, c: Context, size, rng):
    """Noise whose strength grows with the square of the signal: its mean is 0, its variance is not."""
    z = (x / c.keep("largest", np.max(np.abs(x)))) ** 2
    count = -(-len(x) // c.substeps)
    grain = np.convolve(rng.standard_normal(count + 8), np.ones(9) / 3.0, mode="valid")[:count]
    return x + size * c.span * z * np.append(np.repeat(grain[:-1], c.substeps), grain[-1])


def snap_through(x, c: Context, size, rng):
    """A bistable plate: v' = k (v - v^3 + x), added to the signal."""
    z = (x - c.keep("mean", np.mean(x))) / (0.5 * c.span)
    step = min(c.dt / (c.dt * c.substeps * rng.uniform(8.0, 20.0)), 0.2)
    v, out = -1.0, []
    for drive in z.tolist():
        v += step * (v - v * v * v + 0.9 * drive)
        out.append(v)
    return x + size * c.span * np.array(out)


def chaotic_forcing(x, c: Context, size, rng):
    """A Lorenz oscillator shakes the plant: broadband, bounded, no line."""
    h = 1.0 / (c.substeps * rng.uniform(25.0, 60.0))
    a, b, d = 1.0 + rng.random(), 1.0, 20.0
    out = []
    for _ in range(len(x)):
        da, db, dd = 10.0 * (b - a), a * (28.0 - d) - b, a * b - 8.0 / 3.0 * d
        a, b, d = a + h * da, b + h * db, d + h * dd
        out.append(a)
    return x + size * c.span * np.array(out) / 8.0


CATALOGUE: dict[str, tuple[Realisation, ...]] = {
    "outside:" + function.__name__: (Realisation(function.__name__, function, 0.02, largest),)
    for function, largest in (
        (non_minimum_phase, 2.0),
        (time_varying_resonance, 0.3),
        (intermittent_loss, 0.25),
        (hidden_hysteresis, 0.3),
        (spring_with_memory, 0.4),
        (self_product, 1.0),
        (switching_gain, 0.3),
        (heats_faster_than_it_cools, 1.0),
        (parametric_pumping, 0.3),
        (noise_by_level, 0.3),
        (snap_through, 0.3),
        (chaotic_forcing, 0.3),
    )
}
