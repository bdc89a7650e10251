"""Executes lines of G-code: the modal state of a controller, and the moves that result from the words of a line."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from takt.gcode import words
from takt.gcode.cycles import Cycle
from takt.gcode.errors import LineError
from takt.gcode.geometry import PLANES, PathBuilder, arc_about, centre_by_radius
from takt.gcode.nurbs import Nurbs
from takt.gcode.offsets import SYSTEMS, Offsets
from takt.toolpath import Point

INCH = 25.4  # [mm]
Numbers = dict[str, float]
_PLAIN = frozenset("XYZ")
_MOVES = frozenset(("G0", "G1", "G2", "G3"))
_POLAR = frozenset("@^")
_ARC_WORDS = frozenset("XYZIJKRP")
_CYCLES = frozenset(f"G{number}" for number in range(70, 90))


@dataclass(frozen=True)
class Modal:
    """The modal state, kept from line to line; M70 saves it, M72 restores it (except `motion`)."""

    motion: str | None = None
    plane: str = "G17"
    unit: float = 1.0  # [mm]
    relative: bool = False
    centres_absolute: bool = False
    inverse_time: bool = False
    retract_to_r: bool = False
    diameters: bool = False
    feed: float | None = None  # [mm/s]; None: not given yet
    coordinates: str = "G54"


@dataclass(frozen=True)
class Flow:
    """The effect of a line on the order of execution."""

    code: str  # M2, M98, M99, M70 to M73
    program: float = 0.0
    count: float = 1.0


class Machine:
    def __init__(
        self,
        path: PathBuilder,
        offsets: Offsets,
        dialect: str,
        leave_out: frozenset[str],
        place: Callable[[], str],
    ) -> None:
        self.path, self.offsets, self.modal = path, offsets, Modal()
        self.left_out: Counter[str] = Counter()
        self._homes: dict[str, Point] = {}  # of G28 and G30, if set by the program; else the machine's zero
        self._dialect, self._leave_out, self._place = dialect, leave_out, place
        self._letters_left_out = [name for name in leave_out if len(name) == 1]
        self._shift: Point | None = None
        self._away: LineError | None = None  # error of the next move: the position of the tool is not known
        self._cycle = Cycle()
        self._nurbs: Nurbs | None = None  # between G5.2 and G5.3, or of G6.2
        self._spline: tuple[float, float] | None = None  # P and Q of the preceding G5
        self._feed_number: float | None = None  # of this line, in G93

    # --- State read by parameters of a program ---

    def local(self) -> list[float]:
        """Returns the position of the tool in the active coordinate system and unit of the program."""
        shift = self.offsets.shift()
        return [(here - s) / self.modal.unit for here, s in zip(self.path.here, shift, strict=True)]

    def end(self) -> None:
        """Raises LineError if the program ends within a NURBS."""
        if self._nurbs is not None:
            raise LineError("the program ends within a NURBS")

    def restore(self, modal: Modal) -> None:
        self.modal = replace(modal, motion=self.modal.motion)
        self.offsets.active, self._shift = modal.coordinates, None

    # --- Lines ---

    def run(self, codes: tuple[str, ...], given: Mapping[str, float]) -> Flow | None:
        """Executes the words of a line. Returns its effect on the order of lines, None if there is none. Raises
        LineError if a word is not read or its value is invalid."""
        numbers = dict(given)
        numbers.pop("N", None)
        for letter in self._letters_left_out:
            if numbers.pop(letter, None) is not None:
                self.left_out[letter] += 1
        told, flow, machine_coordinates = False, None, False
        if codes:
            if len(codes) == 1 and codes[0] in _MOVES and codes[0] not in self._leave_out and self._nurbs is None:
                told = True
                if self.modal.motion != codes[0]:
                    self.modal = replace(self.modal, motion=codes[0])
            else:
                told, machine_coordinates, flow = self._codes(codes, numbers)
        self._feed_number = None
        if numbers.keys() - _PLAIN:
            self._other_words(numbers)
        if numbers or (told and self.modal.motion not in ("G0", "G1", None)):
            self._move(numbers, machine_coordinates)
        return flow

    def _other_words(self, numbers: Numbers) -> None:
        if "F" in numbers:
            feed = numbers.pop("F")
            if not 0 < feed < math.inf:
                raise LineError("F: expected a number above 0")
            if self.modal.inverse_time:
                self._feed_number = feed
            else:
                self.modal = replace(self.modal, feed=feed * self.modal.unit / 60)
        for letter in "STEDH$":
            if letter in numbers:
                del numbers[letter]
                self.left_out[letter] += 1

    def _codes(self, codes: tuple[str, ...], numbers: Numbers) -> tuple[bool, bool, Flow | None]:
        """Executes all codes of a line. Returns whether one of them commands a motion, whether it is in machine
        coordinates (G53), and the effect on the order of lines."""
        motions = [code for code in codes if words.GROUP_OF.get(code) == "motion" and code not in self._leave_out]
        rest = []
        for code in codes:
            if code in self._leave_out:
                self._leave(code, numbers, bool(motions))
            elif code not in motions:
                rest.append(code)
        state = {code for code in rest if code in words.GROUP_OF}
        if state:
            self._state(state)
        told, in_machine, flow = bool(motions), False, None
        for code in rest:
            if code[0] == "M":
                flow = self._m_code(code, numbers, bool(motions)) or flow
            elif code[0] == "$":
                self._system(code)
            elif code == "G53":
                in_machine = True
            elif code not in state:
                told = self._g_code(code, numbers, told)
        if motions:
            if self._nurbs is not None and motions[0] not in (self.modal.motion, "G5.3"):
                raise LineError(f"{motions[0]}: the NURBS before it is not complete")
            if motions[0] != self.modal.motion:
                self._cycle, self._spline = Cycle(), None
            self.modal = replace(self.modal, motion=motions[0])
        return told, in_machine, flow

    def _leave(self, code: str, numbers: Numbers, has_motion: bool) -> None:
        self.left_out[code] += 1
        for letter in words.words_of(code, self._dialect, has_motion):
            numbers.pop(letter, None)
        if code[0] == "G" and (words.GROUP_OF.get(code) == "motion" or 33 <= float(code[1:]) < 39 or code in _CYCLES):
            self.modal = replace(self.modal, motion=code)  # lines that continue this motion are left out, too

    def _state(self, codes: set[str]) -> None:
        modal = self.modal
        for code in codes:
            group = words.GROUP_OF[code]
            if group == "plane":
                modal = replace(modal, plane=code)
            elif group == "units":
                modal = replace(modal, unit=INCH if code == "G20" else 1.0)
            elif group == "distances":
                modal = replace(modal, relative=code == "G91")
            elif group == "distances of centres":
                modal = replace(modal, centres_absolute=code == "G90.1")
            elif group == "feed":
                modal = replace(modal, inverse_time=code == "G93")
            elif group == "retraction":
                modal = replace(modal, retract_to_r=code == "G99")
            elif group == "diameters":
                modal = replace(modal, diameters=code == "G7")
            elif group == "coordinates":
                modal = replace(modal, coordinates=code)
                self.offsets.active, self._shift = code, None
        self.modal = modal

    def _m_code(self, code: str, numbers: Numbers, has_motion: bool) -> Flow | None:
        number = float(code[1:])
        if code in ("M2", "M30"):
            return Flow("M2")
        if code in ("M98", "M99") and self._dialect in ("grbl", "marlin"):
            raise LineError(words.refused(code))
        if self._dialect == "marlin":
            if has_motion:
                raise LineError(f"{code} beside a motion: Marlin takes one command a line")
            numbers.clear()
            self.left_out[code] += 1
            return None
        if code in ("M98", "M99"):
            if code == "M98" and "P" not in numbers:
                raise LineError("M98: expected P, the number of a subprogram")
            if code == "M99" and numbers.pop("P", None) is not None:
                raise LineError("M99 P is not read: it goes on at a line of the program that called")
            return Flow(code, numbers.pop("P", 0.0), numbers.pop("L", 1.0))
        progress = code == "M73" and bool(numbers.keys() & set("PR"))
        if code in ("M70", "M71", "M72", "M73") and self._dialect in ("linuxcnc", "rs274") and not progress:
            return Flow(code)
        self.left_out[code] += 1
        own = words.M_WORDS.get(code, "PQ")
        if code not in words.M_WORDS and not has_motion:
            if self._dialect == "rs274" and number >= 70:
                own = "ABCDEHIJKLPQRSTUVWXYZ"  # controllers of machine tools have no such codes
            elif numbers.keys() & _PLAIN:
                raise LineError(f"{code} with X, Y or Z: the dialect does not say whose these are ({words.hint(code)})")
        for letter in own:
            if not (letter in "PR" and has_motion and numbers.keys() & set("IJKR")):
                numbers.pop(letter, None)
        return None

    def _g_code(self, code: str, numbers: Numbers, told: bool) -> bool:
        """Executes a code that is not modal. Returns whether the line still commands a motion: not if the axis words
        belong to this code."""
        if code == "G80":
            self.modal = replace(self.modal, motion=None)
            self._cycle = Cycle()
        elif code in words.NOTHING:
            if code in words.WITHOUT_AXES and not told and numbers.keys() & _PLAIN:
                raise LineError(words.refused(code))
            for letter in words.NOTHING[code]:
                if not (letter in "PR" and numbers.keys() & set("IJK")):
                    numbers.pop(letter, None)
        elif code in words.LEFT_OUT:
            self._left_out_code(code, numbers, told)
        elif self._dialect == "marlin" and code in ("G10", "G11"):
            self.left_out[code] += 1
            numbers.clear()
        elif code in ("G28", "G30") or (code == "G29" and self._dialect == "marlin"):
            self._reference(code, numbers)
            told = False
        elif code in ("G28.1", "G30.1"):
            self._homes[code[:3]] = self.path.here
        elif code in ("G10", "G52", "G92", "G92.1", "G92.2", "G92.3"):
            self._set_offsets(code, numbers)
            self._shift = None
            told = False
        else:
            raise LineError(words.refused(code))
        return told

    def _left_out_code(self, code: str, numbers: Numbers, told: bool) -> None:
        self.left_out[code] += 1
        own = words.LEFT_OUT[code]
        if code == "G4" and not told:
            if self._dialect in ("fanuc", "marlin", "rs274"):
                own = "PSXU"
            elif numbers.keys() & {"X", "U"}:
                raise LineError(f"G4 with X or U is not read in the dialect {self._dialect}; P is the time")
            if "F" in numbers and not numbers.keys() & set(own):
                raise LineError("G4 F: a time, or a feed? Expected P for the time")
        for letter in own:
            numbers.pop(letter, None)

    # --- Offsets and machine coordinates ---

    def _take_axes(self, numbers: Numbers) -> dict[int, float]:
        """Removes the words X, Y, Z, and returns their values [mm] by axis."""
        found = {}
        for axis, letter in enumerate("XYZ"):
            if letter in numbers:
                half = 0.5 if axis == 0 and self.modal.diameters else 1.0
                found[axis] = numbers.pop(letter) * self.modal.unit * half
        return found

    def _set_offsets(self, code: str, numbers: Numbers) -> None:
        offsets = self.offsets
        if code in ("G92.1", "G92.2"):
            offsets.clear_g92(keep=code == "G92.2")
        elif code == "G92.3":
            offsets.restore_g92()
        elif code == "G10":
            self._g10(numbers)
        else:
            axes = self._take_axes(numbers)
            extruder = numbers.pop("E", None) is not None
            if extruder:
                self.left_out["E"] += 1
            if not axes and not extruder:
                raise LineError(f"{code}: expected X, Y or Z")
            if code == "G52":
                for axis, value in axes.items():
                    offsets.g92[axis] = value
            elif axes:
                shift = offsets.shift()
                for axis, value in axes.items():
                    offsets.g92[axis] += self.path.here[axis] - shift[axis] - value

    def _g10(self, numbers: Numbers) -> None:
        kind, which = numbers.pop("L", 0.0), numbers.pop("P", 0.0)
        if kind not in (2, 20):
            raise LineError(f"G10 L{kind:g} is not read, but L2 and L20 (--leave-out G10 leaves it out)")
        if numbers.pop("R", 0.0) != 0:
            raise LineError("G10 with R is not read: turned coordinates are not known")
        if which != int(which) or not 0 <= which <= len(SYSTEMS):
            raise LineError(
                f"G10: P: expected a coordinate system from 1 to 9, or 0 for the active one, found {which:g}"
            )
        name = SYSTEMS[int(which) - 1] if which else self.offsets.active
        for axis, value in self._take_axes(numbers).items():
            if kind == 20:
                self.offsets.set_here(name, axis, self.path.here[axis], value)
            elif self.modal.relative:
                before = self.offsets.of_machine(name)[axis]
                if before is None:
                    raise LineError(
                        f"G10 L2 adds to an offset of {name} that is not in the program (--offset {name} X Y Z)"
                    )
                self.offsets.set_machine(name, axis, before + value)
            else:
                self.offsets.set_machine(name, axis, value)

    def _machine_zero(self, code: str) -> Point:
        zero = self.offsets.machine_zero()
        if zero is None:
            name = self.offsets.active
            raise LineError(
                f"{code} needs the machine's zero, which is not in the program; --offset {name} X Y Z gives the"
                f" position of {name} on the machine, --leave-out {code} leaves it out",
                self._place(),
            )
        return zero

    def _reference(self, code: str, numbers: Numbers) -> None:
        """G28, G30: moves to a machine position, through a point if one is given. If that position is unknown, they are
        left out before the first move and after the last one: the path begins at its start and ends with its last move.
        """
        named = [axis for axis, letter in enumerate("XYZ") if letter in numbers]
        try:
            home = self._homes[code] if code in self._homes else self._machine_zero(code)
        except LineError as error:
            self._be_away(code, error)
            own = numbers.keys() if self._dialect == "marlin" else "ABCEUVWPRSHILO" + "XYZ"
            for letter in [*own]:
                numbers.pop(letter, None)
            return
        if self._dialect == "marlin":
            self.left_out.update(f"{letter} of {code}" for letter in numbers if letter not in _PLAIN)
            numbers.clear()  # they name axes, not a point
        elif named:
            self.path.line(self._target(numbers), None)
        target = list(self.path.here)
        for axis in named or range(3):
            target[axis] = home[axis]
        self._go((target[0], target[1], target[2]), None)
        self._take_axes(numbers)

    def _system(self, code: str) -> None:
        """A $ line of grbl: after homing and jogging the position of the tool is not known."""
        if code in ("$H", "$J"):
            where = "where the tool is then is known to the machine only"
            self._be_away(
                code, LineError(f"{code} is not read before a move: {where} ({words.hint(code)})", self._place())
            )
        else:
            self.left_out[code] += 1

    def _be_away(self, code: str, error: LineError) -> None:
        self.left_out[code] += 1
        if self.path.elements:
            self._away = self._away or error

    # --- Moves ---

    def _move(self, numbers: Numbers, in_machine: bool) -> None:
        modal = self.modal
        motion = modal.motion
        if motion in self._leave_out:
            self.left_out[str(motion)] += 1
            return
        if motion is None:
            letter = next(iter(numbers))
            if letter not in _PLAIN | _POLAR | set("IJKRP"):
                raise LineError(words.refused(letter))
            raise LineError(f"expected G0, G1, G2 or G3 before {letter}")
        if in_machine:
            self._move_in_machine(numbers)
            return
        if motion in ("G0", "G1"):
            target = self._target(numbers)
            if numbers.keys() - _PLAIN:
                self._refuse(numbers)
            rapid = motion == "G0" and self._dialect != "marlin"
            self._go(target, None if rapid else modal.feed if not modal.inverse_time else self._inverse(target))
        elif motion in ("G2", "G3"):
            self._arc(numbers)
        elif motion in ("G5", "G5.1"):
            self._splines(motion, numbers)
        elif motion in ("G5.2", "G5.3", "G6.2"):
            self._nurbs_line(motion, numbers)
        else:
            self._drill(motion, numbers)

    def _drill(self, cycle: str, numbers: Numbers) -> None:
        own = words.CYCLES[cycle]
        if self._dialect == "fanuc" and "K" in numbers:  # L in other dialects
            if "L" in numbers:
                raise LineError("K and L exclude each other: both are the number of repeats")
            numbers["L"] = numbers.pop("K")
        for letter in numbers:
            if letter not in _PLAIN and letter not in own:
                raise LineError(words.refused_in_cycle(letter, cycle, self._dialect))
        if "P" in numbers:
            self.left_out[f"P of {cycle}"] += 1
        if self._away:
            raise self._away
        self._cycle.run(cycle, numbers, self.modal, self._shift_now(), self.path)

    def _refuse(self, numbers: Numbers, allowed: str = "") -> None:
        for letter in numbers:
            if letter not in _PLAIN and letter not in _POLAR and letter not in allowed:
                if letter in "IJKRP":
                    raise LineError(f"{letter} is not read but with G2 and G3")
                raise LineError(words.refused(letter))

    def _go(self, target: Point, velocity: float | None) -> None:
        if self._away:
            raise self._away
        self.path.line(target, velocity)

    def _inverse(self, target: Point) -> float:
        return self._velocity(math.dist(self.path.here, target))  # type: ignore[return-value]

    def _velocity(self, length: float) -> float | None:
        """Returns the velocity [mm/s] of a move of this length [mm]; None: no feed was given yet."""
        if not self.modal.inverse_time:
            return self.modal.feed
        if self._feed_number is None:
            raise LineError("expected F in each line with a motion after G93")
        return max(length, 1e-9) * self._feed_number / 60

    def _shift_now(self) -> Point:
        if self._shift is None:
            self._shift = self.offsets.shift()
        return self._shift

    def _target(self, numbers: Numbers) -> Point:
        modal, here = self.modal, self.path.here
        shift, unit = self._shift or self._shift_now(), modal.unit
        if not _POLAR.isdisjoint(numbers):
            self._from_polar(numbers, shift)
        x, y, z = here
        if modal.relative:
            if "X" in numbers:
                x += numbers["X"] * unit * (0.5 if modal.diameters else 1.0)
            if "Y" in numbers:
                y += numbers["Y"] * unit
            if "Z" in numbers:
                z += numbers["Z"] * unit
        else:
            if "X" in numbers:
                x = numbers["X"] * unit * (0.5 if modal.diameters else 1.0) + shift[0]
            if "Y" in numbers:
                y = numbers["Y"] * unit + shift[1]
            if "Z" in numbers:
                z = numbers["Z"] * unit + shift[2]
        return (x, y, z)

    def _from_polar(self, numbers: Numbers, shift: Point) -> None:
        """Replaces @ and ^, distance and angle [deg], by X and Y."""
        if numbers.keys() & {"X", "Y"} or self.modal.plane != "G17":
            raise LineError("@ and ^ exclude X and Y, and hold in the plane of G17")
        local = complex(self.path.here[0] - shift[0], self.path.here[1] - shift[1]) / self.modal.unit
        radius, angle = abs(local), math.degrees(math.atan2(local.imag, local.real))
        distance, turn = numbers.pop("@", None), numbers.pop("^", None)
        if self.modal.relative:
            radius, angle = radius + (distance or 0.0), angle + (turn or 0.0)
        else:
            radius, angle = radius if distance is None else distance, angle if turn is None else turn
        x, y = radius * math.cos(math.radians(angle)), radius * math.sin(math.radians(angle))
        if self.modal.relative:
            x, y = x - local.real, y - local.imag
        numbers["X"], numbers["Y"] = x * (2.0 if self.modal.diameters else 1.0), y

    def _move_in_machine(self, numbers: Numbers) -> None:
        """G53: moves in machine coordinates."""
        if self.modal.motion not in ("G0", "G1"):
            raise LineError("G53 holds with G0 and G1 only")
        self._refuse(numbers)
        try:
            zero = self._machine_zero("G53")
        except LineError as error:
            self._be_away("G53", error)
            return
        target = list(self.path.here)
        for axis, value in self._take_axes(numbers).items():
            target[axis] = zero[axis] + value
        end = (target[0], target[1], target[2])
        self._go(end, None if self.modal.motion == "G0" else self._velocity(math.dist(self.path.here, end)))

    def _arc(self, numbers: Numbers) -> None:
        if self._away:
            raise self._away
        if not _ARC_WORDS.issuperset(numbers):
            self._refuse(numbers, "IJKRP")
        modal, here = self.modal, self.path.here
        target = self._target(numbers)
        turns = numbers.get("P", 0.0 if self._dialect == "marlin" else 1.0)
        least = 0 if self._dialect == "marlin" else 1
        if self._dialect == "grbl" and "P" in numbers:
            raise LineError("P is not read with G2 and G3 in the dialect grbl")
        if turns != math.floor(turns) or turns < least:
            raise LineError(f"P: expected a whole number of turns from {least} on, found {turns:g}")
        inches, clockwise = modal.unit == INCH, modal.motion == "G2"
        centre = self._centre(target, numbers)
        arc = arc_about(here, target, modal.plane, centre, clockwise=clockwise, more_turns=turns - least, inches=inches)
        self.path.arc(arc, self._velocity(arc.length))

    def _centre(self, end: Point, numbers: Numbers) -> tuple[float, float]:
        modal, here = self.modal, self.path.here
        first, second, third = PLANES[modal.plane]
        letters = "IJK"
        if letters[third] in numbers:
            raise LineError(f"{letters[third]} is not in the plane of {modal.plane}")
        given = (letters[first] in numbers, letters[second] in numbers)
        if "R" in numbers:
            if any(given):
                raise LineError(f"R and {letters[first]}, {letters[second]} exclude each other")
            return centre_by_radius(
                here, end, modal.plane, numbers["R"] * modal.unit,
                clockwise=modal.motion == "G2", inches=modal.unit == INCH,
            )  # fmt: skip
        if not any(given):
            raise LineError(f"expected {letters[first]}, {letters[second]} or R for an arc")
        if modal.centres_absolute:
            if not all(given):
                raise LineError(f"expected both {letters[first]} and {letters[second]} after G90.1")
            shift = self._shift_now()
            return (
                numbers[letters[first]] * modal.unit + shift[first],
                numbers[letters[second]] * modal.unit + shift[second],
            )
        return (
            here[first] + numbers.get(letters[first], 0.0) * modal.unit,
            here[second] + numbers.get(letters[second], 0.0) * modal.unit,
        )

    def _splines(self, motion: str, numbers: Numbers) -> None:
        """G5 (cubic) and G5.1 (quadratic)."""
        if self._away:
            raise self._away
        self._refuse(numbers, "IJPQ" if motion == "G5" else "IJ")
        if self.modal.plane != "G17" or "Z" in numbers:
            raise LineError(f"{motion} is a spline in X and Y only, in the plane of G17")
        unit, here, target = self.modal.unit, complex(*self.path.here[:2]), self._target(numbers)
        end = complex(target[0], target[1])
        if motion == "G5.1":
            if not numbers.keys() & {"I", "J"}:
                raise LineError("G5.1: expected I or J")
            control = [here + unit * complex(numbers.get("I", 0.0), numbers.get("J", 0.0)), end]
        else:
            if not {"P", "Q"} <= numbers.keys():
                raise LineError("G5: expected P and Q")
            if ("I" in numbers) != ("J" in numbers) or ("I" not in numbers and self._spline is None):
                raise LineError("G5: expected I and J")
            out = complex(numbers["I"], numbers["J"]) if "I" in numbers else -complex(*(self._spline or (0.0, 0.0)))
            self._spline = (numbers["P"], numbers["Q"])
            control = [here + unit * out, end + unit * complex(*self._spline), end]
        self._draw_chords(self.path.bezier(control), 0, 1)

    def _nurbs_line(self, motion: str, numbers: Numbers) -> None:
        """Adds a control point of G5.2 (P: its weight, L: the order) or of G6.2 (R: its weight, K: a knot, P: the
        order). At the last one, or at G5.3, appends the curve to the path."""
        if self._away:
            raise self._away
        self._refuse(numbers, {"G5.2": "PL", "G5.3": "", "G6.2": "PRKQ"}[motion])
        first, second, _ = PLANES[self.modal.plane]
        letters = ["XYZ"[axis] for axis in (first, second)]
        given = [letter in numbers for letter in letters]
        if any(given) and (not all(given) or (numbers.keys() & _PLAIN) - set(letters)):
            raise LineError(f"{motion}: expected {letters[0]} and {letters[1]} of a control point")
        if self._nurbs is None:
            if motion == "G5.3":
                raise LineError("G5.3 has no G5.2 before it")
            with_knots = motion == "G6.2"
            if with_knots and "P" not in numbers:
                raise LineError("G6.2: expected P, the order of the NURBS")
            self._nurbs = Nurbs(with_knots)
            self._nurbs.set_order(numbers["P"] if with_knots else numbers.get("L", 3.0))
            here = complex(self.path.here[first], self.path.here[second])
            if not with_knots:  # the first control point is the position of the tool
                self._nurbs.add(here, 1.0 if any(given) else numbers.get("P", 1.0))
        nurbs = self._nurbs
        if "L" in numbers:
            nurbs.set_order(numbers["L"])
        if all(given):
            target = self._target(numbers)
            point = complex(target[first], target[second])
            nurbs.add(point, numbers.get("R" if nurbs.with_knots else "P", 1.0))
        if nurbs.with_knots and "K" in numbers:
            nurbs.add_knot(numbers["K"])
        if motion == "G5.3" or (nurbs.is_complete and nurbs.with_knots):
            self._nurbs = None
            if motion == "G5.3":
                self.modal = replace(self.modal, motion=None)
            self._draw_chords(nurbs.chords(self.path.tolerance), first, second)

    def _draw_chords(self, points: Sequence[complex], first: int, second: int) -> None:
        """Appends chords that end at these points [mm] in the plane of two axes."""
        here = complex(self.path.here[first], self.path.here[second])
        velocity = self._velocity(sum(abs(b - a) for a, b in pairwise([here, *points])))
        for point in points:
            end = list(self.path.here)
            end[first], end[second] = point.real, point.imag
            self.path.line((end[0], end[1], end[2]), velocity)
