"""One record of each machine is kept out: the rest is tuned and diagnosed, and the improved diagram is run on the one that was
kept. What it leaves there, beside what the diagram leaves as drawn and as tuned, is the proof of a diagnosis."""

from __future__ import annotations

import json
import math
import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trials.measured.machines import FOLDS, Fold
from trials.scoring.claim import claim
from trials.scoring.fresh import outputs
from trials.scoring.statistics import share
from trials.scoring.verdict import answered, number

GOAL = 0.90
"""So many kept records have an RMS within the interval that was stated."""

ALIKE = 0.95
"""A kept record is like the others where so many of its rows have each input within the range that was stated."""


@dataclass(frozen=True)
class Line:
    """One output of a fold."""

    name: str
    told: str
    signal: str
    rows: int
    rest: float
    """RMS that the improved diagram leaves of the records that it was fitted to."""
    drawn: float
    tuned: float
    improved: float
    """RMS that the diagram leaves of the kept record with the values that it was drawn with, as tuned to the rest, and with what
    the diagnosis of the rest added; not a number where it does not run."""
    stated: tuple[float, float] | None
    """The interval that the verdict states for a further record."""
    alike: float = math.nan
    """The share of its rows in which each input lies within the range that the interval is stated for; not a number without one."""

    @property
    def inside(self) -> bool | None:
        """Whether the kept record's RMS lies in it; None where none is stated."""
        return None if self.stated is None else self.stated[0] <= self.improved <= self.stated[1]


def stated(verdict: dict[str, Any], signal: str) -> dict[str, Any]:
    """What a verdict states as `prediction` of a signal: an object with signal, rms, low, high and inputs, or a list of such
    objects; empty where it states none."""
    listed = verdict.get("prediction") or []
    for one in listed if isinstance(listed, list) else [listed]:
        if isinstance(one, dict) and str(one.get("signal", signal)).upper() == signal.upper():
            return one
    return {}


def stated_interval(verdict: dict[str, Any], signal: str) -> tuple[float, float] | None:
    """The 95 % interval of the RMS on a further record."""
    one = stated(verdict, signal)
    low, high = number(one.get("low")), number(one.get("high"))
    return None if math.isnan(low) or math.isnan(high) else (low, high)


def share_alike(verdict: dict[str, Any], signal: str, log: str) -> float:
    """The share of rows of a log in which each input lies within the range that the prediction is stated for."""
    inside = np.array(True)
    for one in stated(verdict, signal).get("inputs") or []:
        values = column(log, str(one["signal"]))
        inside = inside & (values >= number(one.get("low"))) & (values <= number(one.get("high")))
    return float(np.mean(inside)) if inside.ndim else math.nan


def column(log: str, name: str) -> np.ndarray:
    """A column of a log, whatever its letters."""
    head, *rows = log.strip().splitlines()
    at = [one.strip().upper() for one in head.split(",")].index(name.upper())
    return np.array([float(row.split(",")[at]) for row in rows])


TABLE = re.compile(r"^\[(?:fit|initial|tune)\b[^\]]*\]\n(?:(?!\[).*\n?)*", re.MULTILINE)
"""The tables of a parameter file that say what is fitted, and where a record began."""


def begun(product: str, diagram: Path, parameters: Path, log: Path, starts: tuple[str, ...], out: Path) -> Path:
    """The parameters with the states in which the record begins, fitted to it, and nothing else; as they are where it has none of
    these states or no fit is found."""
    if not starts:
        return parameters
    held = out.with_suffix(".held.toml")
    held.write_text(TABLE.sub("", parameters.read_text()) + f"\n[tune]\ninitial_states = {json.dumps(starts)}\n")
    command = [product, "tune", str(diagram), "--log", str(log), "--params", str(held), "--out", str(out)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, check=False)
    return out if done.returncode in (0, 1) and out.exists() else parameters


def left(product: str, diagram: Path, parameters: Path, log: Path, signal: str) -> float:
    """RMS of what a diagram leaves of a record."""
    model = outputs(product, diagram, parameters, log, (signal,))
    measured = column(log.read_text(), signal)
    return math.nan if model is None or len(model) != len(measured) else float(np.sqrt(np.mean((measured - model[:, 0]) ** 2)))


