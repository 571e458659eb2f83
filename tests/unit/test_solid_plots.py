"""Pictures of a check of solid bodies draw what its numbers are; the field of a tooth is that of its elements."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.checks import small_solid_check

from gearcad import Material
from gearcad.check.task import face_factors
from gearcad.contact.solid.cycle import _gauss_points, _outward, nodal_stress, worst_field
from gearcad.core.records import Role
from gearcad.meshing.outline import OutlineSide
from gearcad.plots.check import (
    plot_contact_pattern,
    plot_harmonics,
    plot_line_loads,
    plot_lines_share,
    plot_load_along_face,
    plot_mesh_stiffness,
    plot_root_along_face,
    plot_root_stress,
    plot_tooth,
    plot_transmission_error,
    viewed,
)
from gearcad.plots.paper import new_figure

_ALL = (
    plot_line_loads,
    lambda result, ax: plot_contact_pattern(result, Role.PINION, ax),
    lambda result, ax: plot_contact_pattern(result, Role.WHEEL, ax),
    plot_lines_share,
    plot_harmonics,
    plot_load_along_face,
    plot_root_along_face,
    plot_mesh_stiffness,
    plot_transmission_error,
    plot_root_stress,
    lambda result, ax: plot_tooth(result.tooth_surfaces.pinion, ax),
)

_FILLET = 0.06
"""A stress averaged at nodes against that at the points between them, on elements as coarse as these."""


def line(axes, label):
    """Data of the line whose label begins like that."""
    (found,) = [each for each in axes.lines if str(each.get_label()).startswith(label)]
    return np.asarray(found.get_xdata(), float), np.asarray(found.get_ydata(), float)


@pytest.mark.parametrize("draw", _ALL)
def test_given_axes_are_used(draw):
    axes = new_figure().subplots()
    assert draw(small_solid_check(), axes) is axes


def test_pattern_lies_inside_the_outline_and_ends_at_the_greatest_pressure():
    result = small_solid_check()
    for role, own in result.pair.gears.items():
        axes = plot_contact_pattern(result, role)
        (colours,) = [each for each in axes.collections if each.get_array() is not None]
        assert colours.norm.vmax == result.summary.contact_pressure
        z, roll = line(axes, "flank")
        form = own.flank_form
        assert (z.min(), z.max(), roll.min(), roll.max()) == (0, own.face_width, form.first, form.last)
        cells = result.cells
        inside = ~cells.on_edge
        rolls = cells.rolls.pick(role)[inside]
        assert (rolls > form.first - 1e-9).all() and (rolls < form.last + 1e-9).all()
        assert colours.get_array().max() == cells.pressure[inside].max()


def test_cells_lie_on_the_line_of_action():
    """A flank's roll length is the distance from its base tangent point: both add up to the whole line."""
    result = small_solid_check()
    cells = result.cells
    inside = ~cells.on_edge
    whole = result.pair.centre_distance * math.sin(math.radians(result.pair.working_transverse_pressure_angle))
    assert cells.rolls[0][inside] == pytest.approx(cells.place[inside], abs=1e-9)
    assert (cells.rolls[0] + cells.rolls[1])[inside] == pytest.approx(whole, abs=1e-9)


def test_share_is_that_of_every_contact():
    result = small_solid_check()
    places, shares = line(plot_lines_share(result), "finite elements")
    assert sorted(shares) == sorted(c.share for position in result.cycle.every for c in position.contacts)
    assert list(places) == sorted(places) == sorted(c.line.middle for _, c in result.cycle.contacts)


def test_load_along_the_face_carries_everything():
    result = small_solid_check()
    across, load = line(plot_load_along_face(result), "mean of all")
    force = 120e3 / (result.pair.pinion.base_diameter / 2)
    assert load.sum() * (across[1] - across[0]) == pytest.approx(force, rel=1e-6)
    assert set(line(plot_load_along_face(result), "over the width")[1]) == {load.mean()}


def test_root_tension_along_the_face_peaks_where_the_summary_says():
    result = small_solid_check()
    axes = plot_root_along_face(result)
    for gear, name in enumerate(("pinion", "wheel")):
        across, stress = line(axes, rf"{name}, $K")
        assert stress.max() == result.summary.root_tension[gear]
        # Both gears are as wide as the common width.
        assert across[stress.argmax()] + 5.0 == pytest.approx(result.summary.root_tension_height[gear], abs=1e-9)


