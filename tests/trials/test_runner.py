"""The runner: what a diagnoser sees, what it may leave behind, and how a set goes on."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import stat
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from trials.runner import Diagnoser, diagnoser, run_case, run_set

ROOT = Path(__file__).resolve().parents[2]

PROBE = """#!/usr/bin/python3
import json, os, sys
os.makedirs(sys.argv[sys.argv.index("--out") + 1])
def read(path):
    try:
        with open(path) as file:
            return file.read()
    except OSError as error:
        return type(error).__name__
seen = sorted(os.path.join(folder, f) for folder, _, files in os.walk(".") for f in files)
json.dump({"verdict": "none", "read": [read(path) for path in sys.argv[-2:]], "seen": seen, "uid": os.getuid(), "groups": os.getgroups(),
           "up": sorted(os.listdir("..")), "typed": sys.stdin.read()}, open("result/verdict.json", "w"))
"""
COUNTS = """#!/usr/bin/python3
import os
os.makedirs("result")
open("result/verdict.json", "w").write("{}")
open(%r, "a").write("ran\\n")
"""
GOOD = "mkdir result; echo '{\"verdict\": \"none\"}' >result/verdict.json\n"


class Folder(unittest.TestCase):
    """A set of three cases, and a diagnoser that a test writes."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.top = Path(held.name)
        self.top.chmod(0o755)
        self.cases, self.out = self.top / "cases", self.top / "out"
        self.cases.mkdir(mode=0o700)
        for case in ("1a", "2b", "3c"):
            (self.cases / case).mkdir(parents=True)
            for file in ("plant.st", "params.toml", "log.csv", "notes.txt"):
                (self.cases / case / file).write_text("x")

    def program(self, text: str) -> str:
        """An executable file."""
        file = self.top / "program"
        file.write_text(text if text.startswith("#!") else "#!/bin/sh\n" + text)
        file.chmod(0o755)
        return str(file)

    def run_one(self, text: str, **more: object) -> tuple[bool, dict]:
        """A case by a program: whether it has a verdict, and its notes."""
        found = run_case(self.cases / "1a", self.out, Diagnoser(self.program(text), **more))
        return found, json.loads((self.out / "1a" / "run.json").read_text())

    def trial(self, *more: str) -> list[str]:
        """The command line."""
        return [str(ROOT / "trials" / "run"), str(self.cases), "--out", str(self.out), "--product", str(self.top / "program"), *more]

    def alive(self, mark: str) -> bool:
        """Whether a process has this command."""
        for process in Path("/proc").glob("[0-9]*/cmdline"):
            with contextlib.suppress(OSError):
                if process.read_bytes().replace(b"\0", b" ").strip() == mark.encode():
                    return True
        return False


class Sandbox(Folder):
    """What a diagnoser sees while it runs."""

    def probe(self, user: str | None) -> dict:
        """A diagnoser that tries to read a key, and a file for root's group alone."""
        keys = self.top / "keys"
        keys.mkdir(mode=0o700)
        key, shared = keys / "key.json", self.top / "shared"
        key.write_text("creep")
        key.chmod(0o600)
        shared.write_text("secret")
        shared.chmod(0o640)
        self.assertEqual(stat.S_IMODE(key.stat().st_mode), 0o600)
        self.assertTrue(self.run_one(PROBE, options=(str(key), str(shared)), user=user)[0])
        return json.loads((self.out / "1a" / "verdict.json").read_text())

    def test_another_user_reads_neither_the_key_nor_what_is_the_groups_of_root(self) -> None:
        if os.getuid() == 0:
            found = self.probe("nobody")
            self.assertNotEqual(found["uid"], 0)
            self.assertNotIn(0, found["groups"])
            self.assertEqual(found["read"], ["PermissionError", "PermissionError"])
        else:
            # Nobody but root can become another user: there the key has to be sealed, which test_vault holds.
            self.assertEqual(self.probe(None)["uid"], os.getuid())
            with self.assertRaises(SystemExit):
                diagnoser("sh", [], 1.0, "nobody", False)

    def test_a_user_who_could_read_all_cases_is_refused(self) -> None:
        self.cases.chmod(0o755)
        with self.assertRaisesRegex(SystemExit, "chmod 700"):
            run_set(self.cases, self.out, Diagnoser(self.program(GOOD), user="nobody"), 1)
        with self.assertRaises(SystemExit):
            diagnoser("sh", [], 1.0, "no-such-user", False)

    def test_the_folder_of_a_run_holds_the_case_alone(self) -> None:
        found = self.probe(None)
        self.assertEqual(found["seen"], ["./log.csv", "./params.toml", "./plant.st"])
        self.assertNotIn("cases", found["up"])
        self.assertNotIn("keys", found["up"])
        self.assertEqual(found["typed"], "")


