"""The score as one self-contained page with pictures."""

from __future__ import annotations

import base64
import html
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from trials.scoring.figures import Score  # noqa: E402
from trials.scoring.text import amount, decidable, effects, goal, mark, plants, strata  # noqa: E402

INK, GOOD, BAD = "#1f3a5f", "#2f855a", "#c05621"
STYLE = """
body{font:15px/1.5 system-ui,sans-serif;color:#1a202c;max-width:72em;margin:2em auto;padding:0 1em}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}
.wide{overflow-x:auto}table{border-collapse:collapse}td,th{padding:.2em .8em;border-bottom:1px solid #e2e8f0;text-align:right}
td:first-child,th:first-child{text-align:left;white-space:pre}
.reached{color:#2f855a}.missed{color:#c05621;font-weight:600}
pre{background:#f7fafc;padding:.8em;overflow-x:auto}img{max-width:100%}
"""


LONGEST = 28
"""Characters of a name in a picture."""


def _picture(figure: plt.Figure, says: str) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="svg", bbox_inches="tight")
    plt.close(figure)
    return f'<img alt="{html.escape(says)}" src="data:image/svg+xml;base64,{base64.b64encode(buffer.getvalue()).decode()}">'


def reliability(score: Score) -> str:
    """Stated confidence against the share of right verdicts, and how many verdicts each tenth holds."""
    figure, (axes, below) = plt.subplots(2, 1, figsize=(6, 6), sharex=True, height_ratios=(3, 1))
    axes.plot([0, 1], [0, 1], color="#a0aec0", lw=1, ls="--", label="as stated")
    for one in score.reliability:
        axes.errorbar(one["stated"], one["right"], yerr=[[one["right"] - one["from"]], [one["to"] - one["right"]]], color=INK, fmt="o", capsize=3)
    axes.set(ylabel="share of right verdicts,\n95 % interval", xlim=(0, 1.03), ylim=(0, 1.03))
    axes.legend(loc="lower right", frameon=False)
    bars = below.bar([one["low"] + 0.05 for one in score.reliability], [one["count"] for one in score.reliability], width=0.09, color=INK)
    below.bar_label(bars, fmt="%d")
    below.set(xlabel="stated confidence", ylabel="verdicts")
    below.margins(y=0.25)
    return _picture(figure, "Share of right verdicts over the stated confidence")


def times(score: Score) -> str:
    """How long the cases took."""
    if not score.seconds:
        return "<p>No run times.</p>"
    figure, axes = plt.subplots(figsize=(7.5, 2.6))
    low, high = max(min(score.seconds), 0.01), max(*score.seconds, 60.0, 0.02)
    axes.hist(score.seconds, bins=np.geomspace(low, high, 30), color=INK)
    axes.axvline(60.0, color="#1a202c", lw=1.2, ls="--", label="goal of the slowest, 60 s")
    axes.set(xscale="log", xlabel="run time of a case, s", ylabel="cases")
    axes.legend(frameon=False)
    return _picture(figure, "Histogram of run times")


