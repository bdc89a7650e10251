"""Writes cpp/takt/core/maths_constants.h: the numbers that core/maths.cc computes with, from their definitions, in
decimal arithmetic of 450 digits. To be called when a polynomial's degree or range or a table's step changes.

A number that a double does not hold exactly is given as the double next to it and the double next to what is left. The
polynomials interpolate at Chebyshev nodes; their error is within a small factor of the least possible one.

Usage: build/venv/bin/python tools/maths_constants.py
"""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, getcontext, localcontext
from fractions import Fraction
from pathlib import Path

FILE = Path(__file__).resolve().parent.parent / "cpp" / "takt" / "core" / "maths_constants.h"
DIGITS = 450
ATAN_STEPS = 32  # to 1
EXP_STEPS = 32  # to 2
WORDS = 20  # of 2/pi: the largest double's exponent, 192 bits, and a word, since windows begin within one

getcontext().prec = DIGITS
ONE = Decimal(1)


def atan(x: Decimal) -> Decimal:
    """For |x| <= 1: halved until the series is short."""
    halvings = 0
    while abs(x) > Decimal("0.01"):
        x = x / (1 + (1 + x * x).sqrt())
        halvings += 1
    square, power = x * x, x
    total, k = Decimal(0), 0
    while abs(power) > ONE.scaleb(-DIGITS):
        total += power / (2 * k + 1) * (1 if k % 2 == 0 else -1)
        power *= square
        k += 1
    return total * Decimal(2**halvings)


def factorial_series(z: Decimal, first: int) -> Decimal:
    """1/first! - z/(first+2)! + z^2/(first+4)! - ..., of which sine and cosine are made."""
    total, factor, k = Decimal(0), ONE, first
    for i in range(2, first + 1):
        factor /= i
    while abs(factor) > ONE.scaleb(-DIGITS):
        total += factor
        factor *= -z / ((k + 1) * (k + 2))
        k += 2
    return total


def cbrt(x: Decimal) -> Decimal:
    return x ** (ONE / 3)


def nearest(x: Decimal) -> float:
    """The double next to it. Decimal's own conversion rounds correctly."""
    return float(x)


def pair(x: Decimal) -> tuple[float, float]:
    high = nearest(x)
    return high, nearest(x - Decimal(high))


def cut(x: Decimal, bits: int) -> float:
    """Its first bits as a double."""
    mantissa, exponent = Fraction(float(x)), 0
    while mantissa < 1:
        mantissa, exponent = mantissa * 2, exponent - 1
    while mantissa >= 2:
        mantissa, exponent = mantissa / 2, exponent + 1
    scale = Decimal(2) ** (bits - 1 - exponent)
    return float((x * scale).to_integral_value("ROUND_FLOOR") / scale)


def interpolated(f: Callable[[Decimal], Decimal], begin: Decimal, end: Decimal, count: int) -> list[Decimal]:
    """The coefficients of the polynomial that is f at the Chebyshev nodes of [begin, end]."""
    with localcontext() as context:
        context.prec = 100
        pi = 4 * atan(ONE)
        nodes = []
        for k in range(count):
            angle = (2 * k + 1) * pi / (2 * count)
            cosine = factorial_series(angle * angle, 0)
            nodes.append((begin + end) / 2 + (end - begin) / 2 * cosine)
        divided = [f(x) for x in nodes]  # Newton's divided differences
        for j in range(1, count):
            for i in range(count - 1, j - 1, -1):
                divided[i] = (divided[i] - divided[i - 1]) / (nodes[i] - nodes[i - j])
        coefficients = [Decimal(0)] * count
        for i in range(count - 1, -1, -1):  # Horner, over polynomials
            for j in range(count - 1, 0, -1):
                coefficients[j] = coefficients[j - 1] - nodes[i] * coefficients[j]
            coefficients[0] = divided[i] - nodes[i] * coefficients[0]
        return coefficients


def rest_of_log(z: Decimal) -> Decimal:
    """R of log((1+s)/(1-s)) = 2 s + s z R(z), z = s^2."""
    total, power, k = Decimal(0), ONE, 1
    while power > ONE.scaleb(-DIGITS):
        total += 2 * power / (2 * k + 1)
        power *= z
        k += 1
    return total


def array(name: str, values: list[float], what: str) -> str:
    items = ", ".join(value.hex() for value in values)
    return f"// {what}\ninline constexpr double {name}[] = {{{items}}};\n"


