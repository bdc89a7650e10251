"""G-code as the controllers that it is written for run it (PY-22, EN-37)."""

from __future__ import annotations

import math
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from takt.cli import main
from takt.gcode import DIALECTS, Options, parse_gcode, read_gcode
from takt.toolpath import Point, Toolpath, ToolpathError


def ends(text: str, **options: object) -> list[Point]:
    return [one.end for one in parse_gcode(text, options=Options(**options)).elements]  # type: ignore[arg-type]


def along_x(text: str, **options: object) -> list[float]:
    return [round(end[0], 9) for end in ends(text, **options)]


def wrong(text: str, **options: object) -> str:
    with pytest.raises(ToolpathError) as error:
        parse_gcode(text, options=Options(**options), source="p.nc")  # type: ignore[arg-type]
    return str(error.value)


def path_or_sentence(text: str, options: Options | None = None) -> Toolpath | str:
    try:
        return parse_gcode(text, options=options)
    except ToolpathError as error:
        return str(error)


# --- Expressions and parameters ---


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("[1 + 2 * 3 ** 2]", 19),
        ("[2 ** 3 ** 2]", 64),  # from the left
        ("[-2 ** 2]", 4),  # the sign belongs to the number
        ("[8 / 4 / 2]", 1),
        ("[2.0 / 3 * 1.5 - 5.5 / 11.0]", 0.5),
        ("[7 mod 3 + -7 mod 3]", 3),
        ("[1 + acos[0] - [2 ** [4.0 / 2]]]", 87),
        ("sin[30]", 0.5),
        ("-sqrt[16]", -4),
        ("atan[-1]/[-1]", -135),
        ("[fix[-2.8] * 100 + fup[-2.8] * 10 + round[2.5]]", -317),
        ("[round[-2.5] + abs[-1]]", -2),
        ("exp[ln[5]]", 5),
        ("[1 lt 2 and 3 ge 3]", 1),
        ("[1 eq 1.0000001]", 1),
        ("[1 ne 1.00001]", 1),
        ("[2 gt 1 xor 1]", 0),
        ("[0 or 5]", 1),
        ("[1.5e2 - 1e-1]", 149.9),
        ("tan[45]", 1),
        ("--3", 3),
    ],
)
def test_expressions(expression: str, value: float) -> None:
    path = parse_gcode(f"G1 X500\nX{expression} F100")
    assert path.end[0] == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize(
    ("expression", "said"),
    [
        ("[1 / 0]", "division by 0"),
        ("[1 mod 0]", "MOD by 0"),
        ("sqrt[-1]", "SQRT of -1"),
        ("ln[0]", "LN of 0"),
        ("asin[1.5]", "ASIN of 1.5"),
        ("[-8 ** 0.5]", "a negative number to the power of 0.5"),
        ("[10 ** 400]", "no finite value"),
        ("exp[1000]", "no finite value"),
        ("sin[#8 * #8]", "no finite value"),
        ("[[#8 * #8] mod 5]", "no finite value"),
        ("#[0]", "#0: expected the number of a parameter from 1 to 5602"),
        ("#1.5", "#1.5: expected the number of a parameter"),
        ("#<depth>", "#<depth> has no value"),
        ("#5410", "#5410 is the tool's table, known to the machine only; --set 5410=NUMBER gives it a value"),
        ("#5221", "#5221 is an offset of G54 that is not in the program; --offset G54 X Y Z gives it"),
        ("[1 + ]", "expected a number, a parameter or an expression, found ']'"),
        ("[1", "expected an operator or ]"),
        ("foo[1]", "expected a number, a parameter or an expression, found 'FOO[1]'"),
        ("[" * 5000 + "1" + "]" * 5000, "nest deeper than 100"),
        ("[" + "1+#1" * 1 + "+#1" * 50_000 + "]", "too long"),
        ("9" * 400, "too many digits"),
    ],
)
def test_expressions_that_have_no_value(expression: str, said: str) -> None:
    assert said in wrong(f"#8 = 1{'0' * 200}\nG1 X{expression}")
    assert wrong(f"#8 = 1{'0' * 200}\nG1 X{expression}").startswith("p.nc:2: ")


def test_parameters() -> None:
    """Set at the end of their line; indices of indices; local and global names; values from outside."""
    assert along_x("#3 = 15\n#3=6 G1 X#3 F60\nX#3") == [15, 6]
    assert along_x("#1=2 #2=30\nG1 X##1 F60") == [30]
    assert along_x("#<Deep Hole>=4\n#<_all>=5\nG1 X[#<deephole> + #<_ALL> + exists[#<no>]] F60") == [9]
    assert along_x("G1 X#<_width> F60\nX#5410", parameters={"_width": 12.5, "5410": 6}) == [12.5, 6]
    # The values of a line are those before it.
    assert along_x("G20 G1 X1 F60\nG21 X[#5420 + #<_x>]\nX[#5420 * 3]\nX#<_metric>") == [25.4, 2, 6, 1]


@given(
    st.recursive(
        st.integers(-50, 50).map(str),
        lambda inner: st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda t: f"({t[0]}{t[1]}{t[2]})"),
        max_leaves=12,
    )
)
def test_property_expressions_are_those_of_arithmetic(expression: str) -> None:
    """Against Python, with brackets for its parentheses."""
    value = float(eval(expression))
    if abs(value) < 1e7:
        text = "[" + expression.replace("(", "[").replace(")", "]") + "]"
        assert parse_gcode(f"G1 X{text}").end[0] == pytest.approx(value)


# --- The order of lines ---

