"""Pictures of plane and solid checks draw what their numbers are; the stress field is that of the elements."""

import math

import numpy as np
import pytest
from support.checks import small_check, small_solid_check

from gearcad import Material
from gearcad.check.task import face_factors
from gearcad.contact.plane.cycle import contact_frame, tooth_field
from gearcad.contact.solid.cycle import _outward, nodal_stress, worst_field
from gearcad.core.records import PerGear, Role
from gearcad.meshing.fem import quadrature
from gearcad.meshing.outline import OutlineSide
from gearcad.plots.check import (
    plot_contact_pattern,
    plot_contact_pressure,
    plot_contact_zone,
    plot_convergence,
    plot_depth_profile,
    plot_fillets,
    plot_harmonics,
    plot_line_loads,
    plot_lines_share,
    plot_load_along_face,
    plot_load_share,
    plot_mesh_stiffness,
    plot_root_along_face,
    plot_root_stress,
    plot_stress_field,
    plot_sweep_pressure,
    plot_sweep_stiffness,
    plot_tooth,
    plot_transmission_error,
    viewed,
)
from gearcad.plots.paper import new_figure, short

_ALL = (
    plot_contact_pressure,
    plot_load_share,
    plot_mesh_stiffness,
    plot_transmission_error,
    plot_root_stress,
    plot_stress_field,
    plot_contact_zone,
    plot_fillets,
    plot_depth_profile,
    plot_sweep_pressure,
    plot_sweep_stiffness,
    plot_convergence,
)

_UNIAXIAL = math.sqrt(1 - 0.3 + 0.3**2)
"""Von Mises stress of a free surface in plane strain, over its only stress in the plane, for nu = 0.3."""

_FILLET = 0.01
"""The field averages at nodes what `Fillets` takes at points between them: 0.5 % on this mesh, half of that on a finer one."""

_PRESSURE_CELLS = 0.005
"""Cells of constant pressure against an ellipse: 0.2 % in the pressure; a wrong sign or axis changes a stress by tens of %."""


def line(axes, label):
    """Data of the line whose label begins like that."""
    (found,) = [each for each in axes.lines if str(each.get_label()).startswith(label)]
    return np.asarray(found.get_xdata(), float), np.asarray(found.get_ydata(), float)


@pytest.mark.parametrize("draw", _ALL)
def test_given_axes_are_used_and_axes_say_their_unit(draw):
    axes = new_figure().subplots()
    assert draw(small_check(), axes) is axes
    for label in (axes.get_xlabel(), axes.get_ylabel()):
        assert any(
            label.endswith(unit) for unit in (" mm", " MPa", " °", " µm", "µm)", " %", " N·m", "load", "pitch point", ")")
        )


def test_pressure_is_drawn_inside_the_flanks_only():
    axes = plot_contact_pressure(small_check())
    places, pressures = line(axes, "finite elements")
    inside = {contact.place: contact for _, contact in small_check().cycle.interior_contacts}
    assert set(inside) <= set(places[~np.isnan(pressures)])
    every = {c.place: c for position in small_check().cycle.every for c in position.contacts}
    assert list(places) == sorted(every)
    for place, pressure, hertz in zip(places, pressures, line(axes, "Hertz")[1], strict=True):
        contact = every[place]
        if contact.interior:
            assert (pressure, hertz) == (contact.peak_pressure, contact.hertz_pressure)
        else:
            assert math.isnan(pressure) and math.isnan(hertz)
    corners = [place for place, contact in every.items() if contact.edge_distance < 0]
    assert sorted(corners) == list(line(axes, "a corner touches")[0]) and corners


def test_share_of_every_contact():
    places, shares = line(plot_load_share(small_check()), "finite elements")
    every = {c.place: c.share for position in small_check().cycle.every for c in position.contacts}
    assert dict(zip(places, shares, strict=True)) == every


def test_path_is_marked_where_it_is():
    axes = plot_load_share(small_check())
    path = small_check().pair.path_of_contact._asdict()
    assert {text.get_text().strip(): text.get_position()[0] for text in axes.texts} == path


