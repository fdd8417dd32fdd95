"""The controls that must fail: they hold on an honest set, and a leak or a made-up score is found."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

from tests.trials.labels import judged, keys, named, truth
from trials.peers.largest import verdict
from trials.runner import fingerprint, run_set
from trials.scoring.beside import SHOWN, beside
from trials.scoring.controls import always, coarse, peeking, shuffled, table
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


PROGRAM = """#!/usr/bin/python3
import os, sys
os.makedirs("result")
open("result/verdict.json", "w").write("{}")
open(%r, "a").write("ran\\n")
"""


class Resumed(unittest.TestCase):
    """A set that was interrupted goes on; verdicts of another diagnoser are not taken for its own."""

    def test_what_has_run_is_not_run_again(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            top = Path(name)
            for case in ("1a", "2b", "3c"):
                (top / "cases" / case).mkdir(parents=True)
                (top / "cases" / case / "plant.st").write_text("x")
            program, runs = top / "program", top / "runs"
            program.write_text(PROGRAM % str(runs))
            program.chmod(0o755)

            def run(options: list[str]) -> int:
                return run_set(top / "cases", top / "out", str(program), options, 1, 10.0, None, False)

            self.assertEqual(run([]), 0)
            (top / "out" / "2b" / "run.json").unlink()  # as if interrupted before it was whole
            self.assertEqual(run([]), 0)
            self.assertEqual(runs.read_text().count("ran"), 4)
            with self.assertRaises(SystemExit):
                run(["--other"])

    def test_an_interrupt_ends_what_runs_and_keeps_what_has_run(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            top = Path(name)
            for case in ("1a", "2b", "3c"):
                (top / "cases" / case).mkdir(parents=True)
                (top / "cases" / case / "plant.st").write_text("x")
            program, runs = top / "program", top / "runs"
            program.write_text(PROGRAM % str(runs) + f"import time\nif open({str(runs)!r}).read().count('ran') == 2:\n    time.sleep(600)\n")
            program.chmod(0o755)
            command = ["env", "--default-signal=INT", str(ROOT / "trials" / "run"), str(top / "cases"), "--out", str(top / "out"), "--product", str(program)]
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as trial:
                while not (runs.exists() and runs.read_text().count("ran") == 2):
                    time.sleep(0.02)
                trial.send_signal(signal.SIGINT)
                said = trial.communicate(timeout=60)[1]
            self.assertEqual(trial.returncode, 130)
            self.assertIn("1 cases have run", said)
            self.assertFalse((top / "out" / "2b" / "run.json").exists())
            done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
            self.assertIn("3 cases run, 0 of them without a verdict", done.stdout)
            self.assertEqual(runs.read_text().count("ran"), 4)

    def test_a_program_that_an_option_names_counts(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            program = Path(name) / "program"
            program.write_text("1")
            before = fingerprint(__file__, [f"--hysteron={program}"])
            program.write_text("2")
            self.assertNotEqual(before, fingerprint(__file__, [f"--hysteron={program}"]))


if __name__ == "__main__":
    unittest.main()
