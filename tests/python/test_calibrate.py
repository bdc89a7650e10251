"""GR-46: frames from measured points: tables, cameras, belts."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from takt import calibrate
from takt.calibrate import CalibrationError
from takt.cli import main
from takt.kinematics import pose_to_matrix

PLACES = st.tuples(*[st.floats(-2000, 2000)] * 3)
TURNS = st.tuples(*[st.floats(-80, 80)] * 3)


def _at(pose: np.ndarray, points: np.ndarray) -> np.ndarray:
    matrix = pose_to_matrix(pose)
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


@given(PLACES, TURNS, st.floats(1, 500), st.floats(-300, 300), st.floats(1, 500))
def test_three_points(place: tuple[float, ...], turn: tuple[float, ...], x: float, aside: float, y: float) -> None:
    pose = np.array([*place, *turn])
    origin, on_x, on_xy = _at(pose, np.array([[0, 0, 0], [x, 0, 0], [aside, y, 0]]))
    found = calibrate.three_points(origin, on_x, on_xy)
    assert np.allclose(pose_to_matrix(found.pose), pose_to_matrix(pose), atol=1e-6)
    assert found.largest == 0


@given(PLACES, TURNS, st.integers(0, 10_000))
def test_fit_finds_the_frame_and_what_is_left(place: tuple[float, ...], turn: tuple[float, ...], seed: int) -> None:
    random = np.random.default_rng(seed)
    pose = np.array([*place, *turn])
    seen = random.uniform(-300, 300, (5, 3))
    exact = calibrate.fit(seen, _at(pose, seen))
    assert np.allclose(pose_to_matrix(exact.pose), pose_to_matrix(pose), atol=1e-6)
    assert exact.largest < 1e-6
    noisy = _at(pose, seen) + random.uniform(-0.05, 0.05, seen.shape)
    found = calibrate.fit(seen, noisy)
    assert found.largest < 0.2
    # No frame beside it is nearer to the points.
    for axis in range(6):
        other = found.pose.copy()
        other[axis] += 0.01
        worse = np.linalg.norm(_at(other, seen) - noisy, axis=1)
        assert (worse**2).sum() >= (found.residuals**2).sum() - 1e-9


def test_belt() -> None:
    pose = np.array([120.0, -40.0, 15.0, 0.0, 0.0, 30.0])
    positions = np.array([100.0, 250.0, 400.0])
    measured = _at(pose, np.column_stack([0.5 * positions, np.zeros(3), np.zeros(3)]))
    found = calibrate.belt(positions, measured, _at(pose, np.array([[60.0, 45.0, 0.0]]))[0])
    assert np.allclose(found.pose, pose, atol=1e-9)
    assert found.ratio == pytest.approx(0.5)
    assert found.largest < 1e-9


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: calibrate.three_points([0, 0, 0], [0, 0, 0.01], [0, 1, 0]), "0.01 mm from the origin"),
        (lambda: calibrate.three_points([0, 0, 0], [10, 0, 0], [30, 0.05, 0]), "must not lie on one line"),
        (lambda: calibrate.fit([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 0, 0], [1, 0, 0], [2, 1, 0]]), "of one line"),
        (lambda: calibrate.fit([[0, 0, 0]] * 3, [[0, 0, 0]] * 3), "of one another"),
        (lambda: calibrate.fit([[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [1, 0, 0]]), "at least 3, found 2"),
        (
            lambda: calibrate.fit([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 0, 0], [9, 0, float("nan")], [0, 9, 0]]),
            "point 2",
        ),
        (lambda: calibrate.belt([5, 5], [[0, 0, 0], [9, 0, 0]], [0, 9, 0]), "one position"),
        (lambda: calibrate.belt([0.1] * 3, [[0, 0, 0], [9, 0, 0], [18, 0, 0]], [0, 9, 0]), "one position"),
        (lambda: calibrate.belt([0, 50], [[0, 0, 0], [50, 0, 0]], [70, 0, 0]), "must not lie on it"),
        (lambda: calibrate.fit([[0, 0, 0], [1, 0]], [[0, 0, 0], [1, 0, 0]]), "x, y, z in each row, as numbers"),
    ],
)
def test_points_that_define_no_frame(call: object, sentence: str) -> None:
    with pytest.raises(CalibrationError, match=sentence):
        call()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x,y,z\n0,0,0\n1,5,2,5,3,5\n0,9,0\n", ":3: expected 3 fields as in the head, found 6"),
        ("x,y,z\n\n0,0,0\n\n1,a,0\n0,1,0\n", ":5: y: expected a finite number, found 'a'"),
        ('x,y,z,note\n0,0,0,\n9,0,0,"top\n0,9,0,\n5,5,0,\n', ":5: is no CSV"),
        ("x,y,z,x\n0,0,0,1\n9,0,0,2\n0,9,0,3\n", ":1: the head has the column x twice"),
        ('x,y,z\n0,0,0\n"9"5,0,0\n0,9,0\n', ":3: is no CSV"),
    ],
)
def test_rows_that_cannot_be_read(text: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Decimal commas, quotation marks that nothing ends; with the number of the line."""
    (tmp_path / "table.csv").write_text(text)
    assert main(["calibrate", "frame", str(tmp_path / "table.csv")]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    "text",
    ["x,y,z\n100,50,10,\n100,150,10\n20,60,10,,\n", "x,y,z,\n100,50,10,5\n100,150,10\n20,60,10,\n"],
)
def test_commas_at_the_end_of_a_line_mean_nothing(text: str, tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text(text)
    assert main(["calibrate", "frame", str(tmp_path / "table.csv")]) == 0


@pytest.mark.parametrize("separator", [";", "; ", "\t"])
def test_tables_with_decimal_commas(separator: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """GR-46: with semicolons or tabulators between the columns, as spreadsheets write them; as cams are read."""
    rows = ["position,x,y,z", "0,0.5,0,5", "200,200.5,0,5", ",100,60,5"]
    for name, text in (
        ("points.csv", "\n".join(rows)),
        ("commas.csv", "\n".join(row.replace(",", separator).replace(".", ",") for row in rows)),
    ):
        (tmp_path / name).write_text(f"{text}\n")
        assert main(["calibrate", "belt", str(tmp_path / name)]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[: len(printed) // 2] == printed[len(printed) // 2 :]
    assert "ratio: 1" in printed
    (tmp_path / "points.csv").write_text("x;y;z\n0;0;0\n1,5;2,5;3,5;4\n0;9;0\n")
    assert main(["calibrate", "frame", str(tmp_path / "points.csv")]) == 2
    assert ":3: expected 3 fields as in the head, found 4" in capsys.readouterr().err


def test_a_table_from_a_pipe(tmp_path: Path) -> None:
    """GR-46: what cannot be read twice."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_text, args=("x,y,z\n100,50,10\n100,150,10\n20,60,10\n",))
    writer.start()
    assert main(["calibrate", "frame", str(pipe)]) == 0
    writer.join()


def test_values_are_printed_as_precisely_as_they_are_used(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """GR-46: positions and angles to 1e-6 mm and deg, whatever their size, rounding noise as 0, the ratio exactly."""
    table = tmp_path / "table.csv"
    table.write_text("position,x,y,z\n0,12345.678,0.1,0\n1000000,12468.456789,0.1,0\n,12345.678,50,0\n")
    assert main(["calibrate", "belt", str(table)]) == 0
    origin, ratio = capsys.readouterr().out.splitlines()[:2]
    assert origin == "origin: {x: 12345.678, y: 0.1, z: 0, a: 0, b: 0, c: 0}"
    assert float(ratio.removeprefix("ratio: ")) == pytest.approx(122.778789 / 1e6, rel=1e-12)
    found = calibrate.Calibration(np.array([-3.55e-15, 1e8 / 3, -0.5, 0, 1.0000004, -1.2e-7]), np.empty(0))
    assert found.yaml == "{x: 0, y: 33333333.333333, z: -0.5, a: 0, b: 1, c: 0}"


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "table.csv"
    table.write_text("x,y,z\n100,50,10\n100,150,10\n20,60,10\n")
    assert main(["calibrate", "frame", str(table)]) == 0
    assert "{x: 100, y: 50, z: 10, a: 0, b: 0, c: 90}" in capsys.readouterr().out
    camera = tmp_path / "camera.csv"
    camera.write_text("seen_x,seen_y,seen_z,x,y,z\n0,0,0,10,0,0\n50,0,0,60,0.1,0\n0,50,0,10,50,0\n50,50,0,60,50,0\n")
    assert main(["calibrate", "frame", str(camera)]) == 0
    printed = capsys.readouterr().out
    assert "largest residual" in printed
    assert "point 4" in printed
    belt = tmp_path / "belt.csv"
    belt.write_text("position,x,y,z\n0,0,0,5\n200,200,0,5\n,100,60,5\n")
    assert main(["calibrate", "belt", str(belt)]) == 0
    printed = capsys.readouterr().out
    assert "ratio: 1\n" in printed
    assert "z: 5" in printed
    line = tmp_path / "line.csv"
    line.write_text("x,y,z\n0,0,0\n10,0,0\n20,0,0\n")
    assert main(["calibrate", "frame", str(line)]) == 2
    assert "must not lie on one line" in capsys.readouterr().err
    camera.write_text("seen_x,seen_y,x,y,z\n0,0,10,0,0\n50,0,60,0.1,0\n0,50,10,50,0\n")
    assert main(["calibrate", "frame", str(camera)]) == 2
    assert "there is no column seen_z; the head says seen_x, seen_y, x, y, z" in capsys.readouterr().err