def test_stiffness_and_its_references():
    result, axes = small_check(), plot_mesh_stiffness(small_check())
    angles, stiffness = line(axes, "mesh stiffness")
    assert list(angles) == [position.roll_angle for position in result.cycle.every]
    assert list(stiffness) == [position.stiffness for position in result.cycle.every]
    for label, value in (
        ("its mean", result.summary.mesh_stiffness_mean),
        (r"$c_{\gamma", result.rating.stiffness.mesh_alpha),
        ("one pair", result.summary.single_stiffness),
        ("$c'$", result.rating.stiffness.single),
    ):
        assert set(line(axes, label)[1]) == {value}


def test_transmission_error_and_its_parts():
    """About their means, so that the swing is seen and not the zero."""
    result, axes = small_check(), plot_transmission_error(small_check())
    error = result.cycle.mean("transmission_error")[0]
    drawn = {"transmission": np.array([1000 * position.approach for position in result.cycle.every]) - error}
    for gear, name in enumerate(("pinion", "wheel")):
        part = np.array([1000 * position.approach_parts[gear] for position in result.cycle.every])
        drawn[f"part of the {name}"] = part - 1000 * result.cycle.mean("approach_parts")[0][gear]
    for label, values in drawn.items():
        assert line(axes, label)[1] == pytest.approx(values, abs=1e-9)
    swing = np.ptp(drawn["transmission"])
    assert swing == pytest.approx(result.summary.transmission_error_peak_to_peak)
    assert np.ptp(axes.get_ylim()) < 1.3 * swing < 0.6 * (drawn["transmission"] + error).max()


def test_stiffness_fills_its_own_range():
    result, axes = small_check(), plot_mesh_stiffness(small_check())
    low, high = axes.get_ylim()
    least = min(result.summary.mesh_stiffness_min, result.rating.stiffness.single)
    assert least - 0.1 * (high - low) < low < least


def test_root_stress_of_both_gears():
    result, axes = small_check(), plot_root_stress(small_check())
    for gear, name in enumerate(("pinion", "wheel")):
        for kind in ("tension", "compression"):
            wanted = [getattr(position, kind)[gear].stress for position in result.cycle.every]
            assert list(line(axes, f"{name}, {kind}")[1]) == wanted
        assert set(line(axes, rf"{name}, $\sigma")[1]) == {result.rating.root_stresses[gear]}
    assert set(line(axes, "limit")[1]) == {430.0}


def test_fillets_peak_where_the_check_says():
    axes = plot_fillets(small_check())
    for gear, name in enumerate(("pinion", "wheel")):
        angles, stresses = line(axes, f"{name}, tension")
        (angle,), (stress,) = line(axes, f"{name}, greatest")
        assert stress == small_check().summary.root_tension[gear] == stresses.max()
        assert angle == angles[np.argmax(stresses)]


def test_depth_profile_is_hertz_below_an_ellipse_of_pressure():
    result = small_check()
    contact, profile = result.shown.contact, result.depth_profile
    deep = profile.found.depth >= 0.05 * contact.hertz_half_width
    for name in ("sigma_x", "sigma_y", "sigma_z", "largest_shear", "von_mises"):
        found, wanted = getattr(profile.found, name)[deep], getattr(profile.hertz, name)[deep]
        assert found == pytest.approx(wanted, abs=_PRESSURE_CELLS * contact.hertz_pressure)
    depth, mises = line(plot_depth_profile(result), "von Mises")
    assert (depth == profile.found.depth).all() and (mises == profile.found.von_mises).all()


def test_sweep_is_drawn_in_the_order_of_torques():
    torques, pressures = line(plot_sweep_pressure(small_check()), "finite elements")
    assert (list(torques), list(pressures)) == ([75.5, 302.0], [850.0, 1700.0])
    fine, root = line(plot_sweep_pressure(small_check()), "as the square root")
    assert np.interp(75.5, fine, root) == pytest.approx(850.0, rel=1e-3)  # 1700 sqrt(1/4), between points
    axes = plot_sweep_stiffness(small_check())
    assert line(axes, "mesh")[1] == pytest.approx([100 * 14.5 / 15.2, 100])
    assert line(axes, r"$M/\varphi$, wheel")[1] == pytest.approx([100 * 9.2 / 9.8, 100])


def test_convergence_is_told_from_the_finest_mesh():
    factors, difference = line(plot_convergence(small_check()), "root tension, pinion")
    assert list(factors) == [0.5, 1.0, 2.0]
    assert difference == pytest.approx([100 * (380 / 372 - 1), 100 * (374 / 372 - 1), 0])


