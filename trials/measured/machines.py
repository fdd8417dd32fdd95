"""Real machines with the causes that were published of them: which diagram, which logs, and what the record can tell.

The records stay outside of the project, in HYSTERON_DATA (default ../shared/data): the folder `machines`, each with a README
that names source and cause, and the older records that the other tables use too. A cause is a family and the members that
are right in it (trials/families.py); `beside` is what else was published of the machine, and makes up little of
the gap; twins are effects of other families that write the same signal in that record.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from trials.measured.bases import WITHHELD
from trials.measured.sources import Folder, Log, Own, Source
from trials.scoring.causes import Cause


@dataclass(frozen=True)
class Case:
    """One combination of diagram and logs."""

    name: str
    machine: str
    """Cases of one machine hang together; the summary has a line for that."""
    source: Source
    causes: tuple[Cause, ...]
    tells_member: bool
    why: str
    """Why the record tells the member, or only the family."""


OFFSET = Cause.of("offset", "offset", twins=("load",), beside=True)
DRY = Cause.of("dry_friction", "coulomb_friction", "asymmetric_friction")
GROWING = Cause.of("dry_friction", "load_friction")
EITHER = Cause.of("dry_friction", "coulomb_friction", "load_friction", "presliding_friction")
LATE = Cause.of("linear_dynamics", "delay", "lag", beside=True)
CURVE = Cause.of("static_curve", "saturation", "saturating_curve")
BLIND = Cause.of("static_curve", "blind_to_direction", "even_nonlinearity")
HARMONICS = Cause.of("periodic_over_position")

STACK = (Cause.of("hysteresis"), Cause.of("linear_dynamics", "delay", "lag"), Cause.of("slow_memory", twins=("drift", "thermal_drift")))
WEATHER = Cause.of("slow_change", "drift", "thermal_drift", twins=("load",))


def emps(diagram: str, *logs: Log, rewrite: tuple[tuple[str, str], ...] = ()) -> Folder:
    """The positioning axis, by one of its three diagrams."""
    return Folder("machines/emps", f"emps_{diagram}.st", f"emps_{diagram}.toml", logs, rewrite)


def plain(machine: str, *logs: Log) -> Folder:
    """A folder with one diagram."""
    return Folder(f"machines/{machine}", "plant.st", "start.toml", logs or (Log("log.csv"),))


def cylinder(*bars: int) -> Folder:
    """The pneumatic cylinder at one pressure or at several."""
    return Folder("machines/pneumatic-cylinder", "pneu_v.st", "pneu_v.toml", tuple(Log(f"bar{bar}.csv") for bar in bars))


def made(name: str) -> Folder:
    """A record that was made up."""
    return Folder("machines/made", f"{name}.st", f"{name}.toml", (Log(f"{name}.csv"),))


MADE_UP = "made up"
EMPS = Log("log.csv")
EMPS_ROWS = 24841
HALVES = EMPS.halves(EMPS_ROWS)
THIN = (("@ts 1ms", "@ts 4ms"),)
BOTH_SINES = (Log("hold_sin_sin.csv"), Log("hold_sin_time_square.csv"))
CARS = tuple(Log(f"40_{run}.csv") for run in (0, 1, 10, 2))
DRIVES = tuple(Log(f"log{number}.csv") for number in (1, 2, 3))
RAW_VOLTS = Log("raw_sin_sin.csv", column="u", formula=lambda row: row["pwm"] / 885.0 * row["volts"])

RESAMPLED = '\n[record]\nresample = "linear"\n'
"""What the product's own message advises for a log with jitter and gaps."""

IN_THE_LOOP = "the axis turns often and slowly enough; the gap shows in the effort"
COARSE = "the speed is a difference of readings, and coarse where it is low"
ONE_LOAD = "one run has too few loads to part a friction that grows with them from one that does not"
BENT = "a delay bends the curve into a loop"
TURNED = "the speed turns its sign seldom and quickly: an even polynomial does what |y| does"
FURTHER = "one step of heat: a dead time, a lag and a slow mode look alike"

