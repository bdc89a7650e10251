"""Pictures of a twin, without a screen: MuJoCo's renderer in a process of its own, since a driver that cannot draw may
end its process. `python -m takt.twin.picture MODEL STATE PICTURE` is that process."""

from __future__ import annotations

import os
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

DRIVERS = ("egl", "osmesa")  # that need no screen
SIZE = (960, 640)
WAIT_S = 60.0


def draw(model: Model, frame: Frame, file: Path) -> Path:
    """Draws a state as PNG. Raises PlantError with the reason where no driver here can."""
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
            command = [sys.executable, "-m", "takt.twin.picture", str(saved), str(state), str(file)]
            try:
                ended = subprocess.run(
                    command, env={**os.environ, "MUJOCO_GL": driver}, capture_output=True, text=True, timeout=WAIT_S
                )
            except subprocess.TimeoutExpired:
                reasons.append(f"{driver}: no picture within {WAIT_S:g} s")
                continue
            if ended.returncode == 0 and file.is_file():
                return file
            lines = [line for line in ended.stderr.splitlines() if line.strip()]
            reasons.append(f"{driver}: {lines[-1].strip() if lines else f'ended with {ended.returncode}'}")
    raise PlantError(f"no picture: {'; '.join(reasons)}")


def _render(saved: str, state: str, file: str) -> None:
    import matplotlib.image
    import mujoco

    model = mujoco.MjModel.from_binary_path(saved)
    data = mujoco.MjData(model)
    data.qpos[:] = np.load(state)
    mujoco.mj_forward(model, data)
    spheres = [data.geom_xpos[i] for i in range(model.ngeom)]
    middle = (np.min(spheres, axis=0) + np.max(spheres, axis=0)) / 2
    extent = float(np.max(np.ptp(spheres, axis=0))) + 0.3
    camera = mujoco.MjvCamera()
    camera.lookat[:] = middle
    camera.distance, camera.azimuth, camera.elevation = 1.7 * extent, 125, -18
    renderer = mujoco.Renderer(model, SIZE[1], SIZE[0])
    try:
        renderer.update_scene(data, camera)
        picture = renderer.render()
    finally:
        renderer.close()
    if not np.ptp(picture):
        raise SystemExit("the driver drew nothing")
    matplotlib.image.imsave(file, picture)


if __name__ == "__main__":
    _render(*sys.argv[1:])
