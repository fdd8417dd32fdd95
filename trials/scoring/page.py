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
from trials.scoring.text import amount, decidable, goal, mark  # noqa: E402

INK, GOOD, BAD = "#1f3a5f", "#2f855a", "#c05621"
STYLE = """
body{font:15px/1.5 system-ui,sans-serif;color:#1a202c;max-width:72em;margin:2em auto;padding:0 1em}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}
table{border-collapse:collapse}td,th{padding:.2em .8em;border-bottom:1px solid #e2e8f0;text-align:right}
td:first-child,th:first-child{text-align:left;white-space:pre}
.reached{color:#2f855a}.missed{color:#c05621;font-weight:600}
pre{background:#f7fafc;padding:.8em;overflow-x:auto}img{max-width:100%}
"""


def _picture(figure: plt.Figure) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="svg", bbox_inches="tight")
    plt.close(figure)
    return f'<img alt="" src="data:image/svg+xml;base64,{base64.b64encode(buffer.getvalue()).decode()}">'


def reliability(score: Score) -> str:
    """Stated confidence against the share of right verdicts."""
    figure, axes = plt.subplots(figsize=(5, 4.4))
    axes.plot([0, 1], [0, 1], color="#a0aec0", lw=1, ls="--", label="as stated")
    for one in score.reliability:
        axes.errorbar(one["stated"], one["right"], yerr=[[one["right"] - one["from"]], [one["to"] - one["right"]]], color=INK, fmt="o", capsize=3)
        axes.annotate(f"{one['count']:.0f}", (one["stated"], one["right"]), xytext=(6, -10), textcoords="offset points", fontsize=8)
    axes.set(xlabel="stated confidence", ylabel="share of right verdicts", xlim=(0, 1.03), ylim=(0, 1.03))
    axes.legend(loc="upper left", frameon=False)
    return _picture(figure)


def confusion(score: Score) -> str:
    """The confusion matrix, rows summing to 1."""
    rows = list(score.confusion)
    columns = rows + sorted({c for line in score.confusion.values() for c in line} - set(rows))
    matrix = np.array([[score.confusion[r].get(c, 0) / max(sum(score.confusion[r].values()), 1) for c in columns] for r in rows])
    if matrix.size == 0:
        return "<p>No cases.</p>"
    figure, axes = plt.subplots(figsize=(0.27 * len(columns) + 2.6, 0.25 * len(rows) + 2.2))
    axes.imshow(matrix, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    axes.set_xticks(range(len(columns)), columns, rotation=90, fontsize=8)
    axes.set_yticks(range(len(rows)), rows, fontsize=8)
    for i, r in enumerate(rows):
        for j, c in enumerate(columns):
            n = score.confusion[r].get(c, 0)
            if n:
                axes.text(j, i, str(n), ha="center", va="center", fontsize=7, color="white" if matrix[i, j] > 0.55 else INK)
    axes.set(xlabel="put first by the verdict", ylabel="true cause")
    return _picture(figure)


def intervals(score: Score) -> str:
    """Proportions with their intervals and goals."""
    shown = [f for f in score.figures if f.unit == "%" and f.count and f.value == f.value]
    if not shown:
        return "<p>No cases.</p>"
    figure, axes = plt.subplots(figsize=(7.5, 0.3 * len(shown) + 0.8))
    for i, f in enumerate(reversed(shown)):
        color = {True: GOOD, False: BAD, None: INK}[f.reached]
        axes.plot([100 * f.low, 100 * f.high], [i, i], color=color, lw=2)
        axes.plot(100 * f.value, i, "o", color=color, ms=5)
        for at in f.band or ((f.goal,) if f.goal is not None else ()):
            axes.plot([100 * at] * 2, [i - 0.35, i + 0.35], color="#1a202c", lw=1.2)
    axes.set_yticks(range(len(shown)), [f.title.strip() for f in reversed(shown)], fontsize=8)
    axes.set(xlim=(-2, 102), xlabel="%; points with 95 % intervals, ticks: goals")
    return _picture(figure)


def page(score: Score, head: str) -> str:
    """The page."""
    lines = []
    for f in score.figures:
        word = mark(f)
        lines.append(
            f"<tr><td>{html.escape(f.title)}</td><td>{amount(f.value, f.unit)}</td><td>{amount(f.low, f.unit)} … {amount(f.high, f.unit)}</td>"
            f'<td>{f.count}</td><td>{goal(f)}</td><td class="{word}">{word}</td><td>{decidable(f)}</td></tr>'
        )
    worst = "".join(
        f"<tr><td>{m['case']}</td><td>{m['stratum']}</td><td>{m['plant']}</td><td>{m['ratio']}</td><td>{html.escape(', '.join(m['truth']))}</td>"
        f"<td>{m['verdict']}</td><td>{html.escape(', '.join(m['effects']))}</td><td>{m['confidence']:.2f}</td></tr>"
        for m in score.misses[:400]
    )
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Blind trial of the diagnosis</title><style>{STYLE}</style></head><body>
<h1>Blind trial of the diagnosis</h1>
<pre>{html.escape(head)}</pre>
<h2>Figures to reach</h2>
<table><tr><th>figure</th><th>value</th><th>95 % interval</th><th>cases</th><th>goal</th><th></th><th>decidable</th></tr>{"".join(lines)}</table>
<p>Decidable: without the wrong verdicts whose model is nearer to the machine than the noise; to any record the two are the same.</p>
{intervals(score)}
<h2>What is taken for what</h2>{confusion(score)}
<h2>Stated confidence</h2>{reliability(score)}
<h2>Verdicts that are not right ({len(score.misses)})</h2>
<table><tr><th>case</th><th>stratum</th><th>plant</th><th>R</th><th>truth</th><th>verdict</th><th>effects</th><th>confidence</th></tr>{worst}</table>
</body></html>
"""
