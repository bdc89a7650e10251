"""JavaScript modules inside a page: an import map that holds each of them as a data URL, so that the page opens from a
file, offline, with the same modules that the live page loads from its server."""

from __future__ import annotations

import base64
import json
import posixpath
import re
from importlib import resources

IMPORT = re.compile(r'(^import[^;]*?|^export[^;]*? from )"(\.{1,2}/[^"]+)"', re.MULTILINE)


def asset(*path: str) -> str:
    """Returns a file of this package as text."""
    return resources.files("takt").joinpath(*path).read_text(encoding="utf-8")


def import_map(main: str) -> str:
    """Returns the import map of `main` ("takt/report/page/main.js") and all its imports, by their paths in the package.
    Modules in data URLs have no path of their own, so their relative imports are made absolute."""
    modules: dict[str, str] = {}
    waiting = [main]
    while waiting:
        place = waiting.pop()
        if place in modules:
            continue

        def spelled_out(found: re.Match[str], folder: str = posixpath.dirname(place)) -> str:
            name = posixpath.normpath(posixpath.join(folder, found[2]))
            waiting.append(name)
            return f'{found[1]}"{name}"'

        modules[place] = IMPORT.sub(spelled_out, asset(*place.split("/")[1:]))
    urls = {
        place: f"data:text/javascript;base64,{base64.b64encode(text.encode()).decode('ascii')}"
        for place, text in sorted(modules.items())
    }
    return json.dumps({"imports": urls})
