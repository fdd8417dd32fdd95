#!/usr/bin/python3
"""What a fit costs: a static map, and output error on a measured and on long simulated records, by us and by rivals.

Every contender starts at the same values. Of a fit that several options reach, each is a row. A fit counts where its sum of
squares is ours or lower, within 1e-6 of it: a fast wrong one is no rival."""

import array
import ctypes
import os
import shutil
import subprocess
import sys

import contenders
import measure
from contenders import RIVALS, NotThere, generate
from measure import FLAGS, HERE, ROOT, Contender, Goal, Place, Row

NAME = "fit"
TITLE = "A fit"
UNIT = "a fit"
OURS = " ".join(FLAGS)
WORSE_BY = 1e-6
POINTS = (200, 10_000, 1_000_000)
SAMPLES = (100_000, 1_000_000)

CONTENDERS = {
    "ours": Contender("ours", "defaults", "of a map no start is given; covariance included",
                      "bench/static_fit_bench.cpp, bench/output_error_bench.cpp", True),
    "ours_by_ipopt": Contender("ours, all by Ipopt", "`StaticMapMethod::Ipopt`", "three parameters at once, as rivals have them",
                               "bench/static_fit_bench.cpp", True),
    "scipy_lm": Contender("scipy, lm", "`method='lm'`; of output error `x_scale='jac'`", "MINPACK, differences",
                          "bench/rivals/static_map_scipy.py, bench/rivals/output_error_scipy.py"),
    "scipy_lm_exact": Contender("scipy, lm, exact", "`method='lm', jac=exact`", "", "bench/rivals/static_map_scipy.py"),
    "scipy_lm_unchecked": Contender("scipy, lm, exact, unchecked", "`method='lm', jac=exact, check_finite=False`",
                                    "no search for NaN", "bench/rivals/static_map_scipy.py"),
    "scipy_trf_unchecked": Contender("scipy, trf, exact, unchecked", "`method='trf', jac=exact, check_finite=False`", "",
                                     "bench/rivals/static_map_scipy.py"),
    "scipy_lm_start": Contender("scipy, lm, scaled by the start", "`method='lm', x_scale=abs(start)`", "compiled model by ctypes",
                                "bench/rivals/output_error_scipy.py"),
    "scipy_trf": Contender("scipy, trf", "`method='trf', x_scale='jac'`", "compiled model by ctypes",
                           "bench/rivals/output_error_scipy.py"),
    "scipy_trf_bounds": Contender("scipy, trf with bounds", "`method='trf', x_scale='jac', bounds`",
                                  "a lower bound each, as the blocks have", "bench/rivals/output_error_scipy.py"),
    "ceres_points_qr": Contender("Ceres, a cost a point, QR", "AutoDiffCostFunction, DENSE_QR",
                                 "as its tutorial; covariance included",
                                 "bench/rivals/static_map_ceres.cpp"),
    "ceres_points_cholesky": Contender("Ceres, a cost a point, Cholesky", "AutoDiffCostFunction, DENSE_NORMAL_CHOLESKY",
                                       "covariance included", "bench/rivals/static_map_ceres.cpp"),
    "ceres_one_qr": Contender("Ceres, one cost, QR", "exact Jacobian, DENSE_QR", "covariance included",
                              "bench/rivals/static_map_ceres.cpp"),
    "ceres_one_cholesky": Contender("Ceres, one cost, Cholesky", "exact Jacobian, DENSE_NORMAL_CHOLESKY", "covariance included",
                                    "bench/rivals/static_map_ceres.cpp"),
    "ceres_forward": Contender("Ceres, forward differences", "DynamicNumericDiffCostFunction, DENSE_QR", "compiled model",
                               "bench/rivals/output_error_ceres.cpp"),
    "ceres_central": Contender("Ceres, central differences", "the same, CENTRAL", "compiled model",
                               "bench/rivals/output_error_ceres.cpp"),
    "ceres_central_tight": Contender("Ceres, central, tight", "the same, function_tolerance 1e-10", "compiled model",
                                     "bench/rivals/output_error_ceres.cpp"),
    "ipopt_gauss_newton": Contender("Ipopt, Gauss-Newton", "TNLP, exact gradient, defaults", "JᵀJ as its Hessian; no covariance",
                                    "bench/rivals/static_map_ipopt.cpp"),
    "ipopt_limited_memory": Contender("Ipopt, limited memory", "`hessian_approximation limited-memory`", "no covariance",
                                      "bench/rivals/static_map_ipopt.cpp"),
    "casadi": Contender("CasADi", "nothing", "no package of Debian 12"),
    "double": Contender("the step without derivatives", OURS, "what both are measured against", "bench/dual_bench.cpp", True),
    "dual": Contender("Dual<3>", OURS, "derivatives by three parameters, in packs", "bench/dual_bench.cpp", True),
    "jet": Contender("ceres::Jet<double, 3>", OURS, "the same block", "bench/dual_bench.cpp"),
}

