"""Control loops: labels as their sources write them, what a verdict says of the valve, and the table beside the peers."""

from __future__ import annotations

import json
import tempfile
import unittest
from pathlib import Path
from typing import Any

from tests.trials.test_stiction import DISTURBED, STICKS
from trials.measured.loop_table import ANYWHERE, PEERS, PRODUCT, Line, line, lines_of, receiver, whole
from trials.measured.loops import Loop, loops_in, signals
from trials.measured.sources import Folder
from trials.scoring.stiction import probability

RUN = {"seconds": 1.0, "exit": 0, "verdict": True}


def older(kind: str, *sets: tuple[float, tuple[tuple[str, str], ...]]) -> dict[str, Any]:
    """A verdict with sets that are not ruled out, each with its probability; the first one is named."""
    named = [{"id": effect, "edge": edge} for effect, edge in (sets[0][1] if sets else ())]
    details = [{"effects": [e for e, _ in one], "edges": [e for _, e in one], "probability": p} for p, one in sets]
    return {"verdict": kind, "effects": named, "confidence": 0.4, "rivals": [one["effects"] for one in details], "rival_details": details}


def text(columns: tuple) -> str:
    """A log of OP and PV."""
    return "t,op,pv\n" + "".join(f"{k},{u!r},{y!r}\n" for k, (u, y) in enumerate(zip(*(x.tolist() for x in columns))))


class Labels(unittest.TestCase):
    """READMEs as they come."""

    def read(self, name: str, readme: str) -> Loop:
        with tempfile.TemporaryDirectory() as folder:
            loop = Path(folder) / "machines" / "loops" / name
            loop.mkdir(parents=True)
            (loop / "README.md").write_text(readme)
            return loops_in(Path(folder))[0]

    def test_words_of_the_sources(self) -> None:
        for name, readme, sticks, kind in (
            ("CHEM1", "Source: a book.\nTruth (book's table): stiction. Kind: flow.\n", True, "flow"),
            ("CHEM24", "Truth (book's table): stiction (likely). Kind: flow.\n", True, "flow"),
            ("CHEM13", "Truth (book's table): none: faulty steam sensor. Kind: analyser.\n", False, "analyser"),
            ("FIC1", "a.txt (licence: see LICENSE there). Truth, by the authors' folder: no stiction.\n", False, "flow"),
            ("LIC1", "Truth, by the authors' folder: stiction.", True, "level"),
        ):
            with self.subTest(name):
                loop = self.read(name, readme)
                self.assertEqual((loop.sticks, loop.kind, loop.integrating), (sticks, kind, kind == "level"))

    def test_without_a_label(self) -> None:
        for readme in ("nothing\n", "Truth: who knows.\n"):
            with self.assertRaisesRegex(SystemExit, "no label; write a line"):
                self.read("X", readme)

    def test_columns_by_name(self) -> None:
        op, pv = signals("t,PV,op\n0,1.5,2\n1,2.5,3\n")
        self.assertEqual((op.tolist(), pv.tolist()), ([2.0, 3.0], [1.5, 2.5]))


