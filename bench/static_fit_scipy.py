"""Times scipy's curve_fit on the points that hysteron_bench wrote, and prints the result as JSON.

usage: static_fit_scipy.py FOLDER

The rival is given every advantage that its user has: a start from the straight line, the exact Jacobian, no check
for NaN, either of its two unconstrained methods. The fastest that reaches the solution counts. Its time is that of
the processor inside this process, without the start of Python or the reading of the points.
"""

import json
import sys
import time

import numpy
import scipy
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
    "method='lm'": {"method": "lm"},
    "method='lm', jac=exact": {"method": "lm", "jac": jacobian},
    "method='lm', jac=exact, check_finite=False": {"method": "lm", "jac": jacobian, "check_finite": False},
    "method='trf', jac=exact, check_finite=False": {"method": "trf", "jac": jacobian, "check_finite": False},
}


def time_fit(p, m, options, seconds=0.5, at_least=3):
    """The least processor time in seconds of one fit, and its solution."""
    best, spent, runs = float("inf"), 0.0, 0
    while runs < at_least or (spent < seconds and runs < 2000):
        begin = time.process_time()
        solution, _ = curve_fit(model, p, m, p0=line(p, m), **options)
        used = time.process_time() - begin
        best, spent, runs = min(best, used), spent + used, runs + 1
    return best, solution


def main():
    result = {"scipy": scipy.__version__, "numpy": numpy.__version__, "fits": []}
    for points in (200, 10_000, 1_000_000):
        p, m = numpy.fromfile(f"{sys.argv[1]}/static_map_{points}.bin").reshape(2, points)
        for name, options in OPTIONS.items():
            seconds, solution = time_fit(p, m, options)
            result["fits"].append(
                {"points": points, "options": "p0=line, " + name, "seconds": seconds, "solution": solution.tolist()}
            )
    json.dump(result, sys.stdout, indent=1)


if __name__ == "__main__":
    main()
