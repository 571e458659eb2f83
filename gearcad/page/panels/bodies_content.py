"""What the page shows of solid bodies: surfaces of triangles, where they stand and how they turn."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from gearcad.designs.design import Design
from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.planetary import PlanetaryDesign
from gearcad.designs.kinds.rack import RackDesign
from gearcad.designs.kinds.rack_pair import RackPairDesign
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.errors import GearcadError
from gearcad.geometry import Gear, Rack
from gearcad.jobs.products import require_bodies
from gearcad.page.panels.train_section import layout_of, ratios_of
from gearcad.solids import FileOptions
from gearcad.solids.colours import PART_COLOURS, STEEL, Colour
from gearcad.solids.facets.rack_facets import tessellate_rack
from gearcad.solids.facets.tessellation import tessellate

__all__ = ["Bodies", "Body", "Surface", "bodies_of", "surface_of"]

_NO_BODIES = "This kind of design has no bodies."

_CHORD = 0.01
"""Error of facets, in normal modules: bodies are looked at."""

_MOST_KEPT = 48
"""Surfaces that are kept, for all sessions: what did not change is not made again."""

_SHORT = 1 << 16
"""Vertices that two bytes can number."""


class Surface(NamedTuple):
    """A closed surface: numbers of vertices and triangles, coordinates (mm) and corners; by what it is known."""

    key: str
    content: bytes


class Body(NamedTuple):
    """A body where it stands (mm, rad), and how far it turns (rad), goes round or slides along y (mm) with the first gear."""

    name: str
    surface: str
    colour: Colour
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: float = 0.0
    ratio: float = 1.0
    orbit: float = 0.0
    slide: float = 0.0


class Bodies(NamedTuple):
    """The bodies of a design, and their surfaces, which are `error` (mm) off at the most; `why_not` where there are none."""

    bodies: tuple[Body, ...] = ()
    surfaces: Mapping[str, bytes] = {}
    error: float = 0.0
    why_not: str = ""


def bodies_of(design: Design) -> Bodies:
    """Those of a design with teeth."""
    if not isinstance(design, ToothedDesign):
        return Bodies(why_not=_NO_BODIES)
    try:
        require_bodies(design, FileOptions())
        stood = list(_standing(design))
    except GearcadError as error:
        return Bodies(why_not=str(error))
    found = [surface_of(cut) for cut, _ in stood]
    bodies = tuple(body._replace(surface=surface.key) for (_, body), surface in zip(stood, found, strict=True))
    return Bodies(bodies, dict(found), max(_error(cut) for cut, _ in stood))


@lru_cache(maxsize=_MOST_KEPT)
def surface_of(cut: Gear | Rack) -> Surface:
    """That of a gear or a rack. Raises GeometryError for a ring without a rim."""
    facets = tessellate(cut, _error(cut)) if isinstance(cut, Gear) else tessellate_rack(cut, _error(cut))
    counts = np.array([len(facets.vertices), len(facets.faces)], "<u4")
    corners = facets.faces.astype("<u2" if len(facets.vertices) < _SHORT else "<u4")
    content = counts.tobytes() + facets.vertices.astype("<f4").tobytes() + corners.tobytes()
    return Surface(hashlib.blake2b(content, digest_size=12).hexdigest(), content)


def _error(cut: Gear | Rack) -> float:
    return _CHORD * cut.normal_module


def _standing(design: ToothedDesign) -> Iterator[tuple[Gear | Rack, Body]]:
    """What is cut of teeth, each as a body whose surface is not known."""
    if isinstance(design, PairDesign):
        pair, pose = design.pair, design.pair.wheel_pose()
        place, rotation = (pose.x, 0.0, pose.z), math.radians(pose.rotation)
        ratio = -pair.pinion.teeth / pair.wheel.teeth
        yield pair.pinion, Body("pinion", "", PART_COLOURS["pinion"])
        yield pair.wheel, Body("wheel", "", PART_COLOURS["wheel"], place, rotation, ratio)
    elif isinstance(design, RackPairDesign):
        yield from _with_rack(design)
    elif isinstance(design, RackDesign):
        yield design.rack, Body("rack", "", STEEL, ratio=0.0)
    elif isinstance(design, PlanetaryDesign):
        yield from _of_train(design)
    else:
        for name, gear in design.gears.items():
            yield gear, Body(name, "", STEEL)


def _with_rack(design: RackPairDesign) -> Iterable[tuple[Gear | Rack, Body]]:
    pair, pose = design.pair, design.pair.rack_pose()
    place, rotation = (pose.x, pose.y, pose.z), math.radians(pose.rotation)
    rack = Body("rack", "", PART_COLOURS["rack"], place, rotation, ratio=0.0, slide=pair.pitch_radius)
    return (pair.pinion, Body("pinion", "", PART_COLOURS["pinion"])), (pair.rack, rack)


def _of_train(design: PlanetaryDesign) -> Iterator[tuple[Gear | Rack, Body]]:
    layout = layout_of(design)
    ratios = ratios_of(design, layout)
    for standing in layout.standing:
        body, orbit = standing.body, ratios[layout.carrier.name] if standing.axle.on else 0.0
        rotation, ratio = math.radians(standing.rotation), ratios[standing.axle.name]
        yield body.gear, Body(standing.name, "", body.colour, standing.offset, rotation, ratio, orbit)
