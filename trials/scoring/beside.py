"""The peers' figures beside the product's: whether the name is right, and how far the gap closes."""

from __future__ import annotations

from trials.scoring.figures import Score
from trials.scoring.text import amount

SHOWN = (
    "single_r10", "single_r3", "single_r1", "cousin_r10", "named_r3", "rivals", "pair", "false_alarm", "ambiguous", "sure_wrong", "auroc",
    "edge", "closure", "closure_10", "own_closure", "own_closure_10", "seconds", "missing",
)  # fmt: skip


def beside(scores: dict[str, Score]) -> str:
    """A column for each diagnoser, the product first."""
    names = list(scores)
    known = {name: {f.key: f for f in score.figures} for name, score in scores.items()}
    lines = ["the same cases by the peers" + " " * 25 + "".join(f"{name:>12s}" for name in names), "-" * (52 + 12 * len(names))]
    under = {"closure_10": "closure, 10th percentile", "own_closure": "closure of the effect's own gap, median", "own_closure_10": "  the same, 10th percentile"}
    for key in SHOWN:
        first = known[names[0]][key]
        title = under.get(key, first.title.strip())
        lines.append(f"{title[:50]:52s}" + "".join(f"{amount(known[name][key].value, first.unit):>12s}" for name in names))
    return "\n".join(lines) + "\n"
