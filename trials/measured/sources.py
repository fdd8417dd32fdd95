"""Where the files of a case on a measured record come from: a machine's folder beside the project, or a model of the project."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from trials.measured.bases import Cut, Model
from trials.measured.make import parameter_file, table
from trials.runner import LOGS

Row = dict[str, float]


@dataclass(frozen=True)
class Log:
    """A record as its folder has it: rows from `first` on, up to `last`, every `stride`-th, each as it is written there."""

    file: str
    first: int = 0
    last: int | None = None
    stride: int = 1
    column: str = ""
    """A column that is worked out of the others and added, as the folder's README says."""
    formula: Callable[[Row], float] | None = field(default=None, compare=False)

    def text(self, folder: Path) -> str:
        """The rows with their head."""
        lines = (folder / self.file).read_text().splitlines()
        head, rows = lines[0], lines[1:][self.first : self.last : self.stride]
        if self.formula:
            names = next(csv.reader([head]))
            rows = [f"{row},{self.formula(dict(zip(names, map(float, row.split(',')))))!r}" for row in rows]
            head = f"{head},{self.column}"
        return "\n".join([head, *rows, ""])

    def halves(self, rows: int) -> tuple[Log, Log]:
        """The same in two, of as many rows each."""
        return replace(self, last=rows // 2), replace(self, first=rows // 2)


@dataclass(frozen=True)
class Folder:
    """A machine's folder: a diagram without the cause, what of it is tuned, and the logs."""

    folder: str
    diagram: str
    parameters: str
    logs: tuple[Log, ...]
    rewrite: tuple[tuple[str, str], ...] = ()
    """Replacements in the diagram: another sample time for a thinned log."""
    settings: str = ""
    """What the parameter file says besides: how the logs are read, where a log as it is leaves that open."""

    def logs_of(self, data: Path) -> list[str]:
        """The text of each log."""
        return [one.text(data / self.folder) for one in self.logs]

    def files(self, data: Path) -> dict[str, str]:
        """What a case consists of."""
        text = (data / self.folder / self.diagram).read_text()
        for old, new in self.rewrite:
            if text.count(old) != 1:
                raise ValueError(f"{self.folder}/{self.diagram} has {old!r} {text.count(old)} times, not once")
            text = text.replace(old, new)
        logs = {name: log for name, log in zip(LOGS, self.logs_of(data), strict=False)}
        return {"plant.st": text, "params.toml": (data / self.folder / self.parameters).read_text() + self.settings, **logs}

    def exists(self, data: Path) -> bool:
        """Whether all of it is there."""
        return all((data / self.folder / name).is_file() for name in (self.diagram, self.parameters, *(one.file for one in self.logs)))


@dataclass(frozen=True)
class Own:
    """A model of the project, and a piece of a record."""

    model: Model
    cut: Cut

    def logs_of(self, data: Path) -> list[str]:
        """The text of the one log."""
        return [table(self.cut.read(data))]

    def files(self, data: Path) -> dict[str, str]:
        """What a case consists of."""
        return {"plant.st": self.model.text(), "params.toml": parameter_file({}, self.model), "log.csv": self.logs_of(data)[0]}

    def exists(self, data: Path) -> bool:
        """Whether the record is there."""
        return (data / self.cut.file).is_file()


Source = Folder | Own
