"""What a fit and a diagnosis give, as objects. Each is made of the JSON that the tool writes; `data` is all of it."""
import dataclasses
import json
from dataclasses import dataclass, field
from typing import Optional

from ._library import Handle, library


def _made(kind, data, /, **more):
    """A dataclass of the keys that it has; keys that a later version adds are left to `data`."""
    names = {one.name for one in dataclasses.fields(kind)}
    return kind(**{key: value for key, value in {**data, **more}.items() if key in names})


@dataclass(frozen=True)
class Fitted:
    """A fitted parameter or initial state. The standard error is None where the data do not tell."""

    name: str
    value: float
    standard_error: Optional[float]
    unit: str
    at_bound: str


@dataclass(frozen=True)
class Score:
    """Root of the mean squared error of one output, in its unit. None where there are no samples."""

    name: str
    unit: str
    range: float
    range_test: float
    rmse_train: Optional[float]
    rmse_test: Optional[float]
    rmse_before: Optional[float]
    train_samples: int
    test_samples: int


@dataclass(frozen=True)
class Fit:
    """What `tune` found. `text` is the parameter file with the fitted values, as `tune --out` writes it."""

    status: str
    message: str
    iterations: int
    parameters: dict
    initial_states: dict
    outputs: dict
    warnings: list
    text: str
    data: dict = field(repr=False)
    #: What was understood of the records, and converted.
    notes: list = field(default_factory=list, repr=False)

    @property
    def converged(self):
        return self.status in ("converged", "nearly converged")


@dataclass(frozen=True)
class Margin:
    """A margin of a loop, and the frequency in rad/s that it is at. None where the loop has none: it is unlimited."""

    value: Optional[float]
    frequency: float


@dataclass(frozen=True)
class LoopFigures:
    """What a loop does with one plant. None where there is no such figure, as the overshoot of a ramp.

    `error` is the RMS distance to the wished response, as a share of the step; times are in seconds.
    """

    error: float
    overshoot_percent: Optional[float]
    rise_time: Optional[float]
    settling_time: Optional[float]
    effort: Optional[float]
    effort_rate: Optional[float]
    gain_margin_db: Optional[Margin]
    phase_margin_deg: Optional[Margin]
    sensitivity: Optional[Margin]


@dataclass(frozen=True)
class Plant:
    """One plant of a goal. `before` is None where the loop has no response with the values of the start."""

    name: str
    before: Optional[LoopFigures]
    after: LoopFigures


@dataclass(frozen=True)
class Limit:
    """A limit of [goal.limits] in one plant. `value` is None where it is unlimited."""

    name: str
    plant: str
    limit: float
    value: Optional[float]
    kept: bool
    active: bool


@dataclass(frozen=True)
class Tuned:
    """A parameter of a tuned loop."""

    name: str
    value: float
    start: float
    unit: str
    at_bound: str


@dataclass(frozen=True)
class TunedLoop:
    """What `tune` found for a [goal]. `text` is the parameter file with the tuned values, as `tune --out` writes it."""

    status: str
    message: str
    iterations: int
    start: str
    parameters: dict
    plants: dict
    limits: list
    text: str
    data: dict = field(repr=False)
    #: What was understood of the records, and converted.
    notes: list = field(default_factory=list, repr=False)

    @property
    def keeps_limits(self):
        return all(limit.kept for limit in self.limits)


def _figures(data):
    margins = {name: _made(Margin, one) for name, one in (data["margins"] or {}).items() if isinstance(one, dict)}
    return _made(LoopFigures, data, **{name: margins.get(name) for name in
                                       ("gain_margin_db", "phase_margin_deg", "sensitivity")})


def _loop(data, text, notes):
    plants = {one["name"]: Plant(one["name"], one["before"] and _figures(one["before"]), _figures(one["after"]))
              for one in data["plants"]}
    return _made(TunedLoop, data, parameters={one["name"]: _made(Tuned, one) for one in data["parameters"]},
                 plants=plants, limits=[_made(Limit, one) for one in data["limits"]], text=text, data=data,
                 notes=notes)


def tuned_of(pointer, notes):
    """A fit, or a loop that was tuned for a goal: each has keys that the other has not."""
    handle = Handle(pointer, "fit_free")
    data = json.loads(library.hysteron_fit_json(handle.pointer))
    if "plants" in data:
        return _loop(data, library.hysteron_fit_parameters(handle.pointer).decode(), notes)
    return _made(Fit, data,
                 parameters={one["name"]: _made(Fitted, one) for one in data["parameters"]},
                 initial_states={one["name"]: _made(Fitted, one) for one in data["initial_states"]},
                 outputs={one["name"]: _made(Score, one) for one in data["outputs"]},
                 text=library.hysteron_fit_parameters(handle.pointer).decode(), data=data, notes=notes)


