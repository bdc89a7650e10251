"""Describes missing samples and messages of recordings."""

from __future__ import annotations

from collections.abc import Iterable

from takt.counted import counted
from takt.figures import DROPPED
from takt.recording import Recording
from takt.tables import PREFIXES
from takt.verdict import Interval, seconds

NAMED = 3  # components named in a sentence; more are only counted
# Channels that repeat their content, or send it on demand, so that a lost message does no harm. Losses of states show
# as missing samples.
REPEATING = (
    *("takt/engine", "takt/machine", "takt/track_shapes/", "takt/mover_trails/", "takt/mover_routes/", "takt/cams"),
    *PREFIXES.values(),
)


def missing(recording: Recording, components: Iterable[str] | None = None, window: Interval | None = None) -> str:
    """ "3 samples of x in 2 gaps, the first after 0.099 s": the missing samples of these components, or of all, in a
    time window or in the whole recording; empty if none are missing."""
    lacking = []
    for component in dict.fromkeys(recording if components is None else components):
        gaps = recording.gaps(component)
        if window is not None:
            gaps = [gap for gap in gaps if gap.time_s < window[1] and gap.until_s > window[0]]
        if gaps:
            first = f"{', the first' if len(gaps) > 1 else ','} after {seconds(gaps[0].time_s)}"
            count = sum(gap.missing for gap in gaps)
            lacking.append((-count, f"{counted(count, 'sample')} of {component} in {counted(len(gaps), 'gap')}{first}"))
    said = [text for _, text in sorted(lacking)]
    others = [f"some of {counted(len(said) - NAMED, 'other component')}"] if len(said) > NAMED else []
    return "; ".join(said[:NAMED] + others)


def lost(recording: Recording) -> str:
    """Returns a text about missing data besides samples: lost messages of other channels, components that fell silent
    or were heard late, and messages that the engine dropped; empty if nothing is missing."""
    losses = recording.meta.get("losses") or {}
    counts = [(-count, channel) for channel, count in losses.items() if not channel.startswith(REPEATING)]
    worst = [(channel, -count) for count, channel in sorted(counts)]
    said = [f"{counted(count, 'message')} of {name}" for name, count in worst[:NAMED]]
    said += [f"some of {counted(len(worst) - NAMED, 'other channel')}"] if len(worst) > NAMED else []
    silent = (recording.meta.get("silent") or {}).items()
    said += [f"{name} from {seconds(since)} on" for name, since in list(silent)[:NAMED]]
    said += [f"{counted(len(silent) - NAMED, 'other component')}"] if len(silent) > NAMED else []
    late = (recording.meta.get("late") or {}).items()
    said += [f"{name} before {seconds(until)}" for name, until in list(late)[:NAMED]]
    said += [f"the beginning of {counted(len(late) - NAMED, 'other component')}"] if len(late) > NAMED else []
    dropped = [counted(count, *DROPPED[name]) for name, count in (recording.meta.get("dropped") or {}).items()]
    said += [f"{' and '.join(dropped)} that the engine had no room for"] if dropped else []
    return "; ".join(said)


def all_missing(recording: Recording) -> str:
    """Returns a text about all missing samples and messages; empty if the recording is complete."""
    return "; ".join(said for said in (missing(recording), lost(recording)) if said)


def holes(recording: Recording, components: Iterable[str], curve: str = "") -> list[Interval]:
    """Returns the time intervals without samples of a curve of these components: of the component in its name
    ("x.set_position"), else of any of them."""
    there = [name for name in components if name in recording]
    named = [name for name in there if curve.startswith((f"{name}.", f"{name}:"))]
    return sorted((gap.time_s, gap.until_s) for name in named or there for gap in recording.gaps(name))


def troubles(recording: Recording) -> list[str]:
    """Returns sentences about the recording that matter for verdicts on it."""
    lacks, others = missing(recording), lost(recording)
    said = [str(recording.meta.get(what) or "") for what in ("starts", "trouble")]
    said += [f"Samples are missing: {lacks}." if lacks else "", f"Messages are missing: {others}." if others else ""]
    return [sentence for sentence in said if sentence]
