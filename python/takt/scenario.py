"""Scenario files: modules with a function `scenario(session)`, which runs the motion, and usually
`verify(recording)`, which checks the recording. Optional functions: `pictures(recording)` returns further figures for
the report (Matplotlib figures by name); `results(recording)` returns the numbers of a run by name, for sweeps.

Optional constants:

EVERY: cycles from one sample of the recording to the next; default 1.
TAKES_S: approximate duration [s] of engine time.
VIEW: the initial state of the live page, as {"tab": "scope", "signals": ["x.set_position"]}.

Further arguments with defaults of these functions are the scenario's parameters. `takt run --set velocity=200` and
`takt sweep` set them; each function receives those that it has.

Scenarios run unchanged in virtual time and on a running engine. The machine is the one that the command line names, or
machine.yaml beside the file.
"""

from __future__ import annotations

import contextlib
import difflib
import importlib.util
import inspect
import os
import re
import sys
import sysconfig
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, get_args
from urllib.parse import urlencode

import numpy as np

from takt import expect
from takt.changes import text_of, value_of
from takt.errors import CommandError, TaktError, TimeoutError
from takt.failed_assertion import VERIFY, FailedAssertion
from takt.judging import asserts
from takt.names import shown
from takt.recording import Recording
from takt.routing import RoutingError
from takt.session import Session
from takt.source import IN_DIRECTORY
from takt.verdict import Verdict

if TYPE_CHECKING:
    from matplotlib.figure import Figure


PLAYED = "played"  # in the `meta` of recordings
TRUE, FALSE = {"true", "yes", "on"}, {"false", "no", "off"}  # as YAML spells them


class ScenarioError(TaktError):
    """A scenario file cannot be used."""


