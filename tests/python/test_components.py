"""One list of the kinds of components: whatever names, publishes, records or describes them goes by it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import takt
from every_kind import FULL
from machines import new_url, running
from takt import _commands, _core, plot, report, style
from takt.session import CLASSES
from takt.tables import KINDS, PREFIXES, components_of

REFERENCE = json.loads(_core.reference())
# The module's section comes first: numbers do not go by the order in the file.
MACHINE = """
name: line
lcm: {axis_rate_hz: 1000}
flex_cams:
  - {name: cutter, slave: knife, master: web, cams: [hill], settings: {sync_mode: ramp_time, sync_in_time_s: 0.1}}
axes:
  - {name: web, limits: {velocity: 1000, acceleration: 10000, jerk: 200000}}
  - {name: knife, unit: deg, limits: {velocity: 5000, acceleration: 100000, jerk: 10000000}}
cams:
  - name: hill
    x_unit: mm
    y_unit: deg
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 50, y: 9, v: 0, a: 0}, {x: 100, y: 0, v: 0, a: 0}]
"""


def test_every_kind_is_known_everywhere() -> None:
    """EN-11, PY-02."""
    kinds = [kind["name"] for kind in REFERENCE["kinds"]]
    assert kinds == list(KINDS) == list(CLASSES) == list(REFERENCE["outputs"])
    assert {verb["target_kind"] for verb in REFERENCE["verbs"]} == {"machine", *kinds}
    for kind in REFERENCE["kinds"]:
        assert kind["section"] in {field["name"] for field in REFERENCE["machine"]["fields"]}
        assert PREFIXES[kind["name"]] == f"takt/{kind['name']}/"


def test_values_before_the_first_cycle() -> None:
    """PY-02: those of an idle one, as another process would have heard them, of every kind."""
    with takt.Engine({"name": "full", **FULL}) as engine:
        kinds = {c.KIND: c for c in engine.components.values()}
        fields = {name: list(KINDS[c.KIND].places) for name, c in engine.components.items()}

        def values() -> dict[str, list[object]]:
            return {name: [engine.components[name]._value(f) for f in of] for name, of in fields.items()}

        assert set(kinds) == set(KINDS)
        members = engine.group("arm").members
        first = values()
        assert [axis.name for axis in members] == ["x", "y", "z"]
        engine.step()
        for name, after in values().items():
            wrong = [f for f, a, b in zip(fields[name], first[name], after, strict=True) if a != b and b == b]
            tracks = engine.components[name].KIND == "track"
            assert not wrong or tracks, (name, wrong)  # tracks are made while the first cycles run


def test_speeds_have_units_of_speeds() -> None:
    """PY-04: also where a field is one of several of a struct."""
    for kind in KINDS.values():
        for field, unit in kind.units.items():
            if "velocity" in field:
                assert unit.endswith("/s"), field
            if "acceleration" in field:
                assert unit.endswith("/s2"), field


def test_arguments_left_out_go_by_the_kind_of_component() -> None:
    """PY-03: an axis and a cam module both have a command jog, with arguments of their own."""
    assert set(_commands.DEFAULTS["axis", "jog"]) == {"forward", "backward"}
    assert set(_commands.DEFAULTS["flex_cam", "jog"]) == {"positive", "negative"}
    assert _commands.DEFAULTS["flex_cam", "configure"] == {}
    assert {("axis", "jog"), ("axis", "stop"), ("flex_cam", "jog")} <= _commands.LEVEL_SENSITIVE


def test_components_are_numbered_by_kind() -> None:
    """PY-02."""
    with takt.Engine(MACHINE) as engine:
        assert [(c.name, c.index, c.KIND) for c in engine.components.values()] == [
            ("web", 0, "axis"),
            ("knife", 1, "axis"),
            ("cutter", 2, "flex_cam"),
        ]
        assert list(components_of(engine.machine)) == ["web", "knife", "cutter"]
        cutter = engine.flex_cam("cutter")
        assert cutter.slave is engine.axis("knife")
        assert cutter.master is engine.axis("web")
        unknown = engine.command("cuter", "control")
        kinds = (
            "an axis, a cam module, a group of axes, a belt, a pose, a pick and place module, a mover, a track, "
            "a group of movers, an environment, a part"
        )
        assert f"expected the name of {kinds} or machine, found 'cuter'" in unknown.sentence


def recording() -> takt.Recording:
    with takt.Engine(MACHINE) as engine:
        recorder = engine.record()
        web, cutter = engine.axis("web"), engine.flex_cam("cutter")
        web.power().wait()
        cutter.control(regulator_on=True).wait()
        engine.wait(lambda: cutter.axis_enabled)
        web.move_velocity(velocity=200)
        cutter.control(sync_cam=True).wait()
        engine.run(0.5)
        return recorder.stop()


def test_x_and_y_of_a_module_have_lanes_of_their_own(tmp_path: Path) -> None:
    """PY-04: they are in units of their own, and no positions of an axis."""
    made = recording()
    usual = plot.select(made, ["cutter"])
    assert usual == [
        ("cutter", "set_x_position"),
        ("cutter", "set_y_position"),
        ("cutter", "set_y_velocity"),
        ("cutter", "state"),
        ("cutter", "cam_synchronised"),
    ]
    figure = plot.draw(made, "*.set_position", "cutter", events=False)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels == [
        "position\n[mm]",
        "position\n[deg]",
        "x position\n[mm]",
        "y position\n[deg]",
        "y velocity\n[deg/s]",
        "",
    ]
    plot.save(figure, tmp_path / "module.png")
    assert made.unit("cutter", "actual_slave_velocity") == "deg/s"


def test_every_state_has_a_colour_of_its_own() -> None:
    """PY-04."""
    for kind in KINDS.values():
        assert set(kind.names.get("state", {}).values()) <= set(style.STATES)


def test_a_report_has_modules_beside_axes(tmp_path: Path) -> None:
    """PY-05."""
    page = report.write_report(recording(), [], tmp_path, "a line with a module")
    assert [p.name for p in page.pictures] == ["overview.png", "web.png", "knife.png", "cutter.png"]
    found = re.search(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page.html.read_text(), re.DOTALL)
    assert found
    rows = json.loads(found[1])["summary"]["rows"]
    assert [(row[0], row[6]) for row in rows] == [
        ("web", "ContinuousMotion"),
        ("knife", "SynchronizedMotion"),
        ("cutter", "Sync"),
    ]
    assert rows[2][2] == "0 … 9 deg"


def test_taktd_says_what_the_machine_has(tmp_path: Path) -> None:
    """EN-02."""
    with running(tmp_path, new_url(), machine=MACHINE) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("line: 2 axes, 1 cam module, cycle 1 ms, ")
