"""The seal: nobody reads the key before it is opened, and an opening leaves its line."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from trials import vault

ROOT = Path(__file__).resolve().parents[2]


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

class Seal(unittest.TestCase):
    """`trials/seal`: no key is lost, and a seed comes out the same for everyone."""

    def setUp(self) -> None:
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.top = Path(held.name)
        self.key, self.passphrase = self.top / "key.json", self.top / "pass"
        self.text = json.dumps({"seed": "a", "cases": {"1f": {"stratum": "none"}}})
        self.key.write_text(self.text)
        self.passphrase.write_text("a passphrase of some length\n")
        self.passphrase.chmod(0o600)

    def seal(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess:
        done = subprocess.run(
            [str(ROOT / "trials" / "seal"), *arguments], capture_output=True, text=True, check=False, env={**os.environ, **environment}
        )
        self.assertNotIn("Traceback", done.stderr)
        return done

    def new(self, key: Path) -> subprocess.CompletedProcess:
        return self.seal("new", str(key), "--passphrase-file", str(self.passphrase))

    def test_a_key_goes_only_once_it_is_sealed(self) -> None:
        self.assertEqual(self.new(self.key).returncode, 0)
        self.assertFalse(self.key.exists())
        sealed = (self.top / "key.sealed").read_bytes()
        self.assertEqual(vault.unseal(sealed, b"a passphrase of some length").decode(), self.text)
        self.assertIn(hashlib.sha256(sealed).hexdigest(), (self.top / "key.sha256").read_text())

    def test_nothing_is_sealed_twice_or_written_over(self) -> None:
        self.assertEqual(self.new(self.key).returncode, 0)
        sealed = (self.top / "key.sealed").read_bytes()
        self.key.write_text(self.text)
        for other in (self.top / "key.sealed", self.key):
            self.assertEqual(self.new(other).returncode, 1)
            self.assertEqual((self.top / "key.sealed").read_bytes(), sealed)
        self.assertTrue(self.key.exists())
        (self.top / "key.sealed").unlink()
        self.assertIn("key.sha256 is there already", self.new(self.key).stderr)
        self.assertFalse((self.top / "key.sealed").exists())

    def test_no_key_seals_itself(self) -> None:
        self.key.chmod(0o600)
        self.assertIn("keep the two apart", self.seal("new", str(self.key), "--passphrase-file", str(self.key)).stderr)
        self.assertEqual(self.key.read_text(), self.text)

    def test_what_is_no_key_is_left(self) -> None:
        for text in ("", "notes", "[1]", '{"cases": {}}', '{"cases": 3}', '{"cases": {"1f": 1}}', '{"cases": {"1f": {}}}', "[" * 100_000):
            self.key.write_text(text)
            self.assertIn("no key of a set", self.new(self.key).stderr)
            self.assertEqual(self.key.read_text(), text)

    def test_a_passphrase_that_others_read_or_guess(self) -> None:
        self.passphrase.chmod(0o640)
        self.assertIn("chmod 600", self.new(self.key).stderr)
        self.passphrase.chmod(0o600)
        self.passphrase.write_text("short")
        self.assertIn("fewer than 16", self.new(self.key).stderr)
        self.passphrase.unlink()
        self.assertEqual(self.new(self.key).returncode, 1)
        self.passphrase.mkdir(mode=0o755)
        self.assertIn("this is a folder", self.new(self.key).stderr)
        self.assertTrue(self.key.exists())

    def test_seeds(self) -> None:
        for commit, nonce in (("nonsense", "a"), ("no-such-commit", "a"), ("0" * 40, "")):
            self.assertNotEqual(self.seal("seed", "--commit", commit, "--nonce", nonce).returncode, 0)
        self.assertEqual(self.seal("seed", "--commit", "0" * 40, "--nonce", "a").stdout.strip(), vault.seed("0" * 40, "a"))

    def test_seeds_where_no_git_is(self) -> None:
        no_programs = {"PATH": str(self.top)}
        self.assertIn("git is not installed", self.seal("seed", "--commit", "HEAD", "--nonce", "a", **no_programs).stderr)
        self.assertEqual(self.seal("seed", "--commit", "0" * 40, "--nonce", "a", **no_programs).returncode, 0)


if __name__ == "__main__":
    unittest.main()
