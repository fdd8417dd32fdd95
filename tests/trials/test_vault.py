"""The seal: nobody reads the key before it is opened, and an opening leaves its line."""

from __future__ import annotations

import json
import os
import stat
import tempfile
import unittest
from pathlib import Path

from trials import vault
from trials.runner import run_case

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
json.dump({"verdict": "none", "key": read(sys.argv[-1]), "seen": seen, "uid": os.getuid(), "up": sorted(os.listdir(".."))},
          open("result/verdict.json", "w"))
"""


class Vault(unittest.TestCase):
    """Encryption by keystream and tag."""

    def test_round_trip(self) -> None:
        for text in (b"", b"x", b"creep" * 1000):
            self.assertEqual(vault.unseal(vault.seal(text, b"a passphrase of some length"), b"a passphrase of some length"), text)

    def test_other_passphrase_and_changed_file(self) -> None:
        sealed = vault.seal(b"creep", b"one")
        for wrong in (sealed[:-1] + bytes([sealed[-1] ^ 1]), sealed[:40] + bytes([sealed[40] ^ 1]) + sealed[41:], b"creep"):
            with self.assertRaises(vault.NotSealed):
                vault.unseal(wrong, b"one")
        with self.assertRaises(vault.NotSealed):
            vault.unseal(sealed, b"two")

    def test_no_label_shows_through_and_equal_keys_differ(self) -> None:
        text = json.dumps({"effects": ["creep"] * 100}).encode()
        first, second = vault.seal(text, b"one"), vault.seal(text, b"one")
        self.assertNotIn(b"creep", first)
        self.assertNotEqual(first, second)

    def test_every_opening_is_logged(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            log = Path(name) / "openings.log"
            vault.record_opening(b"sealed", "final\nset", log)
            vault.record_opening(b"sealed", "again", log)
            lines = log.read_text().splitlines()
        self.assertEqual(len(lines), 2)
        self.assertTrue(lines[0].endswith("final set"))

    def test_seed_depends_on_commit_and_nonce(self) -> None:
        self.assertEqual(len({vault.seed(c, n) for c in ("a", "b") for n in ("1", "2")}), 4)
        self.assertEqual(vault.seed("a", "1"), vault.seed("a", "1"))


class Sandbox(unittest.TestCase):
    """What a diagnoser sees while it runs."""

    def run_probe(self, user: str | None) -> dict:
        """Runs a diagnoser that tries to read the key, and returns what it found."""
        with tempfile.TemporaryDirectory() as name:
            top = Path(name)
            top.chmod(0o755)
            (top / "cases" / "1f").mkdir(parents=True)
            for file in ("plant.st", "params.toml", "log.csv", "notes.txt"):
                (top / "cases" / "1f" / file).write_text("x")
            keys = top / "keys"
            keys.mkdir(mode=0o700)
            key = keys / "key.json"
            key.write_text("creep")
            key.chmod(0o600)
            self.assertEqual(stat.S_IMODE(key.stat().st_mode), 0o600)
            probe = top / "probe"
            probe.write_text(PROBE)
            probe.chmod(0o755)
            self.assertTrue(run_case(top / "cases" / "1f", top / "out", str(probe), [str(key)], 30.0, user))
            return json.loads((top / "out" / "1f" / "verdict.json").read_text())

    def test_another_user_cannot_read_the_key(self) -> None:
        if os.getuid() == 0:
            found = self.run_probe("nobody")
            self.assertNotEqual(found["uid"], 0)
            self.assertEqual(found["key"], "PermissionError")
        else:
            # Nobody but root can become another user: there the key has to be sealed, which the tests above hold.
            self.assertEqual(self.run_probe(None)["uid"], os.getuid())

    def test_the_folder_of_a_run_holds_the_case_alone(self) -> None:
        found = self.run_probe(None)
        self.assertEqual(found["seen"], ["./log.csv", "./params.toml", "./plant.st"])
        self.assertNotIn("cases", found["up"])
        self.assertNotIn("keys", found["up"])

    def test_a_diagnoser_that_hangs_is_ended(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            top = Path(name)
            (top / "1f").mkdir()
            (top / "1f" / "plant.st").write_text("x")
            (top / "sleeper").write_text("#!/bin/sh\nsleep 60\n")
            (top / "sleeper").chmod(0o755)
            self.assertFalse(run_case(top / "1f", top / "out", str(top / "sleeper"), [], 0.2, None))
            self.assertEqual(json.loads((top / "out" / "1f" / "run.json").read_text())["exit"], "time limit")


if __name__ == "__main__":
    unittest.main()
