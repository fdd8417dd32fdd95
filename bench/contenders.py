"""Contenders for the step: libraries that are compiled here and timed by hysteron_bench, and programs that time themselves.

Equality comes first: whose outputs are further from ours than rounding is not timed."""

import array
import ctypes
import subprocess

import measure
from measure import HERE, ROOT, Place, Row

RIVALS = HERE / "rivals"
STEPS_OF_ROUND = 20_000
LARGEST_DIFFERENCE = 1e-9


class NotThere(Exception):
    """Why a contender takes no part."""


def write_data():
    """signal.bin and the points of static maps, as hysteron_bench has them."""
    Place.work().mkdir(parents=True, exist_ok=True)
    subprocess.run([Place.program(), "--data", Place.work()], check=True)


def generate(diagram, target, folder):
    """`diagram` is a file, or the name of one of bench/."""
    path = HERE / f"{diagram}.st" if isinstance(diagram, str) else diagram
    subprocess.run([Place.tool(), "generate", path, "--target", target, "--out", folder], check=True,
                   stdout=subprocess.DEVNULL)


def compile_library(source, library, options, what, more=()):
    compiler = "cc" if source.suffix == ".c" else "c++"
    wrong = measure.compiler_says([compiler, *options, "-fPIC", "-shared", f"-I{ROOT}", source, *more, "-o", library, "-lm"],
                                  what)
    if wrong:
        raise NotThere(wrong)


def time_libraries(folder, rounds, quick):
    """Rows of folder/DIAGRAM/NAME.so and of the interpreter on each DIAGRAM, interleaved at random."""
    repetitions = 3 if quick else measure.REPETITIONS
    for name, repetition, seconds, run, error in measure.run_benchmarks(
            "^contender/", ("--contenders", str(folder), str(rounds)), repetitions):
        _, diagram, contender = name.split("/")
        if not error:
            yield Row(diagram, contender, repetition, run["work"], seconds, run["difference"])
        elif repetition == 0:
            yield Row(diagram, contender, note=error)


def outputs_of(library, signal=None):
    """What a compiled step gives over the signal of hysteron_bench, or over another."""
    loaded = ctypes.CDLL(str(library))
    signal = array.array("d", signal or (Place.work() / "signal.bin").read_bytes())
    outputs = array.array("d", bytes(8 * len(signal)))
    address = lambda numbers: ctypes.c_void_p(numbers.buffer_info()[0])
    loaded.contender_reset()
    loaded.contender_run(address(signal), address(outputs), ctypes.c_long(len(signal)))
    return outputs


def time_program(subject, name, command, wanted, rounds, version, work=None):
    """Rows of a program that reads the signal, `rounds` times over, writes its outputs and prints the seconds of each
    repetition. `command` makes the command of both paths."""
    signal, outputs = Place.work() / f"{name}_signal.bin", Place.work() / f"{name}_outputs.bin"
    signal.write_bytes((Place.work() / "signal.bin").read_bytes() * rounds)
    done = subprocess.run(list(map(str, command(signal, outputs))), check=True, capture_output=True, text=True)
    got = array.array("d", outputs.read_bytes()[: 8 * len(wanted)])
    apart = max(abs(a - b) for a, b in zip(wanted, got)) / max(map(abs, wanted))
    if not apart <= LARGEST_DIFFERENCE:
        yield Row(subject, name, version=version, note="other outputs than the interpreter's: not timed")
        return
    for repetition, line in enumerate(done.stdout.split()):
        yield Row(subject, name, repetition, float(work or rounds * STEPS_OF_ROUND), float(line), apart, version)