# ---------------------------------------------------------------------- the field


@pytest.mark.parametrize("role", Role)
def test_field_has_the_stress_of_the_fillets(role):
    cycle = small_check().cycle
    position = cycle.worst_position(role)
    body, tooth = cycle.model.bodies.pick(role), max(position.contacts, key=lambda each: each.force).tooth
    field = tooth_field(cycle, position, role, tooth)
    stresses = {tuple(point): stress for point, stress in zip(field.points.round(9), field.von_mises, strict=True)}
    mesh, start = body.ring.sector.mesh, 0
    for side, nodes in mesh.sides.items():
        part = field.outline[start : start + len(nodes)]
        if side in (OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET):
            found = max(stresses[tuple(point)] for point in part.round(9))
            wanted = (position.tension if side is OutlineSide.LEFT_FILLET else position.compression).pick(role).stress
            assert found == pytest.approx(_UNIAXIAL * abs(wanted), rel=_FILLET)
        start += len(nodes)


def test_flanks_touch_where_the_contact_is():
    cycle = small_check().cycle
    position, contact = cycle.worst_contact
    centre, frame = contact_frame(cycle, contact)
    assert frame.T @ frame == pytest.approx(np.eye(2), abs=1e-12)
    for role, side in PerGear(-1, 1).items():
        field = tooth_field(cycle, position, role, contact.tooth)
        away = (field.points - centre) @ frame
        close = np.abs(away[:, 0]) < contact.hertz_half_width
        # Both bodies end at the tangent, but for the curvature over a half width, and lie on their own side of it.
        sag = contact.hertz_half_width**2 / contact.pair.radius
        assert abs((side * away[close, 1]).min()) < sag
        assert (side * away[:, 1])[np.abs(away[:, 0]) < 1.0].min() > -sag


def test_field_resolves_the_contact():
    result = small_check()
    _, contact = result.cycle.worst_contact
    alone = result.summary.von_mises_half_plane
    for gear, fields in enumerate(np.array_split(np.array(result.stress_field.fields, dtype=object), 2)):
        middle = fields[1]
        deepest = middle.points[np.argmax(middle.von_mises)]
        centre, frame = contact_frame(result.cycle, contact)
        across, into = (deepest - centre) @ frame
        assert (1, -1)[gear] * into < 0  # the pinion lies before the tangent, the wheel behind
        assert abs(into) == pytest.approx(0.7 * contact.half_width, rel=0.2)  # Hertz: 0.704 a
        assert abs(across) < 0.3 * contact.half_width
        # The tooth adds some tension along the flank: 6 % of von Mises here, and the same on a finer mesh within 0.5 %.
        assert middle.von_mises.max() == pytest.approx(1.06 * alone, rel=0.01)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12.7, "12.7"),
        (0.034316, "0.03432"),
        (558796.0, "558\u202f800"),
        (1.0, "1"),
        (30.200000000000003, "30.2"),
        (0, "0"),
        (-181.52, "-181.5"),
        (9999.96, "10000"),
    ],
)
def test_short_numbers(value, text):
    assert short(value) == text


_SOLID_ALL = (
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

_SOLID_FILLET = 0.06
"""A stress averaged at nodes against that at the points between them, on elements as coarse as these."""


@pytest.mark.parametrize("draw", _SOLID_ALL)
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
    levered, plain, slope = [], [], np.cos(np.radians(result.pair.pinion.base_helix_angle))
    for position in result.cycle.positions:  # the edge of a tip has a lever arm of its own
        levered.append(slope * sum((each.forces * each.line.edges.arms.pinion).sum() for each in position.contacts))
        plain.append(slope * sum(each.forces.sum() for each in position.contacts))
    assert levered == pytest.approx([force] * len(levered), rel=1e-6)
    assert load.sum() * (across[1] - across[0]) == pytest.approx(np.mean(plain), rel=1e-6)
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
    assert np.linalg.eigvalsh(tensors[near])[:, 2].max() == pytest.approx(peak.stress, rel=_SOLID_FILLET)


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

    points = quadrature("hex20", 3).places
    nodes = _outward() @ points
    assert sorted(map(tuple, np.round(nodes, 9))) == sorted(map(tuple, ElementHexS2().doflocs))
    np.testing.assert_allclose(_outward() @ field(points), field(nodes), atol=1e-12)
