"""The command `takt path`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np
from rich.console import Console
from rich.table import Table as Grid

from takt import gcode, toolpath
from takt.counted import counted
from takt.names import shown
from takt.written import refuse_input


@dataclass(frozen=True)
class Options:
    """The options of the command line, by their names there."""

    start: toolpath.Point = (0.0, 0.0, 0.0)
    tolerance: float = toolpath.TOLERANCE
    csv: Path | None = None
    target: Path | None = None
    dialect: str | None = None
    leave_out: tuple[str, ...] = ()
    delete_blocks: bool = False
    offsets: tuple[tuple[str, str, str, str], ...] = ()
    parameters: tuple[str, ...] = ()
    subroutines: tuple[Path, ...] = ()

    def of_gcode(self) -> gcode.Options | None:
        """Returns how to read G-code; None if no option of G-code is given. Raises click.UsageError."""
        given = gcode.Options(
            self.dialect,
            self.leave_out,
            self.delete_blocks,
            {name: _numbers(f"--offset {name}", values) for name, *values in self.offsets},
            dict(map(_parameter, self.parameters)),
            self.subroutines,
        )
        return None if given == gcode.Options(subroutines=()) else given


def run(file: Path, options: Options, out: Console) -> int:
    """Reads, reports, draws and writes a path. Returns 0."""
    _refuse_nonsense(file, options)
    path = toolpath.read(file, options.start, options.tolerance, options.of_gcode())
    _say(file, path, out)
    if options.csv is not None:
        print(f"elements: {path.to_csv(options.csv)}")
    if options.target is not None:
        from takt.toolpath_picture import picture

        print(f"picture: {picture(path, options.target, shown(file.name))}")
    return 0


def _refuse_nonsense(file: Path, options: Options) -> None:
    from takt.plot import PICTURES

    if not 0 < options.tolerance <= 1:
        raise click.UsageError(f"--tolerance: expected a number of mm above 0, up to 1, found {options.tolerance:g}")
    for path, suffixes in ((options.target, PICTURES), (options.csv, (".csv",))):
        if path is None:
            continue
        if path.suffix not in suffixes:
            raise click.UsageError(f"{path}: expected a name that ends in {' or '.join(suffixes)}")
        if not path.parent.is_dir():
            raise click.UsageError(f"{path}: there is no directory {path.parent}")
        refuse_input(path, file)


def _say(file: Path, path: toolpath.Toolpath, out: Console) -> None:
    arcs = int(np.count_nonzero(path.is_arc))
    lines = len(path.elements) - arcs
    print(f"{file}: {counted(lines, 'line')} and {counted(arcs, 'arc')}, {path.length:.6g} mm")
    if path.elements:
        _say_elements(path, out)
    if path.read_as:
        print(f"read as: {path.read_as}")
    for word in path.left_out:
        print(f"left out: {word}")


def _say_elements(path: toolpath.Toolpath, out: Console) -> None:
    lengths = np.diff(path.at)
    quick = sum(float(length) for one, length in zip(path.elements, lengths, strict=True) if one.velocity is None)
    print(f"elements of {lengths.min():.4g} to {lengths.max():.4g} mm; {quick:.6g} mm at the velocity of the command")
    grid = Grid("", "begins", "ends", "least", "greatest", "", box=None)
    low, high = path.extents
    for axis, name in enumerate("XYZ"):
        ends = (path.start[axis], path.end[axis], low[axis], high[axis])
        grid.add_row(name, *(f"{value:.6g}" for value in ends), "mm")
    out.print(grid)
    feeds = sorted({one.velocity for one in path.elements if one.velocity is not None})
    if feeds:
        shown = ", ".join(f"{feed:.6g}" for feed in feeds[:8]) + (" ..." if len(feeds) > 8 else "")
        print(f"velocities: {shown} mm/s")


def _numbers(name: str, values: Sequence[str]) -> toolpath.Point:
    try:
        x, y, z = map(float, values)
    except ValueError:
        raise click.UsageError(f"{name}: expected three numbers of mm, found {' '.join(values)}") from None
    return (x, y, z)


def _parameter(text: str) -> tuple[str, float]:
    name, _, value = text.rpartition("=")
    try:
        return name, float(value)
    except ValueError:
        raise click.UsageError(f"--set: expected NAME=NUMBER, found '{text}'") from None
