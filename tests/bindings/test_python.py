"""The Python package against the tool: the same bits, the same fits, the same verdicts; errors with code and mend."""
import gc
import json
import os
import subprocess
import tempfile
import threading
import unittest
import warnings
from pathlib import Path

try:
    import numpy
except ImportError:
    raise unittest.SkipTest("python3-numpy is not installed") from None

import hysteron
from tests.bindings.machines import MACHINE, PLANT, SETTINGS, drive, read_csv, tool, write_csv


def bits(array):
    return numpy.ascontiguousarray(array, dtype=numpy.float64).tobytes()


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name


class Diagrams(Folder):
    def test_says_what_it_takes_and_gives(self):
        plant = hysteron.compile(PLANT)
        self.assertEqual((plant.name, plant.sample_time), ("PLANT", 0.001))
        self.assertEqual(list(plant.inputs), ["U", "HOLD_IT"])
        u = plant.inputs["U"]
        self.assertEqual((u.unit, u.type, u.minimum, u.maximum, u.default), ("V", "LREAL", -10.0, 10.0, None))
        self.assertEqual((plant.inputs["HOLD_IT"].type, plant.inputs["HOLD_IT"].default), ("BOOL", 0.0))
        self.assertEqual({name: port.type for name, port in plant.outputs.items()}, {"Y": "LREAL", "COUNT": "DINT"})
        lag = plant.parameters["AMP.T1"]
        self.assertEqual((lag.unit, lag.value, lag.minimum), ("s", 0.004, 0.0))
        self.assertIn("time constant", lag.meaning)
        self.assertEqual(plant.parameters["HYST.C1"].unit, "um/V")  # as the wires give it

    def test_a_path_a_text_and_parameters_in_four_ways(self):
        path = self.write("plant.st", PLANT)
        file = self.write("p.toml", "[parameters.AMP]\nT1 = 0.02\n")
        for plant in (hysteron.compile(path, file), hysteron.compile(str(path), file.read_text()),
                      hysteron.compile(PLANT, AMP={"T1": 0.02}), hysteron.compile(PLANT, **{"AMP.T1": numpy.float64(0.02)}),
                      hysteron.compile(PLANT).with_parameters(AMP={"T1": 0.02})):
            self.assertEqual(plant.parameters["AMP.T1"].value, 0.02)
        both = hysteron.compile(PLANT, file, HYST={"C1": 5}).with_parameters(AMP={"T1": 0.03})
        self.assertEqual([both.parameters[name].value for name in ("AMP.T1", "HYST.C1")], [0.03, 5.0])

    def test_warnings_are_warned_once_and_kept(self):
        late = PLANT.replace("  COUNT := N.CV;\n", "").replace("  N(CU", "  COUNT := N.CV;\n  N(CU")
        with self.assertRaises(hysteron.Error) as caught:
            hysteron.compile(late)
        self.assertEqual(caught.exception.code, "HY402")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            plant = hysteron.compile(late, any_order=True)
            before = len(told)
            plant.run(drive(10))
        self.assertGreater(before, 0)
        self.assertEqual(len(told), before)
        self.assertEqual(len(plant.warnings), before)
        self.assertTrue(all(one.category is hysteron.InputWarning for one in told))