LOOPS = {
    "while": "#1=0\no7 while [#1 lt 3]\n#1=[#1+1]\nG1 X#1 F60\no7 endwhile\nX10",
    "do": "#1=0\no7 do\n#1=[#1+1]\nG1 X#1 F60\no7 while [#1 lt 3]\nX10",
    "repeat": "G91\no7 repeat [3]\nG1 X1 F60\no7 endrepeat\nG90 X10",
    "sub": "o7 sub\nG1 X#1 F60\no7 endsub\no7 call [1]\no7 call [1+1]\no7 call [3]\nG1 X10",
    "name": "o<go> sub\nG1 X#1 F60\no<go> endsub\n#4=3\no<go> call [1]\no<GO> call [2]\no<go> call [#4]\nG1 X10",
    "index": "o103 sub\nG1 X#1 F60\no103 endsub\no[100+3] call [1]\n#9=103\no#9 call [2]\no103 call [3]\nX10",
    "break": "#1=0\no7 while [1]\n#1=[#1+1]\no8 if [#1 gt 3]\no7 break\no8 endif\nG1 X#1 F60\no7 endwhile\nX10",
    "continue": "#1=0\no7 do\n#1=[#1+1]\no8 if [#1 eq 2]\n"
    "o7 continue\no8 endif\nG1 X#1 F60\no7 while [#1 lt 3]\nX2 \nX10",
    "fanuc": "O1000\nG91 M98 P22 L3\nG90 G1 X10\nM30\nO22\nG1 X1 F60\nM99",
    "recursion": "o<r> sub\no9 if [#1 gt 0]\no<r> call [#1-1]\nG1 X#1 F60\no9 endif\no<r> endsub\no<r> call [3]\nX10",
}


@pytest.mark.parametrize("kind", [name for name in LOOPS if name != "continue"])
def test_three_moves_in_each_way_to_repeat(kind: str) -> None:
    assert along_x(LOOPS[kind]) == [1, 2, 3, 10]


def test_continue() -> None:
    assert along_x(LOOPS["continue"]) == [1, 3, 2, 10]


@pytest.mark.parametrize(
    ("text", "x"),
    [
        # continue and break of the outer loop: the counter of the inner one begins anew
        ("o1 repeat [2]\no2 repeat [3]\n{move}\no3 if [#1 eq 1]\no1 continue\no3 endif\no2 endrepeat\no1 endrepeat", 4),
        (
            "o9 repeat [2]\no1 while [1]\no2 repeat [3]\n{move}\no3 if [#1 eq 1]\no1 break\no3 endif\no2 endrepeat\n"
            "o1 break\no1 endwhile\no9 endrepeat",
            4,
        ),
        # the second of two runs that M98 asks for
        ("M98 P100 L2\nM2\nO100\no2 repeat [3]\n{move}\no3 if [#1 eq 1]\nM99\no3 endif\no2 endrepeat\nM99", 4),
    ],
)
def test_loops_that_are_left_early_begin_anew(text: str, x: int) -> None:
    """PY-22."""
    text = "#1=0\n" + text.format(move="#1=[#1+1]\nG1 X#1 F60")
    assert along_x(text) == list(range(1, x + 1))


@pytest.mark.parametrize(("value", "x"), [(1, 10), (2, 20), (3, 30), (4, 40)])
def test_branches(value: int, x: int) -> None:
    text = (
        f"#1={value}\no1 if [#1 eq 1]\nG1 X10\no1 elseif [#1 eq 2]\nG1 X20\no1 elseif [#1 eq 3]\no2 if [1]\nG1 X30\n"
        "o2 endif\no1 else\nG1 X40\no1 endif\nG1 Y1"
    )
    assert along_x(text) == [x, x]


def test_subs() -> None:
    """#1 to #30 and names are those of a call, all others of the program; return hands back a value."""
    text = (
        "#1=5 #31=1 #<a>=7\no<s> sub\n#2=99 #31=2 #<a>=8\no<s> return [#1*2]\nG1 X999\no<s> endsub\no<s> call [21]\n"
        "G1 X#1 F60\nX#31\nX#<a>\nX#<_value>\nX#2"
    )
    assert along_x(text) == [5, 2, 7, 42, 0]


def test_modal_states_are_kept_and_restored() -> None:
    text = "G21 G90 F60\no1 sub\nM73\nG20 G91\nG1 X1\no1 endsub\nG1 X1\no1 call\nG1 X2\nM70\nG91\nG1 X1\nM72\nX5\nM2"
    assert along_x(text) == [1, 26.4, 2, 3, 5]


def test_subs_in_files_beside_the_program(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "step.ngc").write_text("o<step> sub\nG1 X[#5420+#1] F60\no<leap> call\no<step> endsub\n")
    (tmp_path / "lib/leap.ngc").write_text("o<leap> sub\nG1 Y5\no<leap> endsub\n")
    (tmp_path / "main.ngc").write_text("o<step> call [3]\no<../step> call\n")
    with pytest.raises(ToolpathError, match=r"main\.ngc:2: expected O<\.\./step> sub, found none in the file"):
        read_gcode(tmp_path / "main.ngc", options=Options(subroutines=[tmp_path / "lib"]))
    (tmp_path / "main.ngc").write_text("o<step> call [3]\no<step> call [2]\nM2")
    path = read_gcode(tmp_path / "main.ngc", options=Options(subroutines=tmp_path / "lib"))
    path = read_gcode(tmp_path / "main.ngc", options=Options(subroutines=str(tmp_path / "lib")))
    path = read_gcode(tmp_path / "main.ngc", options=Options(subroutines=[tmp_path / "lib"]))
    assert [one.end[:2] for one in path.elements] == [(3, 0), (3, 5), (5, 5)]
    with pytest.raises(ToolpathError, match=r"step\.ngc:3: expected O<leap> sub"):
        read_gcode(tmp_path / "main.ngc")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("o1 if [1]\nG1 X1", "p.nc:1: O1 if has no end"),
        ("o1 endif", "p.nc:1: O1 endif has no if before it"),
        (
            "o1 while [1]\no2 if [1]\no1 endwhile\no2 endif",
            "p.nc:3: O1 endwhile has no while before it, but stands within O2 if",
        ),
        ("o1 sub\no2 sub\no2 endsub\no1 endsub", "p.nc:2: O2 sub stands within O1 sub"),
        ("o1 sub\no1 endsub\no1 sub\no1 endsub", "p.nc:3: O1 sub is there already, in line 1"),
        ("o1 else", "p.nc:1: O1 else has no if before it"),
        ("o1 break", "p.nc:1: O1 break stands in no loop"),
        ("o1 return", "p.nc:1: O1 return stands in no sub"),
        ("o1 call", "p.nc:1: expected O1 sub, found none in the file"),
        ("o1 while [1]\no1 endwhile", "more than 1,000,000 lines were repeated; a loop does not end"),
        ("o1 sub\no1 call\no1 endsub\no1 call", "p.nc:2: calls nest deeper than 10"),
        ("o1 repeat [1] [2]\no1 endrepeat", "p.nc:1: repeat: expected 1 values in brackets, found 2"),
        ("M98", "p.nc:1: M98: expected P, the number of a subprogram"),
        ("M98 P7", "p.nc:1: M98: expected a program O7 in this file, found none"),
        ("M98 P7\no7 sub\no7 endsub", "p.nc:1: M98: expected a program O7 in this file, found a sub"),
        ("G1 X1\nO5\nG1 X2", "p.nc:2: O5 begins before the program above it ends"),
        ("M72", "p.nc:1: M72 has no M70 before it"),
        ("O1000\nM98 P2 L0.5\nM30\nO2\nM99", "p.nc:2: M98: L: expected a whole number of repeats, found 0.5"),
        ("(ABORT, no tool)\nG1 X1", "p.nc:1: the program ends itself: (ABORT, no tool)"),
        (";py,self.execute()", "p.nc:1: Python in a comment is not run"),
    ],
)
def test_order_of_lines_that_is_none(text: str, said: str) -> None:
    assert said in wrong(text)


