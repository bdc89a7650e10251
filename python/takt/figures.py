"""The engine's own counters and times as text, for the terminal, reports and the live page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from takt import msgs
from takt.counted import counted
from takt.tables import fields_of

# Counters that should stay 0: their names for display, and their meanings.
COUNTS = {
    "overruns": ("overruns", "Cycles that ended after the next one should have begun"),
    "cycles_skipped": ("cycles left out", "Periods that passed without a cycle because one before them came too late"),
    "snapshots_dropped": ("states dropped", "States lost because their queue was full: a slow network or disk"),
    "feedback_dropped": ("feedbacks dropped", "Feedbacks lost because their queue was full"),
    "journal_dropped": ("journal entries dropped", "The journal cannot be replayed"),
    "commands_refused": (
        "commands refused by a full queue",
        "There was no room in the queue to the cycle; other refusals are not counted",
    ),
    "set_points_dropped": ("set points dropped", "For external drives, lost because their queue was full"),
    "samples_refused": ("samples refused", "Of external drives: wrong, old or not asked for"),
    "malformed": ("messages malformed", "On the command and heartbeat channels"),
    "ignored": ("messages ignored", "Commands and heartbeats that came too late"),
    "other_run": ("messages for another start", "Commands and heartbeats for another start of the engine"),
    "untagged": ("messages without a tag", "Ignored, since the engine has a key"),
    "wrong_key": ("messages of another key", "Ignored: tagged with another key, or changed on the way"),
    "replayed": ("messages replayed", "Ignored: they had been heard before"),
    "stale": ("stale messages", "Ignored: tagged more than 2 s before or after they came"),
    "send_failures": ("send failures", "Messages the network or the log file did not take"),
    "replies_dropped": ("replies dropped", "Too many waited"),
    "planner_failures": ("plans failed", "The motion in progress was kept"),
}
# Those of them that count dropped messages: their names, singular and plural.
DROPPED = {
    "snapshots_dropped": ("state", "states"),
    "feedback_dropped": ("feedback", "feedbacks"),
    "set_points_dropped": ("set point for a drive", "set points for drives"),
    "journal_dropped": ("journal entry", "journal entries"),
    "replies_dropped": ("reply to a client", "replies to clients"),
    "send_failures": ("message that was not taken", "messages that were not taken"),
}
TIMES = {"execution": "execution of a cycle", "latency": "wake-up latency"}
ALWAYS = ("overruns", "commands_refused", "snapshots_dropped", "feedback_dropped")  # shown even if 0


def figures_of(state: msgs.engine_state) -> dict[str, Any]:
    """Returns the engine's own counters and histograms as plain values."""
    plain = fields_of(state)
    plain["state_hash"] &= 2**64 - 1  # LCM has no unsigned numbers
    for name in ("execution", "latency"):
        histogram = plain[name]
        plain[name] = {"count": histogram.count, "max": histogram.max, "buckets": list(histogram.buckets)}
    return plain


def in_words(figures: Mapping[str, Any]) -> dict[str, Any]:
    """Returns texts by name for display. Figures of other origin than an engine are returned unchanged."""
    if not figures.keys() >= {"cycle", "commands_applied", *ALWAYS}:
        return dict(figures)
    rows = {"cycles": f"{figures['cycle']:,}", "overruns": f"{figures['overruns']:,}"}
    for name, title in TIMES.items():
        histogram = figures.get(name) or {}
        if histogram.get("count"):
            median, late = (quantile(histogram, share) / 1e3 for share in (0.5, 0.99))
            rows[title] = f"median {median:.0f} µs, 99 % below {late:.0f} µs, longest {histogram['max'] / 1e3:.0f} µs"
    rows["commands"] = (
        f"{figures['commands_applied']:,} applied, {figures['commands_refused']:,} refused by a full queue"
    )
    states, feedbacks = figures["snapshots_dropped"], figures["feedback_dropped"]
    rows["dropped"] = f"{counted(states, 'state')}, {counted(feedbacks, 'feedback')}"
    others = {title: figures.get(name) for name, (title, _) in COUNTS.items() if name not in ALWAYS}
    rows |= {title: f"{count:,}" for title, count in others.items() if count}
    return rows


def quantile(histogram: Mapping[str, Any], share: float) -> float:
    """Returns the time [ns] below which this share of the counted times is, at most the longest. Bucket i counts times
    in [2^i, 2^(i+1)), the last one all larger ones."""
    wanted = share * histogram["count"]
    longest = float(histogram["max"])
    for i, count in enumerate(histogram["buckets"][:-1]):
        if count >= wanted and count:
            return min(float(2**i * (1 + wanted / count)), longest)
        wanted -= count
    return longest
