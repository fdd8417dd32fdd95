"""What the library says: errors are raised, warnings are warned, notes are kept with the result."""
import json
import warnings
from ctypes import byref, c_void_p
from dataclasses import dataclass

from ._library import FOR_PYTHON, library

_SEVERITIES = ("error", "warning", "note")


@dataclass(frozen=True)
class Message:
    """One thing that was found: `code` is 402 for HY402, 0 for a note; line and column count from 1, 0 is unknown."""

    severity: str
    code: int
    file: str
    line: int
    column: int
    message: str
    mend: str


class Error(Exception):
    """Bad input. `code`, `message` and `mend` are of the first error; `messages` are all that was found.

    str() is the text that the tool prints, with the lines that it is about. An option is named as a keyword, rows="1..60".
    """

    def __init__(self, text, messages):
        super().__init__(text)
        first = next((one for one in messages if one.severity == "error"), messages[0])
        self.messages = messages
        self.code = f"HY{first.code}" if first.code > 0 else "fault"
        self.message = first.message
        self.mend = first.mend
        self.file = first.file
        self.line = first.line
        self.column = first.column


def error(code, message, mend):
    """An error that is found on this side of the border."""
    found = Message("error", int(code[2:]), "", 0, 0, message, mend)
    return Error(f"{code} error: {message}\nmend: {mend}\n", [found])


class InputWarning(UserWarning):
    """A warning of the library, as the tool prints it. The results stand all the same."""


def _text(given):
    return (given or b"").decode("utf-8", "replace")


def _listed(pointer):
    return [
        Message(
            severity=_SEVERITIES[library.hysteron_message_severity(pointer, i)],
            code=library.hysteron_message_code(pointer, i),
            file=_text(library.hysteron_message_file(pointer, i)),
            line=library.hysteron_message_line(pointer, i),
            column=library.hysteron_message_column(pointer, i),
            message=_text(library.hysteron_message_cause(pointer, i)),
            mend=_text(library.hysteron_message_mend(pointer, i)),
        )
        for i in range(library.hysteron_messages_count(pointer))
    ]


def called(name, *arguments, told=None):
    """Calls a function that gives a handle. Gives it and the notes. `told` are messages that were warned of before."""
    out = c_void_p()
    result = getattr(library, "hysteron_" + name)(*arguments, byref(out))
    try:
        library.hysteron_messages_for(out, FOR_PYTHON)
        messages = _listed(out)
        text = _text(library.hysteron_messages_text(out))
    finally:
        library.hysteron_messages_free(out)
    if not result:
        raise Error(text, messages)
    for one in messages:
        if one.severity != "note" and one not in (told or ()):
            warnings.warn(f"HY{one.code}: {one.message} {one.mend}", InputWarning, stacklevel=3)
    return result, messages


def notes_of(messages):
    return [one.message for one in messages if one.severity == "note"]


def options(**given):
    """Options as the library takes them: those that are None are left out."""
    return json.dumps({key: value for key, value in given.items() if value is not None}).encode()


def encoded(text):
    return str(text).encode("utf-8", "surrogateescape")
