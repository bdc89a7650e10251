"""Tracks as scenarios see them: from the machine file and by commands, linked to networks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from takt import Engine
from takt.cli import main
from takt.track_layout import TrackLayout

# The network of the manual's chapter 6.2.10, as a machine file says it.
LINES_ONE = [((250, 120), (650, 120)), ((700, 170), (800, 450)), ((650, 500), (250, 500))]
NETWORK = """
name: network
axes: []
tracks:
  - name: one
    elements:
      - {from: {x: 250, y: 120}, to: {x: 650, y: 120}}
      - {from: {x: 700, y: 170}, to: {x: 800, y: 450}}
      - {from: {x: 650, y: 500}, to: {x: 250, y: 500}}
  - {name: two, starts_from: [one], ends_at: [one], elements: [{from: {x: 200, y: 450}, to: {x: 200, y: 170}}]}
  - {name: three, starts_from: [one], elements: [{from: {x: 200, y: 500}, to: {x: 120, y: 500}}]}
  - {name: four, starts_from: [one], elements: [{from: {x: 200, y: 550}, to: {x: 200, y: 750}}]}
"""
EMPTY = """
name: empty
axes: []
tracks: [{name: one}, {name: two}, {name: three}, {name: four}]
"""


def line(start: tuple[float, float], end: tuple[float, float]) -> dict[str, float]:
    return {"start_x": start[0], "start_y": start[1], "end_x": end[0], "end_y": end[1]}


def quadrature(track: takt.Track) -> float:
    """The length of a track from places along it alone: polygons with n and 2n sides, extrapolated."""
    sums = []
    for n in (2000, 4000):
        places = np.array([(p.x, p.y) for p in (track.position_at(s) for s in np.linspace(0, track.length, n + 1))])
        sums.append(float(np.hypot(*np.diff(places, axis=0).T).sum()))
    return sums[1] + (sums[1] - sums[0]) / 3


def build_network(engine: Engine) -> list[takt.Feedback]:
    """The manual's program: state by state, without waiting for feedback."""
    one, two, three, four = (engine.track(name) for name in ("one", "two", "three", "four"))
    given = [one.append_line(**line(*ends)) for ends in LINES_ONE]
    engine.step()
    given += [two.start_from_track(track="one"), two.append_line(**line((200, 450), (200, 170)))]
    given += [two.end_at_track(track="one")]
    engine.step()
    given += [three.start_from_track(track="one"), three.append_line(**line((200, 500), (120, 500)))]
    engine.step()
    given += [four.start_from_track(track="one"), four.append_line(**line((200, 550), (200, 750)))]
    engine.step()
    given += [track.enable() for track in (one, two, three, four)]
    engine.wait(lambda: all(track.state.value == "Enabled" for track in engine.tracks.values()), timeout=1)
    return given


def check_network(engine: Engine) -> None:
    one, two, three, four = (engine.track(name) for name in ("one", "two", "three", "four"))
    assert [t.name for t in one.subsequent] == ["two", "three", "four"]
    assert [t.name for t in one.previous] == ["two"]
    assert two.previous == three.previous == four.previous == [one]
    assert two.subsequent == [one]
    assert three.subsequent == four.subsequent == []
    assert [t.previous_tracks for t in (one, two, three, four)] == [1, 1, 1, 1]
    assert [t.subsequent_tracks for t in (one, two, three, four)] == [3, 1, 0, 0]
    # Longer than the straight ways from place to place, shorter than the ways around the corners.
    straight = {
        one: 400 + math.hypot(50, 50) + math.hypot(100, 280) + math.hypot(150, 50) + 400,
        two: math.hypot(50, 50) + 280 + math.hypot(50, 50),
        three: 50 + 80,
        four: math.hypot(50, 50) + 200,
    }
    around = {one: 1700.0, two: 480.0, three: 130.0, four: 300.0}
    for track, least in straight.items():
        assert least - 1e-6 <= track.length <= around[track] + 1e-6
        assert track.length == pytest.approx(quadrature(track), abs=1e-6)
        assert track.operation_mode.value == "Standing"
        for s in np.linspace(0, track.length, 7):
            at = track.position_at(s)
            assert track.arc_length_closest_to(at.x, at.y) == pytest.approx(s, abs=1e-6)
    for track in (two, three, four):  # place, direction and curvature go on where tracks meet
        end, start = one.position_at(one.length), track.position_at(0)
        assert (start.x, start.y) == pytest.approx((end.x, end.y), abs=1e-9)
        assert math.remainder(start.direction - end.direction, 360) == pytest.approx(0, abs=1e-6)
        assert start.curvature == pytest.approx(end.curvature, abs=1e-9)


