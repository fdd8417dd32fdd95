#!/usr/bin/python3
"""What a step costs: the paper's feedforward and the same without pow, by us and by whoever else can run it.

Each contender that is compiled becomes a library (bench/rivals/contender.h), which hysteron_bench loads and runs for 12
repetitions of 10,000,000 steps, interleaved at random. Before that, its outputs are compared with the interpreter's."""

import shutil
import subprocess
import sys
from xml.etree import ElementTree

import contenders
import measure
from contenders import RIVALS, STEPS_OF_ROUND, NotThere, compile_library, generate
from measure import FAST, FLAGS, ROOT, Contender, Goal, Place

sys.path.insert(0, str(ROOT / "scripts"))
from iec_compilers import Matiec, Strucpp  # noqa: E402

NAME = "step"
TITLE = "A step"
UNIT = "a step"
SUBJECTS = {"feedforward": "the paper's feedforward", "feedforward_without_pow": "the same without pow"}
OURS = " ".join(FLAGS)
FREE = " ".join(FAST)
IEC_FLAGS = (*FLAGS, "-w", "-fwrapv", "-DBLOCK=FEEDFORWARD", "-DINPUT=Y_REF", "-DOUTPUT=U")

CONTENDERS = {
    "generated_cpp": Contender("generated C++", OURS, "the flags of the project", "bench/rivals/generated_cpp.cpp", True),
    "generated_c": Contender("generated C99", "-std=c99 " + OURS, "the same", "bench/rivals/generated_c.c", True),
    "generated_native": Contender("generated C++, this processor", OURS + " -march=native",
                                  "same bits; it refuses -ffast-math", "bench/rivals/generated_cpp.cpp", True),
    "interpreter": Contender("interpreter", OURS, "`hysteron run`", "codegen/interpreter", True),
    "fmu": Contender("our FMU, FMI 3.0", "-std=c99 " + OURS, "an input set, a step done, an output read",
                     "bench/rivals/fmu.c", True),
    "hand_written": Contender("hand-written C++", OURS, "the flags of the project", "bench/hand_written.hpp"),
    "hand_written_fast": Contender("hand-written, bits free", FREE, "the most that a compiler can do here",
                                   "bench/hand_written.hpp"),
    "faust": Contender("Faust", f"`faust -double`, {OURS}", "our flags; its own rewriting stays",
                       "bench/rivals/feedforward.dsp"),
    "faust_fast": Contender("Faust, bits free", f"`faust -double`, {FREE}", "the flags that its own scripts use",
                            "bench/rivals/feedforward.dsp"),
    "matiec": Contender("MATIEC", f"-std=gnu99 {OURS} -fwrapv", "our flags; DINT wraps", "bench/rivals/matiec.c"),
    "strucpp": Contender("STruC++", f"-std=c++17 {OURS} -fwrapv", "our flags; DINT wraps", "bench/rivals/strucpp.cpp"),
    "python": Contender("Python", "3 repetitions of 1,000,000 steps", "the same arithmetic, sample by sample",
                        "bench/rivals/feedforward.py"),
    "octave": Contender("Octave", "3 repetitions of 100,000 steps", "the same arithmetic, sample by sample",
                        "bench/rivals/feedforward.m"),
}


def variant_flags(diagram):
    return ("-DWITHOUT_POW",) if diagram.endswith("without_pow") else ()


def build_ours(diagram, folder, libraries):
    made = folder / "made"
    for target in ("cpp", "c"):
        generate(diagram, target, made)
    hand = ("-std=c++20", *variant_flags(diagram))
    compile_library(RIVALS / "generated_cpp.cpp", libraries / "generated_cpp.so", ("-std=c++20", *FLAGS, f"-I{made}"), "ours")
    compile_library(RIVALS / "generated_cpp.cpp", libraries / "generated_native.so", ("-std=c++20", *FLAGS, "-march=native", f"-I{made}"),
                    "ours")
    compile_library(RIVALS / "generated_c.c", libraries / "generated_c.so", ("-std=c99", *FLAGS, f"-I{made}"), "ours")
    compile_library(RIVALS / "hand_written.cpp", libraries / "hand_written.so", (*hand, *FLAGS), "ours")
    compile_library(RIVALS / "hand_written.cpp", libraries / "hand_written_fast.so", (*hand, *FAST), "ours")


def build_faust(diagram, folder, libraries):
    if not shutil.which("faust"):
        raise NotThere("faust is not installed (Debian package faust)")
    subprocess.run(["faust", "-double", "-cn", "mydsp", RIVALS / f"{diagram}.dsp", "-o", folder / "faust_code.hpp"],
                   check=True, cwd=RIVALS)
    for name, flags in (("faust", FLAGS), ("faust_fast", FAST)):
        compile_library(RIVALS / "faust.cpp", libraries / f"{name}.so", ("-std=c++17", *flags, f"-I{folder}"), "Faust's C++")
    return measure.first_line("faust", "--version").removeprefix("FAUST Version ")


def structured_text(diagram, folder):
    generate(diagram, "st", folder)
    return folder / "feedforward.st"


