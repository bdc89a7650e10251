"""Function blocks for groups of axes (GR-02, GR-10, GR-20, GR-25)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import takt
from blocks import fill_queue, shown, until
from portals import PORTAL, portal
from takt import plcopen as plc
from takt.plcopen.group import GroupBlock

ACS, MCS, WCS, PCS = (takt.CoordinateSystem(name) for name in ("acs", "mcs", "wcs", "pcs"))
STATES = ("GroupDisabled", "GroupStandby", "GroupMoving", "GroupHoming", "GroupStopping", "GroupErrorStop")


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with portal() as (made, _):
        yield made


@pytest.fixture
def gantry(engine: takt.Engine) -> takt.Group:
    return engine.group("gantry")


def done(engine: takt.Engine, block: plc.FunctionBlock, **inputs: object) -> None:
    """Calls a block until it is done, then lets go of Execute."""
    until(engine, block, lambda: block.outputs["Done"] or block.Error, Execute=True, **inputs)
    assert not block.Error, takt.error_text(block.ErrorID)
    block(Execute=False)


def test_enabling_and_states() -> None:
    """GR-01, GR-02."""
    with takt.Engine(PORTAL) as engine:
        gantry = engine.group("gantry")
        status = plc.MC_GroupReadStatus(gantry, Enable=True)
        assert shown(status(), *STATES) == ["GroupDisabled"]
        done(engine, plc.GT_GroupPower(gantry))
        done(engine, plc.MC_GroupEnable(gantry))
        assert shown(status(), *STATES) == ["GroupStandby"]
        assert status.InPosition
        move = plc.MC_MoveLinearAbsolute(gantry, Position=[50, 20])
        until(engine, move, lambda: status().Accelerating, Execute=True)
        assert shown(status, *STATES) == ["GroupMoving"]
        done(engine, move)
        assert gantry.pose == pytest.approx((50, 20, 0, 0, 0, 0), abs=1e-9)
        done(engine, plc.MC_GroupDisable(gantry))
        assert shown(status(), *STATES) == ["GroupDisabled"]
        refused = plc.MC_MoveLinearAbsolute(gantry, Position=[0])
        until(engine, refused, lambda: refused.Error, Execute=True)
        assert refused.ErrorID == 3025


def test_moves(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-20: positions as sequences and by name."""
    done(engine, plc.MC_MoveLinearRelative(gantry, Distance=[10, None, 5], Velocity=100.0))
    assert gantry.pose[:3] == pytest.approx((10, 0, 5), abs=1e-9)
    circle = plc.MC_MoveCircularAbsolute(gantry, AuxPoint=(15, 5, 5), EndPoint={"x": 20.0})
    done(engine, circle)
    assert gantry.pose[:3] == pytest.approx((20, 0, 5), abs=1e-9)
    done(engine, plc.MC_MoveCircularRelative(gantry, AuxPoint=(5, 5, 0), EndPoint=[10]))
    assert gantry.pose[:3] == pytest.approx((30, 0, 5), abs=1e-9)
    done(engine, plc.MC_MoveDirectAbsolute(gantry, Position=[0, 40, 0], VelFactor=0.5))
    assert gantry.pose[:3] == pytest.approx((0, 40, 0), abs=1e-9)
    done(engine, plc.MC_MoveDirectRelative(gantry, Distance={"a2": -40.0}))
    assert gantry.pose[:3] == pytest.approx((0, 0, 0), abs=1e-9)
    with pytest.raises(TypeError, match="up to 6 numbers with mcs, found 7"):
        plc.MC_MoveLinearAbsolute(gantry, Position=[0] * 7)(Execute=True)
    with pytest.raises(TypeError, match=r"AuxPoint has 3 numbers, X, Y and Z in mm, found 2: \[15, 5\]"):
        plc.MC_MoveCircularAbsolute(gantry, AuxPoint=[15, 5], EndPoint=[20, 0])(Execute=True)


