"""A twin of a machine in a physics engine that nobody here wrote: MuJoCo (PY-23).

with takt.Engine("machine.yaml", plant="mujoco") as session: ...

The section `twin` of the machine file says which axes it moves, with which motors and masses; the model is made from
the kinematics, or given as MJCF or URDF. MuJoCo is an extra: pip install takt-motion[twin].
"""

from takt.twin.cargo import Cargo, Gripper, Handled, ProductSeen
from takt.twin.judging import Judged, judge
from takt.twin.plant import ContactSeen, Frame, Twin

__all__ = ["Cargo", "ContactSeen", "Frame", "Gripper", "Handled", "Judged", "ProductSeen", "Twin", "judge"]
