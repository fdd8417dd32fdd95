"""A piezo stage: voltage, hysteresis with the memory of the last branching point, and at times a lag before or after."""

from __future__ import annotations

import numpy as np

from trials.generator import hysteresis as hy
from trials.generator import operators as op
from trials.generator.effects import Realisation
from trials.generator.grid import Grid
from trials.generator.plant import Injection, Plant, literal


def _slopes(loop: hy.Loop, factor):
    """Slope of the loop with its hysteretic part multiplied by a factor of the motion."""
    return lambda m: loop.stiffness + (loop.slope(m.travel) - loop.stiffness) * factor(m)


def asymmetry(u, c, size, rng, loop):
    """The hysteretic part is larger upwards than downwards."""
    side = rng.choice((-1.0, 1.0)) * size
    c.note(ASYMMETRY=side)
    return hy.by_slope(u, c.dt, _slopes(loop, lambda m: 1.0 + side * m.direction))


def duhem_asymmetry(u, c, size, rng, loop):
    """The exponent differs upwards and downwards, as in a Duhem operator with two curves."""
    side = rng.choice((-1.0, 1.0)) * size
    reach = c.keep("reach", np.max(np.abs(u)))
    return hy.by_slope(
        u, c.dt, _slopes(loop, lambda m: (np.maximum(m.travel, 1e-9 * reach) / reach) ** (0.8 * side * m.direction))
    )


def rate_dependence(u, c, size, rng, loop):
    """The hysteretic part grows with the logarithm of the rate."""
    usual = c.keep("rate", np.median(np.abs(np.diff(u))[np.diff(u) != 0.0]) / c.dt)
    c.note(GROWTH=size)
    low = 1e-3 * usual
    return hy.by_slope(u, c.dt, _slopes(loop, lambda m: 1.0 + size * np.log10(np.maximum(m.rate, low) / usual)))


def power_law_rate(u, c, size, rng, loop):
    """The hysteretic part goes with a small power of the rate, as viscoplastic walls do."""
    usual = c.keep("rate", np.median(np.abs(np.diff(u))[np.diff(u) != 0.0]) / c.dt)
    low = 1e-3 * usual
    return hy.by_slope(u, c.dt, _slopes(loop, lambda m: (np.maximum(m.rate, low) / usual) ** size))


def bias_dependence(u, c, size, rng, loop):
    """The slope depends on the voltage itself."""
    reach = c.keep("reach", np.max(np.abs(u)))
    k = rng.choice((-1.0, 1.0)) * size
    c.note(BIAS=k / reach)
    return hy.by_slope(u, c.dt, lambda m: loop.slope(m.travel) * (1.0 + k * m.u / reach))


def duhem_bias(u, c, size, rng, loop):
    """Duhem's form y' = f(u) M(p) u' with an exponential f, acting on the hysteretic part."""
    reach = c.keep("reach", np.max(np.abs(u)))
    k = rng.choice((-1.0, 1.0)) * 2.0 * size
    return hy.by_slope(u, c.dt, _slopes(loop, lambda m: np.exp(k * m.u / reach)))


def curve_shape(u, c, size, rng, loop):
    """A part of the slope that saturates with the travel."""
    reach = c.keep("reach", np.max(np.abs(u)))
    knee = reach * rng.uniform(0.1, 0.3)
    k = rng.choice((-1.0, 1.0)) * size
    c.note(SHARE=k, KNEE=knee)
    return hy.by_slope(u, c.dt, lambda m: loop.slope(m.travel) + k * loop.stiffness * (1.0 - np.exp(-m.travel / knee)))


def bouc_wen(u, c, size, rng, loop):
    """Bouc and Wen's element in parallel: dz/du = 1 - (beta sgn(u') + gamma) |z| sgn-wise, here without return points."""
    reach = c.keep("reach", np.max(np.abs(u)))
    a = rng.uniform(3.0, 7.0) / reach
    z, out = 0.0, [0.0]
    for du in np.diff(u).tolist():
        z += du - a * (abs(du) * z * 0.7 + du * abs(z) * 0.3)
        out.append(z)
    return hy.local_memory(u, loop) - size * loop.stiffness * np.array(out)


def _blend(memory):
    def apply(u, c, size, rng, loop):
        c.note(SHARE=size)
        local = hy.local_memory(u, loop)
        return local + size * (memory(u, loop, rng) - local)

    return apply


return_point = _blend(lambda u, loop, rng: hy.return_point(u, loop))
maxwell_slip = _blend(lambda u, loop, rng: hy.maxwell_slip(u, loop, int(rng.integers(10, 25))))
preisach = _blend(lambda u, loop, rng: hy.relay_preisach(u, loop, int(rng.integers(50, 90))))