@pytest.fixture
def empty() -> Iterator[Engine]:
    with Engine(EMPTY) as engine:
        engine.step()
        yield engine


def test_the_manuals_network_from_the_machine_file() -> None:
    """PL-20, PL-23, PL-50."""
    with Engine(NETWORK) as engine:
        engine.step()
        for track in engine.tracks.values():
            assert (track.state.value, track.operation_mode.value) == ("Disabled", "Uninitialized")
            track.enable()
        engine.run(0.01)
        check_network(engine)


def test_the_manuals_network_by_its_program(empty: Engine) -> None:
    """PL-20, PL-23, PL-50: the same to the last bit."""
    given = build_network(empty)
    assert all(f.done for f in given), [f.sentence for f in given]
    check_network(empty)
    with Engine(NETWORK) as other:
        other.step()
        assert {t.name: t.length for t in empty.tracks.values()} == {t.name: t.length for t in other.tracks.values()}


def test_states_and_modes() -> None:
    """PL-01, PL-22."""
    with Engine(NETWORK) as engine:
        one = engine.track("one")
        enable = one.enable()
        seen = []
        for _ in range(4):
            engine.step()
            seen.append(one.state.value)
        assert seen[:2] == ["Enabling", "Enabled"]
        assert enable.done
        disable, enable = one.disable(), one.enable()
        engine.step()
        assert disable.aborted
        assert one.state.value == "Enabling"
        enable.wait()
        assert one.operation_mode.value == "Standing"
        one.disable().wait()
        assert (one.state.value, one.operation_mode.value) == ("Disabled", "Uninitialized")
        reset = one.reset()
        engine.step()
        assert reset.done  # there is nothing to reset


def refuse(engine: Engine, feedback: takt.Feedback, sentence: str) -> None:
    engine.wait(lambda: feedback.final, timeout=1)
    assert feedback.error
    assert sentence in feedback.sentence


def test_what_cannot_be_is_refused_with_a_sentence(empty: Engine) -> None:
    """PL-20, PL-23: and changes nothing."""
    one, two = empty.track("one"), empty.track("two")
    refuse(empty, one.enable(), "the track has no length")
    empty.run(0.01)
    assert one.state.value == "Disabled"
    refuse(empty, one.append_line(start_x=1, start_y=2, end_x=1, end_y=2), "begins where it ends, or a position is")
    refuse(empty, two.start_from_track(track="one"), "the other track has no length yet")
    refuse(empty, one.start_from_track(track="one"), "expected the name of another track, found 'one'")
    refuse(empty, one.start_from_track(track="tow"), "did you mean two?")
    refuse(empty, one.append_line(start_x=0, start_y=0, end_x=2e6, end_y=0), "end_x: expected ")
    one.append_line(**line((0, 0), (300, 0))).wait()
    refuse(empty, one.append_line(**line((300, 0), (300, 100))), "leave a gap for the transition, in element 2")
    refuse(empty, one.append_circle(start_x=400, start_y=0, end_x=500, end_y=0, center_x=440, center_y=0), "equally")
    refuse(empty, one.append_line(**line((150, 200), (150, -200))), "the track crosses or touches itself")
    assert (one.length, one.element_count) == (300, 1)
    one.append_line(**line((400, 100), (400, 400))).wait()
    two.start_from_track(track="one").wait()
    for change in (one.append_position(x=0, y=900), one.clear(), one.close_loop()):
        refuse(empty, change, "other tracks start from this one or end at it")
    refuse(empty, two.close_loop(), "cannot be a closed loop")
    two.clear().wait()
    one.enable().wait()
    refuse(empty, one.clear(), "only while it is disabled")
    refuse(empty, one.append_position(x=0, y=900), "only while it is disabled")
    one.disable().wait()
    one.append_line(**line((300, 500), (100, 500))).wait()
    one.close_loop().wait()
    assert one.closed_loop
    refuse(empty, one.append_position(x=0, y=900), "nothing can be appended")
    refuse(empty, two.start_from_track(track="one"), "a closed loop, which neither starts nor ends")
    one.clear().wait()
    assert (one.length, one.element_count, one.closed_loop) == (0, 0, False)
    with pytest.raises(takt.TaktError, match="one has no length"):
        one.position_at(0)


