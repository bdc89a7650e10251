"""The command line `takt`."""

from __future__ import annotations

import contextlib
import os
import sys
import traceback
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource
from rich.progress import BarColumn, Progress, ProgressColumn, SpinnerColumn, Task, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

from takt import _core
from takt.counted import counted
from takt.drive import WATCHDOG, simulate
from takt.drives.commands import drives
from takt.ending import end_in_order, wait_until_ended
from takt.engine import Engine, read_machine
from takt.errors import ConfigError, TaktError
from takt.events import Progress as Share
from takt.figures import in_words
from takt.lcmlog import open_log, to_recording, write_log
from takt.missing import all_missing, troubles
from takt.names import shown
from takt.network import usual_url
from takt.opcua.command import opcua, opcua_user
from takt.plant import PlantError
from takt.recording import Recording, RecordingError
from takt.remote import connect
from takt.replay import replay as replay_log
from takt.scenario import (
    Outcome,
    is_of_scenario,
    load_scenario,
    run_scenario,
    settings_of,
    verify_recording,
    with_settings,
)
from takt.session import Session
from takt.source import read_run, stem_of
from takt.terminal import Output, any_output
from takt.written import write_text

if TYPE_CHECKING:
    from takt.sweep import sweeping

BAD_INPUT = 2
FAILED = 1

PACKAGE = Path(__file__).parent
DIFFERENCES = 10  # between two runs, printed at most

out = Output()
err = Output(stderr=True)


def _counted_from_0(_context: click.Context, _option: click.Parameter, number: int | None) -> int | None:
    if number is not None and number < 0:
        raise click.BadParameter(f"there is no run {number}: they are counted from 0")
    return number


FILE = click.Path(path_type=Path)
KEY = click.option("--key", type=FILE, help="File with the key of the engine [TAKT_KEY_FILE, else none].")
START = click.option(
    "--run",
    "start_number",
    type=int,
    callback=_counted_from_0,
    help="Which start of the engine, from 0 on, of several in a log [the last].",
)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(_core.__version__)
@click.option("--traceback", is_flag=True, expose_value=False, help="Show where an error comes from.")
def cli() -> None:
    """Motion engine: check machines, run scenarios, inspect recordings."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns the exit status. 0: success; 1: a check has failed; 2: bad input, reported in
    one line; 130: interrupted. The status does not depend on whether the output can be printed."""
    with any_output():
        return _main(arguments)


def _main(arguments: Sequence[str] | None) -> int:
    given = list(sys.argv[1:] if arguments is None else arguments)
    show_all = "--traceback" in given
    given = [argument for argument in given if argument != "--traceback"]
    try:
        return int(cli.main(args=given, prog_name="takt", standalone_mode=False) or 0)
    except click.exceptions.NoArgsIsHelpError as error:
        print(error.format_message())
        return 0
    except click.ClickException as error:
        return _complain(error.format_message())
    except (click.Abort, KeyboardInterrupt):
        return 130
    except ConfigError as error:
        if show_all:
            traceback.print_exc()
        print("\n".join(error.problems), file=sys.stderr)
        return BAD_INPUT
    except Exception as error:
        if show_all:
            traceback.print_exc()
        return _complain(_sentence(error))


def _complain(sentence: str) -> int:
    print(f"takt: {' '.join(sentence.split())}", file=sys.stderr)
    return BAD_INPUT


def _sentence(error: Exception) -> str:
    """Returns an error as one line: the text of this package's own exceptions; for others also their type and source
    line."""
    if isinstance(error, (TaktError, RecordingError)):
        return str(error)
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    frames = [(Path(frame.filename), frame.lineno) for frame in traceback.extract_tb(error.__traceback__)]
    # Prefer a line of the scenario to one of this package, and that to one of another package.
    places = [frame for frame in frames if is_of_scenario(frame[0])]
    places = places or [frame for frame in frames if frame[0].is_relative_to(PACKAGE)]
    place = f" ({os.path.relpath(places[-1][0])}:{places[-1][1]})" if places else ""
    return f"{type(error).__name__}: {error}{place}"


# --- commands ---


@cli.command()
@click.argument("machines", nargs=-1, required=True, type=FILE)
def check(machines: tuple[Path, ...]) -> int:
    """Report all errors of machine files, and warnings."""
    bad = False
    for machine in machines:
        try:
            for warning in _core.check_machine(*read_machine(machine)):
                print(warning)
            print(f"{machine}: ok")
        except ConfigError as error:
            bad = True
            print("\n".join(error.problems), file=sys.stderr)
    return BAD_INPUT if bad else 0


