"""What the peers share: they take the product's command line, run the nominal model, and answer in its format."""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BLOCKS = 16
"""Alternate blocks of the record are fitted and held out."""


@dataclass
class Record:
    """A log with the nominal model's outputs."""

    t: np.ndarray
    inputs: dict[str, np.ndarray]
    measured: np.ndarray
    """First output, as measured."""
    model: np.ndarray
    """The same by the nominal model."""
    output: str

    @property
    def residual(self) -> np.ndarray:
        """The gap."""
        return self.measured - self.model

    @property
    def held_out(self) -> np.ndarray:
        """Samples that no fit sees."""
        return (np.arange(len(self.t)) * BLOCKS // len(self.t)) % 2 == 1


@dataclass
class Answer:
    """What a peer makes of a record."""

    correction: np.ndarray
    name: str
    """An effect by a rule of thumb, or none."""
    edge: str
    parameters: int


def read(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file."""
    with path.open() as file:
        head = next(csv.reader(file))
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    return {name: values[:, i] for i, name in enumerate(head)}


def run_product(command: list[str]) -> None:
    """Runs the product, or ends with what it said."""
    try:
        done = subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    except OSError as fault:
        sys.exit(f"--hysteron {command[0]}: {fault.strerror}; name the product, as --hysteron=build/hysteron")
    if done.returncode:
        sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr}")


def load(diagram: Path, log: Path, parameters: Path, product: str) -> Record:
    """Reads a log and runs the nominal model over it."""
    columns = read(log)
    with tempfile.TemporaryDirectory(prefix="peer-") as name:
        out = Path(name) / "out.csv"
        command = [product, "run", str(diagram), "--in", str(log), "--out", str(out), "--params", str(parameters)]
        run_product(command)
        model = read(out)
    outputs = [name for name in model if name != "t" and name in columns]
    inputs = {name: x for name, x in columns.items() if name not in ("t", *outputs)}
    return Record(columns["t"], inputs, columns[outputs[0]], model[outputs[0]], outputs[0])


def noise_floor(x: np.ndarray) -> float:
    """RMS of the noise from second differences of the measurement, by the median, so that motion and jumps count little."""
    second = np.diff(x, 2)
    return float(np.median(np.abs(second - np.median(second))) / 0.6745 / np.sqrt(6.0))


def verdict(record: Record, answer: Answer, seconds: float) -> dict:
    """The answer in the product's format, judged on the held-out blocks."""
    held = record.held_out
    left = record.residual - answer.correction
    nominal, improved = (float(np.sqrt(np.mean(x[held] ** 2))) for x in (record.residual, left))
    floor = min(noise_floor(record.measured), improved)
    closed = 1.0 - (improved**2 - floor**2) / max(nominal**2 - floor**2, 0.01 * floor**2)
    pieces = [
        1.0 - (np.mean(left[i] ** 2) - floor**2) / max(np.mean(record.residual[i] ** 2) - floor**2, 0.01 * floor**2)
        for i in np.array_split(np.flatnonzero(held), BLOCKS // 2)
    ]
    spread = 1.96 * float(np.std(pieces)) / np.sqrt(len(pieces))
    gap = nominal > 1.1 * floor
    named = [{"id": answer.name, "edge": answer.edge, "share": closed, "parameters": {}}] if gap and answer.name else []
    return {
        "schema": "hysteron-verdict/1",
        "verdict": "named" if named else ("unknown" if gap else "none"),
        "effects": named,
        "rivals": [[answer.name]] if named else [],
        "confidence": 0.5,
        "unknown_score": float(np.clip(1.0 - closed, 0.0, 1.0)) if gap else 0.0,
        "gap": {
            "signal": record.output, "unit": "", "nominal_rms": nominal, "calibrated_rms": nominal, "improved_rms": improved,
            "floor_rms": floor, "closed": closed, "closed_low": closed - spread, "closed_high": closed + spread,
        },
        "where": {}, "cannot_tell": [], "next_experiment": {}, "seconds": seconds, "fitted": answer.parameters,
    }  # fmt: skip


def arguments(title: str) -> argparse.Namespace:
    """The command line of `hysteron diagnose`, and where the product is."""
    parser = argparse.ArgumentParser(description=title)
    parser.add_argument("command", choices=["diagnose"])
    parser.add_argument("diagram", type=Path)
    parser.add_argument("--log", type=Path, action="append", required=True)
    parser.add_argument("--params", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--hysteron", default="hysteron", help="the product, for its run of the nominal model")
    return parser.parse_args()


def leave(out: Path, result: dict) -> int:
    """Writes the verdict. Returns the exit code."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "verdict.json").write_text(json.dumps(result, indent=1))
    return 0


def main(title: str, solve: Callable[[Record], Answer]) -> int:
    """A peer that works on the residual alone."""
    given = arguments(title)
    started = time.monotonic()
    record = load(given.diagram, given.log[0], given.params, given.hysteron)
    return leave(given.out, verdict(record, solve(record), time.monotonic() - started))
