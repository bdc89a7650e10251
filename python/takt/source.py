"""Runs as files: recordings, LCM logs, and the directories that `takt run --report` and `takt demo` write."""

from __future__ import annotations

from pathlib import Path

from takt.events import Progress, is_log
from takt.lcmlog import read_log
from takt.recording import Recording, RecordingError

IN_DIRECTORY = "recording.npz"
ENDINGS = (".npz", ".log", ".lcm")


def stem_of(run: Path) -> str:
    """Returns the name of a run without an ending of ENDINGS, for files made from it. Other dots belong to the name, as
    in lcmlog-2024-05-01.00."""
    name = run.resolve().name if run.name in ("", "..") else run.name  # links keep their own name
    return name[:-4] if name.lower().endswith(ENDINGS) and len(name) > 4 else name


def recording_of(run: Path) -> Path:
    """Returns the file of a run: the file itself, or the recording in a directory. Raises RecordingError if a directory
    has none."""
    if not run.is_dir():
        return run
    if not (run / IN_DIRECTORY).is_file():
        raise RecordingError(
            f"{run}: holds no run: expected {IN_DIRECTORY} in it, as takt run --report and takt demo write it"
        )
    return run / IN_DIRECTORY


def read_run(run: Path, progress: Progress | None = None, start: int | None = None) -> Recording:
    """Returns a run of any kind of file as a recording.

    progress: called with the progress, 0 to 1.
    start: index of one of several starts of the engine in a log; None: the last one.

    Raises RecordingError or LogError if the file holds no such run.
    """
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