class Leaves(Folder):
    """What a diagnoser leaves: no process, no link, no half of a verdict."""

    def test_one_that_hangs_is_ended(self) -> None:
        found, notes = self.run_one("sleep 60\n", timeout=0.2)
        self.assertFalse(found)
        self.assertEqual(notes["exit"], "time limit")

    def test_what_it_detaches_ends_with_it(self) -> None:
        for how in ("setsid sleep {} &", "sleep {} >/dev/null 2>&1 </dev/null &", "(setsid sleep {} & ) &"):
            with self.subTest(how):
                mark = f"71.{os.getpid()}"
                started = time.monotonic()
                found, _ = self.run_one(how.format(mark) + "\n" + GOOD, timeout=30.0)
                self.assertTrue(found)
                self.assertLess(time.monotonic() - started, 30.0)
                self.assertFalse(self.alive(f"sleep {mark}"))

    def test_it_ends_with_a_runner_that_is_killed(self) -> None:
        mark = f"72.{os.getpid()}"
        self.program(f"setsid sleep {mark} & touch {self.top}/begun; wait\n")
        for number in (signal.SIGKILL, signal.SIGHUP, signal.SIGTERM):
            with self.subTest(number.name), subprocess.Popen(self.trial(), stderr=subprocess.DEVNULL) as running:
                while not (self.top / "begun").exists():
                    time.sleep(0.02)
                running.send_signal(number)
                running.wait(60)
                while self.alive(f"sleep {mark}"):  # without end where it is not ended: the test's own time limit
                    time.sleep(0.02)
                (self.top / "begun").unlink()

    def test_links_lead_nowhere(self) -> None:
        secret = self.top / "secret"
        secret.write_text('{"verdict": "none"}')
        for text in (f"mkdir result; ln -s {secret} result/verdict.json", f"mkdir x; cp {secret} x/verdict.json; ln -s x result"):
            self.assertFalse(self.run_one(text + "\n")[0])
        self.assertTrue(self.run_one(GOOD + f"ln -s {secret} result/improved.st; ln -s {self.cases} result/all; mkdir result/more; echo 1 >result/more/one\n", keep=True)[0])
        left = sorted(str(file.relative_to(self.out / "1a")) for file in (self.out / "1a").rglob("*") if file.is_file())
        self.assertEqual(left, ["more/one", "run.json", "verdict.json"])

    def test_what_is_no_verdict(self) -> None:
        for text in (
            "mkdir result; echo '{\"verdict\":' >result/verdict.json", "mkdir result; echo '[1]' >result/verdict.json", "mkdir -p result/verdict.json",
            "mkdir result; mkfifo result/verdict.json", GOOD + "kill -SEGV $$", "printf 'gr\\366' >&2", "#!/no/such/interpreter\n", "exit 3",
        ):  # fmt: skip
            with self.subTest(text):
                found, notes = self.run_one(text + "\n", timeout=20.0)
                self.assertFalse(found)
                self.assertFalse(notes["verdict"])
                self.assertFalse((self.out / "1a" / "verdict.json").exists())

    def test_no_file_is_larger_than_allowed(self) -> None:
        found, _ = self.run_one(GOOD + "head -c 400M /dev/zero >result/improved.st\n")
        self.assertTrue(found)
        self.assertLess((self.out / "1a" / "improved.st").stat().st_size, 2**28 + 1)