def test_tracks_do_not_refer_to_one_another_in_circles() -> None:
    """PL-23: neither directly nor over a third one; two links to the same track are no circle."""
    ends = {"a": (100, 300), "b": (0, 100), "c": (300, 500)}
    lines = [{"name": name, "elements": [{"from": {"x": x0, "y": 0}, "to": {"x": x1, "y": 0}}]}
             for name, (x0, x1) in ends.items()]  # fmt: skip
    with Engine({"name": "rows", "axes": [], "tracks": lines}) as engine:
        a, b, c = (engine.track(name) for name in "abc")
        b.end_at_track(track="a").wait()
        refuse(engine, a.start_from_track(track="b"), "its geometry stays until they are cleared")
        b.end_at_track(track="a").wait()
        c.start_from_track(track="a").wait()
        refuse(engine, a.end_at_track(track="c"), "its geometry stays until they are cleared")
        b.clear().wait()
        c.clear().wait()
        a.clear().wait()


def test_no_ninth_link_is_lost() -> None:
    """PL-23, PL-33: links to the same track at other positions of its part count by themselves."""
    system = {"coordinate_system": "w"}
    parts = [{"name": name, "positions": [system | {"x": x}, system | {"x": x, "y": 1000}]}
             for name, x in (("left", 0), ("right", 240))]  # fmt: skip

    def line(name: str, part: str, x0: float, x1: float) -> dict[str, object]:
        return {"name": name, "part": part, "elements": [{"from": {"x": x0, "y": 120}, "to": {"x": x1, "y": 120}}]}

    tracks = [line("own", "right", 0, 200), *(line(f"t{k}", "left", 20 + k, 240) for k in range(8))]
    machine = {"name": "m", "axes": [], "coordinate_systems": [{"name": "w"}], "parts": parts, "tracks": tracks}
    with Engine(machine) as engine:
        own = engine.track("own")

        def link(track: str, index: int) -> takt.Feedback:
            only = {"this_position_index": index, "other_position_index": index, "only_there": True}
            return own.start_from_track(track=track, **only)

        link("t0", 1).wait()
        for k in range(1, 8):
            own.start_from_track(track=f"t{k}").wait()
        refuse(engine, link("t0", 2), "starts from at most 8 tracks")
        link("t0", 1).wait()
        own.start_from_track(track="t1").wait()


def test_a_track_takes_64_elements(empty: Engine) -> None:
    one = empty.track("one")
    for i in range(64):
        one.append_line(start_x=100 * i, start_y=0, end_x=100 * i + 50, end_y=0).wait()
    assert (one.element_count, one.length) == (64, pytest.approx(6350))
    refuse(empty, one.append_line(start_x=6400, start_y=0, end_x=6450, end_y=0), "at most 64 elements")


def test_a_whole_circle_becomes_a_loop(empty: Engine) -> None:
    """PL-20."""
    one = empty.track("one")
    one.append_circle(start_x=200, start_y=0, end_x=200, end_y=0, center_x=0, center_y=0).wait()
    one.close_loop().wait()
    assert one.length == pytest.approx(2 * math.pi * 200, rel=1e-12)
    assert one.position_at(2.5 * one.length).x == pytest.approx(-200)
    assert one.position_at(0).curvature == pytest.approx(1 / 200)
    for bad in (math.nan, math.inf):
        with pytest.raises(takt.TaktError, match="is no place on it"):
            one.position_at(bad)
        with pytest.raises(takt.TaktError, match="is no place in the plane"):
            one.arc_length_closest_to(bad, 0)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("[one], ends_at", "[ona], ends_at", "starts_from[0]: expected the name of a track, found 'ona'; did"),
        ("name: three, starts_from: [one]", "name: three, starts_from: [four, four]", "found 'four' again"),
        ("- name: one\n", "- name: one\n    starts_from: [four]\n", "in no circle, found one -> four -> one"),
        ("- name: one\n", "- name: one\n    ends_at: [one]\n", "in no circle, found one -> one"),
        ("- name: one\n", "- name: one\n    closed_loop: true\n", "the other track is a closed loop"),
        ("{from: {x: 700, y: 170}, to", "{from: {x: 650, y: 120}, to", "tracks[0].elements[1]: two pieces of the"),
        ("{from: {x: 700, y: 170}, to", "{to", "must be given for a line or a circle"),
        ("to: {x: 800, y: 450}}", "to: {x: 800, y: 450}, center: {x: 0, y: 0}}", "must be given for a circle, and"),
        ("from: {x: 650, y: 500}", "from: {x: 450, y: 20}", "tracks[0]: the track crosses or touches itself, "),
        ("name: four", "name: four, collision_range_at_end: -1", "collision_range_at_end: expected"),
        ("name: four", "name: one", "again"),
        ("name: four", "name: four, mover_width: 0", "mover_width: expected"),
    ],
)  # fmt: skip
def test_machine_files_that_cannot_be(old: str, new: str, sentence: str) -> None:
    """PL-20, PL-23: which track, which element, and why."""
    assert old in NETWORK
    with pytest.raises(takt.ConfigError) as refused:
        Engine(NETWORK.replace(old, new))
    assert any(sentence in problem for problem in refused.value.problems), refused.value.problems


