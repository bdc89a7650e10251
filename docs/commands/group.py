"""Groups of axes.

The axes of a group move together: the tool that they carry along lines, circles and paths of the machine file, or each
axis to where it is to be, all arriving at the same time. A group is enabled first; from then on its members take no
motion of their own.

Numbers are seen from the machine coordinate system (mcs), the world (wcs), one of 16 product coordinate systems (pcs),
or are those of the axes themselves (acs).
"""

import takt
from takt import expect

COMMANDS = (
    "group.power",
    "group.reset",
    "group.enable",
    "group.disable",
    "group.add_axis",
    "group.remove_axis",
    "group.ungroup_all_axes",
    "group.home",
    "group.define_position",
    "group.set_override",
    "group.set_kin_transform",
    "group.set_cartesian_transform",
    "group.set_coordinate_transform",
    "group.set_tool",
    "group.calibrate",
    "group.move_linear_absolute",
    "group.move_linear_relative",
    "group.move_circular_absolute",
    "group.move_circular_relative",
    "group.move_direct_absolute",
    "group.move_direct_relative",
    "group.move_arch",
    "group.move_path",
    "group.move_path_synchronized",
    "group.sync_axis",
    "group.jog",
    "group.stop",
    "group.halt",
    "group.interrupt",
    "group.continue_path",
)
ERRORS = (
    *(5, 6, 7, 9, 10, 11, 1000, 1001, 1003, 1004, 1005),
    *(3003, 3005, 3006, 3010, 3018, 3021, 3022, 3023, 3024, 3025, 3026, 3103, 3140, 3141),
)
SIGNALS = ("portal.[xy]", "portal.path_velocity", "c.set_position", "portal.state", "portal.interrupted")


def scenario(session: takt.Session) -> None:
    portal = session.group("portal")
    portal.power().wait()
    portal.enable().wait()
    session.mark("every axis by itself, to arrive together")
    portal.move_direct_absolute(a1=20, a2=-10, a3=5).wait()
    session.mark("two lines, the corner rounded by 2 mm")
    portal.move_linear_absolute(x=60, y=0)
    portal.move_linear_absolute(
        x=60, y=40, buffer_mode="blending_next", transition_mode="max_corner_deviation", transition_parameter=2
    ).wait()
    session.mark("half a circle, interrupted")
    half = portal.move_circular_absolute(circ_mode="border", aux_x=40, aux_y=60, x=20, y=40, velocity=100)
    session.run(0.3)
    portal.interrupt().wait()
    session.run(0.1)
    session.mark("continued")
    portal.continue_path().wait()
    half.wait()
    session.mark("a path, seen from a turned product coordinate system; c turns along")
    portal.set_cartesian_transform(pcs=1, x=20, y=40, c=-90).wait()
    c = session.axis("c")
    c.power().wait()
    portal.sync_axis(axis="c", ratio_numerator=2).wait(until="active")
    portal.move_path(
        path="slot",
        coordinate_system="pcs",
        transition_mode="max_corner_deviation",
        transition_parameter=0.5,
        velocity=150,
    ).wait()
    session.mark("stopped")
    portal.move_linear_relative(x=-200)
    session.run(0.2)
    portal.stop().wait()
    portal.set_tool(z=-40).wait()
    portal.disable().wait()
    session.run(0.1)


def verify(recording: takt.Recording) -> None:
    for axis in "xyz":
        expect.within_limits(recording, axis)
        expect.continuous(recording, axis)
    expect.visits_states(recording, "portal", ["GroupStandby", "GroupMoving", "GroupStandby"])
