"""The effects of the diagnosis' list that act on one signal, each in a plain form and in cousins.

An operator takes the signal on the fine clock and a size: its strength relative to the span of the signal, so that a
search over one number reaches any effect-to-noise ratio. What else it draws comes from a generator that is seeded
alike at every call, so that the size alone changes between calls.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy import signal

from trials.generator import operators as op


@dataclass
class Context:
    """Where an operator works."""

    dt: float
    substeps: int
    span: float
    """Peak to peak of the undisturbed signal."""
    other: np.ndarray | None = None
    """A second column of the log, of span 1, on the fine clock."""
    notes: dict[str, float] = field(default_factory=dict)
    """True parameters, for the key."""
    kept: dict[str, float] = field(default_factory=dict)
    """Figures of the first record that an operator goes on using in a second one."""

    def note(self, **values: float) -> None:
        """Keeps parameters for the key."""
        self.notes.update({name: float(value) for name, value in values.items()})


    def keep(self, name: str, value: float) -> float:
        """The value that came first under this name."""
        return self.kept.setdefault(name, float(value))


Operator = Callable[[np.ndarray, Context, float, np.random.Generator], np.ndarray]


@dataclass(frozen=True)
class Realisation:
    """One formula of an effect."""

    name: str
    apply: Operator
    start: float
    """Size at which the search begins."""
    largest: float
    cousin: bool = False
    smallest: float = 1e-9


def _t(x: np.ndarray, c: Context) -> np.ndarray:
    return np.arange(len(x)) * c.dt


def _length(x: np.ndarray, c: Context) -> float:
    return (len(x) - 1) * c.dt


# Times: sizes of delay, lag and resonance are in sampling intervals.


def delay(x, c, size, rng):
    """x(t - T)."""
    late = round(size * c.substeps) * c.dt
    c.note(DEAD_TIME=late)
    return op.delay(x, c.dt, late)


def jittered_delay(x, c, size, rng):
    """A network's delay: a least one and a random, slowly redrawn part (gamma distributed)."""
    ts = c.substeps * c.dt
    redrawn = max(int(rng.integers(3, 20)), 1) * c.substeps
    parts = 0.7 + 0.3 * rng.gamma(2.0, 0.5, len(x) // redrawn + 2)
    late = np.interp(np.arange(len(x)), np.arange(len(parts)) * redrawn, parts) * size * ts
    c.note(DEAD_TIME=size * ts)
    return op.delay(x, c.dt, late)


def lag(x, c, size, rng):
    """T y' + y = x."""
    c.note(T1=size * c.substeps * c.dt)
    return op.lag(x, c.dt, size * c.substeps * c.dt)


def unequal_lags(x, c, size, rng):
    """A dominant lag and a quick second one behind it."""
    total = size * c.substeps * c.dt
    share = rng.uniform(0.05, 0.2)
    return op.lag(op.lag(x, c.dt, total * (1.0 - share)), c.dt, total * share)


def resonance(x, c, size, rng):
    """One mode; the size is 1/w in samples."""
    w = 1.0 / (size * c.substeps * c.dt)
    damping = rng.uniform(0.03, 0.15)
    c.note(T=1.0 / w, ZETA=damping)
    return op.resonance(x, c.dt, w / (2.0 * np.pi), damping)


def two_modes(x, c, size, rng):
    """Two modes in parallel, with modal shares."""
    f = 1.0 / (2.0 * np.pi * size * c.substeps * c.dt)
    share = rng.uniform(0.1, 0.25)
    first = op.resonance(x, c.dt, f, rng.uniform(0.03, 0.12))
    return (1.0 - share) * first + share * op.resonance(x, c.dt, f * rng.uniform(1.5, 2.5), rng.uniform(0.03, 0.12))


# Levels: sizes are relative to the span.


def _asked_rate(x, c):
    """The rate from sample to sample that only steps exceed."""
    return c.keep("rate", np.quantile(np.abs(x[c.substeps :] - x[: -c.substeps]), 0.99) / (c.substeps * c.dt))


def rate_limit(x, c, size, rng):
    """No faster than a share of the greatest rate that is asked."""
    rate = _asked_rate(x, c) * 10.0 ** (2.0 * (0.3 - size))
    c.note(RISE=rate, FALL=rate)
    return op.rate_limit(x, c.dt, rate, rate)


def soft_rate_limit(x, c, size, rng):
    """A slewing amplifier."""
    rate = _asked_rate(x, c) * 10.0 ** (2.0 * (0.3 - size))
    return op.soft_rate_limit(x, c.dt, rate, 1.0 / (0.5 * c.substeps * c.dt))


def _largest(x, c):
    """Largest magnitude."""
    return c.keep("largest", np.max(np.abs(x)))


def _levels(x, c, size, rng):
    """Upper and lower level that cut a share of the half span."""
    top, bottom = c.keep("top", np.max(x)), c.keep("bottom", np.min(x))
    side = int(rng.integers(0, 3))
    reach = size * 0.5 * (top - bottom)
    return (top - reach if side != 1 else np.inf), (bottom + reach if side != 0 else -np.inf)


def saturation(x, c, size, rng):
    """Hard limits, above, below or both."""
    high, low = _levels(x, c, size, rng)
    c.note(**{name: value for name, value in (("MX", high), ("MN", low)) if np.isfinite(value)})
    return np.clip(x, low, high)


def tanh_clip(x, c, size, rng):
    """An amplifier whose limit sets in along a hyperbolic tangent."""
    top, bottom = c.keep("top", np.max(x)), c.keep("bottom", np.min(x))
    middle, half = 0.5 * (top + bottom), 0.5 * (top - bottom)
    level = half * (1.0 - 0.8 * size)
    knee = level * 0.8
    d = np.abs(x - middle)
    over = np.maximum(d - knee, 0.0)
    bent = np.minimum(d, knee) + (level - knee) * np.tanh(over / (level - knee))
    return middle + np.sign(x - middle) * bent


def dead_zone(x, c, size, rng):
    """Nothing near zero, then a straight line."""
    width = size * c.span
    c.note(WIDTH=width)
    return np.sign(x) * np.maximum(np.abs(x) - width, 0.0)


def smooth_dead_zone(x, c, size, rng):
    """x - w tanh(x/w)."""
    width = size * c.span
    return x - width * np.tanh(x / width)


def quantization(x, c, size, rng):
    """Rounding to steps."""
    step = size * c.span
    c.note(STEP=step)
    return step * np.round(x / step)


def uneven_steps(x, c, size, rng):
    """A converter with differential nonlinearity: codes of unequal width."""
    step = size * c.span
    low = np.floor(np.min(x) / step) - 1.0
    codes = int(np.ceil(np.max(x) / step) - low) + 2
    thresholds = low + 0.5 + np.arange(codes) + rng.normal(0.0, 0.08, codes)
    return step * (low + np.searchsorted(np.maximum.accumulate(thresholds), x / step))


def backlash(x, c, size, rng):
    """A gap."""
    c.note(WIDTH=size * c.span)
    return op.play(x, 0.5 * size * c.span)


def smooth_backlash(x, c, size, rng):
    """A gap that closes smoothly."""
    return op.smooth_backlash(x, 0.5 * size * c.span)


def even_nonlinearity(x, c, size, rng):
    """A parabola about zero that adds the size at the end of the span."""
    sign = rng.choice((-1.0, 1.0))
    return x + sign * size * c.span * (x / _largest(x, c)) ** 2


def even_cousin(x, c, size, rng):
    """cosh, or |x| to a power that is no whole number."""
    z = x / _largest(x, c)
    bend = (np.cosh(1.5 * z) - 1.0) / (np.cosh(1.5) - 1.0) if rng.random() < 0.5 else np.abs(z) ** rng.uniform(1.6, 2.6)
    return x + rng.choice((-1.0, 1.0)) * size * c.span * bend


def odd_nonlinearity(x, c, size, rng):
    """A cube."""
    sign = rng.choice((-1.0, 1.0))
    return x + sign * size * c.span * (x / _largest(x, c)) ** 3


def odd_cousin(x, c, size, rng):
    """sinh, or an odd power that is no whole number."""
    z = x / _largest(x, c)
    power = rng.uniform(2.4, 4.0)
    bend = np.sinh(2.0 * z) / np.sinh(2.0) if rng.random() < 0.5 else np.sign(z) * np.abs(z) ** power
    return x + rng.choice((-1.0, 1.0)) * size * c.span * bend


# Memory of the past.


def creep(x, c, size, rng):
    """Logarithmic creep: each step is followed by G log10(1 + age/T0)."""
    t0 = c.dt * c.substeps * rng.uniform(3.0, 20.0)
    c.note(GAIN=size, T0=t0)
    return x + size * op.after_effect(x, c.dt, lambda age: np.log10(1.0 + age / t0))


def power_law_creep(x, c, size, rng):
    """Andrade's law: each step is followed by G (age/T)^n."""
    exponent = rng.uniform(0.08, 0.2)
    t0 = 0.05 * _length(x, c)
    return x + size * op.after_effect(x, c.dt, lambda age: (age / t0) ** exponent - (c.dt / t0) ** exponent)


def relaxation(x, c, size, rng):
    """One Kelvin-Voigt element: each step is followed by G (1 - exp(-age/T))."""
    t = _length(x, c) * rng.uniform(0.008, 0.04)
    c.note(GAIN=size, T1=t)
    return x + size * op.lag(x - x[0], c.dt, t)


def stretched_relaxation(x, c, size, rng):
    """Kohlrausch: G (1 - exp(-(age/T)^b))."""
    t, b = _length(x, c) * rng.uniform(0.008, 0.04), rng.uniform(0.8, 0.92)
    return x + size * op.after_effect(x, c.dt, lambda age: 1.0 - np.exp(-((age / t) ** b)))


# Clock time and disturbances.


def offset(x, c, size, rng):
    """A constant."""
    value = rng.choice((-1.0, 1.0)) * size * c.span
    c.note(VALUE=value)
    return x + value


def drift(x, c, size, rng):
    """Linear in clock time."""
    value = rng.choice((-1.0, 1.0)) * size * c.span / _length(x, c)
    c.note(RATE=value)
    return x + value * _t(x, c)


def uneven_drift(x, c, size, rng):
    """A trend whose slope wanders a little."""
    nodes = np.cumsum(rng.uniform(0.6, 1.4, 8))
    s = np.interp(np.linspace(0.0, 1.0, len(x)), np.linspace(0.0, 1.0, 8), (nodes - nodes[0]) / (nodes[-1] - nodes[0]))
    return x + rng.choice((-1.0, 1.0)) * size * c.span * s


def thermal_drift(x, c, size, rng):
    """Exponential in clock time."""
    t = _length(x, c) * rng.uniform(0.12, 0.35)
    value = rng.choice((-1.0, 1.0)) * size * c.span
    c.note(VALUE=value, T1=t)
    return x + value * (1.0 - np.exp(-_t(x, c) / t))


def arrhenius_warm_up(x, c, size, rng):
    """A body that warms up, whose losses grow by Arrhenius' law with its temperature; the signal follows it."""
    t, e = _length(x, c) * rng.uniform(0.15, 0.4), rng.uniform(0.4, 1.2)
    theta, out = 0.0, []
    h = _length(x, c) / 400.0
    for _ in range(401):
        out.append(theta)
        theta += h / t * (1.0 - theta * np.exp(e * theta / (1.0 + theta)) / np.exp(e / 2.0))
    warm = np.interp(np.linspace(0.0, 1.0, len(x)), np.linspace(0.0, 1.0, 401), np.array(out) / out[-1])
    return x + rng.choice((-1.0, 1.0)) * size * c.span * warm


def gain_drift(x, c, size, rng):
    """The gain changes linearly with clock time."""
    value = rng.choice((-1.0, 1.0)) * size
    c.note(RATE=value / _length(x, c))
    return x * (1.0 + value * _t(x, c) / _length(x, c))


def gain_warm_up(x, c, size, rng):
    """The gain warms up to its end value."""
    t = _length(x, c) * rng.uniform(0.4, 0.9)
    return x * (1.0 + rng.choice((-1.0, 1.0)) * size * (1.0 - np.exp(-_t(x, c) / t)))


def periodic_disturbance(x, c, size, rng):
    """One line."""
    f = 1.0 / (c.dt * c.substeps * rng.uniform(9.0, 60.0))
    c.note(AMPLITUDE=size * c.span, FREQUENCY=f)
    return x + size * c.span * np.sin(2.0 * np.pi * (f * _t(x, c) + rng.random()))


def hum(x, c, size, rng):
    """A line with harmonics whose frequency wanders by some 1e-4, as mains do."""
    f = 1.0 / (c.dt * c.substeps * rng.uniform(12.0, 60.0))
    wander = np.interp(np.linspace(0.0, 1.0, len(x)), np.linspace(0.0, 1.0, 12), rng.normal(0.0, 1e-4, 12))
    phase = 2.0 * np.pi * np.cumsum(f * (1.0 + wander)) * c.dt + rng.random()
    return x + size * c.span * (np.sin(phase) + 0.25 * np.sin(2.0 * phase + 1.0) + 0.15 * np.sin(3.0 * phase))


def cross_coupling(x, c, size, rng):
    """A share of the other column."""
    share = rng.choice((-1.0, 1.0)) * size * c.span
    c.note(SHARE=share)
    return x + share * c.other


def lagged_cross_coupling(x, c, size, rng):
    """The other column through a short lag."""
    quick = c.dt * c.substeps * rng.uniform(1.0, 3.0)
    return x + rng.choice((-1.0, 1.0)) * size * c.span * op.lag(c.other, c.dt, quick)


def load(x, c, size, rng):
    """A load that is put on at one time and taken off at another."""
    t = np.linspace(0.0, 1.0, len(x))
    on, off = rng.uniform(0.15, 0.4), rng.uniform(0.55, 0.85)
    value = rng.choice((-1.0, 1.0)) * size * c.span
    c.note(VALUE=value, ON=on * _length(x, c), OFF=off * _length(x, c))
    return x + value * ((t >= on) & (t < off))


def ramped_load(x, c, size, rng):
    """A load that is put on and taken off within a few per cent of the record."""
    on, off = rng.uniform(0.15, 0.4), rng.uniform(0.55, 0.85)
    ramp = rng.uniform(0.01, 0.03)
    shape = np.interp(np.linspace(0.0, 1.0, len(x)), [0.0, on, on + ramp, off, off + ramp, 1.0], [0, 0, 1, 1, 0, 0])
    return x + rng.choice((-1.0, 1.0)) * size * c.span * shape


# The record itself. These keep the fine clock; what is missed or hit is counted in samples.


def clock_skew(x, c, size, rng):
    """The sensor's clock runs fast or slow by a share of 1."""
    skew = rng.choice((-1.0, 1.0)) * size
    c.note(SKEW=skew)
    t = _t(x, c)
    return np.interp(t * (1.0 + skew), t, x)


def missed_samples(x, c, size, rng):
    """Runs of samples repeat the last one; size is their share."""
    samples = np.arange(0, len(x), c.substeps)
    y = x[samples].copy()
    run = int(rng.integers(2, 6))
    starts = np.flatnonzero(rng.random(len(y)) < size / run)
    for start in starts:
        y[start + 1 : start + 1 + run] = y[start]
    return np.append(np.repeat(y[:-1], c.substeps), y[-1])


def glitches(x, c, size, rng):
    """Single samples far off."""
    count = -(-len(x) // c.substeps)
    hit = rng.random(count) < 0.006
    hit[count // 2] = True
    spikes = hit * rng.choice((-1.0, 1.0), count) * rng.uniform(0.6, 1.4, count) * size * c.span
    return x + np.append(np.repeat(spikes[:-1], c.substeps), spikes[-1])


def bursts(x, c, size, rng):
    """Disturbances that die away within a few samples."""
    count = -(-len(x) // c.substeps)
    hit = rng.random(count) < 0.004
    hit[count // 2] = True
    spikes = hit * rng.choice((-1.0, 1.0), count) * rng.uniform(0.6, 1.4, count) * size * c.span
    spikes = signal.lfilter([1.0], [1.0, -0.35], spikes)
    return x + np.append(np.repeat(spikes[:-1], c.substeps), spikes[-1])


def sensor_gain(x, c, size, rng):
    """A gain that the scale of the plant's own parameters can take over: nothing a record could tell."""
    c.note(K=1.0 + size)
    return x * (1.0 + size)


CATALOGUE: dict[str, tuple[Realisation, ...]] = {
    "sensor_gain": (Realisation("sensor_gain", sensor_gain, 0.03, 0.03, smallest=0.03),),
    # At least a sample long: below, a lag, a delay and a stiff mode are the same thing, and the noise takes up the ratio.
    "delay": (
        Realisation("delay", delay, 1.0, 40.0, smallest=1.0),
        Realisation("jittered_delay", jittered_delay, 1.0, 40.0, True, 1.0),
    ),
    "lag": (Realisation("lag", lag, 1.0, 40.0, smallest=1.0), Realisation("unequal_lags", unequal_lags, 1.0, 40.0, True, 1.0)),
    "resonance": (
        Realisation("resonance", resonance, 2.0, 12.0, smallest=1.5),
        Realisation("two_modes", two_modes, 2.0, 12.0, True, 1.5),
    ),
    "rate_limit": (
        Realisation("rate_limit", rate_limit, 0.2, 0.9),
        Realisation("soft_rate_limit", soft_rate_limit, 0.2, 0.9, True),
    ),
    "saturation": (Realisation("saturation", saturation, 0.15, 0.6), Realisation("tanh_clip", tanh_clip, 0.15, 0.6, True)),
    "dead_zone": (
        Realisation("dead_zone", dead_zone, 0.02, 0.2),
        Realisation("smooth_dead_zone", smooth_dead_zone, 0.02, 0.2, True),
    ),
    "quantization": (
        Realisation("quantization", quantization, 0.01, 0.2),
        Realisation("uneven_steps", uneven_steps, 0.01, 0.2, True),
    ),
    "backlash": (
        Realisation("backlash", backlash, 0.01, 0.3),
        Realisation("smooth_backlash", smooth_backlash, 0.01, 0.3, True),
    ),
    "even_nonlinearity": (
        Realisation("parabola", even_nonlinearity, 0.02, 0.3),
        Realisation("even_cousin", even_cousin, 0.02, 0.3, True),
    ),
    "odd_nonlinearity": (Realisation("cube", odd_nonlinearity, 0.02, 0.3), Realisation("odd_cousin", odd_cousin, 0.02, 0.3, True)),
    "creep": (Realisation("log_creep", creep, 0.02, 0.5), Realisation("power_law_creep", power_law_creep, 0.03, 1.0, True)),
    "relaxation": (
        Realisation("relaxation", relaxation, 0.03, 1.0),
        Realisation("stretched_relaxation", stretched_relaxation, 0.03, 1.0, True),
    ),
    "offset": (Realisation("offset", offset, 0.01, 0.3),),
    "drift": (Realisation("drift", drift, 0.02, 0.5), Realisation("uneven_drift", uneven_drift, 0.02, 0.5, True)),
    "thermal_drift": (
        Realisation("thermal_drift", thermal_drift, 0.02, 0.5),
        Realisation("arrhenius_warm_up", arrhenius_warm_up, 0.02, 0.5, True),
    ),
    "gain_drift": (Realisation("gain_drift", gain_drift, 0.02, 0.5), Realisation("gain_warm_up", gain_warm_up, 0.02, 0.5, True)),
    "periodic_disturbance": (
        Realisation("periodic_disturbance", periodic_disturbance, 0.01, 0.3),
        Realisation("hum", hum, 0.01, 0.3, True),
    ),
    "cross_coupling": (
        Realisation("cross_coupling", cross_coupling, 0.02, 0.5),
        Realisation("lagged_cross_coupling", lagged_cross_coupling, 0.02, 0.5, True),
    ),
    "load": (Realisation("load", load, 0.02, 0.5), Realisation("ramped_load", ramped_load, 0.02, 0.5, True)),
    "clock": (Realisation("clock_skew", clock_skew, 0.0005, 0.05), Realisation("missed_samples", missed_samples, 0.03, 0.4)),
    "glitches": (Realisation("glitches", glitches, 0.05, 3.0), Realisation("bursts", bursts, 0.05, 3.0, True)),
}

TIME_INVARIANT_LINEAR = frozenset({"delay", "lag", "resonance", "creep", "relaxation"})
"""Effects that commute with linear time-invariant blocks, so that the edge before and the edge after cannot be told apart."""