@dataclass(frozen=True)
class Scenario:
    path: Path
    title: str  # the first line of its doc string, or the file's name
    scenario: Callable[..., object]  # called with the session
    verify: Callable[..., object] | None  # called with the recording, like `pictures` and `results`
    pictures: Callable[..., Mapping[str, Figure]] | None = None
    every: int = 1  # cycles from one recorded sample to the next: EVERY in the file
    takes_s: float | None = None  # TAKES_S in the file
    results: Callable[..., Mapping[str, Any]] | None = None
    arguments: Mapping[str, Any] = field(default_factory=dict)  # values of parameters that override the defaults
    view: str = ""  # VIEW in the file, as the fragment (after #) of the live page's address

    def __repr__(self) -> str:
        return f"<Scenario {self.path}: {self.title}>"

    @property
    def machine(self) -> Path:
        """The machine file beside it."""
        return self.path.parent / "machine.yaml"

    def play(self, session: Session) -> None:
        """Runs the scenario. Raises ScenarioError if it calls exit()."""
        with _no_exit(self.path):
            self.scenario(session, **self._arguments_of(self.scenario))

    def draw(self, recording: Recording) -> Mapping[str, Figure]:
        """Returns the scenario's own figures of a recording by name; empty without `pictures`."""
        if self.pictures is None:
            return {}
        with _no_exit(self.path):
            return self.pictures(recording, **self._arguments_of(self.pictures))

    def judge(self, recording: Recording) -> object:
        """Returns the result of `verify`; None without one."""
        if self.verify is None:
            return None
        with _no_exit(self.path):
            return self.verify(recording, **self._arguments_of(self.verify))

    def numbers(self, recording: Recording) -> dict[str, Any]:
        """Returns the `results` of a recording by name; empty without `results`. Raises ScenarioError if they are not a
        mapping with names as keys."""
        if self.results is None:
            return {}
        with _no_exit(self.path):
            told = self.results(recording, **self._arguments_of(self.results))
        if not isinstance(told, Mapping) or not all(isinstance(name, str) for name in told):
            raise ScenarioError(f"{self.path}: results must return numbers by their names, found {told!r}")
        return dict(told)

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters with their defaults."""
        found: dict[str, Any] = {}
        for function in (self.results, self.pictures, self.verify, self.scenario):
            found |= _parameters(function) if function is not None else {}
        return found

    def with_arguments(self, arguments: Mapping[str, Any]) -> Scenario:
        """Returns the scenario with other values of parameters, each of the type of its default: bool (also in the
        spellings of YAML, and 0 and 1), int, float, str. A parameter with an int as default takes any number if it is
        annotated as float. Raises ScenarioError for values of other types and unknown names."""
        known = self.parameters
        for name in arguments:
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1)
                hint = f"; did you mean '{near[0]}'?" if near else ""
                has = f"it has {', '.join(known)}" if known else "its functions have no arguments with defaults"
                more = "keys of the machine file are paths, as axes.x.limits.velocity"
                raise ScenarioError(f"{self.path}: has no parameter '{name}'{hint} ({has}; {more})")
        given = {name: self._like(name, value, known[name]) for name, value in arguments.items()}
        return replace(self, arguments={**self.arguments, **given})

    @property
    def texts(self) -> frozenset[str]:
        """The parameters whose defaults are texts."""
        return frozenset(name for name, default in self.parameters.items() if isinstance(default, str))

    def _like(self, name: str, value: Any, default: Any) -> Any:
        """Returns the value as the type of the default. Raises ScenarioError if it cannot be converted."""
        if isinstance(value, np.generic):
            value = value.item()
        number = isinstance(value, int | float) and not isinstance(value, bool)
        hint = ""
        if isinstance(default, bool):
            if isinstance(value, bool) or (number and value in (0, 1)):
                return bool(value)
            if isinstance(value, str) and value.lower() in TRUE | FALSE:
                return value.lower() in TRUE
            expected = "true or false"
        elif isinstance(default, str):
            if isinstance(value, str):
                return value
            expected = "a text"
        elif isinstance(default, float) or (isinstance(default, int) and self._is_float(name)):
            if number:
                return float(value)
            expected = "a number"
        elif isinstance(default, int):
            if number and float(value).is_integer():
                return int(value)
            expected = f"a whole number, as its default {default} is one" if number else "a whole number"
            hint = f"; {float(default)} as default takes any number" if number else ""
        else:
            return value
        shown = repr(value) if isinstance(value, str) else text_of(value)
        raise ScenarioError(f"{self.path}: {name}: expected {expected}, found {shown}{hint}")

    def _is_float(self, name: str) -> bool:
        """Returns whether any of the functions annotates a parameter as float, alone or in a union."""
        functions = (self.scenario, self.verify, self.pictures, self.results)
        found = [getattr(function, "__annotations__", {}).get(name) for function in functions if function is not None]
        return any(
            kind is float or float in get_args(kind) or (isinstance(kind, str) and re.search(r"\bfloat\b", kind))
            for kind in found
        )

    def _arguments_of(self, function: Callable[..., object]) -> dict[str, Any]:
        if not self.arguments:
            return {}
        return {name: value for name, value in self.arguments.items() if name in _parameters(function)}


@dataclass(frozen=True)
class Outcome:
    recording: Recording
    verdicts: tuple[Verdict, ...]
    assertion: Verdict | None = None  # for a failed plain `assert`, a refused command, or a missing assertion

    def __repr__(self) -> str:
        failed = sum(not verdict.passed for verdict in self.verdicts)
        passed, failed = len(self.verdicts) - failed, failed + (self.assertion is not None)
        return f"<Outcome: {passed} passed, {failed} failed; {self.recording!r}>"

    def _repr_html_(self) -> str:
        from takt.notebook import outcome_table

        return outcome_table(self)

    @property
    def complaint(self) -> str:
        """The sentence of `assertion`; empty if there is none."""
        return self.assertion.sentence if self.assertion is not None else ""

    @property
    def passed(self) -> bool:
        return self.assertion is None and all(verdict.passed for verdict in self.verdicts)


def load_scenario(path: str | os.PathLike[str]) -> Scenario:
    """Imports a scenario file and returns its scenario. Raises ScenarioError if the file does not exist or does not
    have the required form."""
    file = Path(path)
    if not file.is_file():
        raise ScenarioError(f"{file}: there is no such file")
    spec = importlib.util.spec_from_file_location(f"takt_scenario_{file.stem}", file)
    if spec is None or spec.loader is None:
        raise ScenarioError(f"{file}: is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses and pickle look it up there
    with modules_of(file.resolve().parent), _no_exit(file):
        try:
            spec.loader.exec_module(module)
        except BaseException:
            sys.modules.pop(spec.name, None)
            raise
    scenario: Any = getattr(module, "scenario", None)
    verify: Any = getattr(module, "verify", None)
    pictures: Any = getattr(module, "pictures", None)
    results: Any = getattr(module, "results", None)
    if not callable(scenario):
        raise ScenarioError(f"{file}: has no function scenario(session)")
    for name, function, argument in (
        ("scenario", scenario, "session"),
        ("verify", verify, "recording"),
        ("pictures", pictures, "recording"),
        ("results", results, "recording"),
    ):
        if function is None:
            continue
        if not callable(function):
            raise ScenarioError(f"{file}: {name} is no function")
        if not _takes_one(function):
            raise ScenarioError(f"{file}: {name} must take one argument, {name}({argument})")
    every: Any = getattr(module, "EVERY", 1)
    if not isinstance(every, int) or every < 1:
        raise ScenarioError(f"{file}: EVERY must be a whole number of cycles from 1 on, found {every!r}")
    takes_s: Any = getattr(module, "TAKES_S", None)
    if takes_s is not None and (not isinstance(takes_s, (int, float)) or not 0 < takes_s < float("inf")):
        raise ScenarioError(f"{file}: TAKES_S must be a number of seconds above 0, found {takes_s!r}")
    lines = (module.__doc__ or "").strip().splitlines()
    title = lines[0].rstrip(".") if lines else shown(file.stem)
    view = _address(file, module)
    return Scenario(file, title, scenario, verify, pictures, every, takes_s, results, view=view)


def _address(file: Path, module: ModuleType) -> str:
    """Returns VIEW of a scenario file as the fragment of the live page's address."""
    match getattr(module, "VIEW", {}):
        case dict() as view if view.keys() <= {"tab", "signals"}:
            tab, signals = view.get("tab", ""), view.get("signals", ())
            if isinstance(tab, str) and isinstance(signals, (list, tuple)) and all(isinstance(s, str) for s in signals):
                chosen = {"tab": tab, "signals": ",".join(signals)}
                return urlencode({key: text for key, text in chosen.items() if text}, safe=",")
    raise ScenarioError(f'{file}: VIEW must be like {{"tab": "scope", "signals": ["x.set_position"]}}')


