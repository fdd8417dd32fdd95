"""Makes sets of cases from measured records as an engineer would come to them: the nominal diagram is tuned to the record by
the product, from ten starts, and the tuned parameters are what is diagnosed."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from trials.generator.case import TIME_STAMP
from trials.progress import Progress

STARTS = 10
"""Of the tuning, spread over the bounds of each parameter."""
LONGEST = 1800.0
"""Seconds that a tuning may take."""
LAST = 400
"""So many characters of what a tuning says are kept where it fails."""


@dataclass(frozen=True)
class Job:
    """One case to make."""

    name: str
    files: dict[str, str]
    label: dict[str, Any]


def tuned(product: str, files: dict[str, str]) -> tuple[str, dict[str, Any]]:
    """The parameter file after tuning, and how that went. Where the product does not tune, the file stays as it is: the
    diagnosis then meets what a user would give it."""
    with tempfile.TemporaryDirectory(prefix="tune-") as folder:
        for file, text in files.items():
            (Path(folder) / file).write_text(text)
        logs = [part for file in files if file.endswith(".csv") for part in ("--log", file)]
        command = [product, "tune", "plant.st", *logs, "--params", "params.toml", "--out", "tuned.toml", "--start", str(STARTS)]
        started = time.monotonic()
        try:
            done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=LONGEST, check=False)
            code, said = done.returncode, done.stderr.strip()
        except subprocess.TimeoutExpired:
            code, said = -1, f"still tuning after {LONGEST:.0f} s"
        notes = {"seconds": round(time.monotonic() - started, 3), "exit": code, "messages": said[-LAST:]}
        written = Path(folder) / "tuned.toml"
        return (written.read_text() if code in (0, 1) and written.exists() else files["params.toml"]), notes


def case_name(job: Job) -> str:
    """Twelve digits that tell nothing, and others once the case holds something else."""
    return hashlib.sha256(json.dumps([job.name, job.files]).encode()).hexdigest()[:12]


def make_one(job: Job, product: str, cases: Path) -> dict[str, Any]:
    """Tunes and writes a case that is not there yet. Returns its label."""
    folder = cases / case_name(job)
    notes_file = cases / f"{case_name(job)}.tune.json"
    if not (folder.exists() and notes_file.exists()):
        parameters, notes = tuned(product, job.files) if "[fit" in job.files["params.toml"] else (job.files["params.toml"], {"seconds": 0.0, "exit": 0, "messages": ""})
        folder.mkdir(exist_ok=True)
        for file, text in {**job.files, "params.toml": parameters}.items():
            (folder / file).write_text(text)
            os.utime(folder / file, (TIME_STAMP, TIME_STAMP))
        notes_file.write_text(json.dumps(notes))
    rows = sum(text.count("\n") - 1 for file, text in job.files.items() if file.endswith(".csv"))
    return {"name": job.name, "rows": rows, "tune": json.loads(notes_file.read_text()), **job.label}


def make_set(title: str, jobs: list[Job], product: str, cases: Path, key: Path, workers: int) -> int:
    """Makes all cases, several at a time, removes those of another version, and writes the key. Returns their number."""
    cases.mkdir(parents=True, exist_ok=True)
    wanted = {case_name(job) for job in jobs}
    for notes in cases.glob("*.tune.json"):
        name = notes.name.removesuffix(".tune.json")
        if name not in wanted:
            shutil.rmtree(cases / name, ignore_errors=True)
            notes.unlink()
    progress, labels = Progress("tune", len(jobs)), {}

    def one(job: Job) -> dict[str, Any]:
        label = make_one(job, product, cases)
        progress.step()
        return label

    with ThreadPoolExecutor(workers) as pool:
        for job, label in zip(jobs, pool.map(one, jobs)):
            labels[case_name(job)] = label
    key.touch(mode=0o600)
    key.write_text(json.dumps({"schema": "hysteron-trial-machines/1", "set": title, "folder": str(cases.resolve()), "cases": labels}, indent=1))
    return len(jobs)
