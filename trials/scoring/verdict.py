"""A diagnoser's answer as it stands in its files: hashed, read, and refused where it is no verdict."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

ACCUSES = frozenset({"named", "group", "partial", "unknown"})
"""Verdicts that say that something is wrong with the model's structure."""
NAMES = frozenset({"named", "partial", "group"})
"""Verdicts that name effects."""
VERDICTS = ACCUSES | {"none", "calibration", "refused", "missing"}
HASHED = ("verdict.json", "run.json", "improved.st", "improved.toml")
"""Of each case, what a figure of the score depends on."""
LARGEST = 1e100
"""A number beyond is no figure of a machine, and its square has no value."""


def number(value: Any) -> float:
    """A number, or not a number."""
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def _is_share(value: Any) -> bool:
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool) and 0.0 <= value <= 1.0)


def _is_amount(value: Any) -> bool:
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < LARGEST)


def _are_names(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(one, str) for one in value)


def _is_effect(value: Any) -> bool:
    return isinstance(value, dict) and isinstance(value.get("id"), str) and isinstance(value.get("edge", ""), str) and _are_names(value.get("same_edges", []))


def fault_of(verdict: Any) -> str:
    """What is wanted of a verdict that this has not; empty where it is one."""
    if not isinstance(verdict, dict):
        return "a JSON object"
    gap = verdict.get("gap") or {}
    checks = {
        f"verdict: one of {', '.join(sorted(VERDICTS))}": verdict.get("verdict") in VERDICTS if isinstance(verdict.get("verdict"), str) else False,
        "effects: a list of objects with id, edge and same_edges": isinstance(verdict.get("effects", []), list) and all(map(_is_effect, verdict.get("effects", []))),
        "effects: one at least where the verdict names one": verdict.get("verdict") not in ("named", "group") or bool(verdict.get("effects")),
        "rivals: a list of lists of names": isinstance(verdict.get("rivals", []), list) and all(map(_are_names, verdict.get("rivals", []))),
        "cannot_tell: a list of sentences": _are_names(verdict.get("cannot_tell", [])),
        "confidence: 0 to 1": _is_share(verdict.get("confidence")),
        "unknown_score: 0 to 1": _is_share(verdict.get("unknown_score")),
        "gap: an object of finite numbers": isinstance(gap, dict)
        and isinstance(gap.get("signal", ""), str)
        and all(_is_amount(gap.get(key)) for key in ("nominal_rms", "improved_rms", "closed", "closed_low", "closed_high")),
    }
    return next((wanted for wanted, held in checks.items() if not held), "")


def read_object(path: Path) -> dict | None:
    """A JSON object; None where the file holds none."""
    try:
        found = json.loads(path.read_text())
        json.dumps(found, ensure_ascii=False).encode()  # half of a surrogate pair is no text
    except (OSError, ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def read_verdict(path: Path) -> dict | None:
    """A verdict; None where there is none, or one that is none."""
    found = read_object(path)
    return None if fault_of(found) else found


def left_verdict(run: dict) -> bool:
    """Whether trials/run has it that this run ended by itself, with a verdict."""
    return run.get("verdict") is True


def answered(folder: Path) -> tuple[dict | None, dict]:
    """A case's verdict and its run, as trials/run has left them: what did not end by itself has left none."""
    run = read_object(folder / "run.json") or {}
    return (read_verdict(folder / "verdict.json") if left_verdict(run) else None), run


def broken(verdicts: Path) -> list[str]:
    """By case a line for each file verdict.json that is no verdict."""
    lines = []
    for file in sorted(verdicts.glob("*/verdict.json")):
        fault = fault_of(read_object(file))
        if fault:
            lines.append(f"{file.parent.name}: no verdict; wanted is {fault}")
        elif not left_verdict(read_object(file.with_name("run.json")) or {}):
            lines.append(f"{file.parent.name}: no verdict; by its run.json the run did not end by itself")
    return lines


def not_run(verdicts: Path, names: Iterable[str]) -> list[str]:
    """A line for each case of a set that was never run here; the score counts it as one without a verdict."""
    return [f"{name}: not run; trials/run over the whole set goes on with it" for name in names if not (verdicts / name / "run.json").exists()]


def hashes(verdicts: Path) -> str:
    """SHA-256 of all that the score reads, one file a line."""
    files = sorted(file for name in HASHED for file in verdicts.glob(f"*/{name}"))
    return "".join(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.parent.name}/{file.name}\n" for file in files)