def settings_of(given: Sequence[str]) -> dict[str, str]:
    """Returns the values of texts `KEY=VALUE` by key. Raises ScenarioError for other texts and repeated keys."""
    found: dict[str, str] = {}
    for text in given:
        key, equals, value = text.partition("=")
        if not key or not equals:
            raise ScenarioError(f"'{text}': expected KEY=VALUE, as velocity=200")
        if key in found:
            raise ScenarioError(f"'{key}' is set twice")
        found[key] = value
    return found


def with_settings(scenario: Scenario, settings: Mapping[str, Any]) -> tuple[Scenario, dict[str, Any]]:
    """Returns the scenario with these values of its parameters, and the changes of the machine (keys with a dot). Texts
    are parsed as on a command line, except for parameters whose values are texts."""
    texts = scenario.texts
    values = {k: value_of(v) if isinstance(v, str) and k not in texts else v for k, v in settings.items()}
    changes = {key: value for key, value in values.items() if "." in key}
    return scenario.with_arguments({k: v for k, v in values.items() if k not in changes}), changes


_folders: set[Path] = set()  # of loaded scenarios


@contextlib.contextmanager
def modules_of(folder: Path) -> Iterator[None]:
    """A context in which modules in the folder of a scenario can be imported. Modules of other scenarios are removed
    from sys.modules: otherwise, say, a `judge` of theirs would be used instead of the one in this folder."""
    folder = folder.resolve()
    others = _folders - {folder}
    loaded = [(name, module) for name, module in sys.modules.items() if "." not in name] if others else []
    forgotten = {name for name, module in loaded if _root_of(module) in others}
    for name in [name for name in sys.modules if name.partition(".")[0] in forgotten - {"takt"}]:
        del sys.modules[name]
    _folders.add(folder)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))


def is_of_scenario(file: Path) -> bool:
    """Returns whether a file is in the folder of a loaded scenario and does not belong to packages installed in it.
    False for names in tracebacks that are not files, as `<frozen importlib._bootstrap>`."""
    if not file.is_file():
        return False
    file = file.resolve()
    installed = {"site-packages", "dist-packages"} & {*file.parts} or file.is_relative_to(sysconfig.get_path("stdlib"))
    return not installed and any(file.is_relative_to(folder) for folder in _folders)


def _root_of(module: Any) -> Path | None:
    """Returns the folder from which a module or package was imported; None if it has no file."""
    if path := list(getattr(module, "__path__", ())):
        return Path(path[0]).parent
    place = getattr(module, "__file__", None)
    return Path(place).parent if isinstance(place, str) else None


