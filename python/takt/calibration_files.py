"""Files of measured points for `takt calibrate`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from takt import calibrate
from takt.calibrate import Calibration, CalibrationError
from takt.csv_rows import Fields, read_rows
from takt.errors import shortened

MEASURED = ("x", "y", "z")
SEEN = ("seen_x", "seen_y", "seen_z")


def lines(kind: str, file: Path) -> Iterator[str]:
    """Yields the lines of the report on the points in a file: the pose, and the residual of each point. Raises
    CalibrationError."""
    rows = _read(file)
    found = _belt(file, rows) if kind == "belt" else _frame(file, rows)
    yield f"origin: {found.yaml}"
    if found.ratio is not None:
        yield f"ratio: {repr(found.ratio).removesuffix('.0')}"
    for number, residual in enumerate(found.residuals, 1):
        yield f"point {number}: {residual:.3f} mm off"
    if len(found.residuals):
        yield f"largest residual: {found.largest:.3f} mm"


def _read(file: Path) -> list[tuple[int, Fields]]:
    head, rows = read_rows(file, CalibrationError)
    if not rows:
        raise CalibrationError(f"{file}: expected a head and a row for each point, found no row")
    _require(file, MEASURED, head)
    return rows


def _require(file: Path, names: Sequence[str], head: Sequence[str]) -> None:
    missing = [name for name in names if name not in head]
    if missing:
        raise CalibrationError(f"{file}: there is no column {missing[0]}; the head says {_shown(head)}")


def _shown(head: Sequence[str]) -> str:
    return shortened(", ".join(head))


def _numbers(file: Path, line: int, fields: Fields, names: tuple[str, ...]) -> list[float]:
    numbers = []
    for name in names:
        try:
            numbers.append(float(fields[name] or ""))
        except (KeyError, ValueError):
            numbers.append(math.nan)
        if not math.isfinite(numbers[-1]):
            found = shortened(repr(fields.get(name)))
            raise CalibrationError(f"{file}:{line}: {name}: expected a finite number, found {found}")
    return numbers


def _frame(file: Path, rows: list[tuple[int, Fields]]) -> Calibration:
    measured = [_numbers(file, line, fields, MEASURED) for line, fields in rows]
    if any(name in rows[0][1] for name in SEEN):
        _require(file, SEEN, list(rows[0][1]))
        return calibrate.fit([_numbers(file, line, fields, SEEN) for line, fields in rows], measured)
    if len(measured) != 3:
        raise CalibrationError(
            f"{file}: expected three points (origin, on X, towards Y), found {len(measured)}; more of them need the "
            "columns seen_x, seen_y, seen_z"
        )
    return calibrate.three_points(*measured)


def _belt(file: Path, rows: list[tuple[int, Fields]]) -> Calibration:
    if "position" not in rows[0][1]:
        raise CalibrationError(f"{file}: there is no column position; the head says {_shown(list(rows[0][1]))}")
    positions, measured, beside = [], [], []
    for line, fields in rows:
        point = _numbers(file, line, fields, MEASURED)
        if (fields["position"] or "").strip():
            positions += _numbers(file, line, fields, ("position",))
            measured.append(point)
        else:
            beside.append(point)
    if len(beside) != 1:
        raise CalibrationError(f"{file}: expected one row without a position, of a point beside, found {len(beside)}")
    return calibrate.belt(positions, measured, beside[0])
