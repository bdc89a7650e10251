"""`takt view`."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import tempfile
import threading
import webbrowser
from collections.abc import Callable, Iterator
from pathlib import Path

from takt import _core
from takt.demo import free_url, taktd
from takt.engine import read_machine
from takt.network import DEFAULT_URL
from takt.view.server import serving

LOOK_S = 0.2  # from one look at the engine's process to the next


def run(what: str | None, port: int, browser: bool, pace: str, say: Callable[[str], None]) -> int:
    """Shows the engine of a network (its URL, or nothing for the usual one), or one of its own for a machine file."""
    for ending in (signal.SIGINT, signal.SIGTERM):  # either ends the engine in order, too
        signal.signal(ending, signal.default_int_handler)
    if what is None or "://" in what:
        url = what or os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL
        with serving(url, None, port) as address:
            _show(address, f"the engine on {url}", browser, say)
            threading.Event().wait()
    file = Path(what or "")
    _core.load_machine(*read_machine(file))  # says what is wrong with it
    url = free_url()
    with contextlib.ExitStack() as stack:
        directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="takt-view-")))
        address = stack.enter_context(serving(url, file.parent, port))
        engine = stack.enter_context(taktd(file, url, None, pace, directory))
        _show(address, f"{file} on {url}", browser, say)
        return _until_it_ends(engine, directory / "taktd.txt", say)


@contextlib.contextmanager
def beside(url: str, folder: Path, say: Callable[[str], None]) -> Iterator[None]:
    """The page of an engine that somebody else runs."""
    with serving(url, folder) as address:
        say(f"the live page: {address}")
        webbrowser.open(address)
        yield


def _show(address: str, what: str, browser: bool, say: Callable[[str], None]) -> None:
    say(f"{what}: {address} (Ctrl-C ends it)")
    if browser:
        webbrowser.open(address)


def _until_it_ends(engine: subprocess.Popen[bytes], text: Path, say: Callable[[str], None]) -> int:
    while engine.poll() is None:
        with contextlib.suppress(subprocess.TimeoutExpired):
            engine.wait(LOOK_S)
    say(f"taktd has ended: {text.read_text(errors='replace').strip()}")
    return 0 if engine.returncode == 0 else 1
