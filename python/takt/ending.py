"""How programs of ours are ended."""

from __future__ import annotations

import signal


def end_in_order() -> None:
    """Whichever signal ends this process, it comes as KeyboardInterrupt: what was begun is ended, too."""
    for ending in (signal.SIGINT, signal.SIGTERM):
        signal.signal(ending, signal.default_int_handler)
