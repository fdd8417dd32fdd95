"""Runs a diagnoser over cases: each in a scratch copy, with a time limit, as another user if wanted."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from trials.progress import Progress

VISIBLE = ("plant.st", "params.toml", "log.csv", "log2.csv")
"""What a case consists of; nothing else is copied."""


def resolve(program: str) -> str:
    """A program by its path, or by its name in PATH."""
    found = shutil.which(program)
    if found is None:
        raise SystemExit(f"{program}: no such program; build it, or name it with --product")
    return str(Path(found).resolve())


class Stopped(Exception):
    """The set was interrupted; what has run is kept."""


@dataclass
class Running:
    """The diagnosers that run now, so that an interrupt ends them too: each has a session of its own."""

    processes: set[subprocess.Popen] = field(default_factory=set)
    lock: threading.Lock = field(default_factory=threading.Lock)
    stopped: bool = False

    def start(self, command: list[str], **options: Any) -> subprocess.Popen:
        """Starts one, unless the set was interrupted."""
        with self.lock:
            if self.stopped:
                raise Stopped
            process = subprocess.Popen(command, start_new_session=True, **options)
            self.processes.add(process)
            return process

    def end(self, process: subprocess.Popen) -> None:
        """One has ended."""
        with self.lock:
            self.processes.discard(process)
            if self.stopped:
                raise Stopped

    def stop(self) -> None:
        """Ends all of them, and lets no further one begin."""
        with self.lock:
            self.stopped = True
            for process in self.processes:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)


def run_case(
    case: Path, out: Path, program: str, options: list[str], timeout: float, user: str | None, keep: bool = False, running: Running | None = None
) -> bool:
    """Runs one case. Returns whether there is a verdict."""
    running = running or Running()
    with tempfile.TemporaryDirectory(prefix="trial-") as name:
        scratch = Path(name)
        for file in VISIBLE:
            if (case / file).exists():
                shutil.copy2(case / file, scratch / file)
        if user:
            shutil.chown(scratch, user)
            for file in scratch.iterdir():
                shutil.chown(file, user)
        logs = [part for file in ("log.csv", "log2.csv") if (scratch / file).exists() for part in ("--log", file)]
        command = [program, "diagnose", "plant.st", *logs, "--params", "params.toml", "--out", "result", *options]
        started = time.monotonic()
        process = running.start(
            command, cwd=scratch, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, user=user,
            env={"PATH": "/usr/bin:/bin", "HOME": name, "LANG": "C.UTF-8"},
        )  # fmt: skip
        try:
            messages = process.communicate(timeout=timeout)[1]
            code: int | str = process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            messages, code = process.communicate()[1], "time limit"
        running.end(process)
        seconds = time.monotonic() - started
        folder = out / case.name
        folder.mkdir(parents=True, exist_ok=True)
        verdict = scratch / "result" / "verdict.json"
        found = verdict.exists()
        if keep and found:
            shutil.copytree(scratch / "result", folder, dirs_exist_ok=True)
        elif found:
            for file in ("verdict.json", "improved.st", "improved.toml"):
                if (verdict.parent / file).exists():
                    shutil.copy2(verdict.parent / file, folder / file)
        notes = {"seconds": round(seconds, 3), "exit": code, "verdict": found, "messages": messages[-2000:]}
        (folder / "run.part").write_text(json.dumps(notes, indent=1))
        os.replace(folder / "run.part", folder / "run.json")
        return found


def fingerprint(program: str, options: list[str]) -> str:
    """SHA-256 of a diagnoser: its program, its options, and the programs that these name."""
    digest = hashlib.sha256(Path(program).read_bytes())
    for option in options:
        digest.update(option.encode())
        named = Path(option.partition("=")[2])
        if named.is_file():
            digest.update(named.read_bytes())
    return digest.hexdigest()


def run_set(
    cases: Path, out: Path, product: str, options: list[str], jobs: int, timeout: float, user: str | None, keep: bool
) -> int:
    """Runs what has not been run yet. Returns the number of cases without a verdict."""
    program = resolve(product)
    out.mkdir(parents=True, exist_ok=True)
    whose, mark = fingerprint(program, options), out / "diagnoser.sha256"
    if mark.exists() and mark.read_text().strip() != whose:
        raise SystemExit(f"The verdicts in {out} are of another {Path(program).name}, or of other options; remove the folder, or name another with --out")
    mark.write_text(whose + "\n")
    wanted = sorted(path for path in cases.iterdir() if (path / "plant.st").exists())
    missing = [case for case in wanted if not (out / case.name / "run.json").exists()]
    progress = Progress("run", len(wanted), len(wanted) - len(missing))
    running = Running()
    pool = ThreadPoolExecutor(jobs)
    futures = [pool.submit(run_case, case, out, program, options, timeout, user, keep, running) for case in missing]
    try:
        for future in as_completed(futures):
            future.result()
            progress.step()
    except BaseException:
        running.stop()
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
    return sum(not json.loads((out / case.name / "run.json").read_text())["verdict"] for case in wanted)
