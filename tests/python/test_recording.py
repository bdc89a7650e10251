"""PY-04: recordings as NumPy arrays with units, kept in files, handed on to other tools."""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from motion_curves import STATES, one_axis
from takt.recording import Event, Gap, Recording, RecordingError


def two_rates() -> Recording:
    """x every cycle, belt every fourth."""
    return Recording(
        {
            "x": {
                "time_s": np.arange(8) / 1000,
                "cycle": np.arange(8),
                "set_position": np.arange(8.0),
                "state": [1] * 4 + [2] * 4,
            },
            "belt": {
                "time_s": np.arange(0, 8, 4) / 1000,
                "cycle": [0, 4],
                "position": [0.5, 1.5],
                "on": [True, False],
            },
        },
        {"x": {"set_position": "mm"}, "belt": {"position": "m"}},
        names={"x": {"state": STATES}},
        events=[(0.004, "x", "MoveAbsolute", "start"), (0.001, "belt", "started")],
        meta={"machine": "two"},
    )


def same(a: Recording, b: Recording) -> None:
    assert a.components == b.components
    for c in a:
        assert a[c].dtype == b[c].dtype
        for field in a.fields(c):
            np.testing.assert_array_equal(a[c][field], b[c][field])
            assert a.unit(c, field) == b.unit(c, field)
            assert a.names(c, field) == b.names(c, field)
        assert a.info(c) == b.info(c)
    assert a.events == b.events
    assert a.meta == b.meta


# PY-04
def test_a_component_is_a_structured_array_with_units() -> None:
    rec = two_rates()
    assert rec.components == ("x", "belt")
    assert rec["x"].dtype.names == ("time_s", "cycle", "set_position", "state")
    assert rec["x"]["set_position"][3] == 3.0
    assert rec["x"].dtype["state"] == np.int8
    assert rec["x"].dtype["cycle"] == np.int64
    assert rec["belt"].dtype["on"] == np.bool_
    assert rec.unit("x", "set_position") == "mm"
    assert rec.unit("x", "time_s") == "s"
    assert rec.unit("x", "state") == ""
    assert rec.names("x", "state")[2] == "DiscreteMotion"
    assert rec.text("x", "state").tolist() == ["Standstill"] * 4 + ["DiscreteMotion"] * 4
    assert (rec.start_s, rec.end_s) == (0.0, 0.007)
    assert [e.component for e in rec.events] == ["belt", "x"]
    assert rec.events[0] == Event(0.001, "belt", "started", "mark")


def test_columns_cannot_be_changed_behind_its_back() -> None:
    given = np.arange(3.0)
    rec = Recording({"x": {"time_s": [0, 1, 2], "p": given}})
    given[0] = 7
    assert rec["x"]["p"][0] == 0
    with pytest.raises(ValueError, match="read-only"):
        rec["x"]["p"][0] = 1


def test_from_a_matrix_of_columns() -> None:
    rec = Recording.from_columns(
        [0.0, 0.001],
        [10, 11],
        ["x.set_position", "x.state", "x.error_id", "cell.y.torque_nm"],
        [[1.0, 1.0, 2004.0, math.nan], [2.0, math.nan, 0.0, 0.5]],
        ["mm", "", "", "Nm"],
        names={"x": {"state": STATES}},
    )
    assert rec.components == ("x", "cell.y")
    assert rec["x"]["cycle"].tolist() == [10, 11]
    assert rec["x"]["error_id"].dtype.kind == "i"
    assert rec.text("x", "state").tolist() == ["Standstill", "?-1"]
    assert rec.unit("cell.y", "torque_nm") == "Nm"
    with pytest.raises(RecordingError, match="2 columns are named"):
        Recording.from_columns([0.0], [0], ["a.b", "a.c"], [[1.0]])
    with pytest.raises(RecordingError, match="'position' is not of the form"):
        Recording.from_columns([0.0], [0], ["position"], [[1.0]])


def test_from_one_structured_array() -> None:
    rec = Recording.from_array("x", one_axis()["x"], "deg", modulus=360.0)
    assert rec.unit("x", "set_acceleration") == "deg/s²"
    assert rec.unit("x", "following_error") == "deg"
    assert rec.info("x")["modulus"] == 360.0


# PY-04
def test_slice_takes_samples_and_events() -> None:
    part = two_rates().slice(0.003, 0.005)
    assert part["x"]["cycle"].tolist() == [3, 4, 5]
    assert part["belt"]["cycle"].tolist() == [4]
    assert [e.text for e in part.events] == ["MoveAbsolute"]
    assert part.unit("x", "set_position") == "mm"
    assert len(two_rates().slice(5, 6)["x"]) == 0
    with pytest.raises(RecordingError, match="no length"):
        two_rates().slice(1, 0)


