"""Blind trials of the diagnosis: generator, seal, runner, scorer and peers. It imports nothing of the product."""
