"""Assertions for motion.

    from takt import expect

    expect.reaches(rec, "x", 100.0, tolerance=0.01, by=2.0)
    expect.within_limits(rec, "x")
    expect.stays(rec, "|x.following_error| < 0.5", window=(1.0, 2.0))

A failure raises `MotionAssertionError` with a sentence that says when and by how much, and the path of a picture.
Inside `with expect.collect() as verdicts:` nothing is raised; passed and failed verdicts are collected instead. NaN
values and a recording without samples fail every assertion. The same functions without raising are in `takt.checks`.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from pathlib import Path
from typing import Concatenate, ParamSpec

from takt import checks
from takt.recording import Recording
from takt.verdict import MotionAssertionError, Verdict

__all__ = [
    "MotionAssertionError",
    "Verdict",
    "collect",
    "complete",
    "continuous",
    "follows_path",
    "in_sync",
    "keeps_distance",
    "never_both",
    "observers",
    "pictures",
    "reaches",
    "settles",
    "stays",
    "visits_states",
    "within_limits",
]

P = ParamSpec("P")

# Folder for pictures of failures; None: no pictures. The pytest plugin sets it for each test.
pictures: Path | str | None = Path("reports")

# Called with every recording and verdict before anything is raised.
observers: list[Callable[[Recording, Verdict], None]] = []

_collected: ContextVar[list[Verdict] | None] = ContextVar("takt_collected", default=None)
_numbers = itertools.count(1)


@contextmanager
def collect() -> Iterator[list[Verdict]]:
    """A context that collects verdicts instead of raising, and draws no pictures. Verdicts inside an inner `collect` go
    to the inner list only."""
    verdicts: list[Verdict] = []
    token = _collected.set(verdicts)
    try:
        yield verdicts
    finally:
        _collected.reset(token)


def _asserting(
    check: Callable[Concatenate[Recording, P], Verdict],
) -> Callable[Concatenate[Recording, P], Verdict]:
    @functools.wraps(check)
    def asserting(recording: Recording, /, *args: P.args, **kwargs: P.kwargs) -> Verdict:
        __tracebackhide__ = True
        verdict = check(recording, *args, **kwargs)
        for observer in observers:
            observer(recording, verdict)
        collected = _collected.get()
        if collected is not None:
            collected.append(verdict)
        elif not verdict.passed:
            verdict, note = _with_picture(verdict, recording)
            raise MotionAssertionError(verdict, note)
        return verdict

    return asserting


def _with_picture(verdict: Verdict, recording: Recording) -> tuple[Verdict, str]:
    """Saves a picture of the failure and returns the verdict with its path, and a note for the exception. A picture
    that cannot be made must not hide the failure."""
    if pictures is None or not verdict.lanes:
        return verdict, ""
    stem = re.sub(r"[^\w.-]+", "_", "_".join((verdict.name, *verdict.components)))[:80]
    path = Path(pictures) / f"{stem}_{next(_numbers)}.png"
    try:
        from takt import plot

        plot.save(plot.draw_verdict(verdict, recording), path)
    except Exception as error:
        return verdict, f"(no picture: {error})"
    return replace(verdict, picture=path), f"picture: {path}"


within_limits = _asserting(checks.within_limits)
continuous = _asserting(checks.continuous)
reaches = _asserting(checks.reaches)
settles = _asserting(checks.settles)
follows_path = _asserting(checks.follows_path)
in_sync = _asserting(checks.in_sync)
keeps_distance = _asserting(checks.keeps_distance)
never_both = _asserting(checks.never_both)
stays = _asserting(checks.stays)
visits_states = _asserting(checks.visits_states)
complete = _asserting(checks.complete)