class Runs(Folder):
    def test_give_the_bits_of_the_tool(self):
        columns = drive()
        write_csv(self.folder / "log.csv", columns)
        self.write("plant.st", PLANT)
        self.write("p.toml", "[parameters.HYST]\nC2 = 1.7\n")
        for float32 in (False, True):
            tool("run", "plant.st", "--in", "log.csv", "--out", "out.csv", "--params", "p.toml", "--trace", "AMP.XOUT",
                 *["--float32"] * float32, cwd=self.folder)
            wanted = read_csv(self.folder / "out.csv")
            if float32:  # written with the fewest digits of a float
                wanted = {name: numpy.float32(column).astype(float) if name in ("Y", "AMP.XOUT") else column
                          for name, column in wanted.items()}
            plant = hysteron.compile(self.folder / "plant.st", self.folder / "p.toml")
            for record in (columns, self.folder / "log.csv", str(self.folder / "log.csv"),
                           hysteron.read_record(self.folder / "log.csv")):
                out = plant.run(record, traces=["AMP.XOUT"], float32=float32)
                self.assertEqual(list(out), list(wanted))
                for name in wanted:
                    self.assertEqual(bits(out[name]), bits(wanted[name]), name)
        self.assertEqual(out.units["Y"], "um")

    def test_are_the_steps_of_a_machine(self):
        columns = drive(300)
        plant = hysteron.compile(PLANT)
        out = plant.run(columns)
        machine = plant.machine()
        for once in range(2):
            steps = [machine.step(u=u, hold_it=hold) for u, hold in zip(columns["U"], columns["HOLD_IT"])]
            self.assertEqual(bits([one["Y"] for one in steps]), bits(out["Y"]))
            self.assertEqual([one["COUNT"] for one in steps], out["COUNT"].tolist())
            machine.reset()
        first = plant.step(U=columns["U"][0])
        second = plant.step()  # keeps its inputs
        self.assertEqual(first["Y"], out["Y"][0])
        self.assertEqual(second, {**second, **plant_steps(plant, [columns["U"][0]] * 2)})
        plant.reset()
        self.assertEqual(plant.step(U=columns["U"][0]), first)

    def test_time_comes_from_the_diagram_the_arrays_or_the_rate(self):
        u = drive(50)["U"]
        plant = hysteron.compile(PLANT)
        self.assertEqual(plant.run({"U": u})["t"][-1], 0.049)
        late = plant.run({"U": u, "Time": 3.0 + numpy.arange(50) / 1000.0}, columns={"U": "U"})
        self.assertAlmostEqual(late["t"][0], 3.0)
        free = hysteron.compile(PLANT.replace("(* @ts 1ms *)", ""))
        self.assertIsNone(free.sample_time)
        self.assertEqual(bits(free.run({"U": u}, rate="1kHz")["Y"]), bits(plant.run({"U": u})["Y"]))
        with self.assertRaises(hysteron.Error) as caught:
            free.run({"U": u})
        self.assertEqual(caught.exception.code, "HY502")

    def test_units_of_arrays_are_units(self):
        u = drive(50)["U"]
        plant = hysteron.compile(PLANT)
        out = plant.run({"U": 1000.0 * u}, units={"U": "mV"})
        numpy.testing.assert_allclose(out["Y"], plant.run({"U": u})["Y"], rtol=1e-12)
        self.assertTrue(any("mV" in note for note in out.notes), out.notes)
        fitted = hysteron.compile(PLANT, SETTINGS)
        u = drive(2000)["U"]
        tuned = fitted.tune({"U": 1000.0 * u, "Y": plant.run({"U": u})["Y"]}, units={"U": "mV"})
        self.assertEqual(sum("converted to V" in note for note in tuned.notes), 1, tuned.notes)
        with self.assertRaises(hysteron.Error) as caught:
            plant.run({"U": u}, units={"U": "nm"})
        self.assertEqual(caught.exception.code, "HY729")

    def test_arrays_outlive_their_record_and_cannot_be_written(self):
        y = hysteron.compile(PLANT).run(drive(1000))["Y"]
        before = bits(y)
        gc.collect()
        hysteron.compile(PLANT).run(drive(1000, seed=8))
        self.assertEqual(bits(y), before)
        with self.assertRaises(ValueError):
            y[0] = 1.0

    def test_records_are_read_as_the_tool_reads_them(self):
        (self.folder / "trend.txt").write_text("Zeit;MAIN.u [mV];y\n0,000;0,0;0,5\n0,001;250,0;1,5\n0,002;500,0;2,5\n")
        record = hysteron.read_record(self.folder / "trend.txt", columns={"U": "MAIN.u"})
        self.assertEqual((list(record), record.units["U"]), (["t", "U", "y"], "mV"))
        self.assertEqual(record["u"].tolist(), [0.0, 250.0, 500.0])
        self.assertEqual(record.sample_time, 0.001)
        settled = hysteron.compile(PLANT, '[record.columns]\nU = "MAIN.u"\n')
        self.assertEqual(bits(settled.run(self.folder / "trend.txt")["Y"]),
                         bits(hysteron.compile(PLANT).run({"U": [0.0, 0.25, 0.5]})["Y"]))
        # What the parameter file calls the columns of files is no matter of arrays, which have the names of the inputs.
        self.assertEqual(bits(settled.run({"U": [0.0, 0.25, 0.5]})["Y"]), bits(hysteron.compile(PLANT).run({"U": [0.0, 0.25, 0.5]})["Y"]))
        with self.assertRaises(hysteron.Error) as caught:
            settled.run({"V": [0.0, 0.25, 0.5]})
        self.assertEqual((caught.exception.code, "V" in caught.exception.message), ("HY502", True))
        part = hysteron.read_record(self.folder / "trend.txt", range="1ms..")
        self.assertEqual(part["y"].tolist(), [1.5, 2.5])

    def test_uneven_times_are_refused_or_resampled(self):
        columns = drive(200)
        columns["t"] = columns["t"] + 0.0003 * numpy.sin(numpy.arange(200))
        plant = hysteron.compile(PLANT)
        with self.assertRaises(hysteron.Error) as caught:
            plant.run(columns)
        self.assertEqual(caught.exception.code, "HY507")
        self.assertIn("resample", caught.exception.mend)
        self.assertLessEqual(len(plant.run(columns, resample="hold")["t"]), 200)
        by_name = plant.run(columns, resample={"U": "hold", "*": "linear"})
        self.assertEqual(bits(by_name["Y"]), bits(plant.run(columns, resample="hold")["Y"]))
        with self.assertRaises(hysteron.Error) as caught:
            plant.run(columns, resample={"Q": "hold"})
        self.assertIn('resample={"', caught.exception.mend)