@cli.command()
def schema() -> None:
    """Print the JSON Schema of machine files."""
    print(_core.schema())


@cli.command()
@click.option("-o", "--output", type=FILE, help="Write it into this file (.md) instead.")
def reference(output: Path | None) -> None:
    """Print the reference page: machine file, commands, published values, states and errors, as Markdown."""
    from takt.reference import reference_page

    if output is None:
        print(reference_page(), end="")
    else:
        write_text(output, reference_page())
        print(output)


@cli.command()
@click.argument("file", type=FILE)
@click.option("--machine", type=FILE, help="Run on this machine in virtual time [machine.yaml beside FILE].")
@click.option("--url", help="Run on the engine of this LCM network (taktd) instead.")
@click.option("--report", type=FILE, help="Write report.html, pictures and the recording into this directory.")
@click.option(
    "--set", "settings", multiple=True, metavar="KEY=VALUE", help="A parameter of the scenario, or axes.x.limits.jerk."
)
@KEY
def run(
    file: Path,
    machine: Path | None,
    url: str | None,
    report: Path | None,
    settings: tuple[str, ...],
    key: Path | None,
) -> int:
    """Run a scenario FILE, or that of a ready machine by its name, and verify the recording; in virtual time or on a
    running engine."""
    from takt.ready import scenario_of

    if machine is not None and url is not None:
        raise click.UsageError("--machine is for virtual time, --url for a running engine: give one of them")
    scenario, changes = with_settings(load_scenario(scenario_of(str(file))), settings_of(settings))
    if changes and url is not None:
        raise click.UsageError(f"{next(iter(changes))}: keys of the machine file can be set in virtual time only")
    if url is not None:
        session: Session = connect(url, key=key)
    else:
        session = Engine(machine or scenario.machine, key=key, changes=changes)
    with session, _watching(session, scenario.title):
        outcome = run_scenario(scenario, session, report)
        figures = session.figures
    page = None
    try:
        if report is not None:
            from takt.report.command import write_outcome

            page = write_outcome(outcome, scenario, report, figures).html
    finally:
        _show(outcome)
    if page is not None:
        print(f"report: {page}")
    return 0 if outcome.passed else FAILED


@cli.command("sweep")
@click.argument("file", type=FILE)
@click.option("--grid", multiple=True, metavar="KEY=LOW:HIGH:COUNT", help="Even values; or KEY=A,B,C.")
@click.option("--sample", multiple=True, metavar="KEY=LAW:...:COUNT", help="Drawn: uniform:1:2:100, normal:0:0.1:100.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of what is drawn.")
@click.option("--machine", type=FILE, help="The machine [machine.yaml beside FILE].")
@click.option("-o", "--output", type=FILE, help="Directory of table and page [sweeps/FILE].")
@click.option("--workers", type=click.IntRange(1, 1024), help="Processes [one a processor].")
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="Run on the workers of this scheduler of Dask instead.")
@click.option("--stop-after", type=click.IntRange(0), metavar="RUNS", help="So many runs now; later it goes on.")
@click.option("--timeout", default=600.0, show_default=True, type=click.FloatRange(0.1), help="s that a run may take.")
@click.option("--fresh", is_flag=True, help="Begin again [go on with what is there].")
def run_sweep(
    file: Path,
    grid: tuple[str, ...],
    sample: tuple[str, ...],
    seed: int,
    machine: Path | None,
    output: Path | None,
    workers: int | None,
    scheduler: str | None,
    stop_after: int | None,
    timeout: float,
    fresh: bool,
) -> int:
    """Run a scenario FILE many times with different values of its parameters and of the machine file. Writes a table
    with a row per run, and a page. The same command continues an interrupted sweep. Exit code 1: a run failed."""
    from takt.sweep import sweep

    with _bar(f"sweep {file.name}") as progress:
        result = sweep(
            file,
            grid,
            sample,
            output,
            machine=machine,
            seed=seed,
            workers=workers,
            scheduler=scheduler,
            stop_after=stop_after,
            timeout_s=timeout,
            fresh=fresh,
            progress=progress,
        )
    return _show_sweep(result)


