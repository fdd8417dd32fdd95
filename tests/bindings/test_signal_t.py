"""A signal called T, as the time is in a record: by arrays, files and fits, as any other."""
import unittest

try:
    import numpy
except ImportError:
    raise unittest.SkipTest("python3-numpy is not installed") from None

import hysteron
from tests.bindings.test_python import Folder, bits

OVEN = """FUNCTION_BLOCK OVEN  (* @ts 100ms *)
  VAR_INPUT HEAT : LREAL; END_VAR
  VAR_OUTPUT T : LREAL; END_VAR
  VAR WALL : HY_LAG := (T1 := 0.7); END_VAR
  WALL(XIN := HEAT);
  T := WALL.XOUT;
END_FUNCTION_BLOCK
"""


class SignalT(Folder):
    def test_a_signal_called_t_is_a_signal(self):
        rows = 400
        heat = numpy.sin(0.1 * numpy.arange(rows)) + (numpy.arange(rows) // 50) % 3
        time = numpy.arange(rows) / 10.0
        oven = hysteron.compile(OVEN)
        out = oven.run({"HEAT": heat})  # by the diagram's sample time
        self.assertEqual((list(out), out.units["time"], out["TIME"][-1]), (["time", "T"], "s", 39.9))
        self.assertIn("400 rows", repr(out))
        log = {"time": time, "HEAT": heat, "T": out["T"]}
        for columns in (log, {"HEAT": heat, "T": out["T"]}, {"t": time, "T": out["T"], "HEAT": heat}):
            self.assertEqual(bits(oven.run(columns)["T"]), bits(out["T"]))
        settings = "[fit.WALL]\nT1 = {start = 0.3}\n"
        self.assertAlmostEqual(oven.with_parameters(settings).tune(log).parameters["WALL.T1"].value, 0.7, 4)
        numpy.savetxt(self.folder / "log.csv", numpy.column_stack(list(log.values())), delimiter=",",
                      header="time,HEAT,T", comments="")
        for record in (hysteron.read_record(self.folder / "log.csv"), hysteron.read_record(self.folder / "log.csv", diagram=oven)):
            self.assertEqual(list(record), ["time", "HEAT", "T"])
            self.assertEqual(bits(oven.run(record)["T"]), bits(out["T"]))
        # As an input, of which no output has the name: the names of the times are the same.
        wall = hysteron.compile("FUNCTION_BLOCK WALL (* @ts 100ms *) VAR_INPUT T : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
                                "Y := 2.0 * T;\nEND_FUNCTION_BLOCK\n")
        self.assertEqual(list(wall.run({"T": numpy.ones(5)})), ["time", "Y"])
        for name in ("t", "T"):
            with self.assertRaises(hysteron.Error) as caught:
                wall.run({name: time})
            self.assertEqual(caught.exception.code, "HY514")
            self.assertIn(f'time="{name}"', caught.exception.mend)
            self.assertIn('rate="0.1s"', caught.exception.mend)
            self.assertEqual(bits(wall.run({name: time}, rate="0.1s")["Y"]), bits(wall.run({"time": time, "T": time})["Y"]))
