"""What a verdict claims, at the level of families and of members, each with a probability.

Two forms are read. The older one has one confidence for the set of effects that it names. The newer one states beside it
`families`, a list of {"family", "probability"}, and with each effect its `family` and its own `probability`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from trials.families import FAMILIES, family_of, plain, stated_family
from trials.scoring.verdict import NAMES, number

STATED = 0.5
"""A family that a verdict holds for likelier than not is in its set."""
SURE = 0.7
"""The probability from which on a claim counts as sure, as the figures to reach have it."""


@dataclass(frozen=True)
class Named:
    """An effect as a verdict names it."""

    effect: str
    family: str
    edge: str
    probability: float
    stated_family: str = ""
    """As the verdict has it, whose tree may sort an effect otherwise."""


@dataclass(frozen=True)
class Claim:
    """A verdict, read."""

    kind: str
    """named, unknown, … ; refused, or missing where no run has left a verdict."""
    named: tuple[Named, ...] = ()
    families: tuple[tuple[str, float], ...] = ()
    """As the verdict puts them in order, each once, with its probability."""
    rivals: tuple[frozenset[str], ...] = ()
    """Sets of effects that are not ruled out."""
    seconds: float = math.nan

    @property
    def first(self) -> Named | None:
        """What stands first; nothing where the verdict names no effect and no family."""
        if self.named:
            return self.named[0]
        if not self.families:
            return None
        family, probability = max(self.families, key=lambda one: one[1])
        return Named("", family, "", probability) if probability >= STATED else None

    @property
    def first_family(self) -> str:
        """Its family; empty where there is none."""
        return self.first.family if self.first else ""

    @property
    def family_probability(self) -> float:
        """How sure the verdict is of the family that it puts first."""
        if not self.first:
            return math.nan
        stated = dict(self.families)
        return stated.get(self.first.stated_family, self.probability_of(self.first_family))

    @property
    def member_probability(self) -> float:
        """How sure it is of the effect that it puts first."""
        return self.first.probability if self.first and self.first.effect else math.nan

    @property
    def strange(self) -> frozenset[str]:
        """Families that the tree has not: it and the verdict's have grown apart."""
        return (frozenset(one.family for one in self.named) | {family for family, _ in self.families}) - set(FAMILIES)

    @property
    def stated(self) -> frozenset[str]:
        """The families of the set: of every effect that is named, and every family that is likelier than not."""
        return frozenset(one.family for one in self.named) | {family for family, p in self.families if p >= STATED}

    @property
    def rival_families(self) -> frozenset[str]:
        """The families of whatever is not ruled out."""
        return frozenset(family_of(effect) for one in self.rivals for effect in one) | {family for family, p in self.families if p > 0.0}

    def probability_of(self, family: str) -> float:
        """How sure the verdict is that the family is there; 0 where it says nothing of it."""
        stated = dict(self.families)
        if family in stated:
            return stated[family]
        return max((one.probability for one in self.named if one.family == family), default=0.0)


def _probability(value: Any, otherwise: float) -> float:
    found = number(value)
    return found if 0.0 <= found <= 1.0 else otherwise


def claim(verdict: dict[str, Any] | None, run: dict[str, Any]) -> Claim:
    """Reads a verdict and how its run ended. A run that ends with 2, or a verdict that says so, is refused."""
    v = verdict or {}
    seconds = number(run.get("seconds"))
    if v.get("refused") is True or v.get("verdict") == "refused" or (not v and run.get("exit") == 2):
        return Claim("refused", seconds=seconds)
    if not v:
        return Claim("missing", seconds=seconds)
    kind, confidence = str(v.get("verdict", "missing")), _probability(v.get("confidence"), 0.0)
    named = tuple(
        Named(plain(one.get("id")), family_of(one.get("id"), one.get("family")), str(one.get("edge", "")), _probability(one.get("probability"), confidence),
              stated_family(one.get("family") or ""))
        for one in (v.get("effects") or []) if kind in NAMES and family_of(one.get("id")) != "calibration"
    )  # fmt: skip
    families: dict[str, float] = {}
    for one in v.get("families") or []:
        if isinstance(one, dict) and one.get("family"):
            families.setdefault(stated_family(one["family"]), _probability(one.get("probability"), 0.0))
    rivals = tuple(frozenset(plain(x) for x in one) for one in v.get("rivals") or [])
    return Claim(kind, named, tuple(families.items()), rivals, seconds)
