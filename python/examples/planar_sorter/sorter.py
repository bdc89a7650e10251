"""What the movers of the sorter are told: any empty one to any free loading place, any that is loaded to any place on
the tray of its colour, or near it. Which of them goes where, and by which way, is found by the router."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import cycle

import takt

FLOOR = 1  # number of the part
PITCH = 120.0  # mm between places
SIDE = 113.0  # of a mover
LOADING = tuple((0, y) for y in range(8))  # column and row of places
CORNER = tuple((x, y) for x in range(2, 8) for y in range(2, 12))  # where empty movers wait
LOADING_S = 0.4
EMPTYING_S = 0.5
EVERY_S = 0.2  # new orders
LOOK_S = 0.02
ON_TRAY = 8  # movers that a tray takes away
COLOURS = ("red", "blue", "blue", "red", "red", "blue")  # products as they come
EFFORT = 500
Cell = tuple[int, int]


def point(cell: Cell) -> tuple[float, float]:
    return PITCH * (cell[0] + 0.5), PITCH * (cell[1] + 0.5)


def cell_of(mover: takt.Mover) -> Cell:
    return int(mover.x // PITCH), int(mover.y // PITCH)


class Tray:
    """Takes movers of one colour away, and comes back with them."""

    def __init__(self, part: takt.Part, places: Iterable[Cell], waiting: Iterable[Cell]) -> None:
        self.part = part
        self.places = tuple(places)  # on the tray, at the floor
        self.waiting = tuple(waiting)  # on the floor near it
        self.aboard: list[str] = []
        self.leaving: list[str] = []  # empty ones that are still on it
        self.takes = False  # movers may go onto it
        self.delivered = 0


def trays(session: takt.Session) -> dict[str, Tray]:
    return {
        "red": Tray(session.part("red"), _block(16, 2, 4, 4), _block(10, 0, 6, 8)),
        "blue": Tray(session.part("blue"), _block(2, 20, 4, 4), _block(0, 13, 8, 7)),
    }


def _block(x: int, y: int, columns: int, rows: int) -> list[Cell]:
    return [(x + i, y + k) for i in range(columns) for k in range(rows)]


class Sorter:
    """Keeps the movers busy from now on, in step with the session's engine, until it is told to end."""

    def __init__(self, session: takt.Session) -> None:
        self.session = session
        self.trays = trays(session)
        self._router = takt.SurfaceRouter(session, effort=EFFORT)
        self._movers = list(session.movers.values())
        self._in_the_way_s = 0.0
        self._looked_s = session.now
        self._ends = False
        self.colour: dict[str, str] = {}  # by mover that is loaded
        self.refused: list[str] = []
        self._coming = cycle(COLOURS)
        self._orders: list[tuple[takt.SurfaceOrder, str]] = []  # and what for
        self._purpose: dict[str, str] = {}  # by mover with an order, or that is being loaded
        self._loaded_at_s: dict[str, float] = {}
        self._programs = [self._run(tray) for tray in self.trays.values()]
        self._due_s = session.now
        session.program(self._step)

    def end(self) -> None:
        """No more orders; movers that are on their way get to where they are sent."""
        self._ends = True

    @property
    def held_s(self) -> dict[str, float]:
        """s that movers stood on their way, by why: all movers together."""
        return {
            "movers before them": sum(sum(by.values()) for by in self._router.waited_s.values()),
            "movers in their way": self._in_the_way_s,
        }

    def _step(self) -> None:
        now = self.session.now
        if now - self._looked_s > LOOK_S:
            self._in_the_way_s += (now - self._looked_s) * sum(mover.waits_for > 0 for mover in self._movers)
            self._looked_s = now
        if self._ends:
            return
        for program in self._programs:
            next(program)
        for name in [name for name, due in self._loaded_at_s.items() if now >= due]:
            del self._loaded_at_s[name], self._purpose[name]
            self.colour[name] = next(self._coming)
        self._see_who_is_there()
        if now >= self._due_s:
            self._due_s = now + EVERY_S
            self._give_orders()

    def _see_who_is_there(self) -> None:
        for order, purpose in self._orders:
            for name in order.arrived_s:
                if self._purpose.get(name) != purpose:
                    continue
                del self._purpose[name]
                if purpose == "load":
                    self._purpose[name] = "loading"
                    self._loaded_at_s[name] = self.session.now + LOADING_S
                elif purpose.startswith("board"):
                    self.trays[self.colour[name]].aboard.append(name)
                elif purpose.startswith("leave"):
                    leaving = self.trays[purpose.removeprefix("leave ")].leaving
                    if name in leaving:
                        leaving.remove(name)
        self._orders = [(order, purpose) for order, purpose in self._orders if not order.done]

    def _give_orders(self) -> None:
        wanted: list[tuple[str, list[str], list[Cell]]] = []  # what for, any of these, to any of these
        movers = self.session.movers
        on_trays = [name for tray in self.trays.values() for name in (*tray.aboard, *tray.leaving)]
        idle = [name for name in movers if name not in self._purpose and name not in on_trays]
        astray = {name: movers[name].part for name in idle if movers[name].part != FLOOR}  # moved out of the way
        at = {cell_of(mover) for name, mover in movers.items() if name not in self._purpose or name in on_trays}
        at |= {cell_of(movers[name]) for name in self._loaded_at_s}
        for order, _ in self._orders:
            at |= {(int(x // PITCH), int(y // PITCH)) for x, y in order.targets.values()}

        def free(cells: Iterable[Cell]) -> list[Cell]:
            return [cell for cell in cells if cell not in at]

        at_loading = {name for name in idle if cell_of(movers[name]) in LOADING}
        for colour, tray in self.trays.items():
            number = list(self.session.parts).index(colour) + 1
            leaving = [name for name in tray.leaving if name not in self._purpose]
            leaving += [name for name, part in astray.items() if part == number and self.colour.get(name) != colour]
            wanted.append((f"leave {colour}", leaving, free(CORNER)[: len(leaving)]))
            full = [name for name in idle if self.colour.get(name) == colour and astray.get(name, number) == number]
            boards = sum(purpose == f"board {colour}" for purpose in self._purpose.values())
            places = free(tray.places)[: ON_TRAY - len(tray.aboard) - boards] if tray.takes else []
            if places:
                wanted.append((f"board {colour}", full, places[: len(full)]))
            else:
                stored = [name for name in full if name in at_loading]
                wanted.append((f"store {colour}", stored, free(tray.waiting)[: len(stored)]))
        empty = [name for name in idle if name not in self.colour and name not in astray]
        wanted.append(("load", empty, free(LOADING)[: len(empty)]))
        wanted = [(purpose, names, cells) for purpose, names, cells in wanted if names and cells]
        taken: set[Cell] = set()
        aside = [name for name in idle if name not in at_loading]
        for purpose, names, cells in wanted:
            targets = [point(cell) for cell in cells if cell not in taken]
            taken |= set(cells)
            if not targets:
                continue
            try:
                order = self._router.route_any(targets, movers=names, may_move=aside)
            except takt.RoutingError as error:
                self.refused.append(f"{self.session.now:.2f} s, {purpose}: {error}")
                continue
            self._orders.append((order, purpose))
            for name in order.movers:
                self._purpose[name] = purpose

    def _run(self, tray: Tray) -> Iterator[None]:
        while True:
            tray.takes = True
            while len(tray.aboard) < ON_TRAY or tray.part.mover_count > ON_TRAY:
                yield
            tray.takes = False
            yield from self._go(tray.part, 2)
            due = self.session.now + EMPTYING_S
            while self.session.now < due:
                yield
            for name in tray.aboard:
                del self.colour[name]
            tray.delivered += len(tray.aboard)
            yield from self._go(tray.part, 1)
            tray.aboard, tray.leaving = [], tray.aboard
            while tray.leaving:
                yield

    def _go(self, part: takt.Part, index: int) -> Iterator[None]:
        """Again, if it is refused because a mover is in the way for a moment."""
        feedback = part.activate_position(index=index)
        while not feedback.done:
            yield
            if feedback.final and not feedback.done:
                feedback = part.activate_position(index=index)
