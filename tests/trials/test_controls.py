"""The controls that must fail: they hold on an honest set, and a leak or a made-up score is found."""

from __future__ import annotations

import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

from tests.trials.labels import judged, keys, named, truth
from trials.peers.largest import verdict
from trials.scoring.beside import SHOWN, beside
from trials.scoring.controls import TooFew, always, coarse, enough, peeking, shuffled, table
from trials.scoring.figures import score

ROOT = Path(__file__).resolve().parents[2]
KEYS = {f"{int(name) * 7919 % 2**47:012x}": label for name, label in keys("controls").items()}
RIGHT = {name: truth(label) for name, label in KEYS.items()}


def half_right() -> dict:
    """Every second single or cousin gets another name."""
    wrong = named(["creep"])
    return {name: wrong if number % 2 and KEYS[name]["stratum"] in ("single", "cousin") else RIGHT[name] for number, name in enumerate(KEYS)}


class Controls(unittest.TestCase):
    """On made-up verdicts."""

    def test_shuffled_labels_are_at_chance(self) -> None:
        for answers in (RIGHT, half_right()):
            self.assertTrue(shuffled(judged(KEYS, answers), np.random.default_rng(1)).held)

    def test_a_diagnoser_that_ignores_the_record_scores_no_better_than_with_shuffled_labels(self) -> None:
        self.assertFalse(shuffled(judged(KEYS, {name: named(["creep"]) for name in KEYS}), np.random.default_rng(1)).held)

    def test_always_the_same(self) -> None:
        self.assertTrue(always("creep", KEYS).held)
        self.assertIn("100.0 %", always("creep", KEYS).found)

    def test_peeking_finds_a_leak_and_nothing_where_there_is_none(self) -> None:
        chosen = dict(list(KEYS.items())[:240])
        effects = sorted({label["effects"][0]["id"] for label in chosen.values() if label["effects"]})
        for leak in (False, True):
            with self.subTest(leak=leak), tempfile.TemporaryDirectory() as name:
                rng = np.random.default_rng(2)
                for case, label in chosen.items():
                    folder = Path(name) / case
                    folder.mkdir()
                    told = effects.index(label["effects"][0]["id"]) if label["effects"] and leak else int(rng.integers(40))
                    for file, size in (("plant.st", 50), ("params.toml", 60), ("log.csv", 1000 + told)):
                        (folder / file).write_text("x" * size)
                        os.utime(folder / file, (1, 1))
                control = peeking(judged(chosen, {n: RIGHT[n] for n in chosen}), Path(name), rng)
                self.assertEqual(control.held, not leak, control.found)

    def test_coarse_sub_steps_have_to_lower_the_score(self) -> None:
        fine, rough = judged(KEYS, RIGHT), judged(KEYS, half_right())
        self.assertTrue(coarse(fine, rough).held)
        self.assertFalse(coarse(rough, fine).held)
        self.assertIn("NOT AS IT SHOULD BE", table([coarse(rough, fine)]))


class Peers(unittest.TestCase):
    """Beside the product."""

    def test_a_column_each(self) -> None:
        printed = beside({"hysteron": score(judged(KEYS, RIGHT)), "always": score(judged(KEYS, half_right()))})
        self.assertEqual(len(printed.splitlines()), 2 + len(SHOWN))
        self.assertRegex(printed, r"single effect named first, R ≥ 10 .*100\.0 % +\d\d\.\d %")


    def test_the_largest_single_fit_wins_whatever_else_is_known(self) -> None:
        gap = {"nominal_rms": 5.0, "floor_rms": 1.0, "improved_rms": 1.0, "closed": 0.9, "closed_low": 0.8, "closed_high": 1.0}
        fitted = [
            {"effects": ["creep", "lag"], "edges": ["A", "B"], "improved_rms": 1.0},
            {"effects": ["delay"], "edges": ["B"], "improved_rms": 3.0},
            {"effects": ["backlash"], "edges": ["A"], "improved_rms": 2.0},
        ]
        found = verdict({"verdict": "none", "gap": gap, "fitted": fitted}, 1.0)
        self.assertEqual((found["verdict"], found["effects"][0]["id"], found["effects"][0]["edge"]), ("named", "backlash", "A"))
        self.assertAlmostEqual(found["gap"]["closed"], 1 - 3 / 24)
        self.assertEqual(verdict({"gap": gap, "fitted": []}, 1.0)["verdict"], "none")

class Refusals(unittest.TestCase):
    """Sets on which a control says nothing."""

    def test_too_few_cases(self) -> None:
        few = dict([(name, label) for name, label in KEYS.items() if label["stratum"] == "single"][:20])
        with self.assertRaisesRegex(TooFew, "too few for controls"):
            enough(judged(few, {name: RIGHT[name] for name in few}))
        enough(judged(KEYS, RIGHT))

    def test_a_folder_that_is_not_there_is_no_proof(self) -> None:
        with self.assertRaises(FileNotFoundError):
            peeking(judged(KEYS, RIGHT), Path("/no/such/folder"), np.random.default_rng(1))


if __name__ == "__main__":
    unittest.main()
