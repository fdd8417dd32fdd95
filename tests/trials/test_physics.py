"""The generator's physics against closed forms and against second forms of the same law."""

from __future__ import annotations

import math
import unittest

import numpy as np

from trials.generator import friction, hysteresis, operators
from trials.generator.servo import Axis

T = np.linspace(0.0, 1.0, 40001)
U = 50.0 * np.sin(2 * np.pi * 3 * T) * (1 - 0.7 * T) + 10.0 * np.sin(2 * np.pi * 11 * T)
LOOP = hysteresis.Loop.of_slope(0.1, 0.0005, 1.1)


class Hysteresis(unittest.TestCase):
    """Ramberg and Osgood's loop, with and without return-point memory."""

    def test_branch_is_the_integral_of_its_slope(self) -> None:
        closed = hysteresis.local_memory(U, LOOP)
        summed = hysteresis.by_slope(U, T[1], lambda m: LOOP.slope(m.travel))
        self.assertLess(np.max(np.abs(closed - summed)), 1e-6 * np.ptp(closed))

    def test_slope_is_the_papers(self) -> None:
        p = np.array([0.0, 1.0, 30.0])
        np.testing.assert_allclose(LOOP.slope(p), 0.1 + 0.0005 * p**1.1, rtol=1e-12)

    def test_closed_minor_loop_returns_to_the_outer_branch(self) -> None:
        corners = [0.0, 40.0, -40.0, 20.0, -10.0, 40.0]
        detour = np.interp(np.linspace(0, 5, 5001), range(6), corners)
        straight = np.interp(np.linspace(0, 3, 3001), range(4), [0.0, 40.0, -40.0, 40.0])
        kept = hysteresis.return_point(detour, LOOP)
        self.assertAlmostEqual(kept[-1], hysteresis.return_point(straight, LOOP)[-1], places=9)
        self.assertGreater(abs(hysteresis.local_memory(detour, LOOP)[-1] - kept[-1]), 0.1)

    def test_plays_and_relays_have_the_same_memory(self) -> None:
        wiped = hysteresis.return_point(U, LOOP)
        for other, within in ((hysteresis.maxwell_slip(U, LOOP, 40), 1e-3), (hysteresis.relay_preisach(U, LOOP, 150), 6e-3)):
            self.assertLess(np.max(np.abs(other - wiped)), within * np.ptp(wiped))

    def test_play_against_its_recursion(self) -> None:
        y, expected = U[0], []
        for u in U:
            y = max(u - 3.0, min(u + 3.0, y))
            expected.append(y)
        np.testing.assert_allclose(operators.play(U, 3.0), expected, atol=1e-12)


class Filters(unittest.TestCase):
    """Linear operators against their closed forms."""

    def test_lag_of_a_ramp(self) -> None:
        expected = T - 0.02 * (1 - np.exp(-T / 0.02))
        np.testing.assert_allclose(operators.lag(T, T[1], 0.02), expected, atol=1e-12)

    def test_resonance_rings_at_its_frequency(self) -> None:
        step = (T > 0.1).astype(float)
        y = operators.resonance(step, T[1], 20.0, 0.05)
        damped = 20.0 * math.sqrt(1 - 0.05**2)
        self.assertAlmostEqual(T[np.argmax(y)], 0.1 + 0.5 / damped, delta=1e-4)
        self.assertAlmostEqual(y.max(), 1 + math.exp(-0.05 * math.pi / math.sqrt(1 - 0.05**2)), delta=1e-4)

    def test_creep_after_a_step_is_its_kernel(self) -> None:
        step = (np.arange(len(T)) > 0).astype(float)
        y = operators.after_effect(step, T[1], lambda age: np.log10(1 + age / 0.01))
        np.testing.assert_allclose(y[2000:], np.log10(1 + T[2000:] / 0.01), atol=1e-3)

    def test_rate_limit_follows_a_slow_signal(self) -> None:
        np.testing.assert_allclose(operators.rate_limit(0.5 * T, T[1], 1.0, 1.0), 0.5 * T, atol=1e-12)
        self.assertAlmostEqual(operators.rate_limit(3.0 * T, T[1], 1.0, 1.0)[-1], 1.0, places=9)


class Friction(unittest.TestCase):
    """Laws on an axis, and at a given speed."""

    def test_coulomb_stops_and_holds(self) -> None:
        axis = Axis(1e-4, 0.0, friction.coulomb(2.0), None)
        axis.v = 1.0
        positions, speeds = axis.run([0.0] * 20000)
        self.assertAlmostEqual(positions[-1], 0.25, places=9)  # v^2 / (2 F)
        self.assertEqual(speeds[-1], 0.0)
        self.assertEqual(axis.run([1.99] * 1000)[1][-1], 0.0)
        self.assertGreater(axis.run([2.5] * 1000)[1][-1], 0.0)

    def test_coulomb_reverses_between_two_sub_steps(self) -> None:
        axis = Axis(1e-2, 0.0, friction.coulomb(2.0), None)
        axis.v = 1.0
        positions, speeds = axis.run([-6.0] * 100)  # at rest after 1/8 s, and then -4 rad/s^2
        self.assertAlmostEqual(speeds[-1], -4.0 * 0.875, places=12)
        self.assertAlmostEqual(positions[-1], 1.0 / 16 - 2.0 * 0.875**2, places=12)

    def test_presliding_laws_reach_their_level(self) -> None:
        for law in (friction.dahl(2.0, 500.0, 1e-4), friction.lugre(2.0, 3.0, 0.01, 500.0, 1.0, 1e-4), friction.maxwell_slip(2.0, 500.0, 1e-4)):
            force = [law.force(0.5) for _ in range(20000)][-1]
            self.assertAlmostEqual(force, 2.0, delta=1e-3)
            self.assertLess([law.force(-0.5) for _ in range(20000)][-1], -1.9)

    def test_stribeck_at_its_speed(self) -> None:
        self.assertAlmostEqual(friction.stribeck(1.0, 2.0, 0.1).force(0.1), 1.0 + math.exp(-1.0))
        self.assertAlmostEqual(friction.hyperbolic_stribeck(1.0, 2.0, 0.1).force(-0.1), -1.5)

    def test_damped_axis_against_its_closed_form(self) -> None:
        positions, speeds = Axis(1e-3, 4.0, None, None).run([8.0] * 1000)
        self.assertAlmostEqual(speeds[-1], 2.0 * (1 - math.exp(-4.0)), places=9)
        self.assertAlmostEqual(positions[-1], 2.0 - 0.5 * (1 - math.exp(-4.0)), delta=1e-5)


if __name__ == "__main__":
    unittest.main()
