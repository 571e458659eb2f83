"""Solids and facets as others see them: valid, closed, read again from STEP, and with faces that look outward."""

from pathlib import Path
from typing import NamedTuple

import cadquery
import numpy as np
import pytest
import trimesh
from OCP.BRepCheck import BRepCheck_Analyzer

from gearcad.solids import write_step, write_stl
from gearcad.solids.facets.tessellation import Facets

FLOAT32 = 6e-8
"""Relative step of the numbers in STL."""


class Cone(NamedTuple):
    """An end chamfer: tip radius, height and tolerance (mm), slope (positive where the tip is outside), least triangles."""

    tip: float
    height: float
    slope: float
    tolerance: float
    least: int


def valid_and_closed(shape: cadquery.Shape) -> bool:
    """Whether the CAD kernel finds no fault in a shape, and all of its shells are closed."""
    return BRepCheck_Analyzer(shape.wrapped).IsValid() and all(shell.wrapped.Closed() for shell in shape.Shells())


def reopened(solid: cadquery.Shape, path: Path, name: str = "gear") -> cadquery.Shape:
    """The only solid of a STEP file, written to `path`, as the CAD kernel reads it."""
    write_step(solid, path, name=name)
    again = cadquery.importers.importStep(str(path)).val()
    assert len(again.Solids()) == 1
    return again


def check_closed(facets: Facets, euler: int) -> None:
    """Triangles that leave no gap, are wound alike, have an area, use every corner, and have this Euler number."""
    mesh = facets.to_trimesh()
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == euler
    assert mesh.area_faces.min() > 0
    assert len(np.unique(facets.faces)) == len(facets.vertices)


def check_outward(facets: Facets, face_width: float, hubs: tuple[float, float], cone: Cone | None) -> None:
    """No triangle of the end planes and of the end chamfers is folded over: each shows the way it should."""
    corners = facets.vertices[facets.faces]
    upward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    radius, z = np.hypot(corners[..., 0], corners[..., 1]), corners[..., 2]
    back, front = hubs
    for level, outward in ((0.0, -1), (face_width, 1), (-back, -1), (face_width + front, 1)):
        assert np.all(outward * upward[np.all(z == level, axis=1)] > 0)
    if cone is not None:
        for from_end, outward in ((z, -1), (face_width - z, 1)):
            on_cone = np.all(np.abs(radius - cone.tip - cone.slope * (from_end - cone.height)) < cone.tolerance, axis=1)
            assert on_cone.sum() >= cone.least
            assert np.all(outward * upward[on_cone] > 0)


def check_stl(facets: Facets, path: Path) -> None:
    """The STL file of facets, written to `path`: closed, wound alike, with as many triangles and the same volume."""
    write_stl(facets, path)
    mesh = trimesh.load(path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert len(mesh.faces) == len(facets.faces)
    size = np.ptp(facets.vertices, axis=0).max()
    assert mesh.volume == pytest.approx(facets.volume, abs=FLOAT32 * size * mesh.area)