MACHINES = (
    Case("emps, in its loop", "emps", emps("loop", EMPS), (DRY, OFFSET), True, IN_THE_LOOP),
    Case("emps, in its loop, first half", "emps", emps("loop", HALVES[0]), (DRY, OFFSET), True, IN_THE_LOOP),
    Case("emps, in its loop, second half", "emps", emps("loop", HALVES[1]), (DRY, OFFSET), True, IN_THE_LOOP),
    Case("emps, in its loop, every 4th row", "emps", emps("loop", Log("log.csv", stride=4), rewrite=THIN), (DRY, OFFSET), True, IN_THE_LOOP),
    Case("emps, speed from force", "emps", emps("speed", Log("speed.csv")), (DRY, OFFSET), False, COARSE),
    Case("emps, force from motion", "emps", emps("inverse", EMPS), (DRY, OFFSET), True, "the motion is measured, and so is the force"),
    Case("emps, force from motion, first half", "emps", emps("inverse", HALVES[0]), (DRY, OFFSET), True, "the same"),
    Case("pneumatic cylinder, 1 bar", "pneumatic cylinder", cylinder(1), (EITHER, Cause.of("play", beside=True), OFFSET), False, "one pressure"),
    Case("pneumatic cylinder, 5 bar", "pneumatic cylinder", cylinder(5), (EITHER, Cause.of("play", beside=True), OFFSET), False, "one pressure"),
    Case("pneumatic cylinder, both", "pneumatic cylinder", cylinder(1, 5), (GROWING, Cause.of("play", beside=True), OFFSET), True, "two pressures"),
    Case("xl330 pendulum, resampled", "xl330 pendulum", plain("xl330-pendulum", Log("sin_sin.csv")), (EITHER,), False, ONE_LOAD),
    Case("xl330 pendulum, nearest sample", "xl330 pendulum", plain("xl330-pendulum", BOTH_SINES[0]), (EITHER,), False, ONE_LOAD),
    Case("xl330 pendulum, square in time", "xl330 pendulum", plain("xl330-pendulum", BOTH_SINES[1]), (EITHER,), False, ONE_LOAD),
    Case("xl330 pendulum, all three", "xl330 pendulum", plain("xl330-pendulum", Log("sin_sin.csv"), *BOTH_SINES), (GROWING,), True,
         "0.024 rad are left by one that grows with the load, 0.056 by Coulomb's"),
    Case("xl330 pendulum, as logged", "xl330 pendulum", replace(plain("xl330-pendulum", RAW_VOLTS), settings=RESAMPLED), (EITHER,), False, ONE_LOAD),
    Case("car, one log", "car", plain("car-steering", CARS[2]), (CURVE, LATE), False, BENT),
    Case("car, four logs", "car", plain("car-steering", *CARS), (CURVE, LATE), False, BENT),
    Case("hair dryer", "hair dryer", plain("dryer"), (Cause.of("linear_dynamics", "delay"),), True, "a random binary signal, three samples late"),
    Case("robot arm", "robot arm", plain("robot-arm"), (Cause.of("linear_dynamics", "resonance", "second_resonance"),), True, "a sweep over the modes"),
    Case("resolver", "resolver", plain("resolver"), (HARMONICS, LATE), True, "four periods a turn, several turns, two speeds, both ways"),
    Case("hot end", "hot end", plain("hotend"),
         (Cause.of("linear_dynamics", "lag", "second_lag", "delay"),
          Cause.of("slow_change", twins=("load", "cross_coupling", "scheduled_gain", "cutout"), beside=True)), False, FURTHER),
    Case("mr damper", "mr damper", plain("mr-damper"),
         (Cause.of("dry_friction", twins=("saturation", "saturating_curve")), Cause.of("hysteresis", beside=True)), False,
         "over a measured speed a limit of that speed writes the same yield as a friction that is smooth at rest"),
    *(Case(f"coupled drives, log {number}", "coupled drives", plain("coupled-drives", log), (BLIND,), False, TURNED)
      for number, log in enumerate(DRIVES, 1)),
    Case("coupled drives, all three", "coupled drives", plain("coupled-drives", *DRIVES), (BLIND,), False, TURNED),
    Case("made up: cogging", MADE_UP, made("cogging"),
         (Cause.of("periodic_over_position", twins=("periodic_disturbance",)),), False, "one turn at constant speed: place and time run alike"),
    Case("made up: late", MADE_UP, made("late"), (HARMONICS, Cause.of("linear_dynamics", "delay")), True, "4 periods a turn of 1.5 deg, 35 ms"),
    Case("made up: random binary signal", MADE_UP, made("prbs"),
         (Cause.of("linear_dynamics", "delay"),), True, "three samples late, begun in mid-motion"),
)  # fmt: skip
"""The folder `machines`."""