def confusion(score: Score) -> str:
    """The confusion matrix, rows summing to 1."""
    rows = list(score.confusion)
    columns = rows + sorted({c for line in score.confusion.values() for c in line} - set(rows))
    matrix = np.array([[score.confusion[r].get(c, 0) / max(sum(score.confusion[r].values()), 1) for c in columns] for r in rows])
    if matrix.size == 0:
        return "<p>No cases.</p>"
    figure, axes = plt.subplots(figsize=(0.32 * len(columns) + 2.8, 0.3 * len(rows) + 2.4))
    axes.imshow(matrix, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    axes.set_xticks(range(len(columns)), [name[:LONGEST] for name in columns], rotation=90)
    axes.set_yticks(range(len(rows)), [name[:LONGEST] for name in rows])
    for i, r in enumerate(rows):
        for j, c in enumerate(columns):
            n = score.confusion[r].get(c, 0)
            if n:
                axes.text(j, i, str(n), ha="center", va="center", fontsize=9, color="white" if matrix[i, j] > 0.55 else INK)
    axes.set(xlabel="put first by the verdict", ylabel="true cause")
    return _picture(figure, "True causes against what verdicts put first")


def intervals(score: Score) -> str:
    """Proportions with their intervals and goals."""
    shown = [f for f in score.figures if f.unit == "%" and f.count and f.value == f.value]
    if not shown:
        return "<p>No cases.</p>"
    figure, axes = plt.subplots(figsize=(8, 0.33 * len(shown) + 0.8))
    for i, f in enumerate(reversed(shown)):
        color = {True: GOOD, False: BAD, None: INK}[f.reached]
        axes.plot([100 * f.low, 100 * f.high], [i, i], color=color, lw=2)
        axes.plot(100 * f.value, i, "o", color=color, ms=5)
        for at in f.band or ((f.goal,) if f.goal is not None else ()):
            axes.plot([100 * at] * 2, [i - 0.35, i + 0.35], color="#1a202c", lw=1.2)
    axes.set_yticks(range(len(shown)), [f.title.replace("  ", "↳ ", 1) if f.title.startswith("  ") else f.title for f in reversed(shown)])
    axes.tick_params(axis="y", length=0)
    for label in axes.get_yticklabels():
        label.set_horizontalalignment("left")
    axes.tick_params(axis="y", pad=300)
    axes.set(xlim=(-2, 102), xlabel="%; points with 95 % intervals; ticks: goals")
    return _picture(figure, "The proportions of the table with their intervals and goals")


def distance(apart: float) -> str:
    """Of an improved diagram from the machine."""
    return "–" if np.isnan(apart) else f"{apart:.2f}"


def page(score: Score, head: str, side_by_side: str = "") -> str:
    """The page; `side_by_side` is the table of the peers."""
    lines = []
    for f in score.figures:
        word = mark(f)
        lines.append(
            f"<tr><td>{html.escape(f.title)}</td><td>{amount(f.value, f.unit)}</td><td>{amount(f.low, f.unit)} … {amount(f.high, f.unit)}</td>"
            f'<td>{f.count}</td><td>{goal(f)}</td><td class="{word}">{word}</td><td>{decidable(f)}</td></tr>'
        )
    worst = "".join(
        f"<tr><td>{m['case']}</td><td>{m['stratum']}</td><td>{m['plant']}</td><td>{m['ratio']}</td><td>{html.escape(', '.join(m['truth']) or 'none')}</td>"
        f"<td>{m['verdict']}</td><td>{html.escape(', '.join(m['effects']))}</td><td>{m['confidence']:.2f}</td><td>{distance(m['apart'])}</td></tr>"
        for m in score.misses[:400]
    )
    peers = f"<h2>The peers on the same cases</h2><pre>{html.escape(side_by_side)}</pre>" if side_by_side else ""
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Blind trial of the diagnosis</title><style>{STYLE}</style></head><body>
<h1>Blind trial of the diagnosis</h1>
<pre>{html.escape(head)}</pre>
<p>R: RMS of what the effect changes after the best refit of the known parameters, over the RMS of the noise. Rival set: the sets of
effects that a verdict does not rule out. Closure: the share of the gap that the improved diagram closes, 1 for an oracle, which leaves
the noise. Decidable: without the wrong verdicts whose model is nearer to the machine than the noise; to any record the two are the
same. Protocol and all terms: docs/trials.md.</p>
<h2>Figures to reach</h2>
<div class="wide"><table><tr><th>figure</th><th>value</th><th>95 % interval</th><th>cases</th><th>goal</th><th></th><th>decidable</th></tr>{"".join(lines)}</table></div>
{intervals(score)}
{peers}
<h2>What is taken for what</h2>{confusion(score)}
<h2>Stated confidence</h2>{reliability(score)}
<h2>Run times</h2>{times(score)}
<h2>By effect and by plant</h2><pre>{html.escape(effects(score))}</pre><pre>{html.escape(plants(score))}</pre>
<h2>Verdicts by stratum</h2><pre>{html.escape(strata(score))}</pre>
<h2>Verdicts that are not right ({len(score.misses)})</h2>
<div class="wide"><table><tr><th>case</th><th>stratum</th><th>plant</th><th>R</th><th>truth</th><th>verdict</th><th>effects</th><th>confidence</th><th>from the machine, in noises</th></tr>{worst}</table></div>
</body></html>
"""
