"""Runs the benchmarks and their rivals, and prints one table of ratios beside the goals.

usage: report.py PROGRAM [--write]

PROGRAM is hysteron_bench. --write also writes docs/benchmarks.md. Exit code 1 where a goal is missed.
"""

import datetime
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
REPETITIONS = 12


def run_benchmarks(program, folder):
    """Processor time in seconds, real time where several threads work, by name: the least of the repetitions, which are
    interleaved at random."""
    output = pathlib.Path(folder) / "benchmarks.json"
    subprocess.run(
        [
            program,
            f"--benchmark_repetitions={REPETITIONS}",
            "--benchmark_enable_random_interleaving=true",
            "--benchmark_min_time=0.1",
            "--benchmark_out_format=json",
            f"--benchmark_out={output}",
        ],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    best, solutions, left_out = {}, {}, []
    for run in json.loads(output.read_text())["benchmarks"]:
        if run.get("run_type") != "iteration":
            continue
        name = run["run_name"]
        if run.get("error_occurred"):
            if not run["error_message"].startswith("left out: "):
                sys.exit(f"{name}: {run['error_message']}")
            left_out = [f"{name} is {run['error_message']}."]
            continue
        real = name.endswith("/real_time")
        name = name.removesuffix("/real_time")
        seconds = run["real_time" if real else "cpu_time"] * units[run["time_unit"]]
        best[name] = min(best.get(name, float("inf")), seconds)
        if "C3" in run:
            solutions[name] = [run["C1"], run["C2"], run["C3"]]
    return best, solutions, left_out


def run_scipy(program, folder):
    subprocess.run([program, "--write-static-map-data", folder], check=True)
    one_thread = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    done = subprocess.run(
        ["/usr/bin/python3", str(HERE / "static_fit_scipy.py"), folder],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, **one_thread},
    )
    return json.loads(done.stdout)


def fastest_rival(fits, points, solution):
    """The fastest fit that came to our solution; a fast wrong one is no rival."""

    def agrees(fit):
        return all(abs(a - b) <= 1e-4 * abs(b) for a, b in zip(fit["solution"], solution))

    found = [fit for fit in fits if fit["points"] == points and agrees(fit)]
    if not found:
        sys.exit(f"scipy and the static fit differ at {points} points")
    return min(found, key=lambda fit: fit["seconds"])


def duration(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


class Table:
    def __init__(self):
        self.rows = []
        self.missed = False

    def add(self, what, ours, rival, figure, value, goal, at_least=False):
        """A row; value and goal are ratios or seconds, and value may be at most (at least) the goal."""
        met = value >= goal if at_least else value <= goal
        self.missed = self.missed or not met
        self.rows.append((what, ours, rival, figure, ("≥ " if at_least else "≤ ") + f"{goal:g}", "met" if met else "MISSED"))

    def text(self):
        head = ("what", "ours", "beside", "figure", "goal", "")
        rows = [head, tuple("---" for _ in head), *self.rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
        lines = []
        for row in rows:
            cells = [("-" * width if cell == "---" else cell.ljust(width)) for cell, width in zip(row, widths)]
            lines.append("| " + " | ".join(cells) + " |")
        return "\n".join(lines)


def tabulate(best, solutions, scipy):
    samples = 20_000
    table = Table()

    def ratio(what, ours, rival, goal):
        value = best[ours] / best[rival]
        table.add(what, duration(best[ours] / samples), duration(best[rival] / samples), f"{value:.3f} ×", value, goal)

    ratio("generated step : hand-written", "step/generated", "step/hand_written", 1.05)
    ratio("interpreted step : generated", "step/interpreted", "step/generated", 2.0)
    if "step/fmu" in best:
        ratio(f"step of an FMU : generated; {samples / best['step/fmu'] / 1e6:.3g} million steps a second", "step/fmu", "step/generated", 1.5)

    instances = 128
    for name, what in (("same_bits", "the bits of the step"), ("fast", "libmvec")):
        for lanes, goal in ((8, 6e-9), (4, 10e-9), (2, None)):
            run = f"batch/{name}/{lanes}"
            if run in best:
                ours = best[run] / samples / instances
                one = best["step/generated"] / samples
                asked = goal / one if goal and name == "fast" else 1.0
                table.add(f"batch of {lanes} lanes, {what} : generated", duration(ours), duration(one), f"{ours / one:.3f} ×", ours / one, round(asked, 3))

    dual = best["dual/dual"] / best["dual/double"]
    jet = best["dual/jet"] / best["dual/double"]
    table.add("dual of 3 : double, against Jet : double", f"{dual:.2f} ×", f"{jet:.2f} ×", f"{dual / jet:.3f} ×", dual / jet, 2.0)

    used = set()
    for points in (200, 10_000, 1_000_000):
        name = f"static_fit/{points}"
        rival = fastest_rival(scipy["fits"], points, solutions[name])
        used.add(rival["options"])
        faster = rival["seconds"] / best[name]
        table.add(
            f"scipy : static fit, {points:,} points",
            duration(best[name]),
            duration(rival["seconds"]),
            f"{faster:.1f} × faster",
            faster,
            2.0,
            at_least=True,
        )

    if "output_error_fit" in best:
        seconds = best["output_error_fit"]
        table.add("output-error fit of the PICMA record", duration(seconds), "", duration(seconds), seconds, 1.0)

    for name, what in (("of_plain_blocks", "plain blocks"), ("of_hystereses", "a fifth hystereses")):
        ten, hundred = best[f"{name}/10000"], best[f"{name}/100000"]
        table.add(f"check and generate 100,000: {what}", duration(hundred), "", duration(hundred), hundred, 2.0)
        growth = hundred / ten
        table.add("  time of 100,000 : of 10,000", duration(hundred), duration(ten), f"{growth:.1f} ×", growth, 15.0)
    return table, sorted(used)


def machine():
    model = platform.machine()
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    return f"{model}, {os.cpu_count()} processors; {platform.system()}; {compiler}"


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        best, solutions, left_out = run_benchmarks(program, folder)
        scipy = run_scipy(program, folder)
    table, used = tabulate(best, solutions, scipy)
    lines = [
        table.text(),
        "",
        f"Processor time, real time of check and generate, the least of {REPETITIONS} interleaved repetitions. scipy {scipy['scipy']}, numpy {scipy['numpy']}, "
        f"one thread; the fastest of all options tried: {'; '.join(used)}.",
        *left_out,
        f"{machine()}. {datetime.date.today().isoformat()}.",
    ]
    print("\n".join(lines))
    if "--write" in sys.argv[2:]:
        page = HERE.parent / "docs" / "benchmarks.md"
        title = "# Benchmarks\n\nPrinted by `scripts/bench --write`; how to read them: [bench/README.md](../bench/README.md).\n\n"
        page.write_text(title + "\n".join(lines) + "\n")
    return 1 if table.missed else 0


if __name__ == "__main__":
    sys.exit(main())
