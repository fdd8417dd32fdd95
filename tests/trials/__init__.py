"""Tests of the blind trial."""