def test_a_replay_makes_the_same_tracks() -> None:
    """PL-20, EN-07: answers come from the journal, the geometry is made once more."""
    with Engine(EMPTY, journal=True) as engine:
        build_network(engine)
        engine.track("three").disable().wait()
        bad = engine.track("three").append_line(**line((120, 500), (120, 600)))
        engine.track("three").append_line(**line((100, 520), (100, 600)))
        engine.run(0.02)
        assert bad.error
        journal = engine.take_journal()
        cycles, hashes = engine.take_hashes()
        length = engine.track("three").length
    core = takt._core.Engine(EMPTY.encode(), "machine", journal=True, checks=False)
    for cycle in cycles:
        for at, ticket, lease, target, verb, arguments in journal:
            if at == cycle:
                assert core.resubmit(target, verb, arguments, ticket, lease)[1] == 0
        core.step(1)
    again = core.take_hashes()[1]
    assert list(again) == list(hashes)
    assert core.track_at(2, length)[1] == pytest.approx(600)
    assert sum(verb == "track_made" for *_, verb, _ in journal) > 10


@pytest.mark.parametrize("pace", ["paced", "real"])
def test_taktd_makes_tracks_and_its_log_replays(tmp_path: Path, pace: str) -> None:
    """PL-20, EN-07, EN-11: in another process, between two cycles or in a thread of its own."""
    url, log = new_url(), tmp_path / "run.lcm"
    with running(tmp_path, url, "--log", str(log), machine=EMPTY, pace=pace), takt.connect(url) as session:
        one, two = session.track("one"), session.track("two")
        given = [one.append_line(**line(*ends)) for ends in LINES_ONE]
        given += [two.start_from_track(track="one"), two.append_line(**line((200, 450), (200, 170)))]
        given += [two.end_at_track(track="one"), one.enable(), two.enable()]
        for feedback in given:
            feedback.wait()
        session.wait(lambda: two.state.value == "Enabled", timeout=5)
        assert (two.previous_tracks, two.subsequent_tracks) == (1, 1)
        refused = two.clear().wait_final()
        assert refused.sentence.startswith("the geometry of a track can be changed only while it is disabled")
        with pytest.raises(takt.TaktError, match=r"track two: it is .* mm long, 0 mm in the machine file"):
            two.position_at(0)
        length = two.length
    result = takt.replay(log)
    assert result.same, result.sentence
    with Engine(NETWORK) as engine:
        engine.step()
        assert engine.track("two").length == length


