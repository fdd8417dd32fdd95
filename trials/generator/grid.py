"""The two clocks of a record: the samples that are logged, and the sub-steps in which the physics is computed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

SUBSTEPS = 20
"""Sub-steps of a sampling interval: the least that the trial's protocol allows."""


@dataclass(frozen=True)
class Grid:
    """A record of `samples` samples, `ts` seconds apart, with `substeps` computed points in each interval."""

    ts: float
    samples: int
    substeps: int = SUBSTEPS

    @property
    def dt(self) -> float:
        """Length of a sub-step in seconds."""
        return self.ts / self.substeps

    @property
    def length(self) -> float:
        """Time from the first sample to the last, in seconds."""
        return self.ts * (self.samples - 1)

    @cached_property
    def t(self) -> np.ndarray:
        """Times of the samples."""
        return np.arange(self.samples) * self.ts

    @cached_property
    def fine(self) -> np.ndarray:
        """Times of the sub-steps, from the first sample to the last."""
        return np.arange((self.samples - 1) * self.substeps + 1) * self.dt

    def sample(self, x: np.ndarray) -> np.ndarray:
        """What a sensor reads of a signal on the fine clock."""
        return x[:: self.substeps]

    def hold(self, x: np.ndarray) -> np.ndarray:
        """A command that stands from one sample to the next, on the fine clock."""
        return np.append(np.repeat(x[:-1], self.substeps), x[-1])
