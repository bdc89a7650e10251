"""Files that were changed at random, given to every reader (EN-38): each is read, or refused in a sentence, in bounded
time and memory.

`python tests/python/fuzzing.py READER [--tries N] [--seconds S] [--first SEED]` tries one reader and says what failed,
each with the seed that makes the file again; `--keep SEED FILE` writes that file. Tries run in a child of their own,
whose memory and processor time the system bounds; one that dies costs its own try alone.
"""

from __future__ import annotations

import argparse
import faulthandler
import functools
import os
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from fuzz_readers import NUMBERS, READERS, Reader
from takt.errors import TaktError

SECONDS = 10  # of processor time for one file
MEMORY = 1 << 30  # bytes beyond what Python and its modules have
LONGEST_SENTENCE = 2000  # characters of a line


# --- changing them ---


def changed(reader: Reader, seed: int) -> bytes:
    """A whole file that has been changed a few times, the same for the same seed; below 0: the first as it is."""
    whole = _whole(reader)
    if seed < 0:
        return whole[0]
    chance = random.Random(f"{reader.name} {seed}")
    data = chance.choice(whole)
    for _ in range(chance.choice([1, 1, 2, 3, 5, 10])):
        data = chance.choice(CHANGES)(data, chance, reader, whole)
    return data[: 4 << 20]


@functools.cache
def _whole(reader: Reader) -> Sequence[bytes]:
    return reader.whole()


def _piece(data: bytes, chance: random.Random, most: int = 400) -> tuple[int, int]:
    begin = chance.randrange(len(data) + 1)
    return begin, min(len(data), begin + chance.randrange(1, most))


def flip(data: bytes, chance: random.Random, *_: object) -> bytes:
    if not data:
        return data
    at = chance.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]


def remove(data: bytes, chance: random.Random, *_: object) -> bytes:
    begin, end = _piece(data, chance)
    return data[:begin] + data[end:]


def cut(data: bytes, chance: random.Random, *_: object) -> bytes:
    return data[: chance.randrange(len(data) + 1)]


def repeat(data: bytes, chance: random.Random, *_: object) -> bytes:
    begin, end = _piece(data, chance)
    return data[:end] + data[begin:end] * chance.choice([1, 2, 50, 1000]) + data[end:]


def insert(data: bytes, chance: random.Random, reader: Reader, _: object) -> bytes:
    at = chance.randrange(len(data) + 1)
    return data[:at] + chance.choice(reader.words) * chance.choice([1, 1, 1, 3, 2000]) + data[at:]


def replace_number(data: bytes, chance: random.Random, *_: object) -> bytes:
    """Instead of a number that stands there, another one."""
    digits = [i for i, byte in enumerate(data[:200_000]) if 48 <= byte <= 57]
    if not digits:
        return data
    begin = end = chance.choice(digits)
    while end < len(data) and data[end : end + 1] in b"0123456789.eE+-":
        end += 1
    return data[:begin] + chance.choice(NUMBERS) + data[end:]


def swap_lines(data: bytes, chance: random.Random, *_: object) -> bytes:
    lines = data.split(b"\n")
    i, j = chance.randrange(len(lines)), chance.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return b"\n".join(lines)


def splice(data: bytes, chance: random.Random, _: object, whole: Sequence[bytes]) -> bytes:
    other = chance.choice(whole)
    begin, end = _piece(other, chance, 2000)
    at = chance.randrange(len(data) + 1)
    return data[:at] + other[begin:end] + data[at:]


def noise(data: bytes, chance: random.Random, *_: object) -> bytes:
    at = chance.randrange(len(data) + 1)
    return data[:at] + chance.randbytes(chance.choice([1, 8, 300])) + data[at:]


CHANGES: tuple[Callable[..., bytes], ...] = (
    flip, flip, remove, cut, repeat, insert, insert, replace_number, replace_number, swap_lines, splice, noise,
)  # fmt: skip


# --- trying them ---


@dataclass
class Tried:
    """What became of a reader's files."""

    read: int = 0
    refused: int = 0
    failed: list[str] = field(default_factory=list)