def plant_steps(plant, values):
    machine = plant.machine()
    for value in values:
        last = machine.step(U=value)
    return last


def without_times(data):
    # What the tool adds for a reader is not among the numbers of a fit.
    return {key: value for key, value in data.items() if key not in ("seconds", "not_in_the_model")}


class Fits(Folder):
    def setUp(self):
        super().setUp()
        columns = drive()
        noise = numpy.random.default_rng(3).normal(0.0, 0.02, len(columns["t"]))
        self.columns = {**columns, "Y": hysteron.compile(MACHINE).run(columns)["Y"] + noise}
        write_csv(self.folder / "log.csv", self.columns)
        self.write("plant.st", PLANT)
        self.write("settings.toml", SETTINGS)

    def test_are_those_of_the_tool(self):
        done = tool("tune", "plant.st", "--log", "log.csv", "--params", "settings.toml", "--out", "tuned.toml", "--json",
                    cwd=self.folder)
        told = []
        plant = hysteron.compile(self.folder / "plant.st", self.folder / "settings.toml")
        fit = plant.tune(self.folder / "log.csv", progress=lambda done, iteration: told.append((done, iteration)))
        self.assertEqual(without_times(fit.data), without_times(json.loads(done.stdout)))
        self.assertEqual(fit.text.replace(str(self.folder) + "/", ""), (self.folder / "tuned.toml").read_text())
        self.assertTrue(fit.converged)
        self.assertGreater(len(told), 2)
        self.assertTrue(all(0.0 <= done < 1.0 for done, _ in told))
        self.assertEqual(list(fit.parameters), ["HYST.C1", "HYST.C2", "HYST.C3"])
        self.assertLess(fit.outputs["Y"].rmse_train, fit.outputs["Y"].rmse_before)
        tuned = plant.with_parameters(fit.text)
        self.assertEqual(tuned.parameters["HYST.C2"].value, fit.parameters["HYST.C2"].value)
        again = plant.tune(self.columns)
        self.assertEqual(again.data["parameters"], fit.data["parameters"])

    def test_an_exception_in_progress_ends_the_fit_and_is_raised(self):
        calls = []

        def stop(done, iteration):
            calls.append(iteration)
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            hysteron.compile(PLANT, SETTINGS).tune(self.columns, progress=stop)
        self.assertEqual(len(calls), 1)

    def test_a_verdict_is_that_of_the_tool(self):
        self.write("tuned.toml", SETTINGS[:SETTINGS.index("[tune]")])
        self.columns = {name: column[:700] for name, column in self.columns.items()}
        write_csv(self.folder / "log.csv", self.columns)
        options = {"effects": ["lag"], "most": 1, "seed": 3, "explain": True, "limits": {"U": 4.0}, "effort": 0.01}
        done = tool("diagnose", "plant.st", "--log", "log.csv", "--params", "tuned.toml", "--out", "found", "--effects", "lag",
                    "--most", "1", "--seed", "3", "--explain", "--limit", "U=4.0", "--effort", "0.01", "--json",
                    cwd=self.folder)
        plant = hysteron.compile(self.folder / "plant.st", self.folder / "tuned.toml")
        verdict = plant.diagnose(self.folder / "log.csv", **options)
        wanted = json.loads(done.stdout)
        self.assertEqual(without_times(verdict.data), without_times(wanted))
        self.assertEqual(sorted(verdict.files), sorted(path.name for path in (self.folder / "found").iterdir()))
        for name in ("improved.st", "improved.toml"):
            self.assertEqual(verdict.files[name], (self.folder / "found" / name).read_text(), name)
        self.assertEqual([effect.id for effect in verdict.effects], [one["id"] for one in wanted["effects"]])
        self.assertEqual(verdict.gap.signal, "Y")
        self.assertLess(verdict.gap.improved_rms, verdict.gap.calibrated_rms)
        for effect in verdict.effects:
            for estimate in effect.parameters.values():
                self.assertIsInstance(estimate, hysteron.Estimate)
        improved = hysteron.compile(verdict.improved, verdict.improved_parameters, any_order=True)
        self.assertIn("Y", improved.run(self.columns))

    def test_a_record_that_cannot_be_diagnosed_is_a_verdict(self):
        still = {name: numpy.zeros_like(column) if name != "t" else column for name, column in self.columns.items()}
        verdict = hysteron.compile(PLANT, SETTINGS).diagnose(still)
        self.assertTrue(verdict.refused)
        self.assertGreater(len(verdict.refusals), 0)
        self.assertIsNone(verdict.improved)

    def test_one_record_twice_is_refused(self):
        plant = hysteron.compile(PLANT, SETTINGS)
        record = hysteron.read_record(self.folder / "log.csv")
        for twice in ([record, record], [record, self.folder / "log.csv"]):
            with self.assertRaises(hysteron.Error) as caught:
                plant.tune(twice)
            self.assertEqual(caught.exception.code, "HY730")


