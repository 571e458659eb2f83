"""Pictures of gears, pairs and meshes."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.gear_data import outer_diameter, twist
from gearcad.geometry.gear_tools import shaped
from gearcad.geometry.involute import involute, root_between
from gearcad.meshing.bodies.element_mesh import ElementMesh
from gearcad.meshing.fem import ElementShape
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_CHORD = 2e-3
"""Error of the drawn outlines, in normal modules, too small to be visible."""

_WIDTH, _LEAST, _MOST = 6.6, 2.2, 5.0
"""Width of the picture, and least and largest height (inches)."""

_MARGIN = 0.4
"""Around the gears, in normal modules."""

_MOVED, _PLACES = 0.06, 61
"""Range of the centre distance where backlash is drawn, in normal modules, and number of places."""


def pair_inches(pair: GearPair) -> tuple[float, float]:
    """Return the size of a picture of the pair, as high as its larger gear asks for."""
    if pair.internal:
        return _WIDTH, _MOST
    tips = [gear.tip_diameter for gear in (pair.pinion, pair.wheel)]
    height = _WIDTH * max(tips) / (sum(tips) / 2 + pair.centre_distance)
    return _WIDTH, min(max(height, _LEAST), _MOST)


def plot_pair(pair: GearPair, ax: Axes | None = None) -> Axes:
    """Draw a transverse section of both gears, a tooth of the pinion in a space of the wheel, by the exact outlines unmodified.

    Working pitch circles are dash-dotted; the path of contact of left flanks, from A to E, is drawn on the line of action.
    """
    from matplotlib.patches import Circle

    axes = new_figure(pair_inches(pair)).subplots() if ax is None else ax
    turn = _helix_turn(pair)
    turned = pair.wheel_pose(-turn).rotation
    gears = ((pair.pinion, 0.0, 0.0, -turn), (pair.wheel, pair.centre_distance, turned, turned))
    for (gear, x, rotation, rest), (_, colour, _), pitch in zip(gears, GEARS, pair.working_pitch_diameters, strict=True):
        fill_gear(axes, gear, (x, 0.0), math.radians(rotation), colour, rest=math.radians(rest))
        axes.add_patch(Circle((x, 0), abs(pitch) / 2, fill=False, edgecolor=DARK, linestyle="-.", linewidth=0.7))
        axes.plot(x, 0, "+", color=DARK, markersize=9, markeredgewidth=0.8)
    line = _line_of_action(pair)
    axes.plot(*line.T, color=MARKED, linewidth=0.8)
    axes.plot(*line[1:3].T, color=DARK, linewidth=2.2, solid_capstyle="butt")
    axes.set_aspect("equal")
    axes.margins(0)
    margin = _MARGIN * pair.pinion.normal_module
    if pair.internal:
        reach = outer_diameter(pair.wheel) / 2 + margin
        axes.set_xlim(pair.centre_distance - reach, pair.centre_distance + reach)
        axes.set_ylim(-reach, reach)
    else:
        axes.set_xlim(-pair.pinion.tip_diameter / 2 - margin, pair.centre_distance + pair.wheel.tip_diameter / 2 + margin)
        axes.set_ylim(*(side * (max(pair.pinion.tip_diameter, pair.wheel.tip_diameter) / 2 + margin) for side in (-1, 1)))
    axes.set_axis_off()
    return axes


_RACK_REACH = 1.15
"""Length of a rack that is drawn on each side, over the pinion's tip radius."""


def rack_pair_inches(pair: RackPair) -> tuple[float, float]:
    """Return the size of a picture of a pinion and a rack."""
    reach = _RACK_REACH * pair.pinion.tip_diameter
    wide = pair.pinion.tip_diameter / 2 + pair.mounting_distance + pair.rack.height
    return _WIDTH, min(max(_WIDTH * reach / wide, _LEAST), _MOST)


