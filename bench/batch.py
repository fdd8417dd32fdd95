#!/usr/bin/python3
"""What a step of one instance costs where many instances take it at once.

Each contender is a library with 128 or 10,000 instances of the paper's feedforward, an exponent each, over one reference.
hysteron_bench runs them for 12 repetitions, interleaved at random. The output of the instance with the exponent 0.7 is
compared with the interpreter's before."""

import shutil
import sys

import contenders
import measure
from contenders import RIVALS, NotThere, compile_library, generate
from measure import FAST, FLAGS, Contender, Goal, Place

NAME = "batch"
TITLE = "Many instances of one step"
UNIT = "an instance-step"
DIAGRAM = "feedforward"
SIZES = (128, 10_000)
BATCH_FLAGS = ("-std=c++17", "-O2", "-ffp-contract=off", "-frounding-math", "-fno-math-errno", "-Wno-psabi")
OF_LANES = {8: "AVX-512", 4: "AVX2", 2: "SSE2"}

CONTENDERS = {
    "generated_cpp": Contender("one instance, generated C++", " ".join(FLAGS), "what a batch is measured against",
                               "bench/rivals/generated_cpp.cpp", True),
    **{f"same_bits_{lanes}": Contender(f"batch, {lanes} lanes", " ".join(BATCH_FLAGS[1:-1]), f"{name}, the bits of the step",
                                       "bench/rivals/batch.cpp", True) for lanes, name in OF_LANES.items()},
    **{f"fast_{lanes}": Contender(f"batch, {lanes} lanes, libmvec", " ".join(BATCH_FLAGS[1:-1]) + " -DHYSTERON_BATCH_FAST",
                                  f"{name}, within 4 units in the last place", "bench/rivals/batch.cpp", True)
       for lanes, name in OF_LANES.items()},
    "hand_written": Contender("loop over arrays, by hand", " ".join(FAST),
                              "GCC makes vectors of it, and calls libmvec; sums are plain", "bench/rivals/batch_hand_written.cpp"),
    "numpy": Contender("numpy", "3 repetitions", "an array operation for each operation; sums are plain",
                       "bench/rivals/feedforward_numpy.py"),
}


def subject_of(size):
    return f"{size:,} instances"


def build(libraries):
    made = Place.work() / "build_batch"
    shutil.rmtree(made, ignore_errors=True)
    generate(DIAGRAM, "cpp", made)
    generate(DIAGRAM, "batch", made)
    compile_library(RIVALS / "generated_cpp.cpp", libraries / "generated_cpp.so", ("-std=c++20", *FLAGS, f"-I{made}"), "ours")
    for size in SIZES:
        given = (f"-DINSTANCES={size}", f"-I{made}")
        for lanes in OF_LANES:
            for name, flag in ((f"same_bits_{lanes}", ()), (f"fast_{lanes}", ("-DHYSTERON_BATCH_FAST",))):
                options = (*BATCH_FLAGS, *flag, f"-DLANES={lanes}", *given)
                try:
                    compile_library(RIVALS / "batch.cpp", libraries / f"{name}_of_{size}.so", options, "ours", ("-lmvec",))
                except NotThere as why:
                    yield measure.left_out(subject_of(size), name, str(why))
        compile_library(RIVALS / "batch_hand_written.cpp", libraries / f"hand_written_of_{size}.so",
                        ("-std=c++17", *FAST, *given), "the loop over arrays")


def run(quick):
    root = Place.work() / "batch"
    libraries = root / DIAGRAM
    shutil.rmtree(root, ignore_errors=True)
    libraries.mkdir(parents=True)
    contenders.write_data()
    yield from build(libraries)
    for row in contenders.time_libraries(root, 1 if quick else 8, quick):
        name, _, size = row.contender.partition("_of_")
        row.contender = name
        for one in SIZES if not size else (int(size),):
            row.subject = subject_of(one)
            if name != "interpreter":
                yield measure.copied(row)
    yield from numpy_rows(libraries, quick)


def numpy_rows(libraries, quick):
    try:
        import numpy
    except ImportError:
        yield from (measure.left_out(subject_of(size), "numpy", "numpy is not installed (Debian package python3-numpy)")
                    for size in SIZES)
        return
    wanted = contenders.outputs_of(libraries / "generated_cpp.so")
    for size in SIZES:
        samples = 200 if quick else max(256, 2_560_000 // size // 4)
        yield from contenders.time_program(
            subject_of(size), "numpy",
            lambda signal, outputs: [sys.executable, RIVALS / "feedforward_numpy.py", signal, outputs, size, samples, 3],
            wanted[:samples], 1, numpy.__version__, size * samples)


def tables(rows):
    for size in SIZES:
        yield subject_of(size), measure.comparison(rows, subject_of(size), CONTENDERS, "generated_cpp")


def goals(rows):
    result = []
    subject = subject_of(SIZES[0])
    for lanes, limit in ((8, 6e-9), (4, 10e-9)):
        time = measure.least(rows, subject, f"fast_{lanes}")
        if time:
            result.append(Goal(f"an instance-step with {OF_LANES[lanes]}, libmvec", time, limit, "s"))
    one = measure.least(rows, subject, "generated_cpp")
    for lanes in OF_LANES:
        time = measure.least(rows, subject, f"same_bits_{lanes}")
        if time:
            result.append(Goal(f"{lanes} lanes with the bits of the step : a step of one instance", time / one, 1.0))
    return result


def losses(rows):
    for size in SIZES:
        best = min((name for name in CONTENDERS if CONTENDERS[name].ours and measure.least(rows, subject_of(size), name)),
                   key=lambda name: measure.least(rows, subject_of(size), name))
        yield from measure.losses(rows, subject_of(size), CONTENDERS, best)


if __name__ == "__main__":
    sys.exit(measure.main(sys.modules[__name__]))
