"""The score as text."""

from __future__ import annotations

import math

from trials.scoring.figures import Figure, Score


def amount(value: float, unit: str) -> str:
    """A number in the unit of its figure."""
    if math.isnan(value):
        return "–"
    if unit == "%":
        return f"{100.0 * value:.1f} %"
    return f"{value:.1f} s" if unit == "s" else f"{value:.3f}"


def goal(figure: Figure) -> str:
    """The goal in words."""
    if figure.band:
        return f"{100 * figure.band[0]:.0f}–{100 * figure.band[1]:.0f} %"
    if figure.goal is None:
        return ""
    return ("≥ " if figure.at_least else "≤ ") + amount(figure.goal, figure.unit)


def mark(figure: Figure) -> str:
    """Reached, missed, or nothing to say."""
    return {True: "reached", False: "missed", None: ""}[figure.reached]


def decidable(figure: Figure) -> str:
    """The value among the cases that a record decides, where it differs."""
    same = math.isnan(figure.decidable) or figure.decidable == figure.value
    return "" if same else amount(figure.decidable, figure.unit)


def table(score: Score) -> str:
    """The figures in columns."""
    lines = [f"{'figure':52s}{'value':>9s}   {'95 % interval':17s}{'cases':>6s}   {'goal':10s} {'':9s}decidable", "-" * 116]
    for f in score.figures:
        if f.count == 0 and set(score.strata) == {"messy"}:
            continue  # the other strata's
        interval = f"{amount(f.low, f.unit)} … {amount(f.high, f.unit)}"
        lines.append(f"{f.title:52s}{amount(f.value, f.unit):>9s}   {interval:17s}{f.count:6d}   {goal(f):10s} {mark(f):7s}{decidable(f):>11s}".rstrip())
    left = sum(m["apart"] < 1.0 for m in score.misses)
    if any(not math.isnan(f.decidable) for f in score.figures):
        lines.append(f"decidable: without the {left} wrong verdicts whose model is nearer to the machine than the noise, the same to any record")
    return "\n".join(lines)


def effects(score: Score) -> str:
    """Named first, effect by effect."""
    cells = ("R10", "R3", "R1", "cousin")
    lines = [f"{'named first':24s}" + "".join(f"{c.replace('R10', 'R ≥ 10').replace('R3', 'R = 3').replace('R1', 'R = 1'):>10s}" for c in cells)]
    for name, line in score.by_effect.items():
        lines.append(f"{name:24s}" + "".join(f"{'{}/{}'.format(*line[c]) if c in line else '':>10s}" for c in cells))
    return "\n".join(lines)


def plants(score: Score) -> str:
    """Named first, effect by effect and plant by plant."""
    columns = sorted({plant for line in score.by_plant.values() for plant in line})
    lines = [f"{'named first, R ≥ 10':24s}" + "".join(f"{c:>16s}" for c in columns)]
    for name, line in score.by_plant.items():
        lines.append(f"{name:24s}" + "".join(f"{'{}/{}'.format(*line[c]) if c in line else '':>16s}" for c in columns).rstrip())
    return "\n".join(lines)


def confusions(score: Score, most: int = 25) -> str:
    """What is taken for what, most often first."""
    wrong = [(n, row, column) for row, line in score.confusion.items() for column, n in line.items() if row != column and row not in ("none", "outside")]
    wrong.sort(key=lambda item: (-item[0], item[1], item[2]))
    return "\n".join([f"{'taken':>6s}  {'true':24s}for"] + [f"{n:6d}  {row:24s}{column}" for n, row, column in wrong[:most]])


def misses(score: Score) -> str:
    """Every case with an effect that was not judged rightly, the nearest to the machine first: two models that differ
    by less than the noise are the same to a record."""
    known = sorted((m for m in score.misses if m["truth"]), key=lambda m: (math.isnan(m["apart"]), m["apart"]))
    lines = [f"{'from the machine':18s}{'R':>6s}  {'true':44s}named"]
    for m in known:
        true = " + ".join(m["realisations"])
        named = " + ".join(m["effects"]) or m["verdict"]
        apart = "–" if math.isnan(m["apart"]) else f"{m['apart']:.2f} of the noise"
        lines.append(f"{apart:>18s}{m['ratio']:6.1f}  {true + ', ' + m['plant']:44s}{named}")
    if known and all(math.isnan(m["apart"]) for m in known):
        return "\n".join([*lines, "How near their models are to the machine is worked out with --product"])
    near = sum(m["apart"] < 1.0 for m in known)
    very = sum(m["apart"] < 0.37 for m in known)
    return "\n".join([*lines, f"{near} of {len(known)} are nearer to the machine than the noise, {very} than 0.37 of it"])


def strata(score: Score) -> str:
    """Kinds of verdicts in each stratum."""
    return "\n".join(f"{name:14s}" + ", ".join(f"{kind} {n}" for kind, n in sorted(line.items())) for name, line in score.strata.items())


def messy(score: Score) -> str:
    """The messy machines, each with its dominant effect and what stands beside it."""
    lines = [f"{'messy machine':16s}{'dominant, its share of the gap':36s}{'gap':>6s}  {'named first, + more':28s}{'P':>5s}  {'family':8s}{'member':7s}beside"]
    for m in score.messy:
        first = (m["effects"][0] if m["effects"] else m["verdict"]) + ("+" if len(m["effects"]) > 1 else "")
        p = "" if math.isnan(m["probability"]) else f"{m['probability']:.2f}"
        dominant = f"{m['realisation']}, {100 * m['share']:.0f} %"
        worth = f"{m['family']:8s}{'right' if m['member'] else 'no':7s}"
        lines.append(f"{m['plant']:16s}{dominant[:35]:36s}{m['ratio']:6.0f}  {first[:27]:28s}{p:>5s}  {worth}{', '.join(m['beside'])}")
    return "\n".join(lines)


def whole(score: Score, head: str) -> str:
    """All tables that have something to say."""
    parts = [head, table(score)]
    if score.messy:
        parts += [messy(score), score.messy_reliability]
    if set(score.strata) != {"messy"}:
        parts += [effects(score), plants(score), confusions(score), misses(score)]
    return "\n\n".join([*parts, "verdicts by stratum\n" + strata(score)]) + "\n"
