"""Two tanks, one over the other, each emptying by Torricelli's law: A h' = inflow - a sqrt(2 g h)."""

from __future__ import annotations

import numpy as np

from trials.generator.effects import Realisation
from trials.generator.grid import Grid
from trials.generator.plant import Injection, Plant, literal


def overflow(x, c, size, rng):
    """Placeholder for the catalogue: the brim is inside the differential equation."""
    return x


OVERFLOW = (Realisation("overflow", overflow, 0.2, 0.7),)


class Tanks(Plant):
    """U in V to the lower level Y in cm; the pump's command is held between samples."""

    name = "tanks"

    def __init__(self, grid: Grid, rng: np.random.Generator, drive: np.ndarray, other: np.ndarray | None) -> None:
        super().__init__(grid)
        self.other = other
        self._tuned: dict[str, float] | None = None
        self.middle, self.swing = rng.uniform(4.5, 6.0), rng.uniform(1.5, 2.4)
        self.drive(drive)
        # Flows per area, so that areas cancel: level in cm, time in seconds.
        fast = 1.0 / (grid.ts * rng.uniform(250.0, 450.0))  # 1/(time constant) of a tank at the middle level
        h1, h2 = rng.uniform(8.0, 12.0), rng.uniform(8.0, 12.0)
        a1, a2 = 2.0 * fast * np.sqrt(h1), 2.0 * fast * rng.uniform(0.8, 1.3) * np.sqrt(h2)
        self.truth = {"PUMP.K": float(a1 * np.sqrt(h1) / self.middle), "UPPER.K": float(a1), "LOWER.K": float(a2)}
        start = float(self.u[0])
        self.h1_start = round(float((self.truth["PUMP.K"] * start / a1) ** 2), 6)
        self.h2_start = round(float(self.h1_start * (a1 / a2) ** 2), 6)
        self.q_start = round(float(a1 * np.sqrt(self.h1_start)), 8)
        self.chain = ("U", "PUMP.XOUT", "H1", "UPPER.XOUT", "H2")
        self.linear_between = (True, False, False, False)
        self.aliases = {
            "U": ("PUMP.XIN",), "H1": ("LEVEL1.XOUT", "ROOT1.XIN", "ROOT1.XOUT"), "PUMP.XOUT": ("LEVEL1.XIN",),
            "UPPER.XOUT": ("LEVEL2.XIN", "ROOT1.XOUT", "UPPER.XIN"), "H2": ("Y", "LEVEL2.XOUT"),
        }  # fmt: skip
        self.sites = {
            "delay": ("U", "H2"), "lag": ("U", "H2"), "rate_limit": ("U",), "saturation": ("U", "H1"),
            "quantization": ("H2",), "backlash": ("U",), "even_nonlinearity": ("U",), "odd_nonlinearity": ("U",),
            "offset": ("H2",), "drift": ("H2",), "thermal_drift": ("H2",), "gain_drift": ("U",),
            "periodic_disturbance": ("H2",), "load": ("PUMP.XOUT",), "clock": ("H2",), "glitches": ("H2",),
        }  # fmt: skip
        if other is not None:
            self.sites["cross_coupling"] = ("PUMP.XOUT",)
        self.outside_sites = ("U", "H2")

    def drive(self, x):
        """Plays a relative excitation about the working point, held between samples."""
        self.u = self.grid.hold(np.round(self.grid.sample(self.middle + self.swing * x), 6))

    def tuned(self):
        """What tuning a diagram that integrates by Euler's rule finds on this plant: two Gauss-Newton steps."""
        if self._tuned is None:
            wanted = self.simulate(self.truth, [])[:, 0]
            values = np.array(list(self.truth.values()))
            for _ in range(2):
                base = self._euler(values)
                columns = [(self._euler(values * (1.0 + 1e-4 * np.eye(3)[i])) - base) / 1e-4 for i in range(3)]
                values = values * (1.0 + np.linalg.lstsq(np.column_stack(columns), wanted - base, rcond=None)[0])
            self._tuned = dict(zip(self.truth, values.tolist()))
        return dict(self._tuned)

    def _euler(self, values: np.ndarray) -> np.ndarray:
        pump, upper, lower = values.tolist()
        h1, h2, ts, out = self.h1_start, self.h2_start, self.grid.ts, []
        before = self.q_start
        for u in self.grid.sample(self.u).tolist():
            flow = upper * max(h1, 0.0) ** 0.5
            h2 += ts * (0.5 * (flow + before) - lower * max(h2, 0.0) ** 0.5)
            out.append(h2)
            h1 += ts * (pump * u - flow)
            before = flow
        return np.array(out)

    def internal_edges(self, effect: str) -> tuple[str, ...]:
        """The brim may be named at the level or at what feeds it."""
        return ("H1", "LEVEL1.XOUT", "LEVEL1.XIN", "UPPER.XOUT")

    def columns(self, injections):
        """Pump command, and the pump of another line."""
        columns = {"U": self.grid.sample(self.u)}
        if self.other is not None:
            columns["U2"] = self.grid.sample(5.0 + 2.0 * self.other)
        return columns

    def at(self, edge, x, grid, injections):
        """The brim of the upper tank is no operator on a signal."""
        return super().at(edge, x, grid, [one for one in injections if (one.effect, one.edge) != ("saturation", "H1")])

    def simulate(self, parameters, injections: list[Injection], grid=None):
        """Heun's rule in each sub-step."""
        grid = grid or self.grid
        u = self.at("U", self.refined(self.u, grid), grid, injections)
        inflow = self.at("PUMP.XOUT", parameters["PUMP.K"] * u, grid, injections)
        brim = np.inf
        for one in injections:
            if (one.effect, one.edge) == ("saturation", "H1"):
                undisturbed = self.true_spans.get("H1", 0.0)
                low = self.true_spans.get("H1.low", 0.0)
                brim = low + undisturbed * (1.0 - one.size)
                one.notes = {"MX": brim}
        upper, lower = parameters["UPPER.K"], parameters["LOWER.K"]
        h1, h2, dt = self.h1_start, self.h2_start, grid.dt
        first, second = [h1], [h2]
        for q in inflow[:-1].tolist():
            out1, out2 = upper * h1**0.5, lower * h2**0.5
            p1 = h1 + dt * (q - out1)
            p2 = h2 + dt * (out1 - out2)
            next1 = upper * (p1 if p1 > 0.0 else 0.0) ** 0.5
            h1 += 0.5 * dt * (2.0 * q - out1 - next1)
            h2 += 0.5 * dt * (out1 + next1 - out2 - lower * (p2 if p2 > 0.0 else 0.0) ** 0.5)
            h1 = brim if h1 > brim else (h1 if h1 > 1e-9 else 1e-9)
            h2 = h2 if h2 > 1e-9 else 1e-9
            first.append(h1)
            second.append(h2)
        if "H1" not in self.true_spans:
            self.true_spans["H1"] = float(np.ptp(first))
            self.true_spans["H1.low"] = float(np.min(first))
        y = self.at("H2", np.array(second), grid, injections)
        return grid.sample(y)[:, None]

    def diagram(self) -> str:
        """The cascade as an engineer would draw it: levels are the start and what has flowed in since."""
        return "\n".join([
            f"FUNCTION_BLOCK CASCADE  (* @ts {round(self.grid.ts * 1e3)}ms *)",
            "  VAR_INPUT", "    U : LREAL;  (* @unit V *)", "  END_VAR",
            "  VAR_OUTPUT", "    Y : LREAL;  (* @unit cm *)", "  END_VAR",
            "  VAR", "    PUMP   : HY_GAIN := (K := 0.01);", "    LEVEL1 : HY_INTEGRAL_FORWARD;", "    H1     : LREAL;",
            "    ROOT1  : HY_SQRT;", "    UPPER  : HY_GAIN := (K := 0.01);",
            f"    BEFORE : HY_DELAY := (X0 := {literal(self.q_start)});", f"    HELD   : HY_DELAY := (X0 := {literal(self.h2_start)});",
            "    ROOT2  : HY_SQRT;", "    LOWER  : HY_GAIN := (K := 0.01);", "    LEVEL2 : HY_INTEGRAL;", "    H2     : LREAL;",
            "  END_VAR", "",
            "  PUMP(XIN := U);", f"  H1 := {literal(self.h1_start)} + LEVEL1.XOUT;", "  ROOT1(XIN := MAX(H1, 0.0));",
            "  UPPER(XIN := ROOT1.XOUT);", "  LEVEL1(XIN := PUMP.XOUT - UPPER.XOUT);", "  ROOT2(XIN := MAX(HELD.XOUT, 0.0));",
            "  LOWER(XIN := ROOT2.XOUT);", "  LEVEL2(XIN := 0.5 * (UPPER.XOUT + BEFORE.XOUT) - LOWER.XOUT);",
            "  BEFORE(XIN := UPPER.XOUT);", f"  H2 := {literal(self.h2_start)} + LEVEL2.XOUT;", "  HELD(XIN := H2);",
            "  Y := H2;", "END_FUNCTION_BLOCK", "",
        ])  # fmt: skip
