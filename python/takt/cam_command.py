"""The command `takt cam`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import click
import yaml
from rich.console import Console
from rich.table import Table as Grid
from rich.text import Text

from takt import cam
from takt.cam_check import TOUCHING, Check, Limits, check, figure
from takt.counted import counted
from takt.engine import read_machine
from takt.written import refuse_input
from takt.yaml_text import load

FAILED = 1
NAMES = (("y", ""), ("y'", ""), ("y''", "²"), ("y'''", "³"))


@dataclass(frozen=True)
class Options:
    """The options of the command line, by their names there."""

    interpolation: cam.Interpolation | None = None
    cyclic: bool = False
    units: tuple[str, str] | None = None
    columns: Mapping[str, str | int] | None = None
    master_speed: float | None = None
    master_acceleration: float = 0.0
    axis: str | None = None
    machine: Path | None = None
    target: Path | None = None
    csv: Path | None = None
    count: int | None = None
    yaml_file: Path | None = None


def run(file: Path, name: str | None, options: Options, out: Console) -> int:
    """Reads, checks, reports, draws and writes cams. Returns 1 if a limit is exceeded, else 0."""
    _refuse_nonsense(file, options)
    tables = _read(file, name, options)
    writes = options.target or options.csv or options.yaml_file
    if writes and len(tables) > 1:
        names = ", ".join(table.name for table in tables)
        raise click.UsageError(f"{file} has the cams {names}: choose one with --name")
    limits = None
    if options.axis is not None:
        if options.machine is None and not _is_machine(file):
            raise click.UsageError(f"--axis needs --machine where FILE is a cam, as {file} is")
        limits = Limits.of_axis(options.machine or file, options.axis)
    passed = True
    for table in tables:
        result = check(table, options.master_speed, options.master_acceleration, limits)
        _say(table, result, options, out)
        passed &= result.passed
    if writes:
        _write(tables[0], options, limits)
    return 0 if passed else FAILED


def _refuse_nonsense(file: Path, options: Options) -> None:
    from takt.plot import PICTURES

    for value, option in ((options.master_speed, "speed"), (options.master_acceleration, "acceleration")):
        if value is not None and not 0 <= value < math.inf:
            raise click.UsageError(f"--master-{option}: expected a number of at least 0, found {value:g}")
    if options.machine is not None and options.axis is None:
        raise click.UsageError("--machine is where the limits come from: say of which --axis")
    if options.count is not None and options.csv is None:
        raise click.UsageError("--count is for --csv")
    for path, suffixes in ((options.target, PICTURES), (options.csv, None), (options.yaml_file, None)):
        if path is None:
            continue
        if suffixes and path.suffix not in suffixes:
            raise click.UsageError(f"{path}: expected a name that ends in {' or '.join(suffixes)}")
        if not path.parent.is_dir():
            raise click.UsageError(f"{path}: there is no directory {path.parent}")
        refuse_input(path, file, options.machine, *_named_by(file), *_named_by(options.machine))


def _named_by(machine: Path | None) -> Iterator[Path]:
    """Returns the files that a machine file names (points, elements, kinematics, shapes); none if it cannot be
    read."""
    if machine is None or not _is_machine(machine):
        return
    try:
        waiting = [load(read_machine(machine)[0].decode())]
    except (yaml.YAMLError, ValueError):
        return
    seen: set[int] = set()  # aliases lead to the same value again
    while waiting:
        value = waiting.pop()
        if id(value) in seen or not isinstance(value, (dict, list)):
            continue
        seen.add(id(value))
        waiting += value.values() if isinstance(value, dict) else value
        if isinstance(value, dict):
            names = (value.get(key) for key in ("file", "urdf"))
            yield from (machine.parent / name for name in names if isinstance(name, str) and "<" not in name)


def _read(file: Path, name: str | None, options: Options) -> list[cam.Table]:
    if file.suffix not in (".yaml", ".yml"):
        x_unit, y_unit = options.units or (None, None)
        return [
            cam.Table.from_file(
                file,
                columns=options.columns,
                name=name,
                interpolation=options.interpolation,
                cyclic=options.cyclic,
                x_unit=x_unit,
                y_unit=y_unit,
            )
        ]
    if options.interpolation or options.cyclic or options.units or options.columns:
        what = "--interpolation, --cyclic, --units and --columns"
        raise click.UsageError(f"{what} are for files of points; a YAML file says them itself")
    text, _ = read_machine(file)
    tables = cam.of_machine(file) if cam.is_machine(text) else [cam.Table.from_yaml(file)]
    if not tables:
        raise click.UsageError(f"{file}: expected a cam, found a machine without cams")
    chosen = [table for table in tables if name in (None, table.name)]
    if not chosen:
        raise click.UsageError(f"{file}: expected a cam of {', '.join(t.name for t in tables)}, found '{name}'")
    return chosen


def _is_machine(file: Path) -> bool:
    return file.suffix in (".yaml", ".yml") and cam.is_machine(read_machine(file)[0])


def _say(table: cam.Table, result: Check, options: Options, out: Console) -> None:
    u = table.x_unit
    source = f"{counted(len(table.points.x), 'point')}, {table.source['interpolation'].replace('_', ' ')}"
    if not len(table.points.x):
        source = f"{counted(len(table.source['segments']), 'segment')}"
    kind = "cyclic cam" if table.cyclic else "cam"
    span = f"x {table.begin:g} to {table.end:g} {u}, stroke {table.stroke:g} {table.y_unit}"
    print(f"{table.name}: {kind} of {source}; {span}")
    print(result.continuity)
    for warning in table.warnings:
        print(f"warning: {warning}")
    grid = Grid("", "unit", "least", "at x", "greatest", "at x", box=None)
    for (name, power), bounds in zip(NAMES, table.extremes(), strict=True):
        unit = table.y_unit if name == "y" else f"{table.y_unit}/{u}{power}"
        scale = max(abs(bounds.least.value), abs(bounds.greatest.value))
        cells = [figure(value, scale) for one in bounds for value in (one.value, one.x)]
        grid.add_row(name, unit, cells[0], figure(bounds.least.x), cells[2], figure(bounds.greatest.x))
    out.print(grid)
    if options.master_speed is not None:
        moving = f" and {options.master_acceleration:g} {u}/s²" if options.master_acceleration else ""
        print(f"slave, with its master at up to {options.master_speed:g} {u}/s{moving}:")
    elif options.axis is not None:
        print("slave:")
    if options.master_speed is not None or options.axis is not None:
        out.print(_peaks(result))
    if options.axis is not None:
        print(_fastest(result, u))


def _peaks(result: Check) -> Grid:
    grid = Grid("", "most", "unit", "at x", "limit", "", box=None)
    for peak in result.peaks:
        verdict = Text("")
        if peak.limit is not None:
            verdict = Text("ok", "green") if peak.passed else Text("exceeded", "bold red")
        value = "a jump" if math.isinf(peak.value) else figure(peak.value, peak.slack / TOUCHING)
        limit = "" if peak.limit is None else figure(peak.limit)
        grid.add_row(peak.what, value, peak.unit, figure(peak.x), limit, verdict)
    return grid


def _fastest(result: Check, unit: str) -> str:
    if result.fastest is not None:
        found = result.fastest
        return f"the master may go up to {found.value:.6g} {unit}/s at constant velocity; x {found.x:.6g} decides"
    return "no velocity of the master suits the limits: " + result.continuity


def _write(table: cam.Table, options: Options, limits: Limits | None) -> None:
    if options.target is not None:
        from takt.cam_picture import picture

        print(f"picture: {picture(table, options.target, options.master_speed, limits)}")
    if options.csv is not None:
        if options.count is None and not len(table.points.x):
            raise click.UsageError("a cam of segments has no points: say how many the CSV file is to have (--count)")
        table.to_csv(options.csv, count=options.count)
        print(f"points: {options.csv}")
    if options.yaml_file is not None:
        table.to_yaml(options.yaml_file)
        print(f"cam: {options.yaml_file}")
