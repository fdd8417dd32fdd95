"""A progress bar on a terminal, and a line at each tenth elsewhere."""

from __future__ import annotations

import sys
import time


class Progress:
    """Counts steps towards a total; what was done before does not count for the estimate."""

    def __init__(self, title: str, total: int, done: int = 0, quiet: bool = False) -> None:
        self.title, self.total, self.done, self.quiet = title, total, done, quiet
        self.first, self.started, self.shown = done, time.monotonic(), -1
        self.bar = sys.stderr.isatty()

    def step(self, note: str = "") -> None:
        """One more is done."""
        self.done += 1
        tenth = 10 * self.done // max(self.total, 1)
        if self.quiet or not (self.bar or tenth > self.shown):
            return
        self.shown = tenth
        pace = (time.monotonic() - self.started) / max(self.done - self.first, 1)
        left = pace * (self.total - self.done)
        filled = 30 * self.done // max(self.total, 1)
        text = f"{self.title} [{'#' * filled}{'.' * (30 - filled)}] {self.done}/{self.total}, {left / 60:.1f} min left {note}"
        print(("\r\x1b[K" if self.bar else "") + text, end="" if self.bar and self.done < self.total else "\n", file=sys.stderr, flush=True)
