"""Function blocks of cams and of tables over time in cyclic programs: AX-41, AX-48."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import takt
from blocks import call
from takt import plcopen as plc
from takt.plcopen.cam import SelectedCam

MACHINE = """
name: press
axes:
  - name: x
    limits: {velocity: 500, acceleration: 5000, jerk: 100000}
  - name: y
    limits: {velocity: 1000, acceleration: 20000, jerk: 500000}
cams:
  - name: stroke
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 50, y: 20, v: 0, a: 0}, {x: 100, y: 0, v: 0, a: 0}]
  - name: ramp
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 0.5, y: 1, v: 0, a: 0}]
"""


def polynomial345(s: float) -> float:
    """The motion law that points at rest, joined by quintics, make."""
    return s**3 * (10 - 15 * s + 6 * s**2)


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as session:
        for name in ("x", "y"):
            session.axis(name).power()
        session.run(0.2)
        yield session


def test_a_cam_again_and_again(engine: takt.Engine) -> None:
    """AX-48: selected, followed, its end seen once a turn, left."""
    x, y = engine.axis("x"), engine.axis("y")
    select = plc.MC_CamTableSelect(y, CamTable="stroke", Periodic=True)
    call(engine, select, 0.01, Execute=True)
    assert select.Done
    assert select.CamTableID is not None
    cam = plc.MC_CamIn(y, Master=x, CamTableID=select.CamTableID, SlaveScaling=2.0)
    ends = []
    engine.program(lambda: ends.append(cam(Execute=True).EndOfProfile))
    engine.run(0.01)
    assert (cam.InSync, cam.Busy, cam.Active) == (True, True, True)
    drive = plc.MC_MoveVelocity(x, Velocity=100.0)
    drive(Execute=True)
    for _ in range(3500):
        engine.step()
        s = (x.set_position % 100) / 50
        assert y.set_position == pytest.approx(40 * polynomial345(min(s, 2 - s)), abs=1e-9)
    assert ends.count(True) == int(x.set_position // 100)
    out = plc.MC_CamOut(y)
    call(engine, out, 0.01, Execute=True)
    assert out.Done
    assert cam.CommandAborted
    assert not cam.InSync


def test_a_cam_once_from_where_the_axis_is(engine: takt.Engine) -> None:
    """AX-48: relative to both axes, and not over and over: the axis waits at its end."""
    x, y = engine.axis("x"), engine.axis("y")
    engine.run(0.1)
    y.move_absolute(position=7).wait()
    x.move_absolute(position=30).wait()
    select = plc.MC_CamTableSelect(y, CamTable="stroke", MasterAbsolute=False, SlaveAbsolute=False)
    call(engine, select, 0.01, Execute=True)
    cam = plc.MC_CamIn(y, Master=x, CamTableID=select.CamTableID, StartMode=takt.CamStart.RELATIVE)
    call(engine, cam, 0.01, Execute=True)
    x.move_absolute(position=80).wait()
    assert y.set_position == pytest.approx(27)
    x.move_absolute(position=200).wait()
    assert y.set_position == pytest.approx(7)


@pytest.mark.parametrize("follower", ["cam", "move", "aborting cam"])
def test_the_end_of_a_cam_with_another_command_behind_it(engine: takt.Engine, follower: str) -> None:
    """AX-48: EndOfProfile is that of the cam whose end was passed, also in the call in which the next command has
    taken over."""
    x, y = engine.axis("x"), engine.axis("y")
    first = plc.MC_CamIn(y, Master=x, CamTableID="stroke")
    second = plc.MC_CamIn(y, Master=x, CamTableID=SelectedCam("stroke", periodic=True))
    if follower == "cam":
        second.BufferMode = takt.BufferMode.BUFFERED
    call(engine, first, 0.01, Execute=True)
    x.move_velocity(velocity=100.0).wait(until="reached")
    if follower == "cam":
        second(Execute=True)
    elif follower == "move":
        y.move_absolute(position=30, buffer_mode="buffered")
    else:
        engine.wait(lambda: x.set_position >= 99.85)
        first()
        second(Execute=True)  # takes control in the cycle in which the first one passes its end
    ends: dict[str, list[float]] = {"first": [], "second": []}
    while x.set_position < 250:
        engine.step()
        for name, cam in (("first", first), ("second", second)):
            if cam().EndOfProfile:
                ends[name].append(x.set_position)
    assert first.CommandAborted
    assert ends["first"] == pytest.approx([100], abs=0.2)
    assert ends["second"] == ([] if follower == "move" else pytest.approx([200], abs=0.2))


def test_the_end_of_a_cam_that_was_changed(engine: takt.Engine) -> None:
    """AX-48, AX-111: an end that is passed in the call of a change is not lost."""
    x, y = engine.axis("x"), engine.axis("y")
    cam = plc.MC_CamIn(y, Master=x, CamTableID=SelectedCam("stroke", periodic=True), ContinuousUpdate=True)
    call(engine, cam, 0.01, Execute=True)
    x.move_velocity(velocity=100.0)
    ends = 0
    while x.set_position < 450:
        engine.step()
        ends += cam(SlaveScaling=1 + x.set_position * 1e-6).EndOfProfile
    assert ends == 4


def test_what_is_no_cam(engine: takt.Engine) -> None:
    x, y = engine.axis("x"), engine.axis("y")
    select = plc.MC_CamTableSelect(y, CamTable="strike")
    call(engine, select, 0.01, Execute=True)
    assert (select.Error, select.ErrorID, select.CamTableID) == (True, 3010, None)
    refused = y.cam_in(master="x", cam="strike").wait_final()
    assert refused.sentence == "cam: the machine has no cam 'strike' (it has stroke, ramp); did you mean stroke?"
    assert y.gear_in(master="z").wait_final().sentence == "master: there is no axis 'z'; there are x, y"
    assert "expected the name of a cam" in y.cam_in(master="x", cam="").wait_final().sentence
    assert "other than 0" in y.cam_in(master="x", cam="stroke", master_scaling=0).wait_final().sentence
    cam = call(engine, plc.MC_CamIn(y, Master=x), 0.01, Execute=True)
    assert (cam.Error, cam.ErrorID) == (True, 5)
    assert y.state is takt.PlcState.STANDSTILL


def test_tables_over_time(engine: takt.Engine) -> None:
    """AX-41: positions, velocities and accelerations against the integrals of the law."""
    y = engine.axis("y")
    by_position = plc.MC_PositionProfile(y, TimePosition="ramp", PositionScale=30.0, TimeScale=2.0)
    call(engine, by_position, 0.5, Execute=True)
    assert by_position.Busy
    assert y.set_position == pytest.approx(30 * polynomial345(0.5), abs=0.2)
    call(engine, by_position, 0.6, Execute=True)
    assert by_position.Done
    assert y.set_position == pytest.approx(30)
    assert y.state is takt.PlcState.STANDSTILL
    by_velocity = plc.MC_VelocityProfile(y, TimeVelocity="ramp", VelocityScale=80.0)
    call(engine, by_velocity, 0.505, Execute=True)
    assert by_velocity.ProfileCompleted
    assert by_velocity.Done
    assert y.set_velocity == pytest.approx(80)
    assert y.state is takt.PlcState.CONTINUOUS_MOTION
    begun_at = y.set_velocity
    by_acceleration = plc.MC_AccelerationProfile(y, TimeAcceleration="ramp", AccelerationScale=100.0)
    call(engine, by_acceleration, 0.505, Execute=True)
    assert by_acceleration.ProfileCompleted
    assert y.set_velocity - begun_at == pytest.approx(100 * 0.25, rel=0.02)


@pytest.mark.parametrize("scale", [1.0, -1.0])
@pytest.mark.parametrize(
    ("command", "most", "error"),
    [("position_profile", 95, 8), ("velocity_profile", 500, 5), ("acceleration_profile", 5000, 5)],
)
def test_a_table_over_time_is_refused_for_a_peak_however_short(
    command: str, most: float, error: int, scale: float
) -> None:
    """AX-41: the lowest and highest value count; one as high as the limit is allowed."""
    times = (0, 40, 50, 50.05, 50.15, 50.25, 60, 100)
    machine = takt.Engine(
        MACHINE.replace("jerk: 100000}", "jerk: 100000, lower: -95, upper: 95}", 1)
        + "".join(
            f"  - name: {name}\n    interpolation: monotone\n    points: ["
            + ", ".join(
                f"{{x: {x}, y: {share * most}}}"
                for x, share in zip(times, (0, 0.5, 0.5, 0.5, peak, 0.5, 0.5, 0), strict=True)
            )
            + "]\n"
            for name, peak in (("high", 1.01), ("just", 1.0))
        )
    )
    with machine as engine:
        x = engine.axis("x")
        x.power().wait()
        scaled = {f"{command.removesuffix('_profile')}_scale": scale}
        refused = getattr(x, command)(profile="high", **scaled).wait_final()
        assert refused.error_id == error
        assert getattr(x, command)(profile="just", **scaled).wait(until="active")
