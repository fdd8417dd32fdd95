"""Controls that must fail, on verdicts of a real set: labels that are shuffled, a diagnoser that always says the same, a
classifier that sees names, sizes and times of files alone, and a set whose physics is computed in one sub-step a sample."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trials.scoring.figures import figures
from trials.scoring.judge import IN_LIBRARY, Judgement, judge
from trials.scoring.statistics import Share, share

SHUFFLES = 1000
FEWEST = 30
"""Cases whose name is asked; of fewer a control says nothing that chance does not."""


class TooFew(ValueError):
    """A set on which no control can be told from chance."""


def enough(cases: list[Judgement]) -> None:
    """Raises TooFew."""
    chosen = _named(cases)
    causes = {c.truth[0] for c in chosen}
    if len(chosen) < FEWEST or len(causes) < 2:
        raise TooFew(f"{len(chosen)} single effects at R = 3 and above, of {len(causes)} kinds: too few for controls, which take {FEWEST}; generate 60 cases or more")


@dataclass(frozen=True)
class Control:
    """One control: what it should give, what it gave, and whether that is as it should be."""

    name: str
    expected: str
    found: str
    held: bool


def _named(cases: list[Judgement]) -> list[Judgement]:
    """Cases whose name is asked."""
    return [c for c in cases if c.stratum in ("single", "cousin") and c.ratio >= 1.75]


def _percent(x: float) -> str:
    return f"{100.0 * x:.1f} %"


def shuffled(cases: list[Judgement], rng: np.random.Generator) -> Control:
    """Labels dealt out anew: the share of right names is what the frequencies of names and labels give by chance."""
    chosen = _named(cases)
    said, true = np.array([c.first for c in chosen]), np.array([c.truth[0] for c in chosen])
    own = float(np.mean(said == true))
    rates = np.array([np.mean(said == rng.permutation(true)) for _ in range(SHUFFLES)])
    chance = sum(float(np.mean(said == name)) * float(np.mean(true == name)) for name in set(true.tolist()))
    found = f"{_percent(float(rates.mean()))} in the mean of {SHUFFLES}, {_percent(float(rates.max()))} at most; as labelled {_percent(own)}"
    return Control("shuffled labels", f"{_percent(chance)} by chance", found, abs(rates.mean() - chance) < 0.01 and rates.max() < own)


def always(effect: str, labels: dict[str, dict[str, Any]]) -> Control:
    """A diagnoser that names one effect whatever it sees."""
    gap = {"nominal_rms": 1.0, "improved_rms": 1.0, "closed": 1.0, "closed_low": 1.0, "closed_high": 1.0}
    answer = {
        "verdict": "named", "effects": [{"id": effect, "edge": ""}], "rivals": [[effect]], "confidence": 0.99, "unknown_score": 0.0, "gap": gap,
    }  # fmt: skip
    cases = [judge(name, label, answer, {}) for name, label in labels.items()]
    found = {f.key: f for f in figures(cases)}
    chosen = _named(cases)
    right, there = share([c.named_first for c in chosen]), share([effect in c.truth for c in chosen])
    alarms = found["false_alarm"].value
    held = right == there and not alarms < 1.0 and not found["pair"].value > 0.0
    return Control(
        f"always “{effect}”", f"named first as often as it is there: {there.hits} of {there.count}; every false alarm",
        f"{right.hits} of {right.count}; false alarms {_percent(alarms)}", held,
    )  # fmt: skip


def _outside(folder: Path) -> list[float]:
    """What can be seen of a case without opening a file, but for the length of the record, which the diagnosis knows."""
    names = ("plant.st", "params.toml", "log.csv", "log2.csv")
    if not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(folder))
    stats = [(folder / name).stat() if (folder / name).exists() else None for name in names]
    sizes = [float(s.st_size) if s else 0.0 for s in stats]
    return [float(int(folder.name, 16) % 2**40), *sizes, *(s.st_mtime if s else 0.0 for s in stats)]


def _nearest(features: np.ndarray, labels: np.ndarray, plants: np.ndarray) -> float:
    """How often the nearest other case of the same plant has the same cause."""
    hits = []
    for plant in set(plants.tolist()):
        at = np.flatnonzero(plants == plant)
        if len(at) > 1:
            x = features[at]
            x = (x - x.mean(axis=0)) / np.maximum(x.std(axis=0), 1e-12)
            distance = ((x[:, None, :] - x[None, :, :]) ** 2).sum(axis=2)
            np.fill_diagonal(distance, np.inf)
            hits += (labels[at] == labels[at][distance.argmin(axis=1)]).tolist()
    return float(np.mean(hits)) if hits else 0.0


def peeking(cases: list[Judgement], folder: Path, rng: np.random.Generator) -> Control:
    """A nearest neighbour on names, sizes and times. The plant is known from the diagram, so labels are shuffled within it."""
    chosen = _named(cases)
    features = np.array([_outside(folder / c.name) for c in chosen])
    labels, plants = np.array([c.truth[0] for c in chosen]), np.array([c.plant for c in chosen])
    found = _nearest(features, labels, plants)
    chance = []
    for _ in range(SHUFFLES):
        dealt = labels.copy()
        for plant in set(plants.tolist()):
            at = np.flatnonzero(plants == plant)
            dealt[at] = rng.permutation(labels[at])
        chance.append(_nearest(features, dealt, plants))
    p = (1 + sum(one >= found for one in chance)) / (1 + SHUFFLES)
    return Control("peeking at names, sizes, times", f"{_percent(float(np.mean(chance)))} by chance", f"{_percent(found)}, p = {p:.2f}", p > 0.01)


def coarse(cases: list[Judgement], others: list[Judgement]) -> Control:
    """The same plan in one sub-step a sample: the score is lower, as sub-steps are what a machine has and a model has not."""

    def rate(of: list[Judgement]) -> Share:
        return share([c.right for c in of if c.stratum in (*IN_LIBRARY, "none", "calibration") and not c.ratio < 1.75 or c.stratum == "none"])

    fine, rough = rate(cases), rate(others)
    return Control(
        "one sub-step a sample", f"fewer right than {fine.hits} of {fine.count}", f"{rough.hits} of {rough.count}", rough.value < fine.value,
    )  # fmt: skip


def table(found: list[Control]) -> str:
    """The controls in columns."""
    lines = [f"{'control':33s}{'should give':66s}gave", "-" * 150]
    return "\n".join([*lines, *(f"{c.name:33s}{c.expected:66s}{c.found}{'' if c.held else '   NOT AS IT SHOULD BE'}" for c in found), ""])
