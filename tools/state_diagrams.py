"""Sphinx draws ```mermaid blocks that are state diagrams: with Graphviz, as SVG in the page and in its colours.

Known are `A --> B` and `A --> B: what leads there`, with [*] for where it begins and ends; more is an error.
"""

from __future__ import annotations

import re
import subprocess
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive

ARROW = re.compile(r"(\[\*\]|\w+) --> (\[\*\]|\w+)(?:: (.+))?")
LOOK = (
    'digraph { bgcolor="transparent"; rankdir=LR; ranksep=0.55; nodesep=0.3;'
    ' node [shape=box, style=rounded, fontname="Helvetica", fontsize=11, height=0.35, margin="0.12,0.05"];'
    ' edge [fontname="Helvetica", fontsize=9, arrowsize=0.6];'
)
BREAK = 24  # letters, after which what leads there goes on in the next line


def dot(text: str) -> str:
    """The diagram in Graphviz' language. Raises ValueError for a line that is no arrow."""
    first, *lines = [line.strip() for line in text.strip().splitlines()]
    if first != "stateDiagram-v2":
        raise ValueError(f"a diagram begins with stateDiagram-v2, not with '{first}'")
    labels: dict[tuple[str, str], list[str]] = {}
    for line in filter(None, lines):
        arrow = ARROW.fullmatch(line)
        if not arrow:
            raise ValueError(f"expected 'A --> B: what leads there', found '{line}'")
        begin, end, label = arrow.groups()
        pair = ("begin" if begin == "[*]" else begin, "end" if end == "[*]" else end)
        labels.setdefault(pair, []).extend(_wrapped(label) if label else [])
    ends = [name for name in ("begin", "end") if any(name in pair for pair in labels)]
    parts = [LOOK, *(f'"{name}" [label="", shape=circle, width=0.12, height=0.12];' for name in ends)]
    for (begin, end), lines in labels.items():
        text = "\\n".join(line.replace('"', '\\"') for line in lines)
        parts.append(f'"{begin}" -> "{end}" [label="{text}"];')
    return "\n".join([*parts, "}"])


def _wrapped(label: str) -> list[str]:
    lines = [""]
    for word in label.split():
        if lines[-1] and len(lines[-1]) + len(word) > BREAK:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


class Mermaid(Directive):
    has_content = True

    def run(self) -> list[nodes.Node]:
        try:
            drawn = subprocess.run(
                ["dot", "-Tsvg"], input=dot("\n".join(self.content)), capture_output=True, text=True, check=True
            ).stdout
        except (ValueError, OSError, subprocess.CalledProcessError) as error:
            raise self.error(f"state diagram: {getattr(error, 'stderr', '') or error}") from error
        svg = drawn[drawn.index("<svg") :]
        return [nodes.raw("", f'<div class="states">{svg}</div>', format="html")]


def setup(app: Any) -> dict[str, bool]:
    app.add_directive("mermaid", Mermaid)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
