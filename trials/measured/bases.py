"""The measured records, how each is cut, and the models that are tuned to it. The records stay outside of the project."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
OWN = "trials/measured/diagrams"
STACK = "examples/04_piezo_stack"
HEATERS = "examples/07_heater_diagnosis"


def data_folder() -> Path | None:
    """Where the measured records are: HYSTERON_DATA, else ../shared/data."""
    named = os.environ.get("HYSTERON_DATA")
    folder = Path(named) if named else (ROOT / "../shared/data").resolve()
    if folder.is_dir():
        return folder
    if named:
        raise SystemExit(f"HYSTERON_DATA names {named}, which is no folder; correct it, or remove it")
    return None


@dataclass(frozen=True)
class Cut:
    """A piece of a record: rows first to last, every stride-th."""

    file: str
    first: int
    last: int
    stride: int = 1

    def read(self, folder: Path) -> dict[str, np.ndarray]:
        """The columns, with time from 0."""
        with (folder / self.file).open() as file:
            head = next(csv.reader(file))
            values = np.loadtxt(file, delimiter=",")[self.first : self.last : self.stride]
        columns = {name.upper() if name != "t" else name: values[:, i] for i, name in enumerate(head)}
        columns["t"] = columns["t"] - columns["t"][0]
        return columns


@dataclass(frozen=True)
class Model:
    """A diagram and what of it is tuned."""

    diagram: str
    output: str
    command: str
    fit: dict[str, str]
    """Options of the fit, by INSTANCE.PARAMETER, or PARAMETER for one of the diagram's own."""
    levels: dict[str, str] = field(default_factory=dict)
    """Parameters that are positions, each with the column whose range tells how far one may be off."""
    rewrite: tuple[tuple[str, str], ...] = ()
    """Replacements in the diagram's text that take a block out."""

    more: tuple[str, ...] = ()
    """Further outputs that are measured."""

    def text(self) -> str:
        """The diagram."""
        text = (ROOT / self.diagram).read_text()
        for old, new in self.rewrite:
            if text.count(old) != 1:
                raise ValueError(f"{self.diagram} has {old!r} {text.count(old)} times")
            text = text.replace(old, new)
        return text

    def without(self, parameters: tuple[str, ...], *rewrite: tuple[str, str]) -> Model:
        """The same model, a block taken out."""
        left = {name: options for name, options in self.fit.items() if name not in parameters}
        return Model(self.diagram, self.output, self.command, left, self.levels, rewrite)


@dataclass(frozen=True)
class Ablation:
    """A block that is taken out of a model of a measured record."""

    block: str
    model: Model
    truth: str
    same: tuple[str, ...] = ()
    """Other names for the same change of this record."""


@dataclass(frozen=True)
class Withheld:
    """A record with the cause that its authors published."""

    name: str
    cut: Cut
    model: Model
    published: tuple[str, ...]
    """Effects that the authors name."""
    excluded: tuple[str, ...] = ()
    """Effects that the machine has not."""


@dataclass(frozen=True)
class Base:
    """A record with the best model of it that the project has, and what is done to either."""

    name: str
    cut: Cut
    model: Model
    at_output: tuple[str, ...]
    at_command: tuple[str, ...]
    ablations: tuple[Ablation, ...] = field(default=())


LOOP = {"HYST.C1": "", "HYST.C2": "", "HYST.C3": "max = 4.0", "HYST.Y0": "scale = 1.0"}
LATE = {"LATE.DEAD_TIME": "max = 0.05"}
BEND = {"BEND": "scale = 0.01"}
BENT = Model(f"{STACK}/bent_plant.st", "Y", "U", BEND | LOOP | LATE, {"HYST.Y0": "Y"})
PAPERS = BENT.without(("BEND", "LATE.DEAD_TIME"), (" + BEND * FROM_MIDDLE * FROM_MIDDLE", ""))
HEATER = {"REST": "", "HEAT.K": "", "PLATE.T1": "", "SENSOR.T1": ""}
COUPLED = Model(f"{OWN}/coupled.st", "Y1", "U1", HEATER | {"SHARE.K": "", "BOARD.T1": ""}, {"REST": "Y1"})
SPRING = {"DRIVE.K": "", "DAMPER.K": "", "SPRING.K": ""}
DUFFING = Model(f"{OWN}/duffing.st", "Y", "U", {"ZERO": "scale = 0.01", "CUBE": ""} | SPRING, {"ZERO": "U"})

