"""What holds for all tests in Python."""

from __future__ import annotations

import os

from hypothesis import settings

# The same examples each time: a test that fails once in a hundred runs tells nobody why.
# The long run looks for new ones.
settings.register_profile("same each time", derandomize=True, database=None)
if not os.environ.get("TAKT_LONG"):
    settings.load_profile("same each time")