def test_programs_that_fanuc_calls() -> None:
    assert along_x("M98 P30022\nM30\nO22\nG91 G1 X1 F60\nM99", dialect="fanuc") == [1, 2, 3]
    assert along_x("M98 P1000001\nM30\nO1000000\nG1 X2\nM99\nO1000001\nG1 X1 F60\nM99") == [1]
    assert "O30022" in wrong("M98 P30022\nM30\nO22\nM99", dialect="linuxcnc")
    assert parse_gcode("O1234\nG1 X1 F60\nM99").left_out == ("M99, which repeats the program for ever (1 time)",)


# --- What is counted of a file ---


@pytest.mark.parametrize(
    ("text", "x"),
    [
        ("%\nG1 X1\n%\nG1 X2\n", [1]),
        ("(a)\n%\nG1 X1\nM2\n%\nG1 X2\n", [1]),
        ("G1 X1\nM30\n%\n", [1]),
        ("G1 X1 ; layer\u2028G1 X5\nX2", [1, 2]),
        ("G1 X1 (a\x0bb\x0cc)\x0b\nX2", [1, 2]),
        ("G1 X1\rX2\r\nX3", [1, 2, 3]),
        ("\ufeffG1 X1", [1]),
        ("g0X +0. 12 34Y 7", [0.1234]),
        ("N10.5 G01 X1\nN10 X2", [1, 2]),
    ],
)
def test_lines(text: str, x: list[float]) -> None:
    assert along_x(text) == x


def test_code_behind_a_lone_percent_is_refused() -> None:
    assert wrong("G1 X1\n%\nG1 X2").startswith("p.nc:2: the program ends here with '%', but line 3 goes on")


def test_deleted_blocks() -> None:
    text = "/G1 X5 F60\nG1 X1 F60\n/2 X7"
    assert along_x(text) == [5, 1, 7]
    assert along_x(text, delete_blocks=True) == [1]
    assert parse_gcode(text).left_out == ("the / of 2 lines, which are run",)
    assert parse_gcode(text, options=Options(delete_blocks=True)).left_out == ("2 lines that / deletes",)


@pytest.mark.parametrize("data", ["(Größe)\nG1 X1".encode("cp1252"), b"\xef\xbb\xbf(\xc3\xbc)\nG1 X1", b"G1 X1\n\x1a"])
def test_encodings(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.nc").write_bytes(data)
    assert read_gcode(tmp_path / "a.nc").end == (1, 0, 0)


@pytest.mark.parametrize("data", [bytes(range(256)), b"\x7fELF\x02\x01\x01\x00", b"PK\x03\x04", b"G1 X1\x00"])
def test_what_is_no_text(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.nc").write_bytes(data)
    with pytest.raises(ToolpathError, match=r"a\.nc: is no text"):
        read_gcode(tmp_path / "a.nc")


# --- Dialects ---


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("G1 X1 Y2 E0.3", "marlin"),
        ("M104 S200", "marlin"),
        (";LAYER:1", "marlin"),
        ("o<a> call", "linuxcnc"),
        ("#<a>=1", "linuxcnc"),
        ("G43.1 Z1", "linuxcnc"),
        ("O1000 (part)", "fanuc"),
        ("M98 P1", "fanuc"),
        ("G04 X1.5", "fanuc"),
        ("$H", "grbl"),
        ("G1 X1 (E1.0)", "rs274"),
        ("G1 X1.5E-3", "rs274"),
    ],
)
def test_dialects_are_recognised(text: str, name: str) -> None:
    from takt.gcode.dialects import of_text

    assert of_text(["G21", text, "M2"]).name == name
    assert ("line 2" in of_text(["G21", text, "M2"]).why) == (name != "rs274")


def test_two_dialects_in_one_file() -> None:
    said = "line 1 is of marlin and line 2 is of linuxcnc; choose one with --dialect marlin or linuxcnc"
    assert said in wrong("M104 S200\n#<a>=1")
    assert along_x("M104 S200\n#<a>=1\nG1 X#<a>", dialect="linuxcnc") == [1]


@pytest.mark.parametrize("dialect", [None, *DIALECTS])
@pytest.mark.parametrize(
    "line",
    [
        "M205 X8 Y8",
        "M92 X80 Y80",
        "M201 X500",
        "M84",
        "M17 X5",
        "M600",
        "G4 P1",
        "G4 X1.5",
        "G4 U3",
        "G4 F2",
        "G50 X9",
        "M3 S1000",
        "T1",
    ],
)
def test_what_is_no_move_moves_nothing(dialect: str | None, line: str) -> None:
    """In whatever dialect: it is left out or refused."""
    found = path_or_sentence(f"G1 X5 F600\n{line}\nG1 Y2", Options(dialect=dialect))
    if isinstance(found, Toolpath):
        assert [one.end for one in found.elements] == [(5, 0, 0), (5, 2, 0)]
        assert found.left_out
    else:
        assert found.startswith("G-code:2: ")


