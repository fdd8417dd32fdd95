"""INSTANCES of the feedforward in numpy, all at once: an array operation for each operation of the step.

usage: feedforward_numpy.py SIGNAL OUTPUT INSTANCES SAMPLES REPETITIONS

Writes the output of the instance with the exponent 0.7, and prints the seconds of processor time of each repetition."""

import sys
import time

import numpy

SHOWN = 50
TS = 50e-6


def run(signal, c3):
    momentum = numpy.zeros_like(c3)
    control = numpy.zeros_like(c3)
    heading = numpy.zeros_like(c3)
    previous = numpy.full_like(c3, signal[0])
    shown = numpy.empty_like(signal)
    for k, reference in enumerate(signal):
        ahead = numpy.full_like(c3, reference) - previous
        previous += ahead
        branching_point = heading * ahead < 0.0
        heading = numpy.where(ahead != 0.0, numpy.sign(ahead), heading)
        p = numpy.where(branching_point, 0.0, momentum)
        slope = 0.05 + 0.0013 * p**c3  # (17)
        moved = numpy.where(slope > 0.0, ahead / slope, 0.0)  # (15), times TS
        momentum = p + numpy.abs(moved)  # (16)
        control += moved
        shown[k] = control[SHOWN]
    return shown


def main():
    signal_file, output_file, instances, samples, repetitions = sys.argv[1:]
    signal = numpy.fromfile(signal_file)[: int(samples)]
    c3 = 0.7 + 0.002 * (numpy.arange(int(instances)) % 128 - SHOWN)
    for _ in range(int(repetitions)):
        begin = time.process_time()
        shown = run(signal, c3)
        print(time.process_time() - begin)
    shown.tofile(output_file)


if __name__ == "__main__":
    main()
