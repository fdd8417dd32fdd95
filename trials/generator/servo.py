"""A servo axis, J x'' = k u - B x' - friction, driven by a held current; open loop, or closed by a digital controller."""

from __future__ import annotations

import math

import numpy as np

from trials.generator import friction as fr
from trials.generator.beyond import IN_A_LOOP
from trials.generator.effects import Realisation
from trials.generator.grid import Grid
from trials.generator.plant import Injection, Plant, literal


class Axis:
    """The axis in continuous time: exact for a force that stands through a sub-step, with the instant of rest found by the
    change of sign of the speed, and sticking by the drive that is then too weak."""

    def __init__(self, dt: float, damping: float, law: fr.Law | None, cogging: tuple[float, float, int] | None) -> None:
        self.dt, self.damping, self.law, self.cogging = dt, damping, law, cogging
        self.keep, self.take = self.over(dt)
        self.x = self.v = 0.0

    def run(self, drive: list[float]) -> tuple[list[float], list[float]]:
        """Positions and speeds after each of the sub-steps."""
        keep, take, half = self.keep, self.take, 0.5 * self.dt
        x, v, law, cogging = self.x, self.v, self.law, self.cogging
        positions, speeds = [], []
        force = law.force if law else None
        breakaway = law.breakaway if law else 0.0
        for f in drive:
            if cogging:
                torque, teeth, harmonics = cogging
                angle = teeth * x
                f -= torque * math.sin(angle)
                if harmonics > 1:
                    f -= 0.3 * torque * math.sin(2.0 * angle + 0.7)
            if breakaway > 0.0:
                travel, v = self.through_rest(v, f)
            else:
                before = v
                v = keep * v + take * (f - force(v) if force else f)
                travel = half * (before + v)
            x += travel
            positions.append(x)
            speeds.append(v)
        self.x, self.v = x, v
        return positions, speeds

    def over(self, time: float) -> tuple[float, float]:
        """What is kept of a speed after a time, and what of it a unit of force gives."""
        keep = math.exp(-self.damping * time)
        return keep, (1.0 - keep) / self.damping if self.damping > 0.0 else time

    def through_rest(self, v: float, drive: float) -> tuple[float, float]:
        """Travel in a sub-step, and the speed after it, under dry friction. Where the speed passes 0 the axis stands, and
        goes on from there in what is left of the sub-step if the drive exceeds what breaks it loose."""
        travel, left, law = 0.0, self.dt, self.law
        keep, take = self.keep, self.take
        for _ in range(2):
            if v == 0.0 and abs(drive) <= law.breakaway:
                return travel, 0.0
            friction = law.force(v) if v != 0.0 else math.copysign(law.breakaway, drive)
            end = keep * v + take * (drive - friction)
            if end * v >= 0.0:
                return travel + 0.5 * left * (v + end), end
            until = left * v / (v - end)  # the speed is a straight line within so short a time
            travel += 0.5 * until * v
            left -= until
            keep, take = self.over(left)
            v = 0.0
        return travel, v


def _none(x, c, size, rng):
    """Friction and cogging are inside the differential equation, not on a signal."""
    return x


PLAIN = ("delay", "lag", "rate_limit", "saturation", "dead_zone", "quantization")
"""Effects that the amplifier of the closed loop knows in one form."""

INTERNAL: dict[str, tuple[Realisation, ...]] = {
    "coulomb_friction": (
        Realisation("coulomb", _none, 0.01, 0.3),
        Realisation("dahl", _none, 0.01, 0.3, True),
        Realisation("maxwell_slip", _none, 0.01, 0.3, True),
        Realisation("tanh_friction", _none, 0.01, 0.3, True),
    ),
    "stribeck_friction": (
        Realisation("stribeck", _none, 0.01, 0.3),
        Realisation("lugre", _none, 0.01, 0.3, True),
        Realisation("hyperbolic_stribeck", _none, 0.01, 0.3, True),
    ),
    "viscous_friction": (Realisation("viscous", _none, 0.02, 0.5), Realisation("viscous_power", _none, 0.02, 0.5, True)),
    "cogging": (Realisation("cogging", _none, 0.01, 0.3), Realisation("cogging_harmonics", _none, 0.01, 0.3, True)),
}


