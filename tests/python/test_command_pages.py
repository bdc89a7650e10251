"""The pages about groups of commands: every command has its place, every picture is of a scenario that passes."""

from __future__ import annotations

from pathlib import Path

import pytest
import takt
from takt import reference
from takt.scenario import load_scenario, run_scenario

from tools import command_pages

ROOT = Path(__file__).resolve().parents[2]

FIGURES = {file.stem: file for file in command_pages.figures(ROOT / "docs" / "commands" / "flex_cam.py")}


def test_every_command_is_in_one_group() -> None:
    """AX-20 to AX-55, CAM-11."""
    named = [name for group in command_pages.GROUPS for name in command_pages.about(group).COMMANDS]
    assert sorted(named) == sorted(reference.verbs())


@pytest.mark.parametrize("group", command_pages.GROUPS, ids=lambda group: group.stem)
def test_a_page_is_made(group: Path, tmp_path: Path) -> None:
    page = command_pages.write(group, tmp_path).read_text(encoding="utf-8")
    for name in command_pages.about(group).COMMANDS:
        kind, _, verb = name.rpartition(".")
        assert f"{kind}: {verb}\n" in page
    for file in command_pages.figures(group) or [group]:
        picture = tmp_path / f"{file.stem}.png"
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert picture.name in page


def test_no_figure_is_missing() -> None:
    """Those of Flex Cam, 3-6 to 3-20."""
    assert [name.split("_")[2] for name in FIGURES] == [f"{number:02}" for number in range(6, 21)]


@pytest.mark.parametrize("figure", FIGURES.values(), ids=FIGURES)
def test_a_figure_shows_what_it_says(figure: Path) -> None:
    """CAM-20, CAM-21, CAM-30 to CAM-35, CAM-37, CAM-40 to CAM-42."""
    scenario = load_scenario(figure)
    with takt.Engine(scenario.machine) as engine:
        outcome = run_scenario(scenario, engine)
    assert outcome.passed, outcome.complaint
