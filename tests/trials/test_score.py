"""The scorer: known proportions, and controls that must score what they should."""

from __future__ import annotations

import unittest

import numpy as np

from tests.trials.labels import judged, keys, named, truth
from trials.scoring import statistics
from trials.scoring.figures import Figure, figures, score
from trials.scoring.floors import broken, proposal
from trials.scoring.page import page
from trials.scoring.text import whole

KEYS = keys()


def by_key(found: list[Figure]) -> dict[str, Figure]:
    """Figures by their short names."""
    return {f.key: f for f in found}


class Statistics(unittest.TestCase):
    """Against printed values."""

    def test_wilson(self) -> None:
        low, high = statistics.Share(8, 10).interval  # A. Agresti, B. A. Coull, Am. Stat. 52 (1998) 119: 0.490 to 0.943
        self.assertAlmostEqual(low, 0.4902, places=4)
        self.assertAlmostEqual(high, 0.9433, places=4)

    def test_an_interval_holds_its_share(self) -> None:
        for count in range(1, 200):
            for hits in (0, count):
                low, high = statistics.Share(hits, count).interval
                self.assertTrue(0.0 <= low <= hits / count <= high <= 1.0, (hits, count))

    def test_area_under_the_curve(self) -> None:
        self.assertEqual(statistics.auroc([3.0, 4.0], [1.0, 2.0]), 1.0)
        self.assertEqual(statistics.auroc([1.0, 3.0], [2.0, 2.0]), 0.5)
        self.assertEqual(statistics.auroc([2.0], [2.0]), 0.5)

    def test_recall_at_a_false_share(self) -> None:
        negative = [i / 100 for i in range(100)]
        self.assertEqual(statistics.recall_at([0.95, 0.94, 0.2], negative, 0.05).hits, 1)