@cli.command()
@click.argument("what", required=False, metavar="[NAME | FILE]")
@click.option("--machine", type=FILE, help="The machine [machine.yaml beside FILE].")
@click.option("--report", type=FILE, default=Path("reports/demo"), show_default=True, help="Where everything goes.")
@click.option("--pace", type=click.Choice(["real", "paced"]), default="real", show_default=True, help="Of taktd.")
@click.option("--view", is_flag=True, help="Open the live page beside it (takt view).")
@click.option("--port", default=0, type=click.IntRange(0, 65535), help="Of the page [any].")
@click.option("--browser/--no-browser", default=True, help="Open the page in the browser.")
@click.option("--stay/--no-stay", default=None, help="Keep engine and page until Ctrl-C [on a terminal].")
def demo(
    what: str | None,
    machine: Path | None,
    report: Path,
    pace: str,
    view: bool,
    port: int,
    browser: bool,
    stay: bool | None,
) -> int:
    """Run a ready machine by its NAME, or a scenario FILE, on a taktd of its own, in real time over LCM; verify the log
    of the network; write a report. Without NAME: list the ready machines."""
    from takt.ready import EXAMPLES, listing

    if what is None:
        out.print(listing())
        _say(f"\nOne to begin with: takt demo one_axis --view\nThe files of all: {EXAMPLES}")
        _say("With drives on a field bus, emulated ones: takt demo real_drives")
        return 0
    if what == "real_drives":
        from takt.drives import demonstration

        if click.get_current_context().get_parameter_source("pace") is not ParameterSource.COMMANDLINE:
            pace = "paced"  # real time would need top priority for three Python processes
        with demonstration.machine_file(EXAMPLES / demonstration.OF, _say) as file:
            return _demo(demonstration.OF, machine or file, report, pace, view, port, browser, stay, drives=True)
    return _demo(what, machine, report, pace, view, port, browser, stay)


def _demo(
    what: str,
    machine: Path | None,
    report: Path,
    pace: str,
    view: bool,
    port: int,
    browser: bool,
    stay: bool | None,
    *,
    drives: bool = False,
) -> int:
    """drives: also runs emulated drives, and the process between them and the engine."""
    from takt.demo import nothing, run_demo
    from takt.ready import scenario_of
    from takt.report.command import write_outcome
    from takt.view.command import Beside

    scenario = load_scenario(scenario_of(what))
    of = machine or scenario.machine
    page = Beside(scenario.view, port, browser, _say, of) if view else None
    stays = page is not None and (sys.stdin.isatty() if stay is None else stay)

    def judged(outcome: Outcome, figures: Mapping[str, Any]) -> None:
        try:
            written = write_outcome(outcome, scenario, report, figures).html
        finally:
            _show(outcome)
            _show_figures(in_words(figures))
        _say(f"report: {written}")
        if page is not None and stays:
            page.stay()
        else:
            _say("its journal runs again ...")

    @contextlib.contextmanager
    def beside(url: str) -> Iterator[None]:
        from takt.drives.demonstration import processes

        with processes(of, url, report, _say) if drives else contextlib.nullcontext(), (page or nothing)(url):
            yield

    result = run_demo(scenario, of, report, _say, pace, beside, judged, stays)
    if result.replayed is not None:
        _show_figures({"journal": result.replayed.sentence})
    return 0 if result.passed else FAILED


@cli.command("report")
@click.argument("runs", nargs=-1, required=True, type=FILE, metavar="RUN [OTHER]")
@click.option("-o", "--output", type=FILE, help="The page (.html) [report.html in the directory; RUN.html].")
@click.option("--scenario", "judge", type=FILE, help="Judge it again with `verify` of this scenario.")
@click.option("--align", default="", metavar="start | EVENT", help="Two runs: what is at the same time [engine time].")
@START
def show_report(
    runs: tuple[Path, ...], output: Path | None, judge: Path | None, align: str, start_number: int | None
) -> int:
    """Write the report of a RUN as one self-contained HTML page: of a recording (.npz), an LCM log, or the directory
    that `takt run --report` or `takt demo` wrote. Exit code 1: the verification by --scenario has failed.

    With an OTHER run: the differences of the two in figures, verdicts and curves. --align start aligns their beginnings
    in time; the text of a mark or event aligns the first ones with this text.
    """
    from takt.report.command import judged, names_of, target_of, target_of_two, write_page

    if len(runs) > 2:
        raise click.UsageError(f"one run, or two to compare: {len(runs)} are given")
    if align and len(runs) == 1:
        raise click.UsageError("--align is for two runs")
    usual = target_of(runs[0]) if len(runs) == 1 else target_of_two(runs)
    target = _writable(output or usual, (".html",)) if all(run.exists() for run in runs) else Path()
    scenario = load_scenario(judge) if judge is not None else None
    passed, recordings = True, []
    for run in runs:
        recording = _read(run, start_number)
        if scenario is not None:
            outcome = verify_recording(scenario, recording)
            _show(outcome)
            recording, passed = judged(outcome, scenario), passed and outcome.passed
        recordings.append(recording)
    names = names_of(runs) if len(runs) == 2 else ("",)
    for name, recording in zip(names, recordings, strict=True):
        for sentence in troubles(recording):
            print(f"{name}: {sentence}" if name else sentence)
    if len(runs) == 1:
        print(f"report: {write_page(recordings[0], runs[0], target)}")
    else:
        _show_comparison(recordings, (names[0], names[-1]), align, target)
    return 0 if passed else FAILED