def run_scenario(scenario: Scenario, session: Session, directory: Path | None = None) -> Outcome:
    """Runs a scenario with all components recorded, then calls `verify`. Returns the outcome.

    directory: where the recording is saved, also if the scenario breaks off; None: nowhere.
    """
    recorder = session.record(every=scenario.every)
    played = Played()
    try:
        played = play(scenario, session)
    finally:
        recording = recorder.stop()
        played.keep(recording)
        if directory is not None:
            recording.save(directory / IN_DIRECTORY)
    return verify_recording(scenario, recording)


@dataclass(frozen=True)
class Played:
    """How the run of a scenario ended."""

    broken_off: FailedAssertion | None = None  # by a plain `assert`, a failed command, or a timeout
    ignored: FailedAssertion | None = None  # refused commands whose feedback the scenario did not read

    def keep(self, recording: Recording) -> None:
        """Stores this in `meta` of the recording, where verify_recording reads it."""
        complaints = {"broken_off": self.broken_off, "ignored": self.ignored}
        recording.meta[PLAYED] = {name: one.told() for name, one in complaints.items() if one is not None}

    @staticmethod
    def of(recording: Recording) -> Played:
        """Returns what `keep` stored in a recording."""
        told = recording.meta.get(PLAYED) or {}
        return Played(**{name: FailedAssertion.again(one) for name, one in told.items()})


def play(scenario: Scenario, session: Session) -> Played:
    """Runs a scenario and returns how it ended. A failed plain `assert`, an error of a command that it waits for, a
    timeout and a routing error end it early."""
    before = set(map(id, session.unheeded))
    try:
        scenario.play(session)
    except AssertionError as error:
        return Played(FailedAssertion.of(error, scenario.path, session.now))
    except (CommandError, TimeoutError, RoutingError) as error:
        return Played(FailedAssertion.of_broken(error, scenario.path, session.now))
    ignored = [feedback for feedback in session.unheeded if id(feedback) not in before]
    return Played(ignored=FailedAssertion.of_ignored(ignored, scenario.path))


def verify_recording(scenario: Scenario, recording: Recording) -> Outcome:
    """Calls `verify` with a recording from any source, unless its scenario broke off. Returns the outcome. Refused
    commands that the scenario ignored become the outcome's `assertion`; a complaint about `verify` is then a
    verdict."""
    played = Played.of(recording)
    if played.broken_off is not None:
        return Outcome(recording, (), played.broken_off.verdict(recording))
    complaint = None
    with expect.collect() as verdicts:
        try:
            complaint = _judge(scenario, recording, verdicts)
        except AssertionError as error:
            complaint = FailedAssertion.of(error, scenario.path)
    verdict = complaint.verdict(recording) if complaint is not None else None
    if played.ignored is not None:
        judged = (verdict, *verdicts) if verdict is not None else tuple(verdicts)
        return Outcome(recording, judged, played.ignored.verdict(recording))
    return Outcome(recording, tuple(verdicts), verdict)


def _judge(scenario: Scenario, recording: Recording, verdicts: Sequence[Verdict]) -> FailedAssertion | None:
    """Calls `verify`. Returns a complaint if it returns False or has judged nothing, else None."""
    folder = scenario.path.parent
    if scenario.verify is None:
        if asserts(scenario.scenario, folder):
            return None
        return FailedAssertion(
            f"nothing was judged: {shown(scenario.path.name)} has no verify(recording)", None, name=VERIFY
        )
    answer = scenario.judge(recording)
    code = getattr(scenario.verify, "__code__", None)
    name = shown(scenario.path.name)
    where = f"{name}:{code.co_firstlineno}" if code else name
    if isinstance(answer, bool | np.bool_):
        return None if answer else FailedAssertion(f"verify returned False ({where})", None, name=VERIFY)
    if verdicts or asserts(scenario.verify, folder):
        return None
    return FailedAssertion(
        f"nothing was judged: verify has no assertion, and returns no True ({where})", None, name=VERIFY
    )


@contextlib.contextmanager
def _no_exit(path: Path) -> Iterator[None]:
    """Turns SystemExit of a scenario into ScenarioError: it has not been completed."""
    try:
        yield
    except SystemExit as error:
        raise ScenarioError(f"{path}: ended by exit({'' if error.code is None else error.code})") from None


def _parameters(function: Callable[..., object]) -> dict[str, Any]:
    """Returns the arguments with defaults of a function, except for its first argument."""
    try:
        arguments = list(inspect.signature(function).parameters.values())[1:]
    except (TypeError, ValueError):
        return {}
    return {one.name: one.default for one in arguments if one.default is not one.empty}


def _takes_one(function: Callable[..., object]) -> bool:
    try:
        inspect.signature(function).bind(None)
    except TypeError:
        return False
    return True
