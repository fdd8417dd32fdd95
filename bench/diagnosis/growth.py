"""Measures how the time of a diagnosis grows, with the samples of the record and with the candidates that are tried.

usage: growth.py [--tool TOOL] [--write]

The model is axis.st, the record a run of machine.st with noise: play and creep, so that single effects and pairs are
tried. Prints two tables; --write also writes them to docs/diagnosis-growth.md, with docs/pictures/diagnosis_growth.png.
Exit code 1 where 10,000 samples take more than 10 s, or time grows faster than samples or candidates by more than half.
"""

import argparse
import csv
import datetime
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT))

from bench import measure  # noqa: E402  (the path is set above)

SAMPLES = (5_000, 10_000, 20_000, 40_000)  # in shorter records creep is not seen, and no pair tried
PERIOD = 1e-3
EFFECTS = (
    "backlash", "creep", "lag", "delay", "dead_zone", "saturation", "coulomb_friction", "resonance",
    "quantization", "drift", "odd_nonlinearity", "even_nonlinearity", "relaxation", "clock", "rate_limit", "viscous_friction",
)  # fmt: skip
COUNTS = (2, 4, 8, 16)
AT = 10_000
GOAL_SECONDS = 10.0
MOST_GROWTH = 1.5  # of the ratio of times, over the ratio of samples or candidates


def command(count):
    """A rest, then triangles and chirps of changing size, and steps that are held: as many as there is room for."""
    numbers = random.Random(1)
    values = [0.0] * min(300, count // 8)
    while len(values) < count:
        size = numbers.uniform(0.3, 3.0)
        length = numbers.randrange(150, 500)
        kind = numbers.randrange(3)
        for k in range(length):
            share = k / length
            if kind == 0:
                values.append(size * (1.0 - abs((4.0 * share + 1.0) % 4.0 - 2.0)))
            elif kind == 1:
                values.append(size * math.sin(2.0 * math.pi * (1.0 + 12.0 * share) * share * length * PERIOD * 4.0))
            else:
                values.append(size * (1.0 if share < 0.5 else -0.5))
    return values[:count]


def write_csv(path, **columns):
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["t", *columns])
        for k, row in enumerate(zip(*columns.values())):
            table.writerow([f"{k * PERIOD:.3f}", *(repr(value) for value in row)])


def record(tool, folder, count):
    """A log of `count` samples, noise of 0.01 um on it."""
    inputs = command(count)
    driven, answer, log = (folder / f"{count}_{name}.csv" for name in ("in", "out", "log"))
    write_csv(driven, U=inputs)
    subprocess.run([tool, "run", HERE / "machine.st", "--in", driven, "--out", answer], check=True, capture_output=True)
    numbers = random.Random(2)
    with answer.open(newline="") as file:
        measured = [float(row["Y"]) + numbers.gauss(0.0, 0.01) for row in csv.DictReader(file)]
    write_csv(log, U=inputs, Y=measured)
    return log


def diagnose(tool, folder, log, effects=()):
    """One row: candidates, seconds as passed, seconds of the processors, names."""
    before = os.times()
    done = subprocess.run(
        [tool, "diagnose", HERE / "axis.st", "--log", log, "--params", HERE / "params.toml", "--out", folder / "found",
         "--effort", "1e6", "--json", *(["--effects", ",".join(effects)] if effects else [])],
        check=True, capture_output=True, text=True,
    )  # fmt: skip
    after = os.times()
    verdict = json.loads(done.stdout)
    names = " + ".join(effect["id"] for effect in verdict["effects"]) or verdict["verdict"]
    processors = after.children_user + after.children_system - before.children_user - before.children_system
    return verdict["candidates_tried"], after.elapsed - before.elapsed, processors, names


def exponent(xs, ys):
    """Slope of the straight line through the logarithms."""
    logs = [(math.log(x), math.log(y)) for x, y in zip(xs, ys)]
    mean_x, mean_y = (sum(values) / len(logs) for values in zip(*logs))
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--tool", default=str(ROOT / "build" / "hysteron"))
    options.add_argument("--write", action="store_true")
    options = options.parse_args()

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        logs = {count: record(options.tool, folder, count) for count in SAMPLES}
        by_samples = [(count, *diagnose(options.tool, folder, log)) for count, log in logs.items()]
        by_effects = [(f"{count}", *diagnose(options.tool, folder, logs[AT], EFFECTS[:count])) for count in COUNTS]
        by_effects.append(("all", *next(row[1:] for row in by_samples if row[0] == AT)))

        per_samples = exponent([row[0] for row in by_samples], [row[2] for row in by_samples])
        per_candidates = exponent([row[1] for row in by_effects], [row[2] for row in by_effects])
        head = ("candidates", "s", "s of the processors", "named")

        def cells(label, row):
            return (label, f"{row[1]:,}", f"{row[2]:.1f}", f"{row[3]:.1f}", row[4])

        whole = next(row[2] for row in by_samples if row[0] == AT)
        text = "\n".join(
            (
                markdown(("samples", *head), [cells(f"{row[0]:,}", row) for row in by_samples]),
                "",
                f"All effects. The time grows with the samples to the power of {per_samples:.2f}; {AT:,} samples took "
                f"{whole:.1f} s, the goal is at most {GOAL_SECONDS:.0f} s.",
                "",
                markdown(("effects", *head), [cells(row[0], row) for row in by_effects]),
                "",
                f"{AT:,} samples. The time grows with the candidates to the power of {per_candidates:.2f}.",
                "",
                f"{measure.processor()}, {os.cpu_count()} processors; {measure.system_name()}; {measure.first_line('c++', '--version')}. "
                f"{datetime.date.today().isoformat()}.",
            )
        )
        print(text)
        if options.write:
            for table, rows, column in (("samples", by_samples, 0), ("candidates", by_effects, 1)):
                with (folder / f"{table}.csv").open("w", newline="") as file:
                    csv.writer(file).writerows([(table, "seconds"), *((row[column], row[2]) for row in rows)])
            picture = ROOT / "docs" / "pictures" / "diagnosis_growth.png"
            subprocess.run(["gnuplot", "-c", HERE / "growth.gp", folder, picture, str(GOAL_SECONDS)], check=True)
            (ROOT / "docs" / "diagnosis-growth.md").write_text(
                "# How the time of a diagnosis grows\n\nPrinted by `bench/diagnosis/growth.py --write`, which says what is measured.\n\n"
                "![Seconds over samples and over candidates](pictures/diagnosis_growth.png)\n\n" + text + "\n"
            )
    grown = max(per_samples, per_candidates)
    return 1 if whole > GOAL_SECONDS or grown > MOST_GROWTH else 0


if __name__ == "__main__":
    sys.exit(main())
