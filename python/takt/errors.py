"""The exceptions of this package. Each text is one readable sentence; ConfigError has one line for each problem."""

from __future__ import annotations

import builtins
import math
from collections.abc import Sequence
from numbers import Integral, Real
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from takt.feedback import Feedback


class TaktError(Exception):
    """Base class of the exceptions of this package."""


class ConfigError(TaktError, ValueError):
    """A machine file is wrong. `problems` lists where, and what was expected, one line each."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = list(problems)
        super().__init__("\n".join(self.problems))

    def __reduce__(self) -> tuple[type[ConfigError], tuple[list[str]]]:
        return type(self), (self.problems,)  # for pickling, as between processes


class CommandError(TaktError):
    """A command was refused, failed or aborted. `feedback` has the details."""

    def __init__(self, feedback: Feedback) -> None:
        self.feedback = feedback
        number = f" (error {feedback.error_id})" if feedback.error_id else ""
        super().__init__(f"{feedback.text}: {feedback.sentence}{number}")


class TimeoutError(TaktError, builtins.TimeoutError):
    """A condition was not met in time."""


class ConnectionError(TaktError, builtins.ConnectionError):
    """The engine cannot be reached, or the connection to it is lost."""


class KeyFileError(TaktError):
    """A key file cannot be used; the text says why and never quotes the content of the file."""


class DriveWarning(UserWarning):
    """An external drive sent unusable data, or is not heard."""


class ClosedError(TaktError):
    """The session was closed."""


def shortened(text: str, most: int = 200) -> str:
    """Returns the text on one line, cut off after `most` characters."""
    line = " ".join(text.split())
    return line if len(line) <= most else f"{line[:most]} ..."


def whole(value: object, what: str, least: int) -> int:
    """Returns `value` as an int. Raises TypeError if it is not an integer, ValueError if it is below `least`."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(f"{what} is a whole number, not {value!r}")
    if value < least:
        raise ValueError(f"{what} is a whole number from {least} on, not {value}")
    return int(value)


def seconds(value: object, what: str, most: float = math.inf) -> float:
    """Returns `value` [s] as a float. Raises TypeError if it is not a number, ValueError if it is not within 0 to
    `most`."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{what} is a number of seconds, not {value!r}")
    if not 0 <= float(value) <= most:
        raise ValueError(f"{what} is a number of seconds from 0 on, not {value}")
    return float(value)
