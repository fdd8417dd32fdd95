"""Cases: agreement with the product where nothing is wrong, ratios as wanted, and nothing that gives the cause away."""

from __future__ import annotations

import csv
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from scipy import stats

from trials.generator.case import PLANTS, Builder, Specification, build, from_label, parameter_file, scales, write
from trials.generator.grid import Grid
from trials.generator.piezo import Piezo
from trials.generator.strata import AMBIGUOUS, FULL, HOMES, each, plan
from trials.scoring.fresh import checked

ROOT = Path(__file__).resolve().parents[2]
TOOL = os.environ.get("HYSTERON_TOOL", str(ROOT / "build" / "hysteron"))


class Agreement(unittest.TestCase):
    """Two ways of computing the same plant."""

    def test_without_effect_and_deviation_the_noise_is_left(self) -> None:
        for plant in PLANTS:
            for seed in (7, 8):
                with self.subTest(plant=plant, seed=seed), tempfile.TemporaryDirectory() as name:
                    builder = Builder(Specification("single", plant, (), 0.0, seed, noise="white"))
                    builder.sigma = 4e-4 * float(np.ptp(builder.base[:, 0]))
                    builder.deviations = lambda b=builder: dict.fromkeys(scales(b.plant), 0.0)  # type: ignore[method-assign]
                    case = builder.build()
                    folder = Path(name) / "case"
                    write(case, folder)
                    done = subprocess.run(
                        [TOOL, "run", "plant.st", "--in", "log.csv", "--out", "out.csv", "--params", "params.toml"],
                        cwd=folder, capture_output=True, text=True, check=False,
                    )  # fmt: skip
                    said = [line for line in done.stderr.splitlines() if not line.startswith("note: ")]
                    self.assertEqual((done.returncode, said), (0, []))
                    with (folder / "out.csv").open() as file:
                        rows = list(csv.reader(file))
                    for output, rms in zip(case.plant.outputs, case.label["noise_rms"]):
                        model = np.array([float(row[rows[0].index(output)]) for row in rows[1:]])
                        left = float(np.sqrt(np.mean((case.log[output] - model) ** 2)))
                        self.assertLess(left, 1.06 * rms)
                        self.assertGreater(left, 0.9 * rms)


class Improved(unittest.TestCase):
    """What the scorer finds of an improved diagram by running it."""

    def test_the_machine_itself_is_nowhere_apart(self) -> None:
        builder = Builder(Specification("calibration", "servo_speed", (), 10.0, 11))
        case = builder.build()
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "improved.st").write_text(case.files["plant.st"])
            (folder / "improved.toml").write_text(parameter_file(builder.plant.tuned(), builder.plant))
            closed, apart = checked(case.label, name, TOOL)
            self.assertGreater(closed, 0.999)
            self.assertLess(apart, 0.1)
            (folder / "improved.toml").write_text(case.files["params.toml"])
            closed, apart = checked(case.label, name, TOOL)
            self.assertAlmostEqual(closed, 0.0)
            self.assertGreater(apart, 1.0)
            (folder / "improved.st").write_text("no diagram")
            self.assertTrue(all(np.isnan(checked(case.label, name, TOOL))))


class Turns(unittest.TestCase):
    """A reversal makes the loop forget its branch: one that no sample shows would be a second effect, without a label."""

    def test_a_dip_between_two_samples_is_seen(self) -> None:
        plant = Builder(Specification("none", "piezo", (), 0.0, 3)).plant
        self.assertTrue(plant.shows_its_turns())
        middle = int(np.argmax(np.abs(np.gradient(plant.u))))
        first = middle - middle % plant.grid.substeps
        held = plant.u[first + 8]
        plant.u[first + 8 : first + 11] = held + np.array([0.0, -1e-3, 0.0]) * np.sign(plant.u[first + 20] - plant.u[first])
        self.assertFalse(plant.shows_its_turns())

    def test_no_case_has_one(self) -> None:
        asked: list[bool] = []
        shows = Piezo.shows_its_turns
        with mock.patch.object(Piezo, "shows_its_turns", lambda plant: asked.append(shows(plant)) or asked[-1]):
            for seed in range(30):
                builder = Builder(Specification("none", "piezo", (), 0.0, seed))
                self.assertTrue(shows(builder.plant))
                self.assertTrue(shows(builder.second()))
        self.assertIn(False, asked, "some first draw hides a reversal, or nothing was tested")


