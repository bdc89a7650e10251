"""`takt view`."""

from __future__ import annotations

import contextlib
import subprocess
import tempfile
import threading
import webbrowser
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from takt import _core
from takt.demo import free_url, taktd
from takt.ending import end_in_order, wait_until_ended
from takt.engine import read_machine
from takt.keys import KeyFile, read_key
from takt.network import usual_url
from takt.view.server import serving

LOOK_S = 0.2  # interval of checks whether the engine's process has ended
OPENS_S = 15.0  # time for a browser to open the page, before the scenario begins without it


def run(
    what: str | None, port: int, browser: bool, pace: str, say: Callable[[str], None], key_file: KeyFile | None = None
) -> int:
    """Shows the engine of a network (its URL; None: the default one), or an own engine for a machine file, with the key
    in this file (`read_key`). port 0: any. Returns the exit status."""
    key = read_key(key_file)
    end_in_order()
    if what is None or "://" in what:
        url = what or usual_url()
        with serving(url, port, key=key) as address:
            _show(address, f"the engine on {url}", browser, say)
            wait_until_ended()
    file = Path(what or "")
    _core.load_machine(*read_machine(file))  # raises if the file is invalid
    url = free_url()
    with contextlib.ExitStack() as stack:
        directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="takt-view-")))
        address = stack.enter_context(serving(url, port, key=key, file=file))
        engine = stack.enter_context(taktd(file, url, None, pace, directory, key))
        _show(address, f"{file} on {url}", browser, say)
        return _until_it_ends(engine, directory / "taktd.txt", say)


@dataclass(frozen=True)
class Beside:
    """The live page of an engine that the caller runs, as a context: call it with the URL of the engine's network. It
    begins when the page has drawn something, or after OPENS_S."""

    shows: str  # initial view of the page, as in its address
    port: int  # 0: any
    browser: bool
    say: Callable[[str], None]
    machine: Path | None = None  # machine file

    @contextlib.contextmanager
    def __call__(self, url: str) -> Iterator[None]:
        end_in_order()
        drawn = threading.Event()
        with serving(url, self.port, drawn, read_key(), self.machine) as address:
            address += f"#{self.shows}" if self.shows else ""
            self.say(f"the live page: {address} (the scenario begins as soon as it is open)")
            if self.browser:
                webbrowser.open(address)
            if not drawn.wait(OPENS_S):
                self.say(f"no page was opened within {OPENS_S:g} s: the scenario begins without one")
            yield

    def stay(self) -> None:
        """Waits for Ctrl-C."""
        with contextlib.suppress(KeyboardInterrupt):  # it may come at once
            self.say("the engine and its page stay until Ctrl-C")
            wait_until_ended()


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
