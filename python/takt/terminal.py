"""What the command line prints: tables and colours on a terminal; into pipes and files plain lines, neither wrapped nor
padded, with two blanks between the cells of tables that are not empty."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text


class Output(Console):
    """A console that knows what it prints to."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, **options)

    def print(self, *objects: Any, **options: Any) -> None:
        if self.is_terminal:
            super().print(*objects, **options)
            return
        for one in objects:
            for line in _rows(one) if isinstance(one, Table) else [_plain(one)]:
                print(line, file=self.file)


def _rows(table: Table) -> list[str]:
    columns = [[_plain(cell) for cell in column.cells] for column in table.columns]
    lines = list(zip(*columns, strict=True))
    heads = tuple(_plain(column.header) for column in table.columns)
    if table.show_header and any(heads):
        lines.insert(0, heads)
    return ["  ".join(filter(None, line)) for line in lines]


def _plain(cell: Any) -> str:
    return cell.plain if isinstance(cell, Text) else str(cell)