class Substeps(unittest.TestCase):
    """The data depend on the sub-steps, so a record computed in one step a sample would be another one; and 20 are enough."""

    def test_one_substep_a_sample_changes_the_data(self) -> None:
        for plant, effect, name in (
            ("servo_position", "cogging", "cogging"),
            ("servo_position", "stribeck_friction", "stribeck"),
            ("piezo", "rate_dependence", "rate_dependence"),
            ("piezo", "asymmetry", "asymmetry"),
            ("piezo", "rate_limit", "soft_rate_limit"),
            ("closed_loop", "lag", "lag"),
        ):
            with self.subTest(name):
                moved, left = self.moved_by_substeps(plant, effect, name)
                self.assertGreater(moved, 8.0)  # a known waveform is found in white noise from about 4 on
                self.assertLess(left, 0.15 * moved)

    def test_dry_friction_is_exact_in_any_substeps(self) -> None:
        moved, _ = self.moved_by_substeps("servo_speed", "coulomb_friction", "coulomb")
        self.assertLess(moved, 0.1)

    def moved_by_substeps(self, plant: str, effect: str, name: str) -> tuple[float, float]:
        """What one sub-step a sample and ten change of twenty, over the noise, all samples together."""
        builder = Builder(Specification("single", plant, ((effect, name),), 30.0, 21))
        injections = builder.inject()

        def simulate(substeps: int) -> np.ndarray:
            grid = Grid(builder.grid.ts, builder.grid.samples, substeps)
            return builder.plant.simulate(builder.plant.truth, injections, grid)[:, 0]

        fine = simulate(20)
        one, ten = (float(np.sqrt(np.sum((fine - simulate(substeps)) ** 2))) / builder.sigma for substeps in (1, 10))
        return one, ten


class Cases(unittest.TestCase):
    """Single cases."""

    def test_ratio_is_as_wanted(self) -> None:
        for plant, effect in (("piezo", "asymmetry"), ("thermal", "delay"), ("tanks", "saturation"), ("servo_speed", "load")):
            for ratio in (1.0, 30.0):
                with self.subTest(effect=effect, ratio=ratio):
                    label = build(Specification("single", plant, ((effect, ""),), ratio, 3)).label
                    self.assertAlmostEqual(label["ratio"] / ratio, 1.0, delta=0.05)

    def test_the_same_seed_gives_the_same_case(self) -> None:
        specification = Specification("pair", "piezo", (("creep", ""), ("drift", "uneven_drift")), 10.0, 99)
        first, again = build(specification), build(specification)
        self.assertEqual(first.files, again.files)
        self.assertEqual(from_label(first.label).build().files, first.files)

    def test_deviations_are_those_of_a_real_tuning(self) -> None:
        label = build(Specification("single", "thermal", (("load", ""),), 3.0, 5)).label
        for off in label["deviations"].values():
            self.assertTrue(0.005 <= abs(off) <= 0.02)
        self.assertLess(build(Specification("none", "thermal", (), 0.0, 5)).label["deviation_ratio"], 0.2)

    def test_every_designed_ambiguous_record_can_be_made(self) -> None:
        for plant, effect, name, edge, excitation, answers in AMBIGUOUS:
            with self.subTest(plant=plant, effect=effect):
                made = build(Specification("ambiguous", plant, ((effect, name),), 10.0, 12, excitation, edge, answers))
                self.assertEqual(made.label["answers"], list(answers))
                if effect == "sensor_gain":  # what the known parameters take over is nothing after a refit
                    self.assertLess(made.label["ratio"], 0.05)
                else:
                    self.assertAlmostEqual(made.label["ratio"] / 10.0, 1.0, delta=0.05)

    def test_full_plan_has_every_effect_and_enough_cousins(self) -> None:
        cases = plan("any", FULL)
        self.assertEqual(len(cases), sum(FULL.values()))
        named = {one.effects[0][0] for one in cases if one.stratum == "single"}
        listed = re.findall(r"`(\w+)`", LIST_OF_EFFECTS)
        self.assertEqual(named, set(listed))
        inside = [one for one in cases if one.stratum in ("single", "cousin", "pair")]
        self.assertGreaterEqual(sum(one.stratum == "cousin" for one in inside) / len(inside), 1 / 3)

    def test_each_plan_has_every_effect_on_every_plant_that_has_it(self) -> None:
        cases = each("any", 30.0)
        self.assertEqual({one.effects[0][0] for one in cases}, set(re.findall(r"`(\w+)`", LIST_OF_EFFECTS)))
        self.assertEqual({(one.effects[0][0], one.plant) for one in cases}, {(e, p) for e, homes in HOMES.items() for p in homes})
        self.assertEqual({(one.stratum, one.ratio, one.plan, len(one.effects)) for one in cases}, {("single", 30.0, "rich", 1)})


