"""Keys and diagnosers that are made up, to test the scorer with known results."""

from __future__ import annotations

from typing import Any

from trials.generator.strata import FULL, plan
from trials.scoring.judge import Judgement, judge

NOISE = 1.0


def keys(seed: str = "made-up") -> dict[str, dict[str, Any]]:
    """Labels of a full set, without its records."""
    made = {}
    for number, one in enumerate(plan(seed, FULL)):
        effects = [{"id": e, "edge": "A", "edges": ["A", "B"], "realisation": r} for e, r in one.effects]
        made[f"{number:05d}"] = {
            "stratum": one.stratum, "plant": one.plant, "ratio": one.ratio, "deviation_ratio": one.ratio, "effects": effects,
            "noise_rms": [NOISE], "effect_rms": [NOISE * one.ratio], "answers": list(one.answers),
        }  # fmt: skip
    return made


def named(effects: list[str], confidence: float = 0.99, **more: Any) -> dict[str, Any]:
    """A verdict that names effects at the edge A and closes the whole gap."""
    gap = {"nominal_rms": 5.0, "improved_rms": NOISE, "closed": 1.0, "closed_low": 0.97, "closed_high": 1.01}
    return {
        "verdict": "named", "effects": [{"id": e, "edge": "a"} for e in effects], "rivals": [effects], "confidence": confidence,
        "unknown_score": 0.02, "gap": gap, "cannot_tell": [],
    } | more  # fmt: skip


def truth(label: dict[str, Any]) -> dict[str, Any]:
    """What a diagnoser answers that has read the key."""
    stratum = label["stratum"]
    if stratum in ("none", "calibration"):
        return named([], verdict=stratum)
    if stratum == "outside":
        return named([], verdict="unknown", unknown_score=0.97)
    if stratum == "ambiguous":
        return named([e["id"] for e in label["effects"]], verdict="group", cannot_tell=["by design"])
    return named([e["id"] for e in label["effects"]])


def judged(labels: dict[str, dict[str, Any]], answers: dict[str, dict[str, Any]]) -> list[Judgement]:
    """Judgements of all cases."""
    return [judge(name, label, answers[name], {"seconds": 1.0, "exit": 0}) for name, label in labels.items()]
