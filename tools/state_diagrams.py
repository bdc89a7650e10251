"""Sphinx draws ```mermaid blocks that are state diagrams: with Graphviz, as SVG in the page and in its colours.

Known are `A --> B` and `A --> B: what leads there`, with [*] for where it begins and ends; more is an error.
"""

from __future__ import annotations

import html
import re
import subprocess
from collections import Counter
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive

ARROW = re.compile(r"(\[\*\]|\w+) --> (\[\*\]|\w+)(?:: (.+))?")
LOOK = (
    'digraph { bgcolor="transparent"; ranksep=0.4; nodesep=0.25;'
    ' node [shape=box, style=rounded, fontname="Helvetica", fontsize=11, height=0.35, margin="0.12,0.05"];'
    ' edge [fontname="Helvetica", fontsize=9, arrowsize=0.6];'
)
SMALLEST = 0.65  # of its own size
MANY = 4
BREAK = 24  # letters, after which what leads there goes on in the next line


Arrow = tuple[str, str, str]  # from, to, what leads there


def arrows(text: str) -> list[Arrow]:
    """The arrows of a diagram. Raises ValueError for a line that is none."""
    first, *lines = [line.strip() for line in text.strip().splitlines()]
    if first != "stateDiagram-v2":
        raise ValueError(f"a diagram begins with stateDiagram-v2, not with '{first}'")
    found = []
    for line in filter(None, lines):
        arrow = ARROW.fullmatch(line)
        if not arrow:
            raise ValueError(f"expected 'A --> B: what leads there', found '{line}'")
        found.append((arrow[1], arrow[2], arrow[3] or ""))
    return found


def dot(arrows: list[Arrow]) -> str:
    """The diagram in Graphviz' language; arrows between the same two states are one, and so are those that lead from
    many states to one for the same reason."""
    alike = Counter((end, label) for _, end, label in arrows)
    labels: dict[tuple[str, str], list[str]] = {}
    for begin, end, label in arrows:
        count = alike[end, label]
        many = f"{count} states" if count >= MANY else ""
        pair = (
            f"{many}, {end}: {label}" if many else "begin" if begin == "[*]" else begin,
            "end" if end == "[*]" else end,
        )
        if not (many and pair in labels):
            labels.setdefault(pair, []).extend(_wrapped(label))
    parts = [LOOK]
    for name in dict.fromkeys(name for pair in labels for name in pair):
        if name in ("begin", "end"):
            parts.append(f'"{name}" [label="", shape=circle, width=0.12, height=0.12];')
        elif ", " in name:
            parts.append(f'"{name}" [label="{name.split(",")[0]}", shape=plaintext];')
    for (begin, end), lines in labels.items():
        text = "\\n".join(line.replace('"', '\\"') for line in lines)
        parts.append(f'"{begin}" -> "{end}" [label="{text}"];')
    return "\n".join([*parts, "}"])


def drawn(text: str) -> str:
    """The diagram as HTML: the picture, which shrinks no further than one can read it, and all of it as a table."""
    known = arrows(text)
    narrower, svg = min(_laid_out(dot(known), direction) for direction in ("LR", "TB"))
    svg = svg.replace("<svg", f'<svg style="min-width: {SMALLEST * narrower:.0f}pt"', 1)
    rows = "".join(f"<tr><td>{a}</td><td>→ {b}</td><td>{html.escape(by)}</td></tr>" for a, b, by in known)
    table = f"<details><summary>as a table</summary><table>{rows}</table></details>"
    return f'<div class="states">{svg}{table}</div>'


def _laid_out(text: str, direction: str) -> tuple[float, str]:
    """How wide it becomes, pt, and its SVG."""
    command = ["dot", "-Tsvg", f"-Grankdir={direction}"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=True)
    svg = done.stdout[done.stdout.index("<svg") :]
    return float(re.findall(r'width="([\d.]+)pt"', svg)[0]), svg


def _wrapped(label: str) -> list[str]:
    lines: list[str] = []
    for word in label.split():
        if lines and len(lines[-1]) + len(word) <= BREAK:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return lines


class Mermaid(Directive):
    has_content = True

    def run(self) -> list[nodes.Node]:
        try:
            return [nodes.raw("", drawn("\n".join(self.content)), format="html")]
        except (ValueError, OSError, subprocess.CalledProcessError) as error:
            raise self.error(f"state diagram: {getattr(error, 'stderr', '') or error}") from error


def setup(app: Any) -> dict[str, bool]:
    app.add_directive("mermaid", Mermaid)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