@pytest.mark.parametrize(("dialect", "turns"), [("marlin", 2.5), ("linuxcnc", 1.5), ("fanuc", 1.5), (None, 1.5)])
def test_turns_of_an_arc(dialect: str | None, turns: float) -> None:
    """Of half a turn with P2: P counts the turn that is not complete, except Marlin's."""
    path = parse_gcode("G2 X2 I1 P2", options=Options(dialect=dialect))
    assert path.length == pytest.approx(turns * 2 * math.pi)


def test_exponents() -> None:
    assert along_x("G1 X1 F60\nX2.5e-1 Y1\nX1E+2") == [1, 0.25, 100]
    assert "an exponent, or the word E?" in wrong("G1 X1E5")
    assert "has no exponents" in wrong("G1 X1e-5", dialect="linuxcnc")
    assert "Marlin takes e for a word" in wrong("G1 X1e-05 E1.0", dialect="marlin")
    assert parse_gcode("G1 X5 Y20E-1.5 F60", options=Options(dialect="marlin")).end == (5, 20, 0)


def test_marlin() -> None:
    """G0 runs with the feed; texts, checksums; macros of Klipper only on request."""
    path = parse_gcode("N1 G0 X1 F600*35\nM117 X9 (Y9\nG1 X2 E1\nM104 S200 ; X5\nG92 E0\nG10\nG1 X3 E-2")
    assert [(one.end[0], one.velocity) for one in path.elements] == [(1, 10), (2, 10), (3, 10)]
    assert "START_PRINT is not read (--leave-out START_PRINT leaves it out)" in wrong("START_PRINT BED=60\nM104 S200")
    assert along_x("START_PRINT X=60\nM104 S200\nG1 X1", leave_out=["start_print"]) == [1]


def test_marlin_has_letters_without_numbers() -> None:
    """PY-22: they are left out with an M code, and name the axes of G28; elsewhere they are refused."""
    head, moves = "M104 S200\n", "G1 X10 Y10 E1 F1200\nG1 X20 E2\n"
    path = parse_gcode(f"{head}G28 W\nG28 X Y\nG29 A\n{moves}M84 X Y E ;Disable\nM1002 gcode_claim_action : 14\n")
    assert [one.end for one in path.elements] == [(10, 10, 0), (20, 10, 0)]
    said = "M104 (1 time), G28 (2 times), G29 (1 time), E (2 times), M84 (1 time), M1002 (1 time)"
    assert ", ".join(path.left_out) == said
    assert "p.nc:3: G28 needs the machine's zero" in wrong(f"{moves}G28 X\nG1 X5", dialect="marlin")
    home = {"offsets": {"G54": (-1, -2, -3)}, "dialect": "marlin"}
    assert ends("G1 X1 Y1 Z1 F60\nG28 X0 Y\nG1 Z2", **home) == [(1, 1, 1), (1, 2, 1), (1, 2, 2)]
    assert "p.nc:1: expected a letter and a number, found 'XF60'" in wrong("G1 X F60", dialect="marlin")
    assert "p.nc:1: expected a letter and a number, found 'XG1" in wrong("M84 X G1 Y1", dialect="marlin")
    assert "p.nc:1: M106 beside a motion: Marlin takes one command a line" in wrong("G1 X1 M106", dialect="marlin")
    beside = "G1 X10 F600\nM106 S255 G1 X20\nG1 X30"
    assert along_x(beside, dialect="marlin", leave_out="M106") == [10, 20, 30]
    assert "p.nc:2: M3 beside a motion" in wrong("G1 X1 F600\nX5 M3", dialect="marlin")
    assert "--leave-out G380 leaves it out" in wrong("G380 S2 Z", dialect="marlin")
    assert along_x("G1 X1 F60\nG380 S2 Z F9 [a]\nG28 O\nX2", dialect="marlin", leave_out="G380 G28") == [1, 2]
    assert "p.nc:1: expected a letter and a number" in wrong("M84 X Y", dialect="rs274")


def test_lines_of_grbl_that_begin_with_a_dollar() -> None:
    """PY-22: settings are left out; homing and jogging are, before the first move and behind the last one."""
    path = parse_gcode("$H\n$X\n$32=1\n$$\nG21\nG1 X10 F100\n$H\n")
    assert [one.end[0] for one in path.elements] == [10]
    assert path.left_out == ("$H (2 times)", "$X (1 time)", "$ (2 times)")
    between = "G1 X10 F100\n$J=G91 X5 F9\nX20"
    assert "p.nc:2: $J is not read before a move: where the tool is then is" in wrong(between, dialect="grbl")
    assert along_x(between, dialect="grbl", leave_out="$J") == [10, 20]


@pytest.mark.parametrize(
    "line",
    [
        "G64 P0.01", "G61.1", "G43 H1", "G21 G17 G40 G49 G80 G94", "N1 G90 G17 G40 G80 G00 G20\nG21", "M73 P10 R5",
        "G92 E0", "G97 S500", "M6 T1", "G54", "G55", "G59.3", "G28 G91 Z0\nG90", "G53 G0 Z0", "M64 P0", "M66 P0 L3 Q2",
        "G30", "G28", "G91 G28 X0 Y0\nG90",
    ],
)  # fmt: skip
def test_ordinary_heads_and_ends(line: str) -> None:
    """Before the first move and behind the last one."""
    assert ends(f"{line}\nG1 X1 F60\nY2\n{line}\nM30") == [(1, 0, 0), (1, 2, 0)]