def one(reader: Reader, seed: int, folder: Path) -> str:
    """Why this file is a failure; "": read; "refused"."""
    file = folder / f"{reader.name}{reader.suffix}"
    file.write_bytes(changed(reader, seed))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            reader.read(file)
    except TaktError as error:
        lines = str(error).splitlines() or [""]
        if not lines[0].strip():
            return f"{type(error).__name__} without a sentence"
        longest = max(map(len, lines))
        return "refused" if longest <= LONGEST_SENTENCE else f"a line of {longest} characters: {lines[0][:200]}"
    except BaseException as error:  # whatever it is, it is no sentence
        frames = traceback.extract_tb(error.__traceback__)
        where = f"{Path(frames[-1].filename).name}:{frames[-1].lineno}"
        return f"{type(error).__name__}: {str(error)[:200]} ({where})"
    return ""


def _bound() -> None:
    """Memory for all that follows; processor time for one file: the system ends this process when it is used up."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    faulthandler.disable()


def _serve(reader: Reader, seeds: range, pipe: int) -> None:
    """In a child: tries them one after the other, and says before and after each which it is and what became of it."""
    _bound()
    with tempfile.TemporaryDirectory() as folder, os.fdopen(pipe, "w") as said:
        for seed in seeds:
            said.write(f"{seed}\t")
            said.flush()
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            found = one(reader, seed, Path(folder))
            signal.setitimer(signal.ITIMER_PROF, 0)
            said.write(" ".join(found.split()) + "\n")
            said.flush()


def _child(reader: Reader, seeds: range) -> Iterator[tuple[int, str]]:
    """What became of each, up to the one that ended the child."""
    read_end, write_end = os.pipe()
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.close(read_end)
            with Path(os.devnull).open("w") as nothing:  # readers may talk
                os.dup2(nothing.fileno(), 1)
                os.dup2(nothing.fileno(), 2)
            _serve(reader, seeds, write_end)
            code = 0
        finally:
            os._exit(code)
    os.close(write_end)
    seed, status = -1, -1
    try:
        with os.fdopen(read_end) as said:
            for line in said:
                number, _, found = line.partition("\t")
                seed = int(number)
                if line.endswith("\n"):
                    yield seed, found.rstrip("\n")
                    seed = -1
        _, status = os.waitpid(child, 0)
    finally:
        if status == -1:  # nobody wants to know more
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGPROF:
        yield seed, f"took more than {SECONDS} s of processor time"
    elif status != 0:
        yield (
            seed,
            f"ended the process: {signal.Signals(os.WTERMSIG(status)).name if os.WIFSIGNALED(status) else status}",
        )


def outcome(reader: Reader, data: bytes) -> str:
    """What becomes of this very file: "" (read), "refused", or why it is a failure."""
    only = replace(reader, whole=lambda: [data])
    return next(said for _, said in _child(only, range(-1, 0)))


def tried(reader: Reader, tries: int, first: int = 0, seconds: float = 1e9) -> Tried:
    """What becomes of so many files, or of those that can be tried in so many seconds."""
    _whole(reader)  # made before the children are
    found, next_seed, end = Tried(), first, time.monotonic() + seconds
    while next_seed < first + tries:
        for seed, said in _child(reader, range(next_seed, first + tries)):
            next_seed = seed + 1
            if said == "refused":
                found.refused += 1
            elif not said:
                found.read += 1
            else:
                found.failed.append(f"{reader.name} {seed}: {said}")
            if time.monotonic() > end:
                return found
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0] if __doc__ else "")
    parser.add_argument("reader", choices=READERS)
    parser.add_argument("--tries", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=1e9, help="no new file after that")
    parser.add_argument("--first", type=int, default=0, help="seed of the first file")
    parser.add_argument("--keep", nargs=2, metavar=("SEED", "FILE"), help="only write this file")
    options = parser.parse_args()
    reader = READERS[options.reader]
    if options.keep:
        Path(options.keep[1]).write_bytes(changed(reader, int(options.keep[0])))
        return 0
    found = tried(reader, options.tries, options.first, options.seconds)
    print("\n".join(found.failed))
    print(f"{reader.name}: {found.read} read, {found.refused} refused, {len(found.failed)} failed")
    return 1 if found.failed else 0


if __name__ == "__main__":
    sys.exit(main())