@cli.command()
@click.argument("what", required=False, metavar="[MACHINE | URL]")
@click.option("--port", default=8047, show_default=True, type=click.IntRange(0, 65535), help="Of the page; 0: any.")
@click.option("--browser/--no-browser", default=True, help="Open it in the browser.")
@click.option("--pace", type=click.Choice(["real", "paced"]), default="real", show_default=True, help="Of taktd.")
@KEY
def view(what: str | None, port: int, browser: bool, pace: str, key: Path | None) -> int:
    """Show an engine live in a page on this host: that of a MACHINE file, run on a taktd of its own, or the one on an
    LCM network [the default one]."""
    from takt.view import command

    return command.run(what, port, browser, pace, _say, key)


@cli.command()
@click.argument("what", required=False, metavar="[MACHINE | URL]")
@click.option("--port", default=8765, show_default=True, type=click.IntRange(0, 65535), help="Of the link; 0: any.")
@click.option("--pace", type=click.Choice(["real", "paced"]), default="real", show_default=True, help="Of taktd.")
@KEY
def foxglove(what: str | None, port: int, pace: str, key: Path | None) -> int:
    """Serve an engine's scene and signals live for Foxglove on this host: of a MACHINE file, run on a taktd of its own,
    or of the engine on an LCM network [the default one]."""
    from takt.view import foxglove as link

    return link.run(what, port, pace, _say, key)


@cli.command()
@click.argument("machine", type=FILE)
@click.option("--url", help="LCM network of the engine [machine file].")
@click.option("--axis", "axes", multiple=True, help="Only this axis; may be given again [all external drives].")
@click.option(
    "--watchdog", default=WATCHDOG, show_default=True, type=click.IntRange(1), help="Periods without a set point: off."
)
@click.option("--twin", is_flag=True, help="Axes of the machine's twin are in MuJoCo.")
@KEY
def plant(machine: Path, url: str | None, axes: tuple[str, ...], watchdog: int, twin: bool, key: Path | None) -> int:
    """Simulate the external drives of a MACHINE in this process, for an engine in another process."""
    return simulate(machine, url, axes, watchdog, key, twin=twin)


cli.add_command(drives)
cli.add_command(opcua)
cli.add_command(opcua_user)


@cli.command("twin")
@click.argument("what", type=FILE, metavar="MACHINE | NAME | SCENARIO")
@click.option("--scenario", type=FILE, help="The scenario [scenario.py beside the machine file].")
@click.option("--picture", type=FILE, help="Draw the twin at the end (.png).")
@click.option("--report", type=FILE, help="Write report.html, pictures and the recording into this directory.")
@click.option("--compare/--no-compare", default=True, help="Run it with the simulated servos, too.")
@click.option("--speed/--no-speed", default=True, help="Say how fast both were.")
def run_twin(
    what: Path, scenario: Path | None, picture: Path | None, report: Path | None, compare: bool, speed: bool
) -> int:
    """Run a scenario in the twin of its machine, with the mechanics in MuJoCo (section `twin` of the machine file).
    Checks tool positions, motor torques and contacts, and reports the differences from the simulated servos. Exit code
    1: a verdict of the scenario or of the twin has failed."""
    from takt.twin import command

    drawing = picture and _writable(picture, (".png",))
    machine, found = command.find(what, scenario)
    ran = command.run(machine, found, compare=compare, report=report)
    page = None
    try:
        if report is not None:
            from takt.report.command import write_outcome

            page = write_outcome(ran.outcome, found, report, {}).html
    finally:
        _show(ran.outcome)
        out.print(command.table(ran.judged))
    if speed:
        servo = f"; with simulated servos {ran.servo_cycles_s:,.0f}" if ran.servo_cycles_s else ""
        print(f"{ran.cycles_s:,.0f} cycles a second{servo}")
    if page is not None:
        print(f"report: {page}")
    if drawing:
        try:
            print(f"picture: {ran.twin.picture(drawing)}")
        except PlantError as error:  # only the picture is missing; the verdicts are complete
            print(error)
    return 0 if ran.outcome.passed else FAILED