SINES = Cut("piezo-picma-dbo/identify_1hz.csv", 350, 2350)
LOOPS = Cut("piezo-picma-dbo/feedforward_test.csv", 0, 4000)
BOARD = Cut("tclab-thermal/prbs_open_loop.csv", 400, 7140, 5)
MULTISINE = Cut("silverbox/snls80mv.csv", 49238, 51238)

HYSTERETIC = ("backlash", "coulomb_friction", "stribeck_friction", "creep")

BASES = (
    Base(
        "piezo stack, 10 cycles", SINES, BENT,
        ("drift", "thermal_drift", "gain_drift", "saturation", "quantization", "periodic_disturbance", "glitches", "creep", "cross_coupling"),
        ("load", "odd_nonlinearity", "backlash"),
        (
            Ablation("bend", BENT.without(("BEND",), (" + BEND * FROM_MIDDLE * FROM_MIDDLE", "")), "even_nonlinearity"),
            Ablation("dead time", BENT.without(("LATE.DEAD_TIME",), ("  LATE(XIN := HYST.XOUT);\n", ""), ("Y := LATE.XOUT", "Y := HYST.XOUT"),
                                               ("    LATE        : HY_DEAD_TIME;\n", "")), "delay", ("lag",)),
        ),
    ),
    Base(
        "heater, coupled", BOARD, COUPLED,
        ("drift", "lag", "delay", "saturation", "quantization", "periodic_disturbance", "glitches", "thermal_drift"),
        ("load", "gain_drift", "cross_coupling", "backlash"),
        (
            Ablation("coupling", COUPLED.without(("SHARE.K", "BOARD.T1"), (" + BOARD.XOUT", "")), "cross_coupling"),
            Ablation("sensor's lag", COUPLED.without(("SENSOR.T1",), ("  SENSOR(XIN := PLATE.XOUT);\n", ""), ("SENSOR.XOUT", "PLATE.XOUT"),
                                                     ("    SENSOR : HY_LAG  := (T1 := 20.0);\n", "")), "lag", ("delay",)),
        ),
    ),
    Base(
        "silverbox, with its cube", MULTISINE, DUFFING,
        ("lag", "saturation", "quantization", "periodic_disturbance", "glitches", "drift", "clock", "even_nonlinearity"),
        ("delay", "dead_zone", "gain_drift", "load", "cross_coupling", "backlash"),
        (
            Ablation("input's offset", DUFFING.without(("ZERO",), ("U + ZERO", "U")), "offset", ("load",)),
        ),
    ),
)  # fmt: skip

PLATES = {f"{block}{n}.{name}": "" for n in (1, 2) for block, name in (("HEAT", "K"), ("PLATE", "T1"), ("SENSOR", "T1"))}
WITHHELD = (
    Withheld("piezo stack, 10 cycles, the paper's model", SINES, PAPERS, ("lag", "delay", "creep", "asymmetry"), ("coulomb_friction", "stribeck_friction")),
    Withheld("piezo stack, minor loops and rests", LOOPS, BENT, ("return_point_memory", "lag", "delay", "creep", "asymmetry"),
             ("coulomb_friction", "stribeck_friction")),
    Withheld("two heaters, one diagram", BOARD, Model(f"{HEATERS}/heaters.st", "Y1", "U1", {"REST1": "", "REST2": ""} | PLATES, more=("Y2",)),
             ("cross_coupling", "drift", "thermal_drift", "load"), HYSTERETIC),
    Withheld("heater 1 alone", BOARD, Model(f"{HEATERS}/heater1.st", "Y1", "U1", HEATER), ("cross_coupling", "drift", "thermal_drift", "load"), HYSTERETIC),
    Withheld("heater 2 alone", BOARD, Model(f"{HEATERS}/heater2.st", "Y2", "U2", HEATER), ("cross_coupling", "drift", "thermal_drift", "load"), HYSTERETIC),
    Withheld("silverbox, a linear oscillator", MULTISINE, DUFFING.without(("CUBE",), (" + CUBE * P * P * P", "")), ("odd_nonlinearity",), HYSTERETIC),
    Withheld("cascaded tanks", Cut("cascaded-tanks/tanks_est.csv", 0, 1024),
             Model(f"{OWN}/tanks.st", "Y", "U", {"FIRST1": "", "FIRST2": "", "PUMP.K": "", "HOLE1.K": "", "HOLE2.K": ""}), ("saturation",), HYSTERETIC),
    Withheld("fine steering mirror, gains at rest", Cut("piezo-fsm-cubespec/train_100mV_r1.csv", 0, 2048),
             Model(f"{OWN}/mirror.st", "Y1", "U1", {}), ("resonance",), ("backlash", "coulomb_friction")),
)  # fmt: skip