def test_harmonics_are_bars():
    result = small_solid_check()
    heights = [bar.get_height() for bar in plot_harmonics(result).patches]
    assert tuple(heights) == result.summary.transmission_error_harmonics


def test_misalignment_of_method_c_is_that_of_the_gap():
    """The helix angle modification of the model's own flanks, from one end of the common width to the other."""
    result = small_solid_check()
    form = result.pair.pinion.flank_form
    turned = type(form)(
        type(form.modification)(helix_angle_modification=6.0), *[form.first, form.last], form.width, 1.0, form.hand, form.module
    )
    grows = 1000 * float(turned.depth(form.last, form.width) - turned.depth(form.last, 0.0))
    factors = face_factors(result.task)
    assert factors.misalignment == pytest.approx(10.0 + grows)
    specific, stiffness = result.rating.specific_load, result.rating.stiffness.mesh_beta
    assert factors.flank == pytest.approx(1 + abs(factors.misalignment) * stiffness / (2 * specific))


# ---------------------------------------------------------------------- the field


def test_an_even_strain_is_hooke_s_law_at_every_node():
    mesh = small_solid_check().cycle.model.pinion.body.sector.mesh
    hexahedra = np.concatenate([mesh.elements(mesh.section.quads, layer) for layer in range(mesh.layers)])
    gradient = 1e-4 * np.array([[3.0, 1.0, 0.0], [2.0, -1.0, 4.0], [0.5, 0.0, 2.0]])
    stress = nodal_stress(mesh.points, hexahedra, mesh.points @ gradient.T, Material(youngs_modulus=200e3, poisson_ratio=0.25))
    # E/(1+nu) = 160 GPa, nu E/((1+nu)(1-2 nu)) = 80 GPa, trace 4e-4: 32 MPa on each axis besides 160 GPa times the strain.
    assert stress == pytest.approx(np.tile([80.0, 16.0, 64.0, 24.0, 32.0, 4.0], (len(stress), 1)), abs=1e-6)


@pytest.mark.parametrize("role", Role)
def test_field_has_the_stress_of_the_fillet(role):
    result = small_solid_check()
    field = worst_field(result.cycle, role)
    mesh = result.cycle.model.bodies.pick(role).body.sector.mesh
    xx, yy, zz, xy, yz, zx = field.stress[mesh.over(mesh.side(OutlineSide.LEFT_FILLET))].T
    tensors = np.moveaxis(np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]), -1, 0)
    root = mesh.in_section[mesh.over(mesh.side(OutlineSide.LEFT_FILLET))]
    peak = result.cycle.worst_position(role).tension.pick(role)
    near = np.abs(np.hypot(*root.T) - peak.radius) < 0.3
    assert np.linalg.eigvalsh(tensors[near])[:, 2].max() == pytest.approx(peak.stress, rel=_FILLET)


@pytest.mark.parametrize("role", Role)
def test_surface_is_closed_and_looks_outward(role):
    result = small_solid_check()
    surface = result.tooth_surfaces.pick(role)
    edges = np.sort(surface.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert set(np.unique(edges, axis=0, return_counts=True)[1]) == {2}
    corners = surface.points[surface.triangles]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    own = result.pair.gears.pick(role)
    # One tooth over what is left of the sector below: about a tooth's share of the ring between there and the tip, half full.
    ring = math.pi / 4 * (own.tip_diameter**2 - (own.root_diameter - 4 * own.normal_module) ** 2) * own.face_width / own.teeth
    assert 0.5 < volume / ring < 0.9


def test_the_tooth_stands_upright_and_shows_its_loaded_flank():
    seen = viewed(np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]))
    assert seen @ seen.T == pytest.approx(np.eye(3), abs=1e-12)
    assert seen[0][1] > 0.9  # the tooth's height is up
    assert seen[1][2] > 0.6  # the left flank looks at us
    assert np.linalg.det(seen) == pytest.approx(1)


def test_values_at_the_points_of_an_element_give_those_at_its_nodes():
    """Of a trilinear field without error, at the places that the elements of scikit-fem have for their nodes."""
    from skfem import ElementHexS2

    def field(points):
        x, y, z = np.asarray(points).T
        return 3 + x - 2 * y + 5 * z + 7 * x * y * z - y * z

    nodes = _outward() @ _gauss_points()
    assert sorted(map(tuple, np.round(nodes, 9))) == sorted(map(tuple, ElementHexS2().doflocs))
    np.testing.assert_allclose(_outward() @ field(_gauss_points()), field(nodes), atol=1e-12)
