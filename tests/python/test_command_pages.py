"""The pages about groups of commands: every command has its place, every picture is of a scenario that passes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from takt import reference

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import command_pages  # noqa: E402


def test_every_command_is_in_one_group() -> None:
    """AX-20 to AX-55."""
    named = [name for group in command_pages.GROUPS for name in command_pages.about(group).COMMANDS]
    assert sorted(named) == sorted(reference.verbs())


@pytest.mark.parametrize("group", command_pages.GROUPS, ids=lambda group: group.stem)
def test_a_page_is_made(group: Path, tmp_path: Path) -> None:
    page = command_pages.write(group, tmp_path).read_text(encoding="utf-8")
    for name in command_pages.about(group).COMMANDS:
        kind, _, verb = name.rpartition(".")
        assert f"{kind}: {verb}\n" in page
    picture = tmp_path / f"{group.stem}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert picture.name in page