@dataclass(frozen=True)
class Controller:
    """KP·(e + ∫e dt/TR − TD·dy/dt), as HY_PID has it; TR and TD in seconds."""

    KP: float
    TR: float
    TD: float


@dataclass(frozen=True)
class Model:
    """A lag with a dead time, K·exp(−dead_time·s)/(1 + T·s); times in seconds."""

    K: float
    T: float
    dead_time: float


@dataclass(frozen=True)
class Relay:
    """What a relay experiment tells. `model` is None where the record does not tell the static gain: `why_no_model`.

    `text` is the parameter file of a PID to begin with, as `relay --out` writes it.
    """

    low: float
    high: float
    cycles: int
    period: float
    spread: float
    amplitude: float
    hysteresis: float
    gain: float
    phase_deg: float
    ultimate_gain: float
    ultimate_period: float
    model: Optional[Model]
    why_no_model: str
    pi: Controller
    pid: Controller
    text: str
    data: dict = field(repr=False)
    #: What was understood of the records, and converted.
    notes: list = field(default_factory=list, repr=False)


def relay_of(pointer, notes):
    handle = Handle(pointer, "relay_free")
    data = json.loads(library.hysteron_relay_json(handle.pointer))
    return _made(Relay, data, model=data["model"] and _made(Model, data["model"]), pi=_made(Controller, data["pi"]),
                 pid=_made(Controller, data["pid"]), text=library.hysteron_relay_parameters(handle.pointer).decode(),
                 data=data, notes=notes)


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval. None where the record does not determine it."""

    value: Optional[float]
    low: Optional[float]
    high: Optional[float]
    unit: str


@dataclass(frozen=True)
class Setting:
    """What an effect was given and no fit moved."""

    value: float
    unit: str


@dataclass(frozen=True)
class Effect:
    """An effect, the edge of the diagram where it acts, and its share of the gap that calibration leaves."""

    id: str
    edge: str
    same_edges: list
    drivers: list
    share: float
    invertible: bool
    parameters: dict
    settings: dict


@dataclass(frozen=True)
class Gap:
    """The gap of one output, RMS in its unit. `closed` is the share closed on blocks that were held out."""

    signal: str
    unit: str
    nominal_rms: float
    calibrated_rms: float
    improved_rms: float
    floor_rms: float
    floor_evidence: str
    closed: float
    closed_low: float
    closed_high: float


@dataclass(frozen=True)
class Family:
    """A family of effects, and how likely it is that one of it is there."""

    family: str
    probability: float
    closed: float
    closed_alone: float
    effect: str
    effect_probability: float
    edge: str


@dataclass(frozen=True)
class Rival:
    """A set of effects that the data do not rule out."""

    effects: list
    edges: list
    parameters: int
    improved_rms: float
    support: float
    probability: float


@dataclass(frozen=True)
class Verdict:
    """What `diagnose` found, as verdict.json says it. `files` are those that `diagnose --out` writes, by name."""

    verdict: str
    summary: str
    confidence: float
    unknown_score: float
    refused: bool
    refusals: list
    effects: list
    rivals: list
    families: list
    gap: Gap
    gaps: list
    calibration: dict
    nominal: dict
    cannot_tell: list
    warnings: list
    files: dict = field(repr=False)
    data: dict = field(repr=False)
    #: What was understood of the records, and converted.
    notes: list = field(default_factory=list, repr=False)

    @property
    def improved(self):
        """The text of improved.st, the diagram with the effects in it; None where nothing could be diagnosed."""
        return self.files.get("improved.st")

    @property
    def improved_parameters(self):
        """The text of improved.toml; None where nothing could be diagnosed."""
        return self.files.get("improved.toml")


def _named(kind, data):
    return {name: _made(kind, one) for name, one in data.items()}


def verdict_of(pointer, notes):
    handle = Handle(pointer, "diagnosis_free")
    names = [library.hysteron_diagnosis_file_name(handle.pointer, i)
             for i in range(library.hysteron_diagnosis_file_count(handle.pointer))]
    files = {name.decode(): library.hysteron_diagnosis_file(handle.pointer, name).decode() for name in names}
    data = json.loads(files["verdict.json"])
    effects = [_made(Effect, one, parameters=_named(Estimate, one["parameters"]),
                     settings=_named(Setting, one["settings"])) for one in data["effects"]]
    return _made(Verdict, data, effects=effects, rivals=[_made(Rival, one) for one in data["rival_details"]],
                 families=[_made(Family, one) for one in data["families"]], gap=_made(Gap, data["gap"]),
                 gaps=[_made(Gap, one) for one in data["gaps"]], calibration=_named(Estimate, data["calibration"]),
                 nominal=_named(Estimate, data["nominal"]), files=files, data=data, notes=notes)
