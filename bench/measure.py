"""What the questions of bench/ share: runs of hysteron_bench and of outside programs, raw rows, tables, goals.

A row is one repetition of one contender on one subject: `subject,contender,repetition,work,seconds,difference,version,
note`. `work` is how many units (steps, instances, fits) the seconds are of. A contender that is not there has one row, whose
note begins with "left out: "."""

import argparse
import csv
import dataclasses
import datetime
import json
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent

RESULTS = ROOT / "docs" / "benchmarks"
REPETITIONS = 12
# What the project compiles itself with (CMakeLists.txt), in the build type Release.
FLAGS = ("-O3", "-DNDEBUG", "-ffp-contract=off", "-frounding-math")
# What a compiler may do where bits need not be kept.
FAST = ("-Ofast", "-DNDEBUG", "-march=native")


class Place:
    """Where hysteron and hysteron_bench are built, and what is compiled for a question."""

    build = ROOT / "build" / "bench"

    @classmethod
    def program(cls):
        return cls.build / "bench" / "hysteron_bench"

    @classmethod
    def tool(cls):
        return cls.build / "hysteron"

    @classmethod
    def work(cls):
        return cls.build / "contenders"


@dataclasses.dataclass
class Row:
    subject: str
    contender: str
    repetition: int = 0
    work: float = 1.0
    seconds: float | None = None
    difference: float | None = None
    version: str = ""
    note: str = ""

    def each(self):
        return self.seconds / self.work


@dataclasses.dataclass
class Contender:
    """One who takes part: what it is called, what it was given and why, and where our source of it stands."""

    label: str
    options: str
    why: str = ""
    source: str = ""
    ours: bool = False


@dataclasses.dataclass
class Goal:
    what: str
    value: float
    limit: float
    unit: str = "×"
    at_least: bool = False

    def met(self):
        return self.value >= self.limit if self.at_least else self.value <= self.limit


def copied(row):
    return dataclasses.replace(row)


def left_out(subject, contender, why):
    return Row(subject, contender, note="left out: " + why)


def write_rows(question, rows, folder):
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / f"{question}.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(field.name for field in dataclasses.fields(Row))
        for row in rows:
            writer.writerow("" if value is None else f"{value:.9g}" if isinstance(value, float) else value
                            for value in dataclasses.astuple(row))


def read_rows(question, folder):
    number = lambda text: float(text) if text else None
    with open(folder / f"{question}.csv", newline="", encoding="utf-8") as file:
        return [Row(row["subject"], row["contender"], int(row["repetition"]), float(row["work"]), number(row["seconds"]),
                    number(row["difference"]), row["version"], row["note"]) for row in csv.DictReader(file)]


def processor():
    return next((line.split(":", 1)[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                 if line.startswith("model name")), platform.machine())


def write_machine(question, folder):
    """A line of machine.csv: what this question was measured on. Lines of other questions stay."""
    path = folder / "machine.csv"
    lines = read_machines(folder)
    lines[question] = {"question": question, "processor": processor(), "processors": os.cpu_count(),
                       "system": system_name(), "compiler": first_line("c++", "--version"),
                       "load": f"{os.getloadavg()[0]:.1f}", "date": datetime.date.today().isoformat()}
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(lines[question]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines[name] for name in sorted(lines))


def read_machines(folder):
    path = folder / "machine.csv"
    if not path.exists():
        return {}
    with open(path, newline="", encoding="utf-8") as file:
        return {row["question"]: row for row in csv.DictReader(file)}


def system_name():
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except OSError:
        return platform.system()


def first_line(*command):
    """The first line that a command prints; empty where it is not installed."""
    if not shutil.which(command[0]):
        return ""
    done = subprocess.run(command, capture_output=True, text=True)
    return next(iter((done.stdout + done.stderr).strip().splitlines()), "")


def debian_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], capture_output=True, text=True)
    return done.stdout.strip()


def compiler_says(command, what):
    """Compiles; a sentence where that fails, else None."""
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode == 0:
        return None
    errors = [line for line in done.stderr.splitlines() if "error" in line]
    return f"{what} does not compile: {(errors or [done.stderr.strip()])[0]}"


def run_program(command, **options):
    """What a program prints, and the most memory that it had, in bytes. It is asked while the program runs: what the system
    says afterwards begins with the memory of this script."""
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen(list(map(str, command)), stdout=output, stderr=errors, **options)
        peak = 0
        while process.poll() is None:
            peak = max(peak, most_memory(process.pid))
            time.sleep(0.02)
        output.seek(0)
        errors.seek(0)
        if process.returncode:
            sys.exit(f"{command[0]} ended with {process.returncode}: {errors.read().strip()}")
        return output.read(), peak


def most_memory(pid):
    try:
        lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM:")), 0)