def plot_rack_pair(pair: RackPair, ax: Axes | None = None) -> Axes:
    """Draw a transverse section of a pinion and the rack near it, a tooth of the pinion in a space of the rack.

    The pitch circle and the pitch line are dash-dotted; the path of contact of left flanks, from A to E, is drawn on the line
    of action.
    """
    from matplotlib.patches import Circle

    axes = new_figure(rack_pair_inches(pair)).subplots() if ax is None else ax
    pinion, rack, (own, other) = pair.pinion, pair.rack, [colour for _, (_, colour, _) in GEARS.items()]
    fill_gear(axes, pinion, (0.0, 0.0), 0.0, own)
    reach = _RACK_REACH * pinion.tip_diameter / 2
    tooth, pitch = rack.profile.contour(_CHORD * pinion.normal_module), rack.transverse_pitch
    count = math.ceil(reach / pitch)
    along = np.concatenate([tooth + np.array([(number + 0.5) * pitch, 0.0]) for number in range(-count, count)])
    back = [[count * pitch, -rack.height], [-count * pitch, -rack.height]]
    y, height = np.concatenate([along, [[count * pitch, -rack.root_depth]], back]).T
    axes.fill(pair.mounting_distance - height, y, facecolor=f"{other}40", edgecolor=other, linewidth=0.9)
    axes.add_patch(Circle((0, 0), pair.pitch_radius, fill=False, edgecolor=DARK, linestyle="-.", linewidth=0.7))
    axes.axvline(pair.pitch_radius, color=DARK, linestyle="-.", linewidth=0.7)
    axes.plot(0, 0, "+", color=DARK, markersize=9, markeredgewidth=0.8)
    angle, path = math.radians(pair.working_transverse_pressure_angle), pair.path_of_contact
    first = pinion.base_diameter / 2 * np.array([math.cos(angle), -math.sin(angle)])
    line = first + np.outer([0.0, path.A, path.E, 2 * path.C], [math.sin(angle), math.cos(angle)])
    axes.plot(*line.T, color=MARKED, linewidth=0.8)
    axes.plot(*line[1:3].T, color=DARK, linewidth=2.2, solid_capstyle="butt")
    axes.set_aspect("equal")
    margin = _MARGIN * pinion.normal_module
    axes.set_xlim(-pinion.tip_diameter / 2 - margin, pair.back_distance + margin)
    axes.set_ylim(-reach, reach)
    axes.set_axis_off()
    return axes


def plot_backlash(pair: GearPair, ax: Axes | None = None) -> Axes:
    """Backlash at the working circles and along the base normal over the centre distance, where the pair can be mounted."""
    axes = prepared(ax, "change of the centre distance in µm", "backlash in µm")
    moved, found = [], []
    reach, side = _MOVED * pair.pinion.normal_module, -1 if pair.internal else 1
    for change in np.linspace(-reach, reach, _PLACES).tolist():
        with suppress(GeometryError):
            at = replace(pair, centre_distance=pair.centre_distance + side * change)
            moved.append(1000 * change)
            found.append((1000 * at.circumferential_backlash, 1000 * at.normal_backlash))
    for values, words, colour in zip(
        np.transpose(found), ("circumferential, at the working circles", "along the base normal"), SERIES, strict=False
    ):
        axes.plot(moved, values, color=colour, label=words)
    axes.axvline(0, color=MARKED, linewidth=0.8)
    nominal = (pair.circumferential_backlash, pair.normal_backlash)
    axes.plot([0, 0], [1000 * each for each in nominal], "o", color=DARK, label=f"at {abs(pair.centre_distance):.7g} mm")
    axes.set_ylim(bottom=0)
    legend_above(axes, 3)
    return axes


def plot_sliding(pair: GearPair | RackPair, ax: Axes | None = None) -> Axes:
    """Draw the specific sliding of both flanks along the path of contact, from the first to the last contact."""
    axes = prepared(ax, "distance from T1 in mm", "specific sliding ζ")
    path, (first, last) = pair.path_of_contact, pair.usable_path
    along = np.linspace(first, last, _PLACES)
    names = ("pinion", "wheel" if isinstance(pair, GearPair) else "rack")
    for values, name, (_, colour, _) in zip(pair.specific_sliding_at(along), names, GEARS, strict=True):
        axes.plot(along, np.where(np.isfinite(values), values, np.nan), color=colour, label=name)
    axes.axhline(0, color=MARKED, linewidth=0.8)
    for name, place in path._asdict().items():
        if first <= place <= last:
            axes.axvline(place, color=MARKED, linewidth=0.5, linestyle=":")
            axes.annotate(name, (place, 1), xycoords=("data", "axes fraction"), ha="center", va="bottom")
    axes.legend()
    return axes


def _helix_turn(pair: GearPair) -> float:
    """Return the turn (degrees) of a helical pinion's section at the wheel's lower end, as `wheel_pose` has it."""
    return math.degrees(twist(pair.pinion, pair.wheel_pose().z))


