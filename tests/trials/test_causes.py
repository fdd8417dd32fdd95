"""Verdicts at the level of families and members: the tree, both forms of a verdict, and what each is worth."""

from __future__ import annotations

import math
import unittest
from typing import Any

from trials.scoring.causes import Cause, Mark, mark_of, of_all, reliability
from trials.scoring.claim import claim
from trials.families import FAMILIES, OTHER_NAMES, family_of, stated_family

RUN = {"seconds": 3.0, "exit": 0, "verdict": True}


def older(kind: str, *effects: str, confidence: float = 0.9, rivals: tuple[tuple[str, ...], ...] = ()) -> dict[str, Any]:
    """A verdict with one confidence for all."""
    return {
        "verdict": kind, "effects": [{"id": one, "edge": "U"} for one in effects], "confidence": confidence,
        "rivals": [list(one) for one in rivals] or [list(effects)],
    }  # fmt: skip


def newer(kind: str, families: dict[str, float], *effects: tuple[str, str, float]) -> dict[str, Any]:
    """A verdict that states families, and of each effect its own probability."""
    return {
        "verdict": kind, "confidence": 0.1, "rivals": [],
        "effects": [{"id": name, "edge": "U", "family": family, "probability": p} for name, family, p in effects],
        "families": [{"family": family, "probability": p} for family, p in families.items()],
    }  # fmt: skip


DRY = Cause.of("dry_friction", "coulomb_friction", "asymmetric_friction", twins=("saturation",))
OFFSET = Cause.of("offset", twins=("load",), beside=True)
CAUSES = (DRY, OFFSET)


def mark(verdict: dict[str, Any] | None, run: dict[str, Any] | None = None, causes: tuple[Cause, ...] = CAUSES) -> Mark:
    """Read and judged."""
    return mark_of(claim(verdict, RUN if run is None else run), causes)


class Tree(unittest.TestCase):
    """Families and their members."""

    def test_a_member_has_one_family(self) -> None:
        members = [one for listed in FAMILIES.values() for one in listed]
        self.assertEqual(len(members), len(set(members)))

    def test_names_are_read_as_the_tree_has_them(self) -> None:
        for effect, family in (("coulomb_friction", "dry_friction"), ("Coulomb friction", "dry_friction"), ("dead-zone", "play"), ("lag", "linear_dynamics")):
            self.assertEqual(family_of(effect), family)

    def test_what_the_tree_has_not_is_of_the_family_that_is_stated_or_of_none(self) -> None:
        self.assertEqual(family_of("elastoplastic", "dry friction"), "dry_friction")
        self.assertEqual(family_of("elastoplastic"), "elastoplastic")
        self.assertEqual(family_of("coulomb_friction", "slow_change"), "dry_friction")

    def test_other_names_of_families_lead_into_the_tree(self) -> None:
        self.assertEqual(stated_family("Periodic in place"), "periodic_over_position")
        self.assertTrue(set(OTHER_NAMES.values()) <= set(FAMILIES))
        self.assertFalse(set(OTHER_NAMES) & set(FAMILIES))

    def test_a_cause_is_of_the_tree(self) -> None:
        with self.assertRaisesRegex(ValueError, "no family; the tree has dry_friction"):
            Cause.of("rust")
        self.assertIn("stribeck_friction", Cause.of("dry_friction").members)


