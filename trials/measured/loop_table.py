"""The table of the control loops: the product as a detector of stiction, yes or no, beside published detectors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from trials.measured.loops import Loop, signals
from trials.peers.stiction import bicoherence, correlation, shape
from trials.scoring.claim import claim
from trials.scoring.statistics import auroc, auroc_interval, share
from trials.scoring.stiction import probability
from trials.scoring.verdict import answered

PRODUCT = "hysteron"
ANYWHERE = "anywhere"
"""The product again, where a sticking behind the process counts, too."""
SURE = 0.5
"""From here on a loop counts as told to stick by the product."""
GOAL = 0.95
"""19 of 20 loops right, and no false alarm."""
PEERS: dict[str, tuple[Callable[..., float], float]] = {
    "correlation": (correlation.score, correlation.SURE), "shape": (shape.score, shape.SURE), "bicoherence": (bicoherence.score, bicoherence.SURE),
}  # fmt: skip
"""Each with the score from which on its paper calls stiction."""
THRESHOLDS = {PRODUCT: SURE, ANYWHERE: SURE, **{name: sure for name, (_, sure) in PEERS.items()}}


@dataclass(frozen=True)
class Line:
    """One loop with all scores."""

    loop: Loop
    told: str
    """By the product: verdict and first name."""
    seconds: float
    scores: dict[str, float] = field(default_factory=dict)


def line(loop: Loop, log: str, verdict: dict[str, Any] | None, run: dict[str, Any]) -> Line:
    """Scores of a loop by all detectors."""
    read = claim(verdict, run)
    first = f" {read.first.effect or read.first.family} at {read.first.edge}" if read.first else ""
    op, pv = signals(log)
    own = {PRODUCT: probability(verdict, run), ANYWHERE: probability(verdict, run, anywhere=True)}
    scores = own | {name: score(op, pv, loop.integrating) for name, (score, _) in PEERS.items()}
    return Line(loop, read.kind + first, read.seconds, scores)


def lines_of(labels: dict[str, dict[str, Any]], verdicts: Path, loops: list[Loop], data: Path) -> list[Line]:
    """The loops of a key, with their verdicts."""
    listed = {one.name: one for one in loops}
    found = []
    for name, label in labels.items():
        if label["name"] not in listed:
            raise SystemExit(f"{label['name']}: {data} has no such loop any more; make the set again")
        loop = listed[label["name"]]
        found.append(line(loop, loop.source.logs_of(data)[0], *answered(verdicts / name)))
    return sorted(found, key=lambda one: (not one.loop.sticks, one.loop.name))


def receiver(lines: list[Line], method: str) -> list[tuple[int, int]]:
    """The curve of a detector as counts: false alarms, and loops found, as the threshold falls."""
    points = [(0, 0)]
    for threshold in sorted({one.scores[method] for one in lines}, reverse=True):
        told = [one for one in lines if one.scores[method] >= threshold]
        points.append((sum(not one.loop.sticks for one in told), sum(one.loop.sticks for one in told)))
    return points


def _found_at(points: list[tuple[int, int]], alarms: int) -> int:
    return max(found for false, found in points if false <= alarms)


def figures(lines: list[Line], method: str) -> str:
    """A detector's line of the summary."""
    yes = [one.scores[method] for one in lines if one.loop.sticks]
    no = [one.scores[method] for one in lines if not one.loop.sticks]
    area, (low, high), points = auroc(yes, no), auroc_interval(yes, no), receiver(lines, method)
    right = share([(one.scores[method] >= THRESHOLDS[method]) == one.loop.sticks for one in lines])
    alarms = sum(score >= THRESHOLDS[method] for score in no)
    curve = "  ".join(f"{_found_at(points, number):3d}" for number in range(4))
    interval = "{:.0f} … {:.0f} %".format(*(100.0 * end for end in right.interval))
    return f"{method:14s}{area:6.2f}   {low:.2f} … {high:.2f}   {right.hits:3d} of {right.count:<3d} {interval:14s}{alarms:6d}     {curve}"


def whole(lines: list[Line], head: str) -> str:
    """The table and what it sums up to."""
    methods = list(THRESHOLDS)
    title = f"{'loop':18s}{'kind':15s}{'label':28s}" + "".join(f"{name:>13s}" for name in methods) + "  told by the product"
    rows = [
        f"{one.loop.name[:17]:18s}{one.loop.kind[:14]:15s}{one.loop.label[:27]:28s}"
        + "".join(f"{one.scores[name]:>12.2f}" + ("+" if one.scores[name] >= THRESHOLDS[name] else " ") for name in methods)
        + f"  {one.told}"
        for one in lines
    ]
    sticking = sum(one.loop.sticks for one in lines)
    summary = f"{'detector':14s}{'AUROC':>6s}   {'95 % interval':13s}   {'right at its threshold':25s}{'false':>7s}     found of {sticking} at 0, 1, 2, 3 false alarms"
    right = share([(one.scores[PRODUCT] >= SURE) == one.loop.sticks for one in lines])
    alarms = sum(one.scores[PRODUCT] >= SURE and not one.loop.sticks for one in lines)
    reached = "reached" if lines and right.value >= GOAL and alarms == 0 else "missed"
    goal = f"goal: {100 * GOAL:.0f} % right and no false alarm: {reached}"
    note = "+ told to stick: from " + ", ".join(f"{name} {sure:.2f}" for name, sure in THRESHOLDS.items())
    return "\n".join([head, "", title, "-" * len(title), *rows, "", note, "", summary, *(figures(lines, name) for name in methods), goal, ""])
