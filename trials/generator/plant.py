"""What all plants share: parameters, columns, edges of the diagram, and the injection of effects at edges."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from trials.generator import beyond, effects, outside
from trials.generator.effects import TIME_INVARIANT_LINEAR, Context, Realisation
from trials.generator.grid import Grid

EVERYWHERE = frozenset({"delay", "clock"})
"""Effects that commute with every time-invariant block."""
SLOW_OR_ADDED = frozenset({"offset", "drift", "thermal_drift", "gain_drift", "load", "periodic_disturbance"})
"""Slow against every lag of these plants, or a line that stays a line, so that they commute with a linear block as far as a
record can tell."""


@dataclass
class Injection:
    """One effect at one edge."""

    effect: str
    edge: str
    realisation: Realisation
    size: float
    seed: int
    notes: dict[str, float] = field(default_factory=dict)


class Plant(ABC):
    """A machine with its diagram. A record is drawn once; simulate() may be called with other parameters and effects."""

    name: str
    outputs: tuple[str, ...] = ("Y",)
    units: dict[str, str] = {}
    chain: tuple[str, ...]
    """Edges from the input to the output."""
    linear_between: tuple[bool, ...]
    """Whether the block between two neighbours of the chain is linear and time-invariant."""
    sites: dict[str, tuple[str, ...]]
    """Where each effect may act."""
    aliases: dict[str, tuple[str, ...]]
    """Other names of the same edge."""
    truth: dict[str, float]
    """True values of the tuned parameters, by INSTANCE.PARAMETER."""

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        self.other: np.ndarray | None = None
        self.true_spans: dict[str, float] = {}
        self.kept: dict[tuple[str, int], dict[str, float]] = {}

    @abstractmethod
    def drive(self, x: np.ndarray) -> None:
        """Plays a relative excitation, -1 to 1 on the fine clock, in the plant's own units."""

    def shows_its_turns(self) -> bool:
        """Whether each reversal that changes the machine is one of the samples, too: else no record could tell it."""
        return True

    @abstractmethod
    def diagram(self) -> str:
        """The plant in the product's language."""

    @abstractmethod
    def columns(self, injections: list[Injection]) -> dict[str, np.ndarray]:
        """Inputs as logged, by column."""

    @abstractmethod
    def simulate(
        self, parameters: dict[str, float], injections: list[Injection], grid: Grid | None = None
    ) -> np.ndarray:
        """Outputs at the samples without noise, a column each. A grid with other sub-steps may be given."""

    def internal(self, effect: str) -> tuple[Realisation, ...]:
        """Realisations that belong to this plant alone."""
        return ()

    def realisations(self, effect: str) -> tuple[Realisation, ...]:
        """All realisations of an effect on this plant."""
        return self.internal(effect) or effects.CATALOGUE.get(effect, ()) or outside.CATALOGUE.get(effect, ()) or beyond.CATALOGUE.get(effect, ())

    def tuned(self) -> dict[str, float]:
        """Values that a perfect tuning of the diagram would find."""
        return dict(self.truth)

    def at(self, edge: str, x: np.ndarray, grid: Grid, injections: list[Injection]) -> np.ndarray:
        """Applies what is injected at an edge. The span is that of the undisturbed record, so that sizes keep their meaning."""
        span = self.true_spans.setdefault(edge, float(np.ptp(x)))
        for one in injections:
            if one.edge == edge and not self.internal(one.effect):
                context = self.context(one, grid, span)
                x = one.realisation.apply(x, context, one.size, np.random.default_rng(one.seed))
                one.notes = context.notes
        return x

    def context(self, one: Injection, grid: Grid, span: float) -> Context:
        """Where an injected operator works; what it keeps belongs to this plant."""
        kept = self.kept.setdefault((one.edge, one.seed), {})
        return Context(grid.dt, grid.substeps, span, self.other_on(grid), kept=kept)

    def other_on(self, grid: Grid) -> np.ndarray | None:
        """The second column on the fine clock of a grid."""
        return None if self.other is None else np.interp(grid.fine, self.grid.fine, self.other)

    def refined(self, x: np.ndarray, grid: Grid) -> np.ndarray:
        """A signal of this record's fine clock, on that of another grid whose sub-steps divide this one's."""
        return x[:: self.grid.substeps // grid.substeps]

    def admissible_edges(self, effect: str, edge: str) -> list[str]:
        """All edges that no record could tell from the true one, under all their names."""
        group = {edge}
        if edge in self.chain:
            position = self.chain.index(edge)
            for step in (-1, 1):
                at = position
                while 0 <= at + step < len(self.chain):
                    linear = self.linear_between[min(at, at + step)]
                    commutes = effect in EVERYWHERE or (linear and effect in TIME_INVARIANT_LINEAR | SLOW_OR_ADDED)
                    if not commutes:
                        break
                    at += step
                    group.add(self.chain[at])
        if self.internal(effect) or edge not in self.chain:
            group.update(self.internal_edges(effect))
        return sorted(group | {alias for one in group for alias in self.aliases.get(one, ())})

    def same_as(self, effect: str, edge: str) -> dict[str, tuple[str, ...]]:
        """Other effects, with their edges, that give the very same output with as many parameters."""
        return {}

    def internal_edges(self, effect: str) -> tuple[str, ...]:
        """Edges that name a block's inside, where an effect changes the block itself."""
        return ()


def numbers(x: float) -> str:
    """A literal of the diagram and of the parameter file: always with a point."""
    text = f"{x:.10g}"
    return text if any(mark in text for mark in ".e") else text + ".0"


def literal(x: float) -> str:
    """The same for the diagram, where digits stand on both sides of the point."""
    text = numbers(x)
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = (mantissa if "." in mantissa else mantissa + ".0") + "E" + exponent
    return text
