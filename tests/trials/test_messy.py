"""The stratum messy: shares and floors as wanted, parameters bent as a tuning bends them, the same set for the same seed, and
how its verdicts are judged."""

from __future__ import annotations

import dataclasses
import unittest
from unittest import mock

import numpy as np

from tests.trials.labels import named
from trials.families import family_of
from trials.generator import beyond
from trials.generator.case import PLANTS, Builder, Specification, build, from_label, scales
from trials.generator.effects import Context
from trials.generator.messy import LEAST_RATIO, tune
from trials.generator.sets import drawn
from trials.generator.strata import FULL, ONE_LAW, plan
from trials.generator.unreachable import Unreachable
from trials.scoring.figures import score
from trials.scoring.judge import judge
from trials.scoring.text import whole

SOME = (
    Specification("messy", "servo_speed", (("coulomb_friction", "coulomb"), ("drift", "drift"), ("load", "load"), ("beyond:static_bend", "static_bend")), 200.0, 5, share=0.8),
    Specification("messy", "closed_loop", (("cogging", "cogging"), ("gain_drift", "gain_drift"), ("lag", "lag"), ("beyond:wandering_gain", "wandering_gain")), 100.0, 6, share=0.7),
    Specification("messy", "thermal", (("saturation", "tanh_clip"), ("delay", "delay"), ("creep", "log_creep"), ("beyond:second_mode", "second_mode")), 100.0, 7, share=0.9),
)  # fmt: skip
CASES = [build(one) for one in SOME]


class Plan(unittest.TestCase):
    """What a set of messy machines holds."""

    def setUp(self) -> None:
        self.cases = plan("any", {"messy": 42})

    def test_all_plants_alike_and_each_with_its_own_effects(self) -> None:
        counts = [sum(one.plant == plant for one in self.cases) for plant in PLANTS]
        self.assertEqual(counts, [6] * len(PLANTS))
        dominants = [one.effects[0][0] for one in self.cases]
        self.assertLessEqual(max(dominants.count(one) for one in dominants), 3)

    def test_two_to_five_small_ones_of_other_families_and_one_beyond(self) -> None:
        numbers = set()
        for one in self.cases:
            names = [name for name, _ in one.effects]
            small = names[1:-1]
            numbers.add(len(small))
            self.assertNotIn(family_of(names[0]), {family_of(name) for name in small})
            self.assertEqual(len(set(names)), len(names))
            self.assertLessEqual(len(ONE_LAW & set(names)), 1)
            self.assertIn(names[-1], beyond.CATALOGUE)
        self.assertEqual(numbers, {2, 3, 4, 5})

    def test_the_other_strata_stay_as_they_were_without_it(self) -> None:
        self.assertEqual(plan("any", FULL), [one for one in plan("any", FULL | {"messy": 0}) if one.stratum != "messy"])
        self.assertNotIn("messy", FULL)

    def test_the_same_seed_gives_the_same_plan(self) -> None:
        self.assertEqual(plan("any", {"messy": 9}), plan("any", {"messy": 9}))
        self.assertNotEqual(plan("any", {"messy": 9}), plan("other", {"messy": 9}))


class Beyond(unittest.TestCase):
    """The discrepancies outside of the library."""

    def test_they_grow_with_their_size_and_vanish_with_it(self) -> None:
        x = np.sin(np.linspace(0.0, 40.0, 4001)) * np.linspace(0.2, 1.0, 4001)
        for name, (one,) in beyond.CATALOGUE.items():
            with self.subTest(name):
                changes = [one.apply(x, Context(0.0005, 20, 2.0), size, np.random.default_rng(3)) - x for size in (1e-12, 0.01, 0.02)]
                self.assertLess(np.max(np.abs(changes[0])), 1e-9)
                np.testing.assert_allclose(changes[2], 2.0 * changes[1], atol=1e-9)

    def test_a_bend_is_neither_straight_nor_a_cubic(self) -> None:
        x = np.linspace(-1.0, 1.0, 2001)
        for seed in range(6):
            bent = beyond.static_bend(x, Context(0.0005, 20, 2.0), 0.1, np.random.default_rng(seed)) - x
            spread = np.std(bent - np.polyval(np.polyfit(x, bent, 1), x))
            self.assertGreater(spread, 1e-3)
            self.assertGreater(np.std(bent - np.polyval(np.polyfit(x, bent, 3), x)), 0.01 * spread)

    def test_a_wandering_gain_has_no_trend(self) -> None:
        gain = beyond.wandering_gain(np.ones(4001), Context(0.0005, 20, 2.0), 0.1, np.random.default_rng(1)) - 1.0
        self.assertLess(abs(np.polyfit(np.linspace(0.0, 1.0, 4001), gain, 1)[0]), 0.1)
        self.assertGreater(np.std(gain), 0.05)


