"""The session: a scenario's interface to an engine, the same in process and over LCM."""

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
    """A program and the cycle before which it is called next. With a `watch`, a change calls it earlier, and calls are
    made only before cycles `begin` + n * `every`."""

    scan: Program
    every: int
    due: int
    begin: int = 0
    watch: Any = None

    def at_or_after(self, cycle: int) -> int:
        """Returns the first cycle, from `cycle` on, before which the program may be called."""
        return cycle if self.watch is None else cycle + (self.begin - cycle) % self.every


P = TypeVar("P", bound=Program)
C = TypeVar("C", bound=Component)

CLASSES: dict[str, type[Component]] = {
    component.KIND: component
    for component in (Axis, FlexCam, Group, Belt, FreePose, PickPlace, Mover, Track, PlanarGroup, Environment, Part)
}
# Kinds of obstructing objects, indexed by the engine's number of the kind.
OBJECTS = ("", "mover", "track", "planar_group", "environment", "part", "coordinate_system", "axis")


PACKAGE = f"{Path(__file__).parent}{os.sep}"
EXAMPLES = f"{PACKAGE}examples{os.sep}"  # inside the package, but treated as user programs
CALLS = 8  # call stack entries kept for a command
REFUSED = 1000  # refused commands kept at most


class Recorder:
    """A recording in progress; `stop` returns the Recording. Also a context manager: after it, read `recording`."""

    def __init__(self, session: Session, components: Iterable[str], every: int) -> None:
        self._session = session
        self._recording: Recording | None = None
        self.components = tuple(components)
        self.every = every
        self.events: list[tuple[float, str, str, str]] = []
        self.belts = [name for name in self.components if name in session.belts]
        self.belt_objects = BeltObjectLog()  # of `belts`

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
        """Ends the recording and returns it. Further calls return it again. Raises TaktError if it was lost."""
        if self.running:
            self._session._recorders.remove(self)  # first: an interrupted end is not retried
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
    """A session with one engine. `axis("x")` returns an axis, whose commands return feedback objects; `wait` and `run`
    let engine time pass."""

    def __init__(self, machine: Mapping[str, Any], machine_text: str) -> None:
        self.machine = machine  # all parameters of the machine file, including defaults
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
        self._routers: dict[int, SurfaceRouter] = {}  # by number of the coordinate system
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
        """All externally supplied poses by name, in the order of the machine file."""
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
        """All components that publish values, axes included, by name."""
        return MappingProxyType(self._components)

    @property
    @abstractmethod
    def cycle(self) -> int:
        """The engine's current cycle; over LCM the latest one received."""

    @property
    @abstractmethod
    def period(self) -> float:
        """Cycle time [s]."""

    @property
    def now(self) -> float:
        """Engine time [s]."""
        return self.cycle * self.period

    @property
    @abstractmethod
    def figures(self) -> dict[str, Any]:
        """The engine's counters and histograms (times in [ns])."""

    # --- commands ---

    def command(self, target: str, verb: str, arguments: Mapping[str, Any] | str = "") -> Feedback:
        """Gives a command by name; the methods of components use this. Returns its feedback; a refused command has the
        state Error and a sentence.

        target: the name of a component, or "machine".
        verb: the name of the command.
        arguments: by name, or as the one-line text that the engine reads.

        Raises TypeError if an argument has the wrong type, ClosedError if the session is closed, and over LCM
        ConnectionError if the engine does not answer.
        """
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
        """Refused commands whose feedback the program has never read (state, error_id, sentence, ...). Only the last
        1,000 refused commands are kept."""
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
        """Moves several movers along tracks at once and lets engine time pass until all have arrived. Returns, for each
        mover that was moved, the time [s] from the call to its arrival.

        targets: by mover, a track and the arc length [mm] along it.
        route: "auto" plans routes and an order of passing without deadlock (takt.plan_routes), and plans again, up to
            three plans in all, if a mover is held up. "shortest" commands the shortest route to every mover at once,
            regardless of the other movers.
        may_move: names of movers without a target that may be moved aside; True: all of them. Used by "auto" only.
        gap: distance [mm] from centre to centre along the route; None: the movers' own.
        timeout: engine time [s] for the whole call.
        dynamics: velocity, acceleration, deceleration, jerk of all moves.

        Raises RoutingError if "auto" finds no plan (of the first plan: before anything moves) or the last plan fails,
        TimeoutError if a mover has not arrived in time, CommandError if a move of "shortest" fails.
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
        """Moves several movers over the free surface at once and lets engine time pass until all have arrived. Returns,
        for each mover that was moved, the time [s] from the start to its arrival.

        targets: by mover, X and Y [mm]. By a tuple of movers, a list of positions that any of them may take. Or only a
            list of positions that any of `movers` may take.
        movers: candidates for a list of targets; None: all movers that can move.
        may_move: names of movers without a target that may be moved aside; True: all of them.
        timeout: engine time [s] for the motion.
        options: as in takt.plan_surface: environment, pitch, origin, effort, seed, velocity, acceleration, jerk.

        Raises RoutingError, before anything moves, if there is no plan (takt.plan_surface).
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
        """Sends movers over the free surface to their targets. Returns an order at once; its `wait()` lets engine time
        pass until they have arrived. If other movers are under way, the routes of all of them are planned again from
        their current positions; a mover that is already under way receives the new target instead of its old one.

        targets, movers, may_move: as in move_on_surface, except that None for `movers` means: all movers that can move
            and are not under way.
        options: as in takt.plan_surface, the same for all movers that are under way at one time; the default of
            `effort` is 3,000.

        Raises RoutingError if there is no plan; motions in progress then continue unchanged.
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
        """As `route`, with interchangeable targets: any of `movers` may take any of `points` (X and Y [mm]). Default of
        `movers`: all that can move and are not under way."""
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
        """Lets engine time pass until `condition()` is true.

        In process the condition is evaluated every `every` cycles (a larger number saves processor time), over LCM
        whenever a message has been received. On return, published values are not older than the cycle at which the
        condition was true.

        timeout: engine time [s].
        what: names the condition in the text of the exception.

        Raises takt.TimeoutError if the condition is not true within `timeout`.
        """
        self._check_open()
        if not callable(condition):
            raise TypeError(f"a condition is a function, not {condition!r}")
        timeout = seconds(timeout, "a timeout")
        every = whole(every, "every", 1)
        if not self._wait_for(lambda: bool(condition()), timeout, on_feedback=False, every=every):
            raise TimeoutError(f"{what or 'the condition'}: not met within {timeout:g} s")
        self._catch_up(self.cycle)

    def run(self, duration: float) -> None:
        """Lets `duration` [s] of engine time pass."""
        self._check_open()
        self._run(round(seconds(duration, "a duration", sys.float_info.max) / self.period))

    def program(self, scan: P, *, every: int = 1, on: Iterable[str] | None = None) -> P:
        """Registers `scan` to be called before every cycle, like a PLC program; function blocks (takt.plcopen) belong
        there. Over LCM it is called whenever a message of the engine has been received. Usable as a decorator: returns
        `scan`.

        every: cycles from one call to the next; a larger number saves processor time.
        on: published values, as "component.field". Calls are skipped while these values are as at the last call, until
            the engine time [s] has passed that `scan` returned there (None: no such limit), or until `wake`. Over LCM
            no call is skipped.
        """
        self._check_open()
        every = whole(every, "every", 1)
        if not callable(scan):
            raise TypeError(f"a program is a function, not {scan!r}")
        watch = None if on is None else self._watch(self._watched(on), every)
        self._programs.append(Scheduled(scan, every, self.cycle, self.cycle, watch))
        return scan

    def wake(self, scan: Program) -> None:
        """Has a program that waits for changes (`program(on=...)`) called before the next cycle that its `every`
        allows. Raises TaktError if `scan` is not a program of this session."""
        programs = [program for program in self._programs if program.scan == scan]
        if not programs:
            raise TaktError(f"{scan!r} is no program of this session: session.program(...) makes it one")
        for program in programs:
            program.due = min(program.due, self.cycle)

    def _watched(self, signals: Iterable[str]) -> list[tuple[int, int]]:
        """Returns (component number, field number) of each signal. Raises TaktError for unknown names."""
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
            # Rounding may make a call one cycle early, never one cycle late.
            cycles = min(asked / self.period, 1e15)
            program.due = min(program.due, now + max(1, math.ceil(cycles - 1e-6)))

    # --- recording ---

    def record(self, *components: str, every: int = 1) -> Recorder:
        """Starts a recording and returns its Recorder.

        components: names of axes and other components; none: all.
        every: one sample every `every` cycles; over LCM, every `every`-th published message of each component.
        """
        self._check_open()
        names = [_named(self._components, name, "axis or other component").name for name in components]
        recorder = Recorder(self, names or self._components, whole(every, "every", 1))
        self._begin(recorder)
        self._recorders.append(recorder)
        return recorder

    def mark(self, text: str, axis: str = "") -> None:
        """Adds a mark at the current time to all recordings in progress.

        axis: the axis or other component that the mark belongs to; "": the whole machine.
        """
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
        """Passes a report of the engine on to the command's feedback and to the recordings."""
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
        """Returns the component with the engine's numbers of kind and object (from 1); None for 0, and for what is no
        component of this machine."""
        named_so = OBJECTS[kind] if 0 <= kind < len(OBJECTS) else ""
        alike = [component for component in self._components.values() if named_so == component.KIND]
        return alike[number - 1] if 1 <= number <= len(alike) else None

    def _object_of(self, kind: str, number: int) -> Component | None:
        """As `_object`, with the kind by name; None for other kinds."""
        return self._object(OBJECTS.index(kind) if kind in OBJECTS else 0, number)

    # --- the end ---

    def close(self) -> None:
        """Ends the session. Recordings in progress are stopped and stay readable."""
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

    # --- implemented by the two kinds of session ---

    @abstractmethod
    def _submit(self, feedback: Feedback) -> None:
        """Gives the command to the engine; afterwards the feedback is Busy, a later state, or Error."""

    @abstractmethod
    def _value(self, component: Component, field: str) -> Any:
        """Returns a published value of a component; enumerated ones as their names."""

    @abstractmethod
    def _objects(self, belt: Belt) -> Iterable[tuple[Any, ...]]:
        """Returns the objects on a belt: the fields of a BeltObject, the state by number."""

    @abstractmethod
    def _history(self, mover: Mover) -> Iterable[tuple[Any, ...]]:
        """Returns the last commands of a mover: the fields of a MoverRecord, enumerated ones by number."""

    @abstractmethod
    def _trail(self, mover: Mover) -> Iterable[int]:
        """Returns the numbers, from 0, of the tracks that a mover's command leads along."""

    @abstractmethod
    def _route(self, mover: Mover) -> tuple[int, FloatArray]:
        """Returns the number of the first visit of a mover's surface route, and all its positions [mm], shape
        (n, 2)."""

    @abstractmethod
    def _track_at(self, track: Track, s: float) -> tuple[float, float, float, float]:
        """Returns x, y [mm], direction [deg], curvature [1/mm] of a track at arc length `s` [mm]."""

    @abstractmethod
    def _track_closest_to(self, track: Track, x: float, y: float) -> float:
        """Returns the arc length [mm] of the point of a track closest to (x, y) [mm]."""

    @abstractmethod
    def _track_links(self, track: Track) -> tuple[list[int], list[int]]:
        """Returns the numbers, from 0, of the tracks before and after a track."""

    def _foresee(self, axis: Axis, verb: str, arguments: Mapping[str, Any]) -> Forecast:
        raise TaktError("forecasts are made in process only; over LCM a feedback has travel_time_s")

    @abstractmethod
    def _wait_for(self, condition: Callable[[], bool], timeout: float, *, on_feedback: bool, every: int = 1) -> bool:
        """Lets time pass until the condition holds. Returns False on timeout. `on_feedback`: the condition changes only
        with feedback; otherwise it is evaluated every `every` cycles."""

    @abstractmethod
    def _run(self, cycles: int) -> None:
        """Lets `cycles` cycles pass."""

    def _watch(self, fields: list[tuple[int, int]], every: int) -> Any:
        """Starts comparing these fields of components every `every` cycles. Returns None where cycles may be missed
        (over LCM); programs are then called at every message."""
        return None

    def _has_changed(self, watch: Any) -> bool:
        """Returns whether a field differs from its value at the last `_keep`."""
        raise NotImplementedError

    def _keep(self, watch: Any) -> None:
        """Stores the current values of a watch's fields, for `_has_changed`."""
        raise NotImplementedError

    def _catch_up(self, cycle: int) -> None:
        """Waits until published values are not older than `cycle`."""

    @abstractmethod
    def _begin(self, recorder: Recorder) -> None: ...

    @abstractmethod
    def _finish(self, recorder: Recorder) -> Recording: ...


