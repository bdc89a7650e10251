"""PY-24: single values of machine files and parameters of scenarios, given for a run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
import yaml
from takt.changes import Value, changed, text_of, value_of
from takt.cli import main
from takt.scenario import load_scenario, settings_of, with_settings
from takt.yaml_text import load

MACHINE = """\
# Two axes, in both styles.
name: m
axes:
  - {name: x, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 50000}} # flow
  - name: y # block
    unit: mm
    limits:
      velocity: 100
      acceleration: 1000
      jerk: 9000
simulation:
  servos: [{axis: x}]
"""
SCENARIO = '''\
"""A move."""
from takt import expect
def scenario(session, velocity=100.0, repeat=1, *, where="there"):
    assert isinstance(velocity, float) and isinstance(repeat, int), (velocity, repeat)
    x = session.axis("x")
    x.power().wait()
    for i in range(repeat):
        x.move_absolute(position=10 * (i + 1), velocity=velocity).wait()
    assert where == "there"
def verify(recording, most=500.0):
    expect.within_limits(recording, "x", velocity=most)
'''


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "scenario.py").write_text(SCENARIO)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_values_are_changed_where_they_stand() -> None:
    changes = {"axes.x.limits.velocity": 250.5, "axes.1.limits.velocity": 7, "axes.y.unit": "in: ch"}
    text = changed(MACHINE.encode(), "m", changes).decode()
    assert text == MACHINE.replace("500,", "250.5,").replace("100\n", "7\n").replace("unit: mm\n", 'unit: "in: ch"\n')


def test_keys_are_added_where_there_are_none() -> None:
    changes = {
        "axes.x.limits.deceleration": 1e-5,
        "axes.y.limits.deceleration": 2,
        "axes.y.supervision.deviation_moving": 3,
        "simulation.servos.x.mechanics.inertia": 4,
        "simulation.servos.x.mechanics.start_position": 5,
        "cycle.period_s": 0.002,
    }
    found = yaml.safe_load(changed(MACHINE.encode(), "m", changes))
    assert found["axes"][1]["limits"] == {"velocity": 100, "acceleration": 1000, "jerk": 9000, "deceleration": 2}
    assert found["axes"][1]["supervision"] == {"deviation_moving": 3}
    assert found["simulation"]["servos"] == [{"axis": "x", "mechanics": {"inertia": 4, "start_position": 5}}]
    assert found["cycle"] == {"period_s": 0.002}


def test_a_key_that_holds_nothing_yet() -> None:
    assert yaml.safe_load(changed(b"name: m\nview:\n", "m", {"view.commands": True}))["view"] == {"commands": True}
    assert yaml.safe_load(changed(b"{name: }", "m", {"name": "n", "cycle.period_s": 1})) == {
        "name": "n",
        "cycle": {"period_s": 1},
    }


def test_an_engine_with_changes() -> None:
    with takt.Engine(MACHINE, changes={"axes.x.limits.velocity": 300, "cycle.period_s": 0.002}) as session:
        assert session.axis("x").parameters["limits"]["velocity"] == 300
        assert session.period == 0.002


@pytest.mark.parametrize(
    ("key", "wrong"),
    [
        ("axes.z.unit", r"m: axes: has no element 'z' \(it has x, y\)"),
        ("axes.2.unit", "has no element '2'"),
        ("axes.x.unit.more", "m: axes.x.unit: holds a value, so there is no axes.x.unit.more"),
        ("axes.x.limits", "m: axes.x.limits: holds further keys"),
        ("axes..x", "is no path of keys"),
    ],
)
def test_what_cannot_be_changed(key: str, wrong: str) -> None:
    with pytest.raises(takt.ConfigError, match=wrong):
        changed(MACHINE.encode(), "m", {key: 1})


@pytest.mark.parametrize(
    "text",
    [
        MACHINE.replace("velocity: 500", "velocity:\t500"),
        MACHINE.replace("velocity: 100\n", "velocity: 100\t# mm/s\n"),
        MACHINE.replace("name: x, unit", "name: x,\tunit"),
        MACHINE.replace("# flow", "# a\u2028b"),
        MACHINE.replace("# flow", "# a\uffffb"),
        json.dumps(yaml.safe_load(MACHINE), indent="\t"),
    ],
)
def test_texts_that_the_engine_reads_can_be_changed(text: str) -> None:
    """PY-24: tabs and line separators do not keep values from being changed."""
    changes = {"axes.x.limits.velocity": 300, "axes.y.limits.velocity": 200, "cycle.period_s": 0.002}
    with takt.Engine(text, changes=changes) as session:
        assert [axis.parameters["limits"]["velocity"] for axis in session.axes.values()] == [300, 200]
        assert session.period == 0.002


def test_characters_beyond_ffff_as_json_writes_them() -> None:
    """EN-10: a pair of surrogates is one character, in machine files and their changes; a single one is refused."""
    machine = yaml.safe_load(MACHINE.replace("name: m", "name: press \N{ELECTRIC PLUG}"))
    escaped = json.dumps(machine, indent=1)
    assert "press \\ud83d\\udd0c" in escaped
    with takt.Engine(escaped, changes={"axes.x.limits.velocity": 300}) as session:
        assert session.name == machine["name"]
        assert session.axis("x").parameters["limits"]["velocity"] == 300
    assert load(escaped) == machine
    with pytest.raises(takt.ConfigError, match=r"machine:2:.*invalid unicode: 55357"):
        takt.Engine(escaped.replace("\\udd0c", ""))


def test_a_text_in_which_no_values_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-24: such a text is refused; the run does not have the values that it was given otherwise."""

    def refuse(*_: Any, **__: Any) -> None:
        raise yaml.YAMLError("why")

    monkeypatch.setattr(yaml, "compose", refuse)
    with pytest.raises(takt.ConfigError, match="m: values cannot be changed in this text: why"):
        changed(MACHINE.encode(), "m", {"axes.x.limits.velocity": 70})


