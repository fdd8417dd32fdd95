"""scipy's curve_fit on a static map, M(p) = c1 + c2*p**c3, from the points that hysteron_bench wrote.

usage: static_map_scipy.py FOLDER

Prints a line a repetition: the contender, the points, the seconds of processor time, then c1, c2, c3. The rival is given
every advantage that its user has: a start from the straight line, the exact Jacobian, no check for NaN, either of its two
unconstrained methods. Neither Python's start nor reading the points is timed."""

import sys
import time

import numpy
from scipy.optimize import curve_fit


def model(p, c1, c2, c3):
    return c1 + c2 * p**c3


def jacobian(p, c1, c2, c3):
    power = p**c3
    return numpy.column_stack((numpy.ones_like(p), power, c2 * power * numpy.log(p)))


def line(p, m):
    """C1 and C2 of the straight line, C3 = 1: the start."""
    slope, intercept = numpy.polyfit(p, m, 1)
    return intercept, slope, 1.0


OPTIONS = {
    "scipy_lm": {"method": "lm"},
    "scipy_lm_exact": {"method": "lm", "jac": jacobian},
    "scipy_lm_unchecked": {"method": "lm", "jac": jacobian, "check_finite": False},
    "scipy_trf_unchecked": {"method": "trf", "jac": jacobian, "check_finite": False},
}


def repetitions(fit, seconds=0.5, at_least=3, at_most=2000):
    """Fits until the time is spent, each with its processor time."""
    spent, runs = 0.0, 0
    while runs < at_least or (spent < seconds and runs < at_most):
        begin = time.process_time()
        solution = fit()
        used = time.process_time() - begin
        spent, runs = spent + used, runs + 1
        yield used, solution


def main():
    for points in (200, 10_000, 1_000_000):
        p, m = numpy.fromfile(f"{sys.argv[1]}/static_map_{points}.bin").reshape(2, points)
        for name, options in OPTIONS.items():
            for seconds, (solution, _) in repetitions(lambda: curve_fit(model, p, m, p0=line(p, m), **options)):
                print(name, points, seconds, *solution)


if __name__ == "__main__":
    main()