def test_heads_of_post_processors() -> None:
    fusion = "%\n(1001)\nN10 G90 G94 G17 G91.1\nN15 G21\nN20 G53 G0 Z0.\nN30 T1 M6\nN35 S5000 M3\nN40 G54\n"
    fusion += "N55 G0 X10. Y0.\nN60 G43 Z15. H1\nN65 G1 Z-1. F333.\nN70 X20.\nN80 M5\nN85 G53 G0 Z0.\nN90 M30\n%"
    assert ends(fusion) == [(10, 0, 0), (10, 0, 15), (10, 0, -1), (20, 0, -1)]
    mastercam = (
        "%\nO0001(PART)\nN100 G21\nN110 G0 G17 G40 G49 G80 G90\nN120 T2 M6\nN130 G0 G90 G54 X5. Y0. A0. S900 M3\n"
    )
    mastercam += "N140 G43 H2 Z25.\nN150 G1 Z-2. F95.5\nN160 G2 X15. R5. F191.\nN170 M5\nN180 G91 G28 Z0.\nN190 M30\n%"
    assert "p.nc:6: A is not read" in wrong(mastercam)
    assert ends(mastercam, leave_out="A")[-1] == (15, 0, -2)
    prusa = "; generated by PrusaSlicer 2.8\nM201 X500 Y500\nM205 X8.00 Y8.00\nG28 ; home\nG21\nG90\nM83\nG1 Z.2 F720\n"
    prusa += "G1 X5 Y5 F9000\nG1 X9 E.4 F1200\nM73 P99 R0\nG1 E-.8 F2100\nM107\n"
    assert ends(prusa) == [(0, 0, 0.2), (5, 5, 0.2), (9, 5, 0.2)]


# --- Words that are left out ---


@pytest.mark.parametrize(
    ("line", "leave_out"),
    [
        ("G41 D1 X2", "G41"),
        ("G28 X9 Y9", "G28"),
        ("G53 G0 Y9", "G53"),
        ("G10 L1 P1 R3", ["G10"]),
        ("G33 Z-5 K1", "G33"),
        ("G38.2 Z-5", "g38.2"),
        ("G68 X1 Y1 R30", "G68"),
        ("M107 S0 X9", "M107"),
        ("G1 X2 A90 C4", "A C"),
        ("G76 P0.1 Z-1 I-1 J.01 K.04", "G76"),
    ],
)
def test_words_are_left_out_on_request(line: str, leave_out: str | list[str]) -> None:
    text = f"G1 X1 F60\n{line}\nG1 X2 Y3"
    if not line.startswith("M"):
        assert "--leave-out" in wrong(text)
    path = parse_gcode(text, options=Options(leave_out=leave_out))
    assert path.end == (2, 3, 0)
    assert (1, 9) not in [one.end[:2] for one in path.elements]
    assert path.left_out[0].split()[0] in str(leave_out).upper()


def test_lines_that_rest_on_a_motion_are_left_out_with_it() -> None:
    path = parse_gcode("G1 X1 F60\nG33 Z-5 K1\nX3\nG1 X4\nY2", options=Options(leave_out="G33"))
    assert [one.end for one in path.elements] == [(1, 0, 0), (4, 0, 0), (4, 2, 0)]
    assert path.left_out == ("G33 (2 times)",)


@pytest.mark.parametrize("name", ["1", "G1.2.3", "M-1", "ä"])
def test_words_that_are_none_are_not_left_out(name: str) -> None:
    assert "leave_out: expected a word like M7, G41 or A" in wrong("G1 X1", leave_out=[name])


# --- Coordinates ---


def test_reference_moves_in_the_middle_need_the_machine() -> None:
    text = "G1 X1 F60\nG28\nG1 X2"
    assert wrong(text).startswith(
        "p.nc:2: G28 needs the machine's zero, which is not in the program; --offset G54 X Y Z"
    )
    assert ends(text, offsets={"G54": (10, 20, 30)}) == [(1, 0, 0), (-10, -20, -30), (2, -20, -30)]
    assert ends("G1 X1 F60\nG91 G28 Z5\nG90 G1 X2", offsets={"G54": (10, 20, 30)}) == [
        (1, 0, 0), (1, 0, 5), (1, 0, -30), (2, 0, -30),
    ]  # fmt: skip
    assert along_x("G1 X4 F60\nG28.1\nG1 X9\nG28\nG1 X2") == [4, 9, 4, 2]
    assert ends("G1 X1 F60\nG53 G0 Z0\nG1 X2", offsets={"g54": (0, 0, -40)}) == [(1, 0, 0), (1, 0, 40), (2, 0, 40)]


def test_work_offsets() -> None:
    """A path is in the coordinates of the system of its first move."""
    text = "G55 G1 X1 F60\nG54 X1\nG55 X2"
    assert "p.nc:2: G54: the path began in another coordinate system" in wrong(text)
    assert along_x(text, offsets={"G54": (100, 0, 0), "G55": (130, 0, 0)}) == [1, -29, 2]
    assert along_x("G10 L2 P1 X0 Y0 Z0\nG10 L2 P2 X5 Y0 Z0\nG1 X1 F60\nG55 X1\nG54 X2") == [1, 6, 2]
    assert along_x("G1 X4 F60\nG10 L20 P2 X0 Y0 Z0\nG55 X1\nG54 X1") == [4, 5, 1]
    assert "not in the program" in wrong("G10 L2 P2 X5\nG1 X1 F60\nG55 X1")


def test_offsets_of_g92() -> None:
    assert along_x("G1 X5 F60\nG92 X0\nX1\nG92.1\nX1\nG92 X2\nG92.2 X9\nG92.3\nX9") == [5, 6, 1, 9, 8]
    assert along_x("G52 X10\nG1 X1 F60\nG52 X0\nX1") == [11, 1]
    assert "G92: expected X, Y or Z" in wrong("G92")


def test_polar_coordinates() -> None:
    path = parse_gcode("G0 @10 ^30\n^120\nG91 ^60\n@2")
    expected = [10 * np.exp(1j * np.radians(angle)) for angle in (30, 120, 180)] + [-12]
    assert [complex(*one.end[:2]) for one in path.elements] == pytest.approx(expected)


@pytest.mark.parametrize("unit", ["G21", "G20"])
def test_polar_coordinates_with_diameters(unit: str) -> None:
    """PY-22: diameters hold for the words X; @ is a distance from the axis, with G90 and with G91."""
    path = parse_gcode(f"{unit} G7 G1 X40 Y0 F600\n@10 ^0\n^90\nG91 ^-90\n@2")
    scale = 25.4 if unit == "G20" else 1.0
    expected = [scale * point for point in (20, 10, 10j, 10, 12)]
    assert [complex(*one.end[:2]) for one in path.elements] == pytest.approx(expected)


