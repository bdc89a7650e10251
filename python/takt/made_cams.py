"""Cams made at run time (CAM-88): sends them to an engine, and remembers those of this session."""

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

POINTS = 20  # per command
SEGMENTS = 8  # per command
UNANSWERED = 128  # commands without an answer at most
KNOWN = 256  # cams whose data is kept; an engine holds 64
MOST_KEPT = 5_000  # points of a cam kept in recordings
BUILDS = 2  # cams that an engine builds at a time


@dataclass
class MadeCam:
    """A cam that this session has sent to the engine."""

    name: str
    table: Table
    feedback: Feedback  # its value is the number of the cam
    dropped: Feedback | None = None

    @property
    def found(self) -> bool:
        """Whether commands find it by its name, unless a later cam has the same name."""
        return self.feedback._done and not (self.dropped and self.dropped._done)

    @cached_property
    def named(self) -> Table:
        """The cam with the name under which the engine has it."""
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
        """The names of all cams that commands find, as far as this session knows."""
        names = [cam["name"] for cam in self._session.machine["cams"]]
        return list(dict.fromkeys(names + [made.name for made in self.cams if made.found]))

    def find(self, name: str) -> Table:
        """Returns the cam with this name, as far as this session knows. Raises TaktError if there is none."""
        for made in reversed(self.cams):
            if made.name == name and made.found:
                return made.named
        for number, cam in enumerate(self._session.machine["cams"], 1):
            if cam["name"] == name:
                return self._session._cam(number)
        raise TaktError(f"there is no cam '{name}' (there are {', '.join(self.names)})")

    def known(self, number: int) -> Table | None:
        """Returns the cam with this number; None if this session does not know it (made by another client)."""
        from takt.cam import Table

        if 1 <= number <= len(self._session.machine["cams"]):
            return Table.from_dict(self._session.machine["cams"][number - 1])
        for made in self.cams:
            if made.feedback._done and made.feedback.value == number:
                return made.named
        return None

    def kept(self) -> dict[str, Any]:
        """Returns the cams made so far, by number, for the `meta` of recordings; without the largest ones."""
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
            feedback._heeded = True  # if one of them is refused, build_cam is refused, too
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
    """Returns whether recordings keep the data of a cam; they do not for the largest ones."""
    return _count(table) <= MOST_KEPT


def _count(table: Table) -> int:
    return len(table.points.x) or len(table.source["segments"])


def _commands(table: Table, name: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Returns the commands that send a cam, except the final build_cam."""
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
    """Returns the value; None for NaN, which means free in points of cams."""
    return value if value == value else None


class SessionWithCams(MachineCommands):
    """The part of a session that makes cams and reads them back."""

    _made_cams: MadeCams

    def _check_open(self) -> None:
        raise NotImplementedError

    def make_cam(self, cam: Table | Mapping[str, Any], *, name: str | None = None) -> Feedback:
        """Makes a cam at run time (CAM-88). The engine checks and builds it outside its cycle; the feedback is done
        when the cam can be used by `set_cam` of a cam module or `cam_in` of an axis. A module or axis that runs an
        earlier cam of this name keeps that cam until it leaves it.

        cam: a takt.cam.Table (points, segments, a file, the result of a maker), or a cam as in a machine file.
        name: its name for commands, up to 40 bytes; None: the cam's own name.

        Returns the feedback; its value is the number of the cam. A cam is sent in pieces: for more than 2,500 points,
        or a third cam while two are being built, engine time passes until there is room. Raises takt.ConfigError if the
        cam has errors; nothing is sent then.
        """
        self._check_open()
        return self._made_cams.make(cam, name)

    def drop_cam(self, *, cam: str) -> Feedback:
        feedback = super().drop_cam(cam=cam)
        self._made_cams.drop(cam, feedback)
        return feedback

    drop_cam.__doc__ = MachineCommands.drop_cam.__doc__

    def cam(self, name: str) -> Table:
        """Returns the cam with this name, from the machine file or made at run time by any client: points, laws,
        extremes. Over LCM the cam is read from the engine unless this session knows it, which takes some time for a
        large cam. Raises TaktError if there is no such cam."""
        self._check_open()
        return self._made_cams.find(name)

    def _cam(self, number: int) -> Table:
        """Returns the cam with this number."""
        raise NotImplementedError