def fill_gear(
    axes: Axes,
    gear: Gear,
    place: tuple[float, float],
    rotation: float,
    colour: str,
    chord: float | None = None,
    *,
    rest: float = 0.0,
) -> None:
    """A section about a place, turned by `rotation` (rad), its bore left out; that of a ring out to its rim.

    The teeth of a splined bore, which are straight, are turned by `rest` (rad). `chord` (mm) is the greatest error of the
    outline; none: what nobody sees where a pair fills the picture.
    """
    from matplotlib.patches import Circle, PathPatch
    from matplotlib.path import Path

    outline = _turned_outline(gear, place, rotation, chord)
    if gear.internal:
        rim = Path.circle(place, outer_diameter(gear) / 2)
        opening = Path(np.r_[outline[::-1], outline[-1:]], closed=True)
        axes.add_patch(
            PathPatch(Path.make_compound_path(rim, opening), facecolor=f"{colour}40", edgecolor=colour, linewidth=0.9)
        )
        return
    axes.fill(*outline.T, facecolor=f"{colour}40", edgecolor=colour, linewidth=0.9)
    if (teeth := bore_teeth(gear)) is not None:
        in_bore = _turned_outline(teeth, place, rest, chord)
        axes.fill(*in_bore.T, facecolor="white", edgecolor=colour, linewidth=0.9)
    elif gear.body.bore:
        axes.add_patch(Circle(place, gear.body.bore / 2, facecolor="white", edgecolor=colour, linewidth=0.9))


def _turned_outline(gear: Gear, place: tuple[float, float], rotation: float, chord: float | None) -> Floats:
    """Return the outline (n, 2) in mm of a gear about a place, turned by `rotation` (rad)."""
    cosine, sine = math.cos(rotation), math.sin(rotation)
    turn = np.array([[cosine, sine], [-sine, cosine]])
    outline: Floats = gear.profile.contour(chord or _CHORD * gear.normal_module) @ turn + place
    return outline


def _line_of_action(pair: GearPair) -> Floats:
    """T1, A, E and T2 (4, 2) in mm, where the pinion's left flanks press the wheel's."""
    angle = math.radians(pair.working_transverse_pressure_angle)
    base = pair.pinion.base_diameter / 2
    path, whole = pair.path_of_contact, pair.centre_distance * math.sin(angle)
    first = base * np.array([math.cos(angle), -math.sin(angle)])
    result: Floats = first + np.outer([0.0, path.A, path.E, whole], [math.sin(angle), math.cos(angle)])
    return result


_SQUARE = (4.6, 4.6)
"""Size (inches) of a picture of one gear."""

_ROUND = 721
"""Number of points on a circle."""

_ALONG, _UP = 61, 81
"""Places along the face and the profile at which a modification is drawn."""

_FEWEST, _LEAST_MOST = 6, 40
"""Teeth from which shifts are drawn, and up to which at least."""

_LANDS = (0.0, 0.2, 0.4)
"""Thicknesses of the tip, in normal modules, whose shifts are drawn."""

_FARTHEST = 5.0
"""Shift up to which a tip that thin is looked for."""


def plot_gear(gear: Gear, ax: Axes | None = None) -> Axes:
    """Draw a transverse section by the exact outline, unmodified, with reference and base circle."""
    axes = new_figure(_SQUARE).subplots() if ax is None else ax
    fill_gear(axes, gear, (0.0, 0.0), 0.0, GEARS.pinion[1])
    round_about = np.linspace(0, 2 * math.pi, _ROUND)
    for name, diameter, style in (
        ("reference", abs(gear.reference_diameter), "-."),
        ("base", abs(gear.base_diameter), ":"),
    ):
        circle = diameter / 2 * np.cos(round_about), diameter / 2 * np.sin(round_about)
        axes.plot(*circle, color=DARK, linestyle=style, linewidth=0.8, label=f"{name} circle {diameter:.5g} mm")
    axes.plot(0, 0, "+", color=DARK, markersize=9, markeredgewidth=0.8)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.02)
    axes.set_axis_off()
    legend_above(axes, 2)
    return axes


def plot_modification(gear: Gear, ax: Axes | None = None) -> Axes:
    """Draw the depth (µm) by which the left flank is taken back, along the face and from root form circle to tip form circle.

    Raises GeometryError for a gear whose flanks are not modified.
    """
    form = gear.flank_form
    if not form.modification.present:
        raise GeometryError("modification", "none", "must be given, to be drawn: such as tip_relief")
    axes = prepared(new_figure().subplots() if ax is None else ax, "along the axis, z in mm", "diameter in mm")
    heights, rolls = np.linspace(0, form.width, _ALONG), np.linspace(form.first, form.last, _UP)
    depth = 1000 * form.depth(rolls[:, None], heights[None, :])
    diameters = 2 * np.hypot(rolls, form.base_radius)
    drawn = axes.pcolormesh(heights, diameters, depth, cmap="viridis", shading="gouraud")
    drawn.set_rasterized(True)
    if np.ptp(depth) > 0:
        lines = axes.contour(heights, diameters, depth, colors="white", linewidths=0.7)
        axes.clabel(lines, fontsize=8)
    axes.figure.colorbar(drawn, ax=axes, label="taken back in µm")
    return axes