def test_diameters_and_inverse_time() -> None:
    assert along_x("G7 G1 X10 F60\nG8 X10") == [5, 10]
    path = parse_gcode("G93 G1 X10 F2\nG3 X10 Y10 J5 F4\nG94 G1 F60 X0")
    assert [one.velocity for one in path.elements][:1] == [pytest.approx(10 * 2 / 60)]
    assert path.elements[1].velocity == pytest.approx(5 * math.pi * 4 / 60)
    assert "expected F in each line with a motion after G93" in wrong("G93 G1 X1 F1\nX2")


# --- Arcs, splines, cycles ---


@pytest.mark.parametrize(
    ("radius", "apart", "inches", "taken"),
    [
        (1, 0.004, False, True), (1, 0.006, False, False), (10, 0.009, False, True), (10, 0.02, False, False),
        (1000, 0.49, False, True), (1000, 0.51, False, False), (1e5, 0.51, False, False), (1e4, 9, False, False),
        (1, 0.0004, True, True), (1, 0.0011, True, False), (100, 0.049, True, True), (100, 0.051, True, False),
    ],
)  # fmt: skip
def test_ends_unequally_far_from_the_centre(radius: float, apart: float, inches: bool, taken: bool) -> None:
    """As LinuxCNC's manual has it: refused beyond 0.5 mm (0.05 inch), or 0.005 mm (0.0005 inch) and 0.1 %."""
    text = f"G{20 if inches else 21} G3 X{-radius} Y{radius + apart} I{-radius} F60"
    if taken:
        assert parse_gcode(text).end[1] == pytest.approx((radius + apart) * (25.4 if inches else 1))
    else:
        assert "from its centre, but ends" in wrong(text)


@given(
    st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(1e-3, 1e4), st.floats(-3.14, 3.14), st.floats(1e-4, 6.28),
    st.booleans(), st.sampled_from(["G17", "G18", "G19"]),
)  # fmt: skip
def test_property_arcs_are_as_long_as_their_angles(
    x: float, y: float, radius: float, begin: float, sweep: float, clockwise: bool, plane: str
) -> None:
    """About any centre, in each plane, by any angle; straight where no three points could tell the arc."""
    first, second, third = {"G17": (0, 1, "XYIJ"), "G18": (2, 0, "ZXKI"), "G19": (1, 2, "YZJK")}[plane]
    sign = -1 if clockwise else 1
    start = [0.0, 0.0, 0.0]
    start[first], start[second] = x + radius * math.cos(begin), y + radius * math.sin(begin)
    end = (x + radius * math.cos(begin + sign * sweep), y + radius * math.sin(begin + sign * sweep))
    a, b, i, j = third
    text = f"{plane} G90.1 {'G2' if clockwise else 'G3'} {a}{end[0]:.12f} {b}{end[1]:.12f} {i}{x:.12f} {j}{y:.12f}"
    path = parse_gcode(text, start=(start[0], start[1], start[2]))
    if radius * sweep > 1e-3:
        assert path.length == pytest.approx(radius * sweep, rel=1e-4, abs=1e-5)
    path._checked("arc")


def test_arcs_too_small_or_too_flat_for_three_points() -> None:
    assert parse_gcode("G2 X0.0000005 Y0 I0.00000025 J0 F100").elements == ()
    flat = parse_gcode("G3 X0.001 I0.0005 J10000000 F60")
    assert flat.elements[0].via is None
    assert flat.length == pytest.approx(0.001)


def test_splines() -> None:
    """The parabola of LinuxCNC's manual, y = x², and the second cubic that goes on as the first one ends."""
    parabola = parse_gcode("G0 X-2 Y4\nG5.1 X2 I2 J-8 F60", tolerance=0.001)
    points = np.array([one.end for one in parabola.elements])
    assert points[:, 1] == pytest.approx(points[:, 0] ** 2)
    exact = 2 * math.sqrt(17) + math.asinh(4) / 2
    assert parabola.length - math.hypot(2, 4) == pytest.approx(exact, rel=1e-4)
    cubic = parse_gcode("G5 I0 J3 P0 Q-3 X1 Y1\nG5 P0 Q-3 X2 Y2", tolerance=1e-4)
    half = len(cubic.elements) // 2
    first = np.array([(0, 0, 0), *(one.end for one in cubic.elements[:half])])
    second = np.array([one.end for one in cubic.elements[half - 1 :]])
    assert second - first == pytest.approx(np.broadcast_to([1, 1, 0], first.shape))
    assert "G5: expected I and J" in wrong("G5 P0 Q-3 X1 Y1")
    assert "G5.1: expected I or J" in wrong("G5.1 X1 Y1")


@pytest.mark.parametrize(
    "spline",
    [
        "G5 X10 Y0 I0 J40 P0 Q40", "G5 X0 Y0 I40 J40 P-40 Q40", "G5.1 X10 Y0 I5 J40", "G2 X10 Y0 I5 J0",
        "G6.2 P3 K0 X0 Y0\nX5 Y40 K0\nX10 Y0 K0\nK1\nK1\nK1",
    ],
)  # fmt: skip
def test_curves_take_the_time_of_g93(spline: str) -> None:
    """PY-22: F of G93 is the inverse of the duration [1/min] of the whole curve, also where it ends as it begins."""
    path = parse_gcode("G21 G90 G93\n" + "\n".join(line + " F6" for line in spline.split("\n")))
    (velocity,) = {one.velocity for one in path.elements}
    assert velocity is not None
    assert path.length / velocity == pytest.approx(10, rel=1e-6)


QUARTER = math.sqrt(0.5)  # the weight in the middle of a quarter of a circle


