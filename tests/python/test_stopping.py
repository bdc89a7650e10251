"""What stops a machine, of every kind of component and for every one of its commands (docs/stopping.md)."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import takt
from seams import MACHINE, commands
from takt.plcopen import GT_EStop, MC_MoveVelocity, MC_Power

EMERGENCY_STOP = 3100


def start() -> takt.Engine:
    """Everything is powered and moves."""
    s = takt.Engine(MACHINE)
    for name in ("left", "right", "web", "infeed", "valve"):
        s.axis(name).power().wait()
    for group in ("portal",):
        s.group(group).power().wait()
        s.group(group).enable().wait()
    s.command("cutter", "control", {"regulator_on": True})
    s.command("picker", "control", {"regulator_on": True})
    s.command("shuttle", "enable")
    s.run(0.4)
    s.axis("web").move_velocity(velocity=50)
    s.axis("infeed").move_velocity(velocity=50)
    s.axis("left").move_velocity(velocity=50)
    s.axis("valve").jog(forward=True, velocity=20)
    s.command("cutter", "control", {"sync_cam": True})
    s.group("portal").move_linear_absolute(x=200, velocity=20)
    s.group("portal").move_linear_absolute(x=0, buffer_mode="buffered")
    s.run(0.4)
    assert all(s.axis(name).set_velocity > 0 for name in ("web", "infeed", "left", "right", "x", "valve"))
    return s


def all_off(s: takt.Engine) -> bool:
    return all(a.state.value == "Disabled" and not a.loop_closed and a.set_velocity == 0 for a in s.axes.values())


def test_while_an_emergency_stop_is_held_no_command_moves_anything() -> None:
    """AX-100: kinds of component x their commands. Every one that could power or move something is refused with 3100,
    others as they are; no axis leaves Disabled, no set point moves, whatever is asked, and nothing comes back."""
    with start() as s:
        stop = s.command("machine", "emergency_stop", {"hold": True}).wait()
        s.run(1.0)  # movers brake
        assert all_off(s)
        places = {a.name: a.true_position for a in s.axes.values()}
        mover = (s.movers["shuttle"].x, s.movers["shuttle"].y)
        answers = {}
        for target, verb, arguments in commands():
            feedback = s.command(target, verb, arguments)
            s.step(3)
            assert all_off(s), f"{target}.{verb}"
            answers[target, verb, str(arguments)] = feedback.error_id
        asked = {key: error for key, error in answers.items() if error == EMERGENCY_STOP}
        for must in (
            ("web", "power"), ("web", "move_absolute"), ("web", "jog"), ("web", "gear_in"), ("web", "home"),
            ("right", "power"), ("valve", "direct_output"), ("valve", "pulse_output"), ("portal", "power"),
            ("portal", "move_linear_absolute"), ("cutter", "control"), ("cutter", "jog"), ("picker", "control"),
            ("picker", "jog"), ("shuttle", "enable"), ("shuttle", "move_to_position"), ("deck", "activate_position"),
        ):  # fmt: skip
            assert must in {key[:2] for key in asked}, must
        for setting in ("set_coordinate_transform", "set_dyn_coord_transform"):
            assert ("portal", setting) not in {key[:2] for key in asked}
        for target in ("web", "portal", "cutter", "picker", "shuttle"):
            s.command(target, "reset") if target in ("web", "portal", "shuttle") else None
        s.run(0.5)
        stop.release()
        s.run(2.0)
        assert all_off(s)
        for a in s.axes.values():
            assert a.true_position == pytest.approx(places[a.name], abs=0.01), a.name
        assert (s.movers["shuttle"].x, s.movers["shuttle"].y) == mover


def test_what_is_asked_for_anew_moves_after_an_emergency_stop() -> None:
    """AX-100: what each kind needs to go on."""
    with start() as s:
        s.command("machine", "emergency_stop", {"hold": True}).wait().release()
        s.run(1.0)
        for name in ("cutter", "picker"):
            s.command(name, "control", {"reset_error": True})
            s.run(0.3)
            s.command(name, "control", {"reset_error": False})
        s.group("portal").reset().wait()
        s.run(0.3)
        assert all_off(s)  # a reset switches nothing on
        for name in ("cutter", "picker"):
            s.command(name, "control", {"regulator_on": False})
            s.step(2)
            s.command(name, "control", {"regulator_on": True})
        s.group("portal").power().wait()
        for name in ("left", "right", "web"):
            s.axis(name).power().wait()
        s.run(0.5)
        assert s.axis("knife").loop_closed
        assert s.axis("a").loop_closed
        s.group("portal").move_linear_absolute(x=0).wait()
        s.axis("left").move_relative(distance=10).wait()
        assert s.axis("right").set_position == pytest.approx(s.axis("left").set_position, abs=0.1)
        s.command("shuttle", "enable").wait()


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("every", [1, 7])
def test_blocks_do_not_resume_after_an_emergency_stop(held: bool, every: int) -> None:
    """AX-100: a program that is scanned in every cycle, or in every seventh, with its Enable true throughout."""
    with takt.Engine(MACHINE) as s:
        web = s.axis("web")
        power, estop, move = MC_Power(web, Enable=True), GT_EStop(web), MC_MoveVelocity(web, Velocity=80)
        pressed = lambda: held and 0.6 < s.now < 1.2  # noqa: E731
        enable = True
        seen_done = []

        def scan() -> None:
            if s.cycle % every == 0:
                power(Enable=enable)
                estop(Execute=pressed())
                move(Execute=power.Status and not move.Error)
                seen_done.append((s.now, estop.Done, web.state.value))

        s.program(scan)
        s.run(0.65 if held else 0.6)
        if not held:
            assert web.set_velocity == 80
            s.command("machine", "emergency_stop")
        s.run(0.05)
        for _ in range(100):
            s.run(0.02)
            assert (web.state.value, web.loop_closed, web.set_velocity) == ("Disabled", False, 0)
            assert (power.Error, power.ErrorID, power.Status) == (True, EMERGENCY_STOP, False)
            assert "emergency stop" in power.ErrorText
        if held:
            assert any(done for _, done, _ in seen_done)
            assert all(state == "Disabled" for _, done, state in seen_done if done)
            assert not estop.Done  # let go
        enable = False
        s.run(0.05)
        assert not power.Error
        enable = True
        s.run(0.5)
        assert (power.Status, web.emergency_stopped) == (True, False)


def test_a_block_that_asks_while_the_stop_is_held_is_refused_once_and_for_all() -> None:
    """AX-100: Enable that rises while the stop is on does not count when it is off."""
    with takt.Engine(MACHINE) as s:
        web = s.axis("web")
        power, estop = MC_Power(web), GT_EStop(web)

        def scan() -> None:
            estop(Enable=s.now < 0.5)
            power(Enable=s.now > 0.2)

        s.program(scan)
        s.run(1.5)
        assert (power.Error, power.ErrorID, web.state.value) == (True, EMERGENCY_STOP, "Disabled")


def test_a_stop_is_done_when_the_next_command_can_be_given() -> None:
    """AX-37: from rest and in motion, of each way to be at rest."""
    with takt.Engine(MACHINE) as s:
        web = s.axis("web")
        web.power().wait()
        for velocity in (0.0, 5.0, 200.0):
            for held in (False, True):
                if velocity:
                    web.move_velocity(velocity=velocity).wait(until="reached")
                stop = web.stop(hold=held).wait()
                assert web.state.value == ("Stopping" if held else "Standstill")
                if held:
                    stop.release()
                    s.step(2)
                assert web.move_relative(distance=3).wait().done


def test_the_reset_of_a_group_does_not_lose_its_power() -> None:
    """AX-100: reset and power in one cycle: refused as on a single axis, not done without an effect."""
    with start() as s:
        portal = s.group("portal")
        s.command("machine", "emergency_stop").wait()
        s.step(2)
        reset, power = portal.reset(), portal.power()
        power.wait_final()
        reset.wait()
        assert (power.error, power.error_id) == (True, 11)
        portal.power().wait()
        assert all(s.axis(name).loop_closed for name in "xyz")


def test_an_emergency_stop_without_hold_lasts_its_cycle() -> None:
    """AX-100: what asks for power or motion in the same cycle is refused."""
    with takt.Engine(MACHINE) as s:
        web = s.axis("web")
        web.power().wait()
        web.move_velocity(velocity=50)
        s.run(0.2)
        s.command("machine", "emergency_stop")
        power, move = web.power(), web.move_velocity(velocity=50, buffer_mode="buffered")
        s.run(0.3)
        assert (power.error_id, move.error_id) == (3100, 3100)
        assert web.emergency_stopped
        web.power().wait()


def test_more_holders_of_an_emergency_stop_than_there_is_room_for() -> None:
    """AX-100: the seventeenth is told so, and the stop ends when the others have let go."""
    with takt.Engine(MACHINE) as s:
        holders = [s.command("machine", "emergency_stop", {"hold": True}) for _ in range(16)]
        assert s.command("machine", "emergency_stop", {"hold": True}).wait_final().error_id == 3003
        for holder in holders:
            assert s.axis("web").power().wait_final().error_id == 3100
            holder.release()
            s.step(2)
        s.axis("web").power().wait()


def test_stops_end_a_voltage_that_is_put_out_directly() -> None:
    """EN-32: with the loop open, too."""
    stops: list[Callable[[takt.Engine], takt.Feedback]] = [
        lambda s: s.axis("valve").stop(),
        lambda s: s.axis("valve").halt(),
        lambda s: s.command("machine", "stop_all"),
    ]
    for stop in stops:
        with takt.Engine(MACHINE) as s:
            s.axis("valve").direct_output(voltage=2).wait()
            s.run(0.3)
            assert s.axis("valve").actual_velocity > 50
            assert stop(s).wait().done
            s.run(0.5)
            assert abs(s.axis("valve").actual_velocity) < 1
