"""Reads lines and arcs of a DXF drawing, in [mm] (needs ezdxf: pip install ezdxf).

From the model space: lines, arcs, circles, polylines, ellipses, splines, helices in top view, also within blocks.
Coordinate systems of entities (extrusion) and blocks are handled by ezdxf. Texts, dimensions, hatchings and the like
are ignored; surfaces and bodies, and curves that are not in a plane parallel to X and Y, are errors.
"""

from __future__ import annotations

import math
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from os import PathLike
from typing import Any, NamedTuple

from takt.errors import TaktError, shortened
from takt.toolpath import REACH
from takt.track_drawing import SAME, TOLERANCE, Piece

MOST = 100_000  # entities, including those of blocks and the lines of curves
DEPTH = 50  # of nested blocks
FLAT = 1e-6  # mm by which an entity may leave its plane; also the tolerance of its extrusion direction
_SURVEY_FOOT = 1200e3 / 3937  # mm
# mm per unit ($INSUNITS), for units that ezdxf does not know, or not exactly: those based on inches.
_UNITS = {
    **{0: 1.0, 1: 25.4, 2: 304.8, 3: 1609344.0, 8: 25.4e-6, 9: 0.0254, 10: 914.4},
    **{21: _SURVEY_FOOT, 22: _SURVEY_FOOT / 12, 23: 3 * _SURVEY_FOOT, 24: 5280 * _SURVEY_FOOT},
}
_SAY_NOTHING = {"VIEWPORT", "SEQEND", "ATTDEF", "ATTRIB"}
_SURFACES = {
    "3DFACE", "3DSOLID", "BODY", "EXTRUDEDSURFACE", "LOFTEDSURFACE", "MESH", "PLANESURFACE", "REGION",
    "REVOLVEDSURFACE", "SURFACE", "SWEPTSURFACE",
}  # fmt: skip
_ANNOTATIONS = {
    "ACAD_TABLE", "ARC_DIMENSION", "DIMENSION", "HATCH", "IMAGE", "LARGE_RADIAL_DIMENSION", "LEADER", "LIGHT",
    "MPOLYGON", "MTEXT", "MULTILEADER", "OLE2FRAME", "PDFUNDERLAY",
    "DWFUNDERLAY", "DGNUNDERLAY", "POINT", "SOLID", "SUN", "TEXT",
    "TOLERANCE", "TRACE", "WIPEOUT",
}  # fmt: skip


class Run(NamedTuple):
    """The pieces of an entity. `loose`: it may continue in adjacent entities; polylines are complete."""

    pieces: list[Piece]
    loose: bool


def read_dxf(file: str | PathLike[str], left_out: Counter[str]) -> list[Run]:
    """Returns the runs of the entities, in their order, and counts ignored ones in `left_out`. Raises TaktError."""
    try:
        from ezdxf.enums import InsertUnits
        from ezdxf.filemanagement import readfile
        from ezdxf.units import conversion_factor
    except ImportError:
        raise TaktError(f"{file}: DXF needs ezdxf (pip install ezdxf)") from None
    try:
        drawing = readfile(str(file))
        space = drawing.modelspace()
    except Exception as error:  # ezdxf raises many kinds of errors on bad data
        raise TaktError(f"{file}: is no DXF: {shortened(str(error))}") from None
    try:
        scale = _UNITS.get(drawing.units) or conversion_factor(InsertUnits(drawing.units), InsertUnits.Millimeters)
    except (ValueError, KeyError, TypeError):
        raise TaktError(f"{file}: its unit ($INSUNITS) is {drawing.units}, which is not known") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of overflowing numbers, which are refused here
            return list(_Reader(drawing, scale, left_out).runs(space, 0))
    except _EntityError as error:
        raise TaktError(f"{file}: {shortened(str(error), 400)}") from None
    except Exception as error:  # damaged tables and blocks
        raise TaktError(f"{file}: is damaged: {shortened(str(error))}") from None


class _EntityError(Exception):
    """An entity cannot be read; the text says why."""


