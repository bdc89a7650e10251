"""The command `takt track`."""

from __future__ import annotations

import math
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table as Grid

from takt.track_layout import TrackLayout


def run(file: Path, target: Path | None, out: Console) -> int:
    """Reads, checks, says, draws."""
    from takt.plot import PICTURES

    if target is not None and target.suffix not in PICTURES:
        raise click.UsageError(f"{target}: expected a name that ends in {' or '.join(PICTURES)}")
    if target is not None and not target.parent.is_dir():
        raise click.UsageError(f"{target}: there is no directory {target.parent}")
    layout = TrackLayout(file)
    if not layout.tracks:
        raise click.UsageError(f"{file}: expected a section tracks, found a machine without")
    _say(file, layout, out)
    if target is not None:
        from takt.track_picture import picture

        print(f"picture: {picture(layout, target, file.name)}")
    return 0


def _say(file: Path, layout: TrackLayout, out: Console) -> None:
    total = sum(track.length for track in layout.tracks)
    print(f"{file}: {len(layout.tracks)} tracks, {total:.6g} mm")
    columns = ("track", "length", "least radius", "from", "to", "range at start", "range at end")
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
    print("all in mm")