# PY-04, EN-20: cycle numbers let a receiver see losses
def test_gaps() -> None:
    cycle = np.array([0, 4, 8, 20, 24, 32])
    rec = Recording({"x": {"time_s": cycle / 1000, "cycle": cycle}})
    assert rec.gaps("x") == [Gap(8, 20, 2, 0.008, 0.02), Gap(24, 32, 1, 0.024, 0.032)]
    assert sum(g.missing for g in rec.gaps("x", step=1)) == 33 - 6
    assert two_rates().gaps("belt") == []


# PY-04
def test_save_and_load(tmp_path: Path) -> None:
    rec = two_rates()
    rec.info("x")["limits"] = {"velocity": 3.0}
    path = rec.save(tmp_path / "new" / "a.npz")
    same(rec, Recording.load(path))
    with np.load(path) as plain:  # NumPy alone can read it
        assert plain["component0"]["set_position"][2] == 2.0
    with pytest.raises(RecordingError, match="JSON"):
        Recording({}, meta={"x": object()}).save(tmp_path / "b.npz")


@settings(max_examples=40, deadline=None)
@given(
    values=hnp.arrays(np.float64, st.integers(0, 30), elements=st.floats(allow_nan=True, allow_infinity=True)),
    unit=st.text(max_size=8),
    text=st.text(max_size=20),
)
def test_whatever_it_holds_comes_back(
    tmp_path_factory: pytest.TempPathFactory, values: Any, unit: str, text: str
) -> None:
    rec = Recording({"x": {"time_s": np.arange(len(values)), "p": values}}, {"x": {"p": unit}}, events=[(0, "x", text)])
    same(rec, Recording.load(rec.save(tmp_path_factory.mktemp("npz") / "r.npz")))


@pytest.mark.parametrize("content", [b"", b"nonsense", b"PK\x03\x04 broken"])
def test_a_file_that_is_none(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "bad.npz"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"bad\.npz is not a recording"):
        Recording.load(path)
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    with pytest.raises(RecordingError, match="not a recording"):
        Recording.load(tmp_path / "other.npz")
    with pytest.raises(FileNotFoundError):
        Recording.load(tmp_path / "none.npz")


