"""The process that draws a twin (takt.twin.picture): `python render.py MODEL STATE PICTURE WIDTH HEIGHT`. It imports
nothing of takt, so that it starts quickly."""

from __future__ import annotations

import sys


def render(saved: str, state: str, file: str, width: int, height: int) -> None:
    import matplotlib.image
    import mujoco
    import numpy as np

    model = mujoco.MjModel.from_binary_path(saved)
    data = mujoco.MjData(model)
    data.qpos[:] = np.load(state)
    mujoco.mj_forward(model, data)
    places = [data.geom_xpos[i] for i in range(model.ngeom) if model.geom_rgba[i, 3] > 0]  # others are parked
    if not places:
        raise SystemExit("the model has no shape that can be seen")
    middle = (np.min(places, axis=0) + np.max(places, axis=0)) / 2
    extent = float(np.max(np.ptp(places, axis=0))) + 0.3
    camera = mujoco.MjvCamera()
    camera.lookat[:] = middle
    camera.distance, camera.azimuth, camera.elevation = 1.7 * extent, 125, -18
    # The frame buffer of a model from a file may be smaller.
    frame = model.vis.global_
    frame.offwidth, frame.offheight = max(frame.offwidth, width), max(frame.offheight, height)
    renderer = mujoco.Renderer(model, height, width)
    try:
        renderer.update_scene(data, camera)
        picture = renderer.render()
    finally:
        renderer.close()
    if not np.ptp(picture):
        raise SystemExit("the driver drew nothing")
    matplotlib.image.imsave(file, picture)


if __name__ == "__main__":
    _, model, state, picture, width, height = sys.argv
    render(model, state, picture, int(width), int(height))
