"""The command `takt track`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table as Grid

from takt.counted import counted
from takt.errors import ConfigError
from takt.names import shown
from takt.track_drawing import CORNER, DRAWINGS, read_drawing
from takt.track_layout import TrackLayout
from takt.written import refuse_input, write_text


@dataclass(frozen=True)
class Options:
    """The options of the command line, by their names there."""

    target: Path | None = None
    corner: float | None = None
    yaml_file: Path | None = None


def run(file: Path, options: Options, out: Console) -> int:
    """Reads, checks, reports, draws and writes tracks. Returns 0."""
    _refuse_nonsense(file, options)
    drawing = read_drawing(file, options.corner or CORNER) if file.suffix.lower() in DRAWINGS else None
    try:
        layout = TrackLayout(drawing.tracks if drawing else file, str(file))
    except ConfigError as error:
        if drawing is None:
            raise
        raise ConfigError([drawing.placed(file, problem) for problem in error.problems]) from None
    if not layout.tracks:
        raise click.UsageError(f"{file}: expected a section tracks, found a machine without")
    _say(file, layout, out)
    for what in drawing.left_out if drawing else ():
        print(f"left out: {what}")
    if options.target is not None:
        from takt.track_picture import picture

        print(f"picture: {picture(layout, options.target, shown(file.name))}")
    if drawing is not None and options.yaml_file is not None:
        write_text(options.yaml_file, drawing.tracks)
        print(f"tracks: {options.yaml_file}")
    return 0


def _refuse_nonsense(file: Path, options: Options) -> None:
    from takt.plot import PICTURES

    if options.corner is not None and not 0 < options.corner < math.inf:
        raise click.UsageError(f"--corner: expected a number of mm above 0, found {options.corner:g}")
    if file.suffix.lower() not in DRAWINGS and (options.corner or options.yaml_file):
        raise click.UsageError(f"--corner and --yaml are for drawings ({', '.join(DRAWINGS)})")
    for path, suffixes in ((options.target, PICTURES), (options.yaml_file, (".yaml", ".yml"))):
        if path is None:
            continue
        if path.suffix not in suffixes:
            raise click.UsageError(f"{path}: expected a name that ends in {' or '.join(suffixes)}")
        if not path.parent.is_dir():
            raise click.UsageError(f"{path}: there is no directory {path.parent}")
        refuse_input(path, file)


def _say(file: Path, layout: TrackLayout, out: Console) -> None:
    total = sum(track.length for track in layout.tracks)
    print(f"{file}: {counted(len(layout.tracks), 'track')}, {total:.6g} mm")
    columns = ("track", "length", "least radius", "from", "to", "at start", "at end")
    grid = Grid(*columns, box=None)
    for i in (1, 2, 5, 6):
        grid.columns[i].justify = "right"
    for track in layout.tracks:
        radius = f"{track.smallest_radius:.4g}" if track.smallest_radius < math.inf else "straight"
        before = "itself" if track.closed else ", ".join(track.previous) or "-"
        behind = "itself" if track.closed else ", ".join(track.subsequent) or "-"
        length = f"{track.length:.3f}" if track.length else "none yet"
        grid.add_row(
            track.name, length, radius, before, behind, f"{track.range_at_start:.1f}", f"{track.range_at_end:.1f}"
        )
    out.print(grid)
    print("all in mm; at start and at end: the collision ranges")