class Valve(unittest.TestCase):
    """The probability that the valve sticks."""

    def test_of_sets_that_are_not_ruled_out(self) -> None:
        backlash, lag = (("backlash", "OP"),), (("lag", "OP"),)
        for verdict, wanted in (
            (older("named", (1.0, backlash)), 1.0),
            (older("group", (0.6, lag), (0.3, backlash), (0.1, (("lag", "OP"), ("coulomb_friction", "VALVE.XOUT")))), 0.4),
            (older("named", (1.0, lag)), 0.0),
            (older("named", (1.0, (("backlash", "PV"),))), 0.0),
            (older("named", (1.0, (("backlash", "proc.xout"),))), 0.0),
            (older("unknown", (1.0, backlash)), 0.0),
            (older("none"), 0.0),
            ({"verdict": "named", "confidence": 0.3, "effects": [{"id": "backlash", "edge": "PV", "same_edges": ["OP"]}]}, 0.3),
            (None, 0.0),
        ):
            with self.subTest(verdict):
                self.assertAlmostEqual(probability(verdict, RUN), wanted)

    def test_the_right_effect_in_the_wrong_place(self) -> None:
        behind = older("named", (0.8, (("backlash", "PROC.XOUT"),)), (0.2, (("lag", "OP"),)))
        self.assertEqual((probability(behind, RUN), probability(behind, RUN, anywhere=True)), (0.0, 0.8))

    def test_of_stated_families(self) -> None:
        for effects, dry, wanted in (
            ([], 0.8, 0.8),
            ([{"id": "valve_stiction", "edge": "OP", "probability": 0.6}], 0.8, 0.8),
            ([{"id": "backlash", "edge": "OP"}], 0.1, 0.3),
            ([{"id": "backlash", "edge": "OP", "probability": 0.7}], 0.1, 0.7),
            ([{"id": "coulomb_friction", "edge": "PV"}], 0.8, 0.0),
            ([{"id": "lag", "edge": "OP"}], 0.8, 0.8),
        ):
            with self.subTest(effects):
                families = [{"family": "dry_friction", "probability": dry}, {"family": "play", "probability": 0.3}]
                found = probability({"verdict": "partial", "confidence": 0.1, "effects": effects, "families": families}, RUN)
                self.assertAlmostEqual(found, wanted)


class Table(unittest.TestCase):
    """The table of two loops that are simulated, and of made-up scores."""

    def test_a_perfect_product(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            data, verdicts = Path(name) / "data", Path(name) / "verdicts"
            for loop, label, columns, verdict in (
                ("A", "stiction", STICKS, older("named", (1.0, (("backlash", "OP"),)))), ("B", "none", DISTURBED, older("named", (1.0, (("lag", "OP"),)))),
            ):  # fmt: skip
                folder = data / "machines" / "loops" / loop
                folder.mkdir(parents=True)
                (folder / "README.md").write_text(f"Truth (made up): {label}.\n")
                (folder / "log.csv").write_text(text(columns))
                (verdicts / loop).mkdir(parents=True)
                (verdicts / loop / "verdict.json").write_text(json.dumps(verdict))
                (verdicts / loop / "run.json").write_text(json.dumps(RUN))
            lines = lines_of({"A": {"name": "A"}, "B": {"name": "B"}}, verdicts, loops_in(data), data)
            printed = whole(lines, "head")
        self.assertRegex(printed, r"(?m)^A .*stiction +1\.00\+ +1\.00\+ +0\.\d\d\+ .*named backlash at OP$")
        self.assertRegex(printed, r"(?m)^hysteron +1\.00 .* 2 of 2 .* 0 +1 +1 +1 +1$")
        self.assertRegex(printed, r"(?m)^correlation +1\.00 .* 2 of 2 ")
        self.assertIn("no false alarm: reached", printed)

    def test_the_curve_counts_ties_together(self) -> None:
        def made(score: float, sticks: bool) -> Line:
            return Line(Loop("", "stiction" if sticks else "none", "", Folder("", "", "", ())), "", 0.0, {PRODUCT: score})

        lines = [made(0.9, True), made(0.5, True), made(0.5, False), made(0.1, False), made(0.0, True)]
        self.assertEqual(receiver(lines, PRODUCT), [(0, 0), (0, 1), (1, 2), (2, 2), (2, 3)])

    def test_a_false_alarm_misses_the_goal(self) -> None:
        scores = {name: 0.5 for name in (*PEERS, ANYWHERE)}
        lines = [Line(Loop(f"{k}", "none" if k else "stiction", "", Folder("", "", "", ())), "", 0.0, {PRODUCT: 0.9 if k < 2 else 0.0} | scores) for k in range(30)]
        printed = whole(lines, "head")
        self.assertIn("29 of 30", printed)
        self.assertIn("no false alarm: missed", printed)

    def test_a_loop_without_a_verdict_is_told_nothing(self) -> None:
        loop = Loop("A", "stiction", "", Folder("", "", "", ()))
        self.assertEqual(line(loop, text(STICKS), None, {"exit": 2}).scores[PRODUCT], 0.0)


if __name__ == "__main__":
    unittest.main()
