"""Rate-independent hysteresis between voltage and displacement, from the literature's own forms.

The loop of the paper is Ramberg and Osgood's: from a branching point (u_i, y_i)

    y - y_i = (y*/u*) (u - u_i) (1 + alpha (|u - u_i| / 2u*)^(gamma - 1)),

and on the virgin curve about the origin the same with u* for 2u*. Only the last branching point counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from trials.generator.operators import play, turning_points


@dataclass(frozen=True)
class Loop:
    """Ramberg and Osgood's loop by its stiffness y*/u*, its alpha and its gamma for u* = 1."""

    stiffness: float
    alpha: float
    gamma: float

    @staticmethod
    def of_slope(c1: float, c2: float, c3: float) -> Loop:
        """The loop whose slope after the travel p is c1 + c2 p^c3: the paper's (17)."""
        gamma = c3 + 1.0
        return Loop(c1, c2 * 2.0 ** (gamma - 1.0) / (gamma * c1), gamma)

    def branch(self, travel: np.ndarray) -> np.ndarray:
        """Height over the branching point, odd in the travel."""
        return self.stiffness * travel * (1.0 + self.alpha * (np.abs(travel) / 2.0) ** (self.gamma - 1.0))

    def virgin(self, u: np.ndarray) -> np.ndarray:
        """The curve that a virgin actuator follows from the origin."""
        return self.stiffness * u * (1.0 + self.alpha * np.abs(u) ** (self.gamma - 1.0))

    def slope(self, travel: np.ndarray) -> np.ndarray:
        """Derivative of the branch."""
        return self.stiffness * (1.0 + self.alpha * self.gamma * (np.abs(travel) / 2.0) ** (self.gamma - 1.0))


def local_memory(u: np.ndarray, loop: Loop) -> np.ndarray:
    """The paper's model: every branch starts anew from the last branching point."""
    turns = turning_points(u)
    y = np.empty_like(u)
    for number, (first, last) in enumerate(zip(turns[:-1], turns[1:])):
        piece = u[first : last + 1]
        y[first : last + 1] = loop.virgin(piece) if number == 0 else y[first] + loop.branch(piece - u[first])
    return y


@dataclass(frozen=True)
class Motion:
    """What a slope may depend on, at the middle of each sub-step."""

    travel: np.ndarray
    """Travel since the last branching point, twice that on the virgin curve."""
    direction: np.ndarray
    u: np.ndarray
    rate: np.ndarray
    branch_start: np.ndarray


def by_slope(u: np.ndarray, dt: float, slope: Callable[[Motion], np.ndarray]) -> np.ndarray:
    """Integral of slope du by the midpoint rule on the fine clock, for slopes that depend on more than the travel."""
    turns = turning_points(u)
    du = np.diff(u)
    middle = 0.5 * (u[1:] + u[:-1])
    start = np.repeat(u[turns[:-1]], np.diff(turns))
    travel = np.abs(middle - start)
    travel[: turns[1]] = 2.0 * np.abs(middle[: turns[1]])
    motion = Motion(travel, np.sign(du), middle, np.abs(du) / dt, start)
    return np.concatenate(([0.0], np.cumsum(slope(motion) * du)))


def return_point(u: np.ndarray, loop: Loop) -> np.ndarray:
    """Masing's rules with wiping-out: a minor loop that closes gives way to the branch that it had left
    (I. D. Mayergoyz, Mathematical Models of Hysteresis, 1991)."""
    turns = turning_points(u)
    y = np.empty_like(u)
    memory: list[tuple[float, float]] = []  # branching points that still count, oldest first
    for first, last in zip(turns[:-1], turns[1:]):
        up = u[last] >= u[first]
        at = first
        if first > 0:
            memory.append((float(u[first]), float(y[first])))
        while at <= last:
            inner = len(memory) >= 2
            limit = memory[-2][0] if inner else (np.inf if not memory else (-memory[-1][0]))
            if not memory:
                y[at : last + 1] = loop.virgin(u[at : last + 1])
                break
            piece = u[at : last + 1]
            beyond = np.flatnonzero(piece > limit) if up else np.flatnonzero(piece < limit)
            stop = last + 1 if len(beyond) == 0 else at + int(beyond[0])
            from_u, from_y = memory[-1]
            y[at:stop] = from_y + loop.branch(u[at:stop] - from_u)
            if stop <= last:
                del memory[-2:]
            at = stop
    return y