def run_benchmarks(pattern, arguments=(), repetitions=REPETITIONS, least_seconds="0.1"):
    """The repetitions of Google Benchmark, interleaved at random: name, repetition, seconds of processor time, counters,
    error."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "benchmarks.json"
        _, peak = run_program(
            [Place.program(), *arguments, f"--benchmark_filter={pattern}", f"--benchmark_repetitions={repetitions}",
             "--benchmark_enable_random_interleaving=true", f"--benchmark_min_time={least_seconds}",
             "--benchmark_out_format=json", f"--benchmark_out={output}"])
        runs = json.loads(output.read_text())["benchmarks"]
    units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    for run in runs:
        if run.get("run_type") != "iteration":
            continue
        name = run["run_name"].removesuffix("/process_time").split("/iterations:")[0]
        seconds = run["cpu_time"] * units[run["time_unit"]]
        run["peak"] = peak
        yield name, run.get("repetition_index", 0), seconds, run, run.get("error_message", "")


def least(rows, subject, contender):
    """The least seconds a unit of work; None where there is no such row."""
    times = [row.each() for row in rows if (row.subject, row.contender) == (subject, contender) and row.seconds is not None]
    return min(times) if times else None


def subjects_of(rows):
    return list(dict.fromkeys(row.subject for row in rows))


def duration(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def times(ratio):
    return f"{ratio:,.0f} ×" if ratio >= 100 else f"{ratio:.3g} ×" if ratio >= 10 else f"{ratio:.2g} ×" if ratio < 0.1 else f"{ratio:.2f} ×"


def text_table(head, rows):
    rows = [head, tuple("---" for _ in head), *rows]
    widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
    return "\n".join("| " + " | ".join("-" * width if cell == "---" else cell.ljust(width)
                                       for cell, width in zip(row, widths)) + " |" for row in rows)


def comparison(rows, subject, contenders, base, apart_by="outputs differ by", equal="same bits"):
    """A table of one subject: each contender, its time a unit, its ratio to `base`, how its outputs differ."""
    against = least(rows, subject, base)
    lines = []
    for name, contender in contenders.items():
        mine = [row for row in rows if (row.subject, row.contender) == (subject, name)]
        if not mine:
            continue
        time = least(rows, subject, name)
        if time is None:
            lines.append((float("inf"), (contender.label, "", "", "", mine[0].note)))
            continue
        apart = max((row.difference for row in mine if row.difference is not None), default=None)
        outputs = "" if apart is None else equal if apart == 0.0 else f"{apart:.0e}"
        ratio = times(time / against) if against else ""
        lines.append((time, (contender.label, duration(time), ratio, outputs, mine[0].note)))
    lines.sort(key=lambda line: line[0])
    return text_table(("who", "time", f"against {contenders[base].label}", apart_by, ""),
                      [line for _, line in lines])


def losses(rows, subject, contenders, base, title=None):
    """A sentence for each rival that is faster than we are."""
    ours = least(rows, subject, base)
    for name, contender in contenders.items():
        time = least(rows, subject, name)
        if not contender.ours and time is not None and ours is not None and time < ours:
            yield f"{title or subject}: {contender.label} takes {time / ours:.2f} times what we take."


def goal_table(goals):
    return text_table(("goal", "figure", "asked for", ""), [
        (goal.what, figure(goal.value, goal.unit), ("≥ " if goal.at_least else "≤ ") + figure(goal.limit, goal.unit),
         "met" if goal.met() else "MISSED") for goal in goals])


def figure(value, unit):
    return duration(value) if unit == "s" else f"{value:.3g} {unit}"


def contender_table(contenders, rows):
    versions = {}
    for row in rows:
        versions.setdefault(row.contender, row.version)
    used = {row.contender for row in rows}
    return text_table(("who", "version", "what it was given", "why", "source"), [
        (one.label, versions.get(name, ""), one.options, one.why, one.source)
        for name, one in contenders.items() if name in used])


def report(question, rows):
    """What a question prints: its tables, goals and losses."""
    parts = []
    for heading, table in question.tables(rows):
        parts += [f"{heading}:", "", table, ""]
    goals = question.goals(rows)
    if goals:
        parts += [goal_table(goals), ""]
    lost = [*question.losses(rows), *missed(goals)]
    parts += ["Where we lose:", *(f"- {one}" for one in lost)] if lost else ["We lose nowhere here."]
    return "\n".join(parts)


def missed(goals):
    return [f"{goal.what}: {figure(goal.value, goal.unit)}, where {figure(goal.limit, goal.unit)} were asked for."
            for goal in goals if not goal.met()]


def options(description):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="also write the raw rows to docs/benchmarks/")
    parser.add_argument("--quick", action="store_true", help="a few runs each, to see whether all works")
    parser.add_argument("--build", type=pathlib.Path, default=Place.build, metavar="FOLDER",
                        help="where hysteron and hysteron_bench are built; by default build/bench")
    chosen = parser.parse_args()
    Place.build = chosen.build.resolve()
    return chosen


def main(question):
    """The command line of a question: prints its tables; exit code 1 where a goal is missed."""
    chosen = options(question.__doc__)
    rows = list(question.run(chosen.quick))
    print(report(question, rows))
    if chosen.write:
        write_rows(question.NAME, rows, RESULTS)
        write_machine(question.NAME, RESULTS)
    return 1 if missed(question.goals(rows)) else 0
