"""Runs what stands in the blocks of a page, in order, and says what the page would have to say.

    ```yaml machine.yaml      this block is the file machine.yaml
    ```python run             a program, run as it stands; `sh run` a command line
    ```python run fails       the same, but its exit code is not 0
    ```text output            what was printed since the last block of this kind
    ```cpp from PATH          stands in that file of the repository as it stands here; a line `...` leaves some out

All other blocks are only read. Blocks run in a directory of the page's own, where the pictures lie that it shows:
`![...](tutorial/first.png)` in docs/tutorial.md is the file first.png that a block of it has made.

Usage: build/venv/bin/python tools/page_blocks.py PAGE...       (puts into the pages what their blocks print)
"""

from __future__ import annotations

import difflib
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"

BLOCK = re.compile(r"^```(\w+) ([^\n]+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PICTURE = re.compile(r"!\[[^\]]*\]\((\w+)/([\w./]+)\)")
TIMEOUT_S = 300.0


class PageError(Exception):
    """A block does not do what its page says."""


def pages() -> list[Path]:
    """Those with blocks."""
    return [page for page in sorted(DOCS.glob("*.md")) if BLOCK.search(page.read_text(encoding="utf-8"))]


def run(page: Path, directory: Path) -> str:
    """The text of a page with what its blocks print now. Raises PageError where one fails, a quotation is none or a
    picture is not made."""
    printed = ""

    def carry_out(match: re.Match[str]) -> str:
        nonlocal printed
        language, words, text = match.groups()
        kind, *more = words.split()
        where = f"{page.name}:{page_text.count(chr(10), 0, match.start()) + 1}"
        if kind == "run":
            printed += _printed(language, text, directory, where, fails=more == ["fails"])
        elif kind == "output":
            text, printed = printed, ""
        elif kind == "from":
            _check_quotation(text, ROOT / more[0], where)
        else:
            _write(directory / kind, text)
        return f"```{language} {words}\n{text}```"

    page_text = page.read_text(encoding="utf-8")
    directory.mkdir(parents=True, exist_ok=True)
    said = BLOCK.sub(carry_out, page_text)
    for folder, name in PICTURE.findall(page_text):
        if folder == page.stem and not (directory / name).is_file():
            raise PageError(f"{page.name}: no block makes the picture {name}")
    return said


def unpack(page: Path, directory: Path) -> None:
    """Writes the files of a page, and runs nothing."""
    for _, words, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        if words.split()[0] not in ("run", "output", "from"):
            _write(directory / words, text)


def check(page: Path, directory: Path) -> None:
    """Runs a page. Raises PageError unless it says what its blocks print."""
    said = page.read_text(encoding="utf-8")
    prints = run(page, directory)
    if said != prints:
        lines = difflib.unified_diff(said.splitlines(), prints.splitlines(), f"{page.name} says", "it prints", n=1)
        raise PageError("\n".join(lines))


def dressed(text: str) -> str:
    """The text of a page as Sphinx takes it: files under their names, and nothing of how blocks run."""

    def dress(match: re.Match[str]) -> str:
        language, words, code = match.groups()
        kind, *more = words.split()
        if kind == "run":
            return f"```{language}\n{code}```"
        if kind == "output":
            return f"```{{code-block}} {language}\n:class: output\n\n{code}```"
        caption = more[0] if kind == "from" else kind
        return f"```{{code-block}} {language}\n:caption: {caption}\n\n{code}```"

    return BLOCK.sub(dress, text)


def _write(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


def _printed(language: str, text: str, directory: Path, where: str, fails: bool) -> str:
    command = {"python": [sys.executable, "-c", text], "sh": ["sh", "-e", "-c", text]}[language]
    env = os.environ | {
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PYTHONDONTWRITEBYTECODE": "1",
        **{"COLUMNS": "96", "LINES": "40", "TERM": "dumb", "TTY_COMPATIBLE": "1"},  # a terminal without colours
        "TTY_INTERACTIVE": "0",  # and without progress bars
    }
    done = subprocess.run(
        command,
        cwd=directory,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    if (done.returncode != 0) != fails:
        raise PageError(f"{where}: ended with exit code {done.returncode}:\n{done.stdout}")
    return "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines())


def _check_quotation(text: str, file: Path, where: str) -> None:
    if not file.is_file():
        raise PageError(f"{where}: there is no file {file.relative_to(ROOT)}")
    source, begin = file.read_text(encoding="utf-8"), 0
    for part in re.split(r"^\s*\.\.\.\n", text, flags=re.MULTILINE):
        found = source.find(part.strip("\n"), begin)
        if found < 0:
            raise PageError(f"{where}: this does not stand in {file.relative_to(ROOT)}:\n{part}")
        begin = found + len(part.strip("\n"))


def main(names: list[str]) -> None:
    for page in [Path(name).resolve() for name in names] or pages():
        with tempfile.TemporaryDirectory() as directory:
            page.write_text(run(page, Path(directory)), encoding="utf-8")
        print(page)


if __name__ == "__main__":
    main(sys.argv[1:])
