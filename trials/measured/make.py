"""Makes the cases of the trial on measured records, and their key. The product is met as a program: it tunes and runs."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import subprocess
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from trials.generator import effects
from trials.generator.case import TIME_STAMP, after_refit, rms
from trials.generator.effects import Context
from trials.generator.plant import numbers
from trials.generator.search import find_size
from trials.generator.strata import seed_of
from trials.measured import commands
from trials.measured.bases import BASES, WITHHELD, Ablation, Base, Cut, Model, Withheld
from trials.progress import Progress

RATIOS = (10.0, 3.0)
Columns = dict[str, np.ndarray]


class Refused(RuntimeError):
    """The product could not tune or run a model."""


def table(columns: Columns) -> str:
    """A log in CSV."""
    rows = np.column_stack([columns["t"], *(x for name, x in columns.items() if name != "t")])
    head = ",".join(["t", *(name for name in columns if name != "t")])
    return "\n".join([head, *(f"{row[0]:.7f}," + ",".join(f"{x:.9e}" for x in row[1:]) for row in rows.tolist()), ""])


def parameter_file(values: dict[str, float], model: Model) -> str:
    """Values and what of them may be fitted, as the product reads it."""
    lines = []
    for title, table_of in (("parameters", {n: numbers(v) for n, v in values.items()}), ("fit", {n: "{" + o + "}" for n, o in model.fit.items()})):
        groups: dict[str, list[str]] = {}
        for name, text in table_of.items():
            instance, _, parameter = name.rpartition(".")
            groups.setdefault(instance, []).append(f"{parameter} = {text}")
        for instance in sorted(groups):
            lines += [f"[{title}.{instance}]" if instance else f"[{title}]", *groups[instance], ""]
    outputs = ", ".join(f'"{name}"' for name in (model.output, *model.more))
    return "\n".join([*lines, "[tune]", f"outputs = [{outputs}]", ""])


@dataclass
class Tuned:
    """A model on its record."""

    product: str
    model: Model
    columns: Columns
    values: dict[str, float] = field(default_factory=dict)

    def _call(self, command: str, files: dict[str, str], *options: str) -> str:
        """Runs the product in a scratch folder and returns what it wrote to `out`."""
        with tempfile.TemporaryDirectory(prefix="measured-") as name:
            for file, text in {"plant.st": self.model.text(), **files}.items():
                (Path(name) / file).write_text(text)
            line = [self.product, command, "plant.st", "--params", "params.toml", "--out", "out", *options]
            done = subprocess.run(line, cwd=name, capture_output=True, text=True, timeout=300, check=False)
            if done.returncode != 0:
                raise Refused(f"{self.model.diagram}, {command}: {done.stdout}{done.stderr}")
            return (Path(name) / "out").read_text()

    def tune(self) -> Tuned:
        """Finds the parameters on the record."""
        if self.model.fit:
            files = {"log.csv": table(self.columns), "params.toml": parameter_file({}, self.model)}
            found = tomllib.loads(self._call("tune", files, "--log", "log.csv"))["parameters"]
            for name in self.model.fit:
                instance, _, parameter = name.rpartition(".")
                self.values[name] = float((found[instance] if instance else found)[parameter])
        return self

    def run(self, values: dict[str, float], columns: Columns) -> np.ndarray:
        """The model's output."""
        files = {"log.csv": table(columns), "params.toml": parameter_file(values, self.model)}
        rows = list(csv.reader(self._call("run", files, "--in", "log.csv").splitlines()))
        at = [name.upper() for name in rows[0]].index(self.model.output)
        return np.array([float(row[at]) for row in rows[1:]])

    @property
    def measured(self) -> np.ndarray:
        """The output as recorded."""
        return self.columns[self.model.output]

    def residual(self) -> np.ndarray:
        """What the tuned model leaves."""
        return self.measured - self.run(self.values, self.columns)

    def scales(self) -> dict[str, float]:
        """What a relative deviation of each parameter refers to."""
        levels = {name: float(np.ptp(self.columns[column])) for name, column in self.model.levels.items()}
        return {name: levels.get(name, abs(value)) for name, value in self.values.items()}

    def sensitivities(self) -> np.ndarray:
        """Change of the output per relative change of each parameter."""
        base = self.run(self.values, self.columns)
        moved = [self.run(self.values | {n: self.values[n] + 1e-4 * s}, self.columns) for n, s in self.scales().items()]
        return np.array([(y - base) / 1e-4 for y in moved])[:, None, :]


