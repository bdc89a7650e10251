"""An outside CMake project finds, links and runs an installed Takt."""

import os
import subprocess
from pathlib import Path

import pytest

CONSUMER = Path(__file__).parent / "consumer"


def run(*command: str | Path) -> str:
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        pytest.fail("\n".join(done.stdout.splitlines()[-40:]), pytrace=False)
    return done.stdout


def test_another_project_uses_the_installed_package(tmp_path):
    prefix = tmp_path / "prefix"
    run("cmake", "--install", os.environ["TAKT_BUILD_DIR"], "--component", "cpp", "--prefix", prefix)
    folder = tmp_path / "build"
    run(
        "cmake",
        "-G",
        "Ninja",
        "-S",
        CONSUMER,
        "-B",
        folder,
        f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_BUILD_TYPE=Release",
    )
    run("cmake", "--build", folder)
    assert run(folder / "consumer") == "2.0 s, message, at 1.0, 520.0 mm, met\n"
