"""One cam module of a session: a slave axis that follows a master through cams."""

from __future__ import annotations

from takt._commands import FlexCamCommands, FlexCamOutputs
from takt.axis import Axis
from takt.belt import Belt
from takt.component import Component
from takt.mover import Mover


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
    def master(self) -> Axis | Belt | Mover | None:
        """The axis, belt or mover that it follows; None: a virtual master."""
        name = self.parameters.get("master")
        if name is None:
            return None
        named: dict[str, Axis | Belt | Mover] = {**self.session.axes, **self.session.belts, **self.session.movers}
        return named[name] if name in named else named[name.rpartition(".")[0]]
