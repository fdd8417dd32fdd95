"""What is played into a plant: sections from rich to poor, joined into a record, as functions on the fine clock.

Steps take one sampling interval, as a set-point that is ramped by its driver does. All levels are relative, -1 to 1.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trials.generator.grid import Grid

Section = Callable[[np.random.Generator, Grid], np.ndarray]


def through(grid: Grid, corners: list[tuple[float, float]]) -> np.ndarray:
    """Straight lines through corners (fraction of the section, level), each corner moved onto a sample."""
    at = [round(fraction * (grid.samples - 1)) for fraction, _ in corners]
    return np.interp(grid.fine / grid.ts, at, [level for _, level in corners])


def taper(grid: Grid, share: float = 0.06) -> np.ndarray:
    """Rises smoothly from 0 to 1 and falls again, so that a section begins and ends at rest."""
    s = np.clip(np.minimum(grid.fine, grid.length - grid.fine) / (share * grid.length), 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


def rest(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """Nothing."""
    return np.zeros_like(grid.fine)


def multisine(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """Sines of random phase up to a fortieth of the sampling rate, weaker towards high frequency."""
    lowest = 1.5 / grid.length
    tones = np.geomspace(lowest, 1.0 / (40.0 * grid.ts), 14) * rng.uniform(0.95, 1.05, 14)
    weights = (tones / lowest) ** -0.45
    x = sum(w * np.sin(2.0 * np.pi * (f * grid.fine + rng.random())) for f, w in zip(tones, weights))
    x = x * taper(grid)
    return x / np.max(np.abs(x)) * rng.uniform(0.7, 1.0)


def chirp(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """A sweep from slow to a fiftieth of the sampling rate, its amplitude falling with frequency."""
    low, high = 1.2 / grid.length, 1.0 / (50.0 * grid.ts)
    ratio = np.log(high / low)
    phase = 2.0 * np.pi * low * grid.length / ratio * (np.exp(ratio * grid.fine / grid.length) - 1.0)
    return rng.uniform(0.6, 0.9) * np.sin(phase) * np.exp(-1.6 * grid.fine / grid.length) * taper(grid, 0.04)


def staircase(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """Up and down in steps with dwells of unequal length; the same levels are visited in both directions."""
    top = rng.uniform(0.7, 1.0)
    levels = [0.0, 0.5 * top, top, 0.5 * top, 0.0, -0.5 * top, -top, -0.5 * top, 0.0]
    edges = np.concatenate(([0.0], np.cumsum(rng.uniform(0.6, 1.6, len(levels)))))
    edges /= edges[-1]
    step = 1.0 / (grid.samples - 1)
    corners = [(0.0, 0.0)]
    for i in range(1, len(levels)):
        corners += [(edges[i], levels[i - 1]), (edges[i] + step, levels[i])]
    return through(grid, corners + [(1.0, 0.0)])


def concentric(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """Triangles whose amplitude falls from full to a hundredth."""
    peaks = np.geomspace(rng.uniform(0.85, 1.0), 0.012, 13)
    signs = np.resize((1.0, -1.0), len(peaks)) * rng.choice((-1.0, 1.0))
    levels = np.concatenate(([0.0], peaks * signs, [0.0]))
    travel = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(levels)) + 0.08)))
    return through(grid, list(zip(travel / travel[-1], levels)))


def nested(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """Equal minor loops, closed and passed, at several biases upwards and downwards: what memory shows itself in."""
    width = rng.uniform(0.25, 0.4)
    levels = [0.0]
    for bias in (-0.55, 0.0, 0.55):
        levels += [bias + width, bias - 0.3 * width]
    levels.append(0.98)
    for bias in (0.55, 0.0, -0.55):
        levels += [bias - width, bias + 0.3 * width]
    levels += [-0.98, 0.0]
    travel = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(levels)) + 0.05)))
    return through(grid, list(zip(travel / travel[-1], levels)))


def triangle_rates(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """The same triangle at rates of nearly two decades, at two amplitudes."""
    large, small = rng.uniform(0.8, 1.0), rng.uniform(0.2, 0.35)
    corners, at = [(0.0, 0.0)], 0.0
    durations = []
    for period, cycles in ((1.0, 1), (0.25, 2), (0.06, 4)):
        for amplitude in (large, small):
            durations += [(period, amplitude)] * cycles
    whole = sum(period for period, _ in durations)
    for period, amplitude in durations:
        p = period / whole
        corners += [(at + 0.25 * p, amplitude), (at + 0.75 * p, -amplitude), (at + p, 0.0)]
        at += p
    return through(grid, corners)


def steps(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """Random levels for random times, beginning and ending at 0."""
    count = int(rng.integers(7, 12))
    edges = np.sort(rng.uniform(0.03, 0.93, count))
    levels = np.append(rng.uniform(-1.0, 1.0, count - 1), 0.0)
    step = 1.0 / (grid.samples - 1)
    corners, before = [(0.0, 0.0)], 0.0
    for edge, level in zip(edges, levels):
        if edge - corners[-1][0] < 3.0 * step:
            continue
        corners += [(edge, before), (edge + step, level)]
        before = level
    corners.append((1.0, before))
    return through(grid, corners)


def one_sine(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """One frequency, one amplitude: poor."""
    cycles = int(rng.integers(8, 16))
    return rng.uniform(0.6, 0.9) * np.sin(2.0 * np.pi * cycles * grid.fine / grid.length)


def one_step(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """A single step and a dwell: poor."""
    step = 1.0 / (grid.samples - 1)
    at = rng.uniform(0.05, 0.1)
    return through(grid, [(0.0, 0.0), (at, 0.0), (at + step, 0.8), (1.0, 0.8)])


def join(rng: np.random.Generator, grid: Grid, plan: list[tuple[Section, float]], shuffle: bool = True) -> np.ndarray:
    """Sections one after the other, in random order, between two rests; weights share out the samples."""
    order = [plan[i] for i in rng.permutation(len(plan))] if shuffle else list(plan)
    order = [(rest, 0.05)] + order + [(rest, 0.05)]
    total = sum(weight for _, weight in order)
    borders = np.round(np.cumsum([0.0] + [weight / total for _, weight in order]) * (grid.samples - 1)).astype(int)
    out = np.zeros_like(grid.fine)
    for (section, _), first, last in zip(order, borders[:-1], borders[1:]):
        part = Grid(grid.ts, int(last - first) + 1, grid.substeps)
        out[first * grid.substeps : last * grid.substeps + 1] = section(rng, part)
    return out


RICH: list[tuple[Section, float]] = [
    (multisine, 0.16),
    (staircase, 0.22),
    (concentric, 0.14),
    (nested, 0.14),
    (triangle_rates, 0.16),
    (chirp, 0.12),
]
