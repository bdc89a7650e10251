"""Brakes that take their time, and switches that bounce."""

from __future__ import annotations

import numpy as np
import pytest
import takt


def machine(opens: float = 0, closes: float = 0, debounce: float = 0) -> str:
    return f"""
name: brake
axes:
  - name: z
    limits: {{velocity: 300, acceleration: 3000, jerk: 60000}}
    drive: {{brake_opens_s: {opens}, brake_closes_s: {closes}}}
    inputs: {{debounce_s: {debounce}}}
simulation:
  servos:
    - axis: z
      mechanics: {{load_torque: 2}}
      switches: {{reference: {{from: 40, to: 42}}, limit_positive: {{from: 150, to: 150.6}}}}
"""


@pytest.mark.parametrize("opens", [0.0, 0.05, 0.3])
def test_power_is_done_when_the_brake_is_open(opens: float) -> None:
    """AX-115: the loop holds the axis meanwhile; what is asked for is refused, what is buffered begins afterwards."""
    with takt.Engine(machine(opens=opens)) as s:
        z = s.axis("z")
        power = z.power()
        s.wait(lambda: z.loop_closed)
        closed = s.now
        if opens:
            assert z.state is takt.PlcState.DISABLED
            assert z.move_relative(distance=1).wait_final().error_id == 10
            waits = z.move_relative(distance=5, buffer_mode="buffered")
            s.step(2)
            assert waits.busy
            waits.wait()
            assert z.set_position == pytest.approx(5)
        power.wait()
        if not opens:
            assert s.now - closed < 0.003
        else:
            assert s.now - closed > opens
        assert abs(z.true_position - z.set_position) < 0.1


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("closes", [0.0, 0.08, 0.25])
def test_the_loop_stays_closed_until_the_brake_holds(closes: float, moving: bool) -> None:
    """AX-115: at power off, at rest or after the ramp; nothing is taken meanwhile; an emergency stop does not wait."""
    with takt.Engine(machine(closes=closes)) as s:
        z = s.axis("z")
        z.power().wait()
        if moving:
            z.move_velocity(velocity=100).wait(until="reached")
        with s.record("z") as recorder:
            off = z.power(enable=False)
            if closes:
                s.step(3)
                assert z.move_relative(distance=1).wait_final().error_id == 6
            off.wait()
        r = recorder.recording["z"]
        rests = np.asarray(r["loop_closed"]) & (np.asarray(r["set_velocity"]) == 0)
        assert np.count_nonzero(rests) * s.period == pytest.approx(closes, abs=0.004)
        assert (z.state, z.loop_closed) == (takt.PlcState.DISABLED, False)
        s.run(0.2)
        place = z.true_position
        s.run(0.5)
        assert z.true_position == pytest.approx(place, abs=1e-6)
        z.power().wait()
        z.power(enable=False)
        s.step(3)
        s.command("machine", "emergency_stop")
        s.step(2)
        assert not z.loop_closed


@pytest.mark.parametrize("opens", [0.2])
def test_power_off_while_the_brake_opens(opens: float) -> None:
    """AX-115: it stays off."""
    with takt.Engine(machine(opens=opens, closes=0.1)) as s:
        z = s.axis("z")
        power = z.power()
        s.wait(lambda: z.loop_closed)
        off = z.power(enable=False)
        off.wait()
        assert power.aborted
        s.run(0.5)
        assert (z.state, z.loop_closed) == (takt.PlcState.DISABLED, False)


@pytest.mark.parametrize(("debounce", "speed", "seen"), [(0.0, 200.0, True), (0.02, 200.0, False), (0.02, 50.0, True)])
def test_switches_count_when_they_have_settled(debounce: float, speed: float, seen: bool) -> None:
    """AX-115: 2 mm of a switch at 200 mm/s are 10 ms."""
    with takt.Engine(machine(debounce=debounce)) as s:
        z = s.axis("z")
        z.power().wait()
        with s.record("z") as recorder:
            z.move_absolute(position=90, velocity=speed).wait()
        on = np.asarray(recorder.recording["z"]["reference"])
        assert on.any() == seen
        if seen:
            place = np.asarray(recorder.recording["z"]["actual_position"])[np.argmax(on)]
            assert place == pytest.approx(40 + speed * debounce, abs=speed * 0.003)
        # 0.6 mm of the limit switch, which stops the axis where it counts.
        move = z.move_absolute(position=200, velocity=speed).wait_final()
        assert move.error == (debounce == 0 or speed * debounce < 0.6)
