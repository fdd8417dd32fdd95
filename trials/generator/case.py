"""One case: a plant is drawn, an effect is injected and brought to its effect-to-noise ratio, records are written."""

from __future__ import annotations

import copy
import os
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from trials.generator import excitation, messy, noise
from trials.generator.grid import Grid
from trials.generator.piezo import Piezo
from trials.generator.plant import Injection, Plant, numbers
from trials.generator.search import find_size
from trials.generator.servo import ClosedLoop, Servo
from trials.generator.tanks import Tanks
from trials.generator.thermal import Thermal
from trials.generator.unreachable import Unreachable

PLANTS = ("piezo", "servo_position", "servo_speed", "servo_free", "closed_loop", "thermal", "tanks")
TIME_STAMP = 1_600_000_000
"""Every file of every case bears this time."""


@dataclass(frozen=True)
class Specification:
    """What a case is to be."""

    stratum: str
    plant: str
    effects: tuple[tuple[str, str], ...]
    """Pairs of effect and realisation; the realisation may be "" for the first plain one."""
    ratio: float
    """Effect-to-noise ratio R; of the deviations of the parameters in the stratum calibration."""
    seed: int
    plan: str = "rich"
    """Name of the excitation: rich, or one of the poor ones."""
    edge: str = ""
    """Edge, where the stratum prescribes one."""
    answers: tuple[str, ...] = ()
    """Verdicts that count as right for a designed ambiguous case."""
    substeps: int = 20
    noise: str = ""
    """Kind of noise, where it is prescribed."""
    length: float = 1.0
    """Share of the plant's usual number of samples."""
    share: float = 0.0
    """Of the gap's energy that the first effect has, in the stratum messy."""


@dataclass
class Case:
    """A finished case: what the diagnosis may see, and what only the key holds."""

    files: dict[str, str]
    label: dict[str, object]
    plant: Plant
    injections: list[Injection]
    clean: np.ndarray
    log: dict[str, np.ndarray] = field(default_factory=dict)


PLANS: dict[str, list[tuple[excitation.Section, float]]] = {
    "rich": excitation.RICH,
    "one_sine": [(excitation.one_sine, 1.0)],
    "one_step": [(excitation.one_step, 1.0)],
}


def grid_of(plant: str, rng: np.random.Generator, substeps: int, length: float) -> Grid:
    """Sample time and length that suit the plant."""
    ts, samples = {
        "piezo": (float(rng.choice((0.001, 0.002))), 6000),
        "thermal": (float(rng.choice((0.5, 1.0))), 5000),
        "tanks": (float(rng.choice((0.5, 1.0))), 5000),
        "closed_loop": (0.001, 3500),
    }.get(plant, (0.001, 4500))
    return Grid(ts, round(length * samples), substeps)


def make_plant(name: str, grid: Grid, rng: np.random.Generator, drive: np.ndarray, other: np.ndarray | None) -> Plant:
    """A plant of the given kind with random parameters."""
    if name == "piezo":
        return Piezo(grid, rng, drive, other)
    if name == "thermal":
        return Thermal(grid, rng, drive, other)
    if name == "tanks":
        return Tanks(grid, rng, drive, other)
    if name == "closed_loop":
        return ClosedLoop(grid, rng, drive, other)
    kind = {"servo_position": ("position", True), "servo_speed": ("speed", True), "servo_free": ("speed", False)}[name]
    return Servo(grid, rng, drive, other, *kind)


def other_axis(rng: np.random.Generator, grid: Grid) -> np.ndarray:
    """A second column of span 1 that has nothing to do with the first."""
    x = excitation.join(rng, grid, [(excitation.steps, 0.5), (excitation.multisine, 0.5)])
    return x / np.ptp(x)


def scales(plant: Plant) -> dict[str, float]:
    """What a relative deviation of each tuned parameter refers to."""
    reach = getattr(plant, "reach", 1.0)
    tuned = plant.tuned()
    return {name: tuned["HYST.C1"] * reach if name == "HYST.Y0" else abs(value) for name, value in tuned.items()}


def sensitivities(plant: Plant) -> np.ndarray:
    """Change of the stacked outputs per relative change of each tuned parameter, by differences on the samples alone."""
    coarse = Grid(plant.grid.ts, plant.grid.samples, 1)
    base = plant.simulate(plant.truth, [], coarse)
    columns = []
    for name, scale in scales(plant).items():
        moved = dict(plant.truth)
        moved[name] += 1e-4 * scale
        columns.append(((plant.simulate(moved, [], coarse) - base) / 1e-4).T)
    return np.array(columns)  # parameter, output, sample


