"""The tree of effects: families, and the members of each.

A record tells a family more often than a member: dry friction, but not whether by Coulomb or Stribeck. The scorer judges
at both levels. A verdict that states families itself is read as it stands; for one that states effects alone the family
is derived here. Which effects of different families a certain record cannot tell apart, its twins, stands with that record.
"""

from __future__ import annotations

FAMILIES: dict[str, tuple[str, ...]] = {
    "dry_friction": (
        "coulomb_friction", "asymmetric_friction", "stribeck_friction", "presliding_friction", "load_friction", "valve_stiction",
    ),
    "damping": ("viscous_friction",),
    "play": ("backlash", "dead_zone"),
    "loop_memory": ("hysteresis", "asymmetry", "rate_dependence", "return_point_memory", "bias_dependence", "curve_shape"),
    "slow": ("creep", "relaxation", "drift", "thermal_drift", "gain_drift"),
    "linear_dynamics": ("delay", "lag", "second_lag", "resonance", "second_resonance", "zero"),
    "static": ("saturation", "soft_saturation", "even_nonlinearity", "odd_nonlinearity", "absolute_value"),
    "rate": ("rate_limit",),
    "periodic_position": ("cogging", "cyclic_error"),
    "periodic_time": ("periodic_disturbance",),
    "logging": ("clock", "held_samples", "missed_samples", "quantization", "glitches", "stuck_sensor", "branch_chatter"),
    "coupling": ("cross_coupling", "scheduled_gain"),
    "load": ("load", "switched_off"),
    "offset": ("offset",),
    "calibration": ("gain_error", "parameter_mismatch"),
}  # fmt: skip
"""Families in the order of the tree. A dead zone on a speed writes what dry friction does, and is a play all the same."""

_FAMILY_OF = {member: family for family, members in FAMILIES.items() for member in members}


def plain(name: object) -> str:
    """An identifier as the tree has it: small letters, words joined by underscores."""
    return "_".join(str(name).lower().replace("-", " ").replace("_", " ").split())


def family_of(effect: object, stated: object = None) -> str:
    """The family of an effect: as the tree has it; of an effect that is not in the tree, as the verdict states it; else its
    own name, so that an effect without a family is right for no cause but itself."""
    name = plain(effect)
    return _FAMILY_OF.get(name) or (plain(stated) if stated else name)
