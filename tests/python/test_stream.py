"""Set points that come from outside, one after another (docs/axis.md)."""

from __future__ import annotations

import heapq
import math
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running

MACHINE = """
name: streamed
axes:
  - {name: x, limits: {velocity: 300, acceleration: 3000, jerk: 90000, lower: -200, upper: 200}}
  - {name: r, kind: rotary, modulus: 360, unit: deg, limits: {velocity: 400, acceleration: 4000, jerk: 90000}}
"""
OTHER_STREAM, LATE, JUMP, ENDED = 3120, 3121, 3122, 3123


def joystick(seed: int) -> Callable[[float], float]:
    """A hand that never rests: slow and quick waves at random, from 0."""
    rnd = random.Random(seed)
    waves = [(rnd.uniform(5, 40) / f, f, rnd.uniform(0, 6.28)) for f in (0.7, 1.9, 4.3)]
    return lambda t: sum(a * (math.sin(f * t + p) - math.sin(p)) for a, f, p in waves)


def send(s: takt.Engine, signal: Callable[[float], float], rate: float, *, seed: int, seconds: float, velocity: bool,
         jitter: float, lost: float, doubled: float) -> list[takt.Feedback]:  # fmt: skip
    """Packets with the sender's times, which began long ago; each comes late by up to `jitter`, or not at all."""
    rnd = random.Random(seed)
    begin, epoch = s.now, 8000.25
    packets: list[tuple[float, int]] = []
    for i in range(int(seconds * rate)):
        if i and rnd.random() < lost:
            continue
        for _ in range(2 if rnd.random() < doubled else 1):
            heapq.heappush(packets, (i / rate + rnd.uniform(0, jitter if i else 0), i))
    answers = []
    while packets:
        if packets[0][0] > s.now - begin:
            s.step()
            continue
        t = heapq.heappop(packets)[1] / rate
        slope = (signal(t + 1e-4) - signal(t - 1e-4)) / 2e-4
        given = {"velocity": slope} if velocity else {}
        answers.append(s.axis("x").stream_point(position=signal(t), time=epoch + t, key=7, **given))
    return answers


@pytest.mark.parametrize("velocity", [False, True])
@pytest.mark.parametrize(
    ("rate", "jitter", "lost", "doubled", "within"),
    [(50, 0.0, 0.0, 0.0, 0.4), (50, 0.03, 0.05, 0.05, 2.5), (200, 0.012, 0.1, 0.1, 0.4), (1000, 0.006, 0.1, 0.1, 0.2),
     (1000, 0.0, 0.0, 0.0, 0.1)],
)  # fmt: skip
def test_a_hand_is_followed(
    rate: float, jitter: float, lost: float, doubled: float, within: float, velocity: bool
) -> None:
    """AX-114: at 50 Hz to 1 kHz, with jitter, losses, packets twice and out of order: within limits, without a step,
    and where the hand was one delay before."""
    signal = joystick(int(rate) + velocity)
    delay = 0.03 + 2 / rate + jitter
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        x.power().wait()
        stream = x.stream(key=7, delay=min(delay, 0.028) if rate == 1000 else delay)
        delay = min(delay, 0.028) if rate == 1000 else delay
        s.step(3)
        begin = s.now
        with s.record("x") as recorder:
            answers = send(
                s, signal, rate, seed=3, seconds=3.0, velocity=velocity, jitter=jitter, lost=lost, doubled=doubled
            )
        assert stream.reached
        assert stream.active
        assert {answer.error_id for answer in answers} <= {0, LATE}
        assert sum(answer.done for answer in answers) > 0.9 * 3.0 * rate * (1 - lost)
        takt.expect.within_limits(recorder.recording, "x")
        r = recorder.recording["x"]
        t = np.asarray(r["cycle"]) * s.period - begin - delay
        due = np.asarray([signal(one) if one > 0 else 0.0 for one in t])
        away = np.abs(np.asarray(r["set_position"]) - due)[t > 0.8]  # after it has caught up
        assert away.max() < within + 150 * 0.002
        v = np.asarray(r["set_velocity"])
        assert np.abs(np.diff(r["set_position"]) - 0.5 * (v[1:] + v[:-1]) * s.period).max() < 1e-4
        x.halt().wait()


@pytest.mark.parametrize("timeout", [0.05, 0.3])
def test_a_stream_that_stops_stops_the_axis(timeout: float) -> None:
    """AX-114: on with the last velocity until the timeout, then a stop within limits; the axis may be used at once."""
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        x.power().wait()
        stream = x.stream(delay=0.01, timeout=timeout)
        s.run(1.0)
        assert stream.active  # before the first set point nothing is missing
        with s.record("x") as recorder:
            for i in range(40):
                x.stream_point(position=1.5 * i, time=0.02 * i)
                s.step(20)
            last = s.now
            stream.wait_final()
        assert stream.error_id == ENDED
        assert s.now - last == pytest.approx(timeout - 0.02, abs=0.003)
        s.run(0.5)
        assert x.state is takt.PlcState.STANDSTILL
        takt.expect.within_limits(recorder.recording, "x")
        x.move_absolute(position=0).wait()


