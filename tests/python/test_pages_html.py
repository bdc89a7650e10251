"""`./dev docs` makes pages without a warning: every link and every page has its place, and nothing needs a network."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from takt import reference

from tools import docs_pages

ROOT = Path(__file__).resolve().parents[2]

# Nothing runs here (test_pages.py and test_command_pages.py see to that), so the pictures of runs are missing.
WITHOUT_PICTURES = ("-D", "suppress_warnings=image.not_readable")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("docs")
    docs_pages.gather(directory / "source", run=False)
    assert docs_pages.make_html(directory / "source", directory / "html", *WITHOUT_PICTURES) == 0
    return directory


def test_all_pages_are_there(made: Path) -> None:
    pages = {page.relative_to(made / "html").as_posix() for page in (made / "html").rglob("*.html")}
    expected = {f"{page.stem}.html" for page in (ROOT / "docs").glob("*.md")}
    expected |= {f"commands/{group.stem}.html" for group in (ROOT / "docs" / "commands").glob("*.py")}
    expected |= {f"reference/{name}.html" for name in (*reference.sections(), "channels", "command_line")}
    expected |= {"examples/pick_cell.html", "examples/delta_cell.html", "search.html"}
    assert expected <= pages


def test_every_command_is_linked(made: Path) -> None:
    """The list leads to the heading of each command on the page of its group."""
    listed = (made / "html" / "reference" / "commands.html").read_text(encoding="utf-8")
    for name in reference.verbs():
        kind, _, verb = name.rpartition(".")
        heading = f"{kind or '(machine|axis)'}-{verb}".replace("_", "-")
        assert re.search(rf'href="\.\./commands/\w+\.html#{heading}"', listed), name


def test_fields_of_messages_are_said(made: Path) -> None:
    page = (made / "source" / "reference" / "channels.md").read_text(encoding="utf-8")
    assert "| set_position | double | [u] Set point; rotary axes: in [0, modulus). |" in page
    messages = {file.stem for file in (ROOT / "lcmtypes").glob("*.lcm")}
    assert set(re.findall(r"^## (\w+)$", page, re.MULTILINE)) == messages


def test_nothing_comes_from_elsewhere(made: Path) -> None:
    for page in (made / "html").rglob("*.html"):
        loaded = re.findall(
            r'<(?:script|img|link)[^>]*?(?:src|href)="(https?:[^"]*)"', page.read_text(encoding="utf-8")
        )
        assert loaded == [], page.name
    for style in (made / "html").rglob("*.css"):
        assert not re.search(r"url\(\s*['\"]?https?:", style.read_text(encoding="utf-8")), style.name
    assert "move_absolut" in (made / "html" / "searchindex.js").read_text(encoding="utf-8")


def test_what_leads_nowhere_is_an_error(made: Path) -> None:
    lines = {
        "[a page](none.md)": "'none.md'",
        "[a heading](tracks.md#none)": "'none'",
        "[a file](../python/none.yaml)": "'../python/none.yaml'",
        "```mermaid\nstateDiagram-v2\n  A -> B\n```": "found 'A -> B'",
    }
    page = made / "source" / "axis.md"
    page.write_text("\n\n".join([page.read_text(encoding="utf-8"), *lines]), encoding="utf-8")
    (made / "source" / "lonely.md").write_text("# On no list\n", encoding="utf-8")
    written = made / "warnings.txt"
    assert docs_pages.make_html(made / "source", made / "again", *WITHOUT_PICTURES, "-w", str(written)) != 0
    warnings = written.read_text(encoding="utf-8")
    assert [wrong for wrong in lines.values() if wrong not in warnings] == []
    assert "lonely.md: WARNING: document isn't included in any toctree" in warnings