class Servo(Plant):
    """U in A to Y, a position in rad or a speed in rad/s."""

    name = "servo"

    def __init__(
        self, grid: Grid, rng: np.random.Generator, drive: np.ndarray, other: np.ndarray | None, quantity: str, damped: bool
    ) -> None:
        super().__init__(grid)
        self.other, self.quantity, self.damped = other, quantity, damped
        self.level = float(rng.uniform(1.0, 6.0)) * (1.0 if damped else 0.6)
        self.drive(drive)
        self.largest = float(np.max(np.abs(self.u)))
        self.gain = float(rng.uniform(40.0, 200.0) / self.largest)  # rad/s^2 per A
        self.damping = float(rng.uniform(1.5, 5.0)) if damped else 0.0
        self.truth = {"MOTOR.K": self.gain} | ({"DAMPING.K": self.damping} if damped else {})
        self._edges()
        into, last = "U", self.chain[-1]
        self.sites = {
            "delay": (into, last), "lag": (into, last), "resonance": (last,), "rate_limit": (into,), "saturation": (into,),
            "dead_zone": (into,), "quantization": (last,), "offset": (into,), "even_nonlinearity": (into,),
            "odd_nonlinearity": (into,), "gain_drift": (into,), "periodic_disturbance": (into,), "load": (into,),
            "drift": (last,), "thermal_drift": (last,), "clock": (last,), "glitches": (last,),
            "coulomb_friction": (into,), "stribeck_friction": (into,), "cogging": (into,),
        }  # fmt: skip
        if quantity == "position":
            self.sites["backlash"] = (last,)
        else:
            del self.sites["cogging"]  # the diagram has no position that the torque could depend on
        if not damped:
            self.sites["viscous_friction"] = (into,)
        if other is not None:
            self.sites["cross_coupling"] = (into, last)
        self.outside_sites = (into, last)

    def drive(self, x):
        """Plays a relative excitation, held between samples."""
        self.u = self.grid.hold(np.round(self.level * self.grid.sample(x), 9))

    def _edges(self) -> None:
        last = "POS.XOUT" if self.quantity == "position" else "VEL.XOUT"
        self.chain = ("U", "MOTOR.XOUT", "VEL.XOUT") + (("POS.XOUT",) if last == "POS.XOUT" else ())
        self.linear_between = (True,) * (len(self.chain) - 1)
        self.aliases = {"U": ("MOTOR.XIN",), "MOTOR.XOUT": ("VEL.XIN", "ACC"), last: ("Y",)}

    def admissible_edges(self, effect, edge):
        """A pure integrator does not let offsets and drifts through unchanged; forces act anywhere before it."""
        edges = set(super().admissible_edges(effect, edge))
        if effect in ("offset", "drift", "thermal_drift", "gain_drift", "load"):
            forces = {"U", "MOTOR.XIN", "MOTOR.XOUT", "VEL.XIN", "ACC"}
            edges = edges | forces if edge == "U" else edges - forces
            if edge == "U":
                edges -= {"VEL.XOUT", "POS.XOUT", "Y"}
        return sorted(edges)

    def same_as(self, effect, edge):
        """On an axis without damping a constant force is a linear drift of the speed."""
        return {"drift": ("VEL.XOUT", "Y")} if effect == "offset" and edge == "U" and not self.damped else {}

    def internal(self, effect):
        """Friction and cogging."""
        return INTERNAL.get(effect, ())

    def internal_edges(self, effect):
        """A force that depends on the motion may be named at the force or at what it depends on."""
        return ("U", "MOTOR.XIN", "MOTOR.XOUT", "ACC", "VEL.XIN", "VEL.XOUT", "DAMPING.XIN", "DAMPING.XOUT", "POS.XOUT")

    def tuned(self):
        """The diagram integrates the damping by Euler's rule; tuning it on this plant would find these values."""
        ts = self.grid.ts
        if self.damping == 0.0:
            return dict(self.truth)
        euler = (1.0 - math.exp(-self.damping * ts)) / ts
        return {"MOTOR.K": self.truth["MOTOR.K"] * euler / self.damping, "DAMPING.K": euler}

    def columns(self, injections):
        """Current command, and the other axis."""
        columns = {"U": self.grid.sample(self.u)}
        if self.other is not None:
            columns["I2"] = self.grid.sample(self.other)
        return columns

    def inside(self, parameters, injections: list[Injection], grid: Grid) -> Axis:
        """The axis with the friction laws that are injected."""
        level = self.truth["MOTOR.K"] * float(np.max(np.abs(self.u)))
        fast = self.true_spans.get("speed", 1.0)
        law, cogging = None, None
        for one in injections:
            if one.effect not in INTERNAL:
                continue
            rng = np.random.default_rng(one.seed)
            f = one.size * level
            kind = one.realisation.name
            slow = fast * rng.uniform(0.01, 0.04)
            stiff = f / (fast * rng.uniform(0.0005, 0.002))
            if kind.startswith("cogging"):
                teeth = max(round(rng.uniform(15.0, 40.0) / self.true_spans.get("position", 1.0)), 1)
                cogging = (f, float(teeth), 2 if kind.endswith("harmonics") else 1)
                one.notes = {"AMPLITUDE": f, "TEETH": teeth}
            elif kind == "coulomb":
                law, one.notes = fr.coulomb(f), {"FC": f}
            elif kind == "dahl":
                law = fr.dahl(f, stiff, grid.dt)
            elif kind == "maxwell_slip":
                law = fr.maxwell_slip(f, stiff, grid.dt)
            elif kind == "tanh_friction":
                law = fr.tanh_friction(f, slow)
            elif kind == "viscous":
                law, one.notes = fr.viscous(f / fast), {"B": f / fast}
            elif kind == "viscous_power":
                power = rng.uniform(0.85, 1.2)
                law = fr.viscous(f / fast**power, power)
            elif kind == "lugre":
                law = fr.lugre(0.6 * f, f, 3.0 * slow, stiff, 2.0 * math.sqrt(stiff) * 0.3, grid.dt)
            else:
                shape = fr.stribeck if kind == "stribeck" else fr.hyperbolic_stribeck
                law, one.notes = shape(0.6 * f, f, 3.0 * slow), {"FC": 0.6 * f, "FS": f, "VS": 3.0 * slow}
        return Axis(grid.dt, parameters.get("DAMPING.K", 0.0), law, cogging)

    def simulate(self, parameters, injections, grid=None):
        """Open loop: the whole drive is known beforehand."""
        grid = grid or self.grid
        u = self.refined(self.u, grid)
        u = self.at("U", u, grid, injections)
        axis = self.inside(parameters, injections, grid)
        positions, speeds = axis.run((parameters["MOTOR.K"] * u[:-1]).tolist())
        if "speed" not in self.true_spans:
            self.true_spans["speed"] = max(float(np.max(np.abs(speeds))), 1e-9)
            self.true_spans["position"] = max(float(np.ptp(positions)), 1e-9)
        y = np.concatenate(([0.0], positions if self.quantity == "position" else speeds))
        y = self.at(self.chain[-1], y, grid, injections)
        return grid.sample(y)[:, None]

    def _motion(self) -> tuple[list[str], list[str]]:
        declare = ["    MOTOR   : HY_GAIN := (K := 10.0);", "    VEL     : HY_INTEGRAL_FORWARD;"]
        into = "MOTOR.XOUT"
        body = []
        if self.damped:
            declare.append("    DAMPING : HY_GAIN := (K := 1.0);")
            body.append("  DAMPING(XIN := VEL.XOUT);")
            into = "MOTOR.XOUT - DAMPING.XOUT"
        if self.quantity == "position":
            declare += ["    BEFORE  : HY_DELAY;", "    POS     : HY_INTEGRAL;"]
            # The mean of the speeds at both ends is exact for a force that stands through the step.
            body += ["  POS(XIN := 0.5 * (VEL.XOUT + BEFORE.XOUT));", "  BEFORE(XIN := VEL.XOUT);"]
        end = "POS.XOUT" if self.quantity == "position" else "VEL.XOUT"
        body += [f"  Y := {end};", "  MOTOR(XIN := U);", f"  VEL(XIN := {into});"]
        return declare, body

    def diagram(self) -> str:
        """The axis as an engineer would draw it."""
        declare, body = self._motion()
        unit = "rad" if self.quantity == "position" else "rad/s"
        return "\n".join([
            f"FUNCTION_BLOCK AXIS  (* @ts {round(self.grid.ts * 1e6)}us *)",
            "  VAR_INPUT", "    U : LREAL;  (* @unit A *)", "  END_VAR",
            "  VAR_OUTPUT", f"    Y : LREAL;  (* @unit {unit} *)", "  END_VAR",
            "  VAR", *declare, "  END_VAR", "", *body, "END_FUNCTION_BLOCK", "",
        ])  # fmt: skip


