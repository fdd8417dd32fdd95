"""Floors for continuous integration: figures that a fixed set must not fall below."""

from __future__ import annotations

import math
from typing import Any

from trials.scoring.figures import Figure


def below(figures: list[Figure], floors: dict[str, Any]) -> list[str]:
    """What lies on the wrong side of its floor. A floor for a figure that has no cases is broken too."""
    known = {f.key: f for f in figures}
    found = []
    for key, floor in floors.get("floors", {}).items():
        figure = known.get(key)
        if figure is None or math.isnan(figure.value):
            found.append(f"{key}: there is no such figure in this set")
        elif (figure.value < floor) if figure.at_least else (figure.value > floor):
            found.append(f"{figure.title.strip()}: {figure.value:.3f}, floor {floor}")
    return found


def proposal(figures: list[Figure]) -> dict[str, dict[str, float]]:
    """The bounds of the 95 % intervals: a change that is worse beyond chance breaks them."""
    chosen = {}
    for f in figures:
        if f.goal is not None and not math.isnan(f.value) and f.unit != "s":
            chosen[f.key] = round(f.low if f.at_least else f.high, 3)
    return {"floors": chosen}
