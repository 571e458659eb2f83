"""Pictures of stresses at the worst positions of a check: in the teeth, around and below the contact, along the fillets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.plane.result import PlaneCheck
from gearcad.contact.plane.cycle import root_loads
from gearcad.contact.plane.elasticity import Plane
from gearcad.contact.plane.field import ToothField, contact_frame, tooth_field
from gearcad.contact.plane.subsurface import strip_stresses
from gearcad.meshing.outline import Side
from gearcad.per_gear import Role
from gearcad.plots.paper import DARK, GEARS, MARKED, SERIES, legend_above, new_figure, prepared
from gearcad.rating import LineContact, Stresses

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from gearcad.contact.plane.cycle import PlanePairContact, PlanePosition

__all__ = [
    "depth_stresses",
    "fillet_curve",
    "hertz_contact",
    "plot_contact_zone",
    "plot_depth_profile",
    "plot_fillets",
    "plot_stress_field",
    "shown_contact",
    "worst_fields",
]

_Place = tuple[float, float]

_COLOUR_MAP = "viridis"
_TEETH_SHOWN = 3.6
_ZONE = 3.0
"""Half the width of the pictures: in normal modules for the teeth, in half widths for the contact."""

_ON_WHITE = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 2.0}

_OVER = 1.1
"""The end of the colours of the teeth, in greatest stresses of the fillets."""

_DEEPEST = 4.0
"""Depth of the profiles in half widths of contact."""

_LEAST_ANGLE, _ISO_ANGLE = 20.0, 30.0
"""Tangent angles (deg) from which on a fillet is the root, and where ISO 6336-3 looks."""


def shown_contact(result: PlaneCheck) -> tuple[PlanePosition, PlanePairContact]:
    """The contact of the greatest pressure away from corners, or that of the greatest load where all are near them."""
    return result.cycle.worst_contact or result.cycle.heaviest_contact


def worst_fields(result: PlaneCheck) -> list[ToothField]:
    """Stresses in three teeth of each gear at the position of the contact that is shown."""
    position, contact = shown_contact(result)
    teeth = range(contact.tooth - 1, contact.tooth + 2)
    return [tooth_field(result.cycle, position, role, tooth) for role in Role for tooth in teeth]


def plot_stress_field(result: PlaneCheck, ax: Axes | None = None, fields: list[ToothField] | None = None) -> Axes:
    """Von Mises stress of both gears in mesh; colours end a little above the greatest of the fillets.

    `fields` are those of `worst_fields`, if they are at hand.
    """
    position, _ = shown_contact(result)
    most = max(abs(stress.stress) for stress in (*position.tension, *position.compression))
    module = result.pair.pinion.normal_module
    fields = worst_fields(result) if fields is None else fields
    return _plot_field(result, ax, fields, _TEETH_SHOWN * module, _OVER * most, ((0.12, 0.5), (0.88, 0.5)))


def plot_contact_zone(result: PlaneCheck, ax: Axes | None = None, fields: list[ToothField] | None = None) -> Axes:
    """Von Mises stress around the contact of `plot_stress_field`, some half widths wide."""
    _, contact = shown_contact(result)
    fields = worst_fields(result) if fields is None else fields
    most = max(float(field.von_mises.max()) for field in fields)
    return _plot_field(result, ax, fields, _ZONE * contact.hertz_half_width, most, ((0.5, 0.06), (0.5, 0.94)))


def _plot_field(
    result: PlaneCheck, ax: Axes | None, fields: list[ToothField], reach: float, most: float, names: tuple[_Place, _Place]
) -> Axes:
    """Fields within `reach` (mm) of the worst contact, colours up to `most` (MPa), the gears' names at parts of the axes."""
    axes = new_figure().subplots() if ax is None else ax
    (x, y), _ = contact_frame(result.cycle, shown_contact(result)[1])
    for field in fields:
        drawn = axes.tripcolor(
            *field.points.T, field.triangles, field.von_mises, shading="gouraud", vmin=0, vmax=most, cmap=_COLOUR_MAP
        )
        drawn.set_rasterized(True)
        axes.plot(*field.outline.T, color=DARK, linewidth=0.9)
    extend = "max" if any(field.von_mises.max() > most for field in fields) else "neither"
    axes.figure.colorbar(drawn, ax=axes, label="von Mises stress in MPa", extend=extend)
    axes.set_aspect("equal")
    axes.set_xlim(x - 1.45 * reach, x + 1.45 * reach)
    axes.set_ylim(y - reach, y + reach)
    axes.set_xlabel("from the pinion's axis towards the wheel's in mm")
    axes.set_ylabel("across in mm")
    for (gear, _, _), place in zip(GEARS, names, strict=True):
        axes.text(*place, gear, transform=axes.transAxes, ha="center", va="center", fontsize=9, bbox=_ON_WHITE)
    return axes


