"""Proportions with Wilson's interval, quantiles, and the area under a receiver's curve."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats


@dataclass(frozen=True)
class Share:
    """So many of so many."""

    hits: int
    count: int

    @property
    def value(self) -> float:
        """The proportion; not a number where nothing was counted."""
        return self.hits / self.count if self.count else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval."""
        return wilson(self.value, self.count)


def wilson(p: float, n: int) -> tuple[float, float]:
    """95 % interval of a proportion p of n (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209)."""
    if n == 0:
        return (0.0, 1.0)
    z = 1.959963984540054
    middle = p + z * z / (2 * n)
    half = z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    low, high = (middle - half) / (1 + z * z / n), (middle + half) / (1 + z * z / n)
    # At 0 and 1 the interval ends there, but for rounding.
    return (min(p, max(0.0, low)), max(p, min(1.0, high)))


def share(flags: list[bool]) -> Share:
    """How many are true."""
    return Share(sum(bool(x) for x in flags), len(flags))


def auroc(positive: list[float], negative: list[float]) -> float:
    """Probability that a positive's score exceeds a negative's; ties count half (Mann and Whitney)."""
    if not positive or not negative:
        return math.nan
    ranks = stats.rankdata(np.concatenate((positive, negative)))
    n = len(positive)
    return float((ranks[:n].sum() - n * (n + 1) / 2) / (n * len(negative)))


def auroc_interval(positive: list[float], negative: list[float]) -> tuple[float, float]:
    """95 % interval of it: Wilson's, for as many as the smaller of both has. It is too wide rather than too narrow, and has a
    width where all are told apart."""
    if not positive or not negative:
        return (math.nan, math.nan)
    return wilson(auroc(positive, negative), min(len(positive), len(negative)))


def recall_at(positive: list[float], negative: list[float], false_share: float) -> Share:
    """Positives above the threshold that the given share of negatives exceeds."""
    if not positive or not negative:
        return Share(0, 0)
    ordered = sorted(negative, reverse=True)
    threshold = ordered[min(int(false_share * len(ordered)), len(ordered) - 1)]
    return share([x > threshold for x in positive])


def quantile_interval(values: list[float], q: float) -> tuple[float, float, float]:
    """A quantile with its distribution-free 95 % interval from order statistics."""
    if not values:
        return (math.nan, math.nan, math.nan)
    x = np.sort(values)
    n = len(x)
    low = int(stats.binom.ppf(0.025, n, q))
    high = min(int(stats.binom.ppf(0.975, n, q)), n - 1)
    return (float(np.quantile(x, q)), float(x[max(low - 1, 0)]), float(x[high]))
