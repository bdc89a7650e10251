"""One cam module of a session: a slave axis that follows a master through cams."""

from __future__ import annotations

from takt._commands import FlexCamCommands, FlexCamOutputs
from takt.axis import Axis
from takt.component import Component


class FlexCam(Component, FlexCamCommands, FlexCamOutputs):
    """A cam module."""

    KIND = "flex_cam"

    def __repr__(self) -> str:
        return f"<FlexCam {self.name}: {self.state.value}, cam {self.cam_table} at x = {self.set_x_position:.6g}>"

    @property
    def slave(self) -> Axis:
        """The axis that it moves."""
        return self.session.axis(self.parameters["slave"])

    @property
    def master(self) -> Component | None:
        """The axis or other component that it follows; None: a virtual one."""
        name = self.parameters.get("master")
        return None if name is None else self.session.components[name]
