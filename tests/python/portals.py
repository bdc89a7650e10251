"""A portal for tests: three linear axes as a group with kinematics, one axis besides, a path."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import takt

PORTAL = """\
name: portal
cycle: {period_s: 0.001}
lcm: {axis_rate_hz: 1000, dead_man_s: 0.3}
axes:
  - {name: x, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -300, upper: 300}}
  - {name: y, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: z, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: feed, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: gantry
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 300, acceleration: 3000, jerk: 60000}
    base: {x: 1000, c: 90}
paths:
  - name: slot
    elements:
      - {shape: line, to: {x: 40, y: 0, z: 0}}
      - {shape: arc, via_x: 55, via_y: 15, via_z: 0, to: {x: 40, y: 30, z: 0}}
      - {shape: line, to: {x: 0, y: 30, z: 0}}
      - {shape: arc, via_x: -15, via_y: 15, via_z: 0, to: {x: 0, y: 0, z: 0}}
"""


@contextmanager
def portal() -> Iterator[tuple[takt.Engine, takt.Group]]:
    """An engine and its group, powered and enabled."""
    with takt.Engine(PORTAL) as engine:
        gantry = engine.group("gantry")
        gantry.power().wait()
        gantry.enable().wait()
        yield engine, gantry
