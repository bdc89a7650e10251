"""What a scenario sees of an engine, in process or over LCM alike."""

from __future__ import annotations

import difflib
import math
import os
import sys
from abc import abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType, MappingProxyType, TracebackType
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from takt import _core, pick_place
from takt._commands import DEFAULTS, LEVEL_SENSITIVE
from takt.arguments import to_text, without_arguments
from takt.axis import Axis
from takt.belt import Belt
from takt.belt_object_log import BeltObjectLog
from takt.component import Component
from takt.counted import counted
from takt.couplings import why_refused
from takt.environment import Environment
from takt.errors import ClosedError, TaktError, TimeoutError, seconds, whole
from takt.feedback import DEFAULT_TIMEOUT_S, Feedback, FeedbackState, Place
from takt.flex_cam import FlexCam
from takt.group import Group
from takt.made_cams import MadeCams, SessionWithCams
from takt.mover import Mover
from takt.names import names_in
from takt.part import Part
from takt.pick_place import PickPlace
from takt.planar_group import PlanarGroup
from takt.pose import FreePose
from takt.recording import FloatArray, Recording, split_signal
from takt.tables import KINDS, components_of
from takt.track import Track

if TYPE_CHECKING:
    from typing_extensions import Self

    from takt.forecast import Forecast
    from takt.routing.router import SurfaceOrder, SurfaceRouter

Program = Callable[[], object]


@dataclass
class Scheduled:
    """A program, and the cycle ahead of which it is called next. `watch`: it is called earlier when this sees a change,
    and only ahead of cycles that are a multiple of `every` from `begin` on."""

    scan: Program
    every: int
    due: int
    begin: int = 0
    watch: Any = None

    def at_or_after(self, cycle: int) -> int:
        """The first cycle from this one on ahead of which it may be called."""
        return cycle if self.watch is None else cycle + (self.begin - cycle) % self.every


P = TypeVar("P", bound=Program)
C = TypeVar("C", bound=Component)

CLASSES: dict[str, type[Component]] = {
    component.KIND: component
    for component in (Axis, FlexCam, Group, Belt, FreePose, PickPlace, Mover, Track, PlanarGroup, Environment, Part)
}
# What can be in the way, by the numbers that the engine has for it.
OBJECTS = ("", "mover", "track", "planar_group", "environment", "part", "coordinate_system", "axis")


PACKAGE = f"{Path(__file__).parent}{os.sep}"
EXAMPLES = f"{PACKAGE}examples{os.sep}"  # in its folder, but programs like others
CALLS = 8  # kept of where a command was given
REFUSED = 1000  # commands, kept at most


class Recorder:
    """A recording in progress: `stop` makes it a Recording. Also a context manager, after which `recording` has it."""

    def __init__(self, session: Session, components: Iterable[str], every: int) -> None:
        self._session = session
        self._recording: Recording | None = None
        self.components = tuple(components)
        self.every = every
        self.events: list[tuple[float, str, str, str]] = []
        self.belts = [name for name in self.components if name in session.belts]
        self.belt_objects = BeltObjectLog()  # on these

    def __repr__(self) -> str:
        ended = "lost" if self._recording is None else repr(self._recording)
        said = "in progress" if self.running else ended
        return f"<Recorder of {', '.join(self.components)}: {said}>"

    @property
    def running(self) -> bool:
        return self in self._session._recorders

    @property
    def recording(self) -> Recording:
        if self.running:
            raise TaktError("the recording is still in progress: stop it first")
        return self._ended()

    def stop(self) -> Recording:
        """Ends the recording, and again: returns it."""
        if self.running:
            self._session._recorders.remove(self)  # first: an end that was interrupted is not tried again
            self._recording = self._session._finish(self)
        return self._ended()

    def _ended(self) -> Recording:
        if self._recording is None:
            raise TaktError("the recording is lost: its end was interrupted, or failed for lack of memory")
        return self._recording

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        if self.running:
            self.stop()


