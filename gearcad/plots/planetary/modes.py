"""Natural modes of a train, drawn: how carrier, centrals and planets travel and turn."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.modes import ModeFamily, PlanetaryModes
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.paper import FIGURE_INCHES, MARKED, new_figure, short
from gearcad.plots.planetary.parts import PLANETS, colour_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["MOST_MODES", "mode_title", "modes_inches", "plot_modes", "shown_families"]

MOST_MODES = 12
"""Frequencies whose modes are drawn, the lowest that are not 0."""

_COLUMNS = 4

_MOVED = 0.22
"""Greatest travel that is drawn, in centre distances."""

_SPOKES = 4
"""Marks on a body, which show how far it turns."""


class _Body(NamedTuple):
    """A body of the drawing: rest place (2,), travel (2,), turn (rad), radius, colour, and whether marks reach its middle."""

    place: Floats
    travel: Floats
    turn: float
    radius: float
    colour: str
    open: bool


def shown_families(modes: PlanetaryModes) -> list[ModeFamily]:
    """The frequencies whose modes are drawn."""
    return [family for family in modes.families if family.frequency > 0][:MOST_MODES]


def modes_inches(modes: PlanetaryModes) -> tuple[float, float]:
    """Size of the picture."""
    rows = math.ceil(len(shown_families(modes)) / _COLUMNS)
    return FIGURE_INCHES[0], 1.95 * rows


def mode_title(family: ModeFamily) -> str:
    """Such as "3: 1892 Hz, T, twice"."""
    many = {1: "", 2: ", twice"}.get(family.multiplicity, f", {family.multiplicity} times")
    return f"{family.first + 1}: {short(family.frequency)} Hz\n{family.kind.value}{many}"


def plot_modes(train: PlanetaryTrain, modes: PlanetaryModes, figure: Figure | None = None) -> Figure:
    """A panel for each frequency, with the first of its modes: at rest pale, displaced in colour, much enlarged."""
    of = new_figure(modes_inches(modes)) if figure is None else figure
    families = shown_families(modes)
    panels = of.subplots(math.ceil(len(families) / _COLUMNS), _COLUMNS, squeeze=False).ravel()
    for panel in panels:
        panel.set_axis_off()
    for panel, family in zip(panels, families, strict=False):
        bodies = list(_bodies(train, modes, family.first))
        reach = max(float(np.hypot(*body.place)) + body.radius for body in bodies)
        _draw_carrier(panel, train, bodies)
        for body in bodies[1:]:
            _draw_body(panel, body)
        panel.set_aspect("equal")
        panel.set_xlim(-1.22 * reach, 1.22 * reach)
        panel.set_ylim(-1.22 * reach, 1.22 * reach)
        panel.set_title(mode_title(family), fontsize=8, pad=2)
    return of


def _bodies(train: PlanetaryTrain, modes: PlanetaryModes, mode: int) -> Iterator[_Body]:
    """Carrier, centrals and planets, displaced; lengths in mm."""
    shape, turns = modes.shape[mode], modes.turns[mode]
    distance = float(train.centre_distance)
    scale = _MOVED * distance / max(float(np.hypot(shape[:, 0], shape[:, 1]).max()), float(np.abs(shape[:, 2]).max()))
    members = modes.springs.members
    for name, (x, y, _), turn in zip(members, shape, turns, strict=False):
        mesh = next((each for each in train.meshes if each.central.name == name), None)
        radius = distance if mesh is None else abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2
        ring = mesh is not None and not mesh.external
        # Turns are scaled as lengths at the radius by which they count: mm on paper over m, so 1e-3.
        yield _Body(np.zeros(2), scale * np.array([x, y]), scale * turn * 1e-3, radius, colour_of(train, name), ring)
    mesh = train.meshes[0]
    radius = abs(mesh.pair.working_pitch_diameters.pick(mesh.rim_role)) / 2
    for angle, (outwards, along, _), turn in zip(modes.springs.planar.angles, shape[3:], turns[3:], strict=True):
        out, on = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        yield _Body(distance * out, scale * (outwards * out + along * on), scale * turn * 1e-3, radius, PLANETS, False)


def _draw_body(axes: Axes, body: _Body) -> None:
    from matplotlib.patches import Circle

    moved = body.place + body.travel
    axes.add_patch(Circle(tuple(body.place), body.radius, fill=False, edgecolor=MARKED, linewidth=0.5, linestyle=":"))
    axes.add_patch(Circle(tuple(moved), body.radius, fill=False, edgecolor=body.colour, linewidth=1.2))
    for spoke in range(_SPOKES):
        rest = 2 * math.pi * spoke / _SPOKES
        inner = 0.82 * body.radius if body.open else 0.0
        _draw_mark(axes, body.place, rest, (inner, body.radius), MARKED, 0.5)
        _draw_mark(axes, moved, rest + body.turn, (inner, body.radius), body.colour, 1.0)


def _draw_mark(axes: Axes, place: Floats, angle: float, radii: tuple[float, float], colour: str, width: float) -> None:
    direction = np.array([math.cos(angle), math.sin(angle)])
    ends = place + np.outer(radii, direction)
    axes.plot(*ends.T, color=colour, linewidth=width)


def _draw_carrier(axes: Axes, train: PlanetaryTrain, bodies: list[_Body]) -> None:
    """Arms to the pins, which stay on the carrier: planets move away from them as pins bend."""
    carrier = bodies[0]
    for planet in bodies[3:]:
        angle = math.atan2(planet.place[1], planet.place[0])
        _draw_mark(axes, carrier.place, angle, (0.0, carrier.radius), MARKED, 0.5)
        _draw_mark(axes, carrier.place + carrier.travel, angle + carrier.turn, (0.0, carrier.radius), carrier.colour, 1.6)