PICMA = "output error, PICMA record"
DERIVATIVES = "a step of HY_HYSTERESIS_RO with three derivatives"


def of_points(points):
    return f"static map, {points:,} points"


def of_samples(samples):
    return f"output error, {samples:,} samples"


class Model:
    """The compiled model of an output-error fit, its record, and where every contender starts."""

    def __init__(self, name, diagram, flags, rows, stretch, start, least):
        self.rows, self.stretch, self.start, self.least = rows, stretch, start, least
        folder = Place.work() / "models" / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        generate(diagram, "c", folder)
        self.object = folder / "model.o"
        self.library = folder / "model.so"
        source = RIVALS / "output_error_model.c"
        for what, output in ((("-c",), self.object), (("-shared",), self.library)):
            wrong = measure.compiler_says(["cc", "-std=c99", *FLAGS, "-fPIC", *flags, f"-I{folder}", *what, source, "-o", output,
                                           *(["-lm"] if what == ("-shared",) else [])], "the model")
            if wrong:
                raise NotThere(wrong)
        numbers = array.array("d", rows.read_bytes())
        self.count = len(numbers) // 2
        self.u, self.y = numbers[: self.count], numbers[self.count:]
        self.simulate = ctypes.CDLL(str(self.library)).simulate

    def squares(self, theta):
        model = array.array("d", bytes(8 * self.count))
        address = lambda values: ctypes.c_void_p(values.buffer_info()[0])
        self.simulate(address(array.array("d", theta)), address(self.u), address(model), ctypes.c_long(self.count))
        first, last = self.stretch
        return sum((a - b) ** 2 for a, b in zip(model[first:last], self.y[first:last]))


def squares_of_map(points):
    numbers = array.array("d", (Place.work() / f"static_map_{points}.bin").read_bytes())
    p, m = numbers[:points], numbers[points:]
    return lambda c: sum((c[0] + c[1] * x ** c[2] - y) ** 2 for x, y in zip(p, m))


def picma_model():
    data = os.environ.get("HYSTERON_DATA") or ROOT.parent / "shared" / "data"
    path = os.path.join(data, "piezo-picma-dbo", "identify_1hz.csv")
    if not os.path.exists(path):
        return None
    with open(path) as file:
        lines = [line.split(",") for line in file.read().split()[1:]]
    rows = Place.work() / "picma.bin"
    rows.write_bytes(array.array("d", [float(line[1]) for line in lines] + [float(line[2]) for line in lines]).tobytes())
    times = [float(line[0]) for line in lines]
    stretch = (sum(time < 1.0 - 1e-9 for time in times), sum(time <= 21.0 + 1e-9 for time in times))
    return Model("picma", ROOT / "examples/04_piezo_stack/plant.st", ("-DPLANT",), rows, stretch, (10.0, 1.0, 1.0, -120.0),
                 (-1e9, -1e9, 1e-6, -1e9))


def machine_model(samples):
    return Model(f"machine_{samples}", HERE / "diagnosis/machine.st", (), Place.work() / f"machine_{samples}.bin", (0, samples),
                 (0.01, 0.2, 1.5, 0.03, 0.1, 0.1), (1e-6, 0.0, 1e-6, 1e-6, 0.0, 1e-6))