def after_refit(change: np.ndarray, sensitivity: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """What the best refit of the known parameters leaves of a change of the outputs (linear projection)."""
    a = (sensitivity * weights[None, :, None]).reshape(len(sensitivity), -1).T
    b = (change.T * weights[:, None]).ravel()
    left = b - a @ np.linalg.lstsq(a, b, rcond=None)[0]
    return left.reshape(change.shape[1], -1).T / weights


def rms(x: np.ndarray) -> np.ndarray:
    """Root mean square of each column."""
    return np.sqrt(np.mean(x**2, axis=0))


class Builder:
    """Builds one case from its specification."""

    def __init__(self, specification: Specification) -> None:
        self.specification = specification
        self.rng = np.random.default_rng(specification.seed)
        rng = self.rng
        self.grid = grid_of(specification.plant, rng, specification.substeps, specification.length)
        self.plan = PLANS[specification.plan]
        drive = excitation.join(rng, self.grid, self.plan)
        needs_other = any(effect == "cross_coupling" for effect, _ in specification.effects)
        other = other_axis(rng, self.grid)
        has_other = needs_other or rng.random() < 0.5
        self.plant = make_plant(specification.plant, self.grid, rng, drive, other if has_other else None)
        self._drive_until_shown(self.plant, rng)
        plant = self.plant
        for effect, _ in specification.effects:
            if effect == "offset" and isinstance(plant, Piezo) and not plant.zeroed:
                del plant.truth["HYST.Y0"]  # the sensor counts as zeroed, so that its offset is an effect
                plant.zeroed = True
                plant.sites["offset"] = (plant.chain[-1],)
        self.base = plant.simulate(plant.truth, [])
        self.sensitivity = sensitivities(plant)
        self.noises = [noise.draw(rng, self.grid.samples, specification.noise or None) for _ in plant.outputs]
        self.sigma = float(np.ptp(self.base[:, 0]) * 10.0 ** rng.uniform(-3.4, -2.5))
        self.share = 0.0
        self.current_gain = 0.0
        if isinstance(plant, ClosedLoop):
            self.current_gain = self._noise_gain(plant)

    def _drive_until_shown(self, plant: Plant, rng: np.random.Generator) -> None:
        """Draws the excitation again while a reversal hides between two samples."""
        for _ in range(50):
            if plant.shows_its_turns():
                return
            plant.drive(excitation.join(rng, self.grid, self.plan))
        raise Unreachable(f"every excitation of plan {self.specification.plan} hides a reversal between two samples")

    def _noise_gain(self, plant: ClosedLoop) -> float:
        """RMS of the current per RMS of the position sensor's noise, through the controller."""
        coarse = Grid(self.grid.ts, self.grid.samples, 1)
        unit = self.noises[0].unit
        still = plant.simulate(plant.truth, [], coarse)
        shaken = plant.simulate(plant.truth, [], coarse, measure=lambda k, y: y + 1e-6 * float(unit[k]))
        return float(rms(shaken - still)[1]) / 1e-6

    def noise_levels(self, sigma: float) -> np.ndarray:
        """Noise of each output for a noise `sigma` of the first one's sensor."""
        return np.array([sigma, 1.05 * self.current_gain * sigma])[: len(self.plant.outputs)]

    def change(self, injections: list[Injection]) -> np.ndarray:
        """What the injections change in the outputs, against the same plant without them."""
        plant = self.plant
        if any(one.effect == "branch_chatter" for one in injections):
            rest = [one for one in injections if one.effect != "branch_chatter"]
            disturbed = plant.simulate(plant.truth, rest) if rest else self.base
            return disturbed - self.base - (plant.chattering_model(plant.truth, injections) - self.base)
        return plant.simulate(plant.truth, injections) - self.base

    def in_noises(self, change: np.ndarray, sigma: float) -> np.ndarray:
        """What a refit leaves of a change, each output in units of its noise."""
        levels = self.noise_levels(sigma)
        return after_refit(change, self.sensitivity, 1.0 / levels) / levels

    def ratio(self, change: np.ndarray, sigma: float) -> float:
        """Effect-to-noise ratio: the largest over the outputs, after refit."""
        return float(np.max(rms(self.in_noises(change, sigma))))

    def size(self, one: Injection, wanted: float) -> float:
        """Searches the size that gives the wanted ratio at the present noise; returns the ratio reached."""

        def reached_by(size: float) -> float:
            one.size = size
            return self.ratio(self.change([one]), self.sigma)

        one.size, reached = find_size(reached_by, wanted, one.size, one.realisation.smallest, one.realisation.largest)
        return reached

    def sites(self, effect: str) -> tuple[str, ...]:
        """Where an effect may act on this plant."""
        if effect.startswith(("outside:", "beyond:")):
            return self.plant.outside_sites or ("U",)
        return self.plant.sites[effect]

    def inject(self) -> list[Injection]:
        """Draws the injections and scales size, then noise, to the wanted ratio."""
        injections = []
        reached = []
        messy_one = self.specification.stratum == "messy"
        for effect, name in self.specification.effects:
            choices = self.plant.realisations(effect)
            named = [one for one in choices if one.name == name] or [one for one in choices if not one.cousin] or list(choices)
            edge = self.specification.edge
            if not edge:
                edge = str(self.rng.choice(self.sites(effect)))
            one = Injection(effect, edge, named[0], named[0].start, int(self.rng.integers(2**31)))
            if effect != "sensor_gain" and not messy_one:  # a refit takes it over whole, so that it has no ratio
                reached.append(self.size(one, self.specification.ratio))
            injections.append(one)
        if messy_one:
            self.share = messy.mix(self, injections)
        if reached:
            least, most = 1e-5 * np.ptp(self.base[:, 0]), 3e-2 * np.ptp(self.base[:, 0])
            self.sigma = float(np.clip(self.sigma * min(reached) / self.specification.ratio, least, most))
        return injections

    def deviations(self) -> dict[str, float]:
        """How far, relatively, each tuned parameter is off."""
        names = list(scales(self.plant))
        stratum = self.specification.stratum
        levels = self.noise_levels(self.sigma)
        a = (self.sensitivity / levels[None, :, None]).reshape(len(names), -1)
        if stratum == "none":
            # As a tuning leaves them: by the covariance of the fit to a record like this one.
            root = np.linalg.cholesky(np.linalg.inv(a @ a.T + 1e-9 * np.diag(np.diag(a @ a.T))))
            off = root @ self.rng.standard_normal(len(names))
        else:
            off = self.rng.uniform(0.005, 0.02, len(names)) * self.rng.choice((-1.0, 1.0), len(names))
            if stratum == "calibration":
                off *= self.specification.ratio / np.sqrt(np.mean((off @ a) ** 2) * len(self.plant.outputs))
                off = np.clip(off, -0.2, 0.2)
        return dict(zip(names, off.tolist()))

    def record(self, plant: Plant, injections: list[Injection]) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """The columns of a log, and the outputs without noise."""
        columns = plant.columns(injections)
        clean = plant.simulate(plant.truth, injections)
        if isinstance(plant, ClosedLoop):
            sensor, current = self.noises
            lsb = sensor.step * self.sigma
            rest = self.sigma * np.sqrt(max(1.0 - sensor.step**2 / 12.0, 0.05)) if lsb else self.sigma

            def measure(k: int, y: float) -> float:
                value = y + rest * float(sensor.unit[k])
                return lsb * round(value / lsb) if lsb else value

            measured = plant.simulate(plant.truth, injections, measure=measure)
            measured[:, 1] += 0.3 * self.current_gain * self.sigma * current.unit
            outputs = measured
        else:
            outputs = np.column_stack([self.noises[0].read(clean[:, 0], self.sigma)])
        return columns | dict(zip(plant.outputs, outputs.T)), clean

    def second(self, number: int = 1) -> Plant:
        """The same machine with another excitation: 1 is that of log2.csv, 2 is kept for the scorer."""
        plant = copy.deepcopy(self.plant)
        rng = np.random.default_rng(self.specification.seed + number)
        plant.drive(excitation.join(rng, self.grid, self.plan))
        self._drive_until_shown(plant, rng)
        if plant.other is not None:
            plant.other = other_axis(rng, self.grid)
        return plant

    def build(self) -> Case:
        """Everything."""
        plant, specification = self.plant, self.specification
        injections = self.inject()
        change = self.change(injections) if injections else np.zeros_like(self.base)
        scale = scales(plant)
        off = messy.tune(self, self.base + change, scale) if specification.stratum == "messy" else self.deviations()
        start = {name: value + off[name] * scale[name] for name, value in plant.tuned().items()}
        log, clean = self.record(plant, injections)
        files = {"plant.st": plant.diagram(), "params.toml": parameter_file(start, plant), "log.csv": table(self.grid, log)}
        if self.rng.random() < 0.2:
            self.noises = [noise.draw(self.rng, self.grid.samples, one.kind) for one in self.noises]
            files["log2.csv"] = table(self.grid, self.record(self.second(), injections)[0])
        levels = self.noise_levels(self.sigma)
        label: dict[str, object] = {
            "stratum": specification.stratum,
            "plant": specification.plant,
            "excitation": specification.plan,
            "specification": asdict(specification),
            "noise_kind": self.noises[0].kind,
            "noise_rms": [float(x) for x in levels],
            "ratio": self.ratio(change, self.sigma) if injections else 0.0,
            "ratio_wanted": specification.ratio,
            "deviation_ratio": self.deviation_ratio(off, levels),
            "deviations": off,
            "answers": list(specification.answers),
            "effects": [self.described(one, len(injections) > 1) for one in injections],
            "effect_rms": [float(x) for x in rms(after_refit(change, self.sensitivity, 1.0 / levels))],
        }
        if specification.stratum == "messy":
            label.update(messy.label(label, self.share))
        return Case(files, label, plant, injections, clean, log)

    def described(self, one: Injection, among_others: bool) -> dict[str, object]:
        """An injection in a label; among others with its own ratio."""
        return {
            "id": one.effect,
            "edge": one.edge,
            "edges": self.plant.admissible_edges(one.effect, one.edge),
            "same_as": {name: list(edges) for name, edges in self.plant.same_as(one.effect, one.edge).items()},
            "realisation": one.realisation.name,
            "cousin": one.realisation.cousin,
            "size": one.size,
            "parameters": one.notes,
            "ratio": self.ratio(self.change([one]), self.sigma) if among_others else None,
        }

    def deviation_ratio(self, off: dict[str, float], levels: np.ndarray) -> float:
        """RMS over noise of what the parameters' deviations change, to first order."""
        moved = np.tensordot(np.array(list(off.values())), self.sensitivity, axes=1)
        return float(np.max(np.sqrt(np.mean(moved**2, axis=1)) / levels))


def parameter_file(values: dict[str, float], plant: Plant) -> str:
    """The tuned parameters, and that they may be fitted."""
    instances: dict[str, list[str]] = {}
    for name in values:
        instances.setdefault(name.split(".")[0], []).append(name)
    lines = []
    for instance, names in instances.items():
        lines += [f"[parameters.{instance}]"] + [f"{name.split('.')[1]} = {numbers(float(f'{values[name]:.7g}'))}" for name in names] + [""]
    for instance, names in instances.items():
        lines += [f"[fit.{instance}]"] + [f"{name.split('.')[1]} = {{}}" for name in names] + [""]
    outputs = ", ".join(f'"{name}"' for name in plant.outputs)
    return "\n".join(lines + ["[tune]", f"outputs = [{outputs}]", ""])


def table(grid: Grid, columns: dict[str, np.ndarray]) -> str:
    """A log in CSV, all numbers of one width but for the sign."""
    places = max(0, -int(np.floor(np.log10(grid.ts) + 1e-9))) + 1
    head = ",".join(["t", *columns])
    rows = np.column_stack(list(columns.values()))
    lines = [f"{k * grid.ts:.{places}f}," + ",".join(f"{x:.9e}" for x in row) for k, row in enumerate(rows.tolist())]
    return "\n".join([head, *lines, ""])


def build(specification: Specification) -> Case:
    """A case from its specification."""
    return Builder(specification).build()


def from_label(label: dict) -> Builder:
    """The builder of a case that stands in a key, so that the same machine can be asked again."""
    stored = dict(label["specification"])
    stored["effects"] = tuple((effect, name) for effect, name in stored["effects"])
    stored["answers"] = tuple(stored["answers"])
    return Builder(Specification(**stored))


def write(case: Case, folder: Path) -> None:
    """Writes what the diagnosis may see."""
    folder.mkdir(parents=True)
    for name, text in case.files.items():
        (folder / name).write_text(text)
        os.utime(folder / name, (TIME_STAMP, TIME_STAMP))
    os.utime(folder, (TIME_STAMP, TIME_STAMP))
