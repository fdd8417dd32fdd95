"""The diagram of feedforward.st in plain Python, with the arithmetic of the step: the same bits.

usage: feedforward.py SIGNAL OUTPUT CHUNK REPETITIONS [--without-pow]

Reads doubles from SIGNAL and begins anew every CHUNK of them; writes the outputs of the first repetition to OUTPUT and
prints the seconds of processor time of each."""

import array
import sys
import time


class Sum:
    """A running sum and what rounding took from it."""

    __slots__ = ("lost", "value")

    def __init__(self):
        self.value = 0.0
        self.lost = 0.0

    def add(self, term):
        due = term + self.lost
        value = self.value
        after = value + due
        self.lost = (value - after) + due if abs(value) >= abs(due) else (due - after) + value
        self.value = after


class Feedforward:
    TS = 50e-6

    def __init__(self, with_pow):
        self.with_pow = with_pow
        self.c1, self.c2, self.c3 = 0.05, 0.0013, 0.7
        self.started = False
        self.heading = 0
        self.previous = 0.0
        self.momentum = Sum()
        self.control = Sum()

    def step(self, reference, reset=False):
        rate = (reference - self.previous) / self.TS if self.started else 0.0
        ahead = reference - self.previous if self.started else 0.0
        branching_point = self.heading * ahead < 0.0
        if ahead != 0.0:
            self.heading = 1 if ahead > 0.0 else -1
        self.previous = reference
        self.started = True
        p = 0.0 if branching_point else self.momentum.value
        slope = self.c1 + self.c2 * (p**self.c3 if self.with_pow else p)  # (17)
        control_rate = rate / slope if slope > 0.0 else 0.0  # (15)
        if branching_point or reset:
            self.momentum = Sum()
        self.momentum.add(abs(control_rate) * self.TS)  # (16)
        if reset:
            self.control = Sum()
        self.control.add(control_rate * self.TS)
        return self.control.value


def run(signal, with_pow):
    step = Feedforward(with_pow).step
    return [step(reference) for reference in signal]


def main():
    signal_file, output_file, chunk, repetitions = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    with_pow = "--without-pow" not in sys.argv
    signal = array.array("d")
    with open(signal_file, "rb") as file:
        signal.frombytes(file.read())
    parts = [signal[k : k + chunk] for k in range(0, len(signal), chunk)]
    for repetition in range(repetitions):
        begin = time.process_time()
        outputs = [run(part, with_pow) for part in parts]
        print(time.process_time() - begin)
        if repetition == 0:
            with open(output_file, "wb") as file:
                file.write(array.array("d", [y for part in outputs for y in part]).tobytes())


if __name__ == "__main__":
    main()