def pairs(name: str, values: list[Decimal], what: str) -> str:
    items = ", ".join(f"{{{high.hex()}, {low.hex()}}}" for high, low in map(pair, values))
    return f"// {what}\ninline constexpr Pair {name}[] = {{{items}}};\n"


def single(name: str, value: float, what: str) -> str:
    return f"inline constexpr double {name} = {value.hex()};  // {what}\n"


def header() -> str:
    """The text of the file, but for its line breaks."""
    pi = 4 * atan(ONE)
    ln2 = Decimal(2).ln()
    text = "// Made by tools/maths_constants.py, which says from what.\n#pragma once\n\n#include <cstdint>\n\n"
    text += "namespace takt::maths {\n\nstruct Pair {\n  double high;\n  double low;  // what is left\n};\n\n"

    half = pi / 2
    first = cut(half, 43)
    second = cut(half - Decimal(first), 43)
    text += pairs("kHalfPi", [half], "pi/2.").replace("[] = {{", " = {").replace("}};", "};")
    text += array(
        "kHalfPiParts",
        [first, second, nearest(half - Decimal(first) - Decimal(second))],
        "pi/2 in parts of 43 bits and the rest: their products with 10 bits are exact.",
    )
    text += single("kTwoOverPi", nearest(2 / pi), "2/pi")
    bits = int(2 / pi * Decimal(2) ** (64 * WORDS))
    words = [(bits >> (64 * (WORDS - 1 - i))) & (2**64 - 1) for i in range(WORDS)]
    items = ", ".join(f"0x{word:016x}" for word in [0, *words])
    text += "// The bits of 2/pi: a word before the point, then those behind it.\n"
    text += f"inline constexpr std::uint64_t kTwoOverPiBits[] = {{{items}}};\n"
    text += f"inline constexpr std::uint64_t kHalfPiBits = 0x{int(half * 2**63):016x};  // pi/2 times 2^63\n\n"

    eighth = (pi / 4 * Decimal("1.0001")) ** 2
    sine = interpolated(lambda z: -factorial_series(z, 3), Decimal(0), eighth, 6)
    cosine = interpolated(lambda z: factorial_series(z, 4), Decimal(0), eighth, 6)
    text += array("kSine", [*map(nearest, sine)], "sin(x) = x + x z S(z), z = x^2, |x| <= pi/4.")
    text += array("kCosine", [*map(nearest, cosine)], "cos(x) = 1 - z/2 + z^2 C(z).")
    text += "\n"

    steps = [atan(Decimal(k) / ATAN_STEPS) for k in range(ATAN_STEPS + 1)]
    text += pairs("kArcTangents", steps, f"atan(k/{ATAN_STEPS}).")
    text += f"inline constexpr int kArcTangentSteps = {ATAN_STEPS};\n\n"

    step = ln2 / EXP_STEPS
    high = cut(step, 36)
    text += pairs("kPowersOfTwo", [(step * k).exp() for k in range(EXP_STEPS)], f"2^(k/{EXP_STEPS}).")
    text += f"inline constexpr int kPowerSteps = {EXP_STEPS};\n"
    text += single("kPerStep", nearest(1 / step), "steps in 1")
    text += single("kStepHigh", high, f"ln(2)/{EXP_STEPS}, 36 bits: products with 17 bits are exact")
    text += single("kStepLow", nearest(step - Decimal(high)), "the rest")
    text += "\n"

    high = cut(ln2, 42)
    root = Decimal(2).sqrt()
    most = ((root - 1) / (root + 1)) ** 2
    rest = interpolated(rest_of_log, Decimal(0), most, 7)
    text += single("kLn2High", high, "ln(2), 42 bits: products with 11 bits are exact")
    text += single("kLn2Low", nearest(ln2 - Decimal(high)), "the rest")
    text += array(
        "kLogarithm", [*map(nearest, rest)], "log((1+s)/(1-s)) = 2 s + s z R(z), z = s^2, from sqrt(1/2) to sqrt(2)."
    )
    text += "\n"

    root_of = interpolated(cbrt, ONE, Decimal(2), 7)
    text += array("kCubeRoot", [*map(nearest, root_of)], "cbrt(x), 1 <= x <= 2, to 2e-7: where it starts.")
    text += array("kCubeRoots", [nearest(cbrt(Decimal(2) ** k)) for k in range(3)], "cbrt(2^k).")
    return text + "\n}  // namespace takt::maths\n"


if __name__ == "__main__":
    FILE.write_text(header())
