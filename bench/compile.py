#!/usr/bin/python3
"""What it costs to come from the text of a diagram to code that runs, by the number of its instances.

The diagram is a chain of groups of five: gain, limiter, lag, lead-lag and delay, with a feedback in each group. Within
hysteron_bench our own times are of 12 repetitions, interleaved at random; of a million instances there is one. Beside rivals
all are times of whole commands, three repetitions, one where it takes more than 10 s. All are processor times of all threads.
The outputs are compared before."""

import csv
import resource
import shutil
import subprocess
import sys

import contenders
import measure
from contenders import RIVALS, NotThere
from measure import ROOT, Contender, Goal, Place, Row

sys.path.insert(0, str(ROOT / "scripts"))
from iec_compilers import Matiec, Strucpp  # noqa: E402

NAME = "compile"
TITLE = "From text to running code"
UNIT = "a text"
INSIDE = (10, 100, 1_000, 10_000, 100_000, 1_000_000)
BESIDE = (10, 1_000, 100_000)
LIMIT = 120  # seconds a command
OPTIMISED = ("-O2", "-ffp-contract=off", "-frounding-math")
LIBRARY = ("-fPIC", "-shared")
NAMES = ("-DBLOCK=MANY", "-DINPUT=X", "-DOUTPUT=Y")
STEPS = 200

CONTENDERS = {
    "header": Contender("text to C++ header", "within hysteron_bench", "read, checked, scheduled, printed", "bench/instances_bench.cpp", True),
    "interpreter": Contender("text to the interpreter's first step", "within hysteron_bench", "read, checked, scheduled, run",
                             "bench/instances_bench.cpp", True),
    "header_of_hystereses": Contender("text to C++ header, a fifth hystereses", "within hysteron_bench",
                                      "blocks of fifty operations", "bench/instances_bench.cpp", True),
    "ours_run": Contender("hysteron run", "a record of 200 rows", "the interpreter: no compiler of the target", "", True),
    "ours_cpp": Contender("hysteron, to C++", "`generate --target cpp`", "", "", True),
    "ours_cpp_compiled": Contender("hysteron, to machine code", "the same, then `c++ " + " ".join(OPTIMISED) + "`", "", "", True),
    "faust": Contender("Faust, to C++", "`faust -double`", "", "bench/compile.py"),
    "faust_compiled": Contender("Faust, to machine code", "the same, then `c++ " + " ".join(OPTIMISED) + "`", "", "bench/compile.py"),
    "matiec": Contender("MATIEC, to C", "`iec2c`", "reads our one block of Structured Text", ""),
    "matiec_compiled": Contender("MATIEC, to machine code", "the same, then `cc " + " ".join(OPTIMISED) + "`", "", "bench/rivals/matiec.c"),
    "strucpp": Contender("STruC++, to C++", "its command line, by node", "reads our one block of Structured Text", ""),
    "strucpp_compiled": Contender("STruC++, to machine code", "the same, then `c++ " + " ".join(OPTIMISED) + "`", "", "bench/rivals/strucpp.cpp"),
}

# The blocks of the chain in Faust, with the equations of ours.
FAUST_BLOCKS = """TS = 0.001;
started = 1 : mem;
// The rate of a signal behind a lag T, exact for an input that runs straight between the samples.
rate(T, x) = filter ~ _
with {
  filter(before) = before + forgotten(T) * (started * (x - x') / TS - before);
};
forgotten(0) = 1;
forgotten(T) = 1 - exp(0 - TS / T);
lag(T1, x) = x - T1 * rate(T1, x);
lead_lag(T1, T2, x) = x + (T1 - T2) * rate(T2, x);
"""


def inside_subject(instances):
    return f"{instances:,} instances, within the program"


def beside_subject(instances):
    return f"{instances:,} instances, whole commands"


class TooLong(Exception):
    """A command that did not end in time."""