def lines(fold: Fold, case: Path, verdicts: Path, data: Path, product: str) -> list[Line]:
    """Runs the diagrams of a fold on its kept record: a line for each output that the verdict speaks of, one without figures
    where there is no verdict. Where a verdict leaves no improved diagram, the tuned one is what it has."""
    verdict, run = answered(verdicts)
    read, v = claim(verdict, run), verdict or {}
    told = read.kind + (f" {read.first.effect or read.first.family}" if read.first else "") + ("+" if len(read.named) > 1 else "")
    gaps = {str(one["signal"]): number(one.get("improved_rms")) for one in (*(v.get("gaps") or []), v.get("gap") or {}) if one.get("signal")}
    kept = fold.kept.logs_of(data)[0]
    rows = kept.count("\n") - 1
    if read.kind in ("refused", "missing") or not gaps:
        return [Line(fold.name, told, "", rows, math.nan, math.nan, math.nan, math.nan, None)]
    found = []
    with tempfile.TemporaryDirectory(prefix="kept-") as name:
        log, start = Path(name) / "kept.csv", Path(name) / "start.toml"
        log.write_text(kept)
        start.write_text(fold.rest.files(data)["params.toml"])
        diagrams = [(case / "plant.st", start), (case / "plant.st", case / "params.toml")]
        if (verdicts / "improved.st").exists():
            diagrams.append((verdicts / "improved.st", verdicts / "improved.toml"))
        ready = [
            (diagram, begun(product, diagram, parameters, log, fold.starts, Path(name) / f"begun{number}.toml"))
            for number, (diagram, parameters) in enumerate(diagrams)
        ]
        for signal, rest in gaps.items():
            drawn, tuned, *more = (left(product, *each, log, signal) for each in ready)
            improved = more[0] if more else tuned
            found.append(Line(fold.name, told, signal, rows, rest, drawn, tuned, improved, stated_interval(v, signal), share_alike(v, signal, kept)))
    return found


def lines_of(key: dict[str, Any], verdicts: Path, data: Path, product: str, folds: tuple[Fold, ...] = FOLDS) -> list[Line]:
    """All folds of a key."""
    listed, cases = {fold.name: fold for fold in folds}, Path(key["folder"])
    missing = [label["name"] for label in key["cases"].values() if label["name"] not in listed]
    if missing:
        raise SystemExit(f"{missing[0]}: the list of machines has no such fold; its key is of another version, make the set again")
    if not all((cases / name / "plant.st").exists() for name in key["cases"]):
        raise SystemExit(f"{cases}: the cases of this set are gone; make the set again")
    return [one for name, label in key["cases"].items() for one in lines(listed[label["name"]], cases / name, verdicts / name, data, product)]


def _amount(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.3g}"


def _row(one: Line) -> str:
    interval = f"{_amount(one.stated[0])} … {_amount(one.stated[1])}" if one.stated else "not stated"
    alike = "" if math.isnan(one.alike) else f"{100 * one.alike:.0f} %"
    inside = {True: "inside", False: "outside", None: ""}[one.inside]
    amounts = "".join(f"{_amount(value):>11s}" for value in (one.drawn, one.tuned, one.improved, one.rest))
    return f"{one.name[:44]:45s}{one.signal:8s}{one.rows:6d}{amounts}  {interval:20s}{inside:9s}{alike:>5s}  {one.told}".rstrip()


def whole(lines: list[Line], head: str) -> str:
    """The table and what it sums up to."""
    title = f"{'kept record':45s}{'signal':8s}{'rows':>6s}{'as drawn':>11s}{'tuned':>11s}{'improved':>11s}{'the rest':>11s}  {'stated interval':20s}{'':9s}{'alike':>5s}  told of the rest"
    ran = [one for one in lines if not math.isnan(one.tuned) and not math.isnan(one.improved)]
    ratios = sorted(one.improved / one.tuned for one in ran)
    every = share([bool(one.inside) for one in lines if one.inside is not None])
    alike = share([bool(one.inside) for one in lines if one.inside is not None and one.alike >= ALIKE])
    low, high = every.interval
    reached = "" if not every.count else ("reached" if every.value >= GOAL else "missed")
    summary = [
        f"kept record nearer by the improved diagram than by the tuned one, by a tenth or more: {sum(x < 0.9 for x in ratios)} of {len(lines)}"
        f"; farther by as much: {sum(x > 1.1 for x in ratios)}",
        f"improved over tuned, RMS on the kept record: median {ratios[len(ratios) // 2]:.2f}, {ratios[0]:.2f} … {ratios[-1]:.2f}" if ratios else "no diagram has run",
        f"within the stated interval: {every.hits} of {every.count} ({100 * low:.0f} … {100 * high:.0f} %), goal ≥ {100 * GOAL:.0f} % {reached}" if every.count
        else "no verdict states an interval for a further record",
        *([f"of those whose inputs stay in the stated ranges for {100 * ALIKE:.0f} % of their rows: {alike.hits} of {alike.count}"] if alike.count else []),
    ]  # fmt: skip
    what = "RMS that each diagram leaves of the record that was kept out, and the improved one of the rest"
    return "\n".join([head, "", what, title, "-" * len(title), *map(_row, lines), "", *summary, ""])
