"""Seals a key: SHA-256 in counter mode as the keystream (NIST SP 800-108's counter construction with HMAC as the
pseudo-random function), scrypt for the passphrase, encrypt-then-MAC. Python's own hashlib is all it needs."""

from __future__ import annotations

import datetime
import errno
import hashlib
import hmac
import json
import os
import pwd
from pathlib import Path

import numpy as np

MAGIC = b"hysteron-sealed-key/1\n"
LOG = Path(__file__).resolve().parent / "openings.log"


class NotSealed(ValueError):
    """The file is no sealed key, or the passphrase is another one."""


class Refused(ValueError):
    """A passphrase that others can read, or a file that is no key."""


def passphrase_of(file: Path) -> bytes:
    """A passphrase from its file. Raises Refused where it is short, a folder, or where others than its owner can read it."""
    if file.is_dir():
        raise Refused(f"{file}: this is a folder; name the file that holds the passphrase")
    if file.stat().st_mode & 0o077:
        raise Refused(f"{file}: others can read this passphrase: chmod 600 {file}")
    text = file.read_bytes().strip()
    if len(text) < 16:
        raise Refused(f"{file}: the passphrase has fewer than 16 characters; make one: head -c 32 /dev/urandom | base64 >{file}")
    return text


def key_of(text: bytes, file: Path) -> dict:
    """A key that is open. Raises Refused where it is none."""
    try:
        key = json.loads(text)
        if isinstance(key["cases"], dict) and key["cases"] and all(isinstance(one["stratum"], str) for one in key["cases"].values()):
            return key
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise Refused(f"{file}: this is no key of a set; trials/generate writes one with --key")


def seal_file(key: Path, passphrase: bytes) -> str:
    """KEY.sealed and KEY.sha256 in place of KEY.json; returns the SHA-256. Nothing that is there is written over, and the
    open key goes only once the sealed one was read back. Raises Refused, or FileExistsError."""
    text = key.read_bytes()
    key_of(text, key)
    sealed = seal(text, passphrase)
    target, listed = key.with_suffix(".sealed"), key.with_suffix(".sha256")
    if listed.exists():
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(listed))
    with target.open("xb") as file:
        file.write(sealed)
        file.flush()
        os.fsync(file.fileno())
    if unseal(target.read_bytes(), passphrase) != text:
        raise NotSealed(f"{target} does not hold the key; {key} is left as it is")
    digest = hashlib.sha256(sealed).hexdigest()
    with listed.open("x") as file:
        file.write(f"{digest}  {target.name}\n")
    key.unlink()
    return digest


def _keys(passphrase: bytes, salt: bytes) -> tuple[bytes, bytes]:
    both = hashlib.scrypt(passphrase, salt=salt, n=2**14, r=8, p=1, dklen=64)
    return both[:32], both[32:]


def _xor_with_stream(key: bytes, data: bytes) -> bytes:
    blocks = -(-len(data) // 32)
    stream = b"".join(hmac.digest(key, counter.to_bytes(8, "big"), "sha256") for counter in range(blocks))
    mixed = np.frombuffer(data, np.uint8) ^ np.frombuffer(stream[: len(data)], np.uint8)
    return mixed.tobytes()


def seal(text: bytes, passphrase: bytes) -> bytes:
    """Encrypts a key."""
    salt = os.urandom(16)
    cipher, mac = _keys(passphrase, salt)
    body = salt + _xor_with_stream(cipher, text)
    return MAGIC + body + hmac.digest(mac, body, "sha256")


def unseal(sealed: bytes, passphrase: bytes) -> bytes:
    """Decrypts a key, or raises NotSealed."""
    if not sealed.startswith(MAGIC) or len(sealed) < len(MAGIC) + 48:
        raise NotSealed("this is no sealed key")
    body, tag = sealed[len(MAGIC) : -32], sealed[-32:]
    cipher, mac = _keys(passphrase, body[:16])
    if not hmac.compare_digest(hmac.digest(mac, body, "sha256"), tag):
        raise NotSealed("the passphrase is another one, or the file was changed")
    return _xor_with_stream(cipher, body[16:])


def record_opening(sealed: bytes, purpose: str, log: Path = LOG) -> str:
    """Appends a line to the log of openings; it is committed with the result. The user is the process's own."""
    try:
        user = pwd.getpwuid(os.getuid()).pw_name
    except KeyError:
        user = str(os.getuid())
    when = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    line = f"{when}  {hashlib.sha256(sealed).hexdigest()}  {user}  {' '.join(purpose.split())}\n"
    with log.open("a") as file:
        file.write(line)
    return line


def seed(commit: str, nonce: str) -> str:
    """Seed of a scored set: nobody can know it before the product's commit exists."""
    return hashlib.sha256(f"{commit}|{nonce}".encode()).hexdigest()
