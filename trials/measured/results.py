"""The table of the trial on measured records."""

from __future__ import annotations

from trials.scoring.judge import Judgement
from trials.scoring.statistics import Share, share
from trials.scoring.verdict import NAMES

SURE = 0.9
"""A confidence from which on a wrong name is a false one."""


def mark(case: Judgement) -> str:
    """What a verdict is worth: first, rival, open, or wrong.

    first: the truth stands first, or another name for the same change of this record
    rival: it is among the sets that are not ruled out
    open:  no name, or none that is claimed; the record cannot tell, or the diagnosis cannot
    wrong: another cause is named, and the truth ruled out, or what the machine has not is named with confidence
    """
    accepted = {*case.truth, *case.label.get("same", ())}
    first = case.effects[0] if case.verdict in NAMES and case.effects else ""
    if first in set(case.label.get("excluded", ())) and case.confidence >= SURE:
        return "wrong"
    if first in accepted:
        return "first"
    if any(one & accepted for one in case.rivals):
        return "rival"
    return "open" if not first or case.confidence < SURE else "wrong"


def _line(case: Judgement) -> str:
    first = f"{case.effects[0]} at {case.edges[0]}" if case.effects else ""
    also = "+" if len(case.effects) > 1 else ""
    ratio = f"{case.ratio:.1f}" if case.ratio else ""
    closed = case.closed_true if case.stratum == "injected" else case.closed
    return f"{case.label['what'][:40]:41s}{ratio:>5s}  {case.verdict:12s}{(first + also)[:38]:39s}{case.confidence:5.2f}{100 * closed:6.0f} %  {mark(case)}".rstrip()


def _share(title: str, one: Share) -> str:
    low, high = one.interval
    value = f"{100 * one.value:.0f} %" if one.count else "–"
    return f"{title:62s}{value:>7s}   {100 * low:.0f} … {100 * high:.0f} %   {one.hits} of {one.count}"


def shares(cases: list[Judgement]) -> list[tuple[str, Share]]:
    """The figures below the table."""

    def of(kind: str, least: float = 0.0, most: float = float("inf")) -> list[Judgement]:
        return [c for c in cases if c.stratum == kind and least <= c.ratio < most]

    strong, weak, faint = of("injected", 5.5), of("injected", 1.75, 5.5), of("injected", 0.0, 1.75)
    clear = of("injected", 1.75) + of("ablated", 1.75)
    return [
        ("injected, named first, R ≥ 5.5", share([mark(c) == "first" for c in strong])),
        ("injected, named first, R 1.75 to 5.5", share([mark(c) == "first" for c in weak])),
        ("injected, named first, R below 1.75", share([mark(c) == "first" for c in faint])),
        ("block taken out, named first", share([mark(c) == "first" for c in of("ablated")])),
        ("published cause named first", share([mark(c) == "first" for c in of("withheld")])),
        ("truth first or among the rivals, injected or taken out, R ≥ 1.75", share([mark(c) in ("first", "rival") for c in clear])),
        ("another name with confidence of 0.9 or more, all", share([mark(c) == "wrong" for c in cases])),
    ]


def whole(cases: list[Judgement], head: str) -> str:
    """The table and what it sums up to."""
    lines = [head, "", f"{'what the verdict was not told':41s}{'R':>5s}  {'verdict':12s}{'first name, + more':39s}{'conf.':>5s}{'closed':>8s}  truth", "-" * 121]
    records = list(dict.fromkeys((c.stratum, c.plant) for c in cases))
    for stratum, record in records:
        lines.append(f"{stratum}: {record}")
        lines += ["  " + _line(c) for c in cases if (c.stratum, c.plant) == (stratum, record)]
    return "\n".join([*lines, "", *(_share(title, one) for title, one in shares(cases)), ""])
