"""A twin of a machine in an independent physics engine, MuJoCo (PY-23).

with takt.Engine("machine.yaml", plant="mujoco") as session: ...

The section `twin` of the machine file lists the axes that the twin moves, with their motors and masses. The model is
generated from the kinematics, or read from an MJCF or URDF file. MuJoCo is an extra: pip install takt-motion[twin].
"""

from takt.twin.cargo import Cargo, Gripper, Handled, ProductSeen
from takt.twin.judging import Judged, judge
from takt.twin.plant import ContactSeen, Frame, Twin

__all__ = ["Cargo", "ContactSeen", "Frame", "Gripper", "Handled", "Judged", "ProductSeen", "Twin", "judge"]