def judged(rows, squares):
    """Marks rows whose fit is worse than ours: they keep their time in the note alone. `rows` are pairs of a row and its
    solution."""
    cost = {}
    for row, solution in rows:
        cost.setdefault((row.subject, row.contender), squares[row.subject](solution))
    for row, _ in rows:
        ours = cost[(row.subject, "ours")]
        above = cost[(row.subject, row.contender)] / ours - 1.0
        row.difference = max(0.0, above)
        if not above <= WORSE_BY:
            row.note = f"ends worse than ours, after {measure.duration(row.seconds)}" if above == above else "ends without a value"
            row.seconds = None
        yield row


def of_benchmarks(pattern, repetitions, least_seconds="0.1"):
    """Our own fits, each with its solution."""
    for name, repetition, seconds, run, error in measure.run_benchmarks(pattern, (), repetitions, least_seconds):
        kind, which, *size = name.split("/")
        contender = "ours" if kind == "output_error" else which
        subject = (of_points(int(size[0])) if kind == "static_fit" else of_samples(int(size[0])) if size else PICMA)
        if error:
            if repetition == 0:
                yield Row(subject, contender, note=error), None
            continue
        solution = [run[f"p{j}"] for j in range(9) if f"p{j}" in run]
        note = peak_text(run["peak"]) if size and kind == "output_error" else ""
        yield Row(subject, contender, repetition, 1.0, seconds, note=note), solution


def peak_text(peak):
    """The most memory of a process, which ran all options of a rival."""
    return f"{peak / 1e6:,.0f} MB"


def of_program(command, version, subject, with_peak=False):
    """Rows of a rival that prints a line a repetition, each with its solution. `subject` makes one of its second word."""
    one_thread = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    lines, peak = measure.run_program(command, env={**os.environ, **one_thread})
    note = peak_text(peak) if with_peak else ""
    seen = {}
    for line in lines.splitlines():
        contender, which, seconds, *solution = line.split()
        repetition = seen[(contender, which)] = seen.get((contender, which), -1) + 1
        if repetition < 2 * measure.REPETITIONS:
            yield (Row(subject(which), contender, repetition, 1.0, float(seconds), version=version, note=note),
                   [float(x) for x in solution])


def compiled(source, name, libraries, more=()):
    program = Place.work() / name
    wrong = measure.compiler_says(["c++", "-std=c++17", "-O3", "-DNDEBUG", "-w", f"-I{ROOT}", "-isystem", "/usr/include/eigen3",
                                   *pkg_config("--cflags"), source, *more, "-o", program, *libraries], name)
    if wrong:
        raise NotThere(wrong)
    return program


def pkg_config(*what):
    return subprocess.run(["pkg-config", *what, "ipopt"], capture_output=True, text=True).stdout.split()


CERES = ("-lceres", "-lglog")


def static_rows(quick):
    data = Place.work()
    rows = list(of_benchmarks("^static_fit/", 2 if quick else measure.REPETITIONS))
    subject = lambda points: of_points(int(points))
    try:
        import scipy

        rows += of_program([sys.executable, RIVALS / "static_map_scipy.py", data], scipy.__version__, subject)
    except ImportError:
        yield from (measure.left_out(of_points(n), "scipy_lm", "scipy is not installed (python3-scipy)") for n in POINTS)
    for source, libraries, package, name in (("static_map_ceres.cpp", CERES, "libceres-dev", "ceres_points_qr"),
                                             ("static_map_ipopt.cpp", pkg_config("--libs"), "coinor-libipopt-dev",
                                              "ipopt_gauss_newton")):
        try:
            program = compiled(RIVALS / source, source.removesuffix(".cpp"), libraries)
            rows += of_program([program, data], measure.debian_version(package), subject)
        except NotThere as why:
            yield from (measure.left_out(of_points(n), name, str(why)) for n in POINTS)
    yield from judged(rows, {of_points(n): squares_of_map(n) for n in POINTS})


