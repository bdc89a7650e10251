"""Makes the documentation as pages: gathers all of them, hand-written and generated, and has Sphinx make HTML of them.

Usage: build/venv/bin/python -m tools.docs_pages [DIRECTORY]       (./dev docs calls it; without one: build/docs)

DIRECTORY/source has what Sphinx is given: docs/*.md, whose blocks are run (tools/page_blocks.py), the pages about
commands with their pictures (tools/command_pages.py), the reference from the descriptions, the examples.
DIRECTORY/html has the pages. Any warning is an error.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import click
from sphinx.cmd.build import build_main
from takt import _core, reference
from takt.cli import cli

from tools import command_pages, page_blocks

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
EXAMPLES = ROOT / "python" / "examples"
SOURCES = {".py": "python", ".yaml": "yaml", ".gcode": "text", ".csv": "text"}
LONGEST = 300  # lines: of a longer source the page shows the beginning only

INTRODUCTIONS = {
    "machine_file": f"All that a machine file may say, made from the descriptions in C++. {reference.UNITS} `takt "
    "check` holds a file against this, `takt schema` prints it as JSON Schema for editors.",
    "published": "What every component publishes at the end of each cycle: columns of recordings, properties in "
    "Python, fields of messages.",
    "states": "The state diagram of PLCopen, made from the table that the engine runs (`axis/state_table.h`).",
    "homing": "How a search for a reference goes, made from the table that the engine runs (`axis/homing.h`).",
    "errors": "The numbers with which commands end and which components show; `takt.error_text(number)` has "
    "the sentences.",
    "commands": "Every command with its arguments, their units, ranges and defaults, the errors that it can end with, "
    "and a scenario that shows it. They are methods of components in Python (`axis.move_absolute(position=100)`) and "
    "messages on `takt/command`.",
    "channels": "The messages on LCM, made from `lcmtypes/`. Each component has a channel, `takt/KIND/NAME`. "
    "Positions, velocities and voltages are in the units given here; u is an axis' own.",
    "examples": "Whole machines, run by the tests.",
}


def gather(source: Path, run: bool = True) -> None:
    """Writes what Sphinx is given. Without `run` no scenario and no block runs, so pictures are missing."""
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    shutil.copytree(DOCS / "images", source / "images")
    with ThreadPoolExecutor(2) as pool:  # blocks wait for processes of their own
        checks = [pool.submit(page_blocks.check, page, source / page.stem) for page in page_blocks.pages() if run]
        for page in DOCS.glob("*.md"):
            text = page_blocks.dressed(page.read_text(encoding="utf-8"))
            (source / page.name).write_text(_led(text, source), encoding="utf-8")
        (source / "commands").mkdir()
        for group in command_pages.GROUPS:
            page = command_pages.write(group, source / "commands", run)
            page.write_text(_led(page.read_text(encoding="utf-8"), page.parent), encoding="utf-8")
        for done in checks:
            done.result()
    for folder, texts in (("reference", _reference_pages()), ("examples", _example_pages())):
        (source / folder).mkdir()
        for name, text in texts:
            (source / folder / f"{name}.md").write_text(text, encoding="utf-8")


def make_html(source: Path, directory: Path, *options: str) -> int:
    """Has Sphinx make pages; its exit code, not 0 after any warning."""
    cached = directory.parent / "doctrees"
    given = ["-W", "--keep-going", "-q", "-b", "html", "-c", str(DOCS), "-d", str(cached), *options]
    return build_main([*given, str(source), str(directory)])


def _led(text: str, folder: Path) -> str:
    """The text of a page in `folder`, whose links out of the documentation lead to the pages of examples, else to the
    files of the repository."""

    def lead(link: re.Match[str]) -> str:
        target = ROOT / link[1]
        if target.parent == DOCS:
            return f"](/{target.name})"
        if target.parent == EXAMPLES and target.is_dir():
            return f"](/examples/{target.name}.md)"
        return f"]({os.path.relpath(target, folder)})"

    return re.sub(r"\]\((?:\.\./)+((?:python|docs|cpp|tests|lcmtypes)/[\w/.]+)\)", lead, text)


def _reference_pages() -> Iterator[tuple[str, str]]:
    for name, text in reference.sections().items():
        if name == "commands":
            yield name, _list_of_commands()
            continue
        title, _, rest = text.partition("\n")
        lifted = re.sub(r"^##(#+) ", r"#\1 ", rest, flags=re.MULTILINE)
        yield name, f"{title[1:]}\n\n{INTRODUCTIONS[name]}\n{lifted}"
    yield "command_line", "\n".join(_command_line())
    yield "channels", "\n".join(_channels())


def _list_of_commands() -> str:
    """Every command of each kind of component, with a link to the page of its group."""
    groups = {name: group.stem for group in command_pages.GROUPS for name in command_pages.about(group).COMMANDS}
    described = json.loads(_core.reference())
    kinds = {"machine": "The machine"} | {kind["name"]: kind["many"].capitalize() for kind in described["kinds"]}
    lines = ["# Commands", "", INTRODUCTIONS["commands"], ""]
    for kind, title in kinds.items():
        verbs = [verb for verb in described["verbs"] if verb["target_kind"] == kind]
        if not verbs:
            continue
        lines += [f"## {title}", "", "| command | |", "|---|---|"]
        for verb in verbs:
            called = verb["name"] if kind in ("machine", "axis") else f"{kind}.{verb['name']}"
            link = f"../commands/{groups[called]}.md#{kind}-{verb['name']}"
            lines.append(f"| [{verb['name']}]({link}) | {verb['arguments']['about']} |".replace("\n", " "))
        lines.append("")
    lines += ["```{toctree}", ":caption: Groups of commands", ":maxdepth: 1", ""]
    return "\n".join([*lines, *(f"../commands/{group.stem}" for group in command_pages.GROUPS), "```", ""])


def _command_line() -> Iterator[str]:
    """What each command of `takt` says of itself."""
    yield "# The command line\n"
    yield "Exit code 0: all is well; 1: something that was checked has failed; 2: bad input, said in one line.\n"
    yield from _commands_of(cli, click.Context(cli, info_name="takt", max_content_width=96, terminal_width=96))


def _commands_of(group: click.Group, context: click.Context) -> Iterator[str]:
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        inner = click.Context(command, info_name=name, parent=context, max_content_width=96, terminal_width=96)
        yield f"## {inner.command_path}\n\n```text\n{command.get_help(inner)}\n```\n"
        if isinstance(command, click.Group):
            yield from _commands_of(command, inner)


def _channels() -> Iterator[str]:
    """The messages of lcmtypes/, with what is said of them and of their fields there."""
    yield f"# LCM channels\n\n{INTRODUCTIONS['channels']}\n"
    for file in sorted((ROOT / "lcmtypes").glob("*.lcm")):
        about, name, body = re.findall(r"((?:^//.*\n)*)struct (\w+) \{\n(.*?)^\}", file.read_text(), re.M | re.S)[0]
        yield f"## {name}\n\n{_prose(about)}\n\n| field | type | meaning |\n|---|---|---|"
        for said, kind, field in re.findall(r"((?:^ *//.*\n)*)^ +(?!//)(\S+) +([^;\n]+);", body, re.M):
            yield f"| {field} | {kind} | {_prose(said)} |"
        yield ""


def _prose(comment: str) -> str:
    text = " ".join(line.strip().removeprefix("//").strip() for line in comment.splitlines())
    return text.replace("<", "&lt;").replace("|", "\\|")


def _example_pages() -> Iterator[tuple[str, str]]:
    """The sources of each example."""
    folders = sorted(folder for folder in EXAMPLES.iterdir() if (folder / "scenario.py").is_file())
    toctree = "\n".join(folder.name for folder in folders)
    listed = f"```{{toctree}}\n:maxdepth: 1\n\n{toctree}\n```\n"
    yield "index", f"# Examples\n\n{INTRODUCTIONS['examples']}\n\n{listed}"
    for folder in folders:
        about = command_pages.about(folder / "scenario.py").__doc__ or folder.name
        title, _, text = about.strip().partition("\n")
        parts = [f"# {folder.name.replace('_', ' ').capitalize()}", title, text.strip()]
        parts += [f"```sh\ntakt run python/examples/{folder.name}/scenario.py --report build/{folder.name}\n```"]
        for file in sorted(folder.iterdir(), key=lambda file: (file.suffix != ".yaml", file.name)):
            if file.suffix in SOURCES:
                lines = file.read_text(encoding="utf-8").splitlines()
                more = [f"The first {LONGEST} of {len(lines)} lines:"] if lines[LONGEST:] else []
                parts += [f"## {file.name}", *more]
                parts += ["\n".join([f"````{SOURCES[file.suffix]}", *lines[:LONGEST], "````"])]
        yield folder.name, "\n\n".join(parts) + "\n"


def main(directory: Path) -> int:
    gather(directory / "source")
    code = make_html(directory / "source", directory / "html")
    if code == 0:
        print(directory / "html" / "index.html")
    return code


if __name__ == "__main__":
    try:
        sys.exit(main(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build" / "docs"))
    except page_blocks.PageError as error:
        sys.exit(str(error))
