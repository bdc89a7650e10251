"""Every figure that is promised has a benchmark that measures it. Whether it is good enough is read off by people:
nothing here depends on how fast this machine is."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

BENCH = Path(os.environ.get("TAKT_BUILD_DIR", "build/release")) / "bench"

pytestmark = pytest.mark.skipif(not BENCH.is_dir(), reason="built without benchmarks")


def rows(program: str, only: str, into: Path) -> dict[str, dict[str, float]]:
    """The rows of a very short run."""
    out = into / f"{program}.json"
    options = [f"--benchmark_filter={only}", "--benchmark_min_time=0.001", "--benchmark_out_format=json"]
    subprocess.run([BENCH / program, f"--benchmark_out={out}", *options], check=True, capture_output=True, timeout=120)
    return {row["run_name"]: row for row in json.loads(out.read_text())["benchmarks"]}


def test_one_axis_in_each_state(tmp_path: Path) -> None:
    """AX-90: the cost of an axis by state and number of axes, Ruckig in the same run."""
    found = rows("bench_axis", ".", tmp_path)
    for state in ("MoveStandstill/takt", "MoveMoving/takt", "MoveGeared/takt", "MoveMoving/ruckig"):
        for axes in (1, 100, 1000):
            assert found[f"{state}/{axes}"]["per_axis"] > 0
    planning = rows("bench_trajectory", "Plan", tmp_path)
    for plan in ("PlanFromRest", "PlanFromMotion", "PlanToVelocity"):
        assert {f"{plan}/takt", f"{plan}/ruckig"} <= planning.keys()


def test_whole_cycles_by_number_of_axes(tmp_path: Path) -> None:
    """AX-91, AX-01: cycles with position loop and servo; what grows with the axes grows with nothing else."""
    found = rows("bench_engine", "CycleMovingLoop", tmp_path)
    assert {f"CycleMovingLoop/{axes}" for axes in (1, 6, 64, 100, 1000)} <= found.keys()
    assert found["CycleMovingLoop/1000"]["cpu_time"] > found["CycleMovingLoop/1"]["cpu_time"]


def test_tags_by_length_of_message(tmp_path: Path) -> None:
    """EN-31: what a tag costs to make, to check and to refuse."""
    found = rows("bench_lcm", "Tag", tmp_path)
    assert {f"Tag{kind}/{size}" for kind in ("Sign", "Open", "Refuse") for size in (60, 200, 10_000)} <= found.keys()


def test_cams_by_number_of_points(tmp_path: Path) -> None:
    """CAM-04, CAM-60: a look-up by the number of points, beside a cubic polynomial as the floor."""
    found = rows("bench_cam", "Cam(Walk|Floor)", tmp_path)
    assert {f"CamWalk/{kind}/{n}" for kind in ("quintic", "linear") for n in (10, 100, 1000, 100_000)} <= found.keys()
    assert {"CamWalk/modified_sine", "CamFloor/cubic_polynomial"} <= found.keys()


def test_a_cam_module_with_everything_on(tmp_path: Path) -> None:
    """CAM-60: module and slave, coupled alone and with all ramps, filter, sequence and extreme values."""
    found = rows("bench_flexcam", ".", tmp_path)
    assert {f"FlexCamCoupled/{points}" for points in (10, 10_000)} <= found.keys()
    for points in (10, 10_000):
        row = found[f"FlexCamWithEverything/{points}/manual_time"]
        assert 0 < row["p99.9_ns"] <= row["max_ns"]


def test_belts_full_of_objects(tmp_path: Path) -> None:
    """CV-30."""
    found = rows("bench_conveyor", ".", tmp_path)
    assert {f"Belts/{kind}/16" for kind in ("set_value", "actual_value", "tables")} <= found.keys()
    assert 0 < found["BeltsAndDelta/16/manual_time"]["p98_ns"] <= found["BeltsAndDelta/16/manual_time"]["largest_ns"]


def test_a_pick_and_place_module_between_two_full_belts(tmp_path: Path) -> None:
    """PP-50: module, belts and group, picking and with nothing in reach; beside the group alone on the same way."""
    found = rows("bench_pickplace", ".", tmp_path)
    names = ("PickAndPlace/busy", "PickAndPlace/none_reachable", "GroupAlone")
    busy, waiting, alone = (found[f"{name}/iterations:20000/manual_time"] for name in names)
    assert busy["picked"] >= 5
    assert waiting["picked"] == 0
    for row in (busy, waiting, alone):
        assert 0 < row["p98_ns"] <= row["p99.9_ns"] <= row["largest_ns"]