@cli.group(context_settings={"help_option_names": ["-h", "--help"]})
def key() -> None:
    """Keys that engines, clients and drives share, so that no other program can give commands (docs/keys.md)."""


@key.command()
@click.argument("file", type=FILE)
def new(file: Path) -> None:
    """Write a key to a new FILE that only its owner may open: for taktd --key, takt --key, takt.connect(key=...), or
    TAKT_KEY_FILE in the environment."""
    from takt.keys import new_key

    new_key(file)
    print(file)


@cli.command()
@click.argument("kind", type=click.Choice(["frame", "belt"]))
@click.argument("file", type=FILE)
def calibrate(kind: str, file: Path) -> int:
    """Find the frame of a table, a camera or a belt from points measured with the tool.

    FILE is a table (CSV) with a header. frame: columns x, y, z of the measured origin, a point on X, a point towards Y;
    or, with columns seen_x, seen_y, seen_z, three or more points in any position. belt: columns position (of the belt's
    axis), x, y, z of one mark; and a row without a position for a point on the belt, towards its Y.
    """
    from takt import calibration_files

    for line in calibration_files.lines(kind, file):
        print(line)
    return 0


@cli.command()
@click.argument("axis")
@click.option("--machine", type=FILE, help="Tune on this machine in virtual time.")
@click.option("--url", type=str, help="Tune on the engine of this LCM network (taktd): the axis, which is on, moves!")
@click.option("--distance", type=float, required=True, help="Size of the steps, in the axis' unit; keep it small.")
@click.option("--watch", type=float, default=0.5, show_default=True, help="s to look at each step, at least.")
@click.option("--keep", is_flag=True, help="Leave the axis with the new gains [with those that it had].")
@click.option("--picture", "target", type=FILE, help="Draw the step responses before and after.")
@KEY
def tune(
    axis: str,
    machine: Path | None,
    url: str | None,
    distance: float,
    watch: float,
    keep: bool,
    target: Path | None,
    key: Path | None,
) -> int:
    """Find the gains of the position loop of AXIS with small steps near its current position."""
    from takt import tuning

    if (machine is None) == (url is None):
        raise click.UsageError("give either --machine or --url")
    drawing = target and _writable(target, (".png", ".svg"))
    session: Session = Engine(machine, key=key) if machine else connect(url, key=key)
    with session:
        found = session.axis(axis)
        if machine:
            found.power().wait()
        result = tuning.tune(session, found, distance, watch, out.print, keep=keep)
    print(f"before: {result.before.text}")
    print(f"after {counted(result.steps, 'step')}: {result.after.text}")
    if result.remark:
        print(f"but {result.remark}")
    print(result.yaml)
    if drawing:
        print(f"picture: {tuning.picture(result, drawing)}")
    return 0


@cli.command()
@click.argument("file", type=FILE)
@click.option("--url", help="Of this LCM network [the usual one].")
def record(file: Path, url: str | None) -> None:
    """Write all messages of an LCM network to FILE, an LCM log, until Ctrl-C. Unlike lcm-logger it drops no message
    that this host has received."""
    end_in_order()
    url = url or usual_url()
    with write_log(file, url), contextlib.suppress(KeyboardInterrupt):
        _say(f"{file} records {url}; Ctrl-C ends it")
        wait_until_ended()
    _say(f"{file}: {file.stat().st_size / 1e6:,.1f} MB")


@cli.command()
@click.argument("log", type=FILE)
@START
def replay(log: Path, start_number: int | None) -> int:
    """Replay the journal of a LOG of taktd and compare every cycle, bit for bit."""
    with _bar(f"replay {log.name}") as progress:
        result = replay_log(log, run=-1 if start_number is None else start_number, progress=progress)
    print(f"{log}: {result.sentence}")
    return 0 if result.same else FAILED


