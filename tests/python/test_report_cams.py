"""Cams in the page of a report."""

from __future__ import annotations

import numpy as np
import takt
from takt import report
from takt.report.scene import cams_of, machine_of

CAM_MACHINE = """\
name: press
axes:
  - {name: drum, unit: deg, kind: rotary, limits: {velocity: 1800, acceleration: 18000, jerk: 900000}}
  - {name: ram, unit: mm, limits: {velocity: 4000, acceleration: 200000, jerk: 20000000}}
cams:
  - name: flat
    x_unit: deg
    y_unit: mm
    cyclic: true
    segments: [{to: {x: 120, y: 12}, law: cycloid}, {to: {x: 360, y: 0}, law: cycloid}]
flex_cams:
  - {name: stamp, slave: ram, master: drum, cams: [flat, flat], settings: {slave_absolute: true, sync_mode: ramp_time}}
"""


def test_a_page_has_the_cams_that_ran_and_those_made_at_run_time() -> None:  # CAM-88
    with takt.Engine(CAM_MACHINE) as engine:
        drum, stamp = engine.axis("drum"), engine.flex_cam("stamp")
        drum.power().wait()
        stamp.control(regulator_on=True).wait()
        engine.wait(lambda: stamp.axis_enabled)
        recorder = engine.record()
        drum.move_velocity(velocity=360)
        stamp.control(sync_cam=True).wait()
        high = {"to": {"x": 200, "y": 20}, "law": "modified_sine"}, {"to": {"x": 360, "y": 0}, "law": "cycloid"}
        made = takt.cam.Table.from_segments(high, name="high", cyclic=True, x_unit="deg", y_unit="mm")
        stamp.load_cam(2, made).wait()
        stamp.control(cam_table=2).wait()
        engine.wait(lambda: stamp.cam_table == 2, 3.0)
        engine.run(0.4)
        recording = recorder.stop()
    told = cams_of(recording, machine_of(recording))
    assert told is not None
    assert [cam["name"] for cam in told["cams"]] == ["flat"]
    assert [(cam["number"], cam["name"]) for cam in told["made"]] == [(2, "high")]
    np.testing.assert_allclose(told["made"][0]["curves"][0], made.at(told["made"][0]["x"]).y, atol=1e-6)
    assert [module["name"] for module in told["modules"]] == ["stamp"]
    page = report.render(recording, [], "A press")
    assert 'id="cams-section"' in page
    assert '"name":"high"' in page