class ClosedLoop(Servo):
    """REF in rad to Y in rad and U in A: the axis with its digital PID controller, which the record holds exactly."""

    name = "closed_loop"
    outputs = ("Y", "U")

    def __init__(self, grid: Grid, rng: np.random.Generator, drive: np.ndarray, other: np.ndarray | None) -> None:
        super().__init__(grid, rng, drive, other, "position", damped=True)
        self.drive(drive)
        bandwidth = 1.0 / (grid.ts * rng.uniform(20.0, 30.0))
        self.gain = float(rng.uniform(20.0, 80.0))
        self.truth = {"MOTOR.K": self.gain, "DAMPING.K": self.damping}
        self.kp = float(f"{bandwidth**2 / self.gain:.6g}")
        self.kd = float(f"{1.4 * bandwidth / self.gain:.6g}")
        self.ki = float(f"{0.15 * bandwidth**3 / self.gain:.6g}")
        keep = {"delay", "lag", "rate_limit", "saturation", "dead_zone", "offset", "gain_drift", "periodic_disturbance", "load"}
        keep |= {"coulomb_friction", "stribeck_friction", "cogging", "cross_coupling"}
        self.sites = {effect: ("U",) for effect in self.sites if effect in keep}
        self.sites["quantization"] = ("POS.XOUT",)
        self.outside_sites = ()
        self.simulate(self.truth, [])

    def drive(self, x):
        """Plays a relative excitation as the reference."""
        self.reference = np.round(0.3 * self.level * self.grid.sample(x), 9)
        self.u = self.reference

    def realisations(self, effect):
        """What the amplifier does to a current exists in the plain form only."""
        return tuple(one for one in super().realisations(effect) if one.name == effect or effect not in PLAIN)

    def columns(self, injections):
        """Reference, and the other axis."""
        columns = {"REF": self.reference}
        if self.other is not None:
            columns["I2"] = self.grid.sample(self.other)
        return columns

    def simulate(self, parameters, injections, grid=None, measure=None):
        """The loop, sample by sample; `measure(k, y)` is the sensor inside it. The amplifier works on the fine clock."""
        grid = grid or self.grid
        axis = self.inside(parameters, injections, grid)
        amplifier = Amplifier(self, injections, grid)
        gain, ts, last, total, y = parameters["MOTOR.K"], grid.ts, 0.0, 0.0, 0.0
        step = next((one.size * self.true_spans["Y"] for one in injections if one.effect == "quantization"), 0.0)
        ys, us, speeds = [], [], [0.0]
        for k, reference in enumerate(self.reference.tolist()):
            seen = step * round(y / step) if step > 0.0 else y
            seen = measure(k, seen) if measure else seen
            error = reference - seen
            total += ts * error
            u = self.kp * error + self.ki * total - self.kd * (seen - last) / ts
            last = seen
            ys.append(seen)
            us.append(u)
            drive = [gain * value for value in amplifier.run(u)]
            positions, moved = axis.run(drive)
            y = positions[-1]
            speeds.append(moved[-1])
        if "Y" not in self.true_spans:
            self.true_spans.update(Y=float(np.ptp(ys)), U=float(np.ptp(us)), speed=float(np.max(np.abs(speeds))), position=float(np.ptp(ys)))
            self.true_spans["slew"] = float(np.quantile(np.abs(np.diff(us)), 0.99))
            self.largest = float(np.max(np.abs(us)))
        return np.column_stack((ys, us))

    def diagram(self) -> str:
        """Plant and controller together."""
        declare, _ = self._motion()
        declare += ["    E       : LREAL;  (* @unit rad *)", "    SUM     : HY_INTEGRAL;", "    SPEED   : HY_DERIVATIVE;"]
        declare += [f"    {name.upper()}      : HY_GAIN := (K := {literal(getattr(self, name))});" for name in ("kp", "ki", "kd")]
        # Outputs of memory alone come first: the axis answers to the current of the step before.
        order = ["  DAMPING(XIN := VEL.XOUT);", "  POS(XIN := 0.5 * (VEL.XOUT + BEFORE.XOUT));", "  BEFORE(XIN := VEL.XOUT);"]
        control = [
            "  Y := POS.XOUT;", "  E := REF - Y;", "  SUM(XIN := E);",
            "  SPEED(XIN := Y);", "  KP(XIN := E);", "  KI(XIN := SUM.XOUT);", "  KD(XIN := SPEED.XOUT);",
            "  U := KP.XOUT + KI.XOUT - KD.XOUT;", "  MOTOR(XIN := U);", "  VEL(XIN := MOTOR.XOUT - DAMPING.XOUT);",
        ]  # fmt: skip
        return "\n".join([
            f"FUNCTION_BLOCK LOOP  (* @ts {round(self.grid.ts * 1e6)}us *)",
            "  VAR_INPUT", "    REF : LREAL;  (* @unit rad *)", "  END_VAR",
            "  VAR_OUTPUT", "    Y : LREAL;  (* @unit rad *)", "    U : LREAL;", "  END_VAR",
            "  VAR", *declare, "  END_VAR", "", *order, *control, "END_FUNCTION_BLOCK", "",
        ])  # fmt: skip


