"""Records in MATLAB's format, HDF5 and WAV, written by other hands: SciPy, h5py, Octave."""
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

try:
    import numpy
except ImportError:
    raise unittest.SkipTest("python3-numpy is not installed") from None
try:
    import scipy.io
    import scipy.io.wavfile
except ImportError:
    scipy = None
try:
    import h5py
except ImportError:
    h5py = None

import hysteron
from tests.bindings.machines import PLANT, drive, tool, write_csv

OCTAVE = shutil.which("octave-cli")


class Formats(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.columns = drive(500)

    def same(self, file, **options):
        record = hysteron.read_record(self.folder / file, **options)
        self.assertEqual(record.sample_time, 0.001)
        for name, column in self.columns.items():
            self.assertEqual(record[name].tobytes(), column.tobytes(), name)
        return record

    @unittest.skipIf(scipy is None, "python3-scipy is not installed")
    def test_scipy(self):
        for packed in (False, True):
            scipy.io.savemat(self.folder / "log.mat", {**self.columns, "Ts": 0.001, "remark": "text"}, do_compression=packed)
            self.same("log.mat")
        scipy.io.savemat(self.folder / "log.mat", {"log": self.columns}, oned_as="column")
        record = self.same("log.mat")
        run = hysteron.compile(PLANT).run(self.folder / "log.mat")
        self.assertEqual(run["Y"].tobytes(), hysteron.compile(PLANT).run(self.columns)["Y"].tobytes())
        self.assertEqual(list(record), ["t", "U", "HOLD_IT"])

    @unittest.skipIf(scipy is None, "python3-scipy is not installed")
    def test_every_command_takes_them(self):
        (self.folder / "plant.st").write_text(PLANT)
        (self.folder / "p.toml").write_text("[fit.HYST]\nC1 = {}\n")
        y = hysteron.compile(PLANT, HYST={"C1": 8.5}).run(self.columns)["Y"]
        log = {**self.columns, "Y": y + numpy.random.default_rng(2).normal(0.0, 0.01, len(y))}
        scipy.io.savemat(self.folder / "log.mat", log)
        write_csv(self.folder / "log.csv", log)
        said = {}
        for file in ("log.mat", "log.csv"):
            tool("run", "plant.st", "--in", file, "--out", "out.csv", cwd=self.folder)
            said[file] = [(self.folder / "out.csv").read_text()]
            found = tool("tune", "plant.st", "--log", file, "--params", "p.toml", "--out", "tuned.toml", cwd=self.folder)
            said[file].append([line for line in found.stdout.splitlines() if line.startswith("HYST")])
            found = tool("record", file, cwd=self.folder)
            said[file].append([line for line in found.stdout.splitlines() if line.startswith("U ")])
            found = tool("diagnose", "plant.st", "--log", file, "--params", "p.toml", "--out", "found", "--effects", "lag",
                         cwd=self.folder)
            said[file].append([line for line in found.stdout.splitlines() if "nominal" in line])
        self.assertEqual(said["log.mat"], said["log.csv"])
        self.assertTrue(all(said["log.mat"]))

    @unittest.skipIf(scipy is None, "python3-scipy is not installed")
    def test_scipy_wav(self):
        samples = numpy.column_stack([self.columns["U"], -self.columns["U"]]).astype(numpy.float32)
        scipy.io.wavfile.write(self.folder / "log.wav", 1000, samples)
        record = hysteron.read_record(self.folder / "log.wav", columns={"U": "CH1"})
        self.assertEqual(record["U"].tobytes(), samples[:, 0].astype(float).tobytes())
        self.assertEqual(record.sample_time, 0.001)

    @unittest.skipIf(h5py is None, "python3-h5py is not installed")
    def test_h5py(self):
        with h5py.File(self.folder / "log.h5", "w") as file:
            for name, column in self.columns.items():
                file.create_dataset(f"run/{name}", data=column, compression="gzip")
            file["run/U"].attrs["units"] = "V"
            file["run/flag"] = self.columns["HOLD_IT"] > 0
            file["run/remark"] = "text"
        record = self.same("log.h5")
        self.assertEqual(record.units["U"], "V")
        self.assertEqual(record["flag"].tolist(), self.columns["HOLD_IT"].tolist())
        table = numpy.zeros(500, dtype=[("t", float), ("U", float), ("HOLD_IT", float)])
        for name, column in self.columns.items():
            table[name] = column
        with h5py.File(self.folder / "table.h5", "w") as file:
            file["log"] = table
        self.same("table.h5")

    @unittest.skipIf(OCTAVE is None, "octave is not installed")
    def test_octave(self):
        script = "t = (0:499)' / 1000; U = sin(9 * t); HOLD_IT = U > 0.5; M = [U 2 * U]; log.t = t; log.U = U;"
        for kind in ("-v6", "-v7"):
            subprocess.run([OCTAVE, "--eval", f"{script} save {kind} vectors.mat t U HOLD_IT M; save {kind} struct.mat log"],
                           cwd=self.folder, check=True, capture_output=True)
            vectors = hysteron.read_record(self.folder / "vectors.mat")
            self.assertEqual(vectors["M_1"].tobytes(), vectors["U"].tobytes())
            self.assertEqual((2 * vectors["U"]).tobytes(), vectors["M_2"].tobytes())
            self.assertEqual(vectors["HOLD_IT"].tolist(), (vectors["U"] > 0.5).astype(float).tolist())
            self.assertEqual(vectors.sample_time, 0.001)
            structure = hysteron.read_record(self.folder / "struct.mat")
            self.assertEqual(structure["U"].tobytes(), vectors["U"].tobytes())


if __name__ == "__main__":
    unittest.main()