# PY-04: column names with units
def test_csv(tmp_path: Path) -> None:
    with two_rates().to_csv(tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["cycle", "time_s", "x.set_position [mm]", "x.state", "belt.position [m]", "belt.on"]
    assert rows[1] == ["0", "0.0", "0.0", "Standstill", "0.5", "True"]
    assert rows[2] == ["1", "0.001", "1.0", "Standstill", "", ""]
    assert len(rows) == 9


# PY-04: conversion to pandas where installed
def test_pandas() -> None:
    pytest.importorskip("pandas")
    frame = two_rates().to_pandas()
    assert frame.index.name == "time_s"
    assert frame["x.set_position"].tolist() == list(range(8))
    assert frame["belt.position"].dropna().tolist() == [0.5, 1.5]
    assert frame.attrs["units"]["belt.position"] == "m"


# PY-04: conversion to xarray where installed
def test_xarray() -> None:
    pytest.importorskip("xarray")
    data = two_rates().to_xarray()
    assert data["x.set_position"].attrs["units"] == "mm"
    assert float(data["belt.position"].sel(time_s=0.004)) == 1.5
    assert data["x.state"].attrs["flag_meanings"].split()[2] == "DiscreteMotion"


# PY-25: states by their texts, some signals only
def test_dataframe() -> None:
    pytest.importorskip("pandas")
    frame = two_rates().to_dataframe("x.state", "belt")
    assert frame["x.state"].iloc[0] == "Standstill"
    assert frame["x.state"].dtype.name == "category"
    unknown = Recording({"x": {"time_s": [0, 1], "state": [0, 5]}}, names={"x": {"state": ["A"]}}).to_dataframe()
    assert unknown["x.state"].tolist() == ["A", "?5"]
    assert frame["belt.position"].dropna().tolist() == [0.5, 1.5]
    assert "x.set_position" not in frame
    assert frame.attrs["units"]["belt.position"] == "m"
    with pytest.raises(RecordingError, match="no signal matches 'z'"):
        two_rates().to_dataframe("z")


# PY-25: what to_csv writes, with types, nulls and units
def test_parquet(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    rec = two_rates()
    table = parquet.read_table(rec.to_parquet(tmp_path / "new" / "a.parquet"))
    assert table.column_names[:3] == ["cycle", "time_s", "x.set_position"]
    assert table["x.set_position"].to_pylist() == list(range(8))
    assert table["x.state"].to_pylist()[0] == "Standstill"
    assert table["belt.position"].to_pylist() == [0.5, None, None, None, 1.5, None, None, None]
    assert table.schema.field("belt.position").metadata == {b"unit": b"m"}
    assert parquet.read_table(rec.to_parquet(tmp_path / "b.parquet", "x.state")).column_names[2:] == ["x.state"]


# PY-04, PY-25
@pytest.mark.parametrize(
    ("package", "asks"),
    [
        ("pandas", lambda rec: rec.to_pandas()),
        ("pandas", lambda rec: rec.to_dataframe()),
        ("xarray", lambda rec: rec.to_xarray()),
        ("pyarrow", lambda rec: rec.to_parquet("a.parquet")),
    ],
)
def test_a_package_that_is_not_installed_is_named(
    package: str, asks: Callable[[Recording], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=f"needs the package {package}: pip install {package}"):
        asks(two_rates())


@pytest.mark.parametrize(
    ("columns", "sentence"),
    [
        ({"p": [1.0]}, "no column time_s"),
        ({"time_s": [0.0, 1.0], "p": [1.0]}, "has the shape"),
        ({"time_s": [[0.0]]}, "dimensions"),
        ({"time_s": [0.0, math.nan]}, "not a number"),
        ({"time_s": [0.0, 0.0]}, "time_s of 'x' does not rise after sample 0"),
        ({"time_s": [0.0, 1.0], "cycle": [5, 4]}, "cycle of 'x' does not rise"),
        ({"time_s": [0.0], "p": ["a"]}, "not numbers"),
        ({"time_s": [0.0], "state": [300]}, "outside -128 to 127"),
        ({"time_s": [0.0], "state": ["A"]}, "'x.state' holds <U1, not numbers"),
    ],
)
def test_what_cannot_be_a_recording(columns: dict[str, Any], sentence: str) -> None:
    with pytest.raises(RecordingError, match=sentence):
        Recording({"x": columns}, names={"x": {"state": STATES}})


def test_units_of_nothing_and_events_without_time() -> None:
    with pytest.raises(RecordingError, match="units are given for 'y'"):
        Recording({}, {"y": {}})
    with pytest.raises(RecordingError, match="has no time"):
        Recording({}, events=[(math.nan, "x", "start")])
    with pytest.raises(RecordingError, match="an event is"):
        Recording({}, events=[(1.0, "x")])


def test_asking_for_what_is_not_there_says_what_is() -> None:
    rec = two_rates()
    with pytest.raises(RecordingError, match=r"no component 'bell'; did you mean 'belt'\? \(it has x, belt\)"):
        rec["bell"]
    with pytest.raises(RecordingError, match="no field 'setposition'; did you mean 'set_position'"):
        rec.column("x", "setposition")


def test_an_empty_recording() -> None:
    rec = Recording({"x": {"time_s": [], "p": []}})
    assert rec.duration_s == 0.0
    assert math.isnan(rec.start_s)
    assert rec.gaps("x") == []
    assert "x: 0 samples" in repr(rec)


def test_arrays_of_objects_in_meta_become_lists(tmp_path: Path) -> None:
    """PY-04: what is saved is read again."""
    texts = np.array(["one", None, 3], dtype=object)
    path = Recording({"x": {"time_s": [0.0]}}, meta={"texts": texts}).save(tmp_path / "a.npz")
    assert Recording.load(path).meta["texts"] == ["one", None, 3]


def test_arrays_in_meta_are_kept(tmp_path: Path) -> None:
    """At any depth, with their types and shapes, and equal ones once."""
    large = np.random.default_rng(1).normal(size=100_000)
    meta: dict[str, Any] = {"run": [{"values": large, "again": {"values": large.copy()}}], "n": 1}
    meta |= {"bytes": np.arange(4, dtype=np.uint8), "table": np.zeros((0, 7))}
    rec = Recording({"x": {"time_s": [0.0]}}, meta=meta)
    read = Recording.load(rec.save(tmp_path / "a.npz"))
    np.testing.assert_array_equal(read.meta["run"][0]["values"], large)
    np.testing.assert_array_equal(read.meta["run"][0]["again"]["values"], large)
    assert read.meta["bytes"].dtype == np.uint8
    assert read.meta["bytes"].tolist() == [0, 1, 2, 3]
    assert read.meta["table"].shape == (0, 7)
    assert read.meta["n"] == 1
    assert (tmp_path / "a.npz").stat().st_size < 1.1 * large.nbytes
    assert rec.meta["run"][0]["values"] is large  # saving leaves it alone


def test_some_signals() -> None:
    part = two_rates().pick([("x", "state"), ("x", "set_position")])
    assert part.components == ("x",)
    assert part.fields("x") == ("time_s", "cycle", "state", "set_position")
    assert part.unit("x", "set_position") == "mm"
    assert part.text("x", "state").tolist() == two_rates().text("x", "state").tolist()
    assert [e.component for e in part.events] == ["x"]
    with pytest.raises(RecordingError, match="'x' has no field 'nothing'"):
        two_rates().pick([("x", "nothing")])
