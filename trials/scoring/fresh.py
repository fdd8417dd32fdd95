"""What the improved diagram does, against the machine itself.

On a record that nobody has seen, the same machine driven by another excitation, without noise: what a verdict claims of its
held-out blocks is checked there against the truth. And on the record of the case: how far the improved diagram is from the
machine, in units of the noise that hid the difference.
"""

from __future__ import annotations

import csv
import subprocess
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from trials.arguments import program_of
from trials.generator.case import from_label, table
from trials.progress import Progress
from trials.scoring.judge import Judgement


def outputs(product: str, diagram: Path, parameters: Path, log: Path, names: tuple[str, ...]) -> np.ndarray | None:
    """Outputs of a diagram by the product's own run; None where it refuses."""
    out = log.with_suffix(".out.csv")
    command = [product, "run", str(diagram), "--in", str(log), "--out", str(out), "--params", str(parameters)]
    try:
        subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, check=True)
        with out.open() as file:
            rows = list(csv.reader(file))
        at = [[name.upper() for name in rows[0]].index(name.upper()) for name in names]
        return np.array([[float(row[i]) for i in at] for row in rows[1:]])
    except (subprocess.SubprocessError, OSError, ValueError, IndexError):
        return None  # it refuses, takes too long, or has not these outputs


def checked(label: dict, verdict: str, product: str) -> tuple[float, float]:
    """1 - MSE(improved) / MSE(nominal), both against the noise-free fresh record; and the RMS of improved - machine on the
    case's own record over the RMS of its noise, the larger one of two outputs."""
    folder = Path(verdict)
    builder = from_label(label)
    case = builder.build()
    machine = builder.second(2)
    clean = machine.simulate(machine.truth, case.injections)
    columns = machine.columns(case.injections) | dict(zip(machine.outputs, clean.T))
    weights = 1.0 / np.array(label["noise_rms"])
    improved = (folder / "improved.st", folder / "improved.toml")
    with tempfile.TemporaryDirectory(prefix="fresh-") as name:
        scratch = Path(name)
        for file in ("plant.st", "params.toml", "log.csv"):
            (scratch / file).write_text(case.files[file])
        (scratch / "fresh.csv").write_text(table(builder.grid, columns))
        before = outputs(product, scratch / "plant.st", scratch / "params.toml", scratch / "fresh.csv", machine.outputs)
        after = outputs(product, *improved, scratch / "fresh.csv", machine.outputs)
        here = outputs(product, *improved, scratch / "log.csv", machine.outputs)
    apart = float("nan") if here is None or len(here) != len(case.clean) else float(np.max(np.sqrt(np.mean(((here - case.clean) * weights) ** 2, axis=0))))
    if before is None or after is None or len(before) != len(clean) or len(after) != len(clean):
        return float("nan"), apart
    error = [float(np.mean(((y - clean) * weights) ** 2)) for y in (before, after)]
    return 1.0 - error[1] / error[0] if error[0] > 0.0 else float("nan"), apart


def run_fresh(cases: list[Judgement], verdicts: Path, product: str, jobs: int) -> None:
    """Fills in what the improved diagrams do, for every verdict that left one."""
    program = program_of(product)
    chosen = [c for c in cases if c.truth and (verdicts / c.name / "improved.st").exists()]
    progress = Progress("improved diagrams", len(chosen))
    with ProcessPoolExecutor(jobs) as pool:
        futures = [pool.submit(checked, c.label, str(verdicts / c.name), program) for c in chosen]
        for case, future in zip(chosen, futures):
            case.fresh, case.apart = future.result()
            progress.step()