class Mixed(unittest.TestCase):
    """Cases of the stratum."""

    def test_the_dominant_effect_has_its_share_and_the_floor_is_low(self) -> None:
        for one, case in zip(SOME, CASES):
            with self.subTest(one.plant):
                self.assertAlmostEqual(case.label["share"], one.share, delta=0.04)
                self.assertEqual([effect["id"] for effect in case.label["effects"]], [one.effects[0][0]])
                self.assertEqual(len(case.label["beside"]), 3)
                floor = case.label["noise_rms"][0] / np.ptp(case.clean[:, 0])
                self.assertLess(floor, 2.5e-4)
                self.assertGreater(case.label["effects"][0]["ratio"], 0.9 * LEAST_RATIO)

    def test_what_cannot_be_had_as_it_was_drawn_is_drawn_again(self) -> None:
        asked = []

        def built(specification: Specification) -> str:
            asked.append(specification.seed)
            if len(asked) < 3:
                raise Unreachable("a loop swallows what should dominate")
            return "case"

        (specification,) = plan("again", {"messy": 1})
        with mock.patch("trials.generator.sets.build", built):
            self.assertEqual(drawn(specification), "case")
        self.assertEqual(asked[0], specification.seed)
        self.assertEqual(len(set(asked)), 3)
        with mock.patch("trials.generator.sets.build", side_effect=Unreachable("never")), self.assertRaises(Unreachable):
            drawn(specification)

    def test_parameters_are_those_of_a_least_squares_fit(self) -> None:
        for one, case in zip(SOME, CASES):
            with self.subTest(one.plant):
                builder = Builder(one)
                plant, weights = builder.plant, 1.0 / np.std(case.clean, axis=0)
                off, scale = case.label["deviations"], scales(plant)

                def miss(change: dict[str, float], plant=plant, builder=builder, case=case, weights=weights, off=off, scale=scale) -> float:
                    moved = {name: value + (off[name] + change.get(name, 0.0)) * scale[name] for name, value in plant.truth.items()}
                    return float(np.sum(((case.clean - plant.simulate(moved, [])) * weights) ** 2))

                least = miss({})
                self.assertGreater(max(abs(value) for value in off.values()), 1e-3)
                for name in off:
                    for step in (-0.05, 0.05):
                        self.assertGreater(miss({name: step}), 0.999 * least)

    def test_nothing_bends_the_parameters_where_nothing_is_wrong(self) -> None:
        builder = Builder(SOME[0])
        self.assertLess(max(abs(one) for one in tune(builder, builder.base, scales(builder.plant)).values()), 1e-6)

    def test_the_same_specification_gives_the_same_case(self) -> None:
        again = build(SOME[1])
        self.assertEqual(CASES[1].files, again.files)
        whole_label = dict(CASES[1].label)
        self.assertEqual(from_label(whole_label).build().files, again.files)
        self.assertNotEqual(build(dataclasses.replace(SOME[1], seed=8)).files, again.files)


class Judged(unittest.TestCase):
    """Verdicts on messy machines."""

    def judge(self, verdict: dict, case: int = 0):
        return judge("0", CASES[case].label, verdict, {"seconds": 1.0, "exit": 0})

    def test_the_dominant_effect_counts_and_small_ones_are_no_error(self) -> None:
        for effects, family, member in (
            (["coulomb_friction"], "first", True), (["stribeck_friction"], "first", False), (["drift"], "beside", False),
            (["drift", "coulomb_friction"], "beside", False), (["backlash"], "wrong", False),
        ):  # fmt: skip
            with self.subTest(effects):
                case = self.judge(named(effects))
                self.assertEqual((case.mark.family, case.mark.member), (family, member))
                self.assertEqual(case.named_first, member)

    def test_figures_and_table(self) -> None:
        cases = [self.judge(named(["coulomb_friction"], 0.9)), self.judge(named(["stribeck_friction"], 0.9)), self.judge(named(["backlash"], 0.9)), self.judge(named(["drift"], 0.9))]
        result = score(cases)
        found = {figure.key: figure.value for figure in result.figures}
        self.assertEqual(
            [found[f"messy_{key}"] for key in ("family", "member", "family_sure", "member_sure", "family_sure_wrong", "member_sure_wrong")],
            [0.5, 0.25, 0.5, 0.25, 0.25, 0.5],
        )
        printed = whole(result, "head")
        self.assertRegex(printed, r"(?m)^servo_speed +coulomb, \d\d % +\d+  coulomb_friction +0\.90  first   right  drift, load, beyond:static_bend$")
        self.assertNotIn("named first, R ≥ 10", printed)

    def test_a_set_without_them_has_no_such_figures(self) -> None:
        plain = score([judge("0", CASES[0].label | {"stratum": "single"}, named(["coulomb_friction"]), {"seconds": 1.0})])
        self.assertFalse([figure for figure in plain.figures if figure.key.startswith("messy")])


if __name__ == "__main__":
    unittest.main()