def plot_shift_limits(gear: Gear, ax: Axes | None = None) -> Axes:
    """Shifts over numbers of teeth at which the gear's hob undercuts and tips get thin, and where the gear itself is.

    Raises GeometryError for a ring and a gear of a shaper cutter.
    """
    if shaped(gear):
        raise GeometryError("teeth", gear.teeth, "must be those of an external gear that is hobbed, for its shift to be drawn")
    axes = prepared(ax, "number of teeth", "profile shift x")
    most = max(_LEAST_MOST, round(1.5 * gear.teeth))
    teeth = np.arange(_FEWEST, most + 1)
    axes.plot(teeth, [undercut_shift(gear, int(z)) for z in teeth], color=SERIES[1], label="undercut below")
    for land, style in zip(_LANDS, ("-", "--", ":"), strict=True):
        words = f"tip thickness {land:g} $m_n$" if land else "pointed above"
        axes.plot(teeth, [pointed_shift(gear, int(z), land) for z in teeth], color=SERIES[0], linestyle=style, label=words)
    axes.plot(
        gear.teeth, gear.profile_shift, "o", color=DARK, label=f"this gear: z = {gear.teeth}, x = {gear.profile_shift:.4g}"
    )
    axes.axhline(0, color=MARKED, linewidth=0.8)
    axes.set_xlim(_FEWEST, most)
    legend_above(axes, 3)
    return axes


def undercut_shift(gear: Gear, teeth: int) -> float:
    """x_E: the shift below which the gear's hob undercuts so many teeth.

    The straight flank of the hob ends h_fP - rho_fP (1 - sin alpha_n) below its datum line, and where that is deeper than
    z sin² alpha_t/(2 cos beta) below the pitch line it cuts into the involute (DIN 3960).
    """
    sine = math.sin(math.radians(gear.transverse_pressure_angle))
    straight = gear.dedendum - gear.root_radius * (1 - math.sin(math.radians(gear.rack.pressure_angle)))
    return straight - teeth * sine**2 / (2 * math.cos(math.radians(gear.helix_angle)))


def pointed_shift(gear: Gear, teeth: int, land: float) -> float:
    """Return the shift at which so many teeth with the gear's rack and tip alteration are `land` normal modules thick at the
    tip.

    Not a number where that is above 5.
    """
    beta, alpha = math.radians(gear.helix_angle), math.radians(gear.transverse_pressure_angle)
    normal, radius = math.radians(gear.rack.pressure_angle), teeth / (2 * math.cos(beta))
    thinned = gear.tooth_thinning / gear.normal_module

    def excess(shift: float) -> float:
        tip = radius + gear.rack.addendum + shift + gear.tip_alteration
        half = (math.pi / 2 + 2 * shift * math.tan(normal) - thinned) / (2 * radius * math.cos(beta))
        angle = math.degrees(math.acos(radius * math.cos(alpha) / tip))
        helix = math.atan(math.tan(beta) * tip / radius)
        return 2 * tip * (half + involute(math.degrees(alpha)) - involute(angle)) * math.cos(helix) - land

    least = -gear.rack.addendum - gear.tip_alteration
    return root_between(excess, least, _FARTHEST, xtol=1e-12) if excess(_FARTHEST) < 0 else math.nan


_FILLS = {"pinion": GEARS.pinion[1], "wheel": GEARS.wheel[1], "gear": GEARS.pinion[1]}
"""Fill colours of the parts."""

_PALE = 0.22
"""Share of its colour that a part's elements have, so that lines on them can be seen."""

_SHADES = {"flank": "#5b9bd0", "fillet": "#f0a35e", "root": "#d9c27a", "tip": "#8fb996", "": "#d5d9dd"}
"""Colours of the sides of a body, by what their names hold; "" of all others."""

_LIGHT = np.array([-0.45, 0.55, 0.7])
"""Direction from which light falls on a body, as seen: to the right, up, towards the viewer."""

_EDGE_ON = 1e-9
"""Faces whose normal has less than this towards us are not seen."""

_DIM = 0.45
"""Brightness of what light does not reach."""


def plot_mesh(mesh: ElementMesh, ax: Axes | None = None) -> Axes:
    """Draw all elements of a section, or the surface of a body."""
    return (plot_body_mesh if mesh.element.shape.dimension == 3 else plot_section_mesh)(mesh, ax)