def test_a_run_of_a_file_with_a_tab(folder: Path) -> None:
    """PY-24."""
    (folder / "machine.yaml").write_text(MACHINE.replace("velocity: 500", "velocity:\t500"))
    assert main(["run", "scenario.py", "--set", "velocity=200"]) == 0
    assert main(["run", "scenario.py", "--set", "velocity=200", "--set", "axes.x.limits.velocity=150"]) == 1


def test_names_with_dots() -> None:
    """PY-24: elements of lists go by their names, of which the longest one counts."""
    text = MACHINE.replace("name: x,", "name: a.b,").replace("axis: x}", "axis: a.b}").replace("name: y", "name: a")
    changes = {"axes.a.b.limits.velocity": 3, "axes.a.limits.velocity": 4, "simulation.servos.a.b.mechanics.inertia": 5}
    found = yaml.safe_load(changed(text.encode(), "m", changes))
    assert [axis["limits"]["velocity"] for axis in found["axes"]] == [3, 4]
    assert found["simulation"]["servos"][0] == {"axis": "a.b", "mechanics": {"inertia": 5}}
    with pytest.raises(takt.ConfigError, match=r"axes: has no element 'c' \(it has a\.b, a\)"):
        changed(text.encode(), "m", {"axes.c.d.limits.velocity": 3})


def test_a_value_is_given_once() -> None:
    with pytest.raises(takt.ConfigError, match=r"axes\.x\.limits\.velocity and axes\.0\.limits\.velocity are the same"):
        changed(MACHINE.encode(), "m", {"axes.x.limits.velocity": 1, "axes.0.limits.velocity": 2})


def test_what_the_engine_complains_about() -> None:
    with pytest.raises(takt.ConfigError, match=r"limits: expected a known key, found 'velocty'; did you mean velocity"):
        takt.Engine(MACHINE, changes={"axes.x.limits.velocty": 1})
    with pytest.raises(takt.ConfigError, match="machine:1:"):
        takt.Engine("name: [\n", changes={"axes.x.limits.velocity": 1})


@pytest.mark.parametrize("value", [1, -2.5, 1e-300, 0.1 + 0.2, 1e22, True, False, "text", "a b", 10**30])
def test_values_come_back_as_they_were(value: Value) -> None:
    assert value_of(text_of(value)) == value
    assert type(value_of(text_of(value))) is type(value)