LOOP = """FUNCTION_BLOCK LOOP  (* @ts 10ms *)
  VAR_INPUT
    SP : LREAL;  (* @unit mm *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit mm *)
  END_VAR
  VAR
    P : HY_GAIN := (K := 1.0);
    BODY : HY_GAIN := (K := 1.0);
    PLANT : HY_INTEGRAL_FORWARD;
  END_VAR

  P(XIN := SP - PLANT.XOUT);
  BODY(XIN := P.XOUT);
  Y := PLANT.XOUT;
  PLANT(XIN := BODY.XOUT);
END_FUNCTION_BLOCK
"""

GOAL = """[fit.P]
K = {min = 0.0, max = 4.0}

[goal]
settling_time = 0.5
order = 1
loop = "P.XOUT"
plants = ["light.toml", "heavy.toml"]

[goal.limits]
phase_margin_deg = 60.0
"""


class Goals(Folder):
    def setUp(self):
        super().setUp()
        self.write("loop.st", LOOP)
        self.write("p.toml", GOAL)
        self.write("light.toml", "[parameters.BODY]\nK = 2.0\n")
        self.write("heavy.toml", "[parameters.BODY]\nK = 0.5\n")

    def test_are_those_of_the_tool(self):
        done = tool("tune", "loop.st", "--params", "p.toml", "--out", "tuned.toml", "--json", cwd=self.folder)
        told = []
        loop = hysteron.compile(self.folder / "loop.st", self.folder / "p.toml")
        tuned = loop.tune(progress=lambda done, iteration: told.append(done))
        self.assertEqual(without_times(tuned.data), without_times(json.loads(done.stdout)))
        self.assertEqual(tuned.text, (self.folder / "tuned.toml").read_text())
        self.assertIsInstance(tuned, hysteron.TunedLoop)
        self.assertTrue(tuned.keeps_limits)
        self.assertGreater(len(told), 2)
        self.assertEqual((tuned.parameters["P.K"].value, tuned.parameters["P.K"].at_bound), (4.0, "upper"))
        self.assertEqual(list(tuned.plants), ["light.toml", "heavy.toml"])
        light = tuned.plants["light.toml"]
        self.assertLess(light.after.error, light.before.error)
        # Of an integrator behind a gain of 8 1/s, sampled each 10 ms: 2 sin(w/2) = 0.08, and 90 degrees less half a sample.
        w = 2.0 * numpy.arcsin(0.04)
        self.assertAlmostEqual(light.after.phase_margin_deg.value, 90.0 - numpy.degrees(w) / 2.0, places=2)
        self.assertEqual(loop.with_parameters(tuned.text).parameters["P.K"].value, 4.0)

    def test_a_contradiction_is_warned_of_and_given(self):
        text = GOAL.replace('plants = ["light.toml", "heavy.toml"]\n', "").replace("{min = 0.0", "{min = 3.0, start = 3.5")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            tuned = hysteron.compile(LOOP).tune(params=text + "effort = 2.0\n")
        self.assertTrue(any("HY533" in str(one.message) for one in told), told)
        self.assertEqual((tuned.status, tuned.keeps_limits), ("contradiction", False))
        self.assertEqual(tuned.parameters["P.K"].at_bound, "lower")

    def test_a_record_drives_where_the_goal_says_so(self):
        text = "[fit.P]\nK = {min = 0.0}\n[goal]\nsignal = 'record'\nwished = 'WISH'\n"
        t = numpy.arange(300) / 100.0
        loop = hysteron.compile(LOOP, P={"K": 7.0})
        wish = loop.run({"t": t, "SP": numpy.sin(5.0 * t)})["Y"]
        tuned = loop.with_parameters(text, P={"K": 2.0}).tune({"t": t, "SP": numpy.sin(5.0 * t), "WISH": wish})
        self.assertAlmostEqual(tuned.parameters["P.K"].value, 7.0, places=3)
        for code, call in (("HY530", lambda: hysteron.compile(LOOP, text).tune()),
                           ("HY730", lambda: hysteron.compile(LOOP).tune())):
            with self.assertRaises(hysteron.Error) as caught:
                call()
            self.assertEqual(caught.exception.code, code)


