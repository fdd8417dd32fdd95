"""Control loops with known labels, stiction or none, read from the folder `machines/loops`: each loop is a folder with a log of
OP and PV, the diagram of a valve, a dead time and a lag, a start for tuning, and a README that ends with its label."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trials.measured.sources import Folder, Log

LOOPS = "machines/loops"
TRUTH = re.compile(r"Truth[^:\n]*:\s*([^.\n]*)")
KIND = re.compile(r"Kind:\s*([^.\n]*)")


@dataclass(frozen=True)
class Loop:
    """One loop."""

    name: str
    label: str
    """In the words of its source: stiction, stiction (likely), none: faulty steam sensor, …"""
    kind: str
    """flow, level, …"""
    source: Folder

    @property
    def sticks(self) -> bool:
        """Whether the valve sticks, by its label."""
        return self.label.lower().startswith("stiction")

    @property
    def integrating(self) -> bool:
        """Whether the process integrates: a level does."""
        return self.kind == "level"


def _label(name: str, readme: str) -> str:
    found = TRUTH.search(readme)
    label = found.group(1).strip() if found else ""
    if not re.match(r"(stiction|none|no stiction)\b", label, re.IGNORECASE):
        raise SystemExit(f"{name}/README.md: no label; write a line as “Truth (book's table): stiction.”, or none, or no stiction")
    return label


def _kind(name: str, readme: str) -> str:
    """As the README says, else by the first letter of the instrument's tag: FIC is a flow's controller, LIC a level's."""
    found = KIND.search(readme)
    if found:
        return found.group(1).strip().lower()
    return {"F": "flow", "L": "level", "P": "pressure", "T": "temperature", "A": "analyser"}.get(name[0], "") if re.match("[A-Z]IC", name) else ""


def loops_in(data: Path) -> list[Loop]:
    """All of them. Raises SystemExit where a README has no label."""
    found = []
    for folder in sorted((data / LOOPS).glob("*/")):
        readme = (folder / "README.md").read_text()
        source = Folder(f"{LOOPS}/{folder.name}", "loop.st", "start.toml", (Log("log.csv"),))
        found.append(Loop(folder.name, _label(folder.name, readme), _kind(folder.name, readme), source))
    return found


def signals(log: str) -> tuple[np.ndarray, np.ndarray]:
    """OP and PV of a log."""
    head, *rows = log.strip().splitlines()
    columns = dict(zip((name.strip().upper() for name in head.split(",")), np.array([row.split(",") for row in rows], float).T))
    return columns["OP"], columns["PV"]
