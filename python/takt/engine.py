"""The engine in process, in virtual time: runs as fast as possible, with bit-identical results every time."""

from __future__ import annotations

import json
import math
import os
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from takt import _core
from takt._commands import DEFAULTS
from takt.arguments import to_text
from takt.axis import Axis
from takt.belt import Belt
from takt.changes import changed
from takt.component import Component
from takt.errors import ConfigError, DriveWarning, TaktError, seconds, whole
from takt.feedback import Feedback
from takt.forecast import Forecast
from takt.keys import KeyFile, read_key
from takt.mover import Mover
from takt.names import shown
from takt.network import network_of
from takt.plant import Plant, axes_of
from takt.recording import FloatArray, Recording
from takt.saved import JournalEntry, Saved
from takt.session import Recorder, Session
from takt.tables import KINDS, fields_of_kind, make_recording
from takt.track import Track
from takt.yaml_text import to_json

if TYPE_CHECKING:
    from takt.cam import Table

MOST_BYTES = 8_000_001  # read of a machine file: one more than the limit
CHUNK = 20_000  # cycles between two checks for Ctrl-C


@dataclass(frozen=True)
class _Text:
    """The text of a machine file and the file's name."""

    text: bytes
    file_name: str


Machine = str | os.PathLike[str] | Mapping[str, Any]  # a path, the text itself, or its content as dicts


def read_machine(machine: Machine | _Text) -> tuple[bytes, str]:
    """Returns text and file name of a machine given as a path, as the text itself (more than one line), or as dicts and
    lists. The text is not decoded: the engine reports where it is not UTF-8. Dicts are written as text with one key a
    line, to which the line numbers of problems refer. Raises ConfigError if the file cannot be read or the dict cannot
    be written."""
    if isinstance(machine, _Text):
        return machine.text, machine.file_name
    if isinstance(machine, Mapping):
        return _text_of(machine), "machine"
    if isinstance(machine, str) and "\n" in machine:
        return machine.encode("utf-8", "surrogatepass"), "machine"
    if not isinstance(machine, (str, os.PathLike)):
        raise TypeError(f"a machine is the path of a file, its text, or a dict, not {machine!r}")
    if not str(machine):
        raise ConfigError(["the path of the machine file is empty"])
    path = Path(machine)
    try:
        with path.open("rb") as file:
            return file.read(MOST_BYTES), shown(path)
    except OSError as error:
        raise ConfigError([f"{path}: cannot be read: {error.strerror}"]) from None


