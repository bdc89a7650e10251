"""What reads files, with whole files of each kind and words that mean something in them, for fuzzing.py (EN-38)."""

from __future__ import annotations

import contextlib
import io
import struct
import subprocess
import tempfile
import warnings
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import takt
from every_kind import FULL, MINIMAL, text_of
from machines import taktd
from takt import calibration_files, cam, kinematics, lcmlog, toolpath, track_drawing
from takt.engine import read_machine
from takt.errors import TaktError

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Reader:
    """What reads a kind of file, whole ones to begin with, and words that mean something in them."""

    name: str
    suffix: str
    read: Callable[[Path], object]
    whole: Callable[[], Sequence[bytes]]
    words: tuple[bytes, ...]


# --- what reads ---


def check(file: Path) -> None:
    """As `takt check` does."""
    takt._core.check_machine(*read_machine(file))


def read_urdf(file: Path) -> None:
    kinematics.Kinematics(folder=file.parent, serial={"urdf": file.name})


MESH = """\
name: cell
axes:
  - {name: x, limits: {velocity: 100, acceleration: 1000, jerk: 10000}}
  - {name: y, limits: {velocity: 100, acceleration: 1000, jerk: 10000}}
  - {name: z, limits: {velocity: 100, acceleration: 1000, jerk: 10000}}
groups:
  - name: robot
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 100, acceleration: 1000, jerk: 10000}
    workspace:
      gripper: [{name: finger, sphere: {radius: 10}}]
      obstacles: [{name: wall, mesh: {file: FILE}}]
"""


def read_stl(file: Path) -> None:
    takt._core.check_machine(MESH.replace("FILE", file.name).encode(), str(file.parent / "machine.yaml"))


def read_path(file: Path) -> None:
    """As `takt path` does."""
    found = toolpath.read(file)
    if not np.all(np.isfinite(found.extents)):
        raise AssertionError(f"extents {found.extents}")


def read_drawing(file: Path) -> None:
    """As `takt track` does."""
    track_drawing.read_drawing(file)


def read_cam(file: Path) -> None:
    cam.Table.from_csv(file)


def read_points(file: Path) -> None:
    """As `takt calibrate` does."""
    for kind in ("frame", "belt"):
        with contextlib.suppress(TaktError):
            list(calibration_files.lines(kind, file))
    list(calibration_files.lines("frame", file))


def read_recording(file: Path) -> None:
    recording = takt.Recording.load(file)
    for name in recording.components:
        recording[name]


def read_log(file: Path) -> None:
    """As `takt log` and `takt report` do."""
    lcmlog.open_log(file)
    lcmlog.read_log(file)


# --- whole files ---


def machines() -> list[bytes]:
    files = sorted((ROOT / "python" / "examples").glob("*/machine.yaml"))
    texts = [file.read_bytes() for file in files if file.parent.name != "delta_cell"]  # which names a file
    return [*texts, text_of(FULL).encode()]


def robots() -> list[bytes]:
    return [(ROOT / "tests" / "cpp" / "kinematics" / f"{name}.urdf").read_bytes() for name in ("iiwa", "puma")]


def meshes() -> list[bytes]:
    corners = np.array([[0, 0, 0], [100, 0, 0], [0, 100, 0], [0, 0, 100]], float)
    faces = [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)]
    binary = bytes(80) + struct.pack("<I", len(faces))
    text = "solid corner\n"
    for face in faces:
        points = corners[list(face)]
        binary += struct.pack("<12fH", 0, 0, 1, *points.ravel(), 0)
        lines = "".join("vertex {:g} {:g} {:g}\n".format(*point) for point in points)
        text += f"facet normal 0 0 1\nouter loop\n{lines}endloop\nendfacet\n"
    return [binary, f"{text}endsolid corner\n".encode()]


SVG = """\
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
  width="100mm" height="80mm" viewBox="0 0 100 80">
<defs><g id="part"><path d="M0 0 C 10 0 10 10 20 10 S 30 20 40 0 Z"/></g>
<clipPath id="c"><rect width="500" height="400"/></clipPath></defs>
<style>.thin { stroke: black; fill: none }</style>
<g transform="translate(10,10) rotate(30)"><use xlink:href="#part" x="5"/>
<rect x="1" y="2" width="30" height="20" rx="4"/></g>
<circle class="thin" cx="50" cy="40" r="10"/><ellipse cx="20" cy="60" rx="12" ry="5"/>
<line x1="0" y1="0" x2="9" y2="9"/>
<polyline points="1,1 5,9 9,1"/><polygon points="50,50 60,50 55,60" clip-path="url(#c)"/>
<path d="M10,10 h5 v5 l-5,-5 q 3 4 5 0 t 5 0 a 10 5 30 0 1 20 10 A 4 4 0 1 0 9 9"/>
</svg>
"""