@pytest.mark.parametrize(
    ("text", "plane"),
    [
        (f"G5.2 X10 Y10 P{QUARTER}\nX0 Y10 P1\nG5.3", (0, 1)),
        (f"G5.2 P1 L3\nX10 Y10 P{QUARTER}\nX0 Y10\nG5.3", (0, 1)),
        (f"G19\nG5.2 Y10 Z10 P{QUARTER}\nY0 Z10 P1\nG5.3", (1, 2)),
        (f"G6.2 X10 Y0 R1 K0 P3 Q1\nX10 Y10 R{QUARTER} K0\nX0 Y10 R1 K0\nG6.2 K2\nG6.2 K2\nG6.2 K2\nG1 X0", (0, 1)),
    ],
)
def test_a_quarter_of_a_circle_as_a_nurbs(text: str, plane: tuple[int, int]) -> None:
    """Rational and quadratic: exactly round (Piegl, Tiller, 7.3)."""
    start = [0.0, 0.0, 0.0]
    start[plane[0]] = 10.0
    path = parse_gcode("F60\n" + text, start=(start[0], start[1], start[2]), tolerance=1e-4)
    points = np.array([one.end for one in path.elements])
    assert np.hypot(points[:, plane[0]], points[:, plane[1]]) == pytest.approx(10)
    assert path.length == pytest.approx(5 * math.pi, rel=1e-4)
    assert points[-1][list(plane)] == pytest.approx([0, 10])


def test_a_nurbs_of_weight_one_is_a_bezier() -> None:
    nurbs = parse_gcode("G5.2 X0 Y3 P1 L4\nX1 Y-2\nX1 Y1\nG5.3", tolerance=1e-5)
    bezier = parse_gcode("G5 I0 J3 P0 Q-3 X1 Y1", tolerance=1e-5)
    assert nurbs.length == pytest.approx(bezier.length, rel=1e-5)
    assert bezier.follow(np.array([(0, 0, 0), *(one.end for one in nurbs.elements)])).distance.max() < 2e-5


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G5.3", "G5.3 has no G5.2 before it"),
        ("G5.2 X1 Y1\nG5.3", "a NURBS of order 3: expected as many control points at least, found 2"),
        ("G5.2 X1 Y1 L2", "the order of a NURBS: expected a whole number from 3 to 20, found 2"),
        ("G5.2 X1", "G5.2: expected X and Y of a control point"),
        ("G5.2 X1 Y1 Z1", "G5.2: expected X and Y of a control point"),
        ("G5.2 X1 Y1 P0", "the weight of a control point: expected a number above 0, found 0"),
        ("G5.2 X1 Y1\nG1 X5", "G1: the NURBS before it is not complete"),
        ("G5.2 X1 Y1\nM2", "the program ends within a NURBS"),
        ("G6.2 X1 Y1 K0", "G6.2: expected P, the order of the NURBS"),
        ("G6.2 X1 Y1 K1 P3\nX2 Y2 K0", "K: expected a knot from 1 on, found 0"),
    ],
)
def test_nurbs_that_are_none(text: str, said: str) -> None:
    assert said in wrong(text)


@pytest.mark.parametrize(
    ("text", "heights"),
    [
        ("G0 Z5\nG98 G81 X1 Z-2 R1 F60\nX2\nG80", [5, 5, 1, -2, 5, 5, 1, -2, 5]),
        ("G0 Z5\nG99 G81 X1 Z-2 R1 F60\nX2\nG80", [5, 5, 1, -2, 1, 1, -2, 1]),
        ("G81 X1 Z-2 R3 F60", [3, 3, -2, 3]),
        ("G0 Z5\nG91 G81 X1 Z-3 R-4 L2 F60", [5, 5, 1, -2, 5, 5, 1, -2, 5]),
        ("G0 Z5\nG83 X1 Z-2 R1 Q2 F60", [5, 5, 1, -1, 1, -0.746, -2, 5]),
        ("G0 Z5\nG73 X1 Z-2 R1 Q2 F60", [5, 5, 1, -1, -0.746, -2, 5]),
        ("G0 Z5\nG85 X1 Z-2 R1 F60", [5, 5, 1, -2, 1, 5]),
        ("G0 Z5\nG82 X1 Z-2 R1 P0.5 F60", [5, 5, 1, -2, 5]),
    ],
)
def test_drilling(text: str, heights: list[float]) -> None:
    assert [one.end[2] for one in parse_gcode(text).elements] == pytest.approx(heights)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G81 X1 R1", "G81: expected Z, the depth, and R"),
        ("G81 X1 Z2 R1", "G81: R lies 1 mm below the bottom of the hole"),
        ("G83 X1 Z-1 R1", "G83: expected Q"),
        ("G83 X1 Z-1 R1 Q0.0000001", "more than 100,000 pecks"),
        ("G81 X1 Z-1 R1 L0", "L: expected a whole number of repeats from 1"),
        ("G84 X1 Z-1 R1", "G84 is not read: it follows a spindle"),
        ("G81 X1 Z-1 R1 K3", "K is not read with G81 in the dialect rs274; L is the number of repeats"),
        ("G81 X1 Z-1 R1\nX2 I3", "p.nc:2: I is not read with G81 in the dialect rs274 (--leave-out I leaves it out)"),
    ],
)
def test_drilling_that_is_refused(text: str, said: str) -> None:
    assert said in wrong(text)


def test_repeats_of_holes() -> None:
    """PY-22: L in all dialects, K in that of Fanuc; a hole each, one beside the other."""
    for text, dialect in (("L3", "linuxcnc"), ("K3", "fanuc"), ("L3", "fanuc")):
        x = along_x("G0 Z5\nG91 G81 X10 Z-3 R-4 F60 " + text, dialect=dialect)
        assert sorted(set(x)) == [0, 10, 20, 30]
    assert "K and L exclude each other" in wrong("G91 G81 X10 Z-3 R1 F60 K3 L3", dialect="fanuc")
    assert parse_gcode("G82 X1 Z-2 R3 P0.5 F60\nX2").left_out == ("P of G82 (1 time)",)


WORDS_OF_MOVES = ["G0", "G1", "G2 I1", "G3 R9", "G5 I1 J1 P1 Q1", "G5.1 I1 J1", "G73 Z-1 R1 Q1", "G81 Z-1 R1"]
WORDS_OF_MOVES += [
    "G82 Z-1 R1",
    "G83 Z-1 R1 Q1",
    "G85 Z-1 R1",
    "G89 Z-1 R1",
    "G53 G0",
    "G10 L2 P1",
    "G52",
    "G92",
    "G28",
]


