"""Output of the command line: tables and colours on a terminal; plain lines in pipes and files, neither wrapped nor
padded, with two blanks between the non-empty cells of tables."""

from __future__ import annotations

import contextlib
import io
import os
import stat
import sys
from collections.abc import Iterator
from typing import Any, TextIO

from rich.console import Console
from rich.table import Table
from rich.text import Text


class Output(Console):
    """A console that prints plain lines unless it is a terminal."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, **options)

    def print(self, *objects: Any, **options: Any) -> None:
        if self.is_terminal:
            super().print(*objects, **options)
            return
        for one in objects:
            for line in _rows(one) if isinstance(one, Table) else [_plain(one)]:
                print(line, file=self.file)


class _Pipe(io.FileIO):
    """A pipe to write to. Data written after its reader has ended is dropped."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            return memoryview(data).nbytes


@contextlib.contextmanager
def any_output() -> Iterator[None]:
    """A context in which printing does not fail if the encoding of an output lacks a character, which becomes a
    question mark, or if the reader of a pipe has ended."""
    before = sys.stdout, sys.stderr
    within = sys.stdout, sys.stderr = _tolerant(sys.stdout), _tolerant(sys.stderr)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
        for stream in within:
            if stream not in before:
                stream.flush()


def _tolerant(stream: TextIO) -> TextIO:
    if not isinstance(stream, io.TextIOWrapper):
        return stream
    if stream.errors == "strict":
        stream.reconfigure(errors="replace")
    try:
        kind = os.fstat(stream.fileno()).st_mode
    except (OSError, ValueError):
        return stream
    if not (stat.S_ISFIFO(kind) or stat.S_ISSOCK(kind)):
        return stream
    stream.flush()
    pipe = _Pipe(stream.fileno(), "wb", closefd=False)
    return io.TextIOWrapper(
        pipe if isinstance(stream.buffer, io.RawIOBase) else io.BufferedWriter(pipe),
        encoding=stream.encoding,
        errors=stream.errors,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )


def _rows(table: Table) -> list[str]:
    columns = [[_plain(cell) for cell in column.cells] for column in table.columns]
    lines = list(zip(*columns, strict=True))
    heads = tuple(_plain(column.header) for column in table.columns)
    if table.show_header and any(heads):
        lines.insert(0, heads)
    return ["  ".join(filter(None, line)) for line in lines]


def _plain(cell: Any) -> str:
    return cell.plain if isinstance(cell, Text) else str(cell)
