"""The live page under load: 50 signals at 1 kHz, memory when buffers are full, pages that do not read, 1000 axes."""

from __future__ import annotations

import contextlib
import json
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import takt
from machines import new_url, running
from pages import (
    PATIENCE_S,
    Client,
    column,
    needs_chromium,
    opened,
    row,
    start_server,
    until,
    wait_for_cycle,
)
from playwright.sync_api import Browser, Page, expect
from takt.tables import KINDS
from takt.view.ring import CAPACITY
from takt.view.server import AHEAD, MOST_ROWS
from websockets.sync.client import ClientConnection
from websockets.sync.client import connect as connect_socket

AXIS = "{{name: {}, limits: {{velocity: 500, acceleration: 20000, jerk: 1000000}}}}"
FIELDS = list(KINDS["axis"].units)
expect.set_options(timeout=PATIENCE_S * 1000)


def machine(names: list[str], period_s: float = 0.001, rate_hz: float = 1000) -> str:
    axes = "".join(f"  - {AXIS.format(name)}\n" for name in names)
    return f"name: load\ncycle: {{period_s: {period_s}}}\nlcm: {{axis_rate_hz: {rate_hz}}}\naxes:\n{axes}"


@contextlib.contextmanager
def server(*arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    process, address = start_server(*arguments)
    try:
        yield process, address
    finally:
        process.terminate()
        said, _ = process.communicate(timeout=20)
    assert "Traceback" not in said, said


def resident(process: subprocess.Popen[str]) -> float:
    """Memory of a process in MB."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return float(status.split("VmRSS:")[1].split()[0]) / 1e3


def heap(page: Page) -> float:
    """What a page holds, with its arrays, in MB."""
    protocol = page.context.new_cdp_session(page)
    protocol.send("HeapProfiler.collectGarbage")
    said = protocol.send("Runtime.getHeapUsage")
    return float(said["usedSize"] + said["backingStorageSize"]) / 1e6


def rows(page: Page) -> int:
    """So many have come of each component, those that have left again included."""
    script = "() => Math.min(...[...window.takt.scope.store.series.values()].map((one) => one.moved + one.end))"
    return int(page.evaluate(script))


def wait_for_rows(page: Page, count: int) -> None:
    script = """([count]) => {
        const all = [...window.takt.scope.store.series.values()];
        return all.length > 0 && all.every((one) => one.moved + one.end >= count);
    }"""
    until(page, script, count)


def kept_between(page: Page, first: int, last: int) -> dict[str, dict[str, list[float]]]:
    """What the page has of these cycles, by component and field: all at once, for it does not keep it for ever."""
    script = """([first, last]) => {
        const { model, scope } = window.takt;
        return Object.fromEntries([...scope.store.series].map(([index, series]) => {
            const cycles = series.cycles.subarray(0, series.end);
            const [from, to] = [cycles.findIndex((c) => c >= first), cycles.findLastIndex((c) => c <= last) + 1];
            const columns = [["cycle", series.cycles], ...series.columns];
            const kept = columns.map(([field, values]) => [field, [...values.subarray(from, to)]]);
            return [model.components[index].name, Object.fromEntries(kept)];
        }));
    }"""
    said: dict[str, dict[str, list[float]]] = page.evaluate(script, [int(first), int(last)])
    return said


@needs_chromium
def test_fifty_signals_without_loss(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    names = [f"a{i}" for i in range(5)]
    signals = [f"{name}.{field}" for name in names for field in FIELDS[:10]]
    assert len(signals) == 50
    with (
        running(tmp_path, url, machine=machine(names)),
        server(url) as (_, address),
        opened(browser, address, f"#tab=scope&signals={','.join(signals)}") as page,
    ):
        wait_for_rows(page, 1)
        with takt.connect(url) as session:
            record = session.record()
            for power in [axis.power() for axis in session.axes.values()]:
                power.wait()
            for move in [axis.move_absolute(position=20.0 + i) for i, axis in enumerate(session.axes.values())]:
                move.wait()
            recording = record.stop()
        first = min(recording[name]["cycle"][0] for name in names)
        last = max(recording[name]["cycle"][-1] for name in names)
        wait_for_cycle(page, last)
        kept = kept_between(page, first, last)
        for name in names:
            assert len(recording[name]["cycle"]) > 100
            at = np.searchsorted(kept[name]["cycle"], recording[name]["cycle"])
            for field in ["cycle", *FIELDS[:10]]:
                values = np.array(kept[name][field], dtype=float)[at]
                np.testing.assert_array_equal(values, recording[name][field].astype(float))
        redraws = page.evaluate("() => window.takt.scope.redraws")
        wait_for_rows(page, rows(page) + 5000)
        assert page.evaluate("() => window.takt.scope.redraws") > redraws
        wait_for_rows(page, 11_000)  # the whole window is drawn from what was kept of curves by now
        for name in names:
            cycles, _ = column(page, f"{name}.{FIELDS[0]}")
            np.testing.assert_array_equal(np.diff(cycles), 1)
        assert page.evaluate("() => [window.takt.model.health.lost, window.takt.model.health.skipped]") == [0, 0]
        assert_same_as_drawn_anew(page)


def assert_same_as_drawn_anew(page: Page) -> None:
    """A picture that has moved on is the one that is drawn at once, but for how edges of lines are smoothed."""
    script = """() => {
        const { scope } = window.takt;
        const { canvas, roll } = scope.drawing;
        const pixels = () => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        scope.draw();
        const kept = pixels();
        roll.lanes.clear();
        scope.draw();
        const anew = pixels();
        const drawn = kept.some((value) => value < 128);
        return [drawn, kept.reduce((most, value, i) => Math.max(most, Math.abs(value - anew[i])), 0)];
    }"""
    drawn, most = page.evaluate(script)
    assert drawn
    assert most < 64  # of 255


@needs_chromium
def test_memory_stays_when_buffers_are_full(tmp_path: Path, browser: Browser) -> None:
    """Four times as fast, so that they are full sooner."""
    url = new_url()
    signals = [f"{name}.{field}" for name in "xy" for field in FIELDS[:25]]
    with (
        running(tmp_path, url, machine=machine(["x", "y"], 0.00025, 4000)),
        server(url) as (process, address),
        opened(browser, address, f"#tab=scope&signals={','.join(signals)}") as page,
    ):
        until(page, "() => window.takt.scope.store.series.size === 2")
        until(page, "() => [...window.takt.scope.store.series.values()].every((one) => one.moved > 0)")
        before, before_page = resident(process), heap(page)
        more = 48_000
        for _ in range(4):  # patiently
            wait_for_rows(page, rows(page) + more // 4)
        kept = more * (len(signals) + 2) * 8e-6  # MB: what would be there if rows were kept for ever
        assert resident(process) - before < 0.6 * kept
        assert heap(page) - before_page < 0.6 * kept


def test_pages_that_do_not_read_lose_what_is_theirs_alone(tmp_path: Path) -> None:
    """They are told how much. The engine goes on, so does another page, and the server keeps nothing for them."""
    url = new_url()
    signals = [f"{name}.{field}" for name in "xy" for field in FIELDS]
    with (
        running(tmp_path, url, machine=machine(["x", "y"], 0.00025, 4000)),
        server(url) as (process, address),
        contextlib.ExitStack() as stack,
    ):
        quick, *slow = [stack.enter_context(Client(address)) for _ in range(4)]
        live = address.replace("http", "ws") + "live"
        deaf = stack.enter_context(connect_socket(live, origin=address.rstrip("/"), max_queue=1))
        quick.look_at("x.set_position", "y.state")
        for client in slow:
            client.look_at(*signals)
            client.until(lambda client=client: len(client.signal("x.state")[0]) > 0)
        pairs = [[i, field] for i in (0, 1) for field in FIELDS]
        deaf.send(json.dumps({"epoch": quick.machine["epoch"], "signals": pairs}))
        stop = threading.Event()
        talks = threading.Thread(target=_says_that_it_has_drawn_all, args=(deaf, stop))
        talks.start()
        stack.callback(talks.join)
        stack.callback(stop.set)
        before = resident(process)
        most = CAPACITY + AHEAD * MOST_ROWS  # rows that a page which takes nothing more can still get
        since = max(quick.header["cycle"], *(client.signal("x.state")[0][-1] for client in slow))
        quick.until(lambda: quick.header["cycle"] > since + most, timeout=4 * PATIENCE_S)
        unread = most * (2 * len(FIELDS) + 2) * 8e-6  # MB of each of them
        assert resident(process) - before < unread
        for client in slow:
            newest = quick.header["cycle"]
            client.until(lambda client=client, newest=newest: client.signal("x.state")[0][-1] > newest)
            health = client.header["health"]
            assert health["skipped"] > 0
            assert set(client.holes.values()) == {1}  # where the ring was overwritten
            assert _missing(client) == health["skipped"] + health["lost"]
        assert _missing(quick) == quick.header["health"]["lost"]
        assert quick.header["health"]["skipped"] == 0
        assert not quick.header["health"]["gone"]


def _missing(client: Client) -> int:
    """Rows between those that have come, of both axes."""
    return int(sum(np.sum(np.diff(cycles) - 1) for cycles in map(np.concatenate, client.cycles.values())))


def _says_that_it_has_drawn_all(socket: ClientConnection, stop: threading.Event) -> None:
    while not stop.wait(0.05):
        socket.send('{"ack": 1000000}')


@needs_chromium
def test_a_thousand_axes_of_a_machine_file(tmp_path: Path, browser: Browser) -> None:
    file = tmp_path / "many.yaml"
    file.write_text(machine([f"axis_{i:04}" for i in range(1000)], rate_hz=20))  # the page takes as many a second
    with server(str(file)) as (_, address):
        began = time.monotonic()
        with opened(browser, address) as page:
            expect(row(page, "axis_0000").locator(".state")).to_have_text("Disabled")
            print(f"first picture after {time.monotonic() - began:.1f} s")
            until(page, "() => window.takt.model.rows.filter(Boolean).length === 1000")
            page.fill("#list-filter", "axis_0999")
            expect(row(page, "axis_0999").locator(".state")).to_have_text("Disabled")
            expect(page.locator("#list-count")).to_have_text("1 of 1000")
            row(page, "axis_0999").click()
            expect(page.locator("#details-name")).to_have_text("axis_0999")
            page.click("#tab-scope")
            page.fill("#filter", "axis_0777 set_velocity")
            page.locator("#signals .row:visible", has_text="set velocity").click()
            until(page, "() => window.takt.scope.signals.some((one) => one.name === 'axis_0777.set_velocity')")
            redraws = page.evaluate("() => window.takt.scope.redraws")
            until(page, "([before]) => window.takt.scope.redraws > before + 20", redraws)
            until(page, "() => window.takt.scope.store.series.get(777)?.end > 10")