def drawings() -> list[bytes]:
    return [SVG.encode(), SVG.replace("<use", "<!-- -->\n<use").replace("mm", "in").encode()]


def dxf_drawings() -> list[bytes]:
    import ezdxf

    found = []
    for version in ("R12", "R2010"):
        document = ezdxf.new(version)  # type: ignore[attr-defined]
        model = document.modelspace()
        model.add_line((0, 0), (100, 0))
        model.add_arc((100, 10), 10, 270, 90)
        model.add_line((100, 20), (0, 20))
        model.add_arc((0, 10), 10, 90, 270)
        block = document.blocks.new("part")
        block.add_circle((0, 0), 5)
        model.add_blockref("part", (200, 0), dxfattribs={"xscale": 2.0, "yscale": 2.0, "rotation": 30})
        if version != "R12":
            model.add_lwpolyline([(300, 0, 0, 0, 0.5), (340, 0), (340, 40)], close=True)
            model.add_spline([(400, 0), (410, 10), (420, 0), (430, 10)])
            model.add_ellipse((500, 0), (20, 0), 0.5)
        text = io.StringIO()
        document.write(text)
        found.append(text.getvalue().encode())
    return found


GCODE = """\
%
(a part)
G21 G90 G17 G54
G0 X0 Y0 Z5
#1 = 3
o100 sub
G1 X[#1 * 2] Y10 F600
G2 X[#1 * 2 + 10] Y10 I5 J0
o100 endsub
o1 while [#1 lt 6]
G1 X#1 Y[sin[30] * 4]
#1 = [#1 + 1]
o1 endwhile
o100 call
o2 if [#1 eq 6]
G3 X0 Y0 R30
o2 endif
G5 I1 J2 P3 Q4 X30 Y5
G81 X5 Y5 Z-2 R2 F100
G80
M2
%
"""


def programs() -> list[bytes]:
    lines = (ROOT / "python" / "examples" / "delta_cell" / "drawing.gcode").read_text().splitlines()
    return [GCODE.encode(), ("\n".join(lines[:300]) + "\n").encode()]


def paths() -> list[bytes]:
    lines = (ROOT / "python" / "examples" / "delta_cell" / "drawing.csv").read_text().splitlines()
    return [("\n".join(lines[:200]) + "\n").encode()]


def cams() -> list[bytes]:
    rows = "".join(f"{x},{x * x / 100:.4f},{x / 50:.4f},0.02\n" for x in range(0, 101, 5))
    return [f"x,y,v,a\n{rows}".encode(), b"x,y\n0,0\n10.5,1\n20,2\n"]


def points() -> list[bytes]:
    return [
        b"x,y,z\n0,0,0\n100,0,0\n0,100,0\n",
        b"x,y,z,seen_x,seen_y,seen_z\n0,0,0,5,5,5\n100,0,0,105,5,5\n0,100,0,5,105,5\n9,9,9,14,14,14\n",
        b"position,x,y,z\n0,0,0,0\n100,100,0,0\n,50,50,0\n",
    ]


ONE_AXIS = """\
name: one
axes:
  - {name: x, limits: {velocity: 100, acceleration: 1000, jerk: 10000}}
"""


def recordings() -> list[bytes]:
    with takt.Engine(ONE_AXIS) as engine:
        record = engine.record()
        engine.axis("x").power().wait()
        engine.axis("x").move_absolute(position=1.0).wait()
        recording = record.stop()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "a.npz"
        recording.save(file)
        whole = file.read_bytes()
    return [whole]


def members() -> list[bytes]:
    """What is in a recording's archive, one after the other: so that what is changed is not the archive alone."""
    packed = b""
    with zipfile.ZipFile(io.BytesIO(recordings()[0])) as archive:
        for name in archive.namelist():
            data = archive.read(name)
            packed += struct.pack(">HI", len(name), len(data)) + name.encode() + data
    return [packed]


