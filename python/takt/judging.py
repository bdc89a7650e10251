"""Finds whether a function asserts anything: a `verify` without an assertion would pass for any motion."""

from __future__ import annotations

import dis
import inspect
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any


def asserts(function: Callable[..., object], folder: Path) -> bool:
    """Returns whether the function, or a function of the folder that it refers to, directly or indirectly, contains a
    plain `assert`."""
    folder = folder.resolve()
    waiting: list[Any] = [function]
    known: set[int] = set()
    while waiting:
        one = inspect.unwrap(waiting.pop()) if callable(waiting[-1]) else waiting.pop()
        if id(one) in known:
            continue
        known.add(id(one))
        if inspect.isclass(one):
            members = [getattr(member, "__func__", member) for member in vars(one).values()]  # static ones, too
            waiting += [member for member in members if isinstance(member, FunctionType)]
        elif isinstance(one, FunctionType) and _lies_in(one, folder):
            for code in _codes(one.__code__):
                if any(_asserts(instruction) for instruction in dis.get_instructions(code)):
                    return True
                waiting += _named(code, one.__globals__)
    return False


def _named(code: CodeType, names: Mapping[str, object]) -> Iterator[object]:
    """Yields the objects behind the names that the code uses, including those in modules."""
    for name in code.co_names:
        found = names.get(name)
        yield found
        if isinstance(found, ModuleType):
            yield from (vars(found)[of] for of in code.co_names if of in vars(found))


def _asserts(instruction: dis.Instruction) -> bool:
    return "ASSERTION_ERROR" in instruction.opname or "AssertionError" in instruction.argrepr


def _lies_in(function: FunctionType, folder: Path) -> bool:
    return Path(function.__code__.co_filename).resolve().is_relative_to(folder)


def _codes(code: CodeType) -> Iterator[CodeType]:
    """Yields the code and that of the functions inside it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)
