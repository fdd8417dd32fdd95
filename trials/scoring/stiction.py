"""What a verdict on a control loop says of its valve: the probability that it sticks."""

from __future__ import annotations

from typing import Any

from trials.families import family_of, plain
from trials.scoring.claim import claim
from trials.scoring.judge import plain as edge_name
from trials.scoring.verdict import NAMES, number

BEHIND = ("PROC.XOUT", "PV")
"""Edges behind the process: what acts there is no valve."""


def sticks(effect: str, stated: object = None) -> bool:
    """Dry friction, or the play that is stiction without its jump: in the two-parameter model (M. A. A. S. Choudhury,
    N. F. Thornhill, S. L. Shah, Control Engineering Practice 13 (2005) 641) a valve whose jump is 0 has a dead band alone."""
    return family_of(effect, stated) == "dry_friction" or plain(effect) == "backlash"


def _counts(edge: str, same: list[str], anywhere: bool) -> bool:
    return anywhere or any(edge_name(one) not in BEHIND for one in (edge, *same))


def probability(verdict: dict[str, Any] | None, run: dict[str, Any], anywhere: bool = False) -> float:
    """That the valve sticks, as far as a verdict says it; 0 where there is none. `anywhere` counts what is named behind the
    process, too: the right effect in the wrong place.

    Where the verdict says what the swing of the loop tells, it is that. Else, where the verdict states families, it is that of dry
    friction, or of an effect that it names at the valve. Else it is the sum over the sets that are not ruled out, each with its
    probability, of those that have such an effect ahead of the process.
    """
    read, v = claim(verdict, run), verdict or {}
    if v.get("control_loop"):
        return _share(v["control_loop"].get("oddness"), 0.0)
    effects = [one for one in v.get("effects") or [] if sticks(one["id"], one.get("family"))]
    at_valve = [one for one in effects if _counts(str(one.get("edge", "")), one.get("same_edges") or [], anywhere)]
    if read.families:
        own = [_share(one.get("probability"), read.probability_of(family_of(one["id"], one.get("family")))) for one in at_valve]
        unplaced = [] if effects and not at_valve else [read.probability_of("dry_friction")]
        return max(own + unplaced, default=0.0)
    if read.kind not in NAMES:
        return 0.0
    if not v.get("rival_details"):
        return read.named[0].probability if at_valve else 0.0
    return min(sum(_share(one.get("probability"), 0.0) for one in v["rival_details"] if _has_it(one, anywhere)), 1.0)


def _share(value: Any, otherwise: float) -> float:
    found = number(value)
    return found if 0.0 <= found <= 1.0 else otherwise


def _has_it(one: dict[str, Any], anywhere: bool) -> bool:
    pairs = zip(one.get("effects") or [], one.get("edges") or [])
    return any(sticks(effect) and _counts(str(edge), [], anywhere) for effect, edge in pairs)