class Session(SessionWithCams):
    """One engine. `axis("x")` gives an axis, whose commands return feedback objects; `wait` and `run` let engine time
    pass."""

    def __init__(self, machine: Mapping[str, Any], machine_text: str) -> None:
        self.machine = machine  # all parameters of the machine file, with the defaults
        self.machine_text = machine_text
        self._components: dict[str, Component] = {
            name: CLASSES[kind.name](self, number, parameters)
            for number, (name, (kind, parameters)) in enumerate(components_of(machine).items())
        }
        self._axes = {name: c for name, c in self._components.items() if isinstance(c, Axis)}
        self._flex_cams = {name: c for name, c in self._components.items() if isinstance(c, FlexCam)}
        self._groups = {name: c for name, c in self._components.items() if isinstance(c, Group)}
        self._belts = {name: c for name, c in self._components.items() if isinstance(c, Belt)}
        self._poses = {name: c for name, c in self._components.items() if isinstance(c, FreePose)}
        self._pick_places = {name: c for name, c in self._components.items() if isinstance(c, PickPlace)}
        self._movers = {name: c for name, c in self._components.items() if isinstance(c, Mover)}
        self._tracks = {name: c for name, c in self._components.items() if isinstance(c, Track)}
        self._planar_groups = {name: c for name, c in self._components.items() if isinstance(c, PlanarGroup)}
        self._environments = {name: c for name, c in self._components.items() if isinstance(c, Environment)}
        self._parts = {name: c for name, c in self._components.items() if isinstance(c, Part)}
        self._routers: dict[int, SurfaceRouter] = {}  # by coordinate system
        self._programs: list[Scheduled] = []
        self._scanning = False
        self._recorders: list[Recorder] = []
        self._refused: deque[Feedback] = deque(maxlen=REFUSED)
        self._made_cams = MadeCams(self)
        self._closed = False

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}: {counted(len(self._components), 'component')}, {self.now:.3f} s>"

    def _repr_html_(self) -> str:
        from takt.notebook import session_table

        return session_table(self)

    # --- the machine ---

    @property
    def name(self) -> str:
        return str(self.machine["name"])

    @property
    def axes(self) -> Mapping[str, Axis]:
        """All axes by name, in the order of the machine file."""
        return MappingProxyType(self._axes)

    def axis(self, name: str) -> Axis:
        return _named(self._axes, name, "axis")

    @property
    def flex_cams(self) -> Mapping[str, FlexCam]:
        """All cam modules by name, in the order of the machine file."""
        return MappingProxyType(self._flex_cams)

    def flex_cam(self, name: str) -> FlexCam:
        return _named(self._flex_cams, name, "cam module")

    @property
    def groups(self) -> Mapping[str, Group]:
        """All groups of axes by name, in the order of the machine file."""
        return MappingProxyType(self._groups)

    def group(self, name: str) -> Group:
        return _named(self._groups, name, "group")

    @property
    def belts(self) -> Mapping[str, Belt]:
        """All belts by name, in the order of the machine file."""
        return MappingProxyType(self._belts)

    def belt(self, name: str) -> Belt:
        return _named(self._belts, name, "belt")

    @property
    def poses(self) -> Mapping[str, FreePose]:
        """All poses that come from elsewhere by name, in the order of the machine file."""
        return MappingProxyType(self._poses)

    def pose(self, name: str) -> FreePose:
        return _named(self._poses, name, "pose")

    @property
    def pick_places(self) -> Mapping[str, PickPlace]:
        """All pick and place modules by name, in the order of the machine file."""
        return MappingProxyType(self._pick_places)

    def pick_place(self, name: str) -> PickPlace:
        return _named(self._pick_places, name, "pick and place module")

    @property
    def movers(self) -> Mapping[str, Mover]:
        """All planar movers by name, in the order of the machine file."""
        return MappingProxyType(self._movers)

    def mover(self, name: str) -> Mover:
        return _named(self._movers, name, "mover")

    @property
    def tracks(self) -> Mapping[str, Track]:
        """All tracks by name, in the order of the machine file."""
        return MappingProxyType(self._tracks)

    def track(self, name: str) -> Track:
        return _named(self._tracks, name, "track")

    @property
    def planar_groups(self) -> Mapping[str, PlanarGroup]:
        """All groups of movers by name, in the order of the machine file."""
        return MappingProxyType(self._planar_groups)

    def planar_group(self, name: str) -> PlanarGroup:
        return _named(self._planar_groups, name, "group of movers")

    @property
    def environments(self) -> Mapping[str, Environment]:
        """All environments by name, in the order of the machine file."""
        return MappingProxyType(self._environments)

    def environment(self, name: str) -> Environment:
        return _named(self._environments, name, "environment")

    @property
    def parts(self) -> Mapping[str, Part]:
        """All parts of the surface by name, in the order of the machine file."""
        return MappingProxyType(self._parts)

    def part(self, name: str) -> Part:
        return _named(self._parts, name, "part")

    @property
    def components(self) -> Mapping[str, Component]:
        """All axes and all other components that publish something, by name."""
        return MappingProxyType(self._components)

    @property
    @abstractmethod
    def cycle(self) -> int:
        """The cycle the engine is at, as far as is known here."""

    @property
    @abstractmethod
    def period(self) -> float:
        """s, length of a cycle."""

    @property
    def now(self) -> float:
        """s, engine time."""
        return self.cycle * self.period

    @property
    @abstractmethod
    def figures(self) -> dict[str, Any]:
        """The engine's own counts and histograms (times in ns)."""

    # --- commands ---

    def command(self, target: str, verb: str, arguments: Mapping[str, Any] | str = "") -> Feedback:
        """Gives any command by its names; the methods of components are made of this. What the engine refuses comes
        back as a feedback in the state Error, with a sentence."""
        self._check_open()
        for what, text in (("target", target), ("verb", verb)):
            if not isinstance(text, str):
                raise TypeError(f"the {what} of a command is a text, not {text!r}")
        if not isinstance(arguments, (str, Mapping)):
            raise TypeError(f"the arguments of a command are a mapping or a text, not {arguments!r}")
        asked = (self._kind(target), verb)
        text = arguments if isinstance(arguments, str) else to_text(arguments, DEFAULTS.get(asked))
        level = not isinstance(arguments, str) and is_held(*asked, arguments, _clean(text))
        feedback = Feedback(self, _clean(target), _clean(verb), _clean(text), level_sensitive=level)
        feedback.given_at = _places()
        self._give(feedback)
        return feedback

    @property
    def unheeded(self) -> list[Feedback]:
        """Commands that were refused, which the program has not noticed: it never asked what became of them. The last
        1,000."""
        return [feedback for feedback in self._refused if feedback._ignored]

    def _kind(self, target: str) -> str:
        component = self._components.get(target)
        return component.KIND if component else "machine"

    def _give(self, feedback: Feedback) -> None:
        self._event(feedback.target, feedback.text, "start")
        self._submit(feedback)

    def _release(self, feedback: Feedback) -> Feedback:
        self._check_open()
        release = release_of(feedback)
        self._give(release)
        return release

    def _command(self, verb: str, arguments: Mapping[str, Any]) -> Feedback:
        return self.command("machine", verb, arguments)

    def move_on_tracks(
        self,
        targets: Mapping[str, tuple[str, float]],
        *,
        route: Literal["auto", "shortest"] = "auto",
        may_move: bool | Iterable[str] = False,
        gap: float | None = None,
        timeout: float = DEFAULT_TIMEOUT_S,
        **dynamics: float,
    ) -> dict[str, float]:
        """Moves many movers along tracks at once, and lets engine time pass until all are there. How long each of those
        that were moved took, in s.

        targets: by mover, a track and mm along it.
        route: "auto" finds ways and an order of passing in which nobody waits for ever (takt.plan_routes), or raises
            RoutingError before anything moves; should a mover be held up, it plans anew. "shortest" sends each its
            shortest way at once, whatever the others do.
        may_move: movers without a target that may be moved out of the way, or all of them (True).
        gap: mm from centre to centre along the way, instead of the movers' own.
        timeout: s of engine time for all of it.
        dynamics: velocity, acceleration, deceleration, jerk of all moves.
        """
        from takt.routing.journey import move_on_tracks

        self._check_open()
        return move_on_tracks(self, targets, route=route, may_move=may_move, gap=gap, timeout=timeout, **dynamics)

    def move_on_surface(
        self,
        targets: Mapping[Any, Any] | Sequence[tuple[float, float]],
        *,
        movers: Iterable[str] | None = None,
        may_move: bool | Iterable[str] = False,
        timeout: float = DEFAULT_TIMEOUT_S,
        **options: Any,
    ) -> dict[str, float]:
        """Moves many movers over the free surface at once, and lets engine time pass until all are there. How long each
        of those that were moved took, in s. RoutingError, before anything moves, if there is no plan
        (takt.plan_surface).

        targets: by mover, X and Y in mm; by several, as a tuple, a list of places for any of them. Or a list alone,
            each for any of `movers` (all that can move).
        may_move: movers without a target that may be moved out of the way, or all of them (True).
        timeout: s of engine time for all of it.
        options: as those of takt.plan_surface: environment, pitch, origin, effort, seed, velocity, acceleration, jerk.
        """
        from takt.routing.surface_journey import move_on_surface

        self._check_open()
        return move_on_surface(self, targets, movers=movers, may_move=may_move, timeout=timeout, **options)

    def route(
        self,
        targets: Mapping[Any, Any] | Sequence[tuple[float, float]],
        *,
        movers: Iterable[str] | None = None,
        may_move: bool | Iterable[str] = False,
        **options: Any,
    ) -> SurfaceOrder:
        """Sends movers over the free surface to their targets, and returns at once: `wait()` of the order lets engine
        time pass until they are there. Given while others are on their way, routes are planned anew for all of them
        from where they are; a mover that is on its way already goes to its new target instead.

        targets, movers, may_move: as those of move_on_surface.
        options: as those of takt.plan_surface, the same for all movers that are on their way at one time; `effort` is
            3,000 unless given.

        Raises RoutingError if there is no plan; then all goes on as before.
        """
        from takt.routing.router import router_for

        self._check_open()
        movers = None if movers is None else names_in(movers, "movers", "mover")
        router = router_for(self, targets, movers, options)
        return router.route(targets, movers=movers, may_move=may_move)

    def route_any(
        self,
        points: Sequence[tuple[float, float]],
        *,
        movers: Iterable[str] | None = None,
        may_move: bool | Iterable[str] = False,
        **options: Any,
    ) -> SurfaceOrder:
        """Sends any of these movers to any of these places, X and Y in mm, as `route` does. Movers: those that can move
        and are not on their way, unless they are given."""
        return self.route(list(points), movers=movers, may_move=may_move, **options)

    # --- time ---

    def wait(
        self,
        condition: Callable[[], object],
        timeout: float = DEFAULT_TIMEOUT_S,
        *,
        what: str = "",
        every: int = 1,
    ) -> None:
        """Lets engine time pass until `condition()` is true; takt.TimeoutError when it is not within `timeout` s of
        engine time. In process it is asked after every cycle, or after every so many, which takes less time of the
        processor; over LCM whenever something new has come; what is published is then nowhere older than what the
        condition saw."""
        self._check_open()
        if not callable(condition):
            raise TypeError(f"a condition is a function, not {condition!r}")
        timeout = seconds(timeout, "a timeout")
        every = whole(every, "every", 1)
        if not self._wait_for(lambda: bool(condition()), timeout, on_feedback=False, every=every):
            raise TimeoutError(f"{what or 'the condition'}: not met within {timeout:g} s")
        self._catch_up(self.cycle)

    def run(self, duration: float) -> None:
        """Lets so many seconds of engine time pass."""
        self._check_open()
        self._run(round(seconds(duration, "a duration", sys.float_info.max) / self.period))

    def program(self, scan: P, *, every: int = 1, on: Iterable[str] | None = None) -> P:
        """Has `scan` called before every cycle, like a program in a PLC: the place for function blocks (takt.plcopen).
        Over LCM it is called whenever the engine's state has come. Serves as a decorator.

        every: cycles from one call to the next. What need not look into every cycle holds the engine up less.
        on: published values, as "component.field". Calls are left out while these are as they were at the last one,
            until the s of engine time have passed that `scan` returned then (None: for ever), or `wake` was called.
            Over LCM none is left out.
        """
        self._check_open()
        every = whole(every, "every", 1)
        if not callable(scan):
            raise TypeError(f"a program is a function, not {scan!r}")
        watch = None if on is None else self._watch(self._watched(on), every)
        self._programs.append(Scheduled(scan, every, self.cycle, self.cycle, watch))
        return scan

    def wake(self, scan: Program) -> None:
        """Has a program that waits for changes (`program(on=...)`) called at its next turn."""
        programs = [program for program in self._programs if program.scan == scan]
        if not programs:
            raise TaktError(f"{scan!r} is no program of this session: session.program(...) makes it one")
        for program in programs:
            program.due = min(program.due, self.cycle)

    def _watched(self, signals: Iterable[str]) -> list[tuple[int, int]]:
        """Components and their fields by number."""
        found = []
        for signal in names_in(signals, "on", "published value", "published values"):
            name, field = split_signal(signal)
            component = _named(self._components, name, "axis or other component")
            places = KINDS[component.KIND].places
            if field not in places:
                near = difflib.get_close_matches(field, places, n=1)
                hint = f"; did you mean '{near[0]}'?" if near else ""
                raise TaktError(f"'{name}' publishes no '{field}'{hint}")
            found.append((component.index, places[field]))
        return found

    def _scan(self) -> None:
        if self._scanning:
            raise TaktError("a program is called in every cycle: it cannot let time pass itself")
        self._scanning = True
        try:
            now = self.cycle
            for program in self._programs:
                if program.watch is not None:
                    self._scan_on_change(program, now)
                elif program.every == 1 or program.due <= now:
                    program.due = now + program.every
                    program.scan()
        finally:
            self._scanning = False

    def _scan_on_change(self, program: Scheduled, now: int) -> None:
        if program.at_or_after(now) != now or (program.due > now and not self._has_changed(program.watch)):
            return
        program.due = sys.maxsize
        self._keep(program.watch)
        asked = program.scan()
        if asked is not None:
            if not isinstance(asked, (int, float)) or not asked >= 0:
                raise TypeError(f"a program with `on` returns s until its next call, or None, not {asked!r}")
            # Rather a call too early than one too late by a rounding.
            cycles = min(asked / self.period, 1e15)
            program.due = min(program.due, now + max(1, math.ceil(cycles - 1e-6)))

    # --- recording ---

    def record(self, *components: str, every: int = 1) -> Recorder:
        """Starts recording these axes and other components, or all; one sample every so many cycles (over LCM: of those
        that are published)."""
        self._check_open()
        names = [_named(self._components, name, "axis or other component").name for name in components]
        recorder = Recorder(self, names or self._components, whole(every, "every", 1))
        self._begin(recorder)
        self._recorders.append(recorder)
        return recorder

    def mark(self, text: str, axis: str = "") -> None:
        """Puts a mark at this time into all recordings in progress: of this axis or other component, or of the whole
        machine."""
        self._check_open()
        component = _named(self._components, axis, "axis or other component").name if axis != "" else ""
        self._event(component, text, "mark")

    def _event(self, component: str, text: str, kind: str, time_s: float = math.nan) -> None:
        if component not in self._components:
            component = ""  # concerns the whole machine
        for recorder in self._recorders:
            recorder.events.append((self.now if math.isnan(time_s) else time_s, component, text, kind))

    def _report(
        self,
        feedback: Feedback,
        state: int,
        reached: bool,
        error_id: int,
        sentence: str,
        cycle: int,
        value: float = 0.0,
        object_kind: int = 0,
        object_number: int = 0,
    ) -> None:
        """Passes on what the engine says of a command."""
        feedback.object = self._object(object_kind, object_number) or feedback.object
        if error_id:
            sentence = self._why_refused(error_id, feedback, sentence) or sentence
        if not feedback._update(state, reached, error_id, sentence, cycle, value) or not feedback._final:
            return
        name = without_arguments(feedback.text)
        if feedback._state is FeedbackState.ERROR:
            self._event(feedback.target, f"{name}: {feedback._sentence}", "error", feedback.time_s)
            if feedback._refused and not feedback._lets_go_of_another:
                self._refused.append(feedback)
        else:
            self._event(feedback.target, f"{name}: {feedback._state.name.lower()}", "end", feedback.time_s)

    def _why_refused(self, error_id: int, feedback: Feedback, sentence: str) -> str:
        if feedback.target not in self._components:
            return ""
        if self._components[feedback.target].KIND == PickPlace.KIND:
            general = sentence == _core.error_texts().get(error_id, ("", ""))[1]
            return pick_place.why_refused(error_id, feedback.verb, feedback.arguments) if general else ""
        names = self._made_cams.names
        return why_refused(error_id, feedback.target, feedback.arguments, self._axes, self._movers, names)

    def _object(self, kind: int, number: int) -> Component | None:
        """What the engine calls so."""
        if not kind or not number:
            return None
        alike = [component for component in self._components.values() if OBJECTS[kind] == component.KIND]
        return alike[number - 1]

    def _object_of(self, kind: str, number: int) -> Component | None:
        """The same, by the name of its kind."""
        return self._object(OBJECTS.index(kind) if kind in OBJECTS else 0, number)

    # --- the end ---

    def close(self) -> None:
        """Ends the session; what was recorded stays readable."""
        try:
            for recorder in list(self._recorders):
                recorder.stop()
        finally:
            self._closed = True

    def __enter__(self) -> Self:
        self._check_open()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _check_open(self) -> None:
        if self._closed:
            raise ClosedError("the session is closed")

    # --- what the two kinds do in their own way ---

    @abstractmethod
    def _submit(self, feedback: Feedback) -> None:
        """Gives the command to the engine; afterwards the feedback is Busy at least, or Error."""

    @abstractmethod
    def _value(self, component: Component, field: str) -> Any:
        """A published value of a component."""

    @abstractmethod
    def _objects(self, belt: Belt) -> Iterable[tuple[Any, ...]]:
        """What lies on a belt: the fields of a BeltObject, the state by number."""

    @abstractmethod
    def _history(self, mover: Mover) -> Iterable[tuple[Any, ...]]:
        """The last commands of a mover: the fields of a MoverRecord, the state by number."""

    @abstractmethod
    def _trail(self, mover: Mover) -> Iterable[int]:
        """Numbers of the tracks, from 0, that a mover is to go along."""

    @abstractmethod
    def _route(self, mover: Mover) -> tuple[int, FloatArray]:
        """The number of the first visit of a mover's route over the free surface, and all places, (n, 2) mm."""

    @abstractmethod
    def _track_at(self, track: Track, s: float) -> tuple[float, float, float, float]:
        """A position along a track: x, y, direction in deg, curvature."""

    @abstractmethod
    def _track_closest_to(self, track: Track, x: float, y: float) -> float:
        """The arc length of a track where it is nearest to a position."""

    @abstractmethod
    def _track_links(self, track: Track) -> tuple[list[int], list[int]]:
        """Numbers of the tracks before and behind a track."""

    def _foresee(self, axis: Axis, verb: str, arguments: Mapping[str, Any]) -> Forecast:
        raise TaktError("forecasts are made in process only; over LCM a feedback has travel_time_s")

    @abstractmethod
    def _wait_for(self, condition: Callable[[], bool], timeout: float, *, on_feedback: bool, every: int = 1) -> bool:
        """Lets time pass until the condition holds, which changes only with feedback if `on_feedback`, and else is
        asked every so many cycles. False: timed out."""

    @abstractmethod
    def _run(self, cycles: int) -> None:
        """Lets so many cycles pass."""

    def _watch(self, fields: list[tuple[int, int]], every: int) -> Any:
        """Looks at these fields of components every so many cycles. None: it is not known which cycles are seen, and
        programs are called whenever there is something new."""
        return None

    def _has_changed(self, watch: Any) -> bool:
        """Whether a field is other than when they were kept last."""
        raise NotImplementedError

    def _keep(self, watch: Any) -> None:
        """Keeps the fields of a watch as they are now."""
        raise NotImplementedError

    def _catch_up(self, cycle: int) -> None:
        """Makes sure that published values are not older than this cycle."""

    @abstractmethod
    def _begin(self, recorder: Recorder) -> None: ...

    @abstractmethod
    def _finish(self, recorder: Recorder) -> Recording: ...


