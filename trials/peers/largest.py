"""The largest single fit wins: the product's own candidates and fits, one effect at a time, and of these the one that leaves
the least. What makes a verdict of fits is left out: noise floor, material size, calibration, penalties for what was tried,
held-out blocks, rivals, combinations."""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path

from trials.peers.common import arguments, leave, run_product


def closed(gap: dict, improved: float) -> float:
    """The share of the gap, as far as it reaches above the floor that the product states."""
    nominal, floor = float(gap["nominal_rms"]), float(gap["floor_rms"])
    return 1.0 - (improved**2 - floor**2) / max(nominal**2 - floor**2, 0.01 * floor**2)


def verdict(found: dict, seconds: float) -> dict:
    """The product's fits of single effects, without its judgement."""
    singles = [one for one in found.get("fitted", []) if len(one["effects"]) == 1 and one["improved_rms"] is not None]
    best = min(singles, key=lambda one: one["improved_rms"], default=None)
    gap = dict(found["gap"])
    gap["improved_rms"] = best["improved_rms"] if best else gap["nominal_rms"]
    share = closed(gap, gap["improved_rms"])
    gap.update({"closed": share, "closed_low": share, "closed_high": share})
    named = [{"id": best["effects"][0], "edge": best["edges"][0], "share": share, "parameters": {}}] if best else []
    return {
        "schema": "hysteron-verdict/1", "verdict": "named" if best else "none", "effects": named,
        "rivals": [one["effects"] for one in ([best] if best else [])], "confidence": 0.5, "unknown_score": 0.0, "gap": gap,
        "where": {}, "cannot_tell": [], "next_experiment": {}, "seconds": seconds,
    }  # fmt: skip


def main(title: str) -> int:
    """Runs the product with one effect at most, and judges its fits by their size."""
    given = arguments(title)
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="peer-") as name:
        logs = [part for log in given.log for part in ("--log", str(log))]
        command = [given.hysteron, "diagnose", str(given.diagram), *logs, "--params", str(given.params), "--out", name, "--most", "1"]
        run_product(command)
        found = json.loads((Path(name) / "verdict.json").read_text())
    return leave(given.out, verdict(found, time.monotonic() - started))
