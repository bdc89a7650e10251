"""The pages say what is true: their blocks run and print what stands there, what they quote and name is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from takt import reference

from tools import command_pages, page_blocks
from tools.doc_strings import to_rst
from tools.page_blocks import PageError
from tools.state_diagrams import arrows, dot

ROOT = Path(__file__).resolve().parents[2]

PAGES = sorted((ROOT / "docs").glob("*.md"))
COMPONENTS = (
    *("axis", "couplings", "cams", "flex_cam", "groups", "conveyors", "pick_and_place"),
    *("movers", "tracks", "planar_groups", "parts", "environments"),
)
# Where a name with a folder in it may stand: "axis/homing.h" is below cpp/takt.
PLACES = [ROOT / place for place in ("", "cpp/takt", "python/takt", "docs")]


@pytest.mark.parametrize("page", page_blocks.pages(), ids=lambda page: page.stem)
def test_a_page_says_what_its_blocks_print(page: Path, tmp_path: Path) -> None:
    page_blocks.check(page, tmp_path)


@pytest.mark.parametrize("name", COMPONENTS)
def test_a_component_has_a_machine_and_a_scenario_with_a_picture(name: str) -> None:
    text = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    for wanted in ("```yaml machine.yaml\n", "```python scenario.py\n", "takt run scenario.py", f"]({name}/"):
        assert wanted in text, wanted
    assert re.search(r"\]\(commands/\w+\.md\)", text), "no link to its commands"


def test_every_group_of_commands_is_named_on_a_page() -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    assert [group.stem for group in command_pages.GROUPS if f"(commands/{group.stem}.md)" not in text] == []


def test_commands_that_the_page_of_axes_lists_are_there() -> None:
    """AX-107: its table of commands."""
    text = (ROOT / "docs" / "axis.md").read_text(encoding="utf-8")
    rows = [row for row in text.splitlines() if row.startswith("|") and "(commands/" in row]
    named = {name for row in rows for name in re.findall(r"`([a-z_]+)`", row)}
    assert len(named) > 15
    assert named - {verb.rpartition(".")[2] for verb in reference.verbs()} == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_files_that_a_page_names_are_there(page: Path) -> None:
    named = re.findall(r"`((?:[\w.]+/)+\w+(?:\.(?:h|cc|py|lcm|md|yaml))?)`", page.read_text(encoding="utf-8"))
    files = [name for name in named if re.search(r"\.(h|cc|py|lcm|md|yaml)$", name) and "NAME" not in name]
    missing = [
        name
        for name in files
        if not any((place / name).is_file() for place in PLACES)
        and not name.startswith(("build/", "KIND/", "gear/", "cell/", "plane/", "cam/run"))
    ]
    assert missing == []


def said(page: Path, text: str) -> Path:
    page.write_text(text, encoding="utf-8")
    return page


def test_what_is_not_true_is_found(tmp_path: Path) -> None:
    """Each kind of block, with what is wrong and where."""
    page, directory = tmp_path / "page.md", tmp_path / "run"
    page_blocks.check(said(page, "```python run\nprint(1)\n```\n\n```text output\n1\n```\n"), directory)
    for text, wrong in (
        ("```python run\nprint(2)\n```\n\n```text output\n1\n```\n", r"-1\n\+2"),
        ("x\n```python run\n1 / 0\n```\n", r"page.md:2: ended with exit code 1:(.|\n)*ZeroDivisionError"),
        ("```sh run fails\ntrue\n```\n", "page.md:1: ended with exit code 0"),
        ("![A picture](page/none.png)\n```sh run\ntrue\n```\n", "no block makes the picture none.png"),
        ("```cpp from cpp/takt/core/none.h\nint x;\n```\n", "there is no file cpp/takt/core/none.h"),
        ("```cpp from cpp/takt/conveyor/pose.h\nstruct PoseParams {\n  int no;\n```\n", "does not stand in"),
    ):
        with pytest.raises(PageError, match=wrong):
            page_blocks.check(said(page, text), directory)


def test_blocks_in_order(tmp_path: Path) -> None:
    """Files are there for what runs later, outputs are of all since the last one, quotations leave lines out."""
    page = said(
        tmp_path / "page.md",
        "```text sub/a.txt\nhello\n```\n```sh run\ncat sub/a.txt\n```\n```python run\nprint('x  ')\n```\n"
        "```text output\n```\n```sh run\ncp sub/a.txt a.png\n```\n![It](page/a.png)\n"
        "```cpp from cpp/takt/conveyor/pose.h\nstruct PoseParams {\n...\nstruct PoseState {\n```\n",
    )
    prints = page_blocks.run(page, tmp_path / "run")
    assert "```text output\nhello\nx\n```\n" in prints
    page_blocks.check(said(page, prints), tmp_path / "again")
    dressed = page_blocks.dressed(prints)
    assert "```{code-block} text\n:caption: sub/a.txt\n\nhello\n```" in dressed
    assert "```{code-block} text\n:class: output\n\nhello\nx\n```" in dressed
    assert "```sh\ncat sub/a.txt\n```" in dressed


def test_state_diagrams() -> None:
    known = arrows('stateDiagram-v2\n  [*] --> Off\n  Off --> On: power\n  Off --> On: jog "it"\n')
    assert known == [("[*]", "Off", ""), ("Off", "On", "power"), ("Off", "On", 'jog "it"')]
    assert '"Off" -> "On" [label="power\\njog \\"it\\""];' in dot(known)
    many = dot([*known, *((state, "Error", "fault") for state in "abcd")])
    assert many.count('"Error" [label="fault"]') == 1
    assert '[label="4 states", shape=plaintext]' in many
    with pytest.raises(ValueError, match="found 'A -> B'"):
        arrows("stateDiagram-v2\n  A -> B")


def test_states_of_groups_are_those_of_the_engine() -> None:
    table = (ROOT / "cpp" / "takt" / "group" / "state_table.h").read_text(encoding="utf-8")
    rows = re.findall(r'Transition\{GroupState::k(\w+), GroupState::k(\w+),\s*"([^"]*)"\}', table)
    drawn = re.findall(r"```mermaid\n(.*?)```", (ROOT / "docs" / "groups.md").read_text(encoding="utf-8"), re.DOTALL)
    assert len(rows) == 18
    assert arrows(drawn[0]) == [(f"Group{a}", f"Group{b}", by) for a, b, by in rows]


def test_doc_strings_become_what_they_look_like() -> None:
    text = "Draws |x| with `a|b`.\n\n    code * here\n\nfirst: what it is,\n    and more.\nsecond: the other."
    assert to_rst(text.splitlines()) == [
        *("Draws \\|x\\| with `a|b`.", ""),
        *("::", "", "    code * here", ""),
        *("", "- **first**: what it is,", "  and more.", "- **second**: the other.", ""),
    ]