def rivals_on(model, subject, repetitions):
    """Rows of scipy and Ceres on a record, with their solutions; and rows of those that are not there."""
    numbers = lambda values: ",".join(map(repr, values))
    given = (model.rows, "-", *model.stretch, numbers(model.start), numbers(model.least), repetitions)
    try:
        import scipy

        yield from of_program([sys.executable, RIVALS / "output_error_scipy.py", model.library, *given], scipy.__version__,
                              lambda _: subject, subject != PICMA)
    except ImportError:
        yield measure.left_out(subject, "scipy_lm", "scipy is not installed (python3-scipy)"), None
    try:
        program = compiled(RIVALS / "output_error_ceres.cpp", f"ceres_{model.object.parent.name}", CERES, (model.object,))
        yield from of_program([program, *given], measure.debian_version("libceres-dev"), lambda _: subject,
                              subject != PICMA)
    except NotThere as why:
        yield measure.left_out(subject, "ceres_central", str(why)), None


def output_error_rows(quick):
    rows = list(of_benchmarks("^output_error/picma", 2 if quick else measure.REPETITIONS))
    squares = {}
    picma = picma_model()
    if picma:
        squares[PICMA] = picma.squares
        rows += rivals_on(picma, PICMA, 2 if quick else 5)
    for samples in SAMPLES[:1] if quick else SAMPLES:
        model = machine_model(samples)
        squares[of_samples(samples)] = model.squares
        repetitions = 1 if quick else 5 if samples <= 100_000 else 2
        rows += of_benchmarks(f"^output_error/machine/{samples}/", repetitions)
        rows += rivals_on(model, of_samples(samples), max(1, repetitions // 2))
    yield from (row for row, solution in rows if solution is None)
    yield from judged([one for one in rows if one[1] is not None], squares)
    for subject in squares:
        yield measure.left_out(subject, "casadi", "Debian 12 has no package of CasADi")


def derivative_rows(quick):
    for name, repetition, seconds, run_of, _ in measure.run_benchmarks("^dual/", (), 2 if quick else measure.REPETITIONS):
        yield Row(DERIVATIVES, name.split("/")[1], repetition, run_of["work"], seconds)


def run(quick):
    contenders.write_data()
    yield from derivative_rows(quick)
    yield from static_rows(quick)
    yield from output_error_rows(quick)


def base_of(subject):
    return "dual" if subject == DERIVATIVES else "ours"


def tables(rows):
    there = measure.subjects_of(rows)
    for subject in (*map(of_points, POINTS), PICMA, *map(of_samples, SAMPLES), DERIVATIVES):
        if subject in there:
            yield subject[0].upper() + subject[1:], measure.comparison(rows, subject, CONTENDERS, base_of(subject),
                                                                       "sum of squares above ours", "no more")


def fastest(rows, subject, family):
    names = [name for name in CONTENDERS if name.startswith(family) and measure.least(rows, subject, name)]
    return min(names, key=lambda name: measure.least(rows, subject, name), default=None)


def goals(rows):
    result = []
    for points in POINTS:
        subject = of_points(points)
        rival = fastest(rows, subject, "scipy")
        if rival:
            result.append(Goal(f"time of scipy ({CONTENDERS[rival].label}) : ours, {subject}",
                               measure.least(rows, subject, rival) / measure.least(rows, subject, "ours"), 2.0, "×", True))
    dual, jet = measure.least(rows, DERIVATIVES, "dual"), measure.least(rows, DERIVATIVES, "jet")
    result.append(Goal("Dual<3> : ceres::Jet<double, 3>", dual / jet, 1.0))
    seconds = measure.least(rows, PICMA, "ours")
    if seconds:
        result.append(Goal("fit of " + PICMA, seconds, 1.0, "s"))
    return result


def losses(rows):
    for subject in measure.subjects_of(rows):
        yield from measure.losses(rows, subject, CONTENDERS, base_of(subject))


if __name__ == "__main__":
    sys.exit(measure.main(sys.modules[__name__]))