def with_others(columns: Columns, rng: np.random.Generator, wanted: bool) -> Columns:
    """The log, with a column V of another axis where one is needed: it has nothing to do with the machine."""
    if not wanted:
        return columns
    nodes = rng.uniform(-0.5, 0.5, 24)
    return columns | {"V": np.repeat(nodes, -(-len(columns["t"]) // len(nodes)))[: len(columns["t"])]}


def injected(tuned: Tuned, effect: str, at_command: bool, ratio: float, rng: np.random.Generator) -> tuple[Columns, dict]:
    """The record with the effect in it, and its label."""
    model, measured = tuned.model, tuned.measured
    columns = with_others(tuned.columns, rng, effect == "cross_coupling")
    signal = columns[model.command] if at_command else measured
    ts = float(columns["t"][1])
    noise = np.array([float(rms(tuned.residual()))])
    sensitivity = tuned.sensitivities()
    base = tuned.run(tuned.values, columns)
    seed = int(rng.integers(2**31))
    if at_command:
        apply, start, largest = commands.CATALOGUE[effect]
    else:
        plain = effects.CATALOGUE[effect][0]
        apply, start, largest = plain.apply, plain.start, plain.largest

    def altered(size: float) -> Columns:
        context = Context(ts, 1, float(np.ptp(signal)), columns.get("V"))
        name = model.command if at_command else model.output
        return columns | {name: apply(signal, context, size, np.random.default_rng(seed))}

    def change(size: float) -> np.ndarray:
        new = altered(size)
        return (base - tuned.run(tuned.values, new)) if at_command else new[model.output] - measured

    def reached(size: float) -> float:
        return float(rms(after_refit(change(size)[:, None], sensitivity, 1.0 / noise))[0] / noise[0])

    size, got = find_size(reached, ratio, start, 1e-9, largest)
    left = after_refit(change(size)[:, None], sensitivity, 1.0 / noise)
    label = {"ratio": got, "ratio_wanted": ratio, "noise_rms": noise.tolist(), "effect_rms": rms(left).tolist(), "size": size}
    return altered(size), label


@dataclass(frozen=True)
class Job:
    """One case to make."""

    kind: str
    record: str
    cut: Cut
    model: Model
    what: str
    truth: tuple[str, ...]
    effect: str = ""
    at_command: bool = False
    ratio: float = 0.0
    full: Model | None = None
    excluded: tuple[str, ...] = ()
    same: tuple[str, ...] = ()


def jobs() -> Iterator[Job]:
    """All cases."""
    for base in BASES:
        yield from _injections(base)
        for one in base.ablations:
            yield _ablation(base, one)
    for one in WITHHELD:
        yield _withheld(one)


def _injections(base: Base) -> Iterator[Job]:
    sites = [(effect, False) for effect in base.at_output] + [(effect, True) for effect in base.at_command]
    for number, (effect, at_command) in enumerate(sites):
        where = base.model.command if at_command else base.model.output
        yield Job("injected", base.name, base.cut, base.model, f"{effect} at {where}", (effect,), effect, at_command, RATIOS[number % 2])


def _ablation(base: Base, one: Ablation) -> Job:
    return Job("ablated", base.name, base.cut, one.model, f"{one.block} taken out", (one.truth,), full=base.model, same=one.same)


def _withheld(one: Withheld) -> Job:
    return Job("withheld", one.name, one.cut, one.model, " or ".join(one.published), one.published, excluded=one.excluded)


def make_one(job: Job, seed: str, data: Path, product: str) -> tuple[dict[str, str], dict]:
    """The files of a case, and its label."""
    rng = np.random.default_rng(seed_of(f"{seed} {job.record} {job.kind} {job.what}"))
    columns = job.cut.read(data)
    tuned = Tuned(product, job.model, columns).tune()
    values, log = dict(tuned.values), columns
    label: dict = {}
    if job.kind == "injected":
        log, label = injected(tuned, job.effect, job.at_command, job.ratio, rng)
        off = rng.uniform(0.005, 0.02, len(values)) * rng.choice((-1.0, 1.0), len(values))
        values = {name: value + d * tuned.scales()[name] for (name, value), d in zip(values.items(), off.tolist())}
    elif job.full is not None:
        whole = float(rms(Tuned(product, job.full, columns).tune().residual()))
        left = float(rms(tuned.residual()))
        effect = max(left**2 - whole**2, 0.0) ** 0.5
        label = {"ratio": effect / whole, "noise_rms": [whole], "effect_rms": [effect]}
    else:
        left = float(rms(tuned.residual()))
        label = {"ratio": 0.0, "noise_rms": [0.0], "effect_rms": [left]}
    files = {"plant.st": tuned.model.text(), "params.toml": parameter_file(values, job.model), "log.csv": table(log)}
    found = {
        "stratum": job.kind, "plant": job.record, "what": job.what, "excluded": list(job.excluded), "deviation_ratio": 0.0,
        "effects": [{"id": effect, "edges": [], "realisation": effect} for effect in job.truth], "same": list(job.same),
    }  # fmt: skip
    return files, found | label


def make_set(seed: str, data: Path, product: str, cases: Path, key: Path, only: str = "") -> int:
    """Makes all cases whose record or kind contains `only`, and writes the key. Returns their number."""
    chosen = [job for job in jobs() if only in f"{job.kind} {job.record} {job.what}"]
    cases.mkdir(parents=True, exist_ok=True)
    progress, labels = Progress("make", len(chosen)), {}
    for job in chosen:
        files, label = make_one(job, seed, data, product)
        name = hashlib.sha256(f"{seed} {job}".encode()).hexdigest()[:12]
        folder = cases / name
        folder.mkdir(exist_ok=True)
        for file, text in files.items():
            (folder / file).write_text(text)
            os.utime(folder / file, (TIME_STAMP, TIME_STAMP))
        labels[name] = label
        progress.step()
    key.touch(mode=0o600)
    key.write_text(json.dumps({"schema": "hysteron-trial-measured/1", "seed": seed, "cases": labels}, indent=1))
    return len(chosen)