class Relays(Folder):
    def test_are_those_of_the_tool(self):
        u, y, columns = 1.2, 0.0, {"t": [], "U": [], "Y": []}
        for k in range(1500):
            u = 1.2 if y < -0.05 else -0.3 if y > 0.05 else u
            columns["t"].append(k / 100.0)
            columns["U"].append(0.0 if k < 50 else u)
            columns["Y"].append(y)
            y += (1.0 - numpy.exp(-0.01 / 0.6)) * (2.0 * (columns["U"][k - 8] if k > 7 else 0.0) - y)
        write_csv(self.folder / "relay.csv", columns)
        done = tool("relay", "relay.csv", "--u", "U", "--y", "Y", "--controller", "AXIS.PID", "--out", "start.toml", "--json",
                    cwd=self.folder)
        found = hysteron.relay(columns, "U", "Y", controller="AXIS.PID")
        self.assertEqual(found.data, json.loads(done.stdout))
        self.assertEqual(found.text.split("\n", 1)[1], (self.folder / "start.toml").read_text().split("\n", 1)[1])
        self.assertAlmostEqual(found.model.K, 2.0, delta=0.06)
        self.assertAlmostEqual(found.model.T, 0.6, delta=0.03)
        self.assertGreater(found.pid.TD, 0.0)
        self.assertEqual(hysteron.relay(self.folder / "relay.csv", "U", "Y").ultimate_gain, found.ultimate_gain)
        for code, names, more in (("HY535", ("Y", "U"), {}), ("HY502", ("U", "Z"), {}), ("HY730", ("U", "U"), {}),
                                  ("HY730", ("U", "Y"), {"controller": "a b"})):
            with self.assertRaises(hysteron.Error) as caught:
                hysteron.relay(columns, *names, **more)
            self.assertEqual(caught.exception.code, code)


