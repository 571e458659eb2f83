"""Cutaways: a quarter or half of a part taken off, and the faces where it was cut."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.pictures.poly_data import arrays_of, poly_data

__all__ = ["Cut", "CutFacets", "Cutaway", "cut_away"]

_ON = 1e-7
"""How far from a plane a point counts as in it, as a share of the part's size."""


class Cutaway(Enum):
    """How much of a part is taken off."""

    QUARTER = "quarter"
    HALF = "half"


@dataclass(frozen=True, eq=False)
class Cut:
    """Takes off what is beyond all planes through `point` (3,), one or two with unit normals (3,) towards what is taken off."""

    point: Floats
    normals: tuple[Floats, ...]

    def left(self, points: Floats) -> Bools:
        """Which points (n, 3) it leaves."""
        beyond: Bools = np.all([(points - self.point) @ normal > 0 for normal in self.normals], axis=0)
        return ~beyond


@dataclass(frozen=True, eq=False)
class CutFacets:
    """What a cut leaves: facets, and which of them (m,) are its faces. Two planes leave two pieces, side by side."""

    facets: Facets
    caps: Bools
    cut: Cut

    def between(self, ends: Wholes) -> Bools:
        """Which edges, with these ends (n, 2), are only where both pieces stand side by side."""
        if len(self.cut.normals) == 1 or not len(ends):
            return np.zeros(len(ends), bool)
        first, second = ((self.facets.vertices - self.cut.point) @ normal for normal in self.cut.normals)
        near = _ON * np.ptp(self.facets.vertices, axis=0).max()
        inside: Bools = ((abs(first) < near) & (second < near))[ends].all(axis=1)
        beside: Bools = (second[ends] < -near).any(axis=1)
        return inside & beside


def cut_away(facets: Facets, cut: Cut) -> CutFacets:
    """What a cut leaves of facets that stand in their place; all of it in two pieces where two planes cut."""
    first, *others = cut.normals
    sides = [(-first,), *((first, -other) for other in others)]
    pieces = [piece for side in sides if len((piece := _clipped(facets, cut.point, side))[1])]
    if not pieces:
        return CutFacets(Facets(np.zeros((0, 3)), np.zeros((0, 3), np.int64)), np.zeros(0, bool), cut)
    starts = np.cumsum([0, *(len(vertices) for vertices, _, _ in pieces)])
    vertices = np.concatenate([vertices for vertices, _, _ in pieces])
    faces = np.concatenate([faces + start for (_, faces, _), start in zip(pieces, starts, strict=False)])
    return CutFacets(Facets(vertices, faces), np.concatenate([caps for _, _, caps in pieces]), cut)


def _clipped(facets: Facets, point: Floats, inward: tuple[Floats, ...]) -> tuple[Floats, Wholes, Bools]:
    """Vertices, faces and which of them are cut faces, of what is on the inward side of all planes through a point."""
    from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface

    planes = vtkPlaneCollection()
    for normal in inward:
        plane = vtkPlane()
        plane.SetOrigin(*point)
        plane.SetNormal(*normal)
        planes.AddItem(plane)
    clip, triangles = vtkClipClosedSurface(), vtkTriangleFilter()
    clip.SetInputData(poly_data(facets))
    clip.SetClippingPlanes(planes)
    clip.SetScalarModeToLabels()
    triangles.SetInputConnection(clip.GetOutputPort())
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.Update()
    vertices, faces, labels = arrays_of(triangles.GetOutput())
    return vertices, faces, labels > 0