def fillet_curve(result: PlaneCheck, role: Role, side: Side) -> tuple[Floats, Floats]:
    """Tangent angles (deg) and stresses (MPa) along a fillet of the most stressed tooth when its gear's tension is greatest."""
    fillets = result.cycle.model.fillets.pick(role)
    seen = root_loads(result.cycle.worst_position(role).contacts, role)
    worst = max(seen, key=lambda loads: fillets.greatest(Side.LEFT_FILLET, loads).stress)
    angles = fillets.places(side)[1]
    order = np.argsort(angles)
    return angles[order], fillets.stresses(side, worst)[order]


def plot_fillets(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Stress along both fillets of each gear at its worst position, over the tangent's angle to the middle of the tooth."""
    axes = prepared(ax, "tangent angle, from the middle of the tooth, in °", "stress along the fillet in MPa")
    for role, (words, colour, marker) in zip(Role, GEARS, strict=True):
        for side, kind, style in ((Side.LEFT_FILLET, "tension", "-"), (Side.RIGHT_FILLET, "compression", "--")):
            angles, stresses = fillet_curve(result, role, side)
            root = angles >= _LEAST_ANGLE
            axes.plot(angles[root], stresses[root], color=colour, linestyle=style, label=f"{words}, {kind}")
        found = result.cycle.worst_position(role).tension.pick(role)
        bends = result.cycle.model.bodies.pick(role).ring.support.bends
        label = f"{words}, greatest{' of all teeth' if bends else ''}: {found.tangent_angle:.0f}°"
        axes.plot([found.tangent_angle], [found.stress], marker, color=colour, label=label)
    axes.axvline(_ISO_ANGLE, color=MARKED, linestyle=":", label="30°, ISO 6336-3")
    axes.axhline(0, color=MARKED, linewidth=0.8)
    legend_above(axes, 3)
    return axes


def plot_depth_profile(result: PlaneCheck, ax: Axes | None = None) -> Axes:
    """Stresses below the middle of the worst contact by the pressures found (lines), and by Hertz (dots)."""
    axes = prepared(ax, "depth below the flank in mm", "stress in MPa")
    _, contact = shown_contact(result)
    depth = contact.hertz_half_width * np.linspace(0.02, _DEEPEST, 200)
    found, hertz = depth_stresses(result, contact, depth), hertz_contact(result, contact).stresses(depth)
    for (name, words), colour in zip(_DEPTH_WORDS.items(), SERIES, strict=True):
        axes.plot(depth, getattr(found, name), color=colour, linewidth=1.3, label=words)
        axes.plot(depth[::10], getattr(hertz, name)[::10], "o", color=colour, markersize=3.5, markerfacecolor="none")
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


def depth_stresses(result: PlaneCheck, contact: PlanePairContact, depth: Floats) -> Stresses:
    """Stresses of a half-plane below the centre of the pressures of a contact, in the directions of `Stresses`."""
    cells = contact.pair.cells
    middle = float((cells.place * contact.pressures).sum() / contact.pressures.sum())
    across, down, shear = strip_stresses(np.full_like(depth, middle), depth, cells.place, cells.width, contact.pressures)
    along = _poisson_ratio(result) * (across + down)
    half, centre = np.hypot((across - down) / 2, shear), (across + down) / 2
    largest = (np.maximum(centre + half, along) - np.minimum(centre - half, along)) / 2
    mises = np.sqrt(((across - down) ** 2 + (down - along) ** 2 + (along - across) ** 2) / 2 + 3 * shear**2)
    return Stresses(depth, across, along, down, largest, mises)


def hertz_contact(result: PlaneCheck, contact: PlanePairContact) -> LineContact:
    """Two cylinders of the curvature of the flanks under the load of a contact."""
    return LineContact(
        load_per_width=contact.force,
        radius=contact.pair.radius,
        modulus=contact.modulus,
        poisson_ratio=_poisson_ratio(result),
    )


def _poisson_ratio(result: PlaneCheck) -> float:
    """That of sigma_y: in plane stress there is none."""
    return result.material.poisson_ratio if result.options.plane_state is Plane.STRAIN else 0.0