def build_matiec(diagram, folder, libraries):
    compiler = Matiec.found()
    if not compiler:
        raise NotThere("MATIEC is not built beside (HYSTERON_MATIEC)")
    wrong = compiler.translate(structured_text(diagram, folder), folder)
    if wrong:
        raise NotThere("MATIEC says: " + wrong)
    compile_library(RIVALS / "matiec.c", libraries / "matiec.so",
                    ("-std=gnu99", *IEC_FLAGS, f"-I{compiler.folder}/lib/C", f"-I{folder}"), "MATIEC's C")
    return repository_version(compiler.folder)


def build_strucpp(diagram, folder, libraries):
    compiler = Strucpp.found()
    if not compiler or not shutil.which("node"):
        raise NotThere("STruC++ is not built beside (HYSTERON_STRUCPP)")
    wrong = compiler.translate(structured_text(diagram, folder), folder)
    if wrong:
        raise NotThere("STruC++ says: " + wrong)
    compile_library(RIVALS / "strucpp.cpp", libraries / "strucpp.so",
                    ("-std=c++17", *IEC_FLAGS, f"-I{compiler.folder}/src/runtime/include", f"-I{folder}"), "STruC++'s C++",
                    sorted(folder.glob("block*.cpp")))
    return repository_version(compiler.folder)


def repository_version(folder):
    return measure.first_line("git", "-C", str(folder), "log", "-1", "--format=%h of %as")


def build_fmu(diagram, folder, libraries):
    generate(diagram, "fmu", folder)
    shutil.unpack_archive(next(folder.glob("*.fmu")), folder / "fmu", "zip")
    described = ElementTree.parse(folder / "fmu/modelDescription.xml").getroot()
    reference = {one.get("name"): one.get("valueReference") for one in described.find("ModelVariables")}
    step = described.find("CoSimulation").get("fixedInternalStepSize") or described.find("DefaultExperiment").get("stepSize")
    given = (f'-DFMU_TOKEN_OF_BENCH="{described.get("instantiationToken")}"', f"-DFMU_PERIOD={step}",
             f"-DFMU_INPUT={reference['Y_REF']}", f"-DFMU_OUTPUT={reference['U']}")
    compile_library(RIVALS / "fmu.c", libraries / "fmu.so", ("-std=c99", *FLAGS, *given), "the FMU",
                    sorted((folder / "fmu/sources").glob("*.c")))
    return ""


BUILDERS = {("faust", "faust_fast"): build_faust, ("matiec",): build_matiec, ("strucpp",): build_strucpp,
            ("fmu",): build_fmu}


def of_program(name, command, diagram, rounds, version):
    """Rows of a program in an interpreted language."""
    variant = ["--without-pow"] if variant_flags(diagram) else []
    wanted = contenders.outputs_of(Place.work() / "steps" / diagram / "generated_cpp.so")
    yield from contenders.time_program(diagram, name, lambda signal, outputs: [*command, signal, outputs, str(STEPS_OF_ROUND),
                                                                               "3", *variant],
                                       wanted, rounds, version)


def build(diagram, libraries):
    """All libraries of a diagram; the versions of rivals by name, and the rows of those that take no part."""
    versions, absent = {}, []
    folder = Place.work() / f"build_{diagram}"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "ours").mkdir(parents=True)
    libraries.mkdir(parents=True)
    build_ours(diagram, folder / "ours", libraries)
    for names, builder in BUILDERS.items():
        place = folder / names[0]
        place.mkdir()
        try:
            version = builder(diagram, place, libraries)
            versions.update(dict.fromkeys(names, version))
        except NotThere as why:
            absent += [measure.left_out(diagram, name, str(why)) for name in names]
    return versions, absent


def run(quick):
    steps = Place.work() / "steps"
    shutil.rmtree(steps, ignore_errors=True)
    contenders.write_data()
    versions = {}
    for diagram in SUBJECTS:
        versions[diagram], absent = build(diagram, steps / diagram)
        yield from absent
    for row in contenders.time_libraries(steps, 10 if quick else 500, quick):
        row.version = versions[row.subject].get(row.contender, "")
        yield row
    for diagram in SUBJECTS:
        yield from of_program("python", [sys.executable, RIVALS / "feedforward.py"], diagram, 1 if quick else 50,
                              sys.version.split()[0])
        if shutil.which("octave-cli"):
            yield from of_program("octave", ["octave-cli", "--norc", RIVALS / "feedforward.m"], diagram, 1 if quick else 5,
                                  measure.debian_version("octave"))
        else:
            yield measure.left_out(diagram, "octave", "octave is not installed (Debian package octave)")


def tables(rows):
    for subject, title in SUBJECTS.items():
        yield title[0].upper() + title[1:], measure.comparison(rows, subject, CONTENDERS, "generated_cpp")


def goals(rows):
    result = []
    for subject, title in SUBJECTS.items():
        for ours, against, limit in (("generated_cpp", "hand_written", 1.05), ("generated_c", "hand_written", 1.05),
                                     ("interpreter", "generated_cpp", 2.0), ("fmu", "generated_cpp", 1.5)):
            a, b = measure.least(rows, subject, ours), measure.least(rows, subject, against)
            if a and b and (subject == "feedforward" or against == "hand_written"):
                result.append(Goal(f"{CONTENDERS[ours].label} : {CONTENDERS[against].label}, {title}", a / b, limit))
    return result


def losses(rows):
    for subject, title in SUBJECTS.items():
        yield from measure.losses(rows, subject, CONTENDERS, "generated_cpp", title)


if __name__ == "__main__":
    sys.exit(measure.main(sys.modules[__name__]))
