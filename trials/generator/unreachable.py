"""Draws that do not go together."""

from __future__ import annotations


class Unreachable(RuntimeError):
    """What is asked of a case cannot be had with what else was drawn for it."""