def processor_time(command, **options):
    """Seconds of processor time of a command and all that it starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=LIMIT, **options)
    except subprocess.TimeoutExpired:
        raise TooLong(f"not within {LIMIT} s") from None
    if done.returncode:
        raise NotThere("refused: " + (done.stderr.strip().splitlines() or ["no word"])[0][:120])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def faust_text(instances):
    groups = instances // 5
    steps = "".join(f"g{k}(x) = loop ~ _ with {{ loop(held) = 0.9 * (x - 0.25 * held) : min(1e300) : max(-1e300) : lag(0.01) : "
                    "lead_lag(0, 0); };\n" for k in range(groups))
    chain = "\n  : ".join(f"g{k}" for k in range(groups))
    return FAUST_BLOCKS + steps + f"process = {chain};\n"


class Folder:
    """Where one contender works on one text."""

    def __init__(self, name, instances):
        self.path = Place.work() / "texts" / f"{name}_{instances}"
        shutil.rmtree(self.path, ignore_errors=True)
        self.path.mkdir(parents=True)
        self.text = Place.work() / f"instances_{instances}.st"
        self.instances = instances

    def structured_text(self):
        """The one block, printed before anything is timed."""
        out = self.path / "st"
        subprocess.run([Place.tool(), "generate", self.text, "--target", "st", "--out", out], check=True, stdout=subprocess.DEVNULL)
        return out / "many.st"


def compile_ours(folder):
    made = folder.path / "made"
    yield "ours_cpp", processor_time([Place.tool(), "generate", folder.text, "--target", "cpp", "--out", made])
    yield "ours_cpp_compiled", processor_time(["c++", "-std=c++17", *OPTIMISED, *LIBRARY, f"-I{ROOT}", f"-I{made}",
                                               RIVALS / "many.cpp", "-o", folder.path / "ours_cpp.so"])


def run_ours(folder):
    record = folder.path / "in.csv"
    record.write_text("t,X\n" + "".join(f"{k * 0.001:.3f},{x!r}\n" for k, x in enumerate(stimulus())))
    yield "ours_run", processor_time([Place.tool(), "run", folder.text, "--in", record, "--out", folder.path / "out.csv"])


def compile_faust(folder):
    if not shutil.which("faust"):
        raise NotThere("faust is not installed (Debian package faust)")
    text = folder.path / "many.dsp"
    text.write_text(faust_text(folder.instances))
    code = folder.path / "faust_code.hpp"
    yield "faust", processor_time(["faust", "-double", "-cn", "mydsp", text, "-o", code])
    library = folder.path / "faust.so"
    yield "faust_compiled", processor_time(["c++", "-std=c++17", *OPTIMISED, *LIBRARY, f"-I{ROOT}", f"-I{folder.path}",
                                            RIVALS / "faust.cpp", "-o", library])


def compile_matiec(folder):
    compiler = Matiec.found()
    if not compiler:
        raise NotThere("MATIEC is not built beside (HYSTERON_MATIEC)")
    source = folder.structured_text()
    yield "matiec", processor_time(compiler.command(source, folder.path))
    yield "matiec_compiled", processor_time(["cc", "-std=gnu99", "-w", "-fwrapv", *OPTIMISED, f"-I{compiler.folder}/lib/C",
                                             f"-I{folder.path}", f"-I{ROOT}", *LIBRARY, *NAMES, RIVALS / "matiec.c", "-o",
                                             folder.path / "matiec.so", "-lm"])


def compile_strucpp(folder):
    compiler = Strucpp.found()
    if not compiler or not shutil.which("node"):
        raise NotThere("STruC++ is not built beside (HYSTERON_STRUCPP)")
    source = folder.structured_text()
    yield "strucpp", processor_time(compiler.command(source, folder.path))
    yield "strucpp_compiled", processor_time(["c++", "-std=c++17", "-w", "-fwrapv", *OPTIMISED, f"-I{compiler.folder}/src/runtime/include",
                                              f"-I{folder.path}", f"-I{ROOT}", *LIBRARY, *NAMES, RIVALS / "strucpp.cpp",
                                              *sorted(folder.path.glob("block*.cpp")), "-o",
                                              folder.path / "strucpp.so"])


def stimulus():
    """Steps of many heights."""
    return [float((k // 20 * 7) % 11 - 5) for k in range(STEPS)]


def outputs_of(library):
    return contenders.outputs_of(library, stimulus())


def apart(folder, library):
    """The largest difference from `hysteron run`, as a share of the largest output."""
    with open(folder.path.parent / f"ours_run_{folder.instances}" / "out.csv", newline="") as file:
        wanted = [float(row["Y"]) for row in csv.DictReader(file)]
    return max(abs(a - b) for a, b in zip(wanted, outputs_of(library))) / max(map(abs, wanted))


BUILDERS = {"ours_run": run_ours, "ours_cpp": compile_ours, "faust": compile_faust, "matiec": compile_matiec,
            "strucpp": compile_strucpp}


def names_of(name):
    """A contender's rows: its translation, and that with the compiler behind it."""
    return [one for one in CONTENDERS if one in (name, name + "_compiled")]


