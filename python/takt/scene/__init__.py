"""The machine in three dimensions: one description, made from the machine file, that the live page and reports draw."""

from takt.scene.making import make_scene
from takt.scene.moving import link_poses, matrix_of, node_pose, rounded_poses

__all__ = ["link_poses", "make_scene", "matrix_of", "node_pose", "rounded_poses"]
