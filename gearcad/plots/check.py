"""Pictures of a check: pressure, load share, stiffness, root stress, lines of contact, stress fields, torque and mesh size."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gearcad.check.depth import MaterialExposure
from gearcad.check.friction import MeshLosses
from gearcad.check.oil_film import OilFilm
from gearcad.check.on_shafts import LoadOnShafts
from gearcad.check.pictures import ToothSurface
from gearcad.check.result import CheckResult, PlaneCheck, SolidCheck
from gearcad.core.records import Floats, PerGear, Role
from gearcad.geometry import GearPair, RackPair
from gearcad.material import Limit, by_gear
from gearcad.plots.paper import DARK, GEARS, MARKED, PALE, SERIES, draw_limit, legend_above, new_figure, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.tri import Triangulation


PATH = "place on the line of action, from T$_1$, in mm"
_ROLL = "roll angle of the pinion in °, 0 at the pitch point"


def plot_contact_pressure(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Draw the peak pressure of every pair of teeth along the path of contact, beside Hertz's under the load that the pair
    carries.

    Near the ends of the flanks there is no line: there the pressure is that of an edge. Contact of a corner is marked below.
    """
    axes = prepared(ax, PATH, "peak pressure in MPa")
    contacts = result.contacts_along_path
    lengths = np.array([contact.place for contact in contacts])
    inside = np.array([contact.interior for contact in contacts])
    corner = np.array([contact.edge for contact in contacts])
    for name, words, colour, width in (
        ("hertz_pressure", "Hertz, under the load carried", PALE, 3.5),
        ("peak_pressure", "finite elements", SERIES[0], 1.3),
    ):
        values = np.array([getattr(contact, name) for contact in contacts])
        axes.plot(lengths, np.where(inside, values, np.nan), color=colour, linewidth=width, label=words)
    axes.set_ylim(0, 1.12 * max(contact.peak_pressure for contact in contacts if contact.interior) if inside.any() else None)
    edge = ~inside & ~corner
    for places, words, marker in ((edge, "near an edge", "|"), (corner, "a corner touches", "x")):
        if places.any():
            height = np.zeros(places.sum())
            across = axes.get_xaxis_transform()
            axes.plot(lengths[places], height + 0.03, marker, color=DARK, markersize=5, transform=across, label=words)
    for limit in _limits(result, "contact_limit"):
        draw_limit(axes, limit)
    mark_path(axes, result.pair)
    legend_above(axes, 3)
    return axes