@cli.command()
@click.argument("file", type=FILE)
@click.argument("signals", nargs=-1)
@click.option("-o", "--output", type=FILE, help="The picture (.png, .svg, .pdf) [FILE.png].")
@click.option("--from", "start", type=float, help="s, where to begin.")
@click.option("--to", "end", type=float, help="s, where to end.")
@click.option("--title", help="Above the picture [FILE].")
@START
def plot(
    file: Path,
    signals: tuple[str, ...],
    output: Path | None,
    start: float | None,
    end: float | None,
    title: str | None,
    start_number: int | None,
) -> None:
    """Draw SIGNALS (x, x.set_position, "*.following_error") of a FILE: a recording (.npz) or an LCM log."""
    from takt import plot as plotting

    target = _writable(output or file.parent / f"{stem_of(file)}.png", plotting.PICTURES)
    recording = _read(file, start_number).between(start, end)
    window = None
    if start is not None or end is not None:
        window = (recording.start_s if start is None else start, recording.end_s if end is None else end)
    figure = plotting.draw(recording, *signals, title=title or shown(file.name), window=window)
    plotting.save(figure, target)
    for sentence in troubles(recording):
        print(sentence)
    print(target)


@cli.command()
@click.argument("run", type=FILE)
@click.argument("signals", nargs=-1)
@click.option("--mcap", type=FILE, help="Write MCAP (.mcap), for Foxglove and its like.")
@click.option("--csv", type=FILE, help="Write one wide table (.csv).")
@click.option("--parquet", type=FILE, help="Write the same table as Parquet (.parquet).")
@click.option("--from", "start", type=float, help="s, where to begin.")
@click.option("--to", "end", type=float, help="s, where to end.")
@START
def export(
    run: Path,
    signals: tuple[str, ...],
    mcap: Path | None,
    csv: Path | None,
    parquet: Path | None,
    start: float | None,
    end: float | None,
    start_number: int | None,
) -> None:
    """Write SIGNALS (x, x.set_position, "*.following_error") [all] of a RUN for other tools: of a recording (.npz), an
    LCM log, or the directory that `takt run --report` or `takt demo` wrote."""
    from takt.export import write

    files = ((mcap, ".mcap"), (csv, ".csv"), (parquet, ".parquet"))
    targets = [_writable(file, (suffix,)) for file, suffix in files if file is not None]
    if not targets:
        raise click.UsageError("give --mcap FILE, --csv FILE or --parquet FILE, or several of them")
    for sentence in write(_read(run, start_number), targets, signals, start, end):
        print(sentence)


@cli.command("cam")
@click.argument("file", type=FILE)
@click.option("--name", help="Which cam of a machine file [all].")
@click.option(
    "--interpolation",
    type=click.Choice(["linear", "quintic", "cubic_spline", "monotone"]),
    help="Points only [quintic].",
)
@click.option("--cyclic", is_flag=True, help="Points only: the end goes over into the beginning.")
@click.option("--units", nargs=2, metavar="X Y", help="Points only: the master's and the slave's, for people.")
@click.option("--columns", nargs=2, metavar="X Y", help="Points only: titles or numbers (from 1) of the columns.")
@click.option("--master-speed", type=float, help="Largest velocity of the master, its unit/s.")
@click.option("--master-acceleration", type=float, default=0.0, help="Largest acceleration of the master, its unit/s².")
@click.option("--axis", help="Hold the cam against the limits of this axis.")
@click.option("--machine", type=FILE, help="The machine file with the axis [FILE].")
@click.option("--plot", "target", type=FILE, help="Draw y and its derivatives into this file (.png, .svg, .pdf).")
@click.option("--csv", type=FILE, help="Write the points into this file.")
@click.option("--count", type=click.IntRange(2, 100_000), help="With --csv: so many points at even distances.")
@click.option("--yaml", "yaml_file", type=FILE, help="Write the cam into this file, as it stands in a machine file.")
def show_cam(file: Path, name: str | None, **options: Any) -> int:
    """Check the cam of a FILE: points or an export of another system (any name), one cam (.yaml) or the cams of a
    machine file. Reports its continuity and the peaks of its slave; draws and converts it. Exit code 1: a limit of the
    axis is exceeded."""
    from takt import cam_command

    columns = options.pop("columns")
    chosen = None
    if columns:
        chosen = {key: int(of) if of.isdecimal() else of for key, of in zip("xy", columns, strict=True)}
    return cam_command.run(file, name, cam_command.Options(columns=chosen, **options), out)


