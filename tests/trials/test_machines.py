"""Real machines: how their cases are cut and tuned, and the table of verdicts. The machines here are made up."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from trials.measured import machines
from trials.measured.bases import data_folder
from trials.measured.machine_table import lines_of, totals, whole
from trials.measured.machines import ALL, FOLDS, Case
from trials.measured.sources import Folder, Log
from trials.measured.tuned import Job, case_name, make_set
from trials.scoring.causes import Cause

ROOT = Path(__file__).resolve().parents[2]

PRODUCT = """#!/bin/sh
while [ $# -gt 0 ]; do
  case "$1" in --out) out=$2 ;; --start) starts=$2 ;; esac
  shift
done
echo tuned >>"{count}"
grep -q refuse log.csv && {{ echo "HY507: uneven" >&2; exit 2; }}
echo "[parameters]" >"$out"
echo "K = $starts.0" >>"$out"
"""


class Cuts(unittest.TestCase):
    """Logs are cut as text, so that what was written is what is read."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.data = Path(held.name)
        (self.data / "axis").mkdir()
        (self.data / "axis" / "log.csv").write_text("t,pwm,y\n" + "".join(f"{k},{10 * k},0.{k}0\n" for k in range(6)))
        (self.data / "axis" / "plant.st").write_text("(* @ts 1ms *)\n")
        (self.data / "axis" / "start.toml").write_text("[fit]\nK = {}\n")

    def test_halves_share_no_row_and_leave_none_out(self) -> None:
        first, second = Log("log.csv").halves(6)
        self.assertEqual(first.text(self.data / "axis"), "t,pwm,y\n0,0,0.00\n1,10,0.10\n2,20,0.20\n")
        self.assertEqual(second.text(self.data / "axis"), "t,pwm,y\n3,30,0.30\n4,40,0.40\n5,50,0.50\n")

    def test_thinned_with_its_diagram(self) -> None:
        thin = Folder("axis", "plant.st", "start.toml", (Log("log.csv", stride=4),), (("@ts 1ms", "@ts 4ms"),))
        files = thin.files(self.data)
        self.assertEqual(files["log.csv"], "t,pwm,y\n0,0,0.00\n4,40,0.40\n")
        self.assertIn("@ts 4ms", files["plant.st"])
        with self.assertRaisesRegex(ValueError, "0 times, not once"):
            Folder("axis", "plant.st", "start.toml", thin.logs, (("@ts 2ms", "@ts 8ms"),)).files(self.data)

    def test_a_column_out_of_others(self) -> None:
        volts = Log("log.csv", last=2, column="u", formula=lambda row: row["pwm"] / 4.0)
        self.assertEqual(volts.text(self.data / "axis"), "t,pwm,y,u\n0,0,0.00,0.0\n1,10,0.10,2.5\n")

    def test_several_logs_and_what_is_missing(self) -> None:
        both = Folder("axis", "plant.st", "start.toml", Log("log.csv").halves(6))
        self.assertEqual(sorted(both.files(self.data)), ["log.csv", "log2.csv", "params.toml", "plant.st"])
        self.assertTrue(both.exists(self.data))
        self.assertFalse(Folder("axis", "plant.st", "start.toml", (Log("other.csv"),)).exists(self.data))