class Resumed(Folder):
    """A set that was interrupted goes on; verdicts of another diagnoser are not taken for its own."""

    def test_what_has_run_is_not_run_again(self) -> None:
        runs = self.top / "runs"
        one = Diagnoser(self.program(COUNTS % str(runs)))
        self.assertEqual(run_set(self.cases, self.out, one, 1), (3, 0))
        (self.out / "2b" / "run.json").unlink()  # as if interrupted before it was whole
        self.assertEqual(run_set(self.cases, self.out, one, 1), (3, 0))
        self.assertEqual(runs.read_text().count("ran"), 4)
        with self.assertRaises(SystemExit):
            run_set(self.cases, self.out, Diagnoser(one.program, ("--other",)), 1)

    def test_those_without_a_verdict_are_run_again_where_it_is_wanted(self) -> None:
        self.program(f"if [ -e {self.top}/well ]; then {GOOD.strip()}; fi\n")
        done = subprocess.run(self.trial(), capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("3 cases run, 3 of them without a verdict", done.stdout)
        (self.top / "well").touch()
        for more, failed in (((), 3), (("--again",), 0)):
            done = subprocess.run(self.trial(*more), capture_output=True, text=True, check=False)
            self.assertIn(f"3 cases run, {failed} of them without a verdict", done.stdout)

    def test_a_broken_case_is_one_case_without_a_verdict(self) -> None:
        (self.cases / "1a" / "plant.st").unlink()
        (self.cases / "1a" / "plant.st").mkdir()
        (self.cases / "0e").mkdir()
        self.assertEqual(run_set(self.cases, self.out, Diagnoser(self.program(f"test -f plant.st && {GOOD}")), 2), (4, 2))

    def test_an_interrupt_ends_what_runs_and_keeps_what_has_run(self) -> None:
        runs = self.top / "runs"
        self.program(COUNTS % str(runs) + f"import time\nif open({str(runs)!r}).read().count('ran') == 2:\n    time.sleep(600)\n")
        command = ["env", "--default-signal=INT", *self.trial()]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as trial:
            while not (runs.exists() and runs.read_text().count("ran") == 2):
                time.sleep(0.02)
            trial.send_signal(signal.SIGINT)
            said = trial.communicate(timeout=60)[1]
        self.assertEqual(trial.returncode, 130)
        self.assertIn("1 cases have run", said)
        self.assertFalse((self.out / "2b" / "run.json").exists())
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        self.assertIn("3 cases run, 0 of them without a verdict", done.stdout)
        self.assertEqual(runs.read_text().count("ran"), 4)

    def test_programs_and_modules_that_take_part_count(self) -> None:
        program = Path(self.program(GOOD))
        other = self.top / "other"
        other.write_text("1")
        before = Diagnoser(str(program), (f"--hysteron={other}",)).fingerprint
        other.write_text("2")
        after = Diagnoser(str(program), (f"--hysteron={other}",)).fingerprint
        (self.top / "module.py").write_text("x = 1\n")
        self.assertEqual(len({before, after, Diagnoser(str(program), (f"--hysteron={other}",)).fingerprint}), 3)

    def test_options_that_name_files_are_good_in_every_folder(self) -> None:
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.top)
        (self.top / "there").mkdir()
        (self.top / "there" / "file").write_text("x")
        self.assertEqual(diagnoser("sh", ["--a=there/file", "--b=1/2", "--c"], 1.0, None, False).options, (f"--a={self.top.resolve()}/there/file", "--b=1/2", "--c"))


class Refused(Folder):
    """Arguments and folders that make no run."""

    def test_each_in_a_line_or_two(self) -> None:
        self.program(GOOD)
        (self.top / "empty").mkdir()
        (self.top / "file").write_text("x")
        for more in (
            ("--jobs", "0"), ("--jobs", "-3"), ("--timeout", "0"), ("--timeout", "nan"), ("--timeout", "1e20"), ("--user", "no-such-user"), ("--user", "nobody", "--jobs", "2"),
            ("--product", "/no/such"), ("--out", str(self.cases / "out")), ("--out", str(self.top / "file")),
        ):  # fmt: skip
            with self.subTest(more):
                done = subprocess.run(self.trial(*more), capture_output=True, text=True, check=False, timeout=60)
                self.assertNotEqual(done.returncode, 0)
                self.assertNotIn("Traceback", done.stderr)
                self.assertEqual(list(self.out.glob("*/run.json")), [])
        for cases in ("empty", "file", "nothing"):
            done = subprocess.run([str(ROOT / "trials" / "run"), str(self.top / cases), "--out", str(self.out)], capture_output=True, text=True, check=False)
            self.assertNotEqual(done.returncode, 0)
            self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