def read_members(file: Path) -> None:
    """Puts them into an archive, which is whole whatever they are."""
    packed, at = file.read_bytes(), 0
    with zipfile.ZipFile(file, "w") as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # two of one name
        while at + 6 <= len(packed):
            of_name, of_data = struct.unpack_from(">HI", packed, at)
            name, at = packed[at + 6 : at + 6 + of_name].decode("latin-1"), at + 6 + of_name
            archive.writestr(name.replace("\0", "") or "x", packed[at : at + of_data])
            at += of_data
    read_recording(file)


def logs() -> list[bytes]:
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for i, text in enumerate((ONE_AXIS, text_of(MINIMAL["pick_place"]))):
            machine, log = Path(folder) / f"{i}.yaml", Path(folder) / f"{i}.lcm"
            machine.write_text(text)
            command: list[str | Path] = [
                taktd(),
                machine,
                "--no-lcm",
                "--pace",
                "fast",
                "--duration",
                "0.05",
                "--log",
                log,
            ]
            subprocess.run(command, check=True, capture_output=True)
            found.append(log.read_bytes())
    return found


# --- words that mean something in them ---

NUMBERS = (
    b"nan inf -inf 1e308 -1e308 1e-320 0 -0 -1 1 2147483648 4294967295 -9223372036854775809 99999999999999999999 "
    b"0x10 1_000 1,5 .5 5. 1e 1e999999 0.1"
).split()
YAML = b"{ } [ ] : - , & * ! | > ' # ? ~ null true .nan .inf <<: &a *a !!python/object:os.system axes: tracks:".split()
XML = b"< > /> </ <!-- --> &amp; &#0; &x; <![CDATA[ ]]> \xff\xfe ' \"".split()
ENTITIES = b'<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
URDF = (b"<link name='a'/>", b"<joint", b'type="floating"', b'type="continuous"', b"rpy")
STL = (b"facet", b"vertex", b"endloop", b"solid", b"\xff\xff\xff\x7f")
SHAPES = (b'<use xlink:href="#part"/>', b"scale(1e9)", b"A 1 1 0 1 1", b"100%", b'd="', b"skewX(90)", b"M0 0L9 9", b"Z")
DXF = (b"  0\nINSERT\n", b"  2\npart\n", b" 70\n", b"SPLINE", b"EOF")
CODE = (b"o1 while [1]\n", b"o100 call\n", *b"G2 G5 P99999999 #1 [ ] ** L9999999 %".split(), b"G81 L9999999\n")
TABLE = (b",", b";", b'"', b"\r", b"\0", b"\xef\xbb\xbf", b"\xb5", b"x", b"circular", b"position")
ARRAYS = (b"'descr': '|O'", b"(999999999999,)", b"fortran_order", b"\x93NUMPY\x01\x00", b"PK\x03\x04", b"PK\x05\x06")
EVENTS = (b"\xed\xa1\xda\x01", b"\x7f\xff\xff\xff", b"\xff\xff\xff\xff", b"takt/axis/x", bytes(8))

READERS = {
    reader.name: reader
    for reader in (
        Reader("yaml", ".yaml", check, machines, (*NUMBERS, *YAML)),
        Reader("urdf", ".urdf", read_urdf, robots, (*NUMBERS, *XML, ENTITIES, *URDF)),
        Reader("stl", ".stl", read_stl, meshes, (*NUMBERS, *STL)),
        Reader("svg", ".svg", read_path, drawings, (*NUMBERS, *XML, ENTITIES, *SHAPES)),
        Reader("svg_track", ".svg", read_drawing, drawings, (*NUMBERS, *XML, ENTITIES, *SHAPES)),
        Reader("dxf", ".dxf", read_drawing, dxf_drawings, (*NUMBERS, *DXF)),
        Reader("gcode", ".ngc", read_path, programs, (*NUMBERS, *CODE)),
        Reader("csv", ".csv", read_path, paths, (*NUMBERS, *TABLE)),
        Reader("csv_cam", ".csv", read_cam, cams, (*NUMBERS, *TABLE)),
        Reader("csv_points", ".csv", read_points, points, (*NUMBERS, *TABLE)),
        Reader("npz", ".npz", read_recording, recordings, (*NUMBERS, *ARRAYS)),
        Reader("npz_members", ".npz", read_members, members, (*NUMBERS, *ARRAYS)),
        Reader("log", ".lcm", read_log, logs, (*NUMBERS, *EVENTS)),
    )
}
