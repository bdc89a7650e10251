"""What holds for all tests in Python."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from hypothesis import settings

sys.path.insert(0, str(Path(__file__).parent.parent))  # tools
sys.path.insert(0, str(Path(__file__).parent))
from starved import Host

# The same examples each time: a test that fails once in a hundred runs tells nobody why.
# The long run looks for new ones. No deadlines: a busy host is no fault.
settings.register_profile("same each time", derandomize=True, database=None, deadline=None)
settings.register_profile("new ones", deadline=None)
settings.load_profile("new ones" if os.environ.get("TAKT_LONG") else "same each time")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "any_host: a failure is a fault, however busy the host is")
    if folder := os.environ.get("TAKT_BUILD_DIR"):
        config.pluginmanager.register(Host(Path(folder)), "host")
