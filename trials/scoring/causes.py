"""A verdict against causes that are known by family and by member: of real machines, and of the messy stratum."""

from __future__ import annotations

from dataclasses import dataclass

from trials.scoring.claim import Claim
from trials.families import FAMILIES
from trials.scoring.statistics import Share, share


@dataclass(frozen=True)
class Cause:
    """One cause of a gap."""

    family: str
    members: frozenset[str]
    """Effects of the family that are right as members; effects that the library may get later among them."""
    twins: frozenset[str] = frozenset()
    """Effects of other families that write the same signal in this record."""
    beside: bool = False
    """There too, but not what the gap is made of: no error when it is named, and no hit when it stands first."""

    @staticmethod
    def of(family: str, *members: str, twins: tuple[str, ...] = (), beside: bool = False) -> Cause:
        """All members of the family where none is named. Raises ValueError for a family that the tree has not."""
        if family not in FAMILIES:
            raise ValueError(f"{family} is no family; the tree has {', '.join(FAMILIES)}")
        return Cause(family, frozenset(members or FAMILIES[family]), frozenset(twins), beside)


@dataclass(frozen=True)
class Mark:
    """What a verdict is worth against the causes of its record."""

    family: str
    """first, twin, set, beside, rival, open, wrong, refused, missing; see `mark_of`."""
    member: bool
    """The effect that stands first is a member as published."""
    probability: float
    """Of the family that stands first."""
    member_probability: float

    @property
    def right(self) -> bool:
        """The right family stands first, under its own name or a twin's."""
        return self.family in ("first", "twin")

    @property
    def in_set(self) -> bool:
        """The right family stands first or in the set that is named."""
        return self.right or self.family == "set"

    def another(self, at_least: float) -> bool:
        """A family that is no cause stands first with this probability or more."""
        return self.family in ("set", "rival", "wrong") and self.probability >= at_least


def mark_of(claim: Claim, causes: tuple[Cause, ...]) -> Mark:
    """The mark of a claim, at the level of the family:

    first:   a family of the causes stands first; without any cause, no effect is named
    twin:    an effect of another family does, which writes the same signal in this record
    beside:  a family does that is there too, but makes up little of the gap
    set:     another one does, and the right one is named with it, or likelier than not
    rival:   another one does, and the right one is not ruled out
    open:    none is named
    wrong:   another one does, and the right one is ruled out
    """
    first = claim.first
    chief = [one for one in causes if not one.beside]
    families = {one.family for one in chief}
    member = bool(first) and any(first.effect in one.members for one in chief)
    probabilities = (claim.family_probability, claim.member_probability)
    if claim.kind in ("refused", "missing"):
        family = claim.kind
    elif not causes:
        family = "first" if claim.kind in ("none", "calibration") else ("wrong" if first else "open")
    elif not first:
        family = "set" if claim.stated & families else "open"
    elif first.family in families:
        family = "first"
    elif any(first.effect in one.twins for one in chief):
        family = "twin"
    elif any(first.family == one.family or first.effect in one.twins for one in causes if one.beside):
        family = "beside"
    elif claim.stated & families:
        family = "set"
    else:
        family = "rival" if claim.rival_families & families else "wrong"
    return Mark(family, member, *probabilities)


def of_all(marks: list[Mark], sure: float) -> dict[str, Share]:
    """How many marks are right, by family and member, sure or not."""
    return {
        "family": share([one.right for one in marks]),
        "member": share([one.member for one in marks]),
        "family_sure": share([one.right and one.probability >= sure for one in marks]),
        "member_sure": share([one.member and one.member_probability >= sure for one in marks]),
        "family_sure_wrong": share([one.another(sure) for one in marks]),
        "member_sure_wrong": share([not one.member and one.family != "beside" and one.member_probability >= sure for one in marks]),
    }


EDGES = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)
"""Of the classes of stated probability."""


def reliability(marks: list[Mark]) -> str:
    """How often the family that stands first is right, by classes of the probability that is stated of it. What is there but
    makes up little of the gap is left out: it is no error, and not what was asked."""
    lines = ["stated P of the family first     right"]
    for low, high in zip(EDGES[:-1], EDGES[1:]):
        inside = [one for one in marks if one.family != "beside" and (low <= one.probability < high or one.probability == high == 1.0)]
        if inside:
            right = share([one.right for one in inside])
            mean = sum(one.probability for one in inside) / len(inside)
            lines.append("{:.1f} … {:.1f}, mean {:.2f}   {:3d} of {:<3d} {:4.0f} %   {:.0f} … {:.0f} %".format(
                low, high, mean, right.hits, right.count, 100.0 * right.value, *(100.0 * end for end in right.interval)))  # fmt: skip
    return "\n".join(lines)
