"""Cam modules.

A cam module has one slave follow its master through a cam: over scaling and offset to the X axis, through the cam to
the Y axis, over scaling and offset to the slave, and through a clutch.

The figures, numbered as those of Flex Cam, are runs in virtual time of [one machine](../../docs/flex_cam/machine.yaml).
Its cams are `stroke`, up and down within a turn of the master, in slot 1, `short_stroke`, the same within 240°, in slot
2, and `feed`, 180 mm per 180°, in slot 3.
"""

COMMANDS = (
    "flex_cam.control",
    "flex_cam.configure",
    "flex_cam.set_cam",
    "flex_cam.change_cam",
    "flex_cam.withdraw_changes",
    "flex_cam.jog",
)
ERRORS = (
    1,
    2,
    5,
    6,
    9,
    10,
    12,
    2001,
    3001,
    3002,
    3003,
    3004,
    3005,
    3010,
    3018,
    3019,
    3020,
    3110,
    3111,
    3112,
    20306,
    20307,
    20500,
    20501,
)