def test_what_cannot_be_followed_is_refused_and_the_stream_goes_on() -> None:
    """AX-114: each with its own sentence; the axis does not notice."""
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        assert x.stream_point(position=1).wait_final().error_id == 3005
        x.power().wait()
        stream = x.stream(key=5, delay=0.05)
        s.step(3)
        bad = [
            ({"position": math.nan}, 5),
            ({"position": 1.0, "velocity": math.inf}, 5),
            ({"position": 1.0, "velocity": 301.0}, 5),
            ({"position": 1.0, "time": math.nan}, 5),
            ({"position": 1.0, "key": 4}, OTHER_STREAM),
            ({"position": 199.9}, JUMP),
            ({"position": 201.0}, 8),
        ]
        with s.record("x") as recorder:
            for i in range(80):
                t = 0.01 * i
                good = x.stream_point(position=40 * math.sin(2 * t), time=t, key=5)
                s.step(5)
                assert good.done, good.sentence
                given, error = bad[i % len(bad)]
                refused = x.stream_point(**({"time": t + 0.005, "key": 5} | given))
                again = x.stream_point(position=3, time=t, key=5)
                before = x.stream_point(position=3, time=t - 1, key=5)
                s.step(5)
                assert (refused.error_id, again.error_id, before.error_id) == (error, LATE, LATE)
                assert refused.sentence
        assert stream.active
        takt.expect.within_limits(recorder.recording, "x")
        assert x.set_position == pytest.approx(40 * math.sin(2 * (0.01 * 79 - 0.04)), abs=1.0)


def test_two_clients_for_one_stream() -> None:
    """AX-114: the second stream takes over, smoothly; set points of the first one are refused from then on."""
    with takt.Engine(MACHINE) as s:
        x = s.axis("x")
        x.power().wait()
        first = x.stream(key=1)
        answers = []
        second = None
        with s.record("x") as recorder:
            for i in range(150):
                if i == 70:
                    second = x.stream(key=2)
                answers.append(x.stream_point(position=0.8 * i, time=0.01 * i, key=1))
                if second is not None:
                    x.stream_point(position=50 - 0.3 * (i - 70), time=500 + 0.01 * i, key=2)
                s.step(10)
        assert first.aborted
        assert second is not None
        assert second.reached
        assert {answer.error_id for answer in answers[71:]} == {OTHER_STREAM}
        takt.expect.within_limits(recorder.recording, "x")


def test_stops_end_a_stream() -> None:
    """AX-114, AX-100: halt, stop, power off and emergency stop; set points that come later move nothing."""
    for verb, arguments in (("halt", {}), ("stop", {}), ("power", {"enable": False}), ("emergency", {})):
        with takt.Engine(MACHINE) as s:
            x = s.axis("x")
            x.power().wait()
            stream = x.stream()
            given = []
            for i in range(120):
                given.append(x.stream_point(position=0.9 * i, time=0.01 * i))
                if i == 60:
                    s.command("machine", "emergency_stop") if verb == "emergency" else s.command("x", verb, arguments)
                s.step(10)
            assert stream.aborted
            assert given[-1].error_id == 3005
            assert x.set_velocity == 0


def test_a_rotary_axis_goes_round() -> None:
    """AX-114: positions in a turn, by the shorter way from one to the next."""
    with takt.Engine(MACHINE) as s:
        r = s.axis("r")
        r.power().wait()
        r.stream(delay=0.02)
        with s.record("r") as recorder:
            for i in range(300):
                r.stream_point(position=(350 + 2.5 * i) % 360, time=0.01 * i)
                s.step(10)
        velocity = np.asarray(recorder.recording["r"]["set_velocity"])[-500:]
        assert velocity == pytest.approx(250, abs=0.1)


def test_over_lcm(tmp_path: Path) -> None:
    """AX-114: from another process, in real time."""
    url = new_url()
    with running(tmp_path, url, machine=MACHINE), takt.connect(url) as session:
        x = session.axis("x")
        x.power().wait()
        stream = x.stream(key=3, delay=0.2, timeout=5.0)
        session.wait(lambda: stream.active)
        asked = []
        for i in range(60):
            t = 0.01 * i
            position, velocity = 20 * (1 - math.cos(2 * t)), 40 * math.sin(2 * t)
            asked.append(x.stream_point(position=position, velocity=velocity, time=t, key=3))
            session.run(0.01)
        asked.append(x.stream_point(position=30, time=2.0, velocity=0, key=3))
        session.wait(lambda: all(one.final for one in asked))
        assert sum(one.done for one in asked) > 50
        session.wait(lambda: abs(x.set_position - 30) < 1e-3 and abs(x.set_velocity) < 1e-3)
        x.halt().wait()
        assert stream.aborted
