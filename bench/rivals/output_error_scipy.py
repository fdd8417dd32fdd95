"""scipy's least_squares on output error, with a compiled model.

usage: output_error_scipy.py LIBRARY ROWS SUBJECT FIRST LAST START LEAST REPETITIONS

LIBRARY is output_error_model.c, compiled; ROWS has all u, then all y. Residuals are those of the rows FIRST to LAST, START
and LEAST are numbers with commas between. Prints a line a repetition: the contender, SUBJECT, the seconds of processor time,
then the solution."""

import ctypes
import sys
import time

import numpy
from scipy.optimize import least_squares


def main():
    library, rows, subject, first, last, start, least, repetitions = sys.argv[1:]
    u, y = numpy.fromfile(rows).reshape(2, -1)
    stretch = slice(int(first), int(last))
    start = numpy.array([float(one) for one in start.split(",")])
    least = numpy.array([float(one) for one in least.split(",")])
    simulate = ctypes.CDLL(library).simulate
    address = lambda numbers: numbers.ctypes.data_as(ctypes.c_void_p)
    model = numpy.empty_like(y)

    def residuals(theta):
        simulate(address(numpy.ascontiguousarray(theta)), address(u), address(model), ctypes.c_long(len(u)))
        return model[stretch] - y[stretch]

    options = {
        "scipy_lm": {"method": "lm", "x_scale": "jac"},
        "scipy_lm_start": {"method": "lm", "x_scale": numpy.abs(start)},
        "scipy_trf": {"method": "trf", "x_scale": "jac"},
        "scipy_trf_bounds": {"method": "trf", "x_scale": "jac", "bounds": (least, numpy.inf)},
    }
    for name, chosen in options.items():
        for _ in range(int(repetitions)):
            begin = time.process_time()
            try:
                solution = least_squares(residuals, start, **chosen).x
            except ValueError:
                solution = numpy.full_like(start, numpy.nan)
            print(name, subject, time.process_time() - begin, *solution)


if __name__ == "__main__":
    main()