@pytest.mark.parametrize("code", WORDS_OF_MOVES)
def test_no_word_of_a_move_is_dropped_unsaid(code: str) -> None:
    """PY-22: it changes the path or what follows, or is listed, or refused with the line."""

    def outcome(word: str, dialect: str) -> object:
        text = f"G21 G90 G17 G94 F600\nG0 X0 Y0 Z5\n{code} X2 {word}\nG1 X9 Y7 Z1"
        path = path_or_sentence(text, Options(dialect=dialect, offsets={"G54": (3, 3, 3)}))
        return path if isinstance(path, str) else (path.elements, path.left_out)

    for dialect in DIALECTS:
        plain = outcome("", dialect)
        for letter in "ABCDEFHIJKLPQRSTUVWYZ":
            if letter in code or (dialect == "marlin" and code.startswith("G10")):  # there it retracts filament
                continue
            found = outcome(f"{letter}2", dialect)
            assert found != plain, f"{code} {letter}2 in {dialect}"
            if isinstance(found, str) and not isinstance(plain, str):
                assert ":3: " in found


# --- Limits ---


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G2 X0 Y0 Z1 I5 P1000000000", "more than 1,000,000 elements"),
        ("G1 X1e+30", "expected numbers up to 1e+08 mm"),
        ("G1 X" + "9" * 300, "expected numbers up to 1e+08 mm"),
        ("G3 X1 R" + "9" * 100, "expected numbers up to 1e+08 mm"),
        ("#1=0\no1 while [1]\n#1=[#1+1]\no1 endwhile", "a loop does not end"),
        ("o1 repeat [1e9]\nG91 G1 X[1e3] F60\no1 endrepeat", "G-code:2"),
        ("G2 I5 P" + "9" * 305, "more than 1,000,000 elements"),
    ],
)
def test_limits(text: str, said: str) -> None:
    begin = time.process_time()
    assert said in wrong(text).replace("p.nc", "G-code")
    assert time.process_time() - begin < 30


@pytest.mark.parametrize("text", ["G1 X{:.4f} Y{:.4f} E{:.3f}\n", "N{2:.0f} X{0:.4f} Y{1:.4f} (c)\n"])
def test_a_hundred_thousand_lines_in_three_seconds(text: str) -> None:
    lines = [text.format(100 * math.cos(i / 50), 100 * math.sin(i / 50), i) for i in range(100_000)]
    begin = time.process_time()
    path = parse_gcode("G1 F600\n" + "".join(lines))
    assert time.process_time() - begin < 3 * 4  # machines of tests are slower than people's
    assert len(path.elements) == 100_000


TOKENS = (
    "G0 G1 G2 G3 G5 G5.1 G17 G18 G20 G21 G28 G53 G54 G55 G81 G83 G90 G91 G92 G10 G93 G94 G4 G41 G80 M2 M98 M99 M70 M72 "
    "M73 M205 M3 X Y Z I J K R P Q L F E S 1 10 -5 2.5 1e-5 1E3 #1 #<a> #5420 [1+2] = [ ] / * ** sin[30] o100 o<x> sub "
    "endsub call while endwhile if else endif repeat do break ( ; % @ ^ $ 999999999999 0 . -"
).split() + ["\n"] * 12 + ["o1 while [#1 lt 5]\n", "o1 endwhile\n", "G2 X1 Y1 I1\n", "#1=[#1+1]\n"]  # fmt: skip


@given(st.lists(st.sampled_from(TOKENS), max_size=40), st.sampled_from([None, *DIALECTS]), st.booleans())
def test_property_any_text_is_a_path_or_a_sentence(tokens: list[str], dialect: str | None, offset: bool) -> None:
    options = Options(dialect=dialect, offsets={"G54": (1, 2, 3), "G55": (0, 0, 0)} if offset else {})
    found = path_or_sentence(" ".join(tokens), options)
    if isinstance(found, Toolpath):
        assert math.isfinite(found._checked("it").length)
        assert np.all(np.isfinite(found.extents))
    else:
        assert found.startswith("G-code")


@given(st.binary(max_size=60))
def test_property_any_file_is_a_path_or_a_sentence(data: bytes) -> None:
    with tempfile.NamedTemporaryFile(suffix=".nc") as file:
        file.write(data)
        file.flush()
        try:
            found = read_gcode(file.name)
        except ToolpathError as error:
            found = None
            said = str(error)
        assert found is not None or said.startswith(file.name)


# --- The command ---


def test_options_of_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.ngc").write_text("G54 G1 X1 F60\nG41 D1 X2 A5\nG55 X#<_there>\n/X9\n")
    options = ["--leave-out", "G41,A", "--offset", "G54", "0", "0", "0", "--offset", "G55", "5", "0", "0"]
    options += ["--set", "_there=4", "--delete-blocks", "--subroutines", "."]
    assert main(["path", "a.ngc", *options]) == 0
    text = capsys.readouterr().out
    assert "a.ngc: 3 lines and 0 arcs, 9 mm" in text
    assert "read as: linuxcnc ('G55 X#<_there>' in line 3)" in text
    assert "left out: G41 (1 time)\n" in text
    assert "left out: A (1 time)\n" in text
    for wrong_options, said in (
        (["--offset", "G5", "0", "0", "0"], "offsets: expected one of G54, G55"),
        (["--offset", "G54", "a", "0", "0"], "--offset G54: expected three numbers of mm, found a 0 0"),
        (["--set", "a"], "--set: expected NAME=NUMBER, found 'a'"),
        (["--dialect", "heidenhain"], "'heidenhain' is not one of"),
    ):
        assert main(["path", "a.ngc", *wrong_options]) == 2
        assert said in capsys.readouterr().err
    Path("a.svg").write_text("<svg/>")
    assert main(["path", "a.svg", "--leave-out", "M7"]) == 2
    assert "options of G-code do not hold for .svg" in capsys.readouterr().err
