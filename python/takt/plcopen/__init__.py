"""Function blocks with PLCopen's names, inputs and outputs.

A block is an instance that is called once a cycle, usually in a program of the session:

    move = MC_MoveAbsolute(session.axis("x"))

    @session.program
    def scan() -> None:
        move(Execute=start, Position=100.0, Velocity=50.0)
        if move.Done: ...

Rules that all blocks keep:

- An input that is not given keeps its value from the previous call. Inputs take effect on the rising edge of Execute.
- While Execute is true, exactly one of Busy, Done, CommandAborted and Error is true, of those that the block has.
  Active equals Busy; for a buffered command it says that the command is in control.
- Done, CommandAborted, Error and the like are cleared with the falling edge of Execute, but are shown in at least one
  call.
- A new rising edge before the end starts the command again; the block no longer reports the previous command.
- Velocity, acceleration, deceleration and jerk are never negative; the engine refuses negative ones. An input that is
  None is left to the engine, which uses the axis' own limit.
- Inputs of enumerations take a member or its text; any other value is an error (5) of the block, which names the input.
- InVelocity, InEndVelocity, InGear and InSync refer to the present set point: they fall when it no longer has the
  commanded value.
"""

from __future__ import annotations

from takt.plcopen import (
    administration,
    cam,
    cam_switch,
    coupling,
    group,
    group_moves,
    homing,
    jog,
    moves,
    probe,
    profiles,
    settings,
    statement,
    superimposed,
    torque,
    tracking,
)
from takt.plcopen.administration import *  # noqa: F403
from takt.plcopen.base import FunctionBlock
from takt.plcopen.cam import *  # noqa: F403
from takt.plcopen.cam_switch import *  # noqa: F403
from takt.plcopen.coupling import *  # noqa: F403
from takt.plcopen.group import *  # noqa: F403
from takt.plcopen.group_moves import *  # noqa: F403
from takt.plcopen.homing import *  # noqa: F403
from takt.plcopen.jog import *  # noqa: F403
from takt.plcopen.moves import *  # noqa: F403
from takt.plcopen.probe import *  # noqa: F403
from takt.plcopen.profiles import *  # noqa: F403
from takt.plcopen.settings import *  # noqa: F403
from takt.plcopen.superimposed import *  # noqa: F403
from takt.plcopen.torque import *  # noqa: F403
from takt.plcopen.tracking import *  # noqa: F403
from takt.plcopen.tracking import SyncDistances, TrackOptions

_MOVING = (moves, superimposed, profiles, jog, coupling, cam, homing, torque)
_GROUPS = (administration, *_MOVING, settings, probe, cam_switch, group, group_moves, tracking)

BLOCKS: tuple[type[FunctionBlock], ...] = tuple(
    block
    for group in _GROUPS
    for name, block in vars(group).items()
    if name.startswith(("MC_", "GT_")) and block.__module__ == group.__name__
)


def compliance() -> str:
    """Returns the compliance statement as Markdown: the supported blocks, inputs and outputs of PLCopen."""
    return statement.page({block.__name__: block for block in BLOCKS})


__all__ = ["BLOCKS", "FunctionBlock", "SyncDistances", "TrackOptions", "compliance"]
__all__ += [block.__name__ for block in BLOCKS]
