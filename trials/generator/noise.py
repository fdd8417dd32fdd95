"""Sensor noise of unit RMS: white, coloured, 1/f, with rare outliers; and the rounding of a sensor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import signal

KINDS = ("white", "coloured", "pink", "quantised", "outliers")


@dataclass(frozen=True)
class Noise:
    """One channel's noise: `unit` has an RMS of 1, `step` is the sensor's resolution over the noise's RMS."""

    kind: str
    unit: np.ndarray
    step: float

    def read(self, clean: np.ndarray, rms: float) -> np.ndarray:
        """What the sensor shows; the whole error has nearly the given RMS, rounding included."""
        if self.step == 0.0:
            return clean + rms * self.unit
        lsb = self.step * rms
        rest = np.sqrt(max(1.0 - self.step**2 / 12.0, 0.05))
        return lsb * np.round((clean + rest * rms * self.unit) / lsb)


def draw(rng: np.random.Generator, samples: int, kind: str | None = None) -> Noise:
    """A noise of random kind. Colours are mixed with white, as an amplifier's are."""
    kind = kind or str(rng.choice(KINDS, p=(0.4, 0.2, 0.1, 0.2, 0.1)))
    x = rng.standard_normal(samples)
    step = 0.0
    if kind == "coloured":
        pole = rng.uniform(0.3, 0.85)
        x = signal.lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], rng.standard_normal(samples + 200))[200:]
    elif kind == "pink":
        # 1/f down to a few periods of the record, a third of the variance
        spectrum = np.fft.rfft(rng.standard_normal(samples))
        f = np.arange(len(spectrum), dtype=float)
        spectrum /= np.sqrt(np.maximum(f, 4.0))
        pink = np.fft.irfft(spectrum, samples)
        x = np.sqrt(2.0 / 3.0) * x + np.sqrt(1.0 / 3.0) * (pink - pink.mean()) / pink.std()
    elif kind == "quantised":
        step = float(rng.uniform(0.8, 2.0))
    elif kind == "outliers":
        hit = rng.random(samples) < 0.002
        x = x + hit * rng.choice((-1.0, 1.0), samples) * rng.uniform(4.0, 7.0, samples)
    return Noise(kind, x / np.sqrt(np.mean(x**2)), step)
