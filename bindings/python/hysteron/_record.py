"""Records: named columns of numbers over an even time, as numpy arrays."""
import ctypes
import os
from collections.abc import Mapping

import numpy

from ._library import Handle, library
from ._messages import called, error, notes_of, options


def _read_only(pointer, count, owner):
    """An array over the library's memory, which lives as long as the array does."""
    if count == 0:
        return numpy.empty(0)
    buffer = (ctypes.c_double * count).from_address(ctypes.addressof(pointer.contents))
    buffer._owner = owner
    array = numpy.frombuffer(buffer)
    array.flags.writeable = False
    return array


class Record(Mapping):
    """Columns by name, without regard to case; `t` is the time in seconds, or `time` where the diagram has a signal T.
    The arrays are read-only: `copy()` them."""

    def __init__(self, pointer, messages=()):
        self._handle = Handle(pointer, "record_free")
        rows = library.hysteron_record_rows(pointer)
        self.sample_time = library.hysteron_record_sample_time(pointer)
        #: What was understood of the file that it does not say outright.
        self.notes = notes_of(messages)
        self.units = {}
        self._time = library.hysteron_record_time_name(pointer).decode()
        self._columns = {self._time: _read_only(library.hysteron_record_time(pointer), rows, self._handle)}
        self.units[self._time] = "s"
        for i in range(library.hysteron_record_columns(pointer)):
            name = library.hysteron_record_name(pointer, i).decode()
            self._columns[name] = _read_only(library.hysteron_record_values(pointer, i), rows, self._handle)
            self.units[name] = library.hysteron_record_unit(pointer, i).decode()
        self._names = {name.upper(): name for name in self._columns}

    def __getitem__(self, name):
        found = self._names.get(str(name).upper())
        if found is None:
            raise KeyError(f"there is no column {name}; the columns are {', '.join(self._columns)}")
        return self._columns[found]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    def __repr__(self):
        return f"<Record of {len(self[self._time])} rows every {self.sample_time:g} s: {', '.join(self._columns)}>"


def read_options(columns, given):
    unknown = set(given) - {"time", "rate", "skip", "range", "rows", "decimal", "resample"}
    if unknown:
        raise TypeError(f"read_record() has no option {', '.join(sorted(unknown))}")
    return options(columns=dict(columns) if columns else None, **given)


def read_record(path, *, diagram=None, columns=None, **given):
    """Reads a file as `hysteron record` does, in whatever dress a tool wrote it.

    Options are those of the tool, as texts or numbers: time="NAME[ms]", rate="1kHz", columns={"U": "MAIN.u[mV]"},
    skip=3, range="2s..8s", rows="1..600", decimal="comma", resample="linear", or by signal
    resample={"Q": "hold", "*": "linear"}, where * is all others. With a diagram, [record] of its parameter
    file holds where no option does, and a record is resampled to its sample time.
    """
    pointer, messages = called("record_read", os.fsencode(path), diagram._pointer if diagram else None,
                               read_options(columns, given))
    return Record(pointer, messages)


def _has_time(arrays, diagram):
    """Whether one of the arrays may be the time, by its name. Beside a port T, one that does not rise is that signal."""
    named = {name: array for name, array in arrays.items() if name.lower() in ("t", "time")}
    has_port = diagram is not None and any(name.lower() == "t" for name in [*diagram.inputs, *diagram.outputs])
    return any(not has_port or name.lower() == "time" or bool(numpy.all(numpy.diff(array) > 0.0))
               for name, array in named.items())


def as_record(given, diagram=None, *, units=None, columns=None, **options_given):
    """A record as it is; arrays by name as a record; else the name of a file.

    Of arrays, one is the time in seconds, `t`, or `time` beside a signal T, by the rules of a file. Without one, `rate`
    states the rows per second, or else the diagram's sample time counts.
    """
    if isinstance(given, Record):
        return given
    if not isinstance(given, Mapping):
        return read_record(given, diagram=diagram, columns=columns, **options_given)
    arrays = {}
    for name, values in given.items():
        try:
            array = numpy.ascontiguousarray(values, dtype=numpy.float64)
        except (TypeError, ValueError):
            raise error("HY505", f"Column {name} holds no numbers.", "give an array of numbers.") from None
        if numpy.ndim(values) != 1:
            raise error("HY505", f"Column {name} has {numpy.ndim(values)} dimensions.", "give one number for each row.")
        arrays[str(name)] = array
    if not arrays:
        raise error("HY501", "There is no column.", "give arrays by the names of the inputs.")
    lengths = {len(array) for array in arrays.values()}
    if len(lengths) > 1:
        raise error("HY504", "The columns differ in length: " +
                    ", ".join(f"{name} has {len(array)}" for name, array in arrays.items()) + ".",
                    "give each as many numbers as there are rows.")
    count, rows = len(arrays), lengths.pop()
    states_time = "time" in options_given or "rate" in options_given
    if not states_time and not _has_time(arrays, diagram) and diagram is not None and diagram.sample_time:
        options_given["rate"] = f"{diagram.sample_time!r} s"
    given_units = {str(name).lower(): unit for name, unit in (units or {}).items()}
    unknown = set(given_units) - {name.lower() for name in arrays}
    if unknown:
        raise error("HY708", f"There is no column {', '.join(sorted(unknown))} to which units gives a unit.",
                    f"the columns are {', '.join(arrays)}.")
    names = (ctypes.c_char_p * count)(*[name.encode() for name in arrays])
    texts = (ctypes.c_char_p * count)(*[str(given_units.get(name.lower(), "")).encode() for name in arrays])
    values = numpy.concatenate(list(arrays.values())) if rows else numpy.empty(0)
    pointer, messages = called("record_new", count, rows, names, texts,
                               values.ctypes.data_as(ctypes.POINTER(ctypes.c_double)),
                               diagram._pointer if diagram else None, read_options(columns, options_given))
    return Record(pointer, messages)
