"""Holds two builds of the product beside each other: the same records, diagnosed by both at the same time.

usage: beside.py OLD NEW [CASE ...] [--samples N] [--effort E]

A CASE is a folder as trials/generate makes them: plant.st, params.toml, log.csv and perhaps log2.csv. Without one it is
the record of growth.py, of N samples (default 10,000). Prints the seconds of the processors for both, their ratio, and
whether the verdicts are equal; else the largest relative difference of a number in them. Exit code 1 where a verdict
names another effect, or is another.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent))

from bench.diagnosis.growth import record  # noqa: E402  (the path is set above)


def arguments_of(case):
    logs = [case / name for name in ("log.csv", "log2.csv") if (case / name).exists()]
    return [case / "plant.st", *(part for log in logs for part in ("--log", log)), "--params", case / "params.toml"]


def both(tools, arguments, folder):
    """Output and seconds of the processors of each tool, which run side by side."""
    running = []
    for number, tool in enumerate(tools):
        out = (folder / f"{number}.json").open("w+")
        command = [tool, "diagnose", *arguments, "--out", folder / f"found{number}", "--json"]
        running.append((subprocess.Popen(command, stdout=out, stderr=subprocess.DEVNULL), out))
    answers = []
    for process, out in running:
        _, status, used = os.wait4(process.pid, 0)
        out.seek(0)
        if status != 0:
            raise SystemExit(f"{process.args[0]} ended with {os.waitstatus_to_exitcode(status)}")
        answers.append((out.read(), used.ru_utime + used.ru_stime))
    return answers


def largest_difference(a, b):
    """Of two numbers anywhere in the trees, relative; infinite where the trees differ otherwise."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return max((largest_difference(a[key], b[key]) for key in a), default=0.0)
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return max((largest_difference(x, y) for x, y in zip(a, b)), default=0.0)
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in (a, b))
    if numbers and a != b:
        return abs(a - b) / max(abs(a), abs(b))
    return 0.0 if a == b else math.inf


def named(verdict):
    return " + ".join(effect["id"] for effect in verdict["effects"]) or verdict["verdict"]


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("old")
    options.add_argument("new")
    options.add_argument("cases", nargs="*", type=pathlib.Path)
    options.add_argument("--samples", type=int, default=10_000)
    options.add_argument("--effort", default="1")
    options = options.parse_args()

    same = True
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        work = {case.name: arguments_of(case) for case in options.cases}
        if not work:
            log = record(options.old, folder, options.samples)
            work[f"{options.samples} samples"] = [HERE / "axis.st", "--log", log, "--params", HERE / "params.toml"]
        print("| record | s of the processors, old build | new build | new / old | named | verdicts |\n|" + " --- |" * 6)
        for label, arguments in work.items():
            (old, before), (new, after) = both((options.old, options.new), [*arguments, "--effort", options.effort], folder)
            first, second = json.loads(old), json.loads(new)
            for verdict in (first, second):
                del verdict["seconds"]
            difference = largest_difference(first, second)
            told = "equal" if difference == 0.0 else f"a number differs by {difference:.0e}"
            same = same and (named(first), first["verdict"]) == (named(second), second["verdict"])
            names = named(first) if named(first) == named(second) else f"{named(first)}; now {named(second)}"
            print(f"| {label} | {before:.1f} | {after:.1f} | {after / before:.2f} | {names} | {told} |", flush=True)
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
