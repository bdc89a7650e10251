"""Cams read back from an engine over LCM (CAM-88)."""

from __future__ import annotations

import json
from collections import OrderedDict
from typing import TYPE_CHECKING, Any

from takt import msgs
from takt.cam import Table
from takt.errors import ConnectionError, TaktError

if TYPE_CHECKING:
    from takt.remote import RemoteSession

HELD = 64  # received pieces kept at most
WAIT_S = 0.5  # for a piece, once the engine has confirmed the request
TRIES = 5  # requests of a piece that is not received
REFUSED = 3113

Piece = tuple[str, int, int]  # name of the cam, cycle, first


class RemoteCams:
    """Reads cams piece by piece; pieces are received on the receiver thread."""

    def __init__(self, session: RemoteSession) -> None:
        self._session = session
        self._pieces: OrderedDict[Piece, msgs.cam_piece] = OrderedDict()

    def take(self, message: msgs.cam_piece) -> None:
        self._pieces[message.name, message.cycle, message.first] = message
        while len(self._pieces) > HELD:
            self._pieces.popitem(last=False)

    def number_of(self, name: str) -> int:
        """Returns the number of the cam with this name; 0 if the engine has none."""
        piece = self._piece({"cam": name}, 0)
        return 0 if piece is None else int(piece.number)

    def table(self, number: int) -> Table:
        """Returns the cam with this number. Raises TaktError if the engine has no such cam (any more) or refuses
        read_cam, ConnectionError if a piece was not received."""
        first = self._piece({"number": number}, 0)
        if first is None:
            raise TaktError(f"the engine has no cam of number {number} any more")
        cam: dict[str, Any] = json.loads(first.text)
        count = first.count
        while count < first.total:
            more = self._piece({"number": number}, count)
            if more is None:
                raise TaktError(f"the engine has deleted cam number {number} while it was read")
            if more.count < 1:
                raise TaktError(
                    f"cam number {number}: the piece from {count} on is empty, expected {first.total} in all"
                )
            for key, items in json.loads(more.text).items():
                if key in ("points", "segments"):
                    cam.setdefault(key, []).extend(items)
            count += more.count
        return Table.from_dict(cam)

    def _piece(self, which: dict[str, Any], first: int) -> msgs.cam_piece | None:
        """Returns the piece that begins with point or segment `first`; None if the engine has no such cam."""
        for _ in range(TRIES):
            feedback = self._session.command("machine", "read_cam", {**which, "first": first}).wait_final()
            if feedback.error_id == REFUSED:
                return None
            if feedback.error:
                raise TaktError(f"read_cam: {feedback.sentence}")
            wanted = (which, feedback.cycle, first)
            self._session._await(lambda wanted=wanted: self._found(*wanted) is not None, WAIT_S)  # type: ignore[misc]
            piece = self._found(*wanted)
            if piece is not None:
                return piece
        raise ConnectionError(
            f"cam {next(iter(which.values()))}: asked {TRIES} times for its piece from {first} on, none came"
        )

    def _found(self, which: dict[str, Any], cycle: int, first: int) -> msgs.cam_piece | None:
        for piece in list(self._pieces.values()):
            mine = piece.number == which["number"] if "number" in which else piece.name == which["cam"]
            if mine and piece.cycle == cycle and piece.first == first:
                return piece
        return None