class Claims(unittest.TestCase):
    """What is read of a verdict."""

    def test_one_confidence_counts_for_family_and_member(self) -> None:
        one = claim(older("named", "coulomb_friction", "offset", confidence=0.8), RUN)
        self.assertEqual((one.first_family, one.family_probability, one.member_probability), ("dry_friction", 0.8, 0.8))
        self.assertEqual(one.stated, {"dry_friction", "offset"})

    def test_stated_families_go_before_the_confidence(self) -> None:
        one = claim(newer("partial", {"dry_friction": 0.97, "offset": 0.6, "play": 0.1}, ("stribeck_friction", "dry_friction", 0.4)), RUN)
        self.assertEqual((one.first_family, one.family_probability, one.member_probability), ("dry_friction", 0.97, 0.4))
        self.assertEqual(one.stated, {"dry_friction", "offset"})
        self.assertEqual(one.rival_families, {"dry_friction", "offset", "play"})

    def test_an_effect_that_another_tree_sorts_otherwise(self) -> None:
        one = claim(newer("named", {"static_curve": 0.8}, ("dead_zone", "static_curve", 0.6)), RUN)
        self.assertEqual((one.first_family, one.family_probability, one.member_probability), ("play", 0.8, 0.6))
        self.assertFalse(one.strange)
        self.assertEqual(claim(newer("named", {"rust": 0.8}, ("corrosion", "rust", 0.6)), RUN).strange, {"rust"})

    def test_a_family_without_a_member_may_stand_first(self) -> None:
        one = claim(newer("group", {"slow_change": 0.2, "dry_friction": 0.8}), RUN)
        self.assertEqual((one.first_family, one.family_probability), ("dry_friction", 0.8))
        self.assertTrue(math.isnan(one.member_probability))
        self.assertIsNone(claim(newer("unknown", {"dry_friction": 0.4}), RUN).first)

    def test_effects_of_a_verdict_that_names_none_are_no_names(self) -> None:
        self.assertIsNone(claim(older("unknown", "lag"), RUN).first)

    def test_calibration_is_no_effect(self) -> None:
        self.assertEqual(claim(older("partial", "gain_error", "lag"), RUN).first_family, "linear_dynamics")

    def test_refused_or_missing(self) -> None:
        self.assertEqual(claim(None, {"exit": 2, "seconds": 0.1}).kind, "refused")
        self.assertEqual(claim(older("unknown") | {"refused": True}, RUN).kind, "refused")
        self.assertEqual(claim(None, {"exit": -11, "seconds": 0.1}).kind, "missing")

    def test_odd_numbers_are_no_probabilities(self) -> None:
        one = claim(newer("named", {"dry_friction": 7.0}, ("coulomb_friction", "dry_friction", -1.0)), RUN)
        self.assertEqual((one.family_probability, one.member_probability), (0.0, 0.1))


class Worth(unittest.TestCase):
    """Marks of made-up verdicts against friction with an offset beside."""

    def test_marks(self) -> None:
        for verdict, family, member in (
            (older("named", "coulomb_friction"), "first", True),
            (older("named", "stribeck_friction"), "first", False),
            (older("partial", "saturation", "lag"), "twin", False),
            (older("named", "load"), "beside", False),
            (older("named", "lag", "coulomb_friction"), "set", False),
            (older("group", "lag", rivals=(("lag",), ("coulomb_friction",))), "rival", False),
            (older("named", "lag"), "wrong", False),
            (older("unknown"), "open", False),
            (older("none"), "open", False),
            (newer("partial", {"slow_change": 0.9, "dry_friction": 0.8}, ("drift", "slow_change", 0.9)), "set", False),
            (newer("group", {"dry_friction": 0.8}), "first", False),
            (None, "missing", False),
        ):
            with self.subTest(verdict):
                one = mark(verdict)
                self.assertEqual((one.family, one.member), (family, member))
        self.assertEqual(mark(None, {"exit": 2}).family, "refused")

    def test_a_machine_without_a_cause(self) -> None:
        for verdict, family in ((older("none"), "first"), (older("calibration"), "first"), (older("unknown"), "open"), (older("named", "lag"), "wrong")):
            self.assertEqual(mark(verdict, causes=()).family, family)

    def test_another_family_counts_from_its_probability_on(self) -> None:
        self.assertTrue(mark(older("named", "lag", confidence=0.7)).another(0.7))
        self.assertFalse(mark(older("named", "lag", confidence=0.69)).another(0.7))
        for kept in (older("named", "coulomb_friction"), older("named", "saturation"), older("named", "offset"), older("unknown"), None):
            self.assertFalse(mark(kept).another(0.0))

    def test_shares(self) -> None:
        marks = [
            mark(older("named", "coulomb_friction", confidence=0.9)), mark(older("named", "coulomb_friction", confidence=0.2)),
            mark(older("named", "stribeck_friction", confidence=0.9)), mark(older("named", "lag", confidence=0.9)),
        ]  # fmt: skip
        found = {name: one.hits for name, one in of_all(marks, 0.7).items()}
        self.assertEqual(found, {"family": 3, "member": 2, "family_sure": 2, "member_sure": 1, "family_sure_wrong": 1, "member_sure_wrong": 2})

    def test_reliability_counts_each_class_by_itself(self) -> None:
        marks = [mark(older("named", effect, confidence=p)) for effect, p in (("coulomb_friction", 0.95), ("lag", 0.95), ("coulomb_friction", 1.0), ("lag", 0.2), ("offset", 0.2))]
        printed = reliability([*marks, mark(older("unknown"))])
        self.assertRegex(printed, r"0\.9 … 1\.0, mean 0\.97 +2 of 3 +67 %")
        self.assertRegex(printed, r"0\.1 … 0\.3, mean 0\.20 +0 of 1 +0 %")
        self.assertEqual(printed.count("\n"), 2)


if __name__ == "__main__":
    unittest.main()
