"""The published detectors of stiction, on loops that are simulated here: a valve that sticks, a disturbance, tight tuning."""

from __future__ import annotations

import unittest

import numpy as np
from scipy import signal

from trials.peers.stiction import bicoherence, correlation, shape
from trials.peers.stiction.oscillation import half_periods, period, smooth

SAMPLES = 4000
GAIN, RESET = 0.2, 5.0
"""Of the controller: slow oscillations are integrated, as a sticking valve's are, quick ones are passed on in proportion."""
WANTED = 0.2
"""A set point where no jump ends, so that a sticking valve never rests."""


def loop(stick: float = 0.0, disturbed: float = 0.0, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """OP and PV of a flow loop about its working point: a PI controller, a valve that stands until OP has gone on by `stick`
    and then jumps to it, a lag of 8 samples behind a dead time of 2, a sine from outside, noise."""
    rng = np.random.default_rng(seed)
    op, pv, valve, total, y, pipe = [], [], 0.0, 0.0, 0.0, [0.0] * 2
    for k in range(SAMPLES):
        seen = y + disturbed * np.sin(2.0 * np.pi * k / 19.0) + 0.01 * rng.standard_normal()
        total += GAIN / RESET * (WANTED - seen)
        u = total + GAIN * (WANTED - seen)
        if abs(u - valve) > stick:
            valve = u
        pipe.append(valve)
        y += (pipe.pop(0) - y) / 8.0
        op.append(u)
        pv.append(seen)
    return np.array(op[500:]), np.array(pv[500:])


STICKS = loop(stick=0.5)
DISTURBED = loop(disturbed=0.3)


class Correlation(unittest.TestCase):
    """Horch's cross-correlation."""

    def test_odd_where_the_valve_sticks_and_even_where_it_does_not(self) -> None:
        self.assertGreater(correlation.score(*STICKS), correlation.SURE)
        self.assertLess(correlation.score(*DISTURBED), 1.0 - correlation.SURE)

    def test_closed_forms(self) -> None:
        t = np.arange(4000) * 2.0 * np.pi / 100.0
        self.assertGreater(correlation.score(np.sin(t), np.cos(t)), 0.95)
        self.assertLess(correlation.score(np.sin(t), -np.sin(t)), 0.05)
        self.assertEqual(correlation.score(np.zeros(100), np.sin(t[:100])), 0.0)


class Shape(unittest.TestCase):
    """The triangle against the sine."""

    def test_a_triangle_is_one_and_a_sine_is_none(self) -> None:
        t = np.arange(3000) / 100.0
        noise = 0.01 * np.random.default_rng(2).standard_normal((2, 3000))
        triangle = signal.sawtooth(2.0 * np.pi * t, 0.5)
        sine = np.sin(2.0 * np.pi * t)
        self.assertGreater(shape.score(triangle + noise[0], sine), shape.SURE)
        self.assertLess(shape.score(sine + noise[1], triangle), 0.4)
        self.assertGreater(shape.score(sine, triangle + noise[0], integrating=True), shape.SURE)

    def test_loops(self) -> None:
        self.assertGreater(shape.score(*STICKS), shape.SURE)
        self.assertLess(shape.score(*DISTURBED), 0.4)

    def test_without_an_oscillation_there_is_no_decision(self) -> None:
        noise = np.random.default_rng(3).standard_normal((2, 2000))
        self.assertEqual(shape.score(noise[0], noise[1]), 0.5)


class Bicoherence(unittest.TestCase):
    """Coupled phases."""

    def test_coupled_phases_are_nonlinear_and_others_are_not(self) -> None:
        rng, t = np.random.default_rng(4), np.arange(256)
        def record(coupled: bool) -> np.ndarray:
            pieces = []
            for _ in range(64):
                a, b, c = rng.uniform(0.0, 2.0 * np.pi, 3)
                third = a + b if coupled else c
                pieces.append(np.cos(2 * np.pi * 0.11 * t + a) + np.cos(2 * np.pi * 0.19 * t + b) + np.cos(2 * np.pi * 0.30 * t + third))
            return np.concatenate(pieces) + 0.3 * rng.standard_normal(64 * 256)
        coupled, free = bicoherence.score(t, record(True)), bicoherence.score(t, record(False))
        self.assertGreater(coupled, 0.4)
        self.assertLess(free, 0.5 * coupled)

    def test_noise_is_gaussian(self) -> None:
        nongaussian, _ = bicoherence.indices(np.random.default_rng(5).standard_normal(16384))
        self.assertLess(nongaussian, 0.05)

    def test_a_loop_that_sticks_is_more_nonlinear_than_one_that_is_shaken(self) -> None:
        self.assertGreater(bicoherence.score(*STICKS), bicoherence.SURE)
        self.assertGreater(bicoherence.score(*STICKS), bicoherence.score(*DISTURBED))


class Oscillation(unittest.TestCase):
    """Periods and half periods."""

    def test_period_of_a_noisy_sine_on_a_trend(self) -> None:
        k = np.arange(3000)
        x = np.sin(2 * np.pi * k / 75.0) + 0.002 * k + 0.2 * np.random.default_rng(6).standard_normal(3000)
        samples, regular = period(x)
        self.assertAlmostEqual(samples, 75.0, delta=1.0)
        self.assertGreater(regular, 1.0)
        pieces = half_periods(smooth(x, samples), samples)
        self.assertAlmostEqual(np.mean([len(one) for one in pieces]), 37.5, delta=1.0)

    def test_scores_lie_between_0_and_1_whatever_is_given(self) -> None:
        rng = np.random.default_rng(7)
        for op, pv in ((np.zeros(300), np.zeros(300)), (np.ones(300), rng.standard_normal(300)), (np.cumsum(rng.standard_normal(300)), np.arange(300.0)), STICKS):
            for method in (correlation, shape, bicoherence):
                for integrating in (False, True):
                    self.assertTrue(0.0 <= method.score(op, pv, integrating) <= 1.0)


if __name__ == "__main__":
    unittest.main()
