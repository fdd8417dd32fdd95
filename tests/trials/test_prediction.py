"""One record kept out: the figures of made-up diagrams on a made-up record, and what a verdict states beforehand."""

from __future__ import annotations

import json
import math
import os
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

from trials.measured.machines import Fold
from trials.measured.prediction import lines_of, stated_interval, whole
from trials.measured.sources import Folder, Log

ROOT = Path(__file__).resolve().parents[2]
TOOL = os.environ.get("HYSTERON_TOOL", str(ROOT / "build" / "hysteron"))

PLANT = """FUNCTION_BLOCK PLANT  (* @ts 10ms *)
  VAR_INPUT
    U : LREAL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    G : HY_GAIN := (K := 1.0);
  END_VAR

  G(XIN := U);
  Y := G.XOUT;
END_FUNCTION_BLOCK
"""
RUN = {"seconds": 1.0, "exit": 0, "verdict": True}


def parameters(gain: float) -> str:
    """The gain of the plant, which may be fitted."""
    return f"[parameters.G]\nK = {gain}\n[fit.G]\nK = {{}}\n"


class Stated(unittest.TestCase):
    """Stated intervals."""

    def test_an_interval_is_of_its_signal(self) -> None:
        one = {"signal": "Y", "rms": 1.0, "low": 0.5, "high": 2.0}
        self.assertEqual(stated_interval({"prediction": one}, "y"), (0.5, 2.0))
        self.assertEqual(stated_interval({"prediction": [{"signal": "U", "low": 0.0, "high": 1.0}, one]}, "Y"), (0.5, 2.0))
        for verdict in ({}, {"prediction": []}, {"prediction": one | {"low": None}}, {"prediction": one | {"signal": "U"}}):
            self.assertIsNone(stated_interval(verdict, "Y"))


