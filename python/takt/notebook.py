"""HTML tables that notebooks show as the last value of a cell, in the notebook's own colours."""

from __future__ import annotations

import base64
import html
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from takt.counted import counted
from takt.errors import TaktError
from takt.missing import all_missing

if TYPE_CHECKING:
    from takt.component import Component
    from takt.recording import Recording
    from takt.report.comparison import Comparison
    from takt.scenario import Outcome
    from takt.session import Session
    from takt.sweep.sweeping import Result
    from takt.twin.judging import Judged
    from takt.verdict import Verdict

FIELDS = 6  # of a component named in a table
ROWS = 30  # of differences, or of failures of a sweep


def table(title: str, head: Sequence[str], rows: Iterable[Sequence[str]], note: str = "") -> str:
    """Returns a table with a title above and a note below; all texts are escaped."""
    cells = "".join(f'<th style="text-align:left">{html.escape(text)}</th>' for text in head)
    lines = ("".join(f'<td style="text-align:left">{html.escape(str(text))}</td>' for text in row) for row in rows)
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    below = f"<div>{html.escape(note)}</div>" if note else ""
    above = f"<div><b>{html.escape(title)}</b></div>" if title else ""
    return f"{above}<table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>{below}"


def recording_table(recording: Recording) -> str:
    """Returns a table of the recorded components."""
    from takt.export import rates

    title = f"Recording of {recording.meta.get('machine', 'a machine')}, {recording.duration_s:.3f} s"
    known = rates(recording)
    rows = []
    for name in recording:
        fields = recording.fields(name)[2:]
        named = [f"{f} [{unit}]" if (unit := recording.unit(name, f)) else f for f in fields[:FIELDS]]
        more = f", {len(fields) - FIELDS} more" if len(fields) > FIELDS else ""
        rate = f"{known[name]:g} Hz" if name in known else "—"
        rows.append((name, f"{len(recording[name]):,}", rate, ", ".join(named) + more))
    lacks = all_missing(recording)
    note = f"{counted(len(recording.events), 'event')}; " + (f"missing: {lacks}" if lacks else "no sample missing")
    return table(title, ("component", "samples", "rate", "fields"), rows, note)


def session_table(session: Session) -> str:
    """Returns a table of the current states of the components of a machine."""
    title = f"{session.name} at {session.now:.3f} s, cycle {1e3 * session.period:g} ms"
    rows = [(name, one.KIND, _state(one)) for name, one in session.components.items()]
    return table(title, ("component", "kind", "state"), rows, "closed" if session._closed else "")


def _state(component: Component) -> str:
    """Returns the state in the component's repr, without its name."""
    try:
        said = repr(component).removeprefix("<").removesuffix(">")
    except TaktError as error:  # over LCM, before its first message
        return str(error)
    _, colon, state = said.partition(": ")
    return state if colon else "—"


def component_table(component: Component) -> str:
    """Returns a table of the current published values of a component, without values that are 0 or off beyond its first
    fields."""
    from takt.tables import KINDS, unit_of, units_of

    session, kind = component.session, KINDS[component.KIND]
    title = f"{component.name}, {component.KIND.replace('_', ' ')} of {session.name} at {session.now:.3f} s"
    own = units_of(session.machine, kind, component.parameters)
    rows: list[tuple[str, str, str]] = []
    try:
        for number, field in enumerate(kind.units):
            value = component._value(field)
            if number >= FIELDS and (value != value or not value):  # NaN, 0, off
                continue
            unit = unit_of(kind.name, field, own).removeprefix("1") if isinstance(value, float) else ""
            rows.append((field, _text(value), unit))
    except TaktError as error:  # over LCM, before its first message
        return table(title, (), (), str(error))
    rest = len(kind.units) - len(rows)
    return table(title, ("", "value", "unit"), rows, f"{counted(rest, 'other')}: 0, off or unknown" if rest else "")


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return "unknown" if math.isnan(value) else f"{value:.6g}"
    return str(getattr(value, "value", value))  # of enumerations


def outcome_table(outcome: Outcome) -> str:
    """Returns a table of the verdicts of a scenario, with pictures of those that failed."""
    verdicts = (*([outcome.assertion] if outcome.assertion is not None else []), *outcome.verdicts)
    failed = [verdict for verdict in verdicts if not verdict.passed]
    rows = [("passed", verdict.title, verdict.sentence) for verdict in verdicts if verdict.passed]
    title = f"{len(rows)} passed, {len(failed)} failed; {outcome.recording.duration_s:.3f} s"
    lacks = all_missing(outcome.recording)
    below = table(title, ("", "check", ""), rows, f"missing: {lacks}" if lacks else "no sample missing")
    return "".join(verdict_picture(verdict) for verdict in failed) + below


def sweep_table(result: Result) -> str:
    """Returns tables of the failures of a sweep, with the commands that repeat these runs, and of its numbers."""
    summary = result.summary
    rest = summary.size - summary.runs
    title = f"{summary.passed:,} passed, {summary.failed:,} failed" + (f", {rest:,} not made yet" if rest else "")
    reasons = sorted(summary.reasons.items(), key=lambda item: -item[1][0])[:ROWS]
    failed = [(reason, f"{count:,}", str(first), command) for reason, (count, first, command) in reasons]
    numbers = [
        (name, f"{one.least:.6g}", str(one.low[0][1]), f"{one.most:.6g}", str(one.high[0][1]))
        for name, one in summary.columns.items()
    ]
    above = table(title, ("what failed", "runs", "the first", "makes it again"), failed) if failed else ""
    return above + table(
        "" if failed else title, ("number", "least", "run", "largest", "run"), numbers, f"{result.table}, {result.page}"
    )


def twin_table(judged: Judged) -> str:
    """Returns a table of the results of a twin: figures beside those of the servo model, and verdicts."""
    from takt.twin.judging import HEAD

    title = f"{'passed' if judged.passed else 'failed'}: {counted(judged.cycles, 'cycle')} in the twin"
    return table(title, HEAD, judged.table()) + "".join(_line(verdict) for verdict in judged.verdicts)


def _line(verdict: Verdict) -> str:
    from takt import style

    mark = "passed" if verdict.passed else "failed"
    colour = style.GOOD if verdict.passed else style.BAD
    text = f'<div><b style="color:{colour}">{mark}</b> <b>{html.escape(verdict.title)}</b> '
    return text + f"{html.escape(verdict.sentence)}</div>"


def verdict_picture(verdict: Verdict) -> str:
    """Returns the sentence of a verdict and its picture."""
    from takt import plot

    text = _line(verdict)
    if not any(len(trace.time_s) for lane in verdict.lanes for trace in lane.traces):
        return text
    data = base64.b64encode(plot.png(plot.draw_verdict(verdict))).decode("ascii")
    return text + f'<img style="max-width:100%" alt="{html.escape(verdict.title)}" src="data:image/png;base64,{data}">'


def comparison_table(comparison: Comparison) -> str:
    """Returns a table of the differences between two runs."""
    from takt.verdict import number, seconds

    def told(value: float | None, words: Any) -> str:
        return "—" if value is None else str(words(value))

    rows = [
        (
            one.signal,
            told(one.largest, lambda value, unit=one.unit: number(value, unit)),
            told(one.largest_s, seconds),
            told(one.rms, lambda value, unit=one.unit: number(value, unit)),
            told(one.first_s, seconds),
            f"{100 * one.share:.3g} %",
        )
        for one in comparison.differing[:ROWS]
    ]
    head = ("signal", "largest difference", "at", "rms", "differs first", "of the time")
    return table(" and ".join(comparison.names), head, rows, comparison.sentence)
