"""Recordings for other tools: `takt export`."""

from __future__ import annotations

import csv
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from machines import MACHINE
from mcap.reader import NonSeekingReader, SeekingReader, make_reader
from mcap.stream_reader import StreamReader
from motion_curves import one_axis
from takt.cli import main
from takt.recording import Recording

LIMITS = ("velocity", "acceleration", "jerk")


def two_rates() -> Recording:
    """x each ms, belt each fourth, with all kinds of fields."""
    n = np.arange(2000, 2080)
    rare = n[::4]
    values = np.random.default_rng(1).normal(size=len(n)) * 1e-7 + 1 / 3
    values[3] = math.nan
    x = {"time_s": n / 1000, "cycle": n, "place": values, "state": np.arange(80) // 40, "count": n * 7}
    belt = {"time_s": rare / 1000, "cycle": rare, "velocity": rare * 0.1, "on": rare % 8 == 0}
    return Recording(
        {"x": x, "belt": belt},
        {"x": {"place": "mm", "count": "1"}, "belt": {"velocity": "mm/s"}},
        names={"x": {"state": ["Standstill", "DiscreteMotion"]}},
        events=[(2.0305, "x", "x.halt: done", "end"), (2.01, "", "now", "mark"), (2.04, "x", "no", "error")],
        meta={"machine": "two", "period_s": 0.001, "machine_file": {"text": "name: two\n", "folder": ""}},
    )


def read(path: Path) -> tuple[dict[str, Any], list[tuple[str, int, dict[str, Any]]], Any]:
    """Schemas by topic, messages (topic, log time in ns, fields) in the order of the file, and the reader."""
    reader = make_reader(path.open("rb"))
    schemas: dict[str, Any] = {}
    messages = []
    for schema, channel, message in reader.iter_messages(log_time_order=False):
        assert schema is not None
        assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
        assert message.publish_time == message.log_time
        schemas[channel.topic] = json.loads(schema.data)
        messages.append((channel.topic, message.log_time, json.loads(message.data)))
    return schemas, messages, reader


def test_mcap_has_all_of_a_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rec = two_rates()
    rec.save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--mcap", str(tmp_path / "a.mcap")]) == 0
    assert "103 messages of 2 components and of events" in capsys.readouterr().out
    schemas, messages, reader = read(tmp_path / "a.mcap")
    times = [time_ns for _, time_ns, _ in messages]
    assert times == sorted(times)
    for name in rec:
        rows = [(time_ns, fields) for topic, time_ns, fields in messages if topic == f"/{name}"]
        assert [time_ns for time_ns, _ in rows] == [int(cycle) * 1_000_000 for cycle in rec[name]["cycle"]]
        for field in rec.fields(name):
            found = [fields.get(field) for _, fields in rows]
            if rec.names(name, field):
                assert found == rec.text(name, field).tolist()
            else:
                exact = rec[name][field].tolist()
                assert found == [None if isinstance(v, float) and math.isnan(v) else v for v in exact]
                assert {type(v) for v in found} <= {type(exact[0]), type(None)}
    described = schemas["/x"]["properties"]
    assert described["time_s"]["description"] == "s"
    assert described["place"] == {"type": "number", "description": "mm"}
    assert described["state"] == {"type": "string", "description": "Standstill, DiscreteMotion"}
    assert described["count"] == {"type": "integer"}
    assert schemas["/belt"]["properties"]["on"] == {"type": "boolean"}
    assert schemas["/belt"]["properties"]["velocity"]["description"] == "mm/s"
    events = [(t, f["message"], f["name"], f["file"], f["level"]) for topic, t, f in messages if topic == "/events"]
    assert events == [
        (2_010_000_000, "now", "", "mark", 2),
        (2_030_500_000, "x.halt: done", "x", "end", 1),
        (2_040_000_000, "no", "x", "error", 4),
    ]
    (machine,) = reader.iter_attachments()
    assert (machine.name, machine.data) == ("machine.yaml", b"name: two\n")
    (about,) = reader.iter_metadata()
    assert about.metadata == {"machine": "two", "period_s": "0.001"}


def test_mcap_is_sound_and_says_all_by_itself(tmp_path: Path) -> None:
    """By the package's own readers, from front to back and by the index at the end, with check sums; and every message
    by the schema in the file alone, against the CSV of the same run."""
    with takt.Engine(MACHINE) as engine, engine.record() as recorder:
        x = engine.axis("x")
        x.power().wait()
        x.move_absolute(position=20.0).wait()
    recorder.recording.save(tmp_path / "a.npz")
    files = ["--mcap", str(tmp_path / "a.mcap"), "--csv", str(tmp_path / "a.csv")]
    assert main(["export", str(tmp_path / "a.npz"), *files]) == 0

    seeking = SeekingReader((tmp_path / "a.mcap").open("rb"), validate_crcs=True)
    summary = seeking.get_summary()
    assert summary is not None
    assert summary.statistics is not None
    through = list(NonSeekingReader((tmp_path / "a.mcap").open("rb"), validate_crcs=True).iter_messages())
    by_index = list(seeking.iter_messages())
    assert through == by_index
    assert summary.statistics.message_count == len(through) == sum(summary.statistics.channel_message_counts.values())
    assert [message.sequence for _, _, message in through] == list(range(len(through)))
    assert summary.statistics.message_start_time == through[0][2].log_time
    assert summary.statistics.message_end_time == through[-1][2].log_time
    records = [type(record).__name__ for record in StreamReader((tmp_path / "a.mcap").open("rb")).records]
    assert (records[0], records[-1]) == ("Header", "Footer")

    kinds: dict[str, Any] = {"number": (int, float), "integer": int, "boolean": bool, "string": str, "object": dict}
    kinds["array"] = list
    shown: dict[int, dict[str, Any]] = {}
    for schema, channel, message in through:
        assert schema is not None
        said = json.loads(schema.data)
        fields = json.loads(message.data)
        assert said["type"] == "object"
        assert fields.keys() <= said["properties"].keys()
        for field, value in fields.items():
            kind = said["properties"][field]["type"]
            assert isinstance(value, kinds[kind]), field
            assert isinstance(value, bool) == (kind == "boolean"), field
        if channel.topic == "/x":
            shown[fields["cycle"]] = fields
            units = {f: about.get("description", "") for f, about in said["properties"].items()}
    with (tmp_path / "a.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    columns = [name for name in table[0] if name.startswith("x.")]
    assert len(columns) > 20
    assert [int(row["cycle"]) for row in table] == sorted(shown)
    for name in columns:
        field, _, unit = name.removeprefix("x.").removesuffix("]").partition(" [")
        assert units[field] == unit or unit in ("", "1")
        for row in table:
            value = shown[int(row["cycle"])].get(field)
            if value is None:
                assert not math.isfinite(float(row[name])), name
            else:
                assert row[name] == str(value) or float(row[name]) == value, name
    last = table[-1]
    assert float(last["x.set_position [mm]"]) == pytest.approx(20)
    assert last["x.state"] == "Standstill"


def test_a_part_of_it(tmp_path: Path) -> None:
    """Signals by pattern and a window of time, in both formats."""
    two_rates().save(tmp_path / "a.npz")
    some = ["x.state", "belt.*", "--from", "2.02", "--to", "2.03"]
    files = ["--mcap", str(tmp_path / "a.mcap"), "--csv", str(tmp_path / "a.csv")]
    assert main(["export", str(tmp_path / "a.npz"), *some, *files]) == 0
    schemas, messages, _ = read(tmp_path / "a.mcap")
    assert set(schemas["/x"]["properties"]) == {"time_s", "cycle", "state"}
    assert {time_ns for _, time_ns, _ in messages} == {ms * 1_000_000 for ms in range(2020, 2031)}
    with (tmp_path / "a.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["cycle", "time_s", "x.state", "belt.velocity [mm/s]", "belt.on"]
    assert [int(row[0]) for row in rows] == list(range(2020, 2031))
    assert [row[3] != "" for row in rows] == [cycle % 4 == 0 for cycle in range(2020, 2031)]


def test_csv_says_how_rates_are_joined(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    two_rates().save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--csv", str(tmp_path / "a.csv")]) == 0
    assert "rates differ (x 1000 Hz, belt 250 Hz): a row for each cycle of any component" in capsys.readouterr().out
    with (tmp_path / "a.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head[2:4] == ["x.place [mm]", "x.state"]
    assert len(rows) == 80
    assert float(rows[5][2]) == two_rates()["x"]["place"][5]
    one_axis().save(tmp_path / "b.npz")
    assert main(["export", str(tmp_path / "b.npz"), "--csv", str(tmp_path / "b.csv")]) == 0
    assert "a row for each cycle that was recorded" in capsys.readouterr().out


def test_one_of_each_is_said_in_the_singular(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Recording({"x": {"time_s": [0.0], "p": [1.0]}}).save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--mcap", str(tmp_path / "a.mcap")]) == 0
    assert "1 message of 1 component and of events" in capsys.readouterr().out


NOTHING = {"no component": Recording({}), "no sample": Recording({"x": {"time_s": [], "p": []}})}


@pytest.mark.parametrize("empty", NOTHING)
def test_an_empty_run(empty: str, tmp_path: Path) -> None:
    NOTHING[empty].save(tmp_path / "a.npz")
    files = ["--mcap", str(tmp_path / "a.mcap"), "--csv", str(tmp_path / "a.csv")]
    assert main(["export", str(tmp_path / "a.npz"), *files]) == 0
    assert read(tmp_path / "a.mcap")[1] == []
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 1


def test_components_named_like_topics_of_their_own(tmp_path: Path) -> None:
    """PY-27: each topic is there once, with one schema."""
    names = ["events", "tf", "scene", "x"]
    machine = {"name": "m", "axes": [{"name": n, "limits": dict.fromkeys(LIMITS, 100.0)} for n in names]}
    with takt.Engine(machine) as engine:
        recorder = engine.record()
        engine.run(0.01)
        engine.mark("now")
        recorder.stop().save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--mcap", str(tmp_path / "a.mcap")]) == 0
    with (tmp_path / "a.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    topics = [channel.topic for channel in summary.channels.values()]
    assert len(topics) == len(set(topics))
    assert {"/components/events", "/components/tf", "/components/scene", "/x", "/events"} <= set(topics)


@pytest.mark.parametrize("by_s", [-3.0, 1e10])
def test_times_that_mcap_does_not_have(by_s: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-27: one sentence, and no file."""
    two_rates().shifted(by_s).save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--mcap", str(tmp_path / "a.mcap")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"MCAP has no time {2.0 + by_s:g} s" in said
    assert not (tmp_path / "a.mcap").exists()


def test_times_that_are_0_but_for_rounding(tmp_path: Path) -> None:
    """PY-27: in nanoseconds they are."""
    shifted = two_rates().shifted(-2.0).shifted(-5.6e-17)
    assert min(shifted[name]["time_s"][0] for name in shifted) < 0
    shifted.save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--mcap", str(tmp_path / "a.mcap")]) == 0
    assert read(tmp_path / "a.mcap")[1]


def test_the_part_from_0_s_on_has_times_of_mcap(tmp_path: Path) -> None:
    """PY-27: `--from 0` leaves out what was before."""
    two_rates().shifted(-2.01).save(tmp_path / "a.npz")
    assert main(["export", str(tmp_path / "a.npz"), "--mcap", str(tmp_path / "a.mcap"), "--from", "0"]) == 0
    _, messages, _ = read(tmp_path / "a.mcap")
    assert min(time_ns for _, time_ns, _ in messages) == 0


BAD = {
    "to where": (["a.npz"], "give --mcap FILE, --csv FILE or --parquet FILE"),
    "nothing there": (["none.npz", "--csv", "a.csv"], "none.npz: No such file or directory"),
    "name": (["a.npz", "--csv", "a.mcap"], "a.mcap: expected a name that ends in .csv"),
    "folder": (["a.npz", "--mcap", "no/a.mcap"], "no/a.mcap: there is no directory no"),
    "signal": (
        ["a.npz", "y.*", "--csv", "a.csv"],
        "no signal matches 'y.*': this recording has no component 'y' (it has x, belt)",
    ),
    "field": (
        ["a.npz", "x.plaec", "--csv", "a.csv"],
        "no signal matches 'x.plaec': 'x' has no field 'plaec'; did you mean 'place'? (it has place, state, count)",
    ),
    "component": (
        ["a.npz", "bett.on", "--csv", "a.csv"],
        "no signal matches 'bett.on': this recording has no component 'bett'; did you mean 'belt'? (it has x, belt)",
    ),
    "field of several": (
        ["a.npz", "*.velocty", "--csv", "a.csv"],
        "'x' or 'belt' has no field 'velocty'; did you mean 'velocity'? (it has place, state, count, velocity, on)",
    ),
    "window": (["a.npz", "--csv", "a.csv", "--from", "3", "--to", "2"], "a slice from 3.0 s to 2.0 s has no length"),
    "behind the end": (
        ["a.npz", "--csv", "a.csv", "--mcap", "a.mcap", "--from", "3"],
        "nothing was recorded from 3 s on: there are samples from 2 s to 2.079 s",
    ),
    "before the beginning": (
        ["a.npz", "x.place", "--csv", "a.csv", "--to", "1.5"],
        "nothing was recorded to 1.5 s: there are samples from 2 s to 2.079 s",
    ),
    "between two samples": (
        ["a.npz", "belt.*", "--csv", "a.csv", "--from", "2.001", "--to", "2.003"],
        "nothing was recorded from 2.001 s to 2.003 s: there are samples from 2 s to 2.076 s",
    ),
    "directory": (["a.npz", "--mcap", "taken.mcap"], "taken.mcap: Is a directory"),
    "package": (["a.npz", "--mcap", "a.mcap"], "writing MCAP needs the package mcap: pip install mcap"),
}


@pytest.mark.parametrize("case", BAD)
def test_mistakes_are_one_line(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    two_rates().save("a.npz")
    Path("taken.mcap").mkdir()
    if case == "package":
        monkeypatch.setitem(sys.modules, "mcap.writer", None)
    arguments, sentence = BAD[case]
    assert main(["export", *arguments]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert sentence in said
    assert sorted(path.name for path in Path().glob("a.*")) == ["a.npz"]  # nothing was written