class Amplifier:
    """What the injected effects make of the controller's current, on the fine clock: late, limited, lagged, disturbed."""

    def __init__(self, loop: ClosedLoop, injections: list[Injection], grid: Grid) -> None:
        n = len(grid.fine)
        self.gain, self.add = np.ones(n + grid.substeps), np.zeros(n + grid.substeps)
        self.late, self.alpha, self.slew = 0, 1.0, math.inf
        self.low, self.high, self.width = -math.inf, math.inf, 0.0
        self.history: list[float] = []
        self.at = 0
        self.held = 0.0
        self.followed = 0.0
        self.substeps = grid.substeps
        self.idle = not any(one.effect not in INTERNAL and one.effect != "quantization" for one in injections)
        span = loop.true_spans.get("U", 1.0)
        for one in injections:
            rng = np.random.default_rng(one.seed)
            self._add(one, loop, grid, span, rng)

    def _add(self, one: Injection, loop: ClosedLoop, grid: Grid, span: float, rng: np.random.Generator) -> None:
        size = one.size
        if one.effect == "delay":
            self.late = max(round(size * grid.substeps), 0)
            one.notes = {"DEAD_TIME": self.late * grid.dt}
        elif one.effect == "lag":
            self.alpha = 1.0 - math.exp(-1.0 / (size * grid.substeps))
            one.notes = {"T1": size * grid.ts}
        elif one.effect == "rate_limit":
            asked = loop.true_spans["slew"] / grid.substeps
            self.slew = asked * 10.0 ** (2.0 * (0.3 - size))
            one.notes = {"RISE": self.slew / grid.dt}
        elif one.effect == "saturation":
            self.high = loop.largest * (1.0 - size)
            self.low = -self.high
            one.notes = {"MX": self.high}
        elif one.effect == "dead_zone":
            self.width = size * span
            one.notes = {"WIDTH": self.width}
        elif one.effect in ("offset", "gain_drift", "periodic_disturbance", "load", "cross_coupling", IN_A_LOOP):
            # What is added to the current, or multiplies it, by the catalogue's own operator on a constant.
            base = 1.0 if one.effect in ("gain_drift", IN_A_LOOP) else 0.0
            context = loop.context(one, grid, 1.0 if base else span)
            made = one.realisation.apply(np.full(len(grid.fine), base), context, size, rng)
            made = np.append(made, np.full(grid.substeps, made[-1]))
            if base:
                self.gain *= made
            else:
                self.add += made
            one.notes = context.notes

    def run(self, u: float) -> list[float]:
        """The current through one sampling interval."""
        if self.idle:
            return [u] * self.substeps
        out = []
        history, late, alpha, slew, width = self.history, self.late, self.alpha, self.slew, self.width
        gain, add = self.gain, self.add
        for _ in range(self.substeps):
            if late:
                history.append(u)
                value = history[self.at - late] if self.at >= late else 0.0
            else:
                value = u
            value = self.high if value > self.high else (self.low if value < self.low else value)
            if width:
                value = value - width if value > width else (value + width if value < -width else 0.0)
            step = value - self.held
            self.held += slew if step > slew else (-slew if step < -slew else step)
            self.followed += alpha * (self.held - self.followed)
            out.append(self.followed * gain[self.at] + add[self.at])
            self.at += 1
        return out
