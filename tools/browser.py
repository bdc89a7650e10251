"""The browser in which tests and pictures see the pages. It draws no window about a page, whose toolbars cost several
times as much as the page."""

from __future__ import annotations

import shutil

CHROMIUM = shutil.which("chromium-headless-shell")  # None: not installed (`./dev setup`)
FLAGS = (
    "--no-sandbox --disable-gpu --disable-background-networking --disable-component-update --disable-sync "
    "--no-first-run"
).split()
