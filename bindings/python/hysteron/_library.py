"""The shared library by ctypes: where it is found, and what its functions take. The words of hysteron.h."""
import ctypes
import os
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from pathlib import Path

try:
    from ._location import LIBRARY  # written by `cmake --install`: as seen from this folder
except ImportError:
    LIBRARY = None

ABI = 1
FOR_PYTHON = 1

Progress = CFUNCTYPE(c_int, c_void_p, c_double, c_int)
_MESSAGES = POINTER(c_void_p)
_TEXTS = POINTER(c_char_p)
_NUMBERS = POINTER(c_double)
_HANDLES = POINTER(c_void_p)

_FUNCTIONS = {
    "abi": (c_int, []),
    "version": (c_char_p, []),
    "messages_count": (c_size_t, [c_void_p]),
    "message_severity": (c_int, [c_void_p, c_size_t]),
    "message_code": (c_int, [c_void_p, c_size_t]),
    "message_file": (c_char_p, [c_void_p, c_size_t]),
    "message_line": (c_uint, [c_void_p, c_size_t]),
    "message_column": (c_uint, [c_void_p, c_size_t]),
    "message_cause": (c_char_p, [c_void_p, c_size_t]),
    "message_mend": (c_char_p, [c_void_p, c_size_t]),
    "messages_text": (c_char_p, [c_void_p]),
    "messages_for": (None, [c_void_p, c_int]),
    "messages_free": (None, [c_void_p]),
    "compile_file": (c_void_p, [c_char_p, c_char_p, _MESSAGES]),
    "compile_text": (c_void_p, [c_char_p, c_char_p, _MESSAGES]),
    "with_parameters": (c_void_p, [c_void_p, c_char_p, _MESSAGES]),
    "diagram_json": (c_char_p, [c_void_p]),
    "diagram_free": (None, [c_void_p]),
    "machine_new": (c_void_p, [c_void_p, c_double, c_char_p, _MESSAGES]),
    "machine_step": (c_int, [c_void_p, _NUMBERS, _NUMBERS]),
    "machine_reset": (None, [c_void_p]),
    "machine_free": (None, [c_void_p]),
    "record_read": (c_void_p, [c_char_p, c_void_p, c_char_p, _MESSAGES]),
    "record_new": (c_void_p, [c_size_t, c_size_t, _TEXTS, _TEXTS, _NUMBERS, c_void_p, c_char_p, _MESSAGES]),
    "record_rows": (c_size_t, [c_void_p]),
    "record_sample_time": (c_double, [c_void_p]),
    "record_time": (_NUMBERS, [c_void_p]),
    "record_time_name": (c_char_p, [c_void_p]),
    "record_columns": (c_size_t, [c_void_p]),
    "record_name": (c_char_p, [c_void_p, c_size_t]),
    "record_unit": (c_char_p, [c_void_p, c_size_t]),
    "record_values": (_NUMBERS, [c_void_p, c_size_t]),
    "record_free": (None, [c_void_p]),
    "run": (c_void_p, [c_void_p, c_void_p, c_char_p, _MESSAGES]),
    "tune": (c_void_p, [c_void_p, _HANDLES, c_size_t, c_char_p, Progress, c_void_p, _MESSAGES]),
    "fit_json": (c_char_p, [c_void_p]),
    "fit_parameters": (c_char_p, [c_void_p]),
    "fit_free": (None, [c_void_p]),
    "relay_experiment": (c_void_p, [c_void_p, c_char_p, c_char_p, c_char_p, _MESSAGES]),
    "relay_json": (c_char_p, [c_void_p]),
    "relay_parameters": (c_char_p, [c_void_p]),
    "relay_free": (None, [c_void_p]),
    "diagnose": (c_void_p, [c_void_p, _HANDLES, c_size_t, c_char_p, _MESSAGES]),
    "diagnosis_file": (c_char_p, [c_void_p, c_char_p]),
    "diagnosis_file_count": (c_size_t, [c_void_p]),
    "diagnosis_file_name": (c_char_p, [c_void_p, c_size_t]),
    "diagnosis_free": (None, [c_void_p]),
}


def _candidates():
    if os.environ.get("HYSTERON_LIBRARY"):
        return [os.environ["HYSTERON_LIBRARY"]]
    beside = [] if LIBRARY is None else [str(Path(__file__).resolve().parent / LIBRARY)]
    return [one for one in beside if Path(one).exists()] + ["libhysteron.so.1"]


def _load():
    failures = []
    for name in _candidates():
        try:
            found = ctypes.CDLL(name)
            break
        except OSError as failure:
            failures.append(str(failure))
    else:
        raise ImportError("libhysteron is not found: " + "; ".join(failures) +
                          ". Install it, or set HYSTERON_LIBRARY to the path of libhysteron.so.")
    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(found, "hysteron_" + name)
        function.restype = result
        function.argtypes = arguments
    if found.hysteron_abi() != ABI:
        raise ImportError(f"libhysteron has ABI {found.hysteron_abi()}, and this package is for {ABI}. "
                          "Install both from one version.")
    return found


library = _load()


class Handle:
    """Owns a handle of the library, and frees it by the function of that name."""

    def __init__(self, pointer, free):
        self.pointer = pointer
        self._free = getattr(library, "hysteron_" + free)

    def __del__(self):
        if getattr(self, "pointer", None):
            self._free(self.pointer)
            self.pointer = None