FROM_THE_OLDER: dict[str, tuple[str, tuple[Cause, ...], bool, str]] = {
    "piezo stack, 10 cycles, the paper's model": ("piezo stack",
        STACK, False,
        "one frequency: asymmetry, creep and lag close the gap alike"),
    "piezo stack, minor loops and rests": ("piezo stack",
        STACK, False,
        "several published causes, of which none stands out"),
    "two heaters, one diagram": ("heaters", (Cause.of("coupling"), WEATHER), True, "both heaters move"),
    "heater 1 alone": ("heaters", (Cause.of("coupling"), WEATHER), True, "both heaters move"),
    "heater 2 alone": ("heaters", (Cause.of("coupling"), WEATHER), True, "both heaters move"),
    "silverbox, a linear oscillator": ("silverbox", (Cause.of("static_curve", "odd_nonlinearity"),), True, "a random multisine, noise of a thousandth"),
    "cascaded tanks": ("tanks", (Cause.of("static_curve", "saturation"),), False, "48 samples of overflow"),
    "fine steering mirror, gains at rest": ("mirror", (Cause.of("linear_dynamics", "resonance", "second_resonance"),), True, "a multisine over the modes"),
}  # fmt: skip
"""What the authors of the older records name, by the names that these have among the measured records."""

OLDER = tuple(
    Case(one.name, machine, Own(one.model, one.cut), causes, member, why)
    for one in WITHHELD
    for machine, causes, member, why in (FROM_THE_OLDER[one.name],)
)

ALL = MACHINES + OLDER


@dataclass(frozen=True)
class Fold:
    """All records of a machine but one, and that one."""

    name: str
    machine: str
    rest: Folder
    kept: Folder
    starts: tuple[str, ...] = ()
    """States that a record begins in, where it is cut out of a longer one: no part of the machine, and fitted to the kept
    record for each diagram."""


def _folds(machine: str, whole: Folder, names: tuple[str, ...], starts: tuple[str, ...] = ()) -> Iterator[Fold]:
    for number, name in enumerate(names):
        rest = tuple(log for other, log in enumerate(whole.logs) if other != number)
        parts = (Folder(whole.folder, whole.diagram, whole.parameters, logs, whole.rewrite) for logs in (rest, (whole.logs[number],)))
        yield Fold(f"{machine}, without {name}", machine, *parts, starts)


FOLDS = (
    *_folds("car", plain("car-steering", *CARS), tuple(one.file.removesuffix(".csv") for one in CARS)),
    *_folds("xl330 pendulum", plain("xl330-pendulum", *BOTH_SINES), ("sines", "square in time")),
    *_folds("coupled drives", plain("coupled-drives", *DRIVES), ("log 1", "log 2", "log 3")),
    *_folds("emps, in its loop", emps("loop", *HALVES), ("first half", "second half"), ("POSITION.SUM", "SPEED.SUM")),
    *_folds("emps, force from motion", emps("inverse", *HALVES), ("first half", "second half")),
    *_folds("pneumatic cylinder", cylinder(1, 5), ("1 bar", "5 bar")),
)
"""The two files of the pendulum's sines are one experiment, so that one of them alone is used here."""
