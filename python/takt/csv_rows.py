"""Reads the rows of a CSV file with a header; errors are one sentence."""

from __future__ import annotations

import csv
import io
import os
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from takt.errors import TaktError, shortened

Fields = dict[str, str | None]


class Rows(NamedTuple):
    """The names in the header, and the fields of each row by name with its line number. Missing fields of a row are
    None; surplus empty fields have the name ""."""

    head: Sequence[str]
    rows: list[tuple[int, Fields]]


DECIMAL_COMMA = re.compile(r"\s*[-+]?[0-9]*,[0-9]+([eE][-+]?[0-9]+)?\s*")


def _delimiter(head: str) -> str:
    """Returns the separator of the fields of a table with this header."""
    return next((one for one in ",;\t" if one in head), ",")


def _with_points(row: Fields) -> Fields:
    """Returns the row with decimal points instead of decimal commas."""
    return {
        name: text.replace(",", ".") if isinstance(text, str) and DECIMAL_COMMA.fullmatch(text) else text
        for name, text in row.items()
    }


def surplus(fields: Sequence[str], expected: int) -> str:
    """Returns the sentence for a row with more fields than the header; "" if it has none, or they are empty."""
    return f"expected {expected} fields as in the head, found {len(fields)}" if any(fields[expected:]) else ""


def read_rows(file: str | os.PathLike[str], error: type[TaktError]) -> Rows:
    """Returns the rows of a file. Fields are separated by commas or, if the header has none, by semicolons or tabs;
    numbers may then have a decimal comma. Raises `error` if the file is not CSV in UTF-8, the header has a column twice
    or a row has more fields than the header, OSError if the file cannot be read."""
    with Path(file).open(encoding="utf-8-sig", newline="") as source:
        try:
            text = io.StringIO(source.read(), newline="")
            delimiter = _delimiter(text.readline())
            text.seek(0)
            table = csv.DictReader(text, restkey="", delimiter=delimiter, skipinitialspace=True, strict=True)
            head, rows = table.fieldnames or (), []
            for title, count in Counter(head).items():
                if title and count > 1:
                    raise error(f"{os.fspath(file)}:{table.line_num}: the head has the column {shortened(title)} twice")
            for row in table:
                more: Any = row.get("")  # text if the header ends in a comma
                if isinstance(more, list) and (sentence := surplus([*head, *more], len(head))):
                    raise error(f"{os.fspath(file)}:{table.line_num}: {sentence}")
                rows.append((table.line_num, row if delimiter == "," else _with_points(row)))
            return Rows(head, rows)
        except UnicodeDecodeError as wrong:
            raise error(
                f"{os.fspath(file)}: expected text in UTF-8, found the byte 0x{wrong.object[wrong.start]:02x}"
            ) from None
        except csv.Error as wrong:  # an unterminated quotation mark, a field of megabytes
            raise error(f"{os.fspath(file)}:{table.reader.line_num}: is no CSV: {wrong}") from None
