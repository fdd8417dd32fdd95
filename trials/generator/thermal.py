"""A heated body and its sensor: two first-order lags, with the measured ambient temperature as a second input."""

from __future__ import annotations

import numpy as np

from trials.generator import operators as op
from trials.generator.grid import Grid
from trials.generator.plant import Plant, literal


class Thermal(Plant):
    """U in W to Y in degC: C dT/dt = P - (T - Ta)/R, seen through a sensor's lag."""

    name = "thermal"

    def __init__(self, grid: Grid, rng: np.random.Generator, drive: np.ndarray, other: np.ndarray | None) -> None:
        super().__init__(grid)
        self.other = other
        self.middle, self.swing = rng.uniform(20.0, 40.0), rng.uniform(10.0, 18.0)
        self.drive(drive)
        s = grid.fine / grid.length
        self.ambient = rng.uniform(15.0, 25.0) + rng.uniform(0.5, 2.0) * np.sin(2.0 * np.pi * (rng.uniform(0.5, 1.5) * s + rng.random()))
        self.truth = {
            "HEATER.K": float(rng.uniform(0.5, 1.5)),
            "BODY.T1": float(grid.ts * rng.uniform(60.0, 150.0)),
            "SENSOR.T1": float(grid.ts * rng.uniform(8.0, 20.0)),
        }
        self.chain = ("U", "HEATER.XOUT", "BODY.XOUT", "SENSOR.XOUT")
        self.linear_between = (True, True, True)
        self.aliases = {
            "U": ("HEATER.XIN",), "HEATER.XOUT": ("BODY.XIN",), "BODY.XOUT": ("SENSOR.XIN",), "SENSOR.XOUT": ("Y",),
        }  # fmt: skip
        self.sites = {
            "delay": ("U", "SENSOR.XOUT"), "lag": ("U", "SENSOR.XOUT"), "resonance": ("SENSOR.XOUT",),
            "rate_limit": ("U",), "saturation": ("U",), "dead_zone": ("HEATER.XOUT",), "quantization": ("SENSOR.XOUT",),
            "backlash": ("U",), "even_nonlinearity": ("U",), "odd_nonlinearity": ("U",), "offset": ("SENSOR.XOUT",),
            "drift": ("SENSOR.XOUT",), "thermal_drift": ("SENSOR.XOUT",), "gain_drift": ("U",),
            "periodic_disturbance": ("SENSOR.XOUT",), "load": ("U",), "clock": ("SENSOR.XOUT",),
            "glitches": ("SENSOR.XOUT",), "relaxation": ("HEATER.XOUT",), "creep": ("HEATER.XOUT",),
        }  # fmt: skip
        del self.sites["dead_zone"]  # the heater works far from zero
        if other is not None:
            self.sites["cross_coupling"] = ("U",)
        self.outside_sites = ("U", "SENSOR.XOUT")

    def drive(self, x):
        """Plays a relative excitation about the working point."""
        self.u = self.middle + self.swing * x

    def columns(self, injections):
        """Heater power, ambient temperature, and the neighbour's power."""
        columns = {"U": self.grid.sample(self.u), "TA": self.grid.sample(self.ambient)}
        if self.other is not None:
            columns["P2"] = 20.0 + 10.0 * self.grid.sample(self.other)
        return columns

    def simulate(self, parameters, injections, grid=None):
        """Power, body, sensor; linear between, so exactly discretised."""
        grid = grid or self.grid
        u = self.at("U", self.refined(self.u, grid), grid, injections)
        rise = self.at("HEATER.XOUT", parameters["HEATER.K"] * u, grid, injections)
        body = op.lag(rise + self.refined(self.ambient, grid), grid.dt, parameters["BODY.T1"])
        body = self.at("BODY.XOUT", body, grid, injections)
        y = self.at("SENSOR.XOUT", op.lag(body, grid.dt, parameters["SENSOR.T1"]), grid, injections)
        return grid.sample(y)[:, None]

    def diagram(self) -> str:
        """The process as an engineer would draw it."""
        return "\n".join([
            f"FUNCTION_BLOCK HEATED_BODY  (* @ts {round(self.grid.ts * 1e3)}ms *)",
            "  VAR_INPUT", "    U  : LREAL;  (* @unit W *)", "    TA : LREAL;  (* @unit degC *)", "  END_VAR",
            "  VAR_OUTPUT", "    Y : LREAL;  (* @unit degC *)", "  END_VAR",
            "  VAR", "    HEATER : HY_GAIN := (K := 1.0);", f"    BODY   : HY_LAG  := (T1 := {literal(100.0 * self.grid.ts)});",
            f"    SENSOR : HY_LAG  := (T1 := {literal(10.0 * self.grid.ts)});", "  END_VAR", "",
            "  HEATER(XIN := U);", "  BODY(XIN := HEATER.XOUT + TA);", "  SENSOR(XIN := BODY.XOUT);", "  Y := SENSOR.XOUT;",
            "END_FUNCTION_BLOCK", "",
        ])  # fmt: skip
