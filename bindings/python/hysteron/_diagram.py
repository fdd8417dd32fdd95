"""Diagrams: compiled, described, stepped, run, tuned and diagnosed."""
import ctypes
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

import numpy

from ._library import Handle, Progress, library
from ._messages import called, encoded, error, notes_of, options
from ._record import Record, as_record
from ._results import relay_of, tuned_of, verdict_of


@dataclass(frozen=True)
class Port:
    """An input or output. An end of its range is None where it is open, `default` where an input must be driven."""

    name: str
    unit: str
    meaning: str
    type: str
    minimum: Optional[float]
    maximum: Optional[float]
    default: Optional[float] = None


@dataclass(frozen=True)
class Parameter:
    """A number that is constant over a run. With `above_minimum` the minimum itself is out of its range."""

    name: str
    unit: str
    meaning: str
    type: str
    minimum: Optional[float]
    maximum: Optional[float]
    above_minimum: bool
    value: Any


class Machine:
    """A diagram that is stepped, with a state of its own. One thread at a time."""

    def __init__(self, diagram, pointer):
        self.diagram = diagram
        self._handle = Handle(pointer, "machine_free")
        self._places = {name.upper(): i for i, name in enumerate(diagram.inputs)}
        self._names = list(diagram.outputs)
        self._inputs = numpy.array([port.default or 0.0 for port in diagram.inputs.values()])
        self._outputs = numpy.empty(len(self._names))
        numbers = ctypes.POINTER(ctypes.c_double)
        self._in = self._inputs.ctypes.data_as(numbers)
        self._out = self._outputs.ctypes.data_as(numbers)
        self._missing = {name.upper() for name, port in diagram.inputs.items() if port.default is None}

    def step(self, **inputs):
        """One step; gives the outputs by name. An input that is not given keeps its last value, at first its default."""
        places = []
        for name in inputs:
            place = self._places.get(name.upper())
            if place is None:
                raise error("HY502", f"There is no input {name}.", f"the inputs are {', '.join(self.diagram.inputs)}.")
            places.append(place)
        missing = self._missing.difference(name.upper() for name in inputs) if self._missing else None
        if missing:
            raise error("HY502", f"The input {sorted(missing)[0]} has no value and no default.", "give it one.")
        before = self._inputs.copy()
        for name, place, value in zip(inputs, places, inputs.values()):
            try:
                self._inputs[place] = value
            except (TypeError, ValueError):
                self._inputs[:] = before
                raise error("HY707", f"The input {name} is {value!r}, which is no number.", "give a number.") from None
        fault = library.hysteron_machine_step(self._handle.pointer, self._in, self._out)
        if fault > 0:
            name, value = list(self.diagram.inputs)[fault - 1], self._inputs[fault - 1]
            self._inputs[:] = before
            port = self.diagram.inputs[name]
            raise error("HY707", f"The input {name} is {value:g}, which is no {port.type}.",
                         "give 0 or 1." if port.type == "BOOL" else "give a whole number within its range.")
        if fault < 0:
            self._inputs[:] = before
            raise error("HY750", "The step was not made: an FMU in the diagram refused it, or could not be started.",
                        "run() over a record says what it answered, and at which time.")
        self._missing = set()
        return dict(zip(self._names, self._outputs.tolist()))

    def reset(self):
        """Every state as after the start."""
        library.hysteron_machine_reset(self._handle.pointer)


