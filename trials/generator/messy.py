"""The stratum messy: a machine as machines are. One effect dominates, two to five small ones stand beside it, and so does a
discrepancy that no library has; the sensor resolves 1e-4 of the stroke, so that all of it shows; and the parameters were
tuned on such a record, so that they are bent by what the diagram lacks.

Energies are those of the gap after a refit of the tuned parameters, to first order, as everywhere in this generator.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from trials.generator.grid import Grid
from trials.generator.plant import Injection
from trials.generator.unreachable import Unreachable

if TYPE_CHECKING:
    from trials.generator.case import Builder

FLOOR = 1e-4
"""Noise over stroke, within a factor of two; less where the dominant effect cannot be large."""
LEAST_RATIO = 50.0
"""Of the dominant effect over the noise."""
LEAST, MOST = 0.60, 0.95
"""Share of the gap's energy that the dominant effect has."""
ROUNDS = 6
"""Of scaling the small ones to their common share."""
STEPS = 6
"""Gauss-Newton steps of the tuning."""
SHORTEST = 0.05
"""A small lag or delay may be so many samples long."""


def energy(builder: Builder, injections: list[Injection]) -> float:
    """Mean square of what the injections leave after a refit, in units of the noise, over all outputs."""
    return float(np.mean(builder.in_noises(builder.change(injections), builder.sigma) ** 2))


def mix(builder: Builder, injections: list[Injection]) -> float:
    """Sizes the dominant effect, the first one, for its ratio, and the rest for the share that is wanted. Returns the share
    that is reached: what the gap's energy loses without the dominant effect."""
    rng, wanted = builder.rng, builder.specification.share
    builder.sigma = float(np.ptp(builder.base[:, 0])) * FLOOR * 2.0 ** rng.uniform(-1.0, 1.0)
    dominant, rest = injections[0], injections[1:]
    reached = builder.size(dominant, builder.specification.ratio)
    if reached < LEAST_RATIO:  # a loop takes most of a disturbance away
        builder.sigma *= reached / LEAST_RATIO
        reached = LEAST_RATIO
    weights = rng.uniform(0.4, 1.0, len(rest))
    parts = weights / np.linalg.norm(weights) * reached * np.sqrt((1.0 - wanted) / wanted)
    for one, part in zip(rest, parts.tolist()):
        one.realisation = replace(one.realisation, smallest=min(one.realisation.smallest, SHORTEST))
        builder.size(one, part)
    for _ in range(ROUNDS):
        alone = energy(builder, rest)
        share = 1.0 - alone / energy(builder, injections)
        if abs(share - wanted) < 0.01:
            break
        # The rest scales with its sizes, the dominant effect's energy stays: s/(1 - s) is their ratio.
        ratio = max(share, 0.02) / max(1.0 - share, 0.02) * (1.0 - wanted) / wanted
        for one in rest:
            one.size = float(np.clip(one.size * np.clip(np.sqrt(ratio), 0.4, 2.5), 1e-9, one.realisation.largest))
    share = 1.0 - energy(builder, rest) / energy(builder, injections)
    if not LEAST - 0.05 <= share <= MOST + 0.04:
        raise Unreachable(f"{dominant.effect} beside {', '.join(one.effect for one in rest)} has {share:.2f} of the gap, and {wanted:.2f} was wanted")
    return share


def tune(builder: Builder, wanted: np.ndarray, scales: dict[str, float]) -> dict[str, float]:
    """Relative moves of the tuned parameters that fit the nominal diagram to outputs of the messy machine: Gauss-Newton
    steps, each halved until it helps, on the samples alone, outputs by their spread."""
    plant, names, scale = builder.plant, list(scales), np.array(list(scales.values()))
    coarse, weights = Grid(plant.grid.ts, plant.grid.samples, 1), 1.0 / np.std(wanted, axis=0)
    at_truth = plant.simulate(plant.truth, [], coarse)

    def miss(moved: np.ndarray) -> np.ndarray:
        values = dict(plant.truth) | {name: plant.truth[name] + move for name, move in zip(names, (moved * scale).tolist())}
        model = builder.base + plant.simulate(values, [], coarse) - at_truth
        return ((wanted - model) * weights).T.ravel()

    moved = np.zeros(len(names))
    left = miss(moved)
    for _ in range(STEPS):
        columns = np.column_stack([(left - miss(moved + 1e-4 * unit)) / 1e-4 for unit in np.eye(len(names))])
        step = np.linalg.lstsq(columns, left, rcond=None)[0]
        for _ in range(8):
            tried = np.clip(moved + step, -0.8, 4.0)
            new = miss(tried)
            if np.sum(new**2) < np.sum(left**2):
                break
            step = 0.5 * step
        else:
            break
        gained = 1.0 - float(np.sum(new**2) / np.sum(left**2))
        moved, left = tried, new
        if gained < 1e-6:
            break
    return dict(zip(names, moved.tolist()))


def label(whole: dict[str, Any], share: float) -> dict[str, Any]:
    """The label of such a case: its effect is the dominant one, and what else is there stands beside."""
    effects = whole["effects"]
    return {"effects": effects[:1], "beside": effects[1:], "share": share}
