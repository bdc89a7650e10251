"""Runs as they lie on a disk: recordings, LCM logs, and the directories that `takt run --report` and `takt demo`
write."""

from __future__ import annotations

from pathlib import Path

from takt.events import Progress, is_log
from takt.lcmlog import read_log
from takt.recording import Recording, RecordingError

IN_DIRECTORY = "recording.npz"
ENDINGS = (".npz", ".log", ".lcm")


def stem_of(run: Path) -> str:
    """The name of a run without an ending of ENDINGS, for files that are made of it. Other dots are of the name, as in
    lcmlog-2024-05-01.00."""
    name = run.resolve().name if run.name in ("", "..") else run.name  # of a link: its own name
    return name[:-4] if name.lower().endswith(ENDINGS) and len(name) > 4 else name


def recording_of(run: Path) -> Path:
    """The file with a run: itself, or the recording of its directory."""
    if not run.is_dir():
        return run
    if not (run / IN_DIRECTORY).is_file():
        raise RecordingError(
            f"{run}: holds no run: expected {IN_DIRECTORY} in it, as takt run --report and takt demo write it"
        )
    return run / IN_DIRECTORY


def read_run(run: Path, progress: Progress | None = None, start: int | None = None) -> Recording:
    """A run as a recording, whatever kind of file it is. `start`: which one of the engine, of several in a log; the
    last unless told."""
    file = recording_of(run)
    with file.open("rb") as probe:
        magic = probe.read(4)
    if magic.startswith(b"PK"):
        if start is not None:
            raise RecordingError(f"{file}: is a recording, which holds one run: there is none to choose")
        return Recording.load(file)
    if is_log(file):
        return read_log(file, run=-1 if start is None else start, progress=progress)
    raise RecordingError(f"{file}: {'is neither a recording (.npz) nor an LCM log' if magic else 'is empty'}")