@cli.command("path")
@click.argument("file", type=FILE)
@click.option(
    "--start", nargs=3, type=float, default=(0.0, 0.0, 0.0), metavar="X Y Z", help="Where the tool is at first, mm."
)
@click.option("--tolerance", type=float, default=0.005, show_default=True, help="mm from curves to lines for them.")
@click.option("--plot", "target", type=FILE, help="Draw it as seen from above into this file (.png, .svg, .pdf).")
@click.option("--csv", type=FILE, help="Write its elements into this file, for the paths of a machine file.")
@click.option(
    "--dialect",
    type=click.Choice(["rs274", "linuxcnc", "fanuc", "grbl", "marlin"]),
    help="G-code only: [what the file tells].",
)
@click.option("--leave-out", multiple=True, metavar="WORDS", help="G-code only: words to leave out, such as M7,G41,A.")
@click.option("--delete-blocks", is_flag=True, help="G-code only: skip lines that begin with /.")
@click.option(
    "--offset",
    "offsets",
    multiple=True,
    nargs=4,
    metavar="G54 X Y Z",
    help="G-code only: where a coordinate system's zero lies on the machine, mm.",
)
@click.option(
    "--set", "parameters", multiple=True, metavar="NAME=NUMBER", help="G-code only: a parameter, by number or name."
)
@click.option(
    "--subroutines",
    multiple=True,
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="G-code only: a folder with files of subs.",
)
def show_path(file: Path, **options: Any) -> int:
    """Check the path of a FILE: G-code (.gcode, .nc, .ngc, .tap), a drawing (.svg) or elements (.csv). Reports its
    length, elements and extents; draws and converts it."""
    from takt import toolpath_command

    return toolpath_command.run(file, toolpath_command.Options(**options), out)


@cli.command("track")
@click.argument("file", type=FILE)
@click.option("--plot", "--draw", "target", type=FILE, help="Draw them from above into this file (.png, .svg, .pdf).")
@click.option("--corner", type=float, help="Drawings only: mm of the lines that a corner takes [40].")
@click.option("--yaml", "yaml_file", type=FILE, help="Drawings only: write them into this file.")
def show_track(file: Path, **options: Any) -> int:
    """Check the tracks of a FILE: a machine file, one with only the section `tracks`, or a drawing (.svg, .dxf).
    Reports lengths, least radii, links and collision ranges at switches; draws and converts them."""
    from takt import track_command

    return track_command.run(file, track_command.Options(**options), out)


@cli.command("log")
@click.argument("log", type=FILE)
@click.option("--save", type=FILE, help="Keep one run as a recording (.npz) or a table (.csv).")
@START
def show_log(log: Path, save: Path | None, start_number: int | None) -> int:
    """Summarise the content of an LCM LOG. Exit code 1: it is not whole; the missing parts are reported."""
    if save is not None:
        _writable(save, (".npz", ".csv"))
    with _bar(f"read {log.name}") as progress:
        content = open_log(log, progress)
    lost: Counter[str] = Counter()
    for one in content.runs:
        lost.update(one.sequences.lost())
    table = Table("channel", "messages", "lost", "not decoded", box=None)
    for channel, count in sorted(content.messages.items()):
        table.add_row(channel, *map(str, (count, lost[channel], content.malformed[channel])))
    out.print(table)
    for number, one in enumerate(content.runs):
        name = getattr(one.machine, "name", "") or "a machine"
        states = [s for states in one.states.values() for s in (states[0], states[-1])]
        period = one.machine.period_s if one.machine else 0.0
        span = (max(s.cycle for s in states) - min(s.cycle for s in states)) * period if states else 0.0
        journal = f"journal of {counted(len(one.journal), 'command')}" if one.start else "no journal"
        print(f"run {number}: {name}, {counted(len(one.states), 'component')}, {span:.3f} s, {journal}")
    if save is not None:
        recording = to_recording(content, -1 if start_number is None else start_number)
        if starts := recording.meta.get("starts"):
            print(starts)
        print(recording.to_csv(save) if save.suffix == ".csv" else recording.save(save))
    if content.trouble:
        print(content.trouble)
    return FAILED if content.trouble else 0


@cli.command()
@click.option("--machine", type=FILE, help="A machine file [made up].")
@click.option("--axes", default=6, type=click.IntRange(1, 10_000), help="How many axes the made up machine has.")
@click.option("--cycles", default=1_000_000, type=click.IntRange(1000), help="How many cycles to time.")
def bench(machine: Path | None, axes: int, cycles: int) -> None:
    """Measure the speed of virtual time, idle and moving, against the bare C++ loop."""
    from takt.benchmark import measure

    with _bar("bench") as progress:
        results = measure(machine, axes, cycles, progress)
    table = Table("axes", "cycles/s", "ns/cycle", "times real time", "to the C++ loop", box=None)
    for r in results:
        table.add_row(r.name, f"{r.cycles_s:,.0f}", f"{1e9 / r.cycles_s:.0f}", f"{r.pace:,.0f}", f"{r.ratio:.2f}")
    out.print(table)


