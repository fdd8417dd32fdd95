"""The trial on measured records: effects injected backwards, and the worth of a verdict; with the records, a case of each kind."""

from __future__ import annotations

import json
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

from trials.generator import effects
from trials.generator.effects import Context
from trials.measured import commands
from trials.measured.bases import data_folder
from trials.measured.make import jobs, make_set
from trials.measured.results import mark, whole
from trials.scoring.judge import judge

ROOT = Path(__file__).resolve().parents[2]
TOOL = os.environ.get("HYSTERON_TOOL", str(ROOT / "build" / "hysteron"))


class Backwards(unittest.TestCase):
    """The logged command, sent through the generator's effect, is what the machine received."""

    def test_an_effect_takes_its_own_inverse_back(self) -> None:
        t = np.arange(3000) * 0.01
        received = np.sin(1.3 * t) * (1 - 0.02 * t) + 0.4 * np.sin(5.1 * t)
        other = np.sign(np.sin(0.7 * t)) / 2
        for effect, (inverse, start, _) in commands.CATALOGUE.items():
            with self.subTest(effect):
                context = Context(0.01, 1, float(np.ptp(received)), other)
                logged = inverse(received, context, start, np.random.default_rng(3))
                self.assertGreater(float(np.max(np.abs(logged - received))), 0.01)
                again = effects.CATALOGUE[effect][0].apply(logged, context, start, np.random.default_rng(3))
                settled = slice(60, -60)  # a play needs a first reversal, a delay a first sample
                np.testing.assert_allclose(again[settled], received[settled], atol=2e-4)


LABEL = {
    "stratum": "withheld", "plant": "stack", "what": "lag or creep", "ratio": 10.0, "deviation_ratio": 0.0, "noise_rms": [1.0],
    "effect_rms": [10.0], "excluded": ["coulomb_friction"], "same": ["delay"],
    "effects": [{"id": "lag", "edges": [], "realisation": "lag"}, {"id": "creep", "edges": [], "realisation": "creep"}],
}  # fmt: skip


class Worth(unittest.TestCase):
    """What a verdict is worth against a published cause."""

    def test_marks(self) -> None:
        for kind, first, rivals, confidence, wanted in (
            ("named", "creep", [["creep"]], 0.99, "first"),
            ("named", "delay", [["delay"]], 0.99, "first"),
            ("group", "drift", [["drift"], ["lag"]], 0.6, "rival"),
            ("group", "drift", [["drift"], ["load"]], 0.6, "open"),
            ("unknown", "", [], 0.9, "open"),
            ("named", "drift", [["drift"]], 0.95, "wrong"),
            ("group", "coulomb_friction", [["coulomb_friction"], ["lag"]], 0.95, "wrong"),
        ):
            answer = {
                "verdict": kind, "effects": [{"id": first, "edge": "U"}] if first else [], "rivals": rivals, "confidence": confidence,
                "gap": {"nominal_rms": 10.0, "improved_rms": 1.0, "closed": 1.0},
            }  # fmt: skip
            with self.subTest(first=first, kind=kind):
                self.assertEqual(mark(judge("0", LABEL, answer, {})), wanted)

    def test_the_table_counts_a_missing_verdict_as_no_name(self) -> None:
        printed = whole([judge("0", LABEL, None, {})], "head")
        self.assertIn("missing", printed)
        self.assertRegex(printed, r"published cause named first .*0 of 1")


@unittest.skipUnless(data_folder(), "there is no folder of measured records, neither HYSTERON_DATA nor ../shared/data")
class Measured(unittest.TestCase):
    """Cases from the records."""

    def test_one_of_each_kind(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            top = Path(name)
            for only, ratio in (("odd_nonlinearity at U", 10.0), ("coupling taken out", 1.0), ("withheld heater 1", 0.0)):
                with self.subTest(only):
                    key = top / "key.json"
                    self.assertEqual(make_set("test", data_folder(), TOOL, top / "cases", key, only), 1)
                    label = next(iter(json.loads(key.read_text())["cases"].values()))
                    self.assertAlmostEqual(label["ratio"], ratio, delta=0.3 * max(ratio, 1.0))
            for case in (top / "cases").iterdir():
                self.assertEqual({file.name for file in case.iterdir()}, {"plant.st", "params.toml", "log.csv"})

    def test_every_diagram_is_there_and_every_block_comes_out(self) -> None:
        for job in jobs():
            self.assertIn("FUNCTION_BLOCK", job.model.text())


if __name__ == "__main__":
    unittest.main()
