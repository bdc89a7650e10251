"""Ends programs of this package in an orderly way."""

from __future__ import annotations

import signal
import time
from typing import NoReturn

LOOK_S = 0.2


def end_in_order() -> None:
    """Turns SIGINT, SIGTERM and SIGHUP into KeyboardInterrupt, so that contexts are left in an orderly way. An ignored
    SIGHUP (nohup) stays ignored."""
    for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if ending is not signal.SIGHUP or signal.getsignal(ending) is not signal.SIG_IGN:
            signal.signal(ending, signal.default_int_handler)


def wait_until_ended() -> NoReturn:
    """Waits until KeyboardInterrupt. Wakes up periodically: a signal that the system delivers to another thread, as one
    of LCM's, does not wake this one."""
    while True:
        time.sleep(LOOK_S)