def _named(components: Mapping[str, C], name: str, what: str) -> C:
    """Returns the component with this name. Raises TaktError, with the names that exist, if there is none."""
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
    """Returns whether this command acts until it is released. `text`: the arguments as the engine reads them."""
    if (kind, verb) not in LEVEL_SENSITIVE:
        return False
    if any(value is True for value in arguments.values()):
        return True
    return verb == "jog" and not _core.lets_go(kind, verb, text)  # a jog without a direction releases


def release_of(feedback: Feedback) -> Feedback:
    """Returns the command that releases this one, not given yet, and marks this one as released."""
    arguments = to_text({"ticket": feedback.ticket})
    release = Feedback(feedback._session, "machine", "release", arguments, level_sensitive=False)
    feedback._release = release
    feedback.released = True
    return release


def _places() -> tuple[Place, ...]:
    """Returns the call stack of the program that gives a command: calls outside this package, innermost first."""
    places: list[Place] = []
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and len(places) < CALLS:
        name = frame.f_code.co_filename
        if not name.startswith(PACKAGE) or name.startswith(EXAMPLES):
            places.append((name, frame.f_lineno))
        frame = frame.f_back
    return tuple(places)


def _clean(text: str) -> str:
    """Returns the text with question marks for NUL (which ends a text in LCM) and for characters that cannot be encoded
    as UTF-8; the engine then rejects the text."""
    return text.replace("\0", "?").encode("utf-8", "replace").decode()
