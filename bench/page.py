#!/usr/bin/python3
"""Writes docs/benchmarks.md and the tables of bench/README.md from the raw rows in docs/benchmarks/.

usage: bench/page.py [--check]

--check writes nothing; exit code 1 where a page is not what the rows say."""

import sys

import batch
import compile as compiling
import fit
import measure
import step

QUESTIONS = (step, batch, fit, compiling)
PAGE = measure.ROOT / "docs" / "benchmarks.md"
README = measure.HERE / "README.md"
BEGIN, END = "<!-- tables: bench/page.py -->", "<!-- end of tables -->"

HEAD = """# Benchmarks

One program a question, printed by `./scripts/bench --write` from the [raw rows](benchmarks/machine.csv). How to read them:
[bench/README.md](../bench/README.md). A ratio is of two things measured in the same run on the same machine; a time says
little elsewhere.

"""


def sections(question, rows):
    yield f"## {question.TITLE}"
    yield question.__doc__.split("\n\n", 1)[1].strip()
    for heading, table in question.tables(rows):
        yield f"### {heading}"
        yield table
    yield "### Goals and losses"
    yield measure.goal_table(question.goals(rows))
    yield lost(question, rows)
    yield f"Raw rows: [{question.NAME}.csv](benchmarks/{question.NAME}.csv). The command: `bench/{question.NAME}.py --write`."
    yield "### What each was given"
    yield measure.contender_table(question.CONTENDERS, rows)


def lost(question, rows):
    losses = [*question.losses(rows), *measure.missed(question.goals(rows))]
    return "\n".join(["Where we lose:", "", *(f"- {one}" for one in losses)]) if losses else "We lose nowhere here."


def machine_line(one):
    return (f"{one['processor']}, {one['processors']} processors; {one['system']}; {one['compiler']}; load {one['load']}; "
            f"{one['date']}")


def machines():
    lines = measure.read_machines(measure.RESULTS)
    return measure.text_table(("question", "measured on"), [(one["question"], machine_line(one)) for one in lines.values()])


def page(rows_of):
    parts = [HEAD.strip(), machines()]
    for question in QUESTIONS:
        parts += sections(question, rows_of[question.NAME])
    return "\n\n".join(parts) + "\n"


def readme(rows_of):
    text = README.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    parts = []
    for question in QUESTIONS:
        rows = rows_of[question.NAME]
        parts.append(f"### {question.TITLE}")
        for heading, table in question.tables(rows):
            parts += [f"{heading}:", table]
        parts += [measure.goal_table(question.goals(rows)), lost(question, rows)]
    return before + BEGIN + "\n\n" + "\n\n".join(parts) + "\n\n" + END + after


def main():
    rows_of = {question.NAME: measure.read_rows(question.NAME, measure.RESULTS) for question in QUESTIONS}
    different = False
    for path, text in ((PAGE, page(rows_of)), (README, readme(rows_of))):
        if "--check" not in sys.argv[1:]:
            path.write_text(text, encoding="utf-8")
        elif path.read_text(encoding="utf-8") != text:
            print(f"{path.relative_to(measure.ROOT)} is not what docs/benchmarks/*.csv say: run bench/page.py", file=sys.stderr)
            different = True
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
