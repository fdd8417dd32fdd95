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
    "viscous_friction": ("viscous_friction",),
    "play": ("backlash", "dead_zone"),
    "hysteresis": ("asymmetry", "rate_dependence", "return_point_memory", "bias_dependence", "curve_shape", "branch_chatter"),
    "slow_memory": ("creep", "relaxation"),
    "slow_change": ("drift", "thermal_drift", "gain_drift"),
    "linear_dynamics": ("delay", "lag", "second_lag", "resonance", "second_resonance", "zero"),
    "static_curve": ("saturation", "saturating_curve", "even_nonlinearity", "odd_nonlinearity", "blind_to_direction"),
    "rate_limit": ("rate_limit",),
    "periodic_over_position": ("cogging", "cyclic_error"),
    "periodic_in_time": ("periodic_disturbance",),
    "logging": ("clock", "held_values", "missed_samples", "quantization", "glitches", "stuck_sensor"),
    "coupling": ("cross_coupling", "scheduled_gain", "cutout"),
    "load": ("load",),
    "offset": ("offset",),
    "calibration": ("gain_error", "parameter_mismatch"),
}  # fmt: skip
"""Families in the order of the tree. A dead zone on a speed writes what dry friction does, and is a play all the same."""

OTHER_NAMES = {
    "static": "static_curve", "viscous": "viscous_friction", "periodic_in_place": "periodic_over_position", "periodic_position": "periodic_over_position",
    "periodic_time": "periodic_in_time", "memory": "hysteresis", "rate": "rate_limit",
}  # fmt: skip
"""By which a verdict may call a family."""

_FAMILY_OF = {member: family for family, members in FAMILIES.items() for member in members}


def plain(name: object) -> str:
    """An identifier as the tree has it: small letters, words joined by underscores."""
    return "_".join(str(name).lower().replace("-", " ").replace("_", " ").split())


def stated_family(name: object) -> str:
    """A family as a verdict calls it, by its name in the tree; one that the tree has not keeps its own."""
    return OTHER_NAMES.get(plain(name), plain(name))


def family_of(effect: object, stated: object = None) -> str:
    """The family of an effect: as the tree has it; of an effect that is not in the tree, as the verdict states it; else its
    own name, so that an effect without a family is right for no cause but itself."""
    name = plain(effect)
    return _FAMILY_OF.get(name) or (stated_family(stated) if stated else name)
