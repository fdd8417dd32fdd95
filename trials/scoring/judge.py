"""One verdict against one label."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from trials.families import family_of
from trials.scoring.causes import Cause, Mark, mark_of
from trials.scoring.claim import claim
from trials.scoring.verdict import NAMES, VERDICTS, answered, number

IN_LIBRARY = ("single", "cousin", "pair")
CALIBRATION_NAMES = frozenset({"parameter_mismatch", "gain_error"})


@dataclass
class Judgement:
    """What the scorer knows of one case."""

    name: str
    stratum: str
    plant: str
    ratio: float
    truth: tuple[str, ...]
    verdict: str
    effects: tuple[str, ...]
    """As the verdict states them, first one first."""
    edges: tuple[str, ...]
    rivals: tuple[frozenset[str], ...]
    confidence: float
    unknown_score: float
    cannot_tell: bool
    seconds: float
    right_edge: bool | None
    listed_edge: bool | None
    """Whether a right one is among the edges that the verdict says it cannot tell apart, its own with them."""
    listed_edges: int
    """How many these are."""
    closed: float
    """As the verdict claims it."""
    closed_interval: tuple[float, float]
    closed_true: float
    """Against the noise that the generator added: 0 at the nominal gap, 1 where the noise alone is left, as it is for an oracle
    that knows structure and parameters."""
    effect_closed: float = math.nan
    """The same of the effect's own gap, which calibration cannot close: 0 where a refit of the known parameters ends."""
    fresh: float = math.nan
    """Closure on a record that nobody has seen, without noise; not a number where it was not run."""
    apart: float = math.nan
    """RMS distance of the improved diagram from the machine on the case's own record, over the noise; likewise."""
    answers: tuple[str, ...] = ()
    realisations: tuple[str, ...] = ()
    label: dict[str, Any] = field(default_factory=dict)
    mark: Mark | None = None
    """At the level of families and members."""

    @property
    def first(self) -> str:
        """The effect that the verdict puts first, or the verdict itself where it names none."""
        if self.verdict in NAMES and self.effects:
            return self.effects[0]
        return self.verdict

    @property
    def named_first(self) -> bool:
        """The truth stands first, alone or as the head of a group."""
        return self.first in self.truth

    @property
    def named_alone(self) -> bool:
        """Exactly the truth is named and nothing else."""
        return self.verdict == "named" and set(self.effects) == set(self.truth)

    @property
    def in_rivals(self) -> bool:
        """The true set is among the rivals."""
        return frozenset(self.truth) in self.rivals

    @property
    def says_cannot_tell(self) -> bool:
        """It declines to choose, or says what it cannot tell apart."""
        return self.verdict in self.answers or self.cannot_tell or (self.verdict in NAMES and len(self.rivals) > 1)

    @property
    def right(self) -> bool:
        """Whether the verdict is right, for the reliability of its confidence."""
        if self.stratum == "none":
            return self.verdict in ("none", "calibration")
        if self.stratum == "calibration":
            return self.verdict in ("calibration", "none") if self.ratio < 2.0 else self.verdict == "calibration"
        if self.stratum == "outside":
            return self.verdict in ("unknown", "partial")
        if self.stratum == "ambiguous":
            return self.says_cannot_tell
        if self.stratum == "pair":
            return set(self.effects) == set(self.truth)
        return self.named_first

    @property
    def undecidable(self) -> bool:
        """Not right, with a model that differs from the machine by less than the noise: to the record the two are the same."""
        return not self.right and self.apart < 1.0


def plain(name: str) -> str:
    """An edge's name without differences that mean nothing."""
    return "".join(str(name).split()).upper()


def judge(name: str, label: dict[str, Any], verdict: dict[str, Any] | None, run: dict[str, Any]) -> Judgement:
    """Compares a verdict with the label of its case."""
    v = verdict or {}
    kind = str(v.get("verdict", "refused" if run.get("exit") == 2 else "missing"))
    truth = tuple(e["id"] for e in label["effects"])
    # Another effect that gives the very same output with as many parameters is the true one under another name.
    same = {name: e["id"] for e in label["effects"] for name in e.get("same_as", {}) if name not in truth}
    effects = [e for e in v.get("effects", []) if str(e.get("id")) not in CALIBRATION_NAMES]
    named = tuple(same.get(str(e.get("id")), str(e.get("id"))) for e in effects)
    right_edge = listed_edge = None
    listed: set[str] = set()
    if named and named[0] in truth:
        true = label["effects"][truth.index(named[0])]
        allowed = true.get("same_as", {}).get(effects[0]["id"], true["edges"])
        stated = plain(effects[0].get("edge", ""))
        right = {plain(edge) for edge in allowed}
        listed = {stated, *(plain(edge) for edge in effects[0].get("same_edges", []))}
        right_edge = stated in right
        listed_edge = not listed.isdisjoint(right)
    gap = v.get("gap") or {}
    output = 1 if len(label["noise_rms"]) > 1 and str(gap.get("signal", "")).upper() == "U" else 0
    floor2 = float(label["noise_rms"][output]) ** 2
    effect2 = float(label.get("effect_rms", [0.0, 0.0])[output]) ** 2
    nominal2, improved2 = number(gap.get("nominal_rms")) ** 2, number(gap.get("improved_rms")) ** 2
    seconds = number(run.get("seconds"))
    closed_true = 1.0 - (improved2 - floor2) / (nominal2 - floor2) if nominal2 > 1.02 * floor2 else math.nan
    return Judgement(
        name=name,
        stratum=label["stratum"],
        plant=label["plant"],
        ratio=label["ratio"] if label["effects"] else label["deviation_ratio"],
        truth=truth,
        verdict=kind if kind in VERDICTS else "missing",
        effects=named,
        edges=tuple(str(e.get("edge", "")) for e in effects),
        rivals=tuple(dict.fromkeys(frozenset(same.get(str(x), str(x)) for x in one) for one in v.get("rivals", []))),
        confidence=number(v.get("confidence")),
        unknown_score=number(v.get("unknown_score")),
        cannot_tell=bool(v.get("cannot_tell")),
        seconds=seconds if seconds >= 0.0 else math.nan,
        right_edge=right_edge,
        listed_edge=listed_edge,
        listed_edges=len(listed),
        closed=number(gap.get("closed")),
        closed_interval=(number(gap.get("closed_low")), number(gap.get("closed_high"))),
        closed_true=closed_true,
        effect_closed=1.0 - (improved2 - floor2) / effect2 if effect2 > 2.0 * floor2 else math.nan,
        answers=tuple(label.get("answers", ())),
        realisations=tuple(e["realisation"] for e in label["effects"]),
        label=label,
        mark=mark_of(claim(verdict, run), causes_of(label)),
    )


def causes_of(label: dict[str, Any]) -> tuple[Cause, ...]:
    """The effects of a label as causes; of a messy machine, what stands beside the dominant one."""
    parts = [(one, False) for one in label["effects"]] + [(one, True) for one in label.get("beside", ())]
    return tuple(Cause(family_of(one["id"]), frozenset({one["id"]}), frozenset(one.get("same_as", ())), beside) for one, beside in parts)


def judged(labels: dict[str, dict[str, Any]], verdicts: Path) -> list[Judgement]:
    """A diagnoser's verdicts, as trials/run has left them, against the labels of a key."""
    return [judge(name, label, *answered(verdicts / name)) for name, label in labels.items()]