class Diagram:
    """A compiled diagram. It does not change, and any number of threads may use it; `step` is for one of them."""

    def __init__(self, pointer, messages=()):
        self._handle = Handle(pointer, "diagram_free")
        #: Warnings of the compiler.
        self.warnings = [one for one in messages if one.severity == "warning"]
        data = json.loads(library.hysteron_diagram_json(pointer))
        self.name = data["name"]
        #: In seconds; None where the diagram states none.
        self.sample_time = data["sample_time"]
        self.inputs = {one["name"]: Port(**one) for one in data["inputs"]}
        self.outputs = {one["name"]: Port(**one) for one in data["outputs"]}
        self.parameters = {one["name"]: Parameter(**one) for one in data["parameters"]}
        self._own = None

    @property
    def _pointer(self):
        return self._handle.pointer

    def __repr__(self):
        return f"<Diagram {self.name}: {', '.join(self.inputs)} -> {', '.join(self.outputs)}>"

    def with_parameters(self, params=None, **values):
        """The same diagram with other parameters: a file or its text, and values over it, `HYST={"C1": 8.0}`."""
        pointer, messages = called("with_parameters", self._pointer, _parameters(params, values), told=self.warnings)
        made = Diagram(pointer, messages)
        made.warnings = self.warnings
        return made

    def machine(self, *, sample_time=None, float32=False):
        """A machine of its own, after its reset. The sample time is for a diagram that states none."""
        pointer, _ = called("machine_new", self._pointer, float(sample_time or 0.0), options(float32=float32))
        return Machine(self, pointer)

    def step(self, **inputs):
        """One step of a machine that the diagram keeps for this; gives the outputs by name."""
        if self._own is None:
            self._own = self.machine()
        return self._own.step(**inputs)

    def reset(self):
        """The machine of `step` as after the start."""
        self._own = None

    def run(self, record, *, traces=(), float32=False, **reading):
        """Runs over a record, arrays by name or a file, from the reset; gives the outputs and `t` as a record.

        The numbers have the bits of `hysteron run`. `traces` are signals inside, as HYST.XOUT. Further options say how
        the record is read: read_record, and units={"U": "mV"} of arrays.
        """
        given = as_record(record, self, **reading)
        pointer, messages = called("run", self._pointer, given._handle.pointer,
                                   options(traces=list(traces), float32=float32), told=self.warnings)
        made = Record(pointer, messages)
        made.notes = _read_here([record], [given]) + made.notes
        return made

    def tune(self, records=(), params=None, *, starts=1, progress=None, **reading):
        """Fits what [fit] of the parameter file names, so that the outputs meet the columns of their names; gives a Fit.

        With [goal] it tunes a control loop instead, and gives a TunedLoop; records are then needed for
        signal = "record" alone. Limits that cannot be kept together are warned of (HY533).

        `records` is a record, arrays or a file, or a list of these; `params` a parameter file or its text, else that of
        the diagram. `progress(done, iteration)` is called once an iteration. An exception in it, Ctrl-C among them, ends
        the fit.
        """
        diagram, given, pointers = self._given(records, params, reading)
        raised = []

        def told(_user, done, iteration):
            try:
                if progress is not None:
                    progress(done, iteration)
                return 0
            except BaseException as reason:  # no exception may cross the border
                raised.append(reason)
                return 1

        pointer, messages = called("tune", diagram._pointer, pointers, len(given), options(starts=starts),
                                   Progress(told), None, told=self.warnings)
        fit = tuned_of(pointer, _read_here(_listed(records), given) + notes_of(messages))
        if raised:
            raise raised[0]
        return fit

    def diagnose(self, records, params=None, *, material=None, effects=None, ignore=None, most=None, limits=None,
                 effort=None, time_limit=None, seed=None, explain=None, without=None, threads=None, **reading):
        """Why records of the machine and the diagram differ; gives the verdict. Options are those of the tool."""
        diagram, given, pointers = self._given(records, params, reading)
        pointer, messages = called("diagnose", diagram._pointer, pointers, len(given),
                                   options(material=material, effects=effects, ignore=ignore, most=most, limits=limits,
                                           effort=effort, time_limit=time_limit, seed=seed, explain=explain,
                                           without=without, threads=threads),
                                   told=self.warnings)
        return verdict_of(pointer, _read_here(_listed(records), given) + notes_of(messages))

    def _given(self, records, params, reading):
        """The diagram with these parameters, the records, which own their handles, and these handles."""
        diagram = self if params is None else self.with_parameters(params)
        given = [as_record(one, diagram, **reading) for one in _listed(records)]
        return diagram, given, (ctypes.c_void_p * len(given))(*[one._handle.pointer for one in given])


def _listed(records):
    return records if isinstance(records, (list, tuple)) else [records]


def _read_here(asked, given):
    """Notes of the records that a call has read or made itself; of another, its owner has them."""
    return [note for one, record in zip(asked, given) if record is not one for note in record.notes]


def _is_text(given):
    return isinstance(given, str) and "\n" in given


def _parameters(params, values, **more):
    flat = {}
    for name, value in values.items():
        inside = value.items() if isinstance(value, Mapping) else [(None, value)]
        for key, one in inside:
            path = name if key is None else f"{name}.{key}"
            flat[path] = one.tolist() if isinstance(one, (numpy.ndarray, numpy.generic)) else one
    key = "params_text" if _is_text(params) else "params"
    return options(parameters=flat or None, **{key: params if params is None else os.fspath(params)}, **more)


def compile(source, params=None, *, top=None, any_order=None, **values):  # noqa: A001, as the tool's own word
    """Compiles a diagram: a path, or its text, which has more lines than one.

    `params` is a parameter file, or its text; keywords set values over it: compile(text, HYST={"C1": 8.0}).
    """
    given = _parameters(params, values, top=top, any_order=any_order)
    if _is_text(source):
        return Diagram(*called("compile_text", encoded(source), given))
    return Diagram(*called("compile_file", os.fsencode(source), given))


def relay(record, u, y, *, controller=None, **reading):
    """What a relay experiment tells of a process: ultimate gain and period, a model, and a PID to begin with.

    `record` is arrays by name or a file; `u` is the column that the relay wrote, `y` the process value. `controller` is
    the PID's instance in the diagram, for the parameter file that the result has as `text`.
    """
    given = as_record(record, None, **reading)
    pointer, messages = called("relay_experiment", given._handle.pointer, encoded(u), encoded(y),
                               options(controller=controller))
    return relay_of(pointer, _read_here([record], [given]) + notes_of(messages))
