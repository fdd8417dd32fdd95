"""Runs a diagnoser over cases: each in a scratch copy, with a time limit, as another user if wanted."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import pwd
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from trials.arguments import program_of
from trials.progress import Progress
from trials.scoring.verdict import read_object

LOGS = ("log.csv", *(f"log{number}.csv" for number in range(2, 10)))
"""Records of one machine."""
VISIBLE = ("plant.st", "params.toml", *LOGS)
"""What a case consists of; nothing else is copied."""
KEPT = ("verdict.json", "improved.st", "improved.toml")
"""What is kept of an answer."""
MOST_BYTES = 256 * 2**20
"""Of one file that a diagnoser may write."""
GUARD = Path(__file__).resolve().with_name("guard.py")


class Stopped(Exception):
    """The set was interrupted; what has run is kept."""


@dataclass(frozen=True)
class Diagnoser:
    """What is run over the cases."""

    program: str
    options: tuple[str, ...] = ()
    timeout: float = 180.0
    user: str | None = None
    keep: bool = False
    """Keeps all that it leaves, not the verdict and the improved diagram alone."""

    @property
    def fingerprint(self) -> str:
        """SHA-256 of its program, its user, its options and the programs that these name; of a script with the modules beside it."""
        content = Path(self.program).read_bytes()
        digest = hashlib.sha256(content)
        if content.startswith(b"#!"):
            for module in sorted(Path(self.program).parent.glob("*.py")):
                digest.update(module.read_bytes())
        digest.update((self.user or "").encode())
        for option in self.options:
            digest.update(option.encode())
            named = Path(option.partition("=")[2])
            if named.is_file():
                digest.update(named.read_bytes())
        return digest.hexdigest()


def diagnoser(product: str, options: list[str], timeout: float, user: str | None, keep: bool) -> Diagnoser:
    """A program by its path or name; options that name files of the present folder are good in every other one."""
    if user is not None:
        if os.geteuid() != 0:
            raise SystemExit(f"--user {user}: only root can run a program as somebody else; leave it out, and seal the key")
        try:
            pwd.getpwnam(user)
        except KeyError:
            raise SystemExit(f"--user {user}: no such user") from None
    absolute = []
    for option in options:
        name, equals, value = option.partition("=")
        absolute.append(f"{name}={Path(value).resolve()}" if equals and "/" in value and Path(value).exists() else option)
    return Diagnoser(program_of(product), tuple(absolute), timeout, user, keep)


@dataclass
class Running:
    """The guards that run now, so that an interrupt ends them and their diagnosers."""

    processes: set[subprocess.Popen] = field(default_factory=set)
    lock: threading.Lock = field(default_factory=threading.Lock)
    stopped: bool = False

    def start(self, command: list[str]) -> subprocess.Popen:
        """Starts one, unless the set was interrupted."""
        with self.lock:
            if self.stopped:
                raise Stopped
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, start_new_session=True)
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
                process.send_signal(signal.SIGTERM)


def is_plain(file: Path) -> bool:
    """A file of its own: no link to what the diagnoser itself could not read, no pipe that nobody writes."""
    try:
        return stat.S_ISREG(file.lstat().st_mode)
    except OSError:
        return False


def is_folder(path: Path) -> bool:
    """A folder, and no link to one."""
    return path.is_dir() and not path.is_symlink()


def keep_all(left: Path, folder: Path) -> None:
    """Copies what a diagnoser left, but for links and what is no file."""
    for file in left.rglob("*"):
        relative = file.relative_to(left)
        if is_plain(file) and all(is_folder(left / parent) for parent in relative.parents):
            (folder / relative).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, folder / relative, follow_symlinks=False)


def is_verdict(file: Path) -> bool:
    """Whether a file of its own holds a JSON object."""
    return is_plain(file) and read_object(file) is not None


def ended_by_itself(code: int | str) -> bool:
    """Neither by a signal nor by the guard."""
    return isinstance(code, int) and code >= 0


def call(command: list[str], scratch: Path, one: Diagnoser, running: Running) -> dict[str, Any]:
    """Runs a command under guard: seconds, exit and messages."""
    request = {
        "command": command, "folder": str(scratch), "user": one.user, "seconds": one.timeout, "bytes": MOST_BYTES, "runner": os.getpid(),
    }  # fmt: skip
    process = running.start([sys.executable, str(GUARD), json.dumps(request)])
    answer = process.communicate()[0]
    running.end(process)
    try:
        return json.loads(answer)
    except ValueError:
        return {"seconds": 0.0, "exit": "no guard", "messages": f"trials/guard.py ended with {process.returncode}"}


def run_case(case: Path, out: Path, one: Diagnoser, running: Running | None = None) -> bool:
    """Runs one case. Returns whether there is a verdict: a JSON object of a run that ended by itself."""
    running = running or Running()
    with tempfile.TemporaryDirectory(prefix="trial-", ignore_cleanup_errors=True) as name:
        scratch = Path(name)
        try:
            for file in VISIBLE:
                if (case / file).exists():
                    shutil.copy2(case / file, scratch / file)
                    if one.user:
                        shutil.chown(scratch / file, one.user)
        except OSError as fault:
            notes = {"seconds": 0.0, "exit": "no case", "messages": f"{fault.filename}: {fault.strerror or fault}"}
        else:
            if one.user:
                shutil.chown(scratch, one.user)
            logs = [part for file in LOGS if (scratch / file).exists() for part in ("--log", file)]
            command = [one.program, "diagnose", "plant.st", *logs, "--params", "params.toml", "--out", "result", *one.options]
            notes = call(command, scratch, one, running)
        left = scratch / "result"
        notes["verdict"] = ended_by_itself(notes["exit"]) and is_folder(left) and is_verdict(left / "verdict.json")
        folder = out / case.name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        if notes["verdict"] and one.keep:
            keep_all(left, folder)
        elif notes["verdict"]:
            for file in KEPT:
                if is_plain(left / file):
                    shutil.copyfile(left / file, folder / file, follow_symlinks=False)
        (folder / "run.part").write_text(json.dumps(notes, indent=1))
        os.replace(folder / "run.part", folder / "run.json")
        return notes["verdict"]


def cases_of(folder: Path, out: Path, user: str | None) -> list[Path]:
    """The cases of a set: all of its folders, of which one at least has a diagram."""
    if out.resolve().is_relative_to(folder.resolve()):
        raise SystemExit(f"{out} lies in the folder of the cases; name another with --out")
    if user and folder.stat().st_mode & 0o077:
        raise SystemExit(f"{user} could read all cases in {folder}, not its own alone: chmod 700 {folder}")
    cases = sorted(path for path in folder.iterdir() if path.is_dir() and path.suffix != ".part")
    if not any((case / "plant.st").exists() for case in cases):
        raise SystemExit(f"{folder}: no case in there, a folder with plant.st, params.toml and log.csv; trials/generate makes some")
    return cases


def has_run(folder: Path, again: bool) -> bool:
    """Whether a case has been run; with `again` one without a verdict has not."""
    notes = read_object(folder / "run.json") or {}
    return "verdict" in notes and (bool(notes["verdict"]) or not again)


def run_set(cases: Path, out: Path, one: Diagnoser, jobs: int, again: bool = False) -> tuple[int, int]:
    """Runs what has not been run yet. Returns the number of cases, and of those without a verdict."""
    wanted = cases_of(cases, out, one.user)
    out.mkdir(parents=True, exist_ok=True)
    with (out / ".lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise SystemExit(f"Another trials/run fills {out}; wait for it, or name another folder with --out") from None
        whose, mark = one.fingerprint, out / "diagnoser.sha256"
        if mark.exists() and mark.read_text().strip() != whose:
            raise SystemExit(f"The verdicts in {out} are of another {Path(one.program).name}, another user, or other options; remove the folder, or name another with --out")
        mark.write_text(whose + "\n")
        missing = [case for case in wanted if not has_run(out / case.name, again)]
        progress = Progress("run", len(wanted), len(wanted) - len(missing))
        running = Running()
        pool = ThreadPoolExecutor(jobs)
        futures = [pool.submit(run_case, case, out, one, running) for case in missing]
        try:
            for future in as_completed(futures):
                future.result()
                progress.step()
        except BaseException:
            running.stop()
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
    return len(wanted), sum(not has_run(out / case.name, True) for case in wanted)
