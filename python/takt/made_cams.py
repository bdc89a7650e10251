"""Cams made at run time (CAM-88): how they are sent to an engine, and which ones this session knows."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from takt._commands import MachineCommands
from takt.errors import ConfigError, TaktError
from takt.feedback import DEFAULT_TIMEOUT_S, Feedback

if TYPE_CHECKING:
    from takt.cam import Table
    from takt.session import Session

POINTS = 20  # in one command
SEGMENTS = 8
UNANSWERED = 128  # commands under way
KNOWN = 256  # cams whose data is kept; an engine holds 64
MOST_KEPT = 5_000  # points of a cam, in recordings
BUILDS = 2  # cams that an engine builds at a time


@dataclass
class MadeCam:
    """A cam that this session has given."""

    name: str
    table: Table
    feedback: Feedback  # its value is the number of the cam
    dropped: Feedback | None = None

    @property
    def found(self) -> bool:
        """Whether its name stands for it, unless a later one has it."""
        return self.feedback._done and not (self.dropped and self.dropped._done)

    @cached_property
    def named(self) -> Table:
        """The cam under the name it was sent with, as the engine has it."""
        from takt.cam import Table

        if self.table.name == self.name:
            return self.table
        return Table.from_dict({**self.table.source, "name": self.name})


class MadeCams:
    """The cams that a session has made."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._given: deque[Feedback] = deque()
        self.cams: list[MadeCam] = []

    def make(self, cam: Table | Mapping[str, Any], name: str | None) -> Feedback:
        from takt.cam import Table

        table = cam if isinstance(cam, Table) else Table.from_dict(cam)
        name = table.name if name is None else name
        if not name:
            raise ConfigError(["name: expected the name that commands call the cam by, found ''"])
        self._wait_for_fewer(
            BUILDS, "cams being built", lambda: [m.feedback for m in self.cams if not m.feedback._final]
        )
        for verb, arguments in _commands(table, name):
            self._give(verb, arguments)
        feedback = self._give("build_cam", {"cam": name, "count": _count(table)})
        self.cams = [made for made in self.cams if not made.feedback._final or made.feedback._done][1 - KNOWN :]
        self.cams.append(MadeCam(name, table, feedback))
        return feedback

    def drop(self, name: str, feedback: Feedback) -> None:
        for made in self.cams:
            if made.name == name and made.found:
                made.dropped = feedback

    @property
    def names(self) -> list[str]:
        """Of all cams that commands find, as far as this session knows."""
        names = [cam["name"] for cam in self._session.machine["cams"]]
        return list(dict.fromkeys(names + [made.name for made in self.cams if made.found]))

    def find(self, name: str) -> Table:
        """The cam that this name stands for, as far as this session knows."""
        for made in reversed(self.cams):
            if made.name == name and made.found:
                return made.named
        for number, cam in enumerate(self._session.machine["cams"], 1):
            if cam["name"] == name:
                return self._session._cam(number)
        raise TaktError(f"there is no cam '{name}' (there are {', '.join(self.names)})")

    def known(self, number: int) -> Table | None:
        """The cam with this number; None: it was made by another client."""
        from takt.cam import Table

        if 1 <= number <= len(self._session.machine["cams"]):
            return Table.from_dict(self._session.machine["cams"][number - 1])
        for made in self.cams:
            if made.feedback._done and made.feedback.value == number:
                return made.named
        return None

    def kept(self) -> dict[str, Any]:
        """What recordings keep of the cams made so far, by number; of the largest ones nothing."""
        made = [
            (made.feedback.value, made.named.source)
            for made in self.cams
            if made.feedback._done and is_kept(made.table)
        ]
        return {"made_cams": made} if made else {}

    def _give(self, verb: str, arguments: Mapping[str, Any]) -> Feedback:
        self._wait_for_fewer(UNANSWERED, "pieces of cams unanswered", lambda: self._given)
        feedback = self._session.command("machine", verb, arguments)
        if verb != "build_cam":
            feedback._heeded = True  # build_cam is refused where one of them was
        self._given.append(feedback)
        return feedback

    def _wait_for_fewer(self, most: int, what: str, unfinished: Callable[[], Collection[Any]]) -> None:
        def few() -> bool:
            while self._given and self._given[0]._final:
                self._given.popleft()
            return len(unfinished()) < most

        if not few() and not self._session._wait_for(few, DEFAULT_TIMEOUT_S, on_feedback=True):
            raise TaktError(f"the engine does not answer: {most} {what}")


def is_kept(table: Table) -> bool:
    """Whether recordings keep the data of a cam: of the largest ones they do not."""
    return _count(table) <= MOST_KEPT


def _count(table: Table) -> int:
    return len(table.points.x) or len(table.source["segments"])


def _commands(table: Table, name: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """The commands that send a cam, without the last one."""
    source = table.source
    begin = {key: source[key] for key in ("cyclic", "interpolation", "x_unit", "y_unit")}
    yield "begin_cam", {"name": name, **begin}
    x, y, v, a = table.points
    for first in range(0, len(x), POINTS):
        rows = zip(*(column[first : first + POINTS].tolist() for column in (x, y, v, a)), strict=True)
        points = [{"x": px, "y": py, "v": _given(pv), "a": _given(pa)} for px, py, pv, pa in rows]
        yield "add_cam_points", {"cam": name, "first": first, "points": points}
    segments = [] if len(x) else source["segments"]
    for first in range(0, len(segments), SEGMENTS):
        yield "add_cam_segments", {"cam": name, "first": first, "segments": segments[first : first + SEGMENTS]}


def _given(value: float) -> float | None:
    """None: free, which points of cams write as NaN."""
    return value if value == value else None


class SessionWithCams(MachineCommands):
    """The part of a session that makes cams and reads them back."""

    _made_cams: MadeCams

    def _check_open(self) -> None:
        raise NotImplementedError

    def make_cam(self, cam: Table | Mapping[str, Any], *, name: str | None = None) -> Feedback:
        """Makes a cam at run time (CAM-88): the engine checks and builds it outside its cycle, and the feedback is done
        when it can be used, by `set_cam` of a cam module or `cam_in` of an axis. What runs an earlier cam of this name
        keeps it until it is left.

        cam: a takt.cam.Table (points, segments, a file, the result of a maker), or a cam as in a machine file.
        name: how commands call it, 40 bytes at most; its own name unless given.

        A cam is sent in pieces. More than 2,500 points, and a third cam while two are being built, let engine time pass
        until there is room. Raises takt.ConfigError if the cam has errors; nothing is sent then.
        """
        self._check_open()
        return self._made_cams.make(cam, name)

    def drop_cam(self, *, cam: str) -> Feedback:
        feedback = super().drop_cam(cam=cam)
        self._made_cams.drop(cam, feedback)
        return feedback

    drop_cam.__doc__ = MachineCommands.drop_cam.__doc__

    def cam(self, name: str) -> Table:
        """The cam that this name stands for now, of the machine file or made at run time, whoever made it: points,
        laws, extremes. Over LCM what this session does not know is read from the engine: some time for a large cam."""
        self._check_open()
        return self._made_cams.find(name)

    def _cam(self, number: int) -> Table:
        """The cam with this number."""
        raise NotImplementedError
