"""What tests of this folder share without asking for it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for all tests of a file; ask for it where `pages.needs_chromium` holds."""
    from playwright.sync_api import sync_playwright

    from tools.browser import CHROMIUM, FLAGS

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(params=["canopen", "ethercat"])
def bus(request: pytest.FixtureRequest) -> Iterator[str]:
    """A bus of this test alone: each test runs on CANopen and on EtherCAT."""
    import buses

    if request.param == "canopen":
        yield buses.new_bus()
        return
    pytest.importorskip("pysoem")
    import wires

    with wires.own_network():
        yield wires.BUS
