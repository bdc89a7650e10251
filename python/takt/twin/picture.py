"""Pictures of a twin, without a screen: MuJoCo's renderer in a process of its own (takt/twin/render.py), since a driver
that cannot draw may terminate its process."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from takt.plant import PlantError

if TYPE_CHECKING:
    from takt.twin.model import Model
    from takt.twin.plant import Frame

DRIVERS = ("egl", "osmesa")  # these need no screen
SIZE = (960, 640)  # pixels
RENDER = Path(__file__).with_name("render.py")
WAIT_S = 60.0
ERROR = re.compile(r"[\w.]+Error: ")


def draw(model: Model, frame: Frame, file: Path) -> Path:
    """Draws a state as PNG, and returns the path of the file. Raises PlantError, with the reasons, if no driver on this
    machine can draw, or the file is no .png. MUJOCO_GL selects a driver; else those of DRIVERS are tried."""
    import mujoco

    if file.suffix.lower() != ".png":
        raise PlantError(f"{file}: pictures of a twin are PNG")
    reasons = []
    with tempfile.TemporaryDirectory() as folder:
        saved, state = Path(folder) / "model.mjb", Path(folder) / "state.npy"
        mujoco.mj_saveModel(model.model, str(saved), None)
        np.save(state, frame.positions)
        given = os.environ.get("MUJOCO_GL")
        for driver in (given,) if given else DRIVERS:
            command = [sys.executable, "-P", str(RENDER), str(saved), str(state), str(file), *map(str, SIZE)]
            try:
                ended = subprocess.run(
                    command, env={**os.environ, "MUJOCO_GL": driver}, capture_output=True, text=True, timeout=WAIT_S
                )
            except subprocess.TimeoutExpired:
                reasons.append(f"{driver}: no picture within {WAIT_S:g} s")
                continue
            if ended.returncode == 0 and file.is_file():
                return file
            reasons.append(f"{driver}: {_reason(ended.stderr) or f'ended with {ended.returncode}'}")
    raise PlantError(f"no picture: {'; '.join(reasons)}")


def _reason(said: str) -> str:
    """Returns the last line with an exception from the output of a failed program; without one its last line."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    errors = [line for line in lines if ERROR.match(line)]
    return (errors or lines or [""])[-1]