INTERNAL: dict[str, tuple[Realisation, ...]] = {
    "asymmetry": (Realisation("asymmetry", asymmetry, 0.1, 0.9), Realisation("duhem_asymmetry", duhem_asymmetry, 0.1, 0.9, True)),
    "rate_dependence": (
        Realisation("rate_dependence", rate_dependence, 0.1, 0.6),
        Realisation("power_law_rate", power_law_rate, 0.05, 0.4, True),
    ),
    "bias_dependence": (
        Realisation("bias_dependence", bias_dependence, 0.05, 0.6),
        Realisation("duhem_bias", duhem_bias, 0.1, 0.8, True),
    ),
    "curve_shape": (Realisation("curve_shape", curve_shape, 0.1, 1.0), Realisation("bouc_wen", bouc_wen, 0.1, 0.9, True)),
    "return_point_memory": (
        Realisation("return_point", return_point, 0.3, 1.0),
        Realisation("maxwell_slip", maxwell_slip, 0.3, 1.0, True),
        Realisation("relay_preisach", preisach, 0.3, 1.0, True),
    ),
}


class Piezo(Plant):
    """U in V to Y in um."""

    name = "piezo"

    def __init__(self, grid: Grid, rng: np.random.Generator, drive: np.ndarray, other: np.ndarray | None) -> None:
        super().__init__(grid)
        self.other = other
        self.reach = float(rng.uniform(20.0, 80.0))
        self.drive(drive)
        c1 = float(rng.uniform(0.05, 0.2))
        c3 = float(rng.uniform(0.7, 1.5))
        growth = float(rng.uniform(0.25, 0.6))
        self.truth = {"HYST.C1": c1, "HYST.C2": growth * c1 / (2.0 * self.reach) ** c3, "HYST.C3": c3}
        self.place = str(rng.choice(("none", "before", "after"), p=(0.4, 0.2, 0.4)))
        self.time_constant = float(grid.ts * rng.uniform(1.5, 5.0))
        self.zeroed = bool(rng.random() < 0.5)
        if not self.zeroed:
            self.truth["HYST.Y0"] = float(rng.uniform(-1.0, 1.0) * c1 * self.reach)
        lag = {"before": ("AMPLIFIER.XOUT",), "after": (), "none": ()}[self.place]
        sensor = ("SENSOR.XOUT",) if self.place == "after" else ()
        if self.place != "none":
            self.truth[("AMPLIFIER" if lag else "SENSOR") + ".T1"] = self.time_constant
        self.chain = ("U",) + lag + ("HYST.XOUT",) + sensor
        self.linear_between = (True,) * len(lag) + (False,) + (True,) * len(sensor)
        self.aliases = {self.chain[-1]: ("Y",), "U": ("HYST.XIN" if not lag else "AMPLIFIER.XIN",), "HYST.XOUT": ("HYST",)}
        if lag:
            self.aliases["AMPLIFIER.XOUT"] = ("HYST.XIN",)
        if sensor:
            self.aliases["HYST.XOUT"] = ("HYST", "SENSOR.XIN")
        loop, last = "HYST.XOUT", self.chain[-1]
        into = self.chain[self.chain.index(loop) - 1]
        moved = tuple(dict.fromkeys((into, loop)))
        self.sites = {
            "delay": (into, last), "lag": (into, last), "resonance": (last,), "rate_limit": (into,),
            "saturation": (into, last), "dead_zone": (into,), "quantization": (into, last), "backlash": moved,
            "even_nonlinearity": moved, "odd_nonlinearity": moved, "creep": (loop,), "relaxation": (loop,),
            "drift": (last,), "thermal_drift": (last,), "gain_drift": (last,), "periodic_disturbance": (last,),
            "load": (last,), "clock": (last,), "glitches": (last,), "branch_chatter": ("U",),
            **{effect: (loop,) for effect in INTERNAL},
        }  # fmt: skip
        if self.zeroed:
            self.sites["offset"] = (last,)
        if other is not None:
            self.sites["cross_coupling"] = (last,)
        self.outside_sites = (last,)

    def drive(self, x: np.ndarray) -> None:
        """Plays a relative excitation."""
        self.u = self.reach * x

    def into_loop(self, u: np.ndarray, dt: float, parameters: dict[str, float]) -> np.ndarray:
        """What reaches the loop of a voltage, where nothing is injected before it."""
        return op.lag(u, dt, parameters["AMPLIFIER.T1"]) if self.place == "before" else u

    def shows_its_turns(self) -> bool:
        """The loop forgets its branch at the smallest reversal, and one between two samples leaves no trace of itself.
        Behind a lag a reversal of a sample or two comes and goes with the way in which that lag is sampled."""
        fine = self.into_loop(self.u, self.grid.dt, self.truth)
        sampled = (self.grid.sample(fine), self.into_loop(self.grid.sample(self.u), self.grid.ts, self.truth))
        count = len(op.turning_points(fine))
        return all(len(op.turning_points(x)) == count for x in sampled)

    def internal(self, effect: str) -> tuple[Realisation, ...]:
        """Effects that change the loop itself."""
        if effect == "branch_chatter":
            return CHATTER
        return INTERNAL.get(effect, ())

    def internal_edges(self, effect: str) -> tuple[str, ...]:
        """A changed loop is named by either of its sides."""
        at = self.chain.index("HYST.XOUT")
        return (self.chain[at - 1], "HYST.XOUT", "HYST.XIN", "HYST.P", "HYST.SLOPE", "HYST.Q", "HYST")

    def loop(self, parameters: dict[str, float]) -> hy.Loop:
        """The loop of the given parameters."""
        return hy.Loop.of_slope(parameters["HYST.C1"], parameters["HYST.C2"], parameters["HYST.C3"])

    def chatter(self, injections: list[Injection], grid: Grid) -> np.ndarray | None:
        """Noise of the logged voltage at the samples, if the record has any."""
        for one in injections:
            if one.effect == "branch_chatter":
                rng = np.random.default_rng(one.seed)
                one.notes = {"NOISE": one.size * self.reach}
                return one.realisation.apply(self.u[:: self.grid.substeps], None, one.size * self.reach, rng)
        return None

    def columns(self, injections: list[Injection]) -> dict[str, np.ndarray]:
        """Voltage as logged, and the other axis."""
        u = self.grid.sample(self.u)
        chatter = self.chatter(injections, self.grid)
        columns = {"U": u if chatter is None else chatter}
        if self.other is not None:
            columns["V2"] = self.grid.sample(self.other)
        return columns

    def simulate(self, parameters, injections, grid=None):
        """Voltage, amplifier, loop, sensor."""
        grid = grid or self.grid
        u = self.refined(self.u, grid)
        x = self.at("U", u, grid, injections)
        if self.place == "before":
            x = self.at("AMPLIFIER.XOUT", op.lag(x, grid.dt, parameters["AMPLIFIER.T1"]), grid, injections)
        loop = self.loop(parameters)
        y = None
        for one in injections:
            if one.effect in INTERNAL:
                context = self.context(one, grid, 1.0)
                changed = one.realisation.apply(x, context, one.size, np.random.default_rng(one.seed), loop)
                one.notes = context.notes
                y = changed if y is None else y + changed - hy.local_memory(x, loop)
        y = hy.local_memory(x, loop) if y is None else y
        y = self.at("HYST.XOUT", y + parameters.get("HYST.Y0", 0.0), grid, injections)
        if self.place == "after":
            y = self.at("SENSOR.XOUT", op.lag(y, grid.dt, parameters["SENSOR.T1"]), grid, injections)
        return grid.sample(y)[:, None]

    def chattering_model(self, parameters: dict[str, float], injections: list[Injection]) -> np.ndarray:
        """What a model driven by the noisy logged voltage would give: where the gap of branch_chatter comes from."""
        u = self.into_loop(self.columns(injections)["U"], self.grid.ts, parameters)
        y = hy.local_memory(u, self.loop(parameters)) + parameters.get("HYST.Y0", 0.0)
        if self.place == "after":
            y = op.lag(y, self.grid.ts, parameters["SENSOR.T1"])
        return y[:, None]

    def diagram(self) -> str:
        """The stage as an engineer would draw it, with rounded values."""
        p = self.truth
        start = "" if self.zeroed else ", Y0 := 0.0"
        declare = [f"    HYST : HY_HYSTERESIS_RO := (C1 := {literal(round(p['HYST.C1'], 3))}, C2 := 0.0, C3 := 1.0{start});"]
        body = []
        source = "U"
        lag = f"HY_LAG := (T1 := {literal(self.grid.ts)})"
        if self.place == "before":
            declare.insert(0, f"    AMPLIFIER : {lag};")
            body.append("  AMPLIFIER(XIN := U);")
            source = "AMPLIFIER.XOUT"
        body.append(f"  HYST(XIN := {source});")
        end = "HYST.XOUT"
        if self.place == "after":
            declare.append(f"    SENSOR : {lag};")
            body.append("  SENSOR(XIN := HYST.XOUT);")
            end = "SENSOR.XOUT"
        lines = [
            f"FUNCTION_BLOCK STAGE  (* @ts {round(self.grid.ts * 1e6)}us *)",
            "  VAR_INPUT", "    U : LREAL;  (* @unit V *)", "  END_VAR",
            "  VAR_OUTPUT", "    Y : LREAL;  (* @unit um *)", "  END_VAR",
            "  VAR", *declare, "  END_VAR", "", *body, f"  Y := {end};", "END_FUNCTION_BLOCK", "",
        ]  # fmt: skip
        return "\n".join(lines)


def noisy_voltage(u, c, size, rng):
    """The voltage is logged through a sensor with noise, which the branching detector takes for reversals."""
    return u + size * rng.standard_normal(len(u))


def flickering_voltage(u, c, size, rng):
    """The logged voltage flickers between two neighbouring codes of its converter."""
    step = 3.0 * size
    return step * np.round((u + 0.4 * step * rng.standard_normal(len(u))) / step)


CHATTER = (
    Realisation("noisy_voltage", noisy_voltage, 3e-4, 0.02, smallest=1e-4),
    Realisation("flickering_voltage", flickering_voltage, 3e-4, 0.02, True, 1e-4),
)
