"""The table of a sweep: runs.csv, one row per run in their order, and sweep.json, which describes its origin. Rows are
appended as they are made, so that an interrupted sweep can be continued."""

from __future__ import annotations

import csv
import fcntl
import hashlib
import importlib
import io
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any

from takt import _core
from takt.names import shown
from takt.sweep.design import Design, SweepError
from takt.sweep.runs import Job, Row
from takt.written import naming, write_text, written

FORMAT = 1
TABLE, ABOUT, LOCK = "runs.csv", "sweep.json", ".lock"


def about(job: Job, design: Design) -> dict[str, Any]:
    """Returns all that determines the rows of a sweep."""
    scenario = Path(job.scenario)
    machine = Path(job.machine) if job.machine else scenario.parent / "machine.yaml"
    return {
        "takt_sweep": FORMAT,
        "version": _core.__version__,
        "scenario": shown(job.scenario),
        "scenario_sha256": _hash(scenario),
        "machine": shown(job.machine),
        "machine_sha256": _hash(machine),
        "grid": [one.text for one in design.grids],
        "sample": [one.text for one in design.samples],
        "seed": design.seed,
    }


WORDS = {
    "takt_sweep": "another format",
    "version": "another version of Takt",
    "scenario": "another scenario",
    "scenario_sha256": "the scenario as it was before a change",
    "machine": "another machine",
    "machine_sha256": "the machine file as it was before a change",
    "grid": "other grids",
    "sample": "other samples",
    "seed": "another seed",
}


class Table:
    """The rows of a sweep on disk; `count`: their number."""

    def __init__(self, directory: Path, facts: Mapping[str, Any], fresh: bool = False) -> None:
        self.path = directory / TABLE
        self._about = directory / ABOUT
        directory.mkdir(parents=True, exist_ok=True)
        self._lock = (directory / LOCK).open("w")
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._lock.close()
            raise SweepError(f"{self.path}: another sweep is writing it; -o names another directory") from None
        self.columns: list[str] = []
        self.count = 0
        try:
            if not fresh and (self._about.exists() or self.path.exists()):
                self._check(facts)
            else:
                self.path.unlink(missing_ok=True)
            write_text(self._about, json.dumps(facts, indent=2, ensure_ascii=False) + "\n")
            if self.path.exists():
                self._take_up()
        except BaseException:
            self._lock.close()
            raise
        self._file: IO[str] = self.path.open("a", newline="", encoding="utf-8")

    def append(self, row: Row) -> None:
        new = [name for name in row if name not in self.columns]
        with naming(self.path):
            if new:
                self._widen(new)
            self._file.write(_line([row.get(name, "") for name in self.columns]))
        self.count += 1

    def flush(self) -> None:
        with naming(self.path):
            self._file.flush()

    def close(self) -> None:
        try:
            with naming(self.path):
                self._file.close()
        finally:
            self._lock.close()

    def _check(self, facts: Mapping[str, Any]) -> None:
        """Refuses to extend a table that a different sweep made."""
        try:
            known = json.loads(self._about.read_text(encoding="utf-8"))
            differing = [name for name in WORDS if known.get(name) != facts[name]]
        except (OSError, ValueError, AttributeError):
            raise SweepError(
                f"{self._about}: does not say what {TABLE} beside it was made by; --fresh begins again, -o names "
                "another directory"
            ) from None
        if differing:
            name = differing[0]
            plain = not name.endswith("sha256")
            values = f" ({_said(known.get(name))}; now {_said(facts[name])})" if plain else ""
            raise SweepError(
                f"{self.path}: was made by {WORDS[name]}{values}, and rows of both do not belong into one table; "
                "--fresh begins again, -o names another directory"
            )

    def _take_up(self) -> None:
        """Counts the complete rows, and cuts off an incomplete last one."""
        with self.path.open("rb+") as file:
            size = commas = 0
            for number, line in enumerate(file):
                if not line.endswith(b"\n"):
                    break
                if number == 0:
                    self.columns = next(csv.reader([line.decode("utf-8", "replace")]))
                    commas = len(self.columns) - 1
                elif not (line.split(b",", 1)[0] == str(number - 1).encode() and _is_whole(line, commas)):
                    raise SweepError(
                        f"{self.path}:{number + 1}: expected run {number - 1} with {commas + 1} columns here; --fresh "
                        "begins again, -o names another directory"
                    )
                self.count = number
                size += len(line)
            file.truncate(size)

    def _widen(self, new: list[str]) -> None:
        """Writes the table with more columns, empty in the existing rows."""
        fresh = not self.columns
        self.columns += new
        if fresh:
            self._file.write(_line(self.columns))
            return
        self._file.close()
        with (
            written(self.path) as beside,
            beside.open("w", newline="", encoding="utf-8") as file,
            self.path.open(encoding="utf-8") as before,
        ):
            next(before)
            file.write(_line(self.columns))
            for line in before:
                file.write(line.rstrip("\n") + "," * len(new) + "\n")
        self._file = self.path.open("a", newline="", encoding="utf-8")


def _is_whole(line: bytes, commas: int) -> bool:
    """Returns whether a row has a cell for each column."""
    if b'"' not in line:
        return line.count(b",") == commas
    return len(next(csv.reader([line.decode("utf-8", "replace")]))) == commas + 1


def rows_of(path: Path) -> Iterator[dict[str, str]]:
    """Yields the rows of a table as texts."""
    with path.open(newline="", encoding="utf-8") as file:
        yield from csv.DictReader(file)


def to_parquet(path: Path, texts: set[str]) -> Path:
    """Writes the same table as Parquet; `texts`: columns that are not numbers. Requires pyarrow. Returns its path."""
    arrow, arrow_csv, parquet = map(importlib.import_module, ("pyarrow", "pyarrow.csv", "pyarrow.parquet"))
    target = path.with_suffix(".parquet")
    with path.open(newline="", encoding="utf-8") as file:
        columns = next(csv.reader(file))
    whole = ("run", "passed")
    types = {name: arrow.string() if name in texts else arrow.float64() for name in columns}
    types |= dict.fromkeys(whole, arrow.int64())
    options = arrow_csv.ConvertOptions(column_types=types, strings_can_be_null=True)
    with path.open("rb") as rows, written(target) as beside, beside.open("wb") as file:
        reader = arrow_csv.open_csv(rows, convert_options=options)
        with reader, parquet.ParquetWriter(file, reader.schema) as writer:
            for batch in reader:
                writer.write_batch(batch)
    return target


def _line(cells: list[Any]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerow(cells)
    return out.getvalue()


def _said(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    return str(value) or "the one beside the scenario"  # a machine


def _hash(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise SweepError(f"{path}: cannot be read: {error.strerror}") from None
