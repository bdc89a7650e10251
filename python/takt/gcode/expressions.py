"""Numbers, parameters and expressions of RS274/NGC, compiled once and evaluated each time their line is executed.

Source: T. Kramer, F. Proctor, E. Messina, The NIST RS274NGC Interpreter, Version 3 (NISTIR 6556), 3.3.2, and the manual
of LinuxCNC for named parameters, comparisons (equal within 1e-6) and precedence: `**` before `* / MOD` before `+ -`
before comparisons before `AND OR XOR`, each from the left.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Protocol

from takt.gcode.errors import LineError

DEPTH = 100  # of nested brackets
EQUAL = 1e-6


class Values(Protocol):
    """Source of the values of parameters."""

    def number(self, index: float) -> float: ...
    def name(self, name: str) -> float: ...
    def exists(self, name: str) -> bool: ...


Value = float | Callable[[Values], float]

NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[-+]?[0-9]+)?")
_EXPONENT = re.compile(r"E[-+]?[0-9]+")
_NAME = re.compile(r"<([^<>\[\]]*(?:\[[^<>\[\]]*\][^<>\[\]]*)?)>")
_FUNCTION = re.compile(r"([A-Z]+)\[")
_OPERATOR = re.compile(r"\*\*|[-+*/]|MOD|EQ|NE|GT|GE|LT|LE|AND|OR|XOR")
_LEVELS = {"**": 4, "*": 3, "/": 3, "MOD": 3, "+": 2, "-": 2, "AND": 0, "OR": 0, "XOR": 0}  # comparisons: 1


def evaluate(value: Value, values: Values) -> float:
    """Returns the present value of an expression. Raises LineError if it is not a finite number."""
    if isinstance(value, float):
        return value
    try:
        number = value(values)
    except RecursionError:
        raise LineError("an expression is too long") from None
    except (OverflowError, ZeroDivisionError, ValueError):  # functions of infinity raise ValueError
        number = math.inf
    if not math.isfinite(number):
        raise LineError("an expression has no finite value")
    return number


class Reader:
    """Parses a line (capital letters, without blanks and comments) from left to right. Its methods raise LineError if
    the line has something else at this position."""

    def __init__(self, text: str, at: int = 0) -> None:
        self.text, self.at = text, at

    def value(self, depth: int = 0) -> Value:
        """Reads a number, parameter, expression or function, with or without a sign."""
        if depth > DEPTH:
            raise LineError(f"brackets, signs or # nest deeper than {DEPTH}")
        number = NUMBER.match(self.text, self.at)
        if number:
            self.at = number.end()
            value = float(number[0])
            if math.isinf(value):
                raise LineError("a number has too many digits")
            return value
        ch = self.text[self.at : self.at + 1]
        if ch == "[":
            return self.bracket(depth)
        if ch == "#":
            return self._parameter(depth)
        if ch and ch in "+-":
            self.at += 1
            inner = self.value(depth + 1)
            return inner if ch == "+" else _unary(lambda x: -x, inner)
        function = _FUNCTION.match(self.text, self.at)
        if function and (function[1] in _FUNCTIONS or function[1] in ("ATAN", "EXISTS")):
            return self._function(function[1], depth)
        raise self.unexpected("a number, a parameter or an expression")

    def bracket(self, depth: int = 0) -> Value:
        """Reads [...], operands and operators by precedence."""
        self._take("[")
        operands, operators = [self._operand(depth)], list[str]()
        while True:
            ends = self.text.startswith("]", self.at)
            found = None if ends else _OPERATOR.match(self.text, self.at)
            if not ends and not found:
                raise self.unexpected("an operator or ]")
            level = _LEVELS.get(found[0], 1) if found else -1
            while operators and _LEVELS.get(operators[-1], 1) >= level:
                right, left = operands.pop(), operands.pop()
                operands.append(_binary(_OPERATORS[operators.pop()], left, right))
            if not found:
                self.at += 1
                return operands[0]
            operators.append(found[0])
            self.at = found.end()
            operands.append(self._operand(depth))

    def parameter_name(self, depth: int = 0) -> str | Value:
        """Reads a parameter from # on. Returns its name (local or global), or the value of its index."""
        self._take("#")
        name = _NAME.match(self.text, self.at)
        if name:
            self.at = name.end()
            return name[1]
        return self.value(depth + 1)

    def unexpected(self, expected: str) -> LineError:
        found = self.text[self.at : self.at + 12]
        return LineError(f"expected {expected}, found " + (f"'{found}'" if found else "the end of the line"))

    def _operand(self, depth: int) -> Value:
        value = self.value(depth + 1)
        # Within brackets E is an exponent, not a word.
        exponent = _EXPONENT.match(self.text, self.at)
        if isinstance(value, float) and exponent:
            self.at = exponent.end()
            value *= 10.0 ** float(exponent[0][1:]) if abs(float(exponent[0][1:])) < 300 else math.inf
        return value

    def _parameter(self, depth: int) -> Value:
        name = self.parameter_name(depth)
        if isinstance(name, str):
            return lambda values: values.name(name)
        if isinstance(name, float):
            return lambda values: values.number(name)
        return lambda values: values.number(name(values))

    def _function(self, name: str, depth: int) -> Value:
        self.at += len(name)
        if name == "EXISTS":
            self._take("[")
            given = self.parameter_name(depth + 1) if self.text.startswith("#<", self.at) else None
            if not isinstance(given, str):
                raise self.unexpected("a named parameter")
            self._take("]")
            return lambda values: float(values.exists(given))
        first = self.bracket(depth + 1)
        if name != "ATAN":
            return _unary(_FUNCTIONS[name], first)
        self._take("/")
        return _binary(lambda y, x: math.degrees(math.atan2(y, x)), first, self.bracket(depth + 1))

    def _take(self, ch: str) -> None:
        if not self.text.startswith(ch, self.at):
            raise self.unexpected(ch)
        self.at += 1


