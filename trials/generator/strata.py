"""Which cases a set holds: strata with their sizes, effects and plants in turn, so that every one has its share."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator

import numpy as np

from trials.generator import beyond, outside
from trials.generator.beyond import IN_A_LOOP
from trials.generator.case import PLANTS, Specification
from trials.generator.effects import CATALOGUE
from trials.generator.piezo import CHATTER
from trials.generator.piezo import INTERNAL as IN_THE_LOOP
from trials.generator.servo import INTERNAL as IN_THE_AXIS
from trials.generator.servo import PLAIN
from trials.families import family_of

FULL = {"single": 620, "cousin": 420, "pair": 200, "none": 140, "calibration": 80, "outside": 140, "ambiguous": 100}
"""The full set: 1,700 cases."""
MORE = ("messy",)
"""Strata that a set has only where they are asked for."""
RATIOS = (1.0, 3.0, 10.0, 30.0)
MESSY_RATIOS = (100.0, 200.0, 400.0)
"""The dominant effect over the noise of 1e-4 of the stroke: 1 to 4 % of the stroke."""

HOMES: dict[str, tuple[str, ...]] = {
    effect: ("piezo",) for effect in (*IN_THE_LOOP, "branch_chatter", "creep", "relaxation", "dead_zone", "backlash")
} | {
    "delay": PLANTS, "lag": PLANTS, "resonance": ("piezo", "servo_position", "servo_speed", "servo_free", "thermal"),
    "rate_limit": PLANTS, "saturation": PLANTS, "quantization": PLANTS,
    "dead_zone": ("piezo", "servo_position", "servo_speed", "servo_free", "closed_loop"),
    "backlash": ("piezo", "servo_position", "thermal", "tanks"), "creep": ("piezo", "thermal"), "relaxation": ("piezo", "thermal"),
    "even_nonlinearity": ("piezo", "servo_position", "servo_speed", "servo_free", "thermal", "tanks"),
    "odd_nonlinearity": ("piezo", "servo_position", "servo_speed", "servo_free", "thermal", "tanks"),
    "offset": PLANTS, "drift": ("piezo", "servo_position", "servo_speed", "thermal", "tanks"),
    "thermal_drift": ("piezo", "servo_position", "servo_speed", "thermal", "tanks"),
    "gain_drift": PLANTS, "periodic_disturbance": PLANTS, "cross_coupling": PLANTS, "load": PLANTS,
    "clock": ("piezo", "servo_position", "servo_speed", "servo_free", "thermal", "tanks"),
    "glitches": ("piezo", "servo_position", "servo_speed", "servo_free", "thermal", "tanks"),
    "coulomb_friction": ("servo_position", "servo_speed", "servo_free", "closed_loop"),
    "stribeck_friction": ("servo_position", "servo_speed", "servo_free", "closed_loop"),
    "viscous_friction": ("servo_free",), "cogging": ("servo_position", "closed_loop"),
}  # fmt: skip
"""Plants that an effect may be found on."""

PAIRS = (
    ("creep", "asymmetry"), ("return_point_memory", "creep"), ("lag", "even_nonlinearity"), ("delay", "odd_nonlinearity"),
    ("drift", "periodic_disturbance"), ("saturation", "lag"), ("quantization", "delay"), ("gain_drift", "lag"),
    ("backlash", "drift"), ("coulomb_friction", "cogging"), ("coulomb_friction", "delay"), ("resonance", "thermal_drift"),
    ("dead_zone", "lag"), ("load", "lag"), ("rate_dependence", "drift"), ("bias_dependence", "creep"),
    ("periodic_disturbance", "saturation"), ("glitches", "lag"), ("cross_coupling", "delay"), ("relaxation", "drift"),
)  # fmt: skip
"""Pairs that occur together on machines."""

AMBIGUOUS: tuple[tuple[str, str, str, str, str, tuple[str, ...]], ...] = (
    # plant, effect, realisation, edge, excitation, verdicts that count as saying so
    ("thermal", "delay", "delay", "U", "rich", ("group",)),
    ("thermal", "delay", "delay", "SENSOR.XOUT", "rich", ("group",)),
    ("piezo", "delay", "delay", "", "rich", ("group",)),
    ("piezo", "sensor_gain", "sensor_gain", "HYST.XOUT", "rich", ("group", "calibration")),
    ("thermal", "lag", "lag", "SENSOR.XOUT", "one_sine", ("group", "unknown", "none", "calibration")),
    ("servo_speed", "delay", "delay", "VEL.XOUT", "one_sine", ("group", "unknown", "none", "calibration")),
    ("piezo", "odd_nonlinearity", "cube", "HYST.XOUT", "one_sine", ("group", "unknown", "none", "calibration")),
    ("piezo", "creep", "log_creep", "HYST.XOUT", "one_step", ("group", "unknown", "none", "calibration")),
    ("thermal", "drift", "drift", "SENSOR.XOUT", "one_step", ("group", "unknown", "none", "calibration")),
    ("servo_speed", "coulomb_friction", "coulomb", "U", "one_step", ("group", "unknown", "none", "calibration")),
)
"""Records that cannot tell: exact symmetries of the diagram, and excitations that are too poor."""


def forms(effect: str, cousin: bool) -> list[tuple[str, tuple[str, ...]]]:
    """Realisations of an effect, each with the plants that have it."""
    inside = {**IN_THE_LOOP, "branch_chatter": CHATTER, **IN_THE_AXIS}
    found = []
    for one in inside.get(effect, CATALOGUE.get(effect, ())):
        if one.cousin == cousin:
            homes = tuple(p for p in HOMES[effect] if not (cousin and p == "closed_loop" and effect in PLAIN))
            found.append((one.name, homes))
    return found


def _turns(rng: np.random.Generator, items: list, count: int) -> Iterator:
    """Draws `count` items so that every one comes nearly equally often, in random order."""
    order: list[int] = []
    while len(order) < count:
        order += rng.permutation(len(items)).tolist()
    return (items[i] for i in order[:count])


def seed_of(text: str) -> int:
    """A seed of 63 bits from any text."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") >> 1


