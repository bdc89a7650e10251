"""GR-01, GR-02, GR-10, GR-20, EN-20, EN-22, EN-40: a group over LCM on taktd, with a client that loses a fifth of all
messages either way: everything ends as it does in process, each command counts once, and the run is replayed bit for
bit."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from takt.demo import free_url, taktd
from takt.feedback import Feedback
from takt.remote import RemoteSession

CELL = """\
name: cell
cycle: {period_s: 0.001}
lcm: {axis_rate_hz: 250, dead_man_s: 2}
axes:
  - {name: a1, unit: deg, limits: {velocity: 600, acceleration: 6000, jerk: 200000}}
  - {name: a2, unit: deg, limits: {velocity: 600, acceleration: 6000, jerk: 200000}}
  - {name: z, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -200, upper: 50}}
  - {name: c, unit: deg, limits: {velocity: 900, acceleration: 9000, jerk: 300000}}
  - {name: feed, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: arm
    axes: [a1, a2, z, c]
    kinematics: {scara: {first_arm: 325, second_arm: 275}}
    path: {velocity: 400, acceleration: 4000, jerk: 200000}
paths:
  - name: hook
    elements:
      - {shape: line, to: {x: 30, y: 0, z: 0}}
      - {shape: arc, via_x: 40, via_y: 10, via_z: 0, to: {x: 30, y: 20, z: 0}}
      - {shape: line, to: {x: 0, y: 20, z: 0}}
"""
LOST = 0.2
Ending = tuple[str, str, int]


def play(session: takt.Session) -> list[Ending]:
    """What a cell does in a shift; how each command ended."""
    arm = session.group("arm")
    endings: list[Ending] = []

    def over(feedback: Feedback) -> None:
        feedback.wait_final(30)
        endings.append((feedback.verb, feedback.state.name.lower(), feedback.error_id))

    def until(condition: Callable[[], bool]) -> None:
        session.wait(condition, 30)

    over(arm.move_linear_absolute(x=400))  # refused: not enabled
    over(arm.power())
    over(session.axis("feed").power())
    over(arm.enable())
    over(arm.set_cartesian_transform(pcs=2, x=380, y=80, c=30))
    until(lambda: arm.product_system(2) == (380, 80, 0, 0, 0, 30))
    over(arm.move_direct_absolute(x=380, y=80, z=0, c=30, coordinate_system="mcs"))
    # Moves that would show if one came twice.
    corner = {"buffer_mode": "blending_next", "transition_mode": "max_corner_deviation", "transition_parameter": 2}
    moves = [arm.move_linear_relative(x=40, velocity=40)]
    moves += [arm.move_linear_relative(y=step, velocity=60, **corner) for step in (-30, -30, 60)]
    moves.append(arm.move_linear_relative(x=-40, velocity=60, **corner))
    for move in moves:
        over(move)
    over(arm.move_linear_absolute(x=900))  # beyond its reach
    slow = arm.move_path(path="hook", coordinate_system="pcs", pcs=2, velocity=25)
    until(lambda: arm.path_position > 5)
    over(arm.interrupt())
    until(lambda: arm.interrupted)
    over(arm.move_circular_relative(aux_x=5, aux_y=5, x=10, buffer_mode="buffered", velocity=-1))  # no speed
    over(arm.continue_path())
    over(slow)
    over(arm.move_circular_relative(aux_x=5, aux_y=5, x=10, velocity=30))
    over(arm.sync_axis(axis="z"))  # a member: it would follow itself
    held = arm.stop(hold=True)
    until(lambda: arm.state is takt.GroupState.GROUP_STOPPING)
    session.run(2.5)  # beyond the dead man's time: heartbeats keep it, though some are lost
    assert arm.state is takt.GroupState.GROUP_STOPPING
    held.release()
    until(lambda: arm.state is takt.GroupState.GROUP_STANDBY)
    over(held)
    over(arm.add_axis(axis="feed", ident=5))
    until(lambda: [axis.name for axis in arm.members] == ["a1", "a2", "z", "c", "feed"])
    over(arm.move_linear_relative(x=-10, a5=25))
    over(arm.disable())
    return endings


def final(session: takt.Session) -> Sequence[float]:
    return (*session.group("arm").pose, session.axis("feed").set_position)


@pytest.fixture(scope="module")
def in_process() -> tuple[list[Ending], Sequence[float]]:
    with takt.Engine(CELL) as session:
        return play(session), final(session)


def lossy(method: Callable[..., None], chance: random.Random, at: int, channel: str) -> Callable[..., None]:
    """The method, which now and then does not get a message of such a channel."""

    def some(*arguments: Any) -> None:
        if not (arguments[at].startswith(channel) and chance.random() < LOST):
            method(*arguments)

    return some


def test_in_process(in_process: tuple[list[Ending], Sequence[float]]) -> None:
    """The numbers by hand: all of them cancel but the path's end, the half circle and the last move."""
    endings, pose = in_process
    refused = [(verb, error) for verb, state, error in endings if state == "error"]
    assert [verb for verb, _ in refused] == [
        "move_linear_absolute",
        "move_linear_absolute",
        "move_circular_relative",
        "sync_axis",
    ]
    assert [error for _, error in refused] == [3025, 3021, 5, 3018]
    assert all(state == "done" for _, state, error in endings if not error)
    turn = np.radians(30)
    assert pose[:2] == pytest.approx((380 - 20 * np.sin(turn), 80 + 20 * np.cos(turn)), abs=1e-6)
    assert pose[6] == pytest.approx(25, abs=1e-9)


def test_on_taktd(
    in_process: tuple[list[Ending], Sequence[float]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = random.Random(1)
    machine, log, url = tmp_path / "cell.yaml", tmp_path / "cell.log", free_url()
    machine.write_text(CELL)
    with taktd(machine, url, log, "paced", tmp_path), takt.connect(url) as first:
        assert first.group("arm").state is takt.GroupState.GROUP_DISABLED
        for method, at, channel in (
            ("_on_state", 1, "takt/group"),
            ("_on_feedback", 1, "takt/feedback"),
            ("_publish", 1, "takt/"),
        ):
            monkeypatch.setattr(RemoteSession, method, lossy(getattr(RemoteSession, method), chance, at, channel))
        with takt.connect(url) as session:
            assert play(session) == in_process[0]
            session._catch_up(session.cycle)
            assert final(session) == pytest.approx(in_process[1], abs=1e-9)
            assert session.losses["takt/group/arm"] > 100
            assert session.losses["takt/feedback"] > 3
        monkeypatch.undo()
        assert first.group("arm").state is takt.GroupState.GROUP_DISABLED
    recording = takt.read_log(log)
    for axis in ("a1", "a2", "z", "c", "feed"):
        assert takt.expect.within_limits(recording, axis)
        assert takt.expect.continuous(recording, axis)
    replayed = takt.replay(log)
    assert replayed.same, replayed.sentence