class Controls(unittest.TestCase):
    """What must fail, fails by as much as it should."""

    def test_a_diagnoser_that_has_read_the_key_reaches_every_goal(self) -> None:
        found = figures(judged(KEYS, {name: truth(label) for name, label in KEYS.items()}))
        for figure in found:
            with self.subTest(figure.key):
                if figure.key == "coverage":
                    self.assertEqual(figure.value, 1.0)
                elif figure.goal is not None:
                    self.assertTrue(figure.reached, f"{figure.key}: {figure.value}")
        perfect = by_key(found)
        for key in ("single_r10", "single_r3", "single_r1", "cousin_r10", "rivals", "pair", "ambiguous", "edge", "auroc", "recall"):
            self.assertEqual(perfect[key].value, 1.0, key)
        for key in ("false_alarm", "third", "sure_wrong", "missing"):
            self.assertEqual(perfect[key].value, 0.0, key)

    def test_always_creep(self) -> None:
        found = by_key(figures(judged(KEYS, {name: named(["creep"]) for name in KEYS})))
        singles = [label for label in KEYS.values() if label["stratum"] == "single" and label["ratio"] >= 10.0]
        creeps = sum(label["effects"][0]["id"] == "creep" for label in singles)
        self.assertGreater(creeps, 0)
        self.assertEqual((found["single_r10"].value * len(singles)), creeps)
        self.assertEqual(found["false_alarm"].value, 1.0)
        self.assertEqual(found["pair"].value, 0.0)
        self.assertEqual(found["auroc"].value, 0.5)
        self.assertGreater(found["sure_wrong"].value, 0.9)

    def test_shuffled_labels_score_at_chance(self) -> None:
        rng = np.random.default_rng(5)
        names = [name for name, label in KEYS.items() if label["stratum"] == "single"]
        moved = dict(zip(names, rng.permutation(names)))
        answers = {name: truth(KEYS[moved.get(name, name)]) for name in KEYS}
        chosen = [c for c in judged(KEYS, answers) if c.stratum == "single"]
        counts = np.unique([c.truth[0] for c in chosen], return_counts=True)[1] / len(chosen)
        chance = float(np.sum(counts**2))
        low, high = statistics.share([c.named_first for c in chosen]).interval
        self.assertLess(low, chance)
        self.assertLess(high, 3.0 * chance)

    def test_names_in_other_letters_and_wrong_edges(self) -> None:
        label = {"0": next(label for label in KEYS.values() if label["stratum"] == "single")}
        effect = label["0"]["effects"][0]["id"]
        for edge, right in (("b", True), (" A ", True), ("C", False)):
            answer = named([effect]) | {"effects": [{"id": effect, "edge": edge}]}
            self.assertEqual(judged(label, {"0": answer})[0].right_edge, right)

    def test_the_edges_that_a_verdict_cannot_tell_apart(self) -> None:
        label = {"0": next(label for label in KEYS.values() if label["stratum"] == "single")}
        effect = label["0"]["effects"][0]["id"]
        for same, right, count in ((["D"], False, 2), (["b ", "D"], True, 3), ([], False, 1), (["C"], False, 1)):
            answer = named([effect]) | {"effects": [{"id": effect, "edge": "C", "same_edges": same}]}
            case = judged(label, {"0": answer})[0]
            self.assertEqual((case.right_edge, case.listed_edge, case.listed_edges), (False, right, count))
        self.assertIsNone(judged(label, {"0": named(["nothing"])})[0].listed_edge)

    def test_the_same_output_by_another_name(self) -> None:
        effect = {"id": "offset", "edge": "U", "edges": ["U"], "realisation": "offset", "same_as": {"drift": ["VEL.XOUT"]}}
        label = {"0": dict(next(iter(KEYS.values())), stratum="single", ratio=10.0, effects=[effect])}
        for name, edge, first, right in (("drift", "VEL.XOUT", True, True), ("drift", "U", True, False), ("lag", "U", False, None)):
            answer = named([name]) | {"effects": [{"id": name, "edge": edge}], "rivals": [[name], ["offset"]]}
            case = judged(label, {"0": answer})[0]
            self.assertEqual((case.named_first, case.right_edge), (first, right))
            self.assertEqual(len(case.rivals), 1 if first else 2)

    def test_nothing_answered_counts_as_wrong(self) -> None:
        cases = judged(KEYS, {name: {} for name in KEYS})
        self.assertEqual(by_key(figures(cases))["missing"].value, 1.0)
        self.assertEqual(by_key(figures(cases))["single_r10"].value, 0.0)

    def test_closure_is_judged_by_the_true_noise(self) -> None:
        label = {"0": next(label for label in KEYS.values() if label["stratum"] == "single")}
        boast = named(["creep"]) | {"gap": {"nominal_rms": 5.0, "improved_rms": 3.0, "closed": 1.0, "closed_low": 0.9, "closed_high": 1.0}}
        case = judged(label, {"0": boast})[0]
        self.assertAlmostEqual(case.closed_true, 1 - (9 - 1) / (25 - 1))

    def test_only_wrong_verdicts_near_the_machine_are_undecidable(self) -> None:
        chosen = {name: label for name, label in KEYS.items() if label["stratum"] == "single" and label["ratio"] >= 5.5}
        answers = {name: truth(label) for name, label in chosen.items()}
        wrong = list(chosen)[:3]
        answers |= {name: named(["no_such"]) for name in wrong}
        cases = judged(chosen, answers)
        for case in cases:
            case.apart = 0.5 if case.name in wrong[:2] else 2.0
        cases[-1].apart = 0.1  # right, whatever its distance
        one = by_key(score(cases).figures)["single_r10"]
        self.assertEqual(one.count, len(chosen))
        self.assertAlmostEqual(one.value, (len(chosen) - 3) / len(chosen))
        self.assertAlmostEqual(one.decidable, (len(chosen) - 3) / (len(chosen) - 2))
        printed = whole(score(cases), "head")
        self.assertIn("without the 2 wrong verdicts", printed)

    def test_without_distances_nothing_is_said_of_what_is_decidable(self) -> None:
        found = score(judged(KEYS, {name: named(["creep"]) for name in KEYS}))
        self.assertTrue(all(f.decidable != f.decidable for f in found.figures))
        self.assertNotIn("wrong verdicts whose", whole(found, "head"))


class Output(unittest.TestCase):
    """Text, page and floors of a score."""

    def setUp(self) -> None:
        self.score = score(judged(KEYS, {name: named(["creep"]) for name in KEYS}))

    def test_text_and_page_hold_every_figure(self) -> None:
        printed, shown = whole(self.score, "head"), page(self.score, "head")
        for figure in self.score.figures:
            self.assertIn(figure.title, printed)
        self.assertIn("data:image/svg+xml;base64,", shown)
        self.assertNotIn("http://", shown.replace("http://www.w3.org", ""))
        self.assertNotIn("<script", shown)

    def test_effects_by_plants_holds_each_clear_single_case_once(self) -> None:
        cases = judged(KEYS, {name: truth(label) for name, label in KEYS.items()})
        clear = [c for c in cases if c.stratum == "single" and c.ratio >= 5.5]
        cells = [cell for line in score(cases).by_plant.values() for cell in line.values()]
        self.assertGreater(len(clear), 0)
        self.assertEqual((sum(hits for hits, _ in cells), sum(count for _, count in cells)), (len(clear), len(clear)))

    def test_floors(self) -> None:
        self.assertEqual(broken(self.score.figures, proposal(self.score.figures)), [])
        self.assertEqual(len(broken(self.score.figures, {"floors": {"pair": 0.5, "false_alarm": 0.1, "no_such": 0.0}})), 3)


if __name__ == "__main__":
    unittest.main()