def _text_of(machine: Mapping[str, Any]) -> bytes:
    """Returns the machine as the text of a machine file: JSON, a subset of YAML."""
    try:
        text = to_json(machine, indent=1, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        raise ConfigError([f"machine: a dict that no machine file can hold: {error}"]) from None
    return text.encode("utf-8", "surrogatepass")


def _plain(value: Any) -> Any:
    """Converts mappings, paths and NumPy values, which the JSON encoder does not accept."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{value!r} is no number, text, list or dict")


class Engine(Session):
    """A machine in virtual time.

    machine: the path of a machine file, its text, or its content as a dict.
    period: cycle time [s]; None: that of the machine file.
    journal: keep the journal and a hash of the whole state after every cycle (`take_journal`, `take_hashes`); required
        by `save` and `clone`.
    url: LCM network of external drives; None: that of the machine file (`lcm.url`, else LCM_DEFAULT_URL). Engine time
        does not advance until the drives have answered.
    changes: values of the machine file to change, as {"axes.x.limits.velocity": 300}.
    key: file with the key of external drives; None: the file named by the environment (TAKT_KEY_FILE); "": no key.
    plant: in-process plant that moves axes instead of simulated servos: a `takt.Plant`, or "mujoco" for the machine's
        twin (section `twin` of the machine file; takt.twin). It may move external drives, too.

    Raises ConfigError if the machine file is wrong.
    """

    def __init__(
        self,
        machine: Machine | _Text,
        *,
        period: float | None = None,
        journal: bool = False,
        url: str | None = None,
        key: KeyFile | None = None,
        changes: Mapping[str, bool | int | float | str] | None = None,
        plant: Plant | Literal["mujoco"] | None = None,
    ) -> None:
        text, file_name = read_machine(machine)
        text = changed(text, file_name, changes or {})
        self._origin = (text, file_name, period)
        self._journal: list[JournalEntry] | None = [] if journal else None  # all entries, for `save`
        self._taken = 0  # entries that `take_journal` has returned
        self._waiting: deque[tuple[int, float, str, str, str]] = deque()  # commands that no cycle has applied yet
        if period is not None:
            period = seconds(period, "a period")
        described = json.loads(_core.load_machine(text, file_name))
        self.plant = _plant_of(plant, text, file_name, described, period)
        moved = axes_of(self.plant, described, file_name) if self.plant is not None else []
        drives_url = (url or network_of(described)) if described["external"]["drives"] and not moved else None
        drives_key = read_key(key) if drives_url or key else None
        self._core = _core.Engine(
            text,
            file_name,
            journal=journal,
            period_s=period,
            drives_url=drives_url,
            drives_key=drives_key.data if drives_key else None,
            plant=moved,
        )
        self._unfinished: dict[int, Feedback] = {}
        self._unreleased: list[Feedback] = []  # commands whose release was refused; retried
        self._core_recorders: dict[Recorder, _core.Recorder] = {}
        self._folder = str(Path(file_name).resolve().parent)
        super().__init__(json.loads(self._core.machine_json), text.decode())
        if self.plant is not None:
            self.plant.start(self.machine, self.period)
            self._core.set_plant(self.plant.step)

    @property
    def cycle(self) -> int:
        return self._core.cycle

    @property
    def period(self) -> float:
        return self._core.period_s

    @property
    def figures(self) -> dict[str, Any]:
        return {**self._core.figures()}

    @property
    def state_hash(self) -> int:
        """Hash of the whole state; equal in two runs that have been identical so far."""
        return self._core.state_hash()

    def step(self, cycles: int = 1) -> None:
        """Runs `cycles` cycles."""
        self._check_open()
        self._run(whole(cycles, "a number of cycles", 0))

    def shut_down(self, timeout: float = 60.0) -> None:
        """Stops all motions along their ramps and opens the control loops, as taktd does when it ends. Commands are no
        longer accepted. Raises TimeoutError if an axis is not at rest with its loop open within `timeout` [s]."""
        self._check_open()
        self._core.request_shutdown()
        self._run(1)  # a machine that is already off has to process the request, too
        self.wait(lambda: self._core.all_disabled, timeout, what="every axis at rest with its loop open")

    def close(self) -> None:
        """Ends the session and leaves the network of external drives. Recordings stay readable."""
        try:
            super().close()
        finally:
            self._core.leave_network()

    def take_journal(self) -> list[JournalEntry]:
        """Returns the commands applied since the last call: (cycle, ticket, lease [s], target, verb, arguments). Empty
        without `journal=True`."""
        if self._journal is None:
            return []
        self._hear_journal(self._journal)
        begin, self._taken = self._taken, len(self._journal)
        return self._journal[begin:]

    def _hear_journal(self, journal: list[JournalEntry]) -> None:
        for entry in self._core.take_journal():
            journal.append(entry)
            while self._waiting and self._waiting[0][0] <= entry[1]:
                self._waiting.popleft()

    def save(self) -> Saved:
        """Returns the current state; `Engine.restore` makes an engine that continues from it identically. The journal
        is saved and replayed, so restoring takes as long as running the cycles. Commands that no cycle has applied yet
        are included. Raises TaktError without `journal=True`, or if the machine has a plant or external drives, whose
        states the engine does not have."""
        self._check_open()
        if self._journal is None:
            raise TaktError("only an engine with a journal can be saved: takt.Engine(machine, journal=True)")
        if self.plant is not None or self.machine["external"]["drives"]:
            raise TaktError(
                "an engine whose axes a plant or external drives move cannot be saved: it lacks their state"
            )
        self._hear_journal(self._journal)
        text, file_name, period = self._origin
        journal = (*self._journal, *((self.cycle, *given) for given in self._waiting))
        return Saved(text, file_name, period, self.cycle, self.state_hash, journal, _core.__version__)

    @classmethod
    def restore(cls, saved: Saved) -> Engine:
        """Returns an engine in the saved state, with a journal of its own. Raises TaktError if the replayed state
        differs from the saved one (compared by hash)."""
        if not isinstance(saved, Saved):
            raise TypeError(f"expected what Engine.save returned, not {saved!r}")
        engine = cls.__new__(cls)
        Engine.__init__(engine, _Text(saved.machine_text, saved.file_name), period=saved.period_s, journal=True)
        engine._go_to(saved)
        return engine

    def clone(self) -> Engine:
        """Returns a second, independent engine in the same state. Feedback objects, programs and recordings stay with
        this engine. Raises TaktError as `save`."""
        return Engine.restore(self.save())

    def _go_to(self, saved: Saved) -> None:
        waiting: list[JournalEntry] = []
        for entry in saved.journal:
            cycle, ticket, lease_s, target, verb, arguments = entry
            if cycle == saved.cycle:
                waiting.append(entry)
            elif ticket:
                self._core.step(cycle - self.cycle)
                self._expect_given(entry, self._core.resubmit(target, verb, arguments, ticket, lease_s))
            elif verb == "stop_all":
                self._core.step(cycle - self.cycle)
                self._core.request_shutdown()
            # Other commands without a ticket are the engine's own; it gives them again by itself.
        self._core.step(saved.cycle - self.cycle)
        self._core.take_feedback()
        self._core.take_hashes()
        self._journal = self._core.take_journal()
        self._taken = len(self._journal)
        for entry in waiting:
            self._expect_given(entry, self._core.submit(*entry[3:]))
            self._waiting.append(entry[1:])
        if self.state_hash != saved.hash:
            raise TaktError(
                f"the state after {saved.cycle} cycles is not the one that was saved (by version {saved.version}, "
                f"this is {_core.__version__})"
            )

    def _expect_given(self, entry: JournalEntry, answer: tuple[int, int, str]) -> None:
        given, error_id, sentence = answer
        _, ticket, _, target, verb, arguments = entry
        if error_id or given != ticket:
            why = sentence or f"expected ticket {ticket} for it, found {given}"
            raise TaktError(f"the saved command {target}.{verb} {arguments} cannot be given again: {why}")

    def take_drive_journal(self) -> list[tuple[int, int, int, dict[str, Any]]]:
        """Returns the measurements of external drives used since the last call: (cycle, number of the axis from 0,
        cycle of the answered set point, wires)."""
        return self._core.take_drive_journal()

    def take_hashes(self) -> tuple[np.typing.NDArray[np.uint64], np.typing.NDArray[np.uint64]]:
        """Returns the cycles since the last call and the hash of the state after each."""
        return self._core.take_hashes()

    def _submit(self, feedback: Feedback) -> None:
        text = feedback.arguments
        ticket, error_id, sentence = self._core.submit(feedback.target, feedback.verb, text)
        feedback.ticket = ticket
        if error_id:
            self._report(feedback, 4, False, error_id, sentence, -1)
        else:
            self._unfinished[ticket] = feedback
            if self._journal is not None:
                self._waiting.append((ticket, 0.0, feedback.target, feedback.verb, text))

    def _release(self, feedback: Feedback) -> Feedback:
        release = super()._release(feedback)
        if feedback._release_is_refused:
            self._unreleased.append(feedback)
        return release

    def _value(self, component: Component, field: str) -> Any:
        kind = KINDS[component.KIND]
        value = self._core.value(component.index, kind.places[field])
        names = kind.names.get(field)
        return names[value] if names else value

    def _objects(self, belt: Belt) -> Iterable[tuple[Any, ...]]:
        return self._core.belt_objects(list(self.belts).index(belt.name))

    def _history(self, mover: Mover) -> Iterable[tuple[Any, ...]]:
        return self._core.mover_history(list(self.movers).index(mover.name))

    def _trail(self, mover: Mover) -> Iterable[int]:
        return self._core.mover_trail(list(self.movers).index(mover.name))

    def _route(self, mover: Mover) -> tuple[int, FloatArray]:
        return self._core.mover_route(list(self.movers).index(mover.name))

    def _track_at(self, track: Track, s: float) -> tuple[float, float, float, float]:
        return self._core.track_at(list(self.tracks).index(track.name), s)

    def _track_closest_to(self, track: Track, x: float, y: float) -> float:
        return self._core.track_closest_to(list(self.tracks).index(track.name), x, y)

    def _track_links(self, track: Track) -> tuple[list[int], list[int]]:
        return self._core.track_links(list(self.tracks).index(track.name))

    def _cam(self, number: int) -> Table:
        from takt.cam import Table

        return Table(self._core.cam(number))

    def cam(self, name: str) -> Table:
        self._check_open()
        number = self._core.cam_number(name)
        return self._cam(number) if number else super().cam(name)

    def _foresee(self, axis: Axis, verb: str, arguments: Mapping[str, Any]) -> Forecast:
        self._check_open()
        if not verb:
            return Forecast(self._core.foresee(axis.index), "")
        text = to_text(arguments, DEFAULTS.get((axis.KIND, verb)))
        core, sentence = self._core.foresee_command(axis.name, verb, text)
        return Forecast(core, sentence if core.error_id else "")

    def _step(self, cycles: int, until_feedback: bool) -> int:
        """Runs at least one and at most `cycles` cycles. Returns their number."""
        self._check_open()
        again, self._unreleased = self._unreleased, []
        for feedback in again:
            self._release(feedback)
        if self._programs:
            self._scan()
            now = self.cycle
            cycles = min(cycles, *(p.at_or_after(max(p.due, now + 1)) - now for p in self._programs))
        if self._unreleased:
            cycles = 1
        for recorder in self._recorders:
            for belt in recorder.belts:
                cycles = min(cycles, max(1, round(recorder.belt_objects.due_in(belt, self.now) / self.period)))
        while not (made := self._core.step(min(cycles, CHUNK), until_feedback)):
            self._warn()  # waiting for external drives; Ctrl-C is checked here, too
        self._warn()
        self._take_feedback()
        for recorder in self._recorders:
            for belt in recorder.belts:
                if recorder.belt_objects.is_due(belt, self.now):
                    recorder.belt_objects.look(belt, self.now, self._objects(self.belts[belt]))
        return made

    def _warn(self) -> None:
        for sentence in self._core.take_complaints():
            warnings.warn(sentence, DriveWarning, stacklevel=2)

    def _take_feedback(self) -> None:
        for ticket, cycle, state, reached, error_id, value, sentence, *place in self._core.take_feedback():
            feedback = self._unfinished.get(ticket)
            if feedback is None:
                continue
            self._report(feedback, state, reached, error_id, sentence, cycle, value, *place)
            if feedback._final:
                del self._unfinished[ticket]

    def _run(self, cycles: int) -> None:
        while cycles > 0:
            cycles -= self._step(cycles, False)

    def _wait_for(self, condition: Callable[[], bool], timeout: float, *, on_feedback: bool, every: int = 1) -> bool:
        left = math.ceil(timeout / self.period) if timeout < math.inf else CHUNK
        while not condition():
            if left <= 0:
                return False
            made = self._step(left if on_feedback else min(left, every), True)
            left -= made if timeout < math.inf else 0
        return True

    def _watch(self, fields: list[tuple[int, int]], every: int) -> _core.Watch:
        return self._core.start_watch(fields, every)

    def _has_changed(self, watch: _core.Watch) -> bool:
        return self._core.has_changed(watch)

    def _keep(self, watch: _core.Watch) -> None:
        self._core.keep(watch)

    def _begin(self, recorder: Recorder) -> None:
        indices = [self._components[name].index for name in recorder.components]
        self._core_recorders[recorder] = self._core.start_recorder(indices, recorder.every)

    def _finish(self, recorder: Recorder) -> Recording:
        core = self._core_recorders.pop(recorder)
        self._core.stop_recorder(core)
        cycles = core.cycles().astype(np.int64)
        base = {"time_s": cycles * self.period, "cycle": cycles}
        tables = {}
        for i, name in enumerate(recorder.components):
            rows = core.take_table(i)
            tables[name] = base | {f: rows[f] for f in fields_of_kind(self._components[name].KIND)}
        meta = {"source": "engine", "period_s": self.period, "version": _core.__version__}
        meta |= {"objects": recorder.belt_objects.columns(), **self._made_cams.kept()}
        recording = make_recording(self.machine, tables, recorder.events, meta, self.machine_text, self._folder)
        if self.plant is not None:
            self.plant.finish(recording)
        return recording


def _plant_of(
    plant: Plant | str | None, text: bytes, file_name: str, machine: Mapping[str, Any], period: float | None
) -> Plant | None:
    if plant is None or isinstance(plant, Plant):
        return plant
    if plant != "mujoco":
        raise TypeError(f'a plant is a takt.Plant or "mujoco", not {plant!r}')
    from takt.twin import Twin

    return Twin(text, file_name, machine, period)


def error_text(error_id: int) -> str:
    """Returns the meaning of an error number as text; "unknown error" for an unknown number."""
    return _ERRORS.get(error_id, ("", "unknown error"))[1]


def error_name(error_id: int) -> str:
    """Returns the short name of an error number ("Etime"); "" for an unknown number."""
    return _ERRORS.get(error_id, ("", ""))[0]


_ERRORS: dict[int, tuple[str, str]] = _core.error_texts()