class Errors(Folder):
    def refused(self, code, call, *arguments, **options):
        with self.assertRaises(hysteron.Error) as caught:
            call(*arguments, **options)
        self.assertEqual(caught.exception.code, code, str(caught.exception))
        self.assertTrue(caught.exception.message and caught.exception.mend, str(caught.exception))
        self.assertIn(caught.exception.mend, str(caught.exception))
        return caught.exception

    def test_have_code_place_and_mend(self):
        found = self.refused("HY202", hysteron.compile, PLANT.replace("AMP(XIN", "AMP(XNI := U, XIN"))
        self.assertEqual((found.file, found.line), ("diagram", 16))
        self.assertIn("AMP(XNI", str(found))
        self.refused("HY100", hysteron.compile, self.folder / "none.st")
        self.refused("HY603", hysteron.compile, PLANT, HYST={"C9": 1.0})
        self.refused("HY214", hysteron.compile, PLANT, AMP={"T1": -1.0})
        self.refused("HY604", hysteron.compile, PLANT, AMP={"T1": "slow"})
        self.refused("HY604", hysteron.compile, PLANT, AMP={"T1": [[1.0]]})
        self.refused("HY601", hysteron.compile, PLANT, "[parameters\n")
        plant = hysteron.compile(PLANT)
        self.refused("HY502", plant.run, {"X": [1.0, 2.0]})
        self.refused("HY504", plant.run, {"U": [1.0, 2.0], "HOLD_IT": [0.0]})
        self.refused("HY505", plant.run, {"U": [[1.0, 2.0]]})
        self.refused("HY505", plant.run, {"U": ["a", "b"]})
        self.refused("HY501", plant.run, {"U": [1.0]})
        self.refused("HY501", plant.run, {})
        self.refused("HY506", plant.run, {"U": [1.0, float("nan"), 2.0]})
        self.refused("HY707", plant.run, {"U": [1.0, 2.0], "HOLD_IT": [0.5, 0.0]})
        self.refused("HY708", plant.run, {"U": [1.0, 2.0]}, traces=["AMP.NONE"])
        self.refused("HY502", plant.step, V=1.0)
        self.refused("HY502", plant.machine().step)
        self.refused("HY707", plant.step, U=1.0, HOLD_IT=0.5)
        self.refused("HY707", plant.step, U="a")
        self.refused("HY716", plant.tune, {**drive(100), "Y": drive(100)["U"]})
        self.refused("HY730", plant.diagnose, drive(100), effects=["creeep"])
        self.refused("HY730", plant.diagnose, drive(100), most=9)
        self.refused("HY730", plant.diagnose, [])
        self.refused("HY513", hysteron.read_record, self.write("log.json", '{"t": [0, 1]}'))
        self.refused("HY404", hysteron.compile(PLANT.replace("(* @ts 1ms *)", "")).machine)
        with self.assertRaises(TypeError):
            hysteron.read_record("log.csv", rte="1kHz")

    def test_an_output_that_is_not_finite_is_warned_of(self):
        text = PLANT.replace("Y := HYST.XOUT", "Y := HYST.XOUT / SEL(HOLD_IT, 1.0, 0.0)")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            out = hysteron.compile(text).run({"U": [1.0, 1.0], "HOLD_IT": [0.0, 1.0]})
        self.assertFalse(numpy.isfinite(out["Y"][1]))
        self.assertTrue(any("HY706" in str(one.message) for one in told))

    def test_no_text_brings_the_library_down(self):
        random = numpy.random.default_rng(11)
        for _ in range(300):
            cut = PLANT[:random.integers(len(PLANT))] + "\n"
            noisy = bytearray(cut.encode())
            for at in random.integers(len(noisy), size=3):
                noisy[at] = random.integers(1, 256)
            try:
                hysteron.compile(bytes(noisy).decode("utf-8", "surrogateescape") + "\n")
            except hysteron.Error as found:
                self.assertTrue(found.code.startswith("HY"), str(found))


