"""Runs a diagnoser and ends all that it has begun: at its end, at its time limit, and when the one who waits for it ends.

Called by trials/runner.py as `guard.py REQUEST`, a JSON object with command, folder, user, seconds and bytes. The answer on
stdout is a JSON object: how long it took, its exit code or "time limit", its last messages. A process that a diagnoser
detaches is handed to this one (a subreaper, see prctl(2)), which leaves none behind, so that no case meets what another
one has left.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import pwd
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NoReturn

PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36
LAST = 2000
"""So many characters of what a diagnoser says are kept."""


class Ended(BaseException):
    """The runner has ended, or wants this case to end."""


def descendants() -> list[int]:
    """All processes below this one."""
    above: dict[int, int] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            with contextlib.suppress(OSError, IndexError):
                above[int(entry.name)] = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
    found, waiting = [], [os.getpid()]
    while waiting:
        parent = waiting.pop()
        below = [process for process, one in above.items() if one == parent]
        found += below
        waiting += below
    return found


def end_all() -> None:
    """Kills until nothing is left; what is killed is waited for."""
    while processes := descendants():
        for process in processes:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG) != (0, 0):
                pass
        time.sleep(0.01)


def end(_number: int, _frame: object) -> NoReturn:
    raise Ended


def guard(request: dict) -> dict:
    """Runs the command."""
    identity = {}
    if request["user"]:
        entry = pwd.getpwnam(request["user"])
        identity = {"user": entry.pw_uid, "group": entry.pw_gid, "extra_groups": os.getgrouplist(entry.pw_name, entry.pw_gid)}

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (request["bytes"], request["bytes"]))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as said:
        started = time.monotonic()
        try:
            process = subprocess.Popen(
                request["command"], cwd=request["folder"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said,
                env={"PATH": "/usr/bin:/bin", "HOME": request["folder"], "LANG": "C.UTF-8"}, preexec_fn=limit, **identity,
            )  # fmt: skip
        except OSError as fault:
            return {"seconds": 0.0, "exit": "no start", "messages": f"{request['command'][0]}: {fault.strerror or fault}"}
        try:
            code: int | str = process.wait(request["seconds"])
        except subprocess.TimeoutExpired:
            code = "time limit"
        seconds = time.monotonic() - started
        end_all()
        said.seek(max(0, said.seek(0, os.SEEK_END) - 4 * LAST))
        messages = said.read(4 * LAST).decode(errors="replace")[-LAST:]
    return {"seconds": round(seconds, 3), "exit": code, "messages": messages}


def main() -> int:
    """Standard input to standard output."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, end)
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    request = json.loads(sys.argv[1])
    try:
        if os.getppid() != request["runner"]:
            raise Ended  # the runner was gone before it could be asked for
        answer = guard(request)
    except Ended:
        end_all()
        return 130
    print(json.dumps(answer))
    return 0


if __name__ == "__main__":
    sys.exit(main())
