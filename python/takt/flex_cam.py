"""One cam module of a session: a slave axis that follows a master through cams."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from takt._commands import FlexCamCommands, FlexCamOutputs
from takt.axis import Axis
from takt.belt import Belt
from takt.component import Component
from takt.errors import TaktError
from takt.mover import Mover

if TYPE_CHECKING:
    from takt.cam import Table
    from takt.feedback import Feedback


SLOTS = 4


class FlexCam(Component, FlexCamCommands, FlexCamOutputs):
    """A cam module."""

    KIND = "flex_cam"

    def __repr__(self) -> str:
        return f"<FlexCam {self.name}: {self.state.value}, cam {self.cam_table} at x = {self.set_x_position:.6g}>"

    def load_cam(self, slot: int, cam: Table | Mapping[str, Any], *, name: str | None = None) -> Feedback:
        """Makes a cam at run time and assigns it to a slot. Allowed while the module runs a cam of any slot; a running
        cam of this slot is replaced at its end. Lets engine time pass until the cam is built.

        slot: 1 to 4.
        cam, name: as in `Session.make_cam`.

        Returns the feedback of `set_cam`. Raises TaktError for other slots, takt.ConfigError if the cam has errors.
        """
        if slot not in range(1, SLOTS + 1):  # before the cam is made
            raise TaktError(f"{self.name}.load_cam: slot: expected 1 to {SLOTS}, found {slot!r}")
        self.session.make_cam(cam, name=name).wait()
        return self.set_cam(slot=slot, cam=name or (cam["name"] if isinstance(cam, Mapping) else cam.name))

    @property
    def cam_in_force(self) -> Table:
        """The running cam, made at run time or from the machine file: points, laws, extremes (CAM-71). The factors and
        offsets in force are `set_scaling_master`, `set_scaling_slave`, `set_offset_master` and `set_offset_slave`."""
        return self.session._cam(self.cam_number)

    @property
    def slave(self) -> Axis:
        """The slave axis."""
        return self.session.axis(self.parameters["slave"])

    @property
    def master(self) -> Axis | Belt | Mover | None:
        """The master axis, belt or mover; None: a virtual master."""
        name = self.parameters.get("master")
        if name is None:
            return None
        named: dict[str, Axis | Belt | Mover] = {**self.session.axes, **self.session.belts, **self.session.movers}
        return named[name] if name in named else named[name.rpartition(".")[0]]