class Threads(unittest.TestCase):
    def test_share_diagrams_and_records(self):
        columns = drive(500)
        fitted = {**columns, "Y": hysteron.compile(MACHINE).run(columns)["Y"]}
        plant = hysteron.compile(PLANT, SETTINGS.replace("[1.0, 2.0]", "[0.3, 0.5]").replace("[0.0, 1.0]", "[0.0, 0.3]"))
        wanted_run = bits(plant.run(columns)["Y"])
        wanted_fit = plant.tune(fitted).data["parameters"]
        failures = []

        def work(number):
            try:
                for _ in range(5):
                    assert bits(plant.run(columns)["Y"]) == wanted_run
                    own = hysteron.compile(PLANT)
                    machine = plant.machine()
                    steps = [machine.step(U=u, HOLD_IT=h)["Y"] for u, h in zip(columns["U"], columns["HOLD_IT"])]
                    assert bits(steps) == wanted_run
                    assert bits(own.run(columns)["Y"]) == wanted_run
                assert plant.tune(fitted).data["parameters"] == wanted_fit
                try:
                    hysteron.compile(PLANT.replace("AMP(XIN", f"AMP(X{number} := U, XIN"))
                except hysteron.Error as found:
                    assert f"X{number}" in found.message, found.message
            except BaseException as reason:
                failures.append(reason)

        threads = [threading.Thread(target=work, args=(number,)) for number in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])


class Library(unittest.TestCase):
    def test_shows_the_functions_of_its_header_and_no_others(self):
        header = (Path(__file__).parents[2] / "bindings/c/hysteron.h").read_text()
        named = {word.split("(")[0].lstrip("*") for line in header.split("\n") if line.startswith("HYSTERON_API")
                 for word in line.split() if word.lstrip("*").startswith("hysteron_") and "(" in word}
        self.assertGreater(len(named), 40)
        listed = subprocess.run(["nm", "-D", "--defined-only", os.environ["HYSTERON_LIBRARY"]], capture_output=True,
                                text=True, check=True).stdout
        shown = {line.split()[2].split("@")[0] for line in listed.splitlines() if line.split()[1] in "TDBVWiu"}
        self.assertEqual(shown, named)

    def test_the_package_names_the_types_of_each_function(self):
        from hysteron import _library
        for name in _library._FUNCTIONS:
            self.assertTrue(hasattr(_library.library, "hysteron_" + name))


if __name__ == "__main__":
    unittest.main()
