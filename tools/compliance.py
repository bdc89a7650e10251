"""Writes docs/plcopen.md: what takt.plcopen has of the standard. To be called when blocks or spec/ change.

Usage: build/venv/bin/python tools/compliance.py
"""

from __future__ import annotations

from pathlib import Path

from takt.plcopen import compliance

PAGE = Path(__file__).resolve().parent.parent / "docs" / "plcopen.md"

if __name__ == "__main__":
    PAGE.write_text(compliance(), encoding="utf-8")