def maxwell_slip(u: np.ndarray, loop: Loop, elements: int) -> np.ndarray:
    """The same memory by a finite number of play operators in parallel (Prandtl and Ishlinskii; Maxwell slip):
    weights are the second derivative of the virgin curve, by Gauss-Legendre quadrature."""
    reach = float(np.max(np.abs(u)))
    nodes, weights = np.polynomial.legendre.leggauss(elements)
    turns = turning_points(u)
    y = loop.stiffness * u
    exponent = loop.gamma - 1.0
    for node, weight in zip(nodes, weights):
        z = 0.5 * (node + 1.0)  # r = reach z^3 puts nodes where the density is steep
        r = reach * z**3
        density = loop.stiffness * loop.alpha * loop.gamma * exponent * r ** (exponent - 1.0)
        y = y + density * 0.5 * weight * reach * 3.0 * z * z * play(u, r, turns)
    return y


def relay_preisach(u: np.ndarray, loop: Loop, levels: int) -> np.ndarray:
    """Preisach's relays on a triangular grid, with the density of the same loop; output of each relay is -1 or 1.
    A relay (a, b) with width a - b = 2r has the weight of a play of half-width r, spread over its middle."""
    reach = float(np.max(np.abs(u))) * 1.0001
    edges = np.linspace(-reach, reach, levels + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    step = edges[1] - edges[0]
    turns = turning_points(u)
    exponent = loop.gamma - 1.0
    index = np.arange(levels)
    up_level, down_level = np.meshgrid(index, index, indexing="ij")
    valid = up_level > down_level
    # r from the grid, weight dw(r): a play of half-width r is the sum of relays of half-width r.
    r = 0.5 * (up_level - down_level) * step
    cumulative = loop.stiffness * loop.alpha * loop.gamma
    weight = np.where(
        valid, 0.5 * cumulative * (np.maximum(r + step / 4.0, 0.0) ** exponent - np.maximum(r - step / 4.0, 0.0) ** exponent) * step, 0.0
    )
    state = np.where(middle[up_level] + middle[down_level] <= 0.0, 1.0, -1.0)
    y = loop.stiffness * u
    total = np.empty_like(u)
    total_start = 0.0
    for first, last in zip(turns[:-1], turns[1:]):
        piece = u[first : last + 1]
        up = u[last] >= u[first]
        # The sum of relays as a function of the present level: relays switch in the order of their thresholds.
        if up:
            gain = np.where(state < 0.0, 2.0 * weight, 0.0).sum(axis=1)
            reached = np.concatenate(([0.0], np.cumsum(gain)))
            base = float((state * weight).sum())
            position = np.clip((piece - edges[0]) / step, 0.0, levels)
            done = float(np.interp((u[first] - edges[0]) / step, np.arange(levels + 1), reached))
            total[first : last + 1] = base + np.interp(position, np.arange(levels + 1), reached) - done
            state[(middle[up_level] <= u[last]) & valid] = 1.0
        else:
            loss = np.where(state > 0.0, 2.0 * weight, 0.0).sum(axis=0)
            above = np.concatenate((np.cumsum(loss[::-1])[::-1], [0.0]))
            base = float((state * weight).sum())
            position = np.clip((piece - edges[0]) / step, 0.0, levels)
            done = float(np.interp((u[first] - edges[0]) / step, np.arange(levels + 1), above))
            total[first : last + 1] = base - np.interp(position, np.arange(levels + 1), above) + done
            state[(middle[down_level] >= u[last]) & valid] = -1.0
        if first == 0:
            total_start = float(total[0])
    return y + total - total_start + loop.virgin(u[:1])[0] - loop.stiffness * u[0]