def plan(seed: str, sizes: dict[str, int], **more: float) -> list[Specification]:
    """All specifications of a set, in random order."""
    rng = np.random.default_rng(seed_of(seed))
    cases: list[Specification] = []

    def add(stratum: str, plant: str, effects: tuple[tuple[str, str], ...], ratio: float, **others) -> None:
        cases.append(Specification(stratum, plant, effects, ratio, int(rng.integers(2**62)), **others, **more))

    for stratum, cousin in (("single", False), ("cousin", True)):
        # Effects take turns, so that effects with many realisations or plants count no more than others.
        combinations: dict[str, list] = {}
        for effect in HOMES:
            listed = [(effect, name, plant) for name, homes in forms(effect, cousin) for plant in homes]
            if listed:
                combinations[effect] = list(_turns(rng, listed, sizes.get(stratum, 0) + len(listed)))
        turn = list(_turns(rng, list(combinations), sizes.get(stratum, 0)))
        ratios = RATIOS if stratum == "single" else (3.0, 10.0, 10.0, 30.0)
        for number, effect in enumerate(turn):
            effect, name, plant = combinations[effect].pop()
            add(stratum, plant, ((effect, name),), ratios[number % 4])
    for number, pair in enumerate(_turns(rng, list(PAIRS), sizes.get("pair", 0))):
        homes = [p for p in PLANTS if all(p in HOMES[effect] for effect in pair)]
        plant = str(rng.choice(homes))
        effects = []
        for effect in pair:
            names = [name for name, where in forms(effect, cousin=bool(rng.random() < 0.35)) if plant in where]
            names = names or [name for name, where in forms(effect, False) if plant in where]
            effects.append((effect, str(rng.choice(names))))
        add("pair", plant, tuple(effects), (10.0, 30.0)[number % 2])
    for stratum in ("none", "calibration"):
        for number, plant in enumerate(_turns(rng, list(PLANTS), sizes.get(stratum, 0))):
            add(stratum, plant, (), RATIOS[number % 4] if stratum == "calibration" else 0.0)
    for number, effect in enumerate(_turns(rng, list(outside.CATALOGUE), sizes.get("outside", 0))):
        plant = str(rng.choice([p for p in PLANTS if p != "closed_loop"]))
        add("outside", plant, ((effect, outside.CATALOGUE[effect][0].name),), (10.0, 30.0)[number % 2])
    for plant, effect, name, edge, excitation, answers in _turns(rng, list(AMBIGUOUS), sizes.get("ambiguous", 0)):
        add("ambiguous", plant, ((effect, name),), 10.0, plan=excitation, edge=edge, answers=answers)
    used: Counter[str] = Counter()
    for number, plant in enumerate(_turns(rng, list(PLANTS), sizes.get("messy", 0))):
        mixture = messy_effects(rng, plant, used)
        add("messy", plant, mixture, MESSY_RATIOS[number % 3], share=float(rng.uniform(0.62, 0.93)))
    return [cases[i] for i in rng.permutation(len(cases))]


ONE_LAW = frozenset({"coulomb_friction", "stribeck_friction", "viscous_friction"})
"""Of these an axis has one."""


def messy_effects(rng: np.random.Generator, plant: str, used: Counter[str]) -> tuple[tuple[str, str], ...]:
    """A dominant effect, the one that came least often, two to five small ones of other families, and what is beyond any
    library; each by any of its formulas."""
    there = [effect for effect, homes in HOMES.items() if plant in homes and effect != "branch_chatter"]
    least = min(used[effect] for effect in there)
    dominant = str(rng.choice([effect for effect in there if used[effect] == least]))
    used[dominant] += 1
    chosen = [dominant]
    wanted = int(rng.integers(2, 6))
    for effect in rng.permutation(there).tolist():
        other_law = not (effect in ONE_LAW and ONE_LAW & set(chosen))
        if len(chosen) <= wanted and family_of(effect) != family_of(dominant) and other_law:
            chosen.append(effect)
    formulas = []
    for effect in chosen:
        names = [name for cousin in (False, True) for name, homes in forms(effect, cousin) if plant in homes]
        formulas.append((effect, str(rng.choice(names))))
    discrepancy = IN_A_LOOP if plant == "closed_loop" else str(rng.choice(list(beyond.CATALOGUE)))
    return (*formulas, (discrepancy, beyond.CATALOGUE[discrepancy][0].name))


def each(seed: str, ratio: float, **more: float) -> list[Specification]:
    """Every effect of the list alone, on every plant that has it, by one of its own formulas, in a rich record."""
    rng = np.random.default_rng(seed_of(seed))
    cases = []
    for effect in HOMES:
        for plant in HOMES[effect]:
            names = [name for name, homes in forms(effect, False) if plant in homes]
            chosen = ((effect, str(rng.choice(names))),)
            cases.append(Specification("single", plant, chosen, ratio, int(rng.integers(2**62)), **more))
    return cases


def scaled(count: int) -> dict[str, int]:
    """The strata of the full set, scaled to about `count` cases, none left out."""
    whole = sum(FULL.values())
    return {stratum: max(1, round(size * count / whole)) for stratum, size in FULL.items()}
