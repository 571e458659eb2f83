"""Pictures of meshes: every element of a section, and of a body the faces that are seen."""

from __future__ import annotations

import numpy as np
import pytest

import gearcad
from gearcad import Body, Gear, GearPair
from gearcad.plots.gears import plot_body_mesh, plot_section_mesh

GEAR = Gear(teeth=12, normal_module=2, face_width=6, profile_shift=0.3, body=Body(bore=8))


def outlines(axes: object) -> list[np.ndarray]:
    return [path.vertices for drawn in axes.collections for path in drawn.get_paths()]


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return float(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1])) / 2


@pytest.mark.parametrize("element", ["quad8", "tri6"])
def test_a_section_is_drawn_with_all_its_elements(element: str) -> None:
    result = gearcad.mesh(GEAR, what="teeth:3", element=element)
    drawn = outlines(plot_section_mesh(result.mesh))
    assert len(drawn) == len(result.mesh.cells)
    assert sum(map(area, drawn)) == pytest.approx(result.judged["gear"].whole, rel=3e-3)  # edges are drawn straight


def test_both_gears_of_a_pair_are_drawn_in_their_colours_in_a_window() -> None:
    mesh = gearcad.mesh(GearPair(pinion=GEAR, wheel=GEAR), size=1).mesh
    axes = plot_section_mesh(mesh, window=(13.0, 0.0, 3.0))
    pinion, wheel = axes.collections
    assert not np.allclose(pinion.get_facecolor(), wheel.get_facecolor())
    assert 0 < len(outlines(axes)) < len(mesh.cells) / 2
    assert axes.get_ylim() == (-3.0, 3.0)


@pytest.mark.parametrize("element", ["hex8", "hex20"])
def test_a_body_shows_its_end_and_what_it_hides_is_left_out(element: str) -> None:
    mesh = gearcad.mesh(GEAR, what="ring", element=element, size=1).mesh
    above = plot_body_mesh(mesh, pitch=90)
    faces = {name: len(mesh.sides[name]) for name in ("end_back", "end_front")}
    assert faces["end_front"] <= len(outlines(above)) <= faces["end_front"] + 0.01 * sum(map(len, mesh.sides.values()))
    below = plot_body_mesh(mesh, pitch=-90)
    assert faces["end_back"] <= len(outlines(below))