class Tuning(unittest.TestCase):
    """A case is tuned once, by the product, from ten starts."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.top = Path(held.name)
        self.product = self.top / "product"
        self.product.write_text(PRODUCT.format(count=self.top / "count"))
        self.product.chmod(0o755)

    def job(self, name: str, log: str) -> Job:
        return Job(name, {"plant.st": "", "params.toml": "[fit]\nK = {}\n", "log.csv": log}, {})

    def make(self, *jobs: Job) -> dict:
        make_set("machines", list(jobs), str(self.product), self.top / "cases", self.top / "key.json", 2)
        return json.loads((self.top / "key.json").read_text())["cases"]

    def test_tuned_values_are_diagnosed_and_a_refusal_leaves_the_start(self) -> None:
        good, bad = self.job("good", "t\n0\n"), self.job("bad", "refuse\n")
        labels = self.make(good, bad)
        self.assertEqual((self.top / "cases" / case_name(good) / "params.toml").read_text(), "[parameters]\nK = 10.0\n")
        self.assertEqual((self.top / "cases" / case_name(bad) / "params.toml").read_text(), bad.files["params.toml"])
        self.assertEqual([labels[case_name(one)]["tune"]["exit"] for one in (good, bad)], [0, 2])
        self.assertIn("HY507", labels[case_name(bad)]["tune"]["messages"])

    def test_a_case_is_made_anew_only_where_it_holds_something_else(self) -> None:
        kept, changed = self.job("kept", "t\n0\n"), self.job("changed", "t\n1\n")
        self.make(kept, changed)
        self.make(kept, changed)
        self.assertEqual((self.top / "count").read_text().count("tuned"), 2)
        other = self.job("changed", "t\n2\n")
        self.make(kept, other)
        self.assertEqual((self.top / "count").read_text().count("tuned"), 3)
        self.assertEqual({one.name for one in (self.top / "cases").iterdir() if one.is_dir()}, {case_name(kept), case_name(other)})


NOWHERE = Folder("", "", "", ())
LIST = (
    Case("axis, one", "axis", NOWHERE, (Cause.of("dry_friction", "coulomb_friction"),), True, ""),
    Case("axis, two", "axis", NOWHERE, (Cause.of("dry_friction", "coulomb_friction"),), False, ""),
    Case("oven", "oven", NOWHERE, (Cause.of("linear_dynamics", "delay"),), True, ""),
    Case("valve", "valve", NOWHERE, (Cause.of("dry_friction"),), True, ""),
)


class Table(unittest.TestCase):
    """The table of made-up verdicts."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.verdicts = Path(held.name)
        self.labels = {f"{number}": {"name": case.name, "rows": 100, "tune": {"seconds": 2.0}} for number, case in enumerate(LIST)}
        for number, (effect, confidence) in enumerate((("coulomb_friction", 0.9), ("stribeck_friction", 0.3), ("drift", 0.6))):
            self.leave(number, {"verdict": "named", "effects": [{"id": effect, "edge": "U"}], "rivals": [[effect]], "confidence": confidence})
        self.leave(3, None, 2, "HY507: the time goes on by 0.2 s")

    def leave(self, number: int, verdict: dict | None, code: int = 0, messages: str = "") -> None:
        folder = self.verdicts / str(number)
        folder.mkdir()
        (folder / "run.json").write_text(json.dumps({"seconds": 4.0, "exit": code, "messages": messages, "verdict": verdict is not None}))
        if verdict:
            (folder / "verdict.json").write_text(json.dumps(verdict))

    def test_figures(self) -> None:
        found = {one.title.strip(): (one.value.hits, one.value.count) for one in totals(lines_of(self.labels, self.verdicts, LIST))}
        self.assertEqual(found["right family first"], (2, 4))
        self.assertEqual(found["machines on which it is first in all cases"], (1, 3))
        self.assertEqual(found["right member first, where the record can tell"], (1, 3))
        self.assertEqual(found["sure, P ≥ 0.7, among those with the right family first"], (1, 2))
        self.assertEqual(found["another family first although P ≥ 0.5"], (1, 4))
        self.assertEqual(found["another family first although P ≥ 0.7"], (0, 4))
        self.assertEqual(found["refused without need"], (1, 4))
        self.assertEqual(found["no verdict at all: crash or time limit"], (0, 4))

    def test_text(self) -> None:
        printed = whole(lines_of(self.labels, self.verdicts, LIST), "head")
        self.assertRegex(printed, r"(?m)^axis, one .*coulomb_friction at U +0\.90  first   right .*2 s +4 s$")
        self.assertRegex(printed, r"(?m)^axis, two .*first   no \*")
        self.assertRegex(printed, r"(?m)^    HY507: the time goes on by 0\.2 s$")
        self.assertRegex(printed, r"right family first +50 % +15 … 85 % +2 of 4 +≥ 85 % +missed")

    def test_a_key_of_another_list(self) -> None:
        with self.assertRaisesRegex(SystemExit, "has no such case"):
            lines_of({"0": {"name": "spaceship", "rows": 1, "tune": {"seconds": 0.0}}}, self.verdicts, LIST)


class Listed(unittest.TestCase):
    """The list in the project."""

    def test_names_are_their_own(self) -> None:
        self.assertEqual(len({case.name for case in ALL}), len(ALL))
        self.assertEqual(len({fold.name for fold in FOLDS}), len(FOLDS))

    def test_every_case_says_what_its_record_can_tell(self) -> None:
        for case in ALL:
            with self.subTest(case.name):
                self.assertTrue(case.why and any(not cause.beside for cause in case.causes))

    def test_a_fold_keeps_out_what_it_is_judged_on(self) -> None:
        for fold in FOLDS:
            with self.subTest(fold.name):
                self.assertEqual(len(fold.kept.logs), 1)
                self.assertTrue(fold.rest.logs)
                self.assertNotIn(fold.kept.logs[0], fold.rest.logs)

    def test_without_the_records_it_says_so(self) -> None:
        with tempfile.TemporaryDirectory() as empty:
            command = [str(ROOT / "trials" / "machines"), "make", "--out", f"{empty}/cases", "--key", f"{empty}/key.json", "--product", "/bin/true"]
            done = subprocess.run(command, env={**os.environ, "HYSTERON_DATA": empty}, capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (77, ""))
            self.assertIn("skipped", done.stdout)

    @unittest.skipUnless(data_folder() and (data_folder() / "machines").is_dir(), "there is no folder of real machines")
    def test_every_record_is_there_and_emps_is_as_long_as_it_is_cut(self) -> None:
        data = data_folder()
        for case in ALL:
            with self.subTest(case.name):
                self.assertTrue(case.source.exists(data))
        self.assertEqual(machines.EMPS.text(data / "machines" / "emps").count("\n") - 1, machines.EMPS_ROWS)


if __name__ == "__main__":
    unittest.main()
