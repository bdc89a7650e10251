"""Colours and names shared by pictures and reports."""

from __future__ import annotations

import re
from collections.abc import Container, Sequence

# One per component, distinct in hue and lightness; readable on white and on dark grey.
PALETTE = (
    "#2f6fde",
    "#d9682b",
    "#2f9e6b",
    "#9b59c6",
    "#c2992b",
    "#d1477f",
    "#3aa6b9",
    "#7a7f2e",
    "#8c6a55",
    "#6b7689",
)

STATES = {
    "Disabled": "#9aa3ae",
    "Standstill": "#7fb08a",
    "DiscreteMotion": "#4f8fe0",
    "ContinuousMotion": "#37a3b5",
    "SynchronizedMotion": "#9b6fd0",
    "Homing": "#d0a03a",
    "Stopping": "#e08a3c",
    "ErrorStop": "#d6453d",
    # Of a cam module.
    "Init": "#9aa3ae",
    "Ready": "#7fb08a",
    "Service": "#6b7689",
    "JogPos": "#37a3b5",
    "JogNeg": "#3a86a3",
    "Sync": "#9b6fd0",
    "Stop": "#e08a3c",
    "Error": "#d6453d",
    # Of a group.
    "GroupDisabled": "#9aa3ae",
    "GroupStandby": "#7fb08a",
    "GroupMoving": "#4f8fe0",
    "GroupHoming": "#d0a03a",
    "GroupStopping": "#e08a3c",
    "GroupErrorStop": "#d6453d",
    # How its tool follows a moving target; grey for values without information.
    "none": "#c5cad2",
    "waiting": "#d0a03a",
    "synchronizing": "#37a3b5",
    "in_sync": "#9b6fd0",
    "desynchronizing": "#e08a3c",
    # Of a pick and place module.
    "init": "#9aa3ae",
    "ready": "#7fb08a",
    "service": "#6b7689",
    "homing": "#d0a03a",
    "jog_pos": "#37a3b5",
    "jog_neg": "#3a86a3",
    "preparing_path": "#c2992b",
    "move_pp": "#9b6fd0",
    "path_interrupt": "#8c6a55",
    "stop": "#e08a3c",
    "error": "#d6453d",
    # Of components in the plane; Disabled and Error are above.
    "Enabling": "#d0a03a",
    "Enabled": "#7fb08a",
    "Disabling": "#e08a3c",
    "ErrorPending": "#c2703d",
    "Resetting": "#37a3b5",
}

GOOD = "#2f9e6b"
BAD = "#d6453d"

# From top to bottom; other quantities follow in order of appearance.
QUANTITY_ORDER = (
    *("position", "x position", "y position"),
    *("velocity", "x velocity", "y velocity"),
    *("acceleration", "x acceleration", "y acceleration"),
    *("jerk", "following error", "torque", "voltage"),
)

# Fields of a component that are shown by default.
USUAL_FIELDS = (
    "set_position",
    "actual_position",
    "set_velocity",
    "actual_velocity",
    "set_acceleration",
    "following_error",
    "set_x_position",
    "set_y_position",
    "set_y_velocity",
    "state",
    "cam_synchronised",
    *("x", "y", "z"),
    "path_velocity",
    "path_acceleration",
    "track_state",
    "position",
    "first_place",
    "pose_x",
    "pose_y",
)


def component_colour(component: str, components: Sequence[str]) -> str:
    return PALETTE[list(components).index(component) % len(PALETTE)]


def state_colour(name: str, value: int) -> str:
    return STATES.get(name, PALETTE[value % len(PALETTE)])


def is_set_point(field: str, fields: Container[str] = ()) -> bool:
    """Returns whether a field is a set point: by its name, or because its actual value is among `fields` ("x" with
    "actual_x")."""
    return field.startswith(("set_", "commanded_", "target_")) or f"actual_{field}" in fields


def source(field: str) -> str:
    """Returns the common part of the names of set points and actual values of the same quantity."""
    return re.sub("^(set|actual|commanded)_", "", field)