def whole_commands(name, build, instances, repetitions, before, fewer):
    """Rows of one contender on one text. What the compiler cannot end in time, by what it took before, is not tried."""
    subject, names = beside_subject(instances), names_of(name)
    skipped = hopeless(before, instances, fewer, names[-1])
    for repetition in range(repetitions):
        folder = Folder(name, instances)
        total, done = 0.0, []
        try:
            for contender, seconds in build(folder):
                total += seconds
                done.append(Row(subject, contender, repetition, 1.0, total))
                if skipped and contender != names[-1]:
                    raise TooLong(skipped)
        except (NotThere, TooLong) as why:
            note = str(why) if isinstance(why, TooLong) else f"left out: {why}"
            yield from done
            yield from (Row(subject, one, note=note) for one in names[len(done):])
            return
        library = folder.path / f"{name}.so"
        if library.exists():
            done[-1].difference = apart(folder, library)
            if done[-1].difference > contenders.LARGEST_DIFFERENCE:
                yield from (Row(subject, one, note="other outputs than ours: not timed") for one in names)
                return
        yield from done
        if total > 10.0:
            return


def hopeless(rows, instances, fewer, name):
    """Why a text is not tried: where a hundred times what fewer instances took is beyond the limit."""
    times = [measure.least(rows, beside_subject(fewer), name)] if fewer else []
    if times and times[0] and times[0] * instances / fewer > LIMIT:
        return f"not tried: {fewer:,} instances took {measure.duration(times[0])}"
    return None


def run(quick):
    contenders.write_data()
    for instances in INSIDE[:-2] if quick else INSIDE:
        repetitions = 2 if quick else measure.REPETITIONS if instances <= 100_000 else 1
        for name, repetition, seconds, _, error in measure.run_benchmarks(f"^text/.*/{instances}/", (), repetitions):
            yield Row(inside_subject(instances), name.split("/")[1], repetition, 1.0, seconds, note=error)
    rows, fewer = [], None
    for instances in BESIDE[:2] if quick else BESIDE:
        for name, build in BUILDERS.items():
            why = hopeless(rows, instances, fewer, name)
            if why:
                rows += (Row(beside_subject(instances), one, note=why) for one in names_of(name))
            else:
                rows += whole_commands(name, build, instances, 1 if quick else 3, rows, fewer)
        fewer = instances if instances >= 1_000 else None  # below, most of the time does not grow
    yield from rows


def tables(rows):
    yield "Within the program, without any compiler of the target", growth_table(rows)
    for instances in BESIDE:
        subject = beside_subject(instances)
        if any(row.subject == subject for row in rows):
            base = "ours_cpp_compiled" if measure.least(rows, subject, "ours_cpp_compiled") else "ours_cpp"
            yield subject, measure.comparison(rows, subject, CONTENDERS, base)


def growth_table(rows):
    """The time by instances, and its growth from line to line."""
    names = ("interpreter", "header", "header_of_hystereses")
    lines, before = [], None
    for instances in INSIDE:
        each = [measure.least(rows, inside_subject(instances), name) for name in names]
        if None in each:
            continue
        grown = ["" if before is None else f"{now / then:.1f} ×" for now, then in zip(each, before or each)]
        lines.append((f"{instances:,}", *(cell for pair in zip(map(measure.duration, each), grown) for cell in pair)))
        before = each
    head = [cell for name in names for cell in (CONTENDERS[name].label, "growth")]
    return measure.text_table(("instances", *head), lines)


def goals(rows):
    result = []
    for name in ("header", "header_of_hystereses", "interpreter"):
        label = CONTENDERS[name].label
        time = {n: measure.least(rows, inside_subject(n), name) for n in INSIDE}
        if time[100_000]:
            result.append(Goal(f"100,000 instances, {label}", time[100_000], 1.5, "s"))
        for fewer, more in ((10_000, 100_000), (100_000, 1_000_000)):
            if time[fewer] and time[more]:
                result.append(Goal(f"{more:,} : {fewer:,} instances, {label}", time[more] / time[fewer], 11.0))
    return result


def losses(rows):
    for instances in BESIDE:
        subject = beside_subject(instances)
        for kind in ("ours_cpp", "ours_cpp_compiled"):
            rivals = {name: one for name, one in CONTENDERS.items()
                      if name.endswith("_compiled") == kind.endswith("_compiled")}
            yield from measure.losses(rows, subject, rivals, kind)


if __name__ == "__main__":
    sys.exit(measure.main(sys.modules[__name__]))
