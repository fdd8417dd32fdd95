"""The scorer: known proportions, and controls that must score what they should."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

from tests.trials.labels import judged, keys, named, truth
from trials.scoring import statistics
from trials.scoring.figures import Figure, figures, score
from trials.scoring.floors import below, proposal
from trials.scoring.page import page
from trials.scoring.text import whole
from trials.scoring.verdict import fault_of, read_verdict

ROOT = Path(__file__).resolve().parents[2]
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

    def test_the_interval_of_an_area_has_a_width_however_clear_it_is(self) -> None:
        one = statistics.auroc_interval([2.0], [1.0, 1.5])
        many = statistics.auroc_interval([2.0] * 40, [1.0] * 50)
        self.assertEqual((one[1], many[1]), (1.0, 1.0))
        self.assertLess(one[0], 0.3)
        self.assertAlmostEqual(many[0], statistics.Share(40, 40).interval[0])
        self.assertTrue(all(math.isnan(x) for x in statistics.auroc_interval([], [1.0])))

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
        self.assertEqual(below(self.score.figures, proposal(self.score.figures)), [])
        self.assertEqual(len(below(self.score.figures, {"floors": {"pair": 0.5, "false_alarm": 0.1, "no_such": 0.0}})), 3)

ODD = (
    {"effects": None}, {"effects": {}}, {"effects": ["lag"]}, {"effects": 3}, {"effects": [{"id": "lag", "same_edges": None}]}, {"effects": [{"id": 3}]},
    {"rivals": None}, {"rivals": [1, 2]}, {"rivals": ["lag"]}, {"gap": [1]}, {"gap": "x"}, {"gap": {"improved_rms": 1e300}}, {"gap": {"closed": "much"}},
    {"confidence": 5}, {"confidence": -1}, {"confidence": "high"}, {"confidence": math.nan}, {"unknown_score": math.inf}, {"verdict": "guilty"}, {"verdict": ["none"]},
    {"cannot_tell": "anything"}, {"effects": []}, {"verdict": "group", "effects": []},
)  # fmt: skip


class Verdicts(unittest.TestCase):
    """A verdict that is none counts as missing, and stops no score."""

    def test_each_oddity_is_named(self) -> None:
        self.assertEqual(fault_of(named(["creep"])), "")
        for odd in ODD:
            with self.subTest(odd):
                self.assertNotEqual(fault_of(named(["creep"]) | odd), "")
        for other in (None, [], "x", 3):
            self.assertEqual(fault_of(other), "a JSON object")

    def test_what_cannot_be_read_is_none(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "verdict.json"
            for text in ("{", "[" * 100_000, "[]", '"x"', "", json.dumps(named(["\ud800"]))):
                file.write_text(text)
                self.assertIsNone(read_verdict(file))
            file.unlink()
            self.assertIsNone(read_verdict(file))
            file.write_text(json.dumps(named(["creep"])))
            self.assertIsNotNone(read_verdict(file))


class CommandLine(unittest.TestCase):
    """`trials/score` on a set of three cases, sealed."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.top = Path(held.name)
        self.key = dict(list(KEYS.items())[:3])
        for name, label in self.key.items():
            (self.top / "v" / name).mkdir(parents=True)
            (self.top / "v" / name / "verdict.json").write_text(json.dumps(truth(label)))
            (self.top / "v" / name / "run.json").write_text('{"seconds": 1.0, "exit": 0, "verdict": true}')
        (self.top / "key.json").write_text(json.dumps({"cases": self.key}))
        shutil.copytree(ROOT / "trials", self.top / "trials")  # a log of openings of its own
        self.log = self.top / "trials" / "openings.log"
        self.log.write_text("")
        (self.top / "pass").write_text("a passphrase of some length")
        (self.top / "pass").chmod(0o600)

    def score(self, *more: str, key: str = "key.json") -> subprocess.CompletedProcess:
        command = [str(self.top / "trials" / "score"), str(self.top / "v"), "--key", str(self.top / key), "--out", str(self.top / "s"), *more]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=self.top)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def test_odd_verdicts_are_missing_and_the_rest_is_scored(self) -> None:
        first = next(iter(self.key))
        (self.top / "v" / first / "verdict.json").write_text('{"verdict": "named", "effects": null}')
        done = self.score()
        self.assertEqual(done.returncode, 0)
        self.assertIn(f"{first}: no verdict; wanted is effects", done.stderr)
        found = json.loads((self.top / "s" / "score.json").read_text(), parse_constant=self.fail)
        missing = next(f for f in found["figures"] if f["key"] == "missing")
        self.assertAlmostEqual(missing["value"], 1 / 3)

    def test_a_case_that_was_never_run_is_told(self) -> None:
        first = next(iter(self.key))
        shutil.rmtree(self.top / "v" / first)
        done = self.score()
        self.assertEqual(done.returncode, 0)
        self.assertIn(f"v/{first}: not run;", done.stderr)
        self.assertEqual(done.stderr.count("not run"), 1)

    def test_what_did_not_end_by_itself_has_no_verdict(self) -> None:
        first = next(iter(self.key))
        for run in ('{"seconds": 180, "exit": "time limit", "verdict": false}', '{"exit": 137}', "zz", '{"seconds": -5, "verdict": "true"}'):
            with self.subTest(run):
                (self.top / "v" / first / "run.json").write_text(run)
                done = self.score()
                self.assertIn(f"{first}: no verdict; by its run.json", done.stderr)
                found = json.loads((self.top / "s" / "score.json").read_text())
                self.assertAlmostEqual(next(f for f in found["figures"] if f["key"] == "missing")["value"], 1 / 3)
                self.assertGreaterEqual(min(found["seconds"]), 0.0)

    def test_what_was_not_worked_out_is_no_figure(self) -> None:
        first = next(iter(self.key))
        found = json.loads((self.top / "v" / first / "verdict.json").read_text())
        (self.top / "v" / first / "verdict.json").write_text(json.dumps(found | {"verdict": "named", "effects": [{"id": "no such", "edge": "U"}], "rivals": [["no such"]]}))
        done = self.score()
        self.assertEqual(done.returncode, 0)
        self.assertIn("is worked out with --product", done.stdout)
        self.assertNotIn("nearer to the machine", done.stdout)

    def test_no_opening_is_spent_on_a_slip(self) -> None:
        passphrase = ("--passphrase-file", str(self.top / "pass"))
        sealed = subprocess.run([str(self.top / "trials" / "seal"), "new", str(self.top / "key.json"), *passphrase], capture_output=True, check=False)
        self.assertEqual(sealed.returncode, 0)
        purpose = ("--purpose", "a test")
        (self.top / "blocked" / "score.txt").mkdir(parents=True)
        (self.top / "empty").mkdir()
        for name, text in (("list", "[1]"), ("words", '{"floors": {"pair": "a"}}'), ("other", '{"flors": {"pair": 0.5}}'), ("none", "x")):
            (self.top / name).write_text(text)
        for slip in (
            passphrase, (*passphrase, "--purpose", " "), purpose, (*passphrase, *purpose, "--product", "/no/such"), (*passphrase, *purpose, "--floors", "/no/such"),
            (*passphrase, *purpose, "--peer", "sparse=empty"), (*passphrase, *purpose, "--peer", "sparse"), (*passphrase, *purpose, "--peer", "verdicts=v"),
            (*passphrase, *purpose, "--peer", "../x=v"), (*passphrase, *purpose, "--peer", "a=v", "--peer", "a=v"), (*passphrase, *purpose, "--out", "blocked"),
            (*passphrase, *purpose, "--jobs", "0"), (*passphrase, *purpose, "--out", "v"), (*passphrase, *purpose, "--peer", "twin=v", "--out", "v/s"),
            ("--passphrase-file", str(self.top / "empty"), *purpose), (*passphrase, *purpose, "--product", "/bin/true"),
            *((*passphrase, *purpose, "--floors", name) for name in ("list", "words", "other", "none")),
        ):  # fmt: skip
            with self.subTest(slip):
                self.assertNotEqual(self.score(*slip, key="key.sealed").returncode, 0)
                self.assertEqual(self.log.read_text(), "")
        done = self.score(*passphrase, *purpose, "--peer", "twin=v", key="key.sealed")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(self.log.read_text(), r"^\S+Z  [0-9a-f]{64}  \S+  a test\n$")
        self.assertIn("twin", (self.top / "s" / "score.html").read_text())
        self.assertIn("twin", json.loads((self.top / "s" / "score.json").read_text())["peers"])

    def test_verdicts_of_another_set(self) -> None:
        for folder in list((self.top / "v").iterdir()):
            folder.rename(folder.with_name("f" + folder.name))
        self.assertIn("they are of another set", self.score().stderr)

    def test_all_that_is_scored_is_hashed(self) -> None:
        printed = set()
        first = self.top / "v" / next(iter(self.key))
        for file, text in (("run.json", '{"seconds": 0.001, "verdict": true}'), ("improved.st", "x"), ("improved.toml", "x"), ("run.json", "{}")):
            (first / file).write_text(text)
            printed.add(next(line for line in self.score().stdout.splitlines() if line.startswith("verdicts ")))
        self.assertEqual(len(printed), 4)


if __name__ == "__main__":
    unittest.main()
