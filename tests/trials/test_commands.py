"""The commands of the trial: what they refuse, what they leave alone, how they end."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Peers(unittest.TestCase):
    """The peers need the product, and say so where they do not find it or it refuses."""

    def test_a_product_that_is_not_there_or_refuses(self) -> None:
        for peer in ("sparse", "largest"):
            for product, said in (("/no/such/hysteron", "name the product"), ("/bin/false", "ended with 1")):
                with self.subTest(peer=peer, product=product), tempfile.TemporaryDirectory() as folder:
                    log = Path(folder) / "log.csv"
                    log.write_text("t,U,Y\n0,0,0\n1,1,1\n")
                    command = [str(ROOT / "trials" / "peers" / peer), "diagnose", "plant.st", "--log", str(log), "--params", "params.toml"]
                    done = subprocess.run(
                        [*command, "--out", f"{folder}/out", f"--hysteron={product}"], capture_output=True, text=True, check=False
                    )
                    self.assertEqual(done.returncode, 1)
                    self.assertIn(said, done.stderr)
                    self.assertNotIn("Traceback", done.stderr)


class Generate(unittest.TestCase):
    """What `trials/generate` refuses, and how it ends."""

    def generate(self, folder: str, *more: str) -> list[str]:
        return [str(ROOT / "trials" / "generate"), "--out", f"{folder}/cases", "--key", f"{folder}/key.json", "--seed", "a", *more]

    def test_what_makes_no_set_is_refused(self) -> None:
        for more in (("--count", "0"), ("--count", "-3"), ("--jobs", "0"), ("--length", "nan"), ("--each", "0"), ("--stratum", "single=²"), ("--stratum", "none=2", "--count", "3"), ("--stratum", "none=2", "--each", "10"), ("--seed", " "), ("--length", "0.1"), ("--stratum", "single=0"), ("--stratum", "single=99999999999999999999"), ("--substeps", "100000000000"), ("--out", "{folder}/key.labels/x")):
            with self.subTest(more), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run(self.generate(folder, *(one.format(folder=folder) for one in more)), capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 2)
                self.assertNotIn("Traceback", done.stderr)
                self.assertEqual(list(Path(folder).iterdir()), [])

    def test_a_signal_to_the_whole_group_ends_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            command = self.generate(folder, "--count", "400", "--jobs", "2")
            with subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, start_new_session=True) as running:
                labels = Path(folder) / "key.labels"
                while running.poll() is None and not any(labels.glob("*.json")):
                    time.sleep(0.05)
                os.killpg(running.pid, signal.SIGTERM)
                _, said = running.communicate(timeout=60)
            self.assertEqual(running.returncode, 130)
            self.assertIn(b"the same command goes on", said)
            self.assertFalse((Path(folder) / "key.json").exists())

    def test_a_set_that_is_made_is_left_and_no_key_is_lost_to_another_set(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            key = Path(folder) / "key.json"
            small = self.generate(folder, "--stratum", "none=2", "--length", "0.2")
            self.assertEqual(subprocess.run(small, capture_output=True, check=False).returncode, 0)
            made, when = key.read_bytes(), key.stat().st_mtime_ns
            self.assertEqual(subprocess.run(small, capture_output=True, check=False).returncode, 0)
            self.assertEqual(key.stat().st_mtime_ns, when)
            for more in (("--stratum", "none=3", "--length", "0.2"), ("--stratum", "none=2", "--length", "0.3"), ("--stratum", "none=2", "--length", "0.2", "--seed", "b")):
                with self.subTest(more):
                    done = subprocess.run(self.generate(folder, *more), capture_output=True, text=True, check=False)
                    self.assertEqual(done.returncode, 1)
                    self.assertIn("is of another set", done.stderr)
                    self.assertNotIn("Traceback", done.stderr)
                    self.assertEqual(key.read_bytes(), made)
            for case in (Path(folder) / "cases").iterdir():
                shutil.rmtree(case)
            self.assertEqual(subprocess.run(small, capture_output=True, check=False).returncode, 0)
            self.assertEqual(key.read_bytes(), made)
            self.assertEqual(len(list((Path(folder) / "cases").iterdir())), 2)

    def test_an_interrupted_set_whose_cases_are_gone_is_made_whole(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            key, cases, labels = Path(folder) / "key.json", Path(folder) / "cases", Path(folder) / "key.labels"
            small = self.generate(folder, "--stratum", "none=2", "--length", "0.2")
            self.assertEqual(subprocess.run(small, capture_output=True, check=False).returncode, 0)
            made = json.loads(key.read_text())
            key.unlink()  # as one that was interrupted leaves it
            labels.mkdir()
            (labels / "plan.sha256").write_text(made["plan"])
            for name, label in made["cases"].items():
                (labels / f"{name}.json").write_text(json.dumps(label))
            shutil.rmtree(cases)
            self.assertEqual(subprocess.run(small, capture_output=True, check=False).returncode, 0)
            self.assertEqual({one.name for one in cases.iterdir()}, set(made["cases"]))
            self.assertEqual(json.loads(key.read_text()), made)

    def test_no_open_key_is_laid_beside_a_sealed_one(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "key.sealed").write_text("")
            done = subprocess.run(self.generate(folder, "--stratum", "none=1"), capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("key.sealed is there", done.stderr)
            self.assertEqual([one.name for one in Path(folder).iterdir()], ["key.sealed"])

    def test_no_case_is_laid_among_others(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "cases" / "0123456789ab").mkdir(parents=True)
            done = subprocess.run(self.generate(folder, "--stratum", "none=2"), capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("holds 0123456789ab, which is no case of this set", done.stderr)
            self.assertEqual([one.name for one in (Path(folder) / "cases").iterdir()], ["0123456789ab"])
            self.assertFalse((Path(folder) / "key.labels").exists())

    def test_what_cannot_begin_leaves_nothing(self) -> None:
        for blocked, made in (("cases", "key.labels"), ("key.labels", "cases")):
            with self.subTest(blocked), tempfile.TemporaryDirectory() as folder:
                (Path(folder) / blocked).write_text("")
                done = subprocess.run(self.generate(folder, "--stratum", "none=2"), capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 1)
                self.assertIn(f"{folder}/{blocked}", done.stderr)
                self.assertNotIn("Traceback", done.stderr)
                self.assertFalse((Path(folder) / made).exists())

    def test_what_another_set_has_begun_is_not_taken_for_this_one(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            labels = Path(folder) / "key.labels"
            labels.mkdir()
            (labels / "plan.sha256").write_text("another plan")
            done = subprocess.run(self.generate(folder, "--stratum", "none=2"), capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("key.labels is of another set", done.stderr)


class Trial(unittest.TestCase):
    """What `scripts/trial` refuses before it builds or runs anything."""

    def test_options_that_do_not_go_together(self) -> None:
        for options in (
            ("--fixed", "--each"), ("--real", "--peers"), ("--real", "--controls"), ("--each", "--controls"), ("--each", "--count", "5"),
            ("--controls", "--passphrase-file", __file__), ("--passphrase-file", "/no/such/file"), ("--seed",), ("--nonsense",),
            ("--machines", "--seed", "a"), ("--machines", "--count", "5"), ("--machines", "--real"), ("--only", "emps"), ("--real", "--jobs", "2"),
            ("--loops", "--user", "nobody"), ("--predict", "--seed", "a"), ("--loops", "--messy"), ("--messy", "--controls"), ("--messy", "--only", "x"),
        ):  # fmt: skip
            with self.subTest(options):
                done = subprocess.run([str(ROOT / "scripts" / "trial"), "--no-build", *options], capture_output=True, text=True, check=False, timeout=60)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(done.stdout, "")
                self.assertNotEqual(done.stderr, "")

    def test_a_passphrase_file_is_looked_for_where_the_user_is(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            command = [str(ROOT / "scripts" / "trial"), "--no-build", "--passphrase-file", "absent"]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=60)
            self.assertIn(f"{Path(folder).resolve()}/absent: no such file", done.stderr)


class Python(unittest.TestCase):
    """A Python without numpy."""

    def test_it_is_told_what_is_missing(self) -> None:
        program = "import sys; sys.modules['numpy'] = None; sys.argv[0] = 'x'; import importlib.util as u; f = u.find_spec; u.find_spec = lambda n: None if n == 'numpy' else f(n); import trials"
        done = subprocess.run(["/usr/bin/python3", "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("has no numpy; call the programs of trials/ by name", done.stderr)


if __name__ == "__main__":
    unittest.main()