# --- shared helpers ---


def _say(sentence: str) -> None:
    """Prints a sentence and flushes the output."""
    click.echo(sentence)


def _read(file: Path, start_number: int | None) -> Recording:
    """Returns the recording in a file or directory; an LCM log is converted to one."""
    with _bar(f"read {file.name}") as progress:
        return read_run(file, progress, start_number)


def _writable(target: Path, suffixes: Sequence[str]) -> Path:
    """Returns the target. Raises click.UsageError for a wrong suffix or a missing directory, before work is done."""
    if target.suffix not in suffixes:
        raise click.UsageError(f"{target}: expected a name that ends in {' or '.join(suffixes)}")
    if not target.parent.is_dir():
        raise click.UsageError(f"{target}: there is no directory {target.parent}")
    return target


def _show(outcome: Outcome) -> None:
    table = Table("", "check", "", box=None, show_header=False)
    for verdict in (*([outcome.assertion] if outcome.assertion is not None else []), *outcome.verdicts):
        mark = Text("passed", "green") if verdict.passed else Text("failed", "bold red")
        table.add_row(mark, Text(verdict.title), Text(verdict.sentence))
    out.print(table)
    passed = sum(verdict.passed for verdict in outcome.verdicts)
    failed = len(outcome.verdicts) - passed + (outcome.assertion is not None)
    lacks = all_missing(outcome.recording)
    whole = f"; missing: {lacks}" if lacks else ", no sample missing"
    print(f"{passed} passed, {failed} failed; {outcome.recording.duration_s:.3f} s of engine time{whole}")


def _show_comparison(recordings: Sequence[Recording], names: tuple[str, str], align: str, target: Path) -> None:
    from takt.report import compare, write_comparison

    comparison = compare(recordings[0], recordings[1], names, align=align)
    write_comparison(comparison, target)
    for difference in comparison.differing[:DIFFERENCES]:
        print(difference.sentence)
    print(comparison.sentence)
    print(f"report: {target}")


def _show_sweep(result: sweeping.Result) -> int:
    summary = result.summary
    reasons = sorted(summary.reasons.items(), key=lambda item: -item[1][0])
    for reason, (count, first, command) in reasons[:DIFFERENCES]:
        print(f"failed: {counted(count, 'run')}: {reason}; the first one is run {first}: {command}")
    rest = summary.size - summary.runs
    more = f", {counted(rest, 'run')} not made yet: the same command goes on" if rest else ""
    print(f"{summary.passed:,} passed, {summary.failed:,} failed{more}")
    if not result.repeats:
        print("the same run gave other results when it was made again: what is random must come from --sample")
    if result.made:
        print(f"{counted(result.made, 'run')} made, {60 * result.made / max(result.elapsed_s, 1e-9):,.0f} a minute")
    print(f"table: {result.table}")
    if result.parquet:
        print(f"table: {result.parquet}")
    elif summary.runs:
        print("Parquet, too, with: pip install pyarrow")
    print(f"page: {result.page}")
    return FAILED if summary.failed else 0


def _show_figures(rows: Mapping[str, str]) -> None:
    table = Table(box=None, show_header=False)
    for name, value in rows.items():
        table.add_row(name, value)
    out.print(table)


class _EngineTime(ProgressColumn):
    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session

    def render(self, task: Task) -> Text:
        return Text(f"{self._session.now:.1f} s of engine time")


@contextlib.contextmanager
def _watching(session: Session, title: str) -> Iterator[None]:
    """Shows the progress of engine time on a terminal."""
    columns: Any = (SpinnerColumn(), TextColumn("{task.description}"), _EngineTime(session), TimeElapsedColumn())
    with Progress(*columns, console=err, transient=True, disable=not err.is_interactive) as progress:
        progress.add_task(title, total=None)
        yield


@contextlib.contextmanager
def _bar(title: str) -> Iterator[Share]:
    """Shows a progress bar on a terminal. Yields a function to call with the progress, 0 to 1."""
    share = TextColumn("{task.percentage:3.0f} %")
    columns: Any = (TextColumn("{task.description}"), BarColumn(), share, TimeElapsedColumn())
    with Progress(*columns, console=err, transient=True, disable=not err.is_interactive) as progress:
        task = progress.add_task(title, total=1.0)
        yield lambda share: progress.update(task, completed=share)