def plot_section_mesh(mesh: ElementMesh, ax: Axes | None = None, *, window: tuple[float, float, float] | None = None) -> Axes:
    """Draw all elements of a section, curved as they are, each part in its colour.

    `window` is the middle (x, y) of what is shown and half its height, in mm; None shows all. Elements outside are left out.
    """
    from matplotlib.collections import PolyCollection

    axes = new_figure((6.6, 6.6)).subplots() if ax is None else ax
    rim = _rim(mesh.element.shape)
    for name, part in mesh.parts.items():
        outlines = mesh.points[mesh.cells[part][:, rim], :2]
        if window is not None:
            near = np.abs(outlines - np.array(window[:2])).max(axis=(1, 2)) < 3 * window[2]
            outlines = outlines[near]
        colour = _FILLS.get(name, DARK)
        drawn = PolyCollection(list(outlines), facecolors=[_mixed(colour, _PALE)], edgecolors=colour)
        drawn.set_linewidth(_width(len(outlines)))
        axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.01)
    if window is not None:
        x, y, half = window
        corners = axes.get_position()
        figure = axes.figure.bbox
        wide = half * corners.width * figure.width / (corners.height * figure.height)
        axes.set_xlim(x - wide, x + wide)
        axes.set_ylim(y - half, y + half)
    axes.set_axis_off()
    return axes


def plot_body_mesh(mesh: ElementMesh, ax: Axes | None = None, *, yaw: float = 35.0, pitch: float = 30.0) -> Axes:
    """Draw the surface of a body with the edges of its elements, seen from `yaw` (deg, about its axis) and `pitch` above its
    end.

    Flanks, fillets, roots and tips have colours of their own.
    """
    from matplotlib.collections import PolyCollection

    axes = new_figure((6.6, 6.6)).subplots() if ax is None else ax
    outlines, colours = [], []
    look = _look(yaw, pitch)
    for name in mesh.sides:
        seen = mesh.points[mesh.face_cells(name)] @ look.T
        normals = _normals(seen)
        front = normals[:, 2] > _EDGE_ON
        outlines.append(seen[front][:, _rim_of_face(seen.shape[1])])
        colours.append(_shaded(_colour(name), normals[front]))
    polygons, shades = np.concatenate(outlines), np.concatenate(colours)
    order = np.argsort(polygons[:, :, 2].mean(axis=1), kind="stable")
    drawn = PolyCollection(list(polygons[order, :, :2]), facecolors=shades[order], edgecolors=DARK)
    drawn.set_linewidth(_width(len(order)))
    axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.01)
    axes.set_axis_off()
    return axes


def _rim(shape: ElementShape) -> list[int]:
    """Return the nodes of a plane element all round: vertices and those between them in turn."""
    return [node for k in range(shape.vertices) for node in (k, shape.vertices + k)]


def _rim_of_face(nodes: int) -> list[int]:
    """Return the nodes of a body's face all round: vertices and those between them in turn."""
    vertices = nodes if nodes == 4 else nodes // 2
    return list(range(4)) if nodes == 4 else [node for k in range(vertices) for node in (k, vertices + k)]


def _width(elements: int) -> float:
    """Return the width of lines (points), thinner where there are many."""
    return float(np.clip(18 / math.sqrt(max(elements, 1)), 0.08, 0.6))


def _look(yaw: float, pitch: float) -> Floats:
    """Return the axes (3, 3) to the right, up and towards us of a body whose axis of rotation is z, x to the right at yaw 0."""
    a, b = math.radians(yaw), math.radians(pitch)
    right = np.array([math.cos(a), math.sin(a), 0.0])
    towards = np.array([math.sin(a) * math.cos(b), -math.cos(a) * math.cos(b), math.sin(b)])
    return np.stack([right, np.cross(towards, right), towards])


def _normals(faces: Floats) -> Floats:
    """Return the unit normals (n, 3) outwards of faces (n, nodes, 3) by their first three vertices."""
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    result: Floats = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return result


def _colour(side: str) -> str:
    return next(colour for word, colour in _SHADES.items() if word in side)


def _mixed(colour: str, share: float) -> tuple[float, ...]:
    """Return a colour with white."""
    from matplotlib.colors import to_rgb

    return tuple(1 - share * (1 - channel) for channel in to_rgb(colour))


def _shaded(colour: str, normals: Floats) -> Floats:
    """Colours (n, 3) of faces by their normals (n, 3)."""
    from matplotlib.colors import to_rgb

    light = np.maximum(normals @ (_LIGHT / np.linalg.norm(_LIGHT)), 0.0)
    bright = _DIM + (1 - _DIM) * light
    result: Floats = np.clip(bright[:, None] * np.array(to_rgb(colour)) * 1.15, 0, 1)
    return result