def plot_load_share(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Part of the load that a pair of teeth carries along the path of contact, contact of corners beyond it included."""
    axes = prepared(ax, PATH, "share of the load")
    contacts = result.contacts_along_path
    lengths = np.array([contact.place for contact in contacts])
    shares = np.array([contact.share for contact in contacts])
    corner = np.array([contact.edge for contact in contacts])
    axes.plot(lengths, shares, color=SERIES[0], label="finite elements")
    if corner.any():
        axes.plot(lengths[corner], shares[corner], "x", color=DARK, markersize=5, label="a corner touches")
    axes.set_ylim(0, 1.05)
    mark_path(axes, result.pair)
    legend_above(axes, 2)
    return axes


def plot_losses(losses: MeshLosses, ax: Axes | None = None) -> Axes:
    """Power that friction takes over one base pitch, in percent of that of the pinion, its mean, and Ohlendorf's."""
    axes = prepared(ax, _ROLL, "power lost in %")
    whole = abs(losses.torque) / 100
    axes.plot(losses.roll_angles, losses.lost_torque / whole, color=SERIES[0], label="friction in the contact")
    mean = losses.mean_torque / whole
    axes.axhline(mean, color=SERIES[0], linestyle="--", linewidth=1.4, label=f"its mean: {mean:.3f} %")
    if losses.ohlendorf is not None:
        by_rule = 100 * losses.coefficient * losses.ohlendorf
        axes.axhline(by_rule, color=SERIES[1], linestyle="--", linewidth=1.4, label=f"$\\mu H_V$, Ohlendorf: {by_rule:.3f} %")
    axes.set_ylim(bottom=0)
    legend_above(axes, 2)
    return axes


def plot_mesh_stiffness(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Mesh stiffness over one base pitch, its mean and the greatest of a single pair, beside c_gamma and c' of ISO 6336-1."""
    axes = prepared(ax, _ROLL, "stiffness in N/(mm µm)")
    summary, standard, part = result.summary, result.rating.stiffness, result.rating.edition.part(1)
    axes.plot(result.cycle.course("roll_angle"), result.cycle.course("stiffness"), color=SERIES[0], label="mesh stiffness")
    for value, words, colour, style in (
        (summary.mesh_stiffness_mean, "its mean", SERIES[0], "--"),
        (standard.mesh_alpha, rf"$c_{{\gamma\alpha}}$, {part}", SERIES[1], "--"),
        (summary.single_stiffness, "one pair alone, greatest", SERIES[0], ":"),
        (standard.single, f"$c'$, {part}", SERIES[1], ":"),
    ):
        axes.axhline(value, color=colour, linestyle=style, linewidth=1.4, label=f"{words}: {value:.2f}")
    legend_above(axes, 2)
    return axes


def plot_transmission_error(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Draw the transmission error over one base pitch (µm along the line of action), whole and by gears, less the means."""
    axes = prepared(ax, _ROLL, "along the line of action, less the mean, in µm")
    cycle = result.cycle
    curves = [("transmission error", cycle.course("transmission_error"), result.mean_lag.whole, DARK, "-", 1.5)]
    parts = 1000 * cycle.course("approach_parts")
    for gear, (_, colour, _), part, mean in zip(result.names, GEARS, parts.T, result.mean_lag.parts, strict=True):
        curves.append((f"part of the {gear}", part, mean, colour, "--", 1.2))
    for words, values, mean, colour, style, width in curves:
        label = f"{words}, mean {short(mean)} µm"
        axes.plot(cycle.course("roll_angle"), values - mean, color=colour, linestyle=style, linewidth=width, label=label)
    legend_above(axes, 2)
    return axes


def plot_root_stress(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Draw the greatest tension and compression of both fillets over one base pitch, beside the root stress of ISO 6336-3."""
    axes = prepared(ax, _ROLL, "root stress in MPa")
    angles = result.cycle.course("roll_angle")
    standard = r"$\sigma_{F0}$" if result.load.application_factor == 1 else r"$\sigma_{F0} K_A$"
    for role, (_, colour, _) in GEARS.items():
        words = result.names.pick(role)
        for name, style in (("tension", "-"), ("compression", "--")):
            stresses = [getattr(position, name).pick(role).stress for position in result.cycle.every]
            axes.plot(angles, stresses, color=colour, linestyle=style, label=f"{words}, {name}")
        reference = result.rating.root_stresses.pick(role)
        axes.axhline(reference, color=colour, linestyle=":", linewidth=1.4, label=f"{words}, {standard} = {reference:.0f} MPa")
    for limit in _limits(result, "root_limit"):
        draw_limit(axes, limit)
    axes.axhline(0, color=MARKED, linewidth=0.8)
    legend_above(axes, 3)
    return axes


def _limits(result: CheckResult, name: str) -> list[Limit]:
    """Return the limits of a property of both materials, each once."""
    return list(dict.fromkeys(getattr(material, name) for material in by_gear(result.material).values()))


def mark_path(axes: Axes, pair: GearPair | RackPair) -> None:
    """The points A to E of the path of contact, by name."""
    across = axes.get_xaxis_transform()
    for name, place in pair.path_of_contact._asdict().items():
        axes.axvline(place, color=MARKED, linewidth=0.9, zorder=0.5)
        axes.text(place, 0.985, f" {name}", transform=across, ha="left", va="top", fontsize=9, color=DARK)


_COLOUR_MAP = "viridis"

_ROUNDED = 6
"""Decimals (mm) of places that count as one."""

_GAP = 3.0
"""Ratio of a triangle's edge to the distance between neighbours above which the edge spans a hole in the map."""

_BREAK = 0.04
"""Part of the path between neighbours above which a curve along it is broken."""

_ACROSS = "across the face, from the middle of the common width, in mm"


def plot_line_loads(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Draw the line load over the plane of action, and the lines of contact of the position with the greatest pressure, or
    load.
    """
    axes = new_figure().subplots() if ax is None else ax
    cells = result.cells
    cells = cells.only(~cells.on_edge | (cells.line_load > 0))
    _map(axes, cells.place, cells.across, cells.line_load, result.summary.line_load_max, "line load in N/mm")
    for contact in result.shown.position.contacts:
        axes.plot(contact.line.nominal, contact.line.across, color="white", linewidth=1.2, linestyle="--")
    axes.set_xlabel(PATH)
    axes.set_ylabel("across the face in mm")
    mark_path(axes, result.pair)
    return axes


def plot_exposure(exposure: MaterialExposure, ax: Axes | None = None) -> Axes:
    """Material exposure of a gear at every depth below its flank, with the worst point and the depth of the case."""
    axes = new_figure().subplots() if ax is None else ax
    drawn = axes.pcolormesh(exposure.places, exposure.depths, exposure.exposure.T, vmin=0, cmap=_COLOUR_MAP, shading="nearest")
    drawn.set_rasterized(True)
    axes.figure.colorbar(drawn, ax=axes, label=r"material exposure, $\tau/\tau_{per}$")
    worst = f"greatest: {exposure.worst:.3f}, {exposure.worst_depth:.3g} mm deep"
    axes.plot(
        [exposure.worst_place], [exposure.worst_depth], "o", color=DARK, markeredgecolor="white", markersize=7, label=worst
    )
    if case := exposure.profile.case_depth:
        axes.axhline(case, color=DARK, linestyle=":", linewidth=1.2, label=f"case depth, {case:.3g} mm")
    axes.set_ylim(float(exposure.depths[-1]), 0.0)
    axes.set_xlabel(f"roll length on the {exposure.role.value}'s flank in mm")
    axes.set_ylabel("depth in mm")
    legend_above(axes, 2)
    return axes


def plot_exposure_course(exposure: MaterialExposure, ax: Axes | None = None) -> Axes:
    """Amplitude of the largest shear stress over the depth at the worst point of a flank, and what the hardness bears."""
    axes = prepared(ax, "depth in mm", "shear stress in MPa")
    axes.plot(exposure.depths, exposure.shear, color=SERIES[0], label="amplitude of the largest shear stress")
    bears = rf"$\tau_{{per}} = {exposure.profile.ratio:g}\,HV$"
    axes.plot(exposure.depths, exposure.permissible, color=SERIES[1], label=bears)
    axes.set_ylim(bottom=0)
    legend_above(axes, 2)
    return axes


def plot_oil_film(film: OilFilm, ax: Axes | None = None) -> Axes:
    """Contact temperature and specific film thickness along the path of contact, away from edges, and the standard's."""
    axes, shown = prepared(ax, PATH, "temperature in °C"), film.shown
    places, gaps = film.places[shown], np.diff(film.places[shown], prepend=film.places[shown][0])
    broken = gaps > _BREAK * float(np.ptp(places))

    def drawn(values: Floats) -> Floats:
        return np.where(broken, np.nan, values[shown])

    if film.standard_course is not None:
        axes.plot(*film.standard_course, color=PALE, linewidth=3.5, label="contact, ISO/TR 13989-1")
    axes.plot(places, drawn(film.contact), color=SERIES[0], label="contact, local pressures")
    axes.axhline(film.bulk, color=DARK, linestyle="--", linewidth=1.2, label=f"bulk: {film.bulk:.1f} °C")
    beside = axes.twinx()
    beside.plot(places, drawn(film.specific), color=SERIES[1])
    beside.set_ylabel(r"specific film thickness, $\lambda_{GF}$")
    beside.set_ylim(bottom=0)
    beside.spines["top"].set_visible(False)
    axes.plot([], [], color=SERIES[1], label=r"$\lambda_{GF}$, at the right")
    mark_path(axes, film.pair)
    legend_above(axes, 2)
    return axes


def plot_contact_pattern(result: SolidCheck, role: Role, ax: Axes | None = None) -> Axes:
    """Draw the greatest pressure of the cycle at every place of the flank of a gear, in the flank's outline.

    Contact of edges is left out.
    """
    axes = new_figure().subplots() if ax is None else ax
    cells, own = result.cells, result.task.gears[role]
    cells = cells.only(~cells.on_edge)
    _map(
        axes,
        cells.heights.pick(role),
        cells.rolls.pick(role),
        cells.pressure,
        result.summary.contact_pressure,
        "pressure in MPa",
    )
    form = own.flank_form
    z, roll = np.array([0, 1, 1, 0, 0]) * form.width, np.array([0, 0, 1, 1, 0]) * (form.last - form.first) + form.first
    axes.plot(z, roll, color=DARK, linewidth=1.2, label=f"flank of the {role.value}, tip above")
    root = result.along_face.roots.pick(role)
    for height, words in ((root.low, "ends of the common width"), (root.high, None)):
        axes.axvline(height, color=MARKED, linestyle=":", linewidth=1.2, label=words)
    axes.set_xlabel("along the axis, z in mm")
    axes.set_ylabel("roll length in mm")
    legend_above(axes, 2)
    return axes


def _map(axes: Axes, x: Floats, y: Floats, values: Floats, most: float | None, words: str) -> None:
    """Greatest values at every place as colours, which end at the greatest away from edges, if there is one."""
    (x, y), found = _greatest(x, y, values)
    most = float(found.max()) if most is None else most
    drawn = axes.tripcolor(_joined(x, y), found, shading="gouraud", vmin=0, vmax=most, cmap=_COLOUR_MAP)
    drawn.set_rasterized(True)
    axes.figure.colorbar(drawn, ax=axes, label=words, extend="max" if found.max() > most else "neither")


def _greatest(x: Floats, y: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the places (2, m), each once, and the greatest value there: an edge touches at the same place many times."""
    places, index = np.unique(np.stack([x, y], -1).round(_ROUNDED), axis=0, return_inverse=True)
    found = np.zeros(len(places))
    np.maximum.at(found, index.ravel(), values)
    return places.T, found


def _joined(x: Floats, y: Floats) -> Triangulation:
    """Return the triangles between places, but for those that would span a hole."""
    from matplotlib.tri import Triangulation

    triangles = Triangulation(x, y)
    corners = np.stack([x, y], -1)[triangles.triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max(axis=1)
    triangles.set_mask(longest > _GAP * float(np.median(longest)))
    return triangles


def plot_lines_share(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Part of the load that a pair of teeth carries, over the place where its line of contact crosses the middle."""
    axes = prepared(ax, PATH, "share of the load")
    axes.plot(result.load_share.places, result.load_share.shares, color=SERIES[0], label="finite elements")
    axes.set_ylim(0, 1.05)
    mark_path(axes, result.pair)
    legend_above(axes, 1)
    return axes


def plot_harmonics(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Draw the amplitudes of the transmission error at the tooth frequency and its multiples."""
    axes = prepared(ax, "harmonic of the tooth frequency", "amplitude in µm")
    amplitudes = result.summary.transmission_error_harmonics
    bars = axes.bar(np.arange(len(amplitudes)) + 1, amplitudes, width=0.6, color=SERIES[0])
    axes.bar_label(bars, [short(each) for each in amplitudes], fontsize=9, padding=2)
    axes.set_ylim(0, 1.15 * max(amplitudes))
    axes.set_xticks(np.arange(len(amplitudes)) + 1)
    return axes


def plot_load_along_face(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Load per width over the face width, mean of the cycle, with its own mean."""
    axes = prepared(ax, _ACROSS, "load per width in N/mm")
    along, factor = result.along_face, result.summary.face_load_factor
    axes.step(along.across, along.load, where="mid", color=SERIES[0], label="mean of all positions")
    mean = along.mean
    axes.axhline(mean, color=DARK, linestyle="--", linewidth=1.2, label=f"over the width: {short(mean)} N/mm")
    axes.axhline(factor * mean, color=DARK, linestyle=":", linewidth=1.2, label=rf"$K_{{H\beta}}$ = {factor:.3f}")
    if (shafts := result.shafts) is not None:
        axes.step(shafts.across, shafts.rigid_load, where="mid", color=PALE, label="on rigid shafts")
        axes.plot(shafts.across, shafts.annex_e_load, color=SERIES[1], label="ISO 6336-1, annex E")
    axes.set_ylim(bottom=0)
    legend_above(axes, 3)
    return axes


def plot_gap_of_shafts(shafts: LoadOnShafts, ax: Axes | None = None) -> Axes:
    """Gap that both shafts leave over the face under the load of the solid contact, from its least on."""
    axes = prepared(ax, _ACROSS, "gap along the line of action in µm")
    axes.plot(shafts.across, shafts.gap, color=SERIES[0], label="both shafts, under the load of the bodies")
    legend_above(axes, 1)
    return axes


def plot_root_along_face(result: SolidCheck, ax: Axes | None = None) -> Axes:
    """Draw the greatest root tension of the cycle along the face of both gears; what stands out beyond the common width is
    pale.
    """
    axes, part = prepared(ax, _ACROSS, "root tension in MPa"), result.rating.edition.part(3)
    for role, (words, colour, marker) in GEARS.items():
        root = result.along_face.roots.pick(role)
        factor = result.summary.root_face_load_factor.pick(role)
        axes.plot(root.across, root.stress, color=colour, linewidth=1.0, alpha=0.4)
        inside = root.common
        label = rf"{words}, $K_{{F\beta}}$ = {factor:.2f}"
        axes.plot(root.across[inside], root.stress[inside], color=colour, marker=marker, markersize=3.5, label=label)
        standard = result.rating.root_stresses.pick(role)
        axes.axhline(standard, color=colour, linestyle=":", linewidth=1.4, label=f"{words}, {part}: {standard:.0f} MPa")
    axes.set_ylim(bottom=0)
    legend_above(axes, 2)
    return axes


_TEETH_SHOWN = 3.6
_ZONE = 3.0
"""Half the width of the pictures: in normal modules for the teeth, in half widths for the contact."""

_ON_WHITE = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 2.0}

_OVER = 1.1
"""The end of the colours of the teeth, in greatest stresses of the fillets."""

_LEAST_ANGLE = 20.0
"""Tangent angle (deg) from which on a fillet is the root."""


def plot_stress_field(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Von Mises stress of both gears in mesh; colours end a little above the greatest of the fillets."""
    position = result.shown.position
    most = max(abs(stress.stress) for stress in (*position.tension, *position.compression))
    module = result.pair.pinion.normal_module
    return _plot_field(result, ax, _TEETH_SHOWN * module, _OVER * most, PerGear((0.12, 0.5), (0.88, 0.5)))


def plot_contact_zone(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Von Mises stress around the contact of `plot_stress_field`, some half widths wide."""
    reach, most = _ZONE * result.shown.contact.hertz_half_width, result.stress_field.greatest
    return _plot_field(result, ax, reach, most, PerGear((0.5, 0.06), (0.5, 0.94)))


def _plot_field(result: PlaneCheck, ax: Axes | None, reach: float, most: float, names: PerGear[tuple[float, float]]) -> Axes:
    """Return the fields within `reach` (mm) of the contact, colours up to `most` (MPa),
    the gears' names at parts of the axes.
    """
    axes, stress = new_figure().subplots() if ax is None else ax, result.stress_field
    for field in stress.fields:
        drawn = axes.tripcolor(
            *field.points.T, field.triangles, field.von_mises, shading="gouraud", vmin=0, vmax=most, cmap=_COLOUR_MAP
        )
        drawn.set_rasterized(True)
        axes.plot(*field.outline.T, color=DARK, linewidth=0.9)
    extend = "max" if stress.greatest > most else "neither"
    axes.figure.colorbar(drawn, ax=axes, label="von Mises stress in MPa", extend=extend)
    axes.set_aspect("equal")
    axes.set_xlim(stress.x - 1.45 * reach, stress.x + 1.45 * reach)
    axes.set_ylim(stress.y - reach, stress.y + reach)
    sense = "the rack" if isinstance(result.pair, RackPair) else "the wheel's"
    towards = "away from the ring's" if result.ring else f"towards {sense}"
    axes.set_xlabel(f"from the pinion's axis {towards} in mm")
    axes.set_ylabel("across in mm")
    for role, place in names.items():
        axes.text(
            *place, result.names.pick(role), transform=axes.transAxes, ha="center", va="center", fontsize=9, bbox=_ON_WHITE
        )
    return axes


def plot_fillets(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Draw the stress along both fillets of each gear at its worst position, over the tangent's angle to the middle of the
    tooth.
    """
    axes = prepared(ax, "tangent angle, from the middle of the tooth, in °", "stress along the fillet in MPa")
    for role, (_, colour, marker) in GEARS.items():
        words = result.names.pick(role)
        curves, found = result.fillet_curves.pick(role), result.root_peaks.pick(role)
        for kind, curve, style in (("tension", curves.tension, "-"), ("compression", curves.compression, "--")):
            root = curve.angles >= _LEAST_ANGLE
            axes.plot(curve.angles[root], curve.stresses[root], color=colour, linestyle=style, label=f"{words}, {kind}")
        all_round = " of all teeth" if result.bending.pick(role) else ""
        label = f"{words}, greatest{all_round}: {found.tangent_angle:.0f}°"
        axes.plot([found.tangent_angle], [found.stress], marker, color=colour, label=label)
    for angle in sorted({root.section.lean for root in result.rating.roots}):
        axes.axvline(angle, color=MARKED, linestyle=":", label=f"{angle:g}°, ISO 6336-3")
    axes.axhline(0, color=MARKED, linewidth=0.8)
    legend_above(axes, 3)
    return axes


def plot_depth_profile(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Draw the stresses below the middle of the worst contact by the pressures found (lines), and by Hertz (dots)."""
    axes = prepared(ax, "depth below the flank in mm", "stress in MPa")
    profile = result.depth_profile
    depth = profile.found.depth
    for (name, words), colour in zip(_DEPTH_WORDS.items(), SERIES, strict=True):
        axes.plot(depth, getattr(profile.found, name), color=colour, linewidth=1.3, label=words)
        axes.plot(depth[::10], getattr(profile.hertz, name)[::10], "o", color=colour, markersize=3.5, markerfacecolor="none")
    axes.plot([], [], "o", color=DARK, markersize=3.5, markerfacecolor="none", label="dots: Hertz")
    axes.axhline(0, color=MARKED, linewidth=0.8)
    axes.set_xlim(left=0)
    legend_above(axes, 3)
    return axes


_DEPTH_WORDS = {
    "sigma_x": r"$\sigma_x$, along the profile",
    "sigma_y": r"$\sigma_y$, along the tooth",
    "sigma_z": r"$\sigma_z$, into the tooth",
    "largest_shear": r"$\tau$, greatest shear",
    "von_mises": "von Mises",
}
"""Stresses of a depth profile as the legend has them."""


COLOUR_MAP = "viridis"

YAW, PITCH = 50.0, 25.0
"""Angles of view of a tooth (degrees): turned about its height to show the loaded flank, and tilted towards the viewer."""

_AXES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""Directions to the right, upwards and towards the viewer, for a tooth that is seen along its axis and stands upright."""


def viewed(points: Floats) -> Floats:
    """Return points (n, 3) in the directions of the view: to the right, up, and towards the viewer."""
    yaw, pitch = math.radians(YAW), math.radians(PITCH)
    turn = np.array([[math.cos(yaw), 0, math.sin(yaw)], [0, 1, 0], [-math.sin(yaw), 0, math.cos(yaw)]])
    tilt = np.array([[1, 0, 0], [0, math.cos(pitch), -math.sin(pitch)], [0, math.sin(pitch), math.cos(pitch)]])
    result: Floats = points @ (tilt @ turn @ _AXES).T
    return result


def plot_tooth(surface: ToothSurface, ax: Axes | None = None) -> Axes:
    """Draw a still picture of a tooth: triangles that face the viewer, the farthest first."""
    from matplotlib.collections import PolyCollection

    axes = new_figure().subplots() if ax is None else ax
    seen = viewed(surface.points)[surface.triangles]
    normals = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    order = np.argsort(seen[:, :, 2].mean(axis=1))
    order = order[normals[order, 2] > 0]
    values = surface.von_mises[surface.triangles].mean(axis=1)
    drawn = PolyCollection(list(seen[order, :, :2]), array=values[order], cmap=COLOUR_MAP, edgecolors="face", linewidths=0.3)
    drawn.set_clim(0, surface.most)
    axes.add_collection(drawn)
    axes.figure.colorbar(drawn, ax=axes, label="von Mises stress in MPa", extend="max")
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
    return axes


_TORQUE = "torque on the pinion in N·m"
_MARKERS = ("o", "s", "^")


def plot_sweep_pressure(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Draw the greatest contact pressure over torque,
    beside the square root that Hertz has for a load shared in the same way.
    """
    axes = prepared(ax, _TORQUE, "peak pressure in MPa")
    torques, pressures = _swept(result, "contact_pressure")
    fine = np.linspace(0, torques[-1], 100)
    words = "as the square root of the torque"
    axes.plot(fine, pressures[-1] * np.sqrt(fine / torques[-1]), color=PALE, linewidth=3.5, label=words)
    axes.plot(torques, pressures, "o", color=SERIES[0], label="finite elements")
    axes.set_ylim(bottom=0)
    axes.set_xlim(left=0)
    legend_above(axes, 2)
    return axes


def plot_sweep_stiffness(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Draw the mean mesh stiffness and M/phi of each gear over torque, as parts of their values at the greatest torque."""
    axes = prepared(ax, _TORQUE, "part of the value at full torque in %")
    torques, stiffness = _swept(result, "mesh_stiffness")
    axes.plot(torques, 100 * stiffness / stiffness[-1], "^-", color=DARK, label=f"mesh: {short(stiffness[-1])} N/(mm µm)")
    _, turning = _swept(result, "torsional_stiffness")
    for gear, (_, colour, marker), values in zip(result.names, GEARS, turning.T, strict=True):
        words = rf"$M/\varphi$, {gear}: {short(values[-1])} N·m/rad"
        if gear == "rack":
            words = f"force over travel, rack: {short(values[-1])} N/µm"
        axes.plot(torques, 100 * values / values[-1], marker=marker, linestyle="--", color=colour, label=words)
    axes.axhline(100, color=MARKED, linewidth=0.8)
    axes.set_xlim(left=0)
    legend_above(axes, 2)
    return axes


def plot_convergence(result: CheckResult, ax: Axes | None = None) -> Axes:
    """Difference of each quantity from its value on the finest mesh, over the refinement of the mesh."""
    axes = prepared(ax, "refinement of the mesh (1: the check itself)", "difference from the finest mesh in %")
    for each, colour, marker in zip(result.convergence, SERIES, _MARKERS, strict=False):
        difference = 100 * (np.array(each.values) / each.values[-1] - 1)
        axes.plot(each.factors, difference, marker=marker, color=colour, label=each.quantity)
    axes.axhline(0, color=MARKED, linewidth=0.8)
    axes.set_xscale("log", base=2)
    axes.set_xticks(result.convergence[0].factors, [f"{factor:g}" for factor in result.convergence[0].factors])
    axes.minorticks_off()
    legend_above(axes, 3)
    return axes


def _swept(result: CheckResult, name: str) -> tuple[Floats, Floats]:
    """Return the torques (N·m) in rising order, and a quantity at each; NaN where there is none."""
    points = result.trends.points
    return np.array([point.torque for point in points]), np.array([getattr(point, name) for point in points], float)
