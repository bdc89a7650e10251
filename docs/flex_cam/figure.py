"""What the figures have in common: a machine that is on, and what the curves are to be, as closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import takt

Curve = npt.NDArray[np.float64]

SPEED = 90.0  # deg/s of the master


def ready(session: takt.Session, *modules: str) -> None:
    """Switches the master and the slaves of these modules on."""
    session.axis("master").power().wait()
    for module in map(session.flex_cam, modules):
        module.control(regulator_on=True).wait()
        session.wait(lambda module=module: module.axis_enabled)


def mark(recording: takt.Recording, text: str) -> float:
    """The last cycle before it was made, in s; the next one has what is done after it."""
    made = next(event.time_s for event in recording.events if event.text == text)
    times = recording["master"]["time_s"]
    return float(times[times < made][-1])


def turns(recording: takt.Recording, axis: str = "master") -> Curve:
    """The set position of a rotary axis with its turns, in deg."""
    return np.asarray(np.unwrap(recording[axis]["set_position"], period=360))


def rise(u: Curve) -> Curve:
    """The polynomial 3-4-5 from 0 to 1."""
    return u**3 * (10 - 15 * u + 6 * u**2)


def stroke(x: Curve, length: float = 360.0) -> Curve:
    """The cams `stroke` and, with length 240, `short_stroke`: up and down, in mm."""
    return 100 * rise(1 - np.abs(1 - 2 * np.mod(x, length) / length))


def quintic(length: float, begin: Sequence[float], end: Sequence[float], x: Curve) -> Curve:
    """The polynomial of the fifth degree over 0 to `length` with position, slope and curvature at its ends."""
    powers = np.arange(6.0)
    at_end = [
        length**powers,
        powers * length ** np.maximum(powers - 1, 0),
        powers * (powers - 1) * length ** np.maximum(powers - 2, 0),
    ]
    at_begin = [np.eye(6)[0], np.eye(6)[1], 2 * np.eye(6)[2]]
    return np.asarray(np.polynomial.Polynomial(np.linalg.solve([*at_begin, *at_end], [*begin, *end]))(x))


def meets(what: str, curve: Curve, wanted: Curve | float, within: float = 1e-6) -> None:
    """Asserts that a curve is the one that is wanted."""
    assert len(curve) > 0, f"{what}: there is no curve"
    off = float(np.max(np.abs(curve - wanted)))
    assert off <= within, f"{what} is off by up to {off:.3g}"
