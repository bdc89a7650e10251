"""Cams from files of other systems (CAM-92)."""

import math
import re

import numpy as np
import pytest
import takt
from takt.cam import Table

X = np.array([0.0, 72.5, 140.0, 250.25, 360.0])
Y = np.array([0.0, 3.125, 11.5, 4.75, 0.0])


def german(number):
    return f"{number:.3f}".replace(".", ",")


TABLES = {
    "semicolons and decimal commas": "x;y\n" + "\n".join(f"{german(x)};{german(y)}" for x, y in zip(X, Y, strict=True)),
    "tabs, no header": "\n".join(f"{german(x)}\t{german(y)}" for x, y in zip(X, Y, strict=True)),
    "blanks, as CODESYS writes them": "\r\n".join(f"{x:.6f} {y:.6f}" for x, y in zip(X, Y, strict=True)) + "\r\n",
    "blanks and decimal commas": "\n".join(f"{german(x)}   {german(y)} // point" for x, y in zip(X, Y, strict=True)),
    "commas": "# made by hand\nX,Y\n" + "\n".join(f"{x},{y}" for x, y in zip(X, Y, strict=True)),
    "quotes and bars": '"Master"|"Slave"\n' + "\n".join(f'"{x}"|"{y}"' for x, y in zip(X, Y, strict=True)),
    "other columns": "Slave Position [mm];Nr;Master Position [deg]\n"
    + "\n".join(f"{german(y)};{i};{german(x)}" for i, (x, y) in enumerate(zip(X, Y, strict=True))),
    "units below the titles": "Master pos;Slave pos\n[deg];[mm]\n"
    + "\n".join(f"{german(x)};{german(y)}" for x, y in zip(X, Y, strict=True)),
    "TwinCAT, positions": "Table1 : ARRAY[0..4, 0..1] OF LREAL := ["
    + ", ".join(f"{x}, {y}" for x, y in zip(X, Y, strict=True))
    + "];",
    "CODESYS, structured text": "aPoints : ARRAY[0..4] OF SMC_CAMXYVA := [\n"
    + ",\n".join(f"(dX := {x}, dY := {y})" for x, y in zip(X, Y, strict=True))
    + "];",
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("text", TABLES.values(), ids=TABLES)
def test_tables_of_points(tmp_path, text, encoding):  # CAM-92
    file = tmp_path / "press.txt"
    file.write_bytes(text.encode(encoding))
    table = Table.from_file(file, cyclic=True)
    assert table.name == "press"
    assert np.array_equal(table.points.x, X)
    assert np.array_equal(table.points.y, Y)
    assert table.source["interpolation"] == "quintic"
    assert table.cyclic


def test_units_and_velocities_are_taken(tmp_path):  # CAM-92
    file = tmp_path / "with units.csv"
    file.write_text("phi;s;v;a\ndeg;mm;mm/deg;\n0,5;1,5;0,25;\n10,5;7;;0,125\n20;9;0;0\n")
    table = Table.from_file(file, columns={"x": "phi", "y": 2, "v": "V", "a": 4}, interpolation="quintic")
    assert (table.x_unit, table.y_unit) == ("deg", "mm")
    assert list(table.points.x) == [0.5, 10.5, 20]
    assert np.array_equal(table.points.v, [0.25, math.nan, 0], equal_nan=True)
    assert np.array_equal(table.points.a, [math.nan, 0.125, 0], equal_nan=True)


@pytest.mark.parametrize(
    ("text", "x", "y"),
    [
        ('"Master","Slave"\n"0,0","0,0"\n"90,5","10,25"\n"180,0","0,0"\n', [0, 90.5, 180], [0, 10.25, 0]),
        ('"Master (deg; cam)";"Slave (mm; cam)";note\n0;0;"a;b"\n90;10;\n180;0;;;\n', [0, 90, 180], [0, 10, 0]),
        ("Nr\tMaster\tSlave\n\t0\t0\n2\t90\t10\n\t180\t0\n", [0, 90, 180], [0, 10, 0]),
    ],
)
def test_quoted_and_empty_fields(tmp_path, text, x, y):
    """CAM-92: separators within quotation marks separate nothing, empty fields count."""
    file = tmp_path / "t.csv"
    file.write_text(text)
    points = Table.from_file(file).points
    assert (list(points.x), list(points.y)) == (x, y)


ROWS = "(dX := 0, dY := 0, dV := 0, dA := 0),{}(dX := 180, dY := 0, dV := 0, dA := 0)"
ARRAY = "{}c : ARRAY[0..2, 0..1] OF LREAL := [0, 0,\n 90, 10, {}\n 180, 0];"


@pytest.mark.parametrize(
    "text",
    [
        ROWS.format("(dX := 90 (* top *), dY := 10, dV := 0, dA := 0),"),
        ROWS.format("(dX := 90, {attribute 'x'} dY := 10, dV := 0, dA := 0), // (dX := 95, dY := 99)\n"),
        ROWS.format("\n(* (dX := 80, dY := 99), (* old *)\n(dX := 85, dY := 99), *)(dX := 90, dY := 10),"),
        ROWS.format("/* (dX := 80, dY := 99), */(dX := 90, dY := 10), (* a (* b *)"),
        ARRAY.format("// old: ARRAY[0..2, 0..1] OF LREAL := [0, 0, 90, 77, 180, 0];\n", "(* top, 10 *)"),
    ],
)
def test_comments_of_structured_text(tmp_path, text):
    """CAM-92: neither comments nor pragmas hide points or add any."""
    file = tmp_path / "t.exp"
    file.write_text(text)
    points = Table.from_file(file).points
    assert (list(points.x), list(points.y)) == ([0, 90, 180], [0, 10, 0])


@pytest.mark.parametrize("text", ['Master ["];Slave ["]\n0;0\n90;10\n', 'x ["]\ty ["]\n0\t0\n90\t10\n'])
def test_inch_marks_are_no_quotes(tmp_path, text):  # CAM-92
    file = tmp_path / "cam.txt"
    file.write_text(text)
    assert np.allclose(Table.from_file(file).at(np.array([0.0, 90.0])).y, [0, 10])


def test_the_first_line_of_numbers_may_be_short(tmp_path):  # CAM-92
    file = tmp_path / "cam.txt"
    file.write_text("0;0\n90;10;1;0\n180;0;0;0\n")
    assert np.allclose(Table.from_file(file).at(np.array([0.0, 90.0, 180.0])).y, [0, 10, 0])


CODESYS_DEFAULT = """
(* made by the cam editor *)
  (dX := 0.0, dY := 0, dV := 0, dA := 0),
  (dX := 120, dY := 120, dV := 1, dA := 0),
  (dX := 240, dY := 240, dV := 1, dA := 0),
  (dX := 360, dY := 360, dV := 0, dA := 0)
"""


def test_codesys_polynomials_are_those_of_codesys(tmp_path):  # CAM-92: its default cam, three quintics
    file = tmp_path / "default.exp"
    file.write_text(CODESYS_DEFAULT)
    table = Table.from_file(file)
    u = np.linspace(0, 1, 50)
    # From rest at 0 to slope 1 at 120: y = 120 (6 u^3 - 8 u^4 + 3 u^5), from its six conditions.
    assert np.allclose(table.at(120 * u).y, 120 * (6 * u**3 - 8 * u**4 + 3 * u**5))
    assert np.allclose(table.at(np.linspace(120, 240, 9)).dy, 1)


TWINCAT = """
  (PointIndex := 1, FunctionType := MOTIONFUNCTYPE_MODSINUSLINIE, MasterPos := 0, SlavePos := 0, SlaveVelo := 0),
  (PointIndex := 2, FunctionType := MOTIONFUNCTYPE_POLYNOM1, MasterPos := 90, SlavePos := 40),
  (PointIndex := 3, FunctionType := MOTIONFUNCTYPE_POLYNOM5, MasterPos := 150, SlavePos := 40, SlaveVelo := 0),
  (PointIndex := 4, FunctionType := MOTIONFUNCTYPE_POLYNOM1, MasterPos := 270, SlavePos := 10, SlaveVelo := -0.2),
  (PointIndex := 5, FunctionType := MOTIONFUNCTYPE_NOTDEF, MasterPos := 300, SlavePos := 4)
"""
TWINCAT_COLUMNS = """PointIndex\tFunctionType\tPointType\tRelIndex\tMasterPos\tSlavePos\tSlaveVelo\tSlaveAcc\tJerk
1\t11\t0\t1\t0,0\t0,0\t0,0\t0,0\t0,0
2\t1\t0\t1\t90,0\t40,0\t0,0\t0,0\t0,0
3\t5\t0\t1\t150,0\t40,0\t0,0\t0,0\t0,0
4\t1\t0\t1\t270,0\t10,0\t-0,2\t0,0\t0,0
5\t0\t0\t1\t300,0\t4,0\t-0,2\t0,0\t0,0
"""


@pytest.mark.parametrize("text", [TWINCAT, TWINCAT_COLUMNS], ids=["structured text", "columns"])
def test_twincat_motion_functions_become_laws(tmp_path, text):  # CAM-92
    file = tmp_path / "mf.txt"
    file.write_text(text)
    table = Table.from_file(file)
    own = Table.from_segments(
        [
            {"to": {"x": 90, "y": 40}, "law": "modified_sine"},
            {"to": {"x": 150, "y": 40}, "law": "dwell"},
            {"to": {"x": 270, "y": 10}, "begin_v": 0, "begin_a": 0, "end_v": -0.2, "end_a": 0},
            {"to": {"x": 300, "y": 4}, "law": "line"},
        ]
    )
    x = np.linspace(0, 300, 1001)
    for got, wanted in zip(table.at(x), own.at(x), strict=True):
        assert np.allclose(got, wanted, atol=1e-12)


@pytest.mark.parametrize(
    ("function", "number", "law"),
    [
        ("SINUSLINIE", 10, "cycloid"),
        ("MODSINUSLINIE", 11, "modified_sine"),
        ("BESCHLTRAPEZ", 13, "modified_trapezoid"),
        ("POLYNOM5_MM", 15, "polynomial_345"),
    ],
)
def test_twincat_functions_by_name_and_number(tmp_path, function, number, law):
    """CAM-92: the members of MC_MotionFunctionType."""
    own = Table.from_segments([{"to": {"x": 100, "y": 10}, "law": law}])
    file = tmp_path / "mf.txt"
    x = np.linspace(0, 100, 101)
    for name in (f"MOTIONFUNCTYPE_{function}", f"MC_MotionFunctionType.MOTIONFUNCTYPE_{function}", number):
        ends = "SlaveVelo := 0, SlaveAcc := 0"
        file.write_text(
            f"(FunctionType := {name}, MasterPos := 0, SlavePos := 0, {ends}),\n"
            f"(FunctionType := {name}, MasterPos := 100, SlavePos := 10, {ends})"
        )
        assert np.allclose(Table.from_file(file).at(x).y, own.at(x).y, atol=1e-12)


IGNORED = {
    "type": """c : ARRAY[0..2] OF MC_MotionFunctionPoint := [
  (FunctionType := 1, PointType := MOTIONPOINTTYPE_REST, MasterPos := 0, SlavePos := 0),
  (FunctionType := 5, PointType := MOTIONPOINTTYPE_IGNORE, MasterPos := 50, SlavePos := 99),
  (FunctionType := 1, PointType := MOTIONPOINTTYPE_REST, MasterPos := 100, SlavePos := 10)];""",
    "MC3": """c : ARRAY[1..3] OF MotionFunctionPoint := [
  (FunctionType := 1, MasterPosition := 0, SlavePosition := 0),
  (FunctionType := 5, MasterPosition := 50, SlavePosition := 99, Ignored := TRUE),
  (FunctionType := 1, MasterPosition := 100, SlavePosition := 10, Ignored := FALSE)];""",
    "columns": "FunctionType;PointType;MasterPos;SlavePos\n1;1;0;0\n5;0;50;99\n1;1;100;10\n",
    "type without positions": """c : ARRAY[0..2] OF MC_MotionFunctionPoint := [
  (FunctionType := 1, PointType := 1, MasterPos := 0, SlavePos := 0),
  (PointType := MOTIONPOINTTYPE_IGNORE),
  (FunctionType := 1, PointType := 1, MasterPos := 100, SlavePos := 10)];""",
    "MC3 without numbers": """c : ARRAY[0..2] OF MotionFunctionPoint := [
  (FunctionType := 1, MasterPosition := 0, SlavePosition := 0),
  (MasterPosition := NONE, Ignored := TRUE),
  (FunctionType := 1, MasterPosition := 100, SlavePosition := 10)];""",
    "columns without positions": "FunctionType;PointType;MasterPos;SlavePos\n1;1;0;0\n5;0;;-\n1;1;100;10\n",
}


@pytest.mark.parametrize("text", IGNORED.values(), ids=IGNORED.keys())
def test_points_that_twincat_ignores_are_left_out(tmp_path, text):
    """CAM-92: the function before an ignored point leads to the point behind it."""
    file = tmp_path / "mf.txt"
    file.write_text(text)
    assert np.allclose(Table.from_file(file).at(np.array([0.0, 25, 50, 100])).y, [0, 2.5, 5, 10])


@pytest.mark.parametrize("mark", ["PointType", "Ignored"])
def test_points_of_chosen_columns_are_ignored_as_well(tmp_path, mark):
    """CAM-92: columns names the positions only."""
    kept, left_out = ("1", "0") if mark == "PointType" else ("FALSE", "TRUE")
    file = tmp_path / "mf.txt"
    file.write_text(f"A;{mark};B\n0;{kept};0\n50;{left_out};99\n;{left_out};\n100;{kept};10\n")
    table = Table.from_file(file, columns={"x": "A", "y": 3}, interpolation="linear")
    assert table.at(50).y == pytest.approx(5)


def test_types_of_0_of_every_point_ignore_none(tmp_path):
    """CAM-92: the file gives no types then."""
    file = tmp_path / "mf.txt"
    points = ", ".join(f"(PointType := 0, MasterPos := {x}, SlavePos := {y})" for x, y in ((0, 0), (50, 9), (100, 10)))
    file.write_text(f"c : ARRAY[0..2] OF MC_MotionFunctionPoint := [{points}];")
    assert Table.from_file(file).at(50).y == pytest.approx(9)
    file.write_text("A;PointType;B\n0;0;0\n50;0;9\n100;0;10\n")
    assert Table.from_file(file, columns={"x": "A", "y": "B"}).at(50).y == pytest.approx(9)


def test_twincat_cnc_tables_close_over_a_turn(tmp_path):  # CAM-92
    file = tmp_path / "sine.tab"
    values = [10 * math.sin(2 * math.pi * k / 36) for k in range(36)]
    head = "Tablename = Sinus_360\nTabletype = 3 # one column\nTable-ID = 402\nFunctiontype = 1\nLines = 36\n"
    file.write_text(head + "\n".join(f"{value:.9f}" for value in values))
    table = Table.from_file(file, interpolation="quintic")
    assert (table.begin, table.end, table.cyclic) == (0, 360, True)
    x = np.linspace(0, 360, 500)
    assert np.abs(table.at(x).y - 10 * np.sin(np.radians(x))).max() < 1e-3
    zebra = tmp_path / "zebra.tab"
    zebra.write_text("Tabletype = 4\nFunctiontype = 4\nLines = 2\n90 0\n270 180\n")  # the turn closes with a line
    table = Table.from_file(zebra)
    assert (table.begin, table.end) == (90, 450)
    assert np.allclose(table.at(np.linspace(275, 445, 9)).dy, -1)


@pytest.mark.parametrize(
    ("text", "columns", "sentence"),
    [
        ("", None, "expected a table of numbers, found an empty file"),
        ("x;y\n0,5;1\n1,5;abc\n", None, ":3: expected a finite number for y, found 'abc'"),
        ("x;y\n0;1\n1.234,5;2\n", None, ":3: expected a finite number for x, found '1.234,5'"),
        ("x;y\n0;nan\n1;2\n", None, ":2: expected a finite number for y, found 'nan'"),
        ("x;y\n0;1\n", None, "expected 2 to 100,000 points, found 1"),
        ("angle;lift\n0;1\n1;2\n", None, "expected columns for x and y, found 'angle', 'lift': say which with columns"),
        ("0 1 2 3 4\n1 2 3 4 5\n", None, "expected the columns x, y and perhaps v, a, found 5"),
        ("a;b\n0;1\n1;2\n", {"x": "a", "y": "c"}, "columns: expected for y one of a, b, or a number from 1 to 2"),
        ("a;b\n0;1\n1;2\n", {"x": "a"}, "columns: expected x and y at least"),
        ("x;y\n1;1\n0;2\n", None, "odd.txt:3:1: expected x above 1 of the point before, found 0"),
        ("(MasterPos := 0, SlavePos := 0, FunctionType := BESTEHORN), (MasterPos := 1, SlavePos := 1)", None,
         "expected one of the functions"),
        ("Tabletype = 3\n0 0\n120\n240 5\n", None, ":3: expected as many positions as in the first line, 2, found 1"),
        ("Tabletype = 3\nLines = 3\n1\n2\n", None, "Lines: expected 3 lines of values, found 2"),
        ("x,y\n0,5,1,25\n1,5,2,5\n", None, ":2: expected 2 fields as in the head, found 4"),
        ("x;y\n0;0\n90;10;7\n180;0\n", None, ":3: expected 2 fields as in the head, found 3"),
        ('x,y\n"0","0"\n"1,000","2"\n', None, ":3: expected a finite number for x, found '1,000'"),
        ("Nr\tx\ty\tv\n\t0\t1\n1\t1\t1\t0\t5\n", None, ":3: expected 4 fields as in the head, found 5"),
        ("(dX := 0, dY := 0),\n(dX := (90), dY := 1)", None,
         ":2: expected (dX := ..., dY := ...) or (MasterPos := ..., SlavePos := ...), found 'dX := (90), dY := 1)'"),
        ("(dX := 0, dY := 0),\n(dX := 90, dV := 1)", None,
         ":2: expected (dX := ..., dY := ...) or (MasterPos := ..., SlavePos := ...), found 'dX := 90, dV := 1)'"),
        ("c : ARRAY[0..3, 0..1] OF LREAL := [0, 0,\n90, 10,\n180, 0];", None,
         ":1: ARRAY[0..3]: expected 4 points, found 3"),
        ("c : ARRAY[1..3] OF SMC_CAMXYVA := [(dX := 0, dY := 0),\n(dX := 9, dY := 1)];", None,
         ":1: ARRAY[1..3]: expected 3 points, found 2"),
        ("c : ARRAY[0..1] OF MC_MotionFunctionPoint := [(PointType := 0, MasterPos := 0, SlavePos := 0),\n"
         "(PointType := 0)];", None,
         ":2: expected (dX := ..., dY := ...) or (MasterPos := ..., SlavePos := ...), found 'PointType := 0)"),
        ("c : ARRAY[0..LAST] OF SMC_CAMXYVA := [(dV := 0, dA := 0),\n(dX := 9, dY := 1),\n(dX := 18, dY := 2)];", None,
         ":1: expected (dX := ..., dY := ...) or (MasterPos := ..., SlavePos := ...), found 'dV := 0, dA := 0)"),
        ("(dX := 0, dY := 0),\n(* (dX := 9, dY := 1)", None, ":2: the comment has no end: expected *)"),
        ("a: ARRAY[0..0, 0..1] OF REAL := [0, 0];\nb: ARRAY[0..0, 0..1] OF REAL := [1, 1];", None,
         ":2: expected one table of positions, found another one in line 1"),
        ("f(a := 1)", None, "expected (dX := ..., dY := ...) or (MasterPos := ..., SlavePos := ...), found neither"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_place(tmp_path, text, columns, sentence):  # CAM-92
    file = tmp_path / "odd.txt"
    file.write_text(text)
    with pytest.raises(takt.ConfigError, match=re.escape(sentence)):
        Table.from_file(file, columns=columns)