LIST_OF_EFFECTS = """`delay` `lag` `rate_limit` `saturation` `dead_zone` `quantization` `backlash` `asymmetry`
`rate_dependence` `return_point_memory` `bias_dependence` `curve_shape` `creep` `relaxation` `resonance`
`coulomb_friction` `stribeck_friction` `viscous_friction` `cogging` `even_nonlinearity` `odd_nonlinearity` `offset` `drift`
`thermal_drift` `gain_drift` `periodic_disturbance` `cross_coupling` `load` `clock` `glitches` `branch_chatter`"""


class NothingLeaks(unittest.TestCase):
    """Names, sizes and times of files say nothing about the cause."""

    def test_a_classifier_on_file_names_sizes_and_times_is_at_chance(self) -> None:
        rng = np.random.default_rng(4)
        effects = ("delay", "drift", "saturation", "quantization", "load", "glitches")
        features, labels = [], []
        with tempfile.TemporaryDirectory() as name:
            for number in range(48):
                effect = effects[number % len(effects)]
                case = build(Specification("single", "thermal", ((effect, ""),), 10.0, int(rng.integers(2**60))))
                folder = Path(name) / f"{rng.integers(2**48):012x}"
                write(case, folder)
                stamps = {file.stat().st_mtime for file in folder.iterdir()} | {folder.stat().st_mtime}
                self.assertEqual(len(stamps), 1)
                self.assertLessEqual({file.name for file in folder.iterdir()}, {"plant.st", "params.toml", "log.csv", "log2.csv"})
                sizes = [float((folder / file).stat().st_size) for file in ("plant.st", "params.toml", "log.csv")]
                features.append([float(int(folder.name, 16)), *sizes, float((folder / "log2.csv").exists()), *stamps])
                labels.append(effect)
        x = np.array(features)
        x = (x - x.mean(axis=0)) / np.maximum(x.std(axis=0), 1e-12)
        distance = ((x[:, None, :] - x[None, :, :]) ** 2).sum(axis=2)
        np.fill_diagonal(distance, np.inf)
        hits = sum(labels[i] == labels[j] for i, j in enumerate(distance.argmin(axis=1)))
        self.assertGreater(stats.binomtest(hits, len(labels), 1 / len(effects), "greater").pvalue, 0.01)

    def test_a_case_holds_no_word_of_its_label(self) -> None:
        case = build(Specification("single", "thermal", (("saturation", ""),), 10.0, 6))
        for name in ("plant.st", "params.toml"):
            self.assertNotIn("saturation", case.files[name].lower())

    def test_the_trial_imports_and_reads_nothing_of_the_product(self) -> None:
        forbidden = re.compile(r"\b(blocks|codegen|tuning|diagnosis|runtime|records|support)/|\.hpp")
        for file in [*ROOT.glob("trials/**/*.py"), *(ROOT / "trials" / name for name in ("generate", "seal", "run", "score", "real", "machines"))]:
            with self.subTest(file.name):
                self.assertIsNone(forbidden.search(file.read_text()))


if __name__ == "__main__":
    unittest.main()
