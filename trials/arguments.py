"""What the command lines of the trial take, kinds of arguments with their refusals, and how they count."""

from __future__ import annotations

import argparse
import math
import shutil
from pathlib import Path


def whole(text: str) -> int:
    """A whole number from 1."""
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: write a whole number from 1")
    return int(text)


def above_zero(text: str) -> float:
    """A finite number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text}: write a number above 0")
    return value


def length(text: str) -> float:
    """A share of the usual number of samples: with fewer than a fifth no excitation is left that shows all effects."""
    value = above_zero(text)
    if not 0.2 <= value <= 20.0:
        raise argparse.ArgumentTypeError(f"{text}: write a share from 0.2 to 20")
    return value


def seconds(text: str) -> float:
    """A time above 0, of a year at most."""
    value = above_zero(text)
    if value > 366.0 * 86400.0:
        raise argparse.ArgumentTypeError(f"{text}: write a time in seconds, of a year at most")
    return value


def filled(text: str) -> str:
    """A text that is not empty, on one line."""
    if not text.strip():
        raise argparse.ArgumentTypeError("write some text; there is none")
    return " ".join(text.split())


def program_of(program: str) -> str:
    """A program by its path, or by its name in PATH."""
    found = shutil.which(program)
    if found is None:
        raise SystemExit(f"{program}: no such program; build it, or name it with --product")
    return str(Path(found).resolve())


def counted(number: int, what: str) -> str:
    """1 case, 2 cases."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