class _Reader:
    def __init__(self, drawing: Any, scale: float, left_out: Counter[str]) -> None:
        self._scale, self._left_out, self._count = scale, left_out, 0
        self._hidden = {layer.dxf.name.lower() for layer in drawing.layers if layer.is_off() or layer.is_frozen()}

    def runs(self, entities: Iterable[Any], depth: int, matrix: Any = None) -> Iterator[Run]:
        """Yields the runs of entities. `matrix`: from block coordinates to those of the drawing; None: identity."""
        for entity in entities:
            self._room(1)
            if self._is_hidden(entity):
                self._left_out["what is invisible, or on a layer that is off or frozen"] += 1
                continue
            if entity.dxftype() == "INSERT":
                yield from self._block(entity, depth, matrix)
                continue
            try:
                found = self._of(entity, matrix)
            except _EntityError:
                raise
            except Exception as error:  # damaged entities
                raise _EntityError(f"{_label(entity)} cannot be read: {error}") from None
            kept = [replace(piece, source=_label(entity)) for piece in found if piece.length > SAME]
            if found and not kept:
                self._left_out[f"{entity.dxftype()} without length"] += 1
            if kept:
                yield Run(kept, entity.dxftype() not in ("LWPOLYLINE", "POLYLINE"))

    def _is_hidden(self, entity: Any) -> bool:
        invisible = entity.dxf.is_supported("invisible") and entity.dxf.get("invisible", 0)
        layer = entity.dxf.get("layer", "0") if entity.dxf.is_supported("layer") else "0"
        return bool(invisible) or str(layer).lower() in self._hidden

    def _block(self, insert: Any, depth: int, matrix: Any) -> Iterator[Run]:
        from ezdxf.xclip import XClip

        if depth >= DEPTH:
            raise _EntityError(f"blocks nest deeper than {DEPTH}")
        block = insert.block()
        if block is None:
            self._left_out[f"INSERT of the block '{insert.dxf.get('name', '')}', which is not in the file"] += 1
            return
        if XClip(insert).is_clipping_enabled:
            raise _EntityError(
                f"{_label(insert)} of the block '{insert.dxf.name}' is clipped, and blocks are read whole"
            )
        self._room(insert.mcount)
        for one in insert.multi_insert() if insert.mcount > 1 else [insert]:
            inner = one.matrix44()
            yield from self.runs(block, depth + 1, inner if matrix is None else inner * matrix)

    def _of(self, entity: Any, matrix: Any) -> list[Piece]:
        kind = entity.dxftype()
        if kind in ("LWPOLYLINE", "POLYLINE"):
            return self._polyline(entity, matrix)
        if kind in ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "HELIX"):
            entity = entity if matrix is None else _moved(entity, matrix)
            if kind == "LINE":
                begin, end = entity.dxf.start, entity.dxf.end
                return [Piece(self._point(begin, entity), self._point(end, entity, begin))]
            return [self._arc(entity)] if entity.dxftype() in ("ARC", "CIRCLE") else self._curve(entity)
        if kind in _SURFACES:
            raise _EntityError(f"{_label(entity)} is a surface or body; expected lines, arcs and curves")
        if kind in _ANNOTATIONS:
            self._left_out[kind] += 1
            return []
        if kind in _SAY_NOTHING:
            return []
        raise _EntityError(
            f"{_label(entity)} is not read; expected lines, polylines, arcs, circles, ellipses and splines"
        )

    def _polyline(self, entity: Any, matrix: Any) -> list[Piece]:
        if entity.dxftype() == "POLYLINE" and (entity.is_polygon_mesh or entity.is_poly_face_mesh):
            raise _EntityError(f"{_label(entity)} is a mesh; expected lines, arcs and curves")
        parts = list(entity.virtual_entities())
        self._room(len(parts))
        if not parts:
            self._left_out[f"{entity.dxftype()} of one point"] += 1
            return []
        found = [self._of(part, matrix) for part in parts]
        kept = [long for part in found if (long := [piece for piece in part if piece.length > SAME])]
        for i, part in enumerate(kept):  # arcs of ezdxf run counterclockwise, whatever their sense in the polyline
            if len(kept) > 1:
                other = kept[1] if i == 0 else kept[i - 1]
                ends = (other[0].begin, other[-1].end) if i == 0 else (other[-1].end,)
                here, turned = part[0].begin, part[-1].end
                if i == 0:
                    here, turned = turned, here
                if min(abs(turned - end) for end in ends) < min(abs(here - end) for end in ends):
                    kept[i] = [piece.reversed() for piece in reversed(part)]
        return [piece for part in kept or found for piece in part]

    def _arc(self, entity: Any) -> Piece:
        """Returns an arc or circle. ezdxf transforms its points to the coordinates of the drawing; with an extrusion
        towards -Z its direction is reversed."""
        extrusion = entity.dxf.get("extrusion", (0, 0, 1))
        x, y, z = (float(value) for value in extrusion)
        if math.hypot(x, y) > FLAT * abs(z):
            raise _EntityError(f"{_label(entity)} does not lie in a plane parallel to X and Y")
        if not entity.dxf.radius >= 0:
            raise _EntityError(f"{_label(entity)} has a radius of {entity.dxf.radius * self._scale:.6g} mm")
        sense = 1 if z > 0 else -1
        ocs = entity.ocs()
        centre = self._point(ocs.to_wcs(entity.dxf.center), entity)
        if entity.dxftype() == "CIRCLE":
            begin = centre + self._scale * entity.dxf.radius
            self._check(entity, begin.real, begin.imag)
            return Piece(begin, begin, centre, sense * 2 * math.pi)
        sweep = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360)
        begin, end = self._point(entity.start_point, entity), self._point(entity.end_point, entity)
        if sweep < 1e-12 or 2 * math.pi - sweep < 1e-12:  # from 0 to 360
            return Piece(begin, begin, centre, sense * 2 * math.pi)
        return Piece(begin, end, centre, sense * sweep)

    def _curve(self, entity: Any) -> list[Piece]:
        from ezdxf.path import make_path

        path = make_path(entity)
        first, points = None, []
        for vertex in path.flattening(TOLERANCE / self._scale, segments=4):
            first = vertex if first is None else first
            points.append(self._point(vertex, entity, first))
            self._room(1)
        return [Piece(points[i - 1], points[i]) for i in range(1, len(points)) if abs(points[i] - points[i - 1]) > SAME]

    def _point(self, point: Any, entity: Any, level: Any = None) -> complex:
        """Returns a point [mm]. `level`: a point that must have the same Z."""
        x, y, z = (self._scale * float(value) for value in (point.x, point.y, point.z))
        self._check(entity, x, y, z)
        if level is not None and abs(z - self._scale * float(level.z)) > FLAT:
            raise _EntityError(f"{_label(entity)} rises in Z; tracks lie in a plane parallel to X and Y")
        return complex(x, y)

    def _check(self, entity: Any, *values: float) -> None:
        for value in values:
            if not abs(value) <= REACH:
                raise _EntityError(f"{_label(entity)} reaches to {value:.6g} mm; expected numbers up to {REACH:.0e} mm")

    def _room(self, count: int) -> None:
        self._count += count
        if self._count > MOST:
            raise _EntityError(f"more than {MOST:,} entities, with those of blocks and the lines of curves")


def _moved(entity: Any, matrix: Any) -> Any:
    """Returns a transformed copy; a circle that is distorted becomes an ellipse.

    ezdxf detects this by the lengths of two axes only, which suffices for the matrix of one block. For nested blocks
    the product is applied: a single insertion cannot represent every product of two."""
    from ezdxf.entities.ellipse import Ellipse

    copy = entity.copy()
    if entity.dxftype() in ("ARC", "CIRCLE"):
        first, second = (matrix.transform_direction(axis) for axis in (entity.ocs().ux, entity.ocs().uy))
        size = first.magnitude * second.magnitude
        if abs(first.magnitude**2 - second.magnitude**2) > FLAT * size or abs(first.dot(second)) > FLAT * size:
            copy = Ellipse.from_arc(entity)
            copy.dxf.handle = entity.dxf.get("handle")
    return copy.transform(matrix)


def _label(entity: Any) -> str:
    handle = entity.dxf.get("handle")
    return f"{entity.dxftype()}" + (f" #{handle}" if handle else "")