def test_run_with_other_values(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    settings = ["velocity=200", "repeat=2.0", "most=50", "axes.x.limits.velocity=250"]
    assert main(["run", "scenario.py", *(f"--set={one}" for one in settings)]) == 1
    assert "velocity limit of 50 mm/s" in capsys.readouterr().out
    assert main(["run", "scenario.py", "--set", "velocity=200", "--set", "axes.x.limits.velocity=150"]) == 1
    assert main(["run", "scenario.py"]) == 0


@pytest.mark.parametrize(
    ("settings", "wrong"),
    [
        (["velocty=1"], "has no parameter 'velocty'; did you mean 'velocity'? (it has most, velocity, repeat, where;"),
        (["session=1"], "has no parameter 'session'"),
        (["velocity"], "'velocity': expected KEY=VALUE"),
        (["velocity=1", "velocity=2"], "'velocity' is set twice"),
        (["axes.x.limits.velocity=fast"], "machine.yaml:4"),
    ],
)
def test_bad_settings(folder: Path, settings: list[str], wrong: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "scenario.py", *(f"--set={one}" for one in settings)]) == 2
    assert wrong in capsys.readouterr().err


def test_parameters_have_defaults(folder: Path) -> None:
    scenario = load_scenario("scenario.py")
    assert scenario.parameters == {"velocity": 100.0, "repeat": 1, "where": "there", "most": 500.0}
    assert scenario.with_arguments({"velocity": 3}).arguments == {"velocity": 3.0}


@pytest.mark.parametrize(
    ("parameter", "value", "expected"),
    [
        ("up=True", "False", False),
        ("up=False", "yes", True),
        ("up=True", "OFF", False),
        ("up=True", "0", False),
        ("up=True", "true", True),
        ("n=1", "3.0", 3),
        ("n=1", "1e3", 1000),
        ("n: float = 1", "2.5", 2.5),
        ("n: float | None = 1", "2.5", 2.5),
        ("n=1.0", "2", 2.0),
        ('mode="a"', "3", "3"),
        ('mode="a"', "007", "007"),
        ('mode="a"', "true", "true"),
        ("any=None", "2.5", 2.5),
    ],
)
def test_values_are_of_the_kind_of_their_default(folder: Path, parameter: str, value: str, expected: object) -> None:
    """PY-24: true and false in the spellings of YAML, numbers, and texts as they are typed."""
    (folder / "scenario.py").write_text(f"def scenario(session, {parameter}): pass\n")
    name = parameter.split("=")[0].split(":")[0]
    scenario, _ = with_settings(load_scenario("scenario.py"), settings_of([f"{name}={value}"]))
    assert scenario.arguments == {name: expected}
    assert type(scenario.arguments[name]) is type(expected)


def test_values_of_numpy(folder: Path) -> None:
    """PY-24: as arrays hold them."""
    (folder / "scenario.py").write_text("def scenario(session, v=50.0, n=3, up=True): pass\n")
    given = {"v": np.float32(40), "n": np.arange(5)[4], "up": np.bool_(False)}
    assert load_scenario("scenario.py").with_arguments(given).arguments == {"v": 40.0, "n": 4, "up": False}
    assert load_scenario("scenario.py").with_arguments({"v": np.int64(40)}).arguments == {"v": 40.0}


@pytest.mark.parametrize(
    ("parameter", "value", "wrong"),
    [
        ("up=True", "maybe", "scenario.py: up: expected true or false, found 'maybe'"),
        ("up=True", "2", "up: expected true or false, found 2"),
        ("n=1", "2.5", "n: expected a whole number, as its default 1 is one, found 2.5; 1.0 as default takes any"),
        ("n=1", "true", "n: expected a whole number, found true"),
        ("n=1.0", "fast", "n: expected a number, found 'fast'"),
    ],
)
def test_values_of_another_kind_are_refused(
    folder: Path, parameter: str, value: str, wrong: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """PY-24: by `run` and, wherever they are listed, by `sweep` before a run is made."""
    (folder / "scenario.py").write_text(f"def scenario(session, {parameter}): pass\n")
    name, good = parameter.split("=")
    assert main(["run", "scenario.py", "--set", f"{name}={value}"]) == 2
    assert wrong in capsys.readouterr().err
    assert main(["sweep", "scenario.py", "--grid", f"{name}={good},{value}"]) == 2
    assert wrong in capsys.readouterr().err
