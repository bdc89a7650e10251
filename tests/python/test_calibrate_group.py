"""GR-46: product coordinate systems set at run time from measured places of the tool."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import new_url, running
from portals import PORTAL, portal
from takt.calibrate import CalibrationError
from takt.kinematics import pose_to_matrix

POSE = (120.0, -40.0, 25.0, 4.0, -7.0, 33.0)
CORNERS = np.array([[0, 0, 0], [200, 0, 0], [0, 150, 0], [180, 140, 30]], dtype=float)


@pytest.fixture
def gantry() -> Iterator[takt.Group]:
    with portal() as (_, group):
        yield group


def placed(points: np.ndarray) -> np.ndarray:
    """Where points of the frame POSE lie in the machine coordinate system."""
    matrix = np.asarray(pose_to_matrix(POSE))
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def test_three_points_that_the_tool_went_to(gantry: takt.Group) -> None:
    """A point on X and one towards Y, as the tool is measured there."""
    wanted = (30.0, 20.0, 0.0, 0.0, 0.0, 30.0)
    matrix = np.asarray(pose_to_matrix(wanted))
    measured = []
    for point in ([0, 0, 0], [80, 0, 0], [30, 60, 0]):
        x, y, z = matrix[:3, :3] @ point + matrix[:3, 3]
        gantry.move_linear_absolute(x=x, y=y, z=z).wait()
        gantry.session.run(0.1)
        measured.append(gantry.actual_pose)
    made = gantry.calibrate_product_system(4, measured)
    assert gantry.product_system(4) == pytest.approx(wanted, abs=0.01)
    assert made.pose == pytest.approx(gantry.product_system(4))
    assert made.largest == 0
    gantry.move_linear_absolute(x=10, y=5, coordinate_system="pcs", pcs=4).wait()
    assert (gantry.x, gantry.y) == pytest.approx(tuple((matrix @ [10, 5, 0, 1])[:2]), abs=0.02)


def test_a_fourth_point_is_the_origin(gantry: takt.Group) -> None:
    measured = placed(np.array([[50, 50, 0], [90, 50, 0], [60, 90, 0], [0, 0, 0]], dtype=float))
    made = gantry.calibrate_product_system(16, measured)
    assert made.pose == pytest.approx(POSE)
    assert gantry.product_system(16) == pytest.approx(POSE)


def test_seen_points_leave_residuals(gantry: takt.Group) -> None:
    measured = placed(CORNERS)
    measured[3] += [0, 0, 0.8]
    made = gantry.calibrate_product_system(1, measured, seen=CORNERS)
    assert made.residuals.shape == (4,)
    assert 0.05 < made.largest < 0.8
    with pytest.raises(CalibrationError, match=r"is 0\.\d+ mm from where the frame has it, expected up to 0\.01 mm"):
        gantry.calibrate_product_system(2, measured, seen=CORNERS, largest_residual=0.01)
    assert gantry.product_system(2) == (0, 0, 0, 0, 0, 0)
    gantry.calibrate_product_system(2, measured, seen=CORNERS, largest_residual=1.0)
    assert gantry.product_system(2) == gantry.product_system(1)


@pytest.mark.parametrize(
    ("measured", "seen", "sentence"),
    [
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], None, "must not lie on one line"),
        ([[0, 0, 0], [10, 0, 0], [20, 0, 0.01], [5, 5, 5]], None, "must not lie on one line"),
        ([[0, 0, 0], [0, 0, 0], [0, 9, 0]], None, "measure one further away"),
        ([[0, 0, 0], [1, 0, 0]], None, "expected three or four without seen ones, found 2"),
        ([[0, 0, 0]] * 5, None, "expected three or four without seen ones, found 5"),
        ([[0, 0, 0], [10, 0, 0], [float("nan"), 9, 0]], None, "is not finite"),
        ([[0, 0, 0], [10, 0, 0], [1e300, 9, 0]], None, "lies beyond"),
        ([[0, 0], [1, 0], [0, 1]], None, "expected x, y, z in each row"),
        ([[0, 0, 0], [1, 0], "x"], None, "expected rows of three numbers"),
        ([[0, 0, 0], [9, 0, 0], [18, 0, 0], [27, 0, 0]], CORNERS, "of one line"),
        (CORNERS, CORNERS[:3], "expected as many of both"),
    ],
)
def test_points_that_define_no_frame(gantry: takt.Group, measured: object, seen: object, sentence: str) -> None:
    with pytest.raises(CalibrationError, match=sentence):
        gantry.calibrate_product_system(3, measured, seen=seen)  # type: ignore[arg-type]
    assert gantry.product_system(3) == (0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize("pcs", [0, 17, -1])
def test_only_product_systems_that_there_are(gantry: takt.Group, pcs: int) -> None:
    with pytest.raises(takt.TaktError, match=f"product coordinate systems 1 to 16, found {pcs}"):
        gantry.calibrate_product_system(pcs, CORNERS[:3])


def places(points: np.ndarray, prefix: str = "") -> dict[str, float]:
    return {
        f"{prefix}{axis}{i + 1}": float(v) for i, row in enumerate(points) for axis, v in zip("xyz", row, strict=True)
    }


def test_the_command_has_the_same_frames(gantry: takt.Group) -> None:
    """GR-46: three places, four of which the last is the origin, and seen ones with residuals."""
    rnd = np.random.default_rng(46)
    for i in range(40):
        seen = rnd.uniform(-300, 300, (4 if i % 2 else 3, 3))
        measured = placed(seen) + rnd.normal(0, 0.2, seen.shape)
        made = gantry.calibrate(pcs=7, **places(measured), **places(seen, "seen_")).wait()
        wanted = takt.calibrate.fit(seen, measured)
        assert made.value == pytest.approx(wanted.largest, abs=1e-9)
        assert np.allclose(pose_to_matrix(gantry.product_system(7)), pose_to_matrix(wanted.pose), atol=1e-9)
        gantry.calibrate(pcs=8, **places(measured)).wait()
        at = measured[3] if len(measured) == 4 else None
        wanted = takt.calibrate.three_points(*measured[:3], at=at)
        assert np.allclose(pose_to_matrix(gantry.product_system(8)), pose_to_matrix(wanted.pose), atol=1e-9)


def test_the_command_refuses_what_defines_no_frame(gantry: takt.Group) -> None:
    """GR-46: places on one line, in both ways to give them, and residuals."""
    line = np.array([[0, 0, 0], [10, 0, 0], [20, 0, 0.05]], dtype=float)
    corners = CORNERS[:3]
    for given in (places(line), places(line) | places(corners, "seen_"), places(corners) | places(line, "seen_"),
                  places(corners * 0)):  # fmt: skip
        assert gantry.calibrate(pcs=3, **given).wait_final().error_id == 3140
    measured = placed(corners) + np.array([[0, 0, 0], [2, 0, 0], [0, 0, 0]])
    bad = gantry.calibrate(pcs=3, largest_residual=0.1, **places(measured), **places(corners, "seen_")).wait_final()
    assert bad.error_id == 3141
    assert bad.value > 0.1
    assert gantry.product_system(3) == (0, 0, 0, 0, 0, 0)


def test_what_is_under_way_keeps_its_frame(gantry: takt.Group) -> None:
    """GR-46: a move and a jog in the product coordinate system; the next one uses the new frame."""
    gantry.calibrate(pcs=2, **places(np.array([[20, 0, 0], [30, 0, 0], [20, 10, 0]]))).wait()
    move = gantry.move_linear_absolute(x=60, coordinate_system="pcs", pcs=2)
    gantry.session.run(0.1)
    gantry.calibrate(pcs=2, **places(np.array([[0, 0, 0], [0, 10, 0], [-10, 0, 0]]))).wait()
    move.wait()
    assert gantry.x == pytest.approx(80)
    jog = gantry.jog(x=50, coordinate_system="pcs", pcs=2)
    gantry.session.run(0.1)
    gantry.set_cartesian_transform(pcs=2).wait()
    gantry.session.run(0.3)
    jog.release()
    assert gantry.x == pytest.approx(80)
    assert gantry.y > 5


def test_over_lcm(tmp_path: Path) -> None:
    url = new_url()
    with running(tmp_path, url, machine=PORTAL), takt.connect(url) as session:
        group = session.group("gantry")
        group.calibrate_product_system(5, placed(CORNERS[:3]))
        assert group.calibrate(pcs=6, **places(placed(CORNERS[:3]))).wait().value == 0
        session.wait(lambda: group.product_system(5)[0] != 0, 2.0, what="the frame")
        assert group.product_system(5) == pytest.approx(POSE)