def test_the_command_says_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`takt track`: of a file with tracks alone."""
    file, target = tmp_path / "layout.yaml", tmp_path / "layout.png"
    file.write_text(NETWORK.replace("name: network\naxes: []\n", ""))
    assert main(["track", str(file), "--draw", str(target)]) == 0
    text = capsys.readouterr().out
    layout = TrackLayout(file)
    one, two, three, four = layout.tracks
    assert f"{file}: 4 tracks, " in text
    for track in layout.tracks:
        assert f"{track.length:.3f}" in text
        if track.smallest_radius < math.inf:
            assert f"{track.smallest_radius:.4g}" in text
    assert (one.subsequent, two.subsequent, three.previous) == (("two", "three", "four"), ("one",), ("one",))
    assert target.read_bytes().startswith(b"\x89PNG")
    # What movers keep to is found in passing: no less, and at most 40 mm more.
    for track in layout.tracks:
        for kept, range_ in zip(track.traffic_ranges, (track.range_at_start, track.range_at_end), strict=True):
            assert range_ - 1 <= kept <= range_ + 40 or range_ == kept == 0
    # Two and four leave to either side, three goes straight on: behind their ranges movers of 155 mm, turned as they
    # like, are a diagonal apart.
    diagonal = math.hypot(155, 155)
    assert 0 < two.range_at_start <= two.length
    assert four.range_at_start == pytest.approx(two.range_at_start, rel=0.5)
    assert one.range_at_start == pytest.approx(0)
    assert two.range_at_end == pytest.approx(0)
    for track in (two, three, four):
        apart = [
            min(float(np.hypot(o.points.x - x, o.points.y - y).min()) for o in (two, three, four) if o is not track)
            for s, x, y in zip(track.points.s, track.points.x, track.points.y, strict=True)
            if s > track.range_at_start + 1
        ]
        assert not apart or min(apart) >= diagonal - 0.1


def test_the_command_counts_one_track(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "layout.yaml"
    file.write_text("tracks:\n  - {name: one, elements: [{from: {x: 0, y: 0}, to: {x: 500, y: 0}}]}\n")
    assert main(["track", str(file)]) == 0
    assert f"{file}: 1 track, 500 mm" in capsys.readouterr().out


def test_the_command_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "layout.yaml"
    file.write_text("tracks:\n  - {name: one, elements: [{from: {x: 0, y: 0}, to: {x: 0, y: 0}}]}\n")
    assert main(["track", str(file)]) == 2
    error = capsys.readouterr().err
    assert f"{file}:2:" in error
    assert "tracks[0].elements[0]: a line begins where it ends" in error
    file.write_text("tracks: []\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\n")
    assert main(["track", str(file)]) == 2
    assert "expected a section tracks" in capsys.readouterr().err
    assert main(["track", str(file), "--draw", "picture.txt"]) == 2


SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="1000mm" height="600mm" viewBox="0 0 1000 600">
<rect x="100" y="100" width="800" height="300"/><circle cx="500" cy="250" r="90"/>
<path d="M 50 500 L 400 500 A 80 80 0 0 1 480 580 L 480 590"/></svg>
"""


def drawn(directory: Path, suffix: str) -> Path:
    """A rectangle of 800 by 300 mm, a circle of 90 mm radius, and a line that becomes an arc and a line again."""
    file = directory / f"drawing{suffix}"
    if suffix == ".svg":
        file.write_text(SVG)
        return file
    import ezdxf

    drawing = ezdxf.new(units=ezdxf.units.CM)
    space = drawing.modelspace()
    space.add_lwpolyline([(10, 20), (90, 20), (90, 50), (10, 50)], close=True)
    space.add_circle((50, 35), 9)
    space.add_line((48, 2), (48, 1))  # the last one first, and against its sense
    space.add_line((40, 10), (5, 10))
    space.add_arc((40, 2), 8, 0, 90)
    drawing.saveas(file)
    return file


@pytest.mark.parametrize("suffix", [".svg", ".dxf"])
def test_drawings_become_tracks(tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str) -> None:
    file, target = drawn(tmp_path, suffix), tmp_path / "layout.yaml"
    assert main(["track", str(file), "--corner", "30", "--yaml", str(target)]) == 0
    assert f"{file}: 3 tracks" in capsys.readouterr().out
    rectangle, circle, open_one = TrackLayout(target).tracks
    assert rectangle.closed
    corners = 4 * (2 * 30 - math.hypot(30, 30))  # at most that is saved by cutting the corners
    assert 2200 - corners < rectangle.length < 2200
    assert circle.closed
    assert circle.length == pytest.approx(2 * math.pi * 90, rel=1e-9)
    assert not open_one.closed
    assert open_one.length == pytest.approx(350 + math.pi / 2 * 80 + 10, abs=5)
    ends = {(round(float(open_one.points.x[i])), round(float(open_one.points.y[i]))) for i in (0, -1)}
    assert ends == {(50, 100), (480, 10)}
    assert main(["track", str(target)]) == 0


def test_what_is_no_drawing_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, text, sentence in (
        ("a.svg", "<svg", "is no SVG"),
        ("b.svg", SVG[: SVG.index("<rect")] + "</svg>", "no outlines are drawn in it"),
        ("c.dxf", "no drawing", "is no DXF"),
        ("d.yaml", EMPTY, "are for drawings"),
    ):
        (tmp_path / name).write_text(text)
        arguments = ["--corner", "5"] if name.endswith("yaml") else []
        assert main(["track", str(tmp_path / name), *arguments]) == 2
        assert sentence in capsys.readouterr().err