def _unary(function: Callable[[float], float], inner: Value) -> Value:
    if isinstance(inner, float):
        return _constant(function, inner)
    return lambda values: function(inner(values))


def _binary(function: Callable[[float, float], float], left: Value, right: Value) -> Value:
    if isinstance(left, float) and isinstance(right, float):
        return _constant(function, left, right)
    first = left if callable(left) else (lambda values, it=left: it)
    second = right if callable(right) else (lambda values, it=right: it)
    return lambda values: function(first(values), second(values))


def _constant(function: Callable[..., float], *arguments: float) -> float:
    try:
        return function(*arguments)
    except (OverflowError, ValueError):  # infinity raises ValueError
        raise LineError("an expression has no finite value") from None


def _divided(left: float, right: float) -> float:
    if right == 0:
        raise LineError("division by 0")
    return left / right


def _modulo(left: float, right: float) -> float:
    """Returns the remainder, which is never negative."""
    if right == 0:
        raise LineError("MOD by 0")
    rest = math.fmod(left, right)
    return rest + abs(right) if rest < 0 else rest


def _power(left: float, right: float) -> float:
    if left < 0 and right != math.floor(right):
        raise LineError(f"a negative number to the power of {right:g}")
    if left == 0 and right < 0:
        raise LineError(f"0 to the power of {right:g}")
    return float(left**right)


def _within(name: str, function: Callable[[float], float], low: float, high: float = math.inf) -> Callable[..., float]:
    def checked(x: float) -> float:
        if not low <= x <= high:
            raise LineError(f"{name} of {x:g}")
        return function(x)

    return checked


def _rounded(x: float) -> float:
    """Returns the nearest integer; halves are rounded away from 0."""
    return math.copysign(math.floor(abs(x) + 0.5), x)


_OPERATORS: dict[str, Callable[[float, float], float]] = {
    "**": _power,
    "*": lambda a, b: a * b,
    "/": _divided,
    "MOD": _modulo,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "EQ": lambda a, b: float(abs(a - b) < EQUAL),
    "NE": lambda a, b: float(abs(a - b) >= EQUAL),
    "GT": lambda a, b: float(a > b),
    "GE": lambda a, b: float(a >= b or abs(a - b) < EQUAL),
    "LT": lambda a, b: float(a < b),
    "LE": lambda a, b: float(a <= b or abs(a - b) < EQUAL),
    "AND": lambda a, b: float(a != 0 and b != 0),
    "OR": lambda a, b: float(a != 0 or b != 0),
    "XOR": lambda a, b: float((a != 0) != (b != 0)),
}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "ABS": abs,
    "ACOS": _within("ACOS", lambda x: math.degrees(math.acos(x)), -1, 1),
    "ASIN": _within("ASIN", lambda x: math.degrees(math.asin(x)), -1, 1),
    "COS": lambda x: math.cos(math.radians(x)),
    "EXP": math.exp,
    "FIX": lambda x: float(math.floor(x)),
    "FUP": lambda x: float(math.ceil(x)),
    "ROUND": _rounded,
    "LN": _within("LN", math.log, math.nextafter(0.0, 1.0)),
    "SIN": lambda x: math.sin(math.radians(x)),
    "SQRT": _within("SQRT", math.sqrt, 0.0),
    "TAN": lambda x: math.tan(math.radians(x)),
}
