"""The newest state of every component: numbers for the page's pictures, and texts when they have changed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from takt.engine import error_name, error_text
from takt.view.ledger import Ledger
from takt.view.machine import Machine, Source
from takt.view.ring import Floats
from takt.view.status import LIVE, TICKETS, WORDS, name_in, words

Row = dict[str, Any]


class _Batch:
    """Components of one kind whose messages have the same size: decoded as one array."""

    def __init__(self, kind: str, sources: list[Source]) -> None:
        self.kind = kind
        self.sources = sources
        self.messages = [source.layout.blank for source in sources]
        self.heard = np.zeros(len(sources), dtype=bool)
        self.rows = sources[0].layout.rows(self.messages)
        self.seen: Floats = np.full((len(sources), len(WORDS.get(kind, ()))), np.nan)

    def decode(self) -> None:
        self.rows = self.sources[0].layout.rows(self.messages)

    def changed(self) -> npt.NDArray[np.intp]:
        """Returns the indices in the batch of the components whose texts have changed."""
        fields = WORDS.get(self.kind, ())
        now = np.stack([self.rows[f] for f in fields], axis=1).astype(float) if fields else np.zeros(self.seen.shape)
        news = np.any((now != self.seen) & ~(np.isnan(now) & np.isnan(self.seen)), axis=1) & self.heard
        self.seen[news] = now[news]
        return np.flatnonzero(news)


class Overview:
    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.cycle = 0  # the newest one received
        self.revision = 0
        self.words: dict[int, tuple[int, Row]] = {}  # by component: revision, row
        alike: dict[tuple[str, int], list[Source]] = {}
        for source in machine.sources:
            alike.setdefault((source.kind, source.layout.dtype.itemsize), []).append(source)
        self._batches = [_Batch(kind, sources) for (kind, _), sources in alike.items()]
        self._place = {s.index: (batch, i) for batch in self._batches for i, s in enumerate(batch.sources)}
        self._name_of = name_in(machine.names)
        sizes = [len(LIVE.get(source.kind, ())) for source in machine.sources]
        self._starts = np.concatenate(([0], np.cumsum(sizes, dtype=int)))
        self.live: Floats = np.full(int(self._starts[-1]), np.nan)

    def take(self, source: Source, data: bytes) -> None:
        batch, i = self._place[source.index]
        batch.messages[i] = data
        batch.heard[i] = True

    def update(self, ledger: Ledger, latest_cycle: float) -> None:
        """Decodes the newest messages into numbers, texts, and `cycle`, which ignores cycles after `latest_cycle`."""
        touched = {self.machine.by_name[t].index for t in ledger.touched if t in self.machine.by_name}
        ledger.touched.clear()
        for batch in self._batches:
            batch.decode()
            cycles = batch.rows["cycle"][batch.heard]
            self.cycle = max(self.cycle, int(cycles[cycles <= latest_cycle].max(initial=0)))
            for k, field in enumerate(LIVE.get(batch.kind, ())):
                at = np.array([self._starts[source.index] + k for source in batch.sources])
                self.live[at] = np.where(batch.heard, batch.rows[field].astype(float), np.nan)
            touched.update(batch.sources[i].index for i in batch.changed())
        for index in touched:
            self._put_into_words(self.machine.sources[index], ledger)

    def rows_since(self, revision: int) -> list[Row]:
        return [row for changed_at, row in self.words.values() if changed_at > revision]

    def value(self, name: str, field: str) -> float:
        """Returns the newest value of a field of a component, in its unit; NaN before its first message."""
        batch, i = self._place[self.machine.by_name[name].index]
        return float(batch.rows[field][i]) if batch.heard[i] else float("nan")

    def heard(self, index: int) -> bool:
        """Returns whether a message of the component has been received."""
        batch, i = self._place[index]
        return bool(batch.heard[i])

    def values(self, index: int, fields: Mapping[str, Any]) -> Floats:
        """Returns the given fields of a component, in their order; NaN before its first message."""
        batch, i = self._place[index]
        if not batch.heard[i]:
            return np.full(len(fields), np.nan)
        return np.array([float(batch.rows[field][i]) for field in fields])

    def _put_into_words(self, source: Source, ledger: Ledger) -> None:
        batch, i = self._place[source.index]
        if not batch.heard[i]:
            return
        values = {field: batch.rows[field][i] for field in WORDS.get(source.kind, ())}
        said = words(source.kind, values, self._name_of)
        ticket = int(values[TICKETS[source.kind]]) if source.kind in TICKETS else 0
        row: Row = {
            "i": source.index,
            "state": said.state,
            "more": said.more,
            "waits": said.waits,
            "since": said.since,
            "command": ledger.command_of(source.name, ticket) if ticket or source.kind not in TICKETS else "",
            "error": said.error,
            "error_text": f"{error_name(said.error)}: {error_text(said.error)}" if said.error else "",
            "refused": ledger.trouble_of(source.name),
        }
        if self.words.get(source.index, (0, None))[1] != row:
            self.revision += 1
            self.words[source.index] = (self.revision, row)
