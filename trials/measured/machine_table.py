"""The table of the real machines: what each verdict is worth against the published cause, and the figures to reach."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from trials.measured.machines import ALL, MADE_UP, Case
from trials.measured.sources import Own
from trials.scoring.causes import Mark, mark_of, reliability
from trials.scoring.claim import STATED, SURE, Claim, claim
from trials.scoring.statistics import Share, share
from trials.scoring.verdict import answered, read_object

HEAD = f"{'machine and logs':41s}{'rows':>6s}  {'verdict':12s}{'first name, + more':35s}{'P':>5s}  {'family':8s}{'member':8s}{'tune':>7s}{'seconds':>9s}"
GOALS = {"family": 0.85, "member": 0.70, "sure": 0.70, "another": 0.03, "refused": 0.0}


@dataclass(frozen=True)
class Line:
    """One case with its verdict."""

    case: Case
    claim: Claim
    mark: Mark
    rows: int
    tune_seconds: float
    reason: str
    """Why there is no verdict, where there is none."""


def lines_of(labels: dict[str, dict[str, Any]], verdicts: Path, cases: tuple[Case, ...] = ALL) -> list[Line]:
    """The cases of a key, in the order of the list, with their verdicts."""
    listed = {case.name: case for case in cases}
    found = []
    for name, label in labels.items():
        case = listed.get(label["name"])
        if case is None:
            raise SystemExit(f"{label['name']}: the list of machines has no such case; its key is of another version, make the set again")
        verdict, run = answered(verdicts / name)
        one = claim(verdict, run)
        reason = ""
        if one.kind in ("refused", "missing"):
            refusals = (read_object(verdicts / name / "verdict.json") or {}).get("refusals") or [run.get("messages") or f"ended with {run.get('exit', 'nothing')}"]
            reason = " ".join(str(refusals[0]).split())[:150]
        found.append(Line(case, one, mark_of(one, case.causes), int(label["rows"]), float(label["tune"]["seconds"]), reason))
    return found


def _first(one: Claim) -> str:
    if not one.first:
        return ""
    name = f"{one.first.effect} at {one.first.edge}" if one.first.effect else one.first.family
    return (name[:33] + "+") if len(one.named) > 1 else name[:34]


def _line(one: Line) -> str:
    p = "" if math.isnan(one.mark.probability) else f"{one.mark.probability:.2f}"
    member = ("right" if one.mark.member else "no") + ("" if one.case.tells_member else " *")
    seconds = "" if math.isnan(one.claim.seconds) else f"{one.claim.seconds:.0f} s"
    text = f"{one.case.name[:40]:41s}{one.rows:6d}  {one.claim.kind:12s}{_first(one.claim):35s}{p:>5s}  {one.mark.family:8s}{member:8s}{one.tune_seconds:>5.0f} s{seconds:>9s}"
    return text.rstrip() + (f"\n    {one.reason}" if one.reason else "")


@dataclass(frozen=True)
class Total:
    """A line of the summary."""

    title: str
    value: Share
    goal: float | None = None
    at_least: bool = True

    def text(self) -> str:
        """With Wilson's interval, and the goal."""
        low, high = self.value.interval
        share_of = f"{100 * self.value.value:.0f} %" if self.value.count else "–"
        goal, reached = "", ""
        if self.goal is not None and self.value.count:
            goal = ("≥ " if self.at_least else "≤ ") + f"{100 * self.goal:.0f} %"
            reached = "reached" if (self.value.value >= self.goal if self.at_least else self.value.value <= self.goal) else "missed"
        interval = f"{100 * low:.0f} … {100 * high:.0f} %"
        return f"{self.title:60s}{share_of:>6s}   {interval:13s}{self.value.hits:3d} of {self.value.count:<4d}{goal:8s}{reached}".rstrip()


def _groups(lines: list[Line]) -> list[tuple[str, list[Line]]]:
    older = [one for one in lines if isinstance(one.case.source, Own)]
    made = [one for one in lines if one.case.machine == MADE_UP]
    return [("real machines of the folder", [one for one in lines if one not in older + made]), ("made-up records", made), ("older records", older)]


def totals(lines: list[Line]) -> list[Total]:
    """The figures to reach, over cases, and the first of them over machines."""

    def of(flag: Callable[[Line], bool], among: list[Line] = lines) -> Share:
        return share([flag(one) for one in among])

    able = [one for one in lines if one.case.tells_member]
    right = [one for one in lines if one.mark.right]
    machines: dict[str, list[bool]] = {}
    for one in lines:
        machines.setdefault(one.case.machine, []).append(one.mark.right)
    return [
        Total("right family first", of(lambda one: one.mark.right), GOALS["family"]),
        *(Total(f"  {group}", of(lambda one: one.mark.right, among)) for group, among in _groups(lines) if among and len(among) < len(lines)),
        Total("  of these under the name of a twin", of(lambda one: one.mark.family == "twin", right)),
        Total("  first, or in the set that is named", of(lambda one: one.mark.in_set)),
        Total("  machines on which it is first in all cases", share([all(flags) for flags in machines.values()])),
        Total("right member first, where the record can tell", of(lambda one: one.mark.member, able), GOALS["member"]),
        Total(f"sure, P ≥ {SURE}, among those with the right family first", of(lambda one: one.mark.probability >= SURE, right), GOALS["sure"]),
        Total(f"another family first although P ≥ {STATED}", of(lambda one: one.mark.another(STATED))),
        Total(f"another family first although P ≥ {SURE}", of(lambda one: one.mark.another(SURE)), GOALS["another"], False),
        Total("refused without need", of(lambda one: one.mark.family == "refused"), GOALS["refused"], False),
        Total("no verdict at all: crash or time limit", of(lambda one: one.mark.family == "missing")),
    ]


def whole(lines: list[Line], head: str) -> str:
    """The table and what it sums up to."""
    rule = "-" * len(HEAD)
    seconds = sorted(one.claim.seconds for one in lines if not math.isnan(one.claim.seconds))
    time = f"seconds of a diagnosis: median {seconds[len(seconds) // 2]:.0f}, longest {seconds[-1]:.0f}" if seconds else ""
    strange = sorted(frozenset().union(*(one.claim.strange for one in lines)))
    if strange:
        time += f"\nnot in the tree of families (trials/families.py), and so right for no cause: {', '.join(strange)}"
    marks = "first, twin: right; beside: published, but little of the gap; set: right, though not first; rival: not ruled out; open: no name"
    notes = f"* the record tells the family alone\n{marks}"
    return "\n".join([head, "", HEAD, rule, *map(_line, lines), "", *(one.text() for one in totals(lines)), time, "", reliability([one.mark for one in lines]), "", notes, ""])
