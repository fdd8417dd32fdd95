"""Judges verdicts against the key."""