def _named(components: Mapping[str, C], name: str, what: str) -> C:
    """The component of this name, or a sentence that says which there are."""
    article = "an" if what[0] in "aeiou" else "a"
    if not isinstance(name, str):
        raise TypeError(f"{article} {what} goes by its name, not by {name!r}")
    try:
        return components[name]
    except KeyError:
        near = difflib.get_close_matches(name, components, n=1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        has = f" (it has {', '.join(components)})" if components else ""
        raise TaktError(f"the machine has no {what} '{name}'{hint}{has}") from None


def is_held(kind: str, verb: str, arguments: Mapping[str, Any], text: str) -> bool:
    """Whether this command acts until it is released; text: the arguments as the engine reads them."""
    if (kind, verb) not in LEVEL_SENSITIVE:
        return False
    if any(value is True for value in arguments.values()):
        return True
    return verb == "jog" and not _core.lets_go(kind, verb, text)  # without a direction it lets go


def release_of(feedback: Feedback) -> Feedback:
    """The command that lets go of this one, not given yet."""
    arguments = to_text({"ticket": feedback.ticket})
    release = Feedback(feedback._session, "machine", "release", arguments, level_sensitive=False)
    feedback._release = release
    feedback.released = True
    return release


def _places() -> tuple[Place, ...]:
    """Where the program is that gives a command: calls outside of this package, the innermost first."""
    places: list[Place] = []
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and len(places) < CALLS:
        name = frame.f_code.co_filename
        if not name.startswith(PACKAGE) or name.startswith(EXAMPLES):
            places.append((name, frame.f_lineno))
        frame = frame.f_back
    return tuple(places)


def _clean(text: str) -> str:
    """What cannot be written as UTF-8, and NUL, which ends a text in LCM, becomes a question mark, which the engine
    then complains about."""
    return text.replace("\0", "?").encode("utf-8", "replace").decode()