class Folds(unittest.TestCase):
    """A fold of a plant whose true gain is 3: drawn with 1, tuned to 2, improved to 2.9."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        top = Path(held.name)
        self.data, self.verdicts, cases = top / "data", top / "verdicts", top / "cases"
        for folder in (self.data / "m", self.verdicts / "0", cases / "0"):
            folder.mkdir(parents=True)
        (self.data / "m" / "a.csv").write_text("t,u,y\n" + "".join(f"{k * 0.01:.2f},1.0,3.0\n" for k in range(50)))
        (cases / "0" / "plant.st").write_text(PLANT)
        (self.data / "m" / "plant.st").write_text(PLANT)
        (self.data / "m" / "start.toml").write_text("[fit.G]\nK = {}\n")
        (cases / "0" / "params.toml").write_text(parameters(2.0))
        (self.verdicts / "0" / "improved.st").write_text(PLANT)
        (self.verdicts / "0" / "improved.toml").write_text(parameters(2.9))
        (self.verdicts / "0" / "run.json").write_text(json.dumps(RUN))
        self.verdict = {
            "verdict": "named", "effects": [{"id": "lag", "edge": "U"}], "rivals": [["lag"]], "confidence": 0.5,
            "gap": {"signal": "Y", "improved_rms": 0.07},
        }  # fmt: skip
        whole_one = Folder("m", "plant.st", "start.toml", (Log("a.csv"),))
        self.folds = (Fold("machine, without a", "machine", whole_one, whole_one),)
        self.key = {"folder": str(cases), "cases": {"0": {"name": "machine, without a"}}}

    def lines(self, **more: object) -> list:
        (self.verdicts / "0" / "verdict.json").write_text(json.dumps(self.verdict | more))
        return lines_of(self.key, self.verdicts, self.data, TOOL, self.folds)

    def test_what_each_diagram_leaves(self) -> None:
        (one,) = self.lines()
        self.assertAlmostEqual(one.drawn, 2.0, places=9)
        self.assertAlmostEqual(one.tuned, 1.0, places=9)
        self.assertAlmostEqual(one.improved, 0.1, places=9)
        self.assertIsNone(one.inside)
        printed = whole([one], "head")
        self.assertIn("than by the tuned one, by a tenth or more: 1 of 1", printed)
        self.assertIn("no verdict states an interval", printed)

    def test_a_line_for_each_output_and_the_tuned_diagram_where_nothing_improves_it(self) -> None:
        (self.verdicts / "0" / "improved.st").unlink()
        found = self.lines(gaps=[{"signal": "Y", "improved_rms": 0.07}, {"signal": "U", "improved_rms": 0.5}])
        self.assertEqual([one.signal for one in found], ["Y", "U"])
        self.assertAlmostEqual(found[0].improved, found[0].tuned)
        self.assertTrue(math.isnan(found[1].improved))  # the plant has no output U

    def test_the_stated_interval(self) -> None:
        for low, high, inside in ((0.05, 0.2, True), (0.0, 0.09, False), (0.11, 0.2, False)):
            found = self.lines(prediction={"signal": "Y", "rms": 0.1, "low": low, "high": high})
            self.assertEqual(found[0].inside, inside)
        self.assertIn("within the stated interval: 0 of 1", whole(found, "head"))
        self.assertTrue(math.isnan(found[0].alike))
        self.assertNotIn("of those whose inputs stay", whole(found, "head"))

    def test_where_the_inputs_leave_what_the_interval_is_stated_for(self) -> None:
        (self.data / "m" / "a.csv").write_text("t,u,y\n" + "".join(f"{k * 0.01:.2f},{1.0 if k < 40 else 5.0},3.0\n" for k in range(50)))
        for high, alike, printed in ((2.0, 0.8, None), (5.0, 1.0, "for 95 % of their rows: 0 of 1")):
            stated = {"signal": "Y", "low": 0.0, "high": 0.01, "inputs": [{"signal": "U", "low": 1.0, "high": high}]}
            found = self.lines(prediction=stated)
            self.assertAlmostEqual(found[0].alike, alike)
            self.assertIn(printed or "within the stated interval: 0 of 1", whole(found, "head"))
            self.assertEqual("of those whose inputs stay" in whole(found, "head"), printed is not None)

    def test_where_a_record_begins_is_no_part_of_the_machine(self) -> None:
        integrator = PLANT.replace("G : HY_GAIN := (K := 1.0);", "G : HY_GAIN := (K := 1.0);\n    S : HY_INTEGRAL;")
        integrator = integrator.replace("Y := G.XOUT;", "S(XIN := G.XOUT);\n  Y := S.XOUT;")
        for file in (self.verdicts / "0" / "improved.st", self.key["folder"] + "/0/plant.st"):
            Path(file).write_text(integrator)
        (self.verdicts / "0" / "improved.toml").write_text("[initial.S]\nSUM = -7.0\n\n" + parameters(2.9))
        (self.data / "m" / "a.csv").write_text("t,u,y\n" + "".join(f"{k * 0.01:.2f},1.0,{5.0 + 2.9 * 0.01 * k}\n" for k in range(50)))
        (plain,) = self.lines()
        self.assertGreater(plain.improved, 10.0)
        self.folds = (replace(self.folds[0], starts=("S.SUM",)),)
        (one,) = self.lines()
        self.assertLess(one.improved, 0.05)
        self.assertLess(one.tuned, 0.5)  # begun there, too
        self.assertGreater(one.tuned, one.improved)

    def test_without_a_verdict_nothing_is_counted(self) -> None:
        (self.verdicts / "0" / "run.json").write_text(json.dumps({"exit": -9, "seconds": 1.0, "verdict": False}))
        (one,) = lines_of(self.key, self.verdicts, self.data, TOOL, self.folds)
        self.assertTrue(math.isnan(one.improved))
        self.assertIn("than by the tuned one, by a tenth or more: 0 of 1", whole([one], "head"))

    def test_a_key_of_another_list(self) -> None:
        with self.assertRaisesRegex(SystemExit, "has no such fold"):
            lines_of(self.key, self.verdicts, self.data, TOOL, ())


if __name__ == "__main__":
    unittest.main()
