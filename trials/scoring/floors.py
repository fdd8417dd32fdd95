"""Floors for continuous integration: figures that a fixed set must not fall below."""

from __future__ import annotations

import json
import math
from typing import Any

from trials.scoring.figures import Figure


class NoFloors(ValueError):
    """The file of floors is none."""


def read_floors(text: str) -> dict[str, Any]:
    """Floors as proposal() has them. Raises NoFloors."""
    try:
        found = json.loads(text)
        floors = found["floors"]
        if floors and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in floors.values()):
            return found
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        pass
    raise NoFloors('no floors; wanted is {"floors": {"pair": 0.6}}, as --propose-floors prints them')


def below(figures: list[Figure], floors: dict[str, Any]) -> list[str]:
    """What lies on the wrong side of its floor. A floor for a figure that has no cases is broken too."""
    known = {f.key: f for f in figures}
    found = []
    for key, floor in floors["floors"].items():
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
