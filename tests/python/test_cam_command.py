"""The command `takt cam`: CAM-01 to CAM-04, CAM-24 as people meet them."""

from __future__ import annotations

from pathlib import Path

import pytest
from takt.cli import main
from test_cam import FEED, MACHINE


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "feed.yaml").write_text(FEED)
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "points.csv").write_text("x,y\n0,0\n90,10\n180,40\n360,0\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_cam_of_its_own(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-02, CAM-24: what is said, from closed forms: 50 mm over 120 deg under a modified sine."""
    assert main(["cam", "feed.yaml", "--master-speed", "360"]) == 0
    text = capsys.readouterr().out
    assert "feed: cyclic cam of 3 segments; x 0 to 360 deg, stroke 0 mm\n" in text
    assert "position, velocity and acceleration have no jump" in text
    assert "slave, with its master at up to 360 deg/s:" in text
    assert "0.733168" in text  # 50/120 · 4π/(4+π)
    assert "263.941" in text  # times 360


def test_limits_decide(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-24: exit code 1 and the word where the axis cannot; how fast it may go."""
    arguments = ["cam", "feed.yaml", "--machine", "machine.yaml", "--axis", "x"]
    assert main([*arguments, "--master-speed", "360"]) == 0
    text = capsys.readouterr().out
    assert "exceeded" not in text
    fastest = float(text.split("the master may go up to ")[1].split(" deg/s")[0])
    assert main([*arguments, "--master-speed", str(fastest * 1.01)]) == 1
    assert "exceeded" in capsys.readouterr().out
    assert main([*arguments, "--master-speed", "360", "--master-acceleration", "100000"]) == 1
    assert main(arguments) == 0
    assert main(["cam", "machine.yaml", "--name", "saw", "--axis", "x", "--master-speed", "1"]) == 1
    text = capsys.readouterr().out
    assert "warning: saw: points[1]: straight lines meet" in text
    assert "no velocity of the master suits the limits: the velocity jumps" in text


def test_pictures_and_files(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-04: from segments to points to YAML, drawn on the way."""
    arguments = ["cam", "feed.yaml", "--plot", "feed.png", "--csv", "feed.csv", "--count", "73", "--yaml", "again.yaml"]
    assert main([*arguments, "--master-speed", "300", "--axis", "x", "--machine", "machine.yaml"]) == 0
    assert "picture: feed.png\npoints: feed.csv\ncam: again.yaml\n" in capsys.readouterr().out
    assert (files / "feed.png").read_bytes().startswith(b"\x89PNG")
    assert main(["cam", "feed.csv", "--cyclic", "--units", "deg", "mm", "--plot", "points.svg"]) == 0
    assert "feed: cyclic cam of 73 points, quintic; x 0 to 360 deg" in capsys.readouterr().out
    assert main(["cam", "again.yaml"]) == 0
    assert main(["cam", "machine.yaml", "--name", "saw", "--plot", "saw.pdf", "--csv", "saw.csv"]) == 0
    assert (files / "saw.csv").read_text() == "x,y\n0.0,0.0\n180.0,30.0\n360.0,0.0\n"


def test_every_cam_of_a_machine(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cam", "machine.yaml"]) == 0
    text = capsys.readouterr().out
    assert text.index("saw: cam of 3 points, linear") < text.index("feed: cyclic cam of 2 segments")


def test_files_with_tabs(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-04: a machine file is told from a cam by its words, not by what is between them."""
    for text in (MACHINE.replace("name: m", "name:\tm", 1), "# a\u2028b\n" + MACHINE):
        (files / "machine.yaml").write_text(text, encoding="utf-8")
        assert main(["cam", "machine.yaml"]) == 0
        assert "saw: cam of 3 points, linear" in capsys.readouterr().out


def test_check_shows_warnings(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-03: takt check, too."""
    assert main(["check", "machine.yaml"]) == 0
    first, last = capsys.readouterr().out.splitlines()
    assert first.startswith("machine.yaml:8:")
    assert "warning: straight lines meet" in first
    assert last == "machine.yaml: ok"


BAD = [
    (["none.csv"], "none.csv: No such file or directory"),
    (["none.yaml"], "none.yaml: cannot be read: No such file or directory"),
    (["."], "."),
    (["points.csv", "--interpolation", "cubic"], "'cubic' is not one of"),
    (["points.csv", "--name", "a", "--csv", "no/out.csv"], "no/out.csv: there is no directory no"),
    (["points.csv", "--plot", "out.bmp"], "out.bmp: expected a name that ends in .png or .svg or .pdf"),
    (["points.csv", "--master-speed", "-1"], "--master-speed: expected a number of at least 0, found -1"),
    (["points.csv", "--master-speed", "nan"], "--master-speed: expected a number of at least 0, found nan"),
    (["points.csv", "--axis", "x"], "--axis needs --machine where FILE is a cam, as points.csv is"),
    (["feed.yaml", "--axis", "x"], "--axis needs --machine where FILE is a cam, as feed.yaml is"),
    (["points.csv", "--machine", "machine.yaml"], "say of which --axis"),
    (["points.csv", "--count", "5"], "--count is for --csv"),
    (["feed.yaml", "--csv", "out.csv"], "a cam of segments has no points: say how many"),
    (["feed.yaml", "--cyclic"], "--interpolation, --cyclic, --units and --columns are for files of points"),
    (["feed.yaml", "--axis", "z", "--machine", "machine.yaml"], "expected an axis of line, x, found 'z'"),
    (["machine.yaml", "--name", "sew"], "machine.yaml: expected a cam of saw, feed, found 'sew'"),
    (["machine.yaml", "--plot", "out.png"], "machine.yaml has the cams saw, feed: choose one with --name"),
]


@pytest.mark.parametrize(("arguments", "part"), BAD)
def test_bad_input(arguments: list[str], part: str, files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-03: one sentence, exit code 2, nothing written."""
    before = sorted(files.iterdir())
    assert main(["cam", *arguments]) == 2
    captured = capsys.readouterr()
    assert part in captured.err
    assert len(captured.err.splitlines()) == 1
    assert sorted(files.iterdir()) == before


def test_bad_cams(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-03: breaks, falling x, a machine without cams."""
    (files / "bad.csv").write_text("x,y\n0,0\n2,1\n1,2\n")
    assert main(["cam", "bad.csv"]) == 2
    assert capsys.readouterr().err == "bad.csv:4:1: expected x above 2 of the point before, found 1\n"
    (files / "bad.yaml").write_text(FEED.replace("law: dwell", "law: line").replace("180, y: 50", "180, y: 51"))
    assert main(["cam", "bad.yaml"]) == 2
    error = capsys.readouterr().err.splitlines()
    assert error[0].startswith("bad.yaml:7:")
    assert error[0].endswith("expected the velocity of the segment before, 0 at x 120, found 0.0166666667")
    (files / "none.yaml").write_text(MACHINE.split("cams:")[0])
    assert main(["cam", "none.yaml"]) == 2
    assert capsys.readouterr().err == "takt: none.yaml: expected a cam, found a machine without cams\n"


def test_files_of_other_systems(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """CAM-92: read with the columns that are named, written as a machine file has it."""
    (files / "export.txt").write_text("Nr\tWeg\tWinkel\n1\t0,0\t0,0\n2\t12,5\t120,25\n3\t0,0\t360,0\n")
    assert main(["cam", "export.txt", "--columns", "winkel", "2", "--cyclic", "--yaml", "out.yaml"]) == 0
    assert "export: cyclic cam of 3 points, quintic; x 0 to 360 u" in capsys.readouterr().out
    assert main(["cam", "out.yaml"]) == 0
    assert "export: cyclic cam of 3 points, quintic; x 0 to 360 u" in capsys.readouterr().out
    assert main(["cam", "export.txt"]) == 2
    assert "found 'Nr', 'Weg', 'Winkel': say which with columns" in capsys.readouterr().err
