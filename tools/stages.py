"""Runs commands as named stages: a log file each, progress while they run, one line when they are done."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TextIO

Command = Sequence["str | Path"]
Environment = Mapping[str, str]

BYTECODE = Path(__file__).resolve().parents[1] / "build" / "bytecode"

TTY = sys.stdout.isatty()
WIDTH = shutil.get_terminal_size((120, 24)).columns - 1


class StageError(Exception):
    """Ends the run; its text is one line."""


def environment(more: Environment | None = None) -> dict[str, str]:
    """The system's tools go before those of the same names that a Python environment puts on the PATH. Python's
    bytecode is kept in build/, whatever the caller's environment says: without, each start of takt compiles it all."""
    path = "/usr/sbin:/usr/bin:/sbin:/bin:" + os.environ.get("PATH", "")
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {
        **kept,
        "PATH": path,
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
        "PYTHONPYCACHEPREFIX": str(BYTECODE),
        **(more or {}),
    }


def output_of(*command: str | Path) -> str:
    """Standard output of a command that may fail."""
    return subprocess.run(command, env=environment(), text=True, capture_output=True, check=False).stdout


class Stages:
    """The stages of one run and how they ended."""

    def __init__(self, root: Path, logs: Path) -> None:
        self._root = root
        self._logs = logs
        self._results: list[tuple[str, float, bool]] = []

    def run(self, name: str, *commands: Command, env: Environment | None = None, go_on: bool = False) -> bool:
        """Runs the commands in turn. Where one fails: with `go_on` runs the others too, else raises StageError."""
        log = self._logs / f"{name.replace(' ', '-')}.log"
        log.parent.mkdir(parents=True, exist_ok=True)
        start = time.monotonic()
        good = True
        with log.open("w") as out:
            for command in commands:
                if good or go_on:
                    good = self._run_one(name, command, env, out, start) and good
        result = (name, time.monotonic() - start, good)
        self._results.append(result)
        print(("\r\033[K" if TTY else "") + _line(*result))
        report = _report(log.read_text(errors="replace"), good)
        if report:
            print(report)
        if not good:
            print(f"  all of it: {log.relative_to(self._root)}")
            if not go_on:
                raise StageError(f"{name} failed")
        return good

    def _run_one(self, name: str, command: Command, env: Environment | None, out: TextIO, start: float) -> bool:
        out.write("$ " + " ".join(map(str, command)) + "\n")
        shown = start
        with subprocess.Popen(
            command,
            cwd=self._root,
            env=environment(env),
            text=True,
            errors="replace",
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        ) as process:
            for line in process.stdout or ():
                out.write(line)
                now = time.monotonic()
                if now - shown > (0.1 if TTY else 30):
                    shown = now
                    text = f"  {name} {now - start:5.0f} s  {line.strip()}"[:WIDTH]
                    print(f"\r\033[K{text}" if TTY else text, end="" if TTY else "\n", flush=True)
        return process.returncode == 0

    def note(self, name: str, good: bool) -> None:
        """A stage that was a question alone."""
        self._results.append((name, 0.0, good))

    def summary(self) -> int:
        """Prints one line for each stage; the exit code of the whole."""
        good = all(result[2] for result in self._results)
        print()
        for result in self._results:
            print(_line(*result))
        print(_line("all", sum(result[1] for result in self._results), good))
        return 0 if good else 1


def _line(name: str, seconds: float, good: bool) -> str:
    return f"{name:<18} {seconds:7.1f} s  {'ok' if good else 'FAILED'}"


def _report(log: str, good: bool) -> str:
    """What to show of a log: ctest's closing lines after what failing tests said; the end of others that failed."""
    lines = log.splitlines()
    end = next((i for i, line in enumerate(lines) if "% tests passed" in line), None)
    if end is None:
        return "" if good else "\n".join("  " + line for line in lines[-60:])
    said: list[str] = []
    failing = False
    for line in lines[:end]:
        if re.match(r"\s*(\d+/\d+ Test|Start +\d+)", line):
            failing = "***" in line
        if failing:
            said.append(line)
    return "\n".join("  " + line for line in [*said[:200], *lines[end:]] if line.strip())
