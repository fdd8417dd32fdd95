"""The table of figures to reach, from judgements."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from trials.scoring.causes import of_all
from trials.scoring.causes import reliability as reliability_of_families
from trials.scoring.claim import SURE
from trials.scoring.judge import IN_LIBRARY, Judgement
from trials.scoring.statistics import Share, auroc, auroc_interval, quantile_interval, recall_at, share
from trials.scoring.verdict import ACCUSES


@dataclass
class Figure:
    """A line of the table."""

    key: str
    title: str
    value: float
    low: float
    high: float
    count: int
    goal: float | None
    at_least: bool = True
    """Whether more is better; for the coverage `band` holds instead."""
    band: tuple[float, float] | None = None
    unit: str = "%"
    decidable: float = math.nan
    """The value without the cases that no record decides; not a number where their distance was not taken."""

    @property
    def reached(self) -> bool | None:
        """Whether the goal is met; None without a goal or without cases."""
        if math.isnan(self.value):
            return None
        if self.band:
            return self.band[0] <= self.value <= self.band[1]
        if self.goal is None:
            return None
        return self.value >= self.goal if self.at_least else self.value <= self.goal


@dataclass
class Score:
    """Everything that is printed."""

    figures: list[Figure]
    by_effect: dict[str, dict[str, Any]]
    by_plant: dict[str, dict[str, Any]]
    confusion: dict[str, dict[str, int]]
    reliability: list[dict[str, float]]
    strata: dict[str, dict[str, int]]
    seconds: list[float]
    """Of every case that has a run time."""
    misses: list[dict[str, Any]] = field(default_factory=list)
    messy: list[dict[str, Any]] = field(default_factory=list)
    """Every messy machine."""
    messy_reliability: str = ""


def _proportion(key: str, title: str, one: Share, goal: float | None, at_least: bool = True, **more: Any) -> Figure:
    return Figure(key, title, one.value, *one.interval, one.count, goal, at_least, **more)


def _bucket(ratio: float) -> float:
    """The nominal ratio that a case belongs to: 1, 3, or 10 and more."""
    return 10.0 if ratio >= 5.5 else (3.0 if ratio >= 1.75 else 1.0)


def _mean(key: str, title: str, values: list[int], goal: float | None, at_least: bool = True) -> Figure:
    mean = float(np.mean(values)) if values else math.nan
    spread = 1.96 * float(np.std(values)) / math.sqrt(len(values)) if values else math.nan
    return Figure(key, title, mean, mean - spread, mean + spread, len(values), goal, at_least, unit="")


def _quantile(key: str, title: str, values: list[float], q: float, goal: float | None, at_least: bool = True, unit: str = "") -> Figure:
    value, low, high = quantile_interval(values, q)
    return Figure(key, title, value, low, high, len(values), goal, at_least, unit=unit)


def figures(cases: list[Judgement]) -> list[Figure]:
    """The figures of the protocol in its order, with what stands beside them."""

    def of(*strata: str, where: Callable[[Judgement], bool] = lambda c: True) -> list[Judgement]:
        return [c for c in cases if c.stratum in strata and where(c)]

    out: list[Figure] = []
    for bucket, goal in ((10.0, 0.98), (3.0, 0.95), (1.0, 0.85)):
        chosen = of("single", where=lambda c, b=bucket: _bucket(c.ratio) == b)
        sign = "≥ 10" if bucket == 10.0 else f"= {bucket:.0f}"
        out.append(_proportion(f"single_r{bucket:.0f}", f"single effect named first, R {sign}", share([c.named_first for c in chosen]), goal))
        out.append(_proportion(f"single_alone_r{bucket:.0f}", "  and alone, nothing else named", share([c.named_alone for c in chosen]), None))
    chosen = of("cousin", where=lambda c: _bucket(c.ratio) == 10.0)
    out.append(_proportion("cousin_r10", "another formula of the same physics, R ≥ 10", share([c.named_first for c in chosen]), 0.90))
    chosen = of("single", "cousin", where=lambda c: _bucket(c.ratio) >= 3.0)
    out.append(_proportion("named_r3", "  single effects by either formula, R ≥ 3", share([c.named_first for c in chosen]), None))
    out.append(_proportion("rivals", "truth in the rival set, R ≥ 3", share([c.in_rivals for c in chosen]), 0.95))
    out.append(_mean("rival_size", "  mean size of the rival set", [len(c.rivals) for c in chosen if c.rivals], 1.5, False))
    chosen = of("none", "calibration")
    out.append(_proportion("false_alarm", "false alarms: no effect, or calibration only", share([c.verdict in ACCUSES for c in chosen]), 0.01, False))
    chosen = of("calibration", where=lambda c: c.ratio >= 2.0)
    out.append(_proportion("calibration", "  calibration called so, R ≥ 3", share([c.verdict == "calibration" for c in chosen]), None))
    chosen = of("pair")
    out.append(_proportion("pair", "both of a pair, R ≥ 10", share([set(c.truth) <= set(c.effects) for c in chosen]), 0.85))
    out.append(_proportion("third", "  spurious third", share([bool(set(c.effects) - set(c.truth)) and len(c.effects) > 2 for c in chosen]), 0.03, False))
    chosen = of("single", "cousin", where=lambda c: bool(c.effects))
    out.append(_proportion("spurious", "spurious second effect beside a single one", share([len(set(c.effects) - set(c.truth)) > 0 and c.named_first for c in chosen]), None, False))
    positive = [c.unknown_score for c in of("outside") if not math.isnan(c.unknown_score)]
    negative = [c.unknown_score for c in of(*IN_LIBRARY, where=lambda c: c.ratio >= 2.0) if not math.isnan(c.unknown_score)]
    area, interval = auroc(positive, negative), auroc_interval(positive, negative)
    out.append(Figure("auroc", "outside the library: AUROC of unknown_score", area, *interval, len(positive), 0.98, unit=""))
    out.append(_proportion("recall", "  recall at 5 % false unknown", recall_at(positive, negative, 0.05), 0.90))
    out.append(_proportion("outside_named", "  outside the library, yet a name given alone", share([c.verdict == "named" for c in of("outside")]), None, False))
    sure = [c for c in cases if c.confidence >= 0.9]
    out.append(_proportion("sure_wrong", "wrong although confidence ≥ 0.9", share([not c.right for c in sure]), 0.02, False))
    out.append(_proportion("ambiguous", "says “cannot tell” on ambiguous records", share([c.says_cannot_tell for c in of("ambiguous")]), 0.95))
    chosen = of(*IN_LIBRARY, where=lambda c: c.ratio >= 2.0)
    claimed = [c.closed_true for c in chosen if not math.isnan(c.closed_true)]
    out.append(_quantile("closure", "closure against the oracle, R ≥ 3, median", claimed, 0.5, 0.98))
    out.append(_quantile("closure_10", "  10th percentile", claimed, 0.1, 0.90))
    own = [c.effect_closed for c in chosen if not math.isnan(c.effect_closed)]
    out.append(_quantile("own_closure", "  of the effect's own gap alone, median", own, 0.5, 0.98))
    out.append(_quantile("own_closure_10", "  the same, 10th percentile", own, 0.1, 0.90))
    fresh = [c.fresh for c in chosen if not math.isnan(c.fresh)]
    out.append(_quantile("fresh", "  on a fresh record of the machine, median", fresh, 0.5, None))
    out.append(_quantile("fresh_10", "  the same, 10th percentile", fresh, 0.1, None))
    covered = [c for c in chosen if not math.isnan(c.closed_interval[0]) and not math.isnan(c.closed_true)]
    hits = [c.closed_interval[0] - 1e-9 <= c.closed_true <= c.closed_interval[1] + 1e-9 for c in covered]
    out.append(_proportion("coverage", "coverage of the 95 % closure interval", share(hits), 0.92, band=(0.92, 0.98)))
    chosen = of(*IN_LIBRARY, where=lambda c: c.ratio >= 2.0 and c.right_edge is not None)
    out.append(_proportion("edge", "edge right up to its group, R ≥ 3", share([c.right_edge for c in chosen]), 0.95))
    listed = share([c.listed_edge for c in chosen])
    out.append(_proportion("listed_edge", "  or one that the verdict cannot tell from it", listed, 0.95))
    out.append(_mean("listed_edges", "  mean number of these", [c.listed_edges for c in chosen], None))
    out += messy_figures(of("messy"))
    seconds = [c.seconds for c in cases if not math.isnan(c.seconds)]
    out.append(_quantile("seconds", "seconds a case, median", seconds, 0.5, None, False, "s"))
    out.append(_quantile("seconds_max", "  slowest", seconds, 1.0, 60.0, False, "s"))
    out.append(_proportion("missing", "no verdict at all", share([c.verdict in ("missing", "refused") for c in cases]), 0.0, False))
    return out


MESSY_LINES: tuple[tuple[str, str, float | None, bool], ...] = (
    ("family", "messy machines: family of the dominant effect first", 0.90, True),
    ("member", "  the dominant effect itself", 0.90, True),
    ("family_sure", f"  right and sure of the family, P ≥ {SURE}", 0.70, True),
    ("member_sure", "  right and sure of the effect", 0.70, True),
    ("family_sure_wrong", "  sure of a family that is not there", 0.02, False),
    ("member_sure_wrong", "  sure of an effect that is not there", 0.02, False),
)


def messy_figures(cases: list[Judgement]) -> list[Figure]:
    """The figures of the stratum messy; none where a set has none of it."""
    if not cases:
        return []
    shares = of_all([c.mark for c in cases if c.mark], SURE)
    out = [_proportion(f"messy_{key}", title, shares[key], goal, at_least) for key, title, goal, at_least in MESSY_LINES]
    fresh = [c.fresh for c in cases if not math.isnan(c.fresh)]
    return [*out, _quantile("messy_fresh", "  gap closed on a fresh record of the machine, median", fresh, 0.5, None)]


def by_effect(cases: list[Judgement]) -> dict[str, dict[str, Any]]:
    """Named first, for each effect and bucket of R, plain and cousins."""
    table: dict[str, dict[str, Any]] = {}
    for c in cases:
        if c.stratum in ("single", "cousin") and c.truth:
            cell = "cousin" if c.stratum == "cousin" else f"R{_bucket(c.ratio):.0f}"
            line = table.setdefault(c.truth[0], {})
            hits, count = line.get(cell, (0, 0))
            line[cell] = (hits + c.named_first, count + 1)
    return dict(sorted(table.items()))


def by_plant(cases: list[Judgement]) -> dict[str, dict[str, Any]]:
    """Named first, for each effect and plant, by the plain formulas at R of 10 and more."""
    table: dict[str, dict[str, Any]] = {}
    for c in cases:
        if c.stratum == "single" and c.truth and _bucket(c.ratio) == 10.0:
            line = table.setdefault(c.truth[0], {})
            hits, count = line.get(c.plant, (0, 0))
            line[c.plant] = (hits + c.named_first, count + 1)
    return dict(sorted(table.items()))


def confusion(cases: list[Judgement]) -> dict[str, dict[str, int]]:
    """True cause by what was put first."""
    rows: dict[str, Counter[str]] = {}
    for c in cases:
        if c.stratum in ("single", "cousin", "none", "calibration", "outside"):
            row = c.truth[0] if c.stratum in ("single", "cousin") else c.stratum
            rows.setdefault(row, Counter())[c.first] += 1
    return {row: dict(counter) for row, counter in sorted(rows.items())}


def reliability(cases: list[Judgement]) -> list[dict[str, float]]:
    """Share of right verdicts in tenths of the stated confidence."""
    bins = []
    for low in np.arange(0.0, 1.0, 0.1):
        inside = [c for c in cases if low <= c.confidence < low + 0.1 or (low > 0.85 and c.confidence == 1.0)]
        one = share([c.right for c in inside])
        if one.count:
            bins.append(
                {"low": float(low), "stated": float(np.mean([c.confidence for c in inside])), "right": one.value,
                 "from": one.interval[0], "to": one.interval[1], "count": one.count}
            )  # fmt: skip
    return bins


def misses(cases: list[Judgement]) -> list[dict[str, Any]]:
    """Every case that is not right, for those who raise the score."""
    return [
        {"case": c.name, "stratum": c.stratum, "plant": c.plant, "ratio": round(c.ratio, 2), "truth": list(c.truth),
         "realisations": list(c.realisations), "verdict": c.verdict, "effects": list(c.effects), "edges": list(c.edges),
         "rivals": [sorted(r) for r in c.rivals], "confidence": c.confidence, "closed": c.closed, "closed_true": c.closed_true,
         "apart": c.apart}
        for c in sorted(cases, key=lambda c: (c.stratum, c.truth, c.name)) if not c.right
    ]  # fmt: skip


def messy(cases: list[Judgement]) -> list[dict[str, Any]]:
    """What was there on each messy machine, and what of it was told."""
    return [
        {"case": c.name, "plant": c.plant, "dominant": c.truth[0], "realisation": c.realisations[0], "share": c.label["share"],
         "ratio": c.ratio, "beside": [one["id"] for one in c.label["beside"]], "verdict": c.verdict, "effects": list(c.effects),
         "family": c.mark.family, "member": c.mark.member, "probability": c.mark.probability, "closed": c.closed, "fresh": c.fresh}
        for c in sorted(cases, key=lambda c: (c.plant, c.truth, c.name)) if c.stratum == "messy" and c.mark
    ]  # fmt: skip


def with_decidable(cases: list[Judgement]) -> list[Figure]:
    """The figures, each beside its value without the wrong verdicts that no record could mend."""
    found = figures(cases)
    if not all(math.isnan(c.apart) for c in cases):
        for one, other in zip(found, figures([c for c in cases if not c.undecidable])):
            one.decidable = other.value
    return found


def score(cases: list[Judgement]) -> Score:
    """All of it."""
    strata: dict[str, Counter[str]] = {}
    for c in cases:
        strata.setdefault(c.stratum, Counter())[c.verdict] += 1
    return Score(
        with_decidable(cases), by_effect(cases), by_plant(cases), confusion(cases), reliability(cases), {k: dict(v) for k, v in sorted(strata.items())},
        [c.seconds for c in cases if not math.isnan(c.seconds)], misses(cases), messy(cases),
        reliability_of_families([c.mark for c in cases if c.stratum == "messy" and c.mark]),
    )  # fmt: skip
