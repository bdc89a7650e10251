"""How programs of ours are ended."""

from __future__ import annotations

import signal
import time
from typing import NoReturn

LOOK_S = 0.2


def end_in_order() -> None:
    """Ctrl-C, a request to end, the end of the terminal: each comes as KeyboardInterrupt, so what was begun is ended,
    too. Who ignores the end of terminals (nohup) goes on."""
    for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if ending is not signal.SIGHUP or signal.getsignal(ending) is not signal.SIG_IGN:
            signal.signal(ending, signal.default_int_handler)


def wait_until_ended() -> NoReturn:
    """Until KeyboardInterrupt. Wakes up now and then: where the system hands a signal to another thread, one of LCM's,
    nothing tells this one."""
    while True:
        time.sleep(LOOK_S)