def test_buffered_moves_and_aborts(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-22."""
    first = plc.MC_MoveLinearAbsolute(gantry, Position=[60])
    second = plc.MC_MoveLinearAbsolute(gantry, Position=[60, 60], BufferMode=takt.BufferMode.BUFFERED)
    first(Execute=True)
    engine.step()
    second(Execute=True)
    until(engine, first, lambda: first.Active)
    assert second().Busy
    assert not second.Active
    halt = plc.MC_GroupHalt(gantry)
    halt(Execute=True)
    engine.step()
    assert first().CommandAborted
    assert second().CommandAborted
    done(engine, halt)


def test_stop_holds_as_long_as_execute(engine: takt.Engine, gantry: takt.Group) -> None:
    stop = plc.MC_GroupStop(gantry)
    until(engine, stop, lambda: stop.Done, Execute=True)
    engine.run(0.1)
    assert gantry.state is takt.GroupState.GROUP_STOPPING
    stop(Execute=False)
    engine.run(0.01)
    assert gantry.state is takt.GroupState.GROUP_STANDBY


@pytest.mark.parametrize("end", ["emergency stop", "power off", "second stop"])
def test_stop_lets_go_however_its_command_ends(end: str, engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-01: the falling edge of Execute releases a stop that was aborted or ended with an error, too."""
    stop, second = plc.MC_GroupStop(gantry), plc.MC_GroupStop(gantry)
    gantry.move_linear_absolute(x=200)
    engine.wait(lambda: gantry.path_velocity > 100)
    until(engine, stop, lambda: stop.Active, Execute=True)
    if end == "emergency stop":
        engine.command("machine", "emergency_stop").wait_final()
    elif end == "power off":
        gantry.power(enable=False).wait_final()
    else:
        second(Execute=True)
    until(engine, stop, lambda: stop.CommandAborted or stop.Error)
    engine.run(0.3)
    for block in (stop, second):
        block(Execute=False)
        engine.step(2)
    for command in (gantry.reset, gantry.power, gantry.enable):
        command().wait_final()
    assert gantry.state is takt.GroupState.GROUP_STANDBY
    gantry.move_linear_absolute(x=10).wait()


def test_a_path_interrupted_and_continued(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-20."""
    select = plc.MC_PathSelect(gantry, PathDescription="slot")
    assert select(Execute=True).Done
    move = plc.MC_MovePath(gantry, PathData=select.PathData)
    move(Execute=True)
    engine.run(0.3)
    done(engine, plc.MC_GroupInterrupt(gantry))
    assert gantry.interrupted
    done(engine, plc.MC_GroupContinue(gantry))
    done(engine, move)
    unknown = plc.MC_PathSelect(gantry, PathDescription="slit")(Execute=True)
    assert (unknown.Done, unknown.Error, unknown.ErrorID) == (False, True, 3026)


def test_where_it_is(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-02, GR-10: the world is turned by 90 degrees about Z, 1000 mm away."""
    done(engine, plc.MC_MoveLinearAbsolute(gantry, Position=[10, 20, 30]))
    position = plc.MC_GroupReadActualPosition(gantry, Enable=True)
    assert position(CoordSystem=ACS).Position == pytest.approx((10, 20, 30), abs=2e-3)
    assert position(CoordSystem=MCS).Position == pytest.approx((10, 20, 30, 0, 0, 0), abs=2e-3)
    assert position(CoordSystem=WCS).Position == pytest.approx((980, 10, 30, 0, 0, 90), abs=2e-3)
    done(engine, plc.MC_SetCartesianTransform(gantry, TransX=10.0, TransY=-10.0, RotAngle3=90.0, Pcs=16))
    assert position(CoordSystem=PCS, Pcs=16).Position == pytest.approx((30, 0, 30, 0, 0, -90), abs=2e-3)
    position(Pcs=17)
    assert (position.Valid, position.Error, position.ErrorID) == (False, True, 5)
    move = plc.MC_MoveLinearAbsolute(gantry, Position=[100, 20, 30], Velocity=50.0)
    velocity = plc.MC_GroupReadActualVelocity(gantry, Enable=True)
    acceleration = plc.MC_GroupReadActualAcceleration(gantry, Enable=True)
    until(engine, move, lambda: gantry.path_velocity > 40, Execute=True)
    assert velocity(CoordSystem=MCS).PathVelocity == pytest.approx(gantry.velocity, rel=0.2)
    assert velocity(CoordSystem=ACS).Velocity[0] > 30
    assert acceleration(CoordSystem=MCS).PathAcceleration == gantry.acceleration
    assert acceleration(CoordSystem=ACS).Acceleration[1] == pytest.approx(0, abs=1e-9)
    done(engine, move)


@pytest.mark.parametrize(
    ("block_of", "name"),
    [
        (plc.MC_GroupReadActualPosition, "CoordSystem"),
        (plc.MC_GroupReadActualVelocity, "CoordSystem"),
        (plc.MC_ReadCoordinateTransform, "Reference"),
    ],
)
def test_coordinate_systems_are_given_as_text(gantry: takt.Group, block_of: Any, name: str) -> None:
    """AX-11: as for all commands; another value is an error that names the input."""
    read = block_of(gantry, Enable=True)
    for system in takt.CoordinateSystem:
        as_text = read(**{name: system.value}).outputs
        assert as_text == read(**{name: system}).outputs
        assert read.Error is (block_of is plc.MC_ReadCoordinateTransform and system is ACS)
    for value in ("MCS", 1, None, True):
        read(**{name: value})
        assert (read.Valid, read.Busy, read.Error, read.ErrorID) == (False, False, True, 5)
        assert read.ErrorText == f"{name}: expected one of acs, mcs, wcs, pcs, found {value!r}"
    assert not any(read(Enable=False).outputs[output] for output in ("Error", "ErrorID", "ErrorText"))
    assert read(Enable=True, **{name: "mcs"}).Valid


def test_positions_with_coordinate_systems_as_text(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-02, AX-11: numbers without names are those of the axes with the text acs, too."""
    done(engine, plc.MC_MoveDirectAbsolute(gantry, Position=[10, 5, 3], CoordSystem="acs"))
    assert [axis.set_position for axis in gantry.members] == pytest.approx([10, 5, 3])
    done(engine, plc.MC_GroupSetPosition(gantry, Position=[0, 0, 0], CoordSystem="acs"))
    done(engine, plc.MC_MoveLinearAbsolute(gantry, Position=[20, 5, 3], CoordSystem="mcs", BufferMode="buffered"))
    assert [axis.set_position for axis in gantry.members] == pytest.approx([20, 5, 3])
    wrong = plc.MC_MoveDirectAbsolute(gantry, Position=[1, 2], CoordSystem="axes")
    until(engine, wrong, lambda: wrong.Error, Execute=True)
    assert "coordinate_system: expected one of acs, mcs, wcs, pcs, found 'axes'" in wrong.ErrorText
    with pytest.raises(TypeError, match="up to 6 numbers with axes, found 7"):
        plc.MC_MoveDirectAbsolute(gantry, Position=[0] * 7, CoordSystem="axes")(Execute=True)


def test_an_axis_in_step_with_the_path(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-25: InSync only while the slave is where the path has it; here it is too slow for a while."""
    feed = engine.axis("feed")
    feed.power().wait()
    sync = plc.MC_SyncAxisToGroup(gantry, Slave="feed", RatioNumerator=4.0)
    until(engine, sync, lambda: sync.InSync, Execute=True)
    assert sync.Active
    move = gantry.move_linear_absolute(x=150)
    lags = []
    while not (move.done and sync.InSync):
        assert engine.now < 5
        engine.step()
        sync(Slave="")
        assert sync.Active
        assert sync.InSync is feed.in_step
        lags.append(4 * gantry.x - feed.set_position)
        assert not sync.InSync or abs(lags[-1]) < 0.01
    assert max(lags) > 50
    feed.halt().wait()
    assert sync().CommandAborted
    assert not sync.InSync


def test_coordinate_systems(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-10."""
    done(engine, plc.MC_SetCartesianTransform(gantry, TransX=100.0, RotAngle3=90.0))
    done(engine, plc.MC_MoveLinearAbsolute(gantry, Position=[10, 0, 0], CoordSystem=PCS))
    assert gantry.pose[:3] == pytest.approx((100, 10, 0), abs=1e-9)
    done(engine, plc.MC_SetCoordinateTransform(gantry, Pcs=2, CoordTransform=[5, 0, 0], Reference=PCS))
    done(engine, plc.MC_MoveLinearAbsolute(gantry, Position=[0, 0, 0], CoordSystem=PCS, Pcs=2))
    assert gantry.pose[:3] == pytest.approx((100, 5, 0), abs=1e-9)
    # Of 2 in 1 as it was given, in the machine, in the world (base: x 1000, turned by 90 degrees).
    read = plc.MC_ReadCoordinateTransform(gantry, Enable=True, Pcs=2)
    assert read().CoordTransform == gantry.product_system(2) == pytest.approx((100, 5, 0, 0, 0, 90), abs=1e-9)
    assert read(Reference=PCS).CoordTransform == pytest.approx((5, 0, 0, 0, 0, 0), abs=1e-9)
    assert read(Reference=WCS).CoordTransform == pytest.approx((995, 100, 0, 0, 0, 180), abs=1e-9)
    assert read(Reference=PCS, ReferencePcs=3).CoordTransform == pytest.approx((100, 5, 0, 0, 0, 90), abs=1e-9)
    for wrong in ({"Reference": ACS}, {"Reference": PCS, "ReferencePcs": 0}, {"Reference": MCS, "Pcs": 17}):
        assert (read(**wrong).Valid, read.ErrorID) == (False, 5)
    numbers = plc.MC_ReadCartesianTransform(gantry, Enable=True)
    assert numbers().CoordTransform == (100, 0, 0, 0, 0, 90)
    assert (numbers.TransX, numbers.TransY, numbers.RotAngle1, numbers.RotAngle3) == (100, 0, 0, 90)
    assert not numbers(Enable=False).Valid
    transform = plc.MC_ReadKinTransform(gantry, Enable=True)
    assert transform().KinTransform
    done(engine, plc.MC_SetKinTransform(gantry, KinTransform=False))
    assert not transform().KinTransform


def test_members(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-02."""
    done(engine, plc.MC_GroupDisable(gantry))
    done(engine, plc.MC_AddAxisToGroup(gantry, Axis=engine.axis("feed"), IdentInGroup=4))
    read = plc.MC_GroupReadConfiguration(gantry, Enable=True)
    assert read(IdentInGroup=4).Axis is engine.axis("feed")
    done(engine, plc.MC_RemoveAxisFromGroup(gantry, IdentInGroup=4))
    assert (read().Valid, read.ErrorID) == (False, 1003)
    assert read(IdentInGroup=9).ErrorID == 5
    done(engine, plc.MC_UngroupAllAxes(gantry))
    empty = plc.MC_GroupEnable(gantry)(Execute=True)
    until(engine, empty, lambda: empty.Error)
    assert empty.ErrorID == 1005


def test_a_fault_and_its_reset(engine: takt.Engine, gantry: takt.Group) -> None:
    """GR-03: a fault of a member is one of the group."""
    error = plc.MC_GroupReadError(gantry, Enable=True)
    assert (error().GroupErrorID, error.text) == (0, "")
    gantry.move_linear_absolute(x=200)
    engine.run(0.2)
    engine.command("machine", "fail_all_axes").wait()
    engine.run(0.5)
    assert gantry.state is takt.GroupState.GROUP_ERROR_STOP
    assert error().GroupErrorID != 0
    assert error.text
    done(engine, plc.MC_GroupReset(gantry))
    assert gantry.state is takt.GroupState.GROUP_STANDBY


def test_override_holds_the_group(engine: takt.Engine, gantry: takt.Group) -> None:
    override = plc.MC_GroupSetOverride(gantry, VelFactor=0.0)
    until(engine, override, lambda: override.Enabled, Enable=True)
    move = plc.MC_MoveLinearAbsolute(gantry, Position=[10])
    move(Execute=True)
    engine.run(0.5)
    assert gantry.path_velocity == 0
    until(engine, override, lambda: override.Enabled, VelFactor=0.5)
    done(engine, move)
    assert (override(VelFactor=-1.0).Error, override.ErrorID) == (True, 5)


def test_override_in_a_full_queue(engine: takt.Engine, gantry: takt.Group) -> None:
    """AX-51, EN-22: it is given again until there is room."""
    fill_queue(next(iter(engine.axes.values())))
    override = plc.MC_GroupSetOverride(gantry, VelFactor=0.5)
    assert override(Enable=True).ErrorID == 3012
    until(engine, override, lambda: override.Enabled)
    assert not override.Error


def test_every_block_is_called_by_its_group() -> None:
    """AX-11: inputs that are not there, and the name of the group."""
    with takt.Engine(PORTAL) as engine:
        gantry, x = engine.group("gantry"), engine.axis("x")
        blocks = [block for block in plc.BLOCKS if issubclass(block, GroupBlock)]
        assert len(blocks) == 39
        for block in blocks:
            made = block(gantry)
            assert made.AxesGroup is gantry
            with pytest.raises(TypeError, match=f"{block.__name__} has no input 'Exekute'"):
                made(Exekute=True)
        sync = plc.MC_SyncAxisToGroup(gantry, Slave=x)
        assert sync.Master is gantry
