"""`pip install .` in an empty virtual environment gives the package, its commands and its types (PY-01)."""

import os
import shutil
import subprocess
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("venv")
    venv.create(prefix, with_pip=True)
    # As deep as the release build: so the compiler's cache knows what was compiled there.
    build = Path(os.environ["TAKT_BUILD_DIR"]).parent / "wheel"
    shutil.rmtree(build, ignore_errors=True)
    run(prefix, "python", "-m", "pip", "install", ROOT, f"--config-settings=build-dir={build}")
    return prefix


def test_ready_machines_are_delivered(prefix, tmp_path):
    """They need no checkout: listed, and one of them run, with files that lie beside its scenario."""
    listed = {line.split()[0] for line in run(prefix, "takt", "demo").splitlines() if line.strip()}
    examples = {folder.parent.name for folder in (ROOT / "python" / "examples").glob("*/scenario.py")}
    assert len(examples) >= 5
    assert examples <= listed
    (package,) = prefix.glob("lib/python*/site-packages/takt/examples")
    run(prefix, "takt", "check", *package.glob("*/machine.yaml"))
    said = run(prefix, "takt", "demo", "one_axis", "--pace", "paced", "--report", tmp_path / "report")
    assert str(package / "one_axis") in said
    assert "0 failed" in said
    assert "bit for bit" in said
    for name in examples:  # judge.py and the like are found beside them
        load = "import sys, takt.scenario, takt.ready; takt.scenario.load_scenario(takt.ready.scenario_of(sys.argv[1]))"
        run(prefix, "python", "-c", load, name)


def run(prefix: Path, program: str, *arguments: str | Path) -> str:
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    environment["CXX"] = "c++"  # by the name that CMake calls it by: the compiler's cache looks at it
    command = [prefix / "bin" / program, *arguments]
    done = subprocess.run(
        command, cwd=prefix, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
    )
    if done.returncode != 0:
        pytest.fail("\n".join(done.stdout.splitlines()[-40:]), pytrace=False)
    return done.stdout


def test_import(prefix):
    where = run(prefix, "python", "-c", "import takt, takt.msgs; print(takt.__file__)")
    assert Path(where.strip()).is_relative_to(prefix)


@pytest.mark.parametrize("program", ["takt", "taktd"])
def test_commands_introduce_themselves(prefix, program):
    assert "--help" in run(prefix, program, "--help")


def test_metadata(prefix):
    text = run(
        prefix,
        "python",
        "-c",
        "from importlib.metadata import distribution; d = distribution('takt-motion'); m = d.metadata;"
        "print(m['Name'], m['License-Expression'], m['Requires-Python'],"
        " [p.value for p in d.entry_points.select(group='pytest11')])",
    )
    assert text == "takt-motion Apache-2.0 >=3.10 ['takt.pytest_plugin']\n"


def test_types_are_delivered(prefix):
    (package,) = prefix.glob("lib/python*/site-packages/takt")
    assert (package / "py.typed").exists()
    assert list(package.glob("_core*.pyi")) or (package / "_core" / "__init__.pyi").exists()
    assert (package / "msgs" / "__init__.pyi").exists()


def test_nothing_but_the_package_is_installed(prefix):
    files = run(prefix, "python", "-m", "pip", "show", "-f", "takt-motion").split("Files:\n")[1].split()
    assert {file.split("/")[0] for file in files if not file.startswith("..")} == {
        "takt",
        next(file for file in files if ".dist-info" in file).split("/")[0],
    }
