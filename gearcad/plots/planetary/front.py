"""A train in mesh, seen along its axis: exact outlines of all gears of the set for one angle of the carrier."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.geometry import Gear
from gearcad.geometry.helix import section_turn
from gearcad.planetary import PlanetaryTrain, Rim, SetMesh, TrainPose
from gearcad.plots.labels import plain
from gearcad.plots.pair import fill_gear
from gearcad.plots.paper import DARK, FIGURE_INCHES, new_figure
from gearcad.plots.planetary.parts import PLANETS, colour_of
from gearcad.rating.rim import outer_diameter

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["front_inches", "plot_front"]

_ONE = (FIGURE_INCHES[0], 5.0)
"""Inches of a picture of a set whose planets have one rim."""

_CHORD = 1 / 2500
"""Error of outlines, in parts of half the picture."""

_SWEEP = 45.0
"""Degrees that an arrow of rotation goes round."""

_BESIDE = 0.05
"""Room beside the gears for arrows, in parts of half the picture."""

_Point = tuple[float, float]


class _Turn(NamedTuple):
    """An arrow about a centre: its radius, direction of its middle (degrees), sense and colour."""

    centre: _Point
    radius: float
    middle: float
    speed: float
    colour: str


def front_inches(train: PlanetaryTrain) -> tuple[float, float]:
    """Size of the front view: a panel for each rim of a planet."""
    return (FIGURE_INCHES[0], FIGURE_INCHES[0] / 2 + 0.3) if train.stepped else _ONE


def plot_front(train: PlanetaryTrain, pose: TrainPose, turning: Mapping[str, float], figure: Figure | None = None) -> Figure:
    """Transverse sections through the middle of each rim, seen from +z; planets numbered, working circles dash-dotted.

    `turning` has speeds of members, of any unit, and that of "planet": their signs are the senses of the arrows; who stands,
    or is not in it, has none.
    """
    of = new_figure(front_inches(train)) if figure is None else figure
    reach = (1 + 2 * _BESIDE) * max(map(_radius, train.meshes))
    for panel, rim in zip(of.subplots(1, len(train.rims), squeeze=False)[0], train.rims, strict=True):
        meshes = [mesh for mesh in train.meshes if mesh.rim is rim]
        _draw_gears(panel, train, pose, rim, reach * _CHORD)
        _draw_circles(panel, train, pose, meshes)
        for number, planet in enumerate(pose.planets, 1):
            panel.text(planet.x, planet.y, str(number), ha="center", va="center", fontsize=9, color=DARK)
        for turn in _turns(train, pose, rim, turning, reach):
            _draw_turn(panel, turn)
        names = " and ".join(mesh.central.name for mesh in meshes)
        panel.set_title(plain(f"{names} with {rim.name}"), fontsize=9, pad=4)
        panel.set_aspect("equal")
        panel.set_xlim(-reach, reach)
        panel.set_ylim(-reach, reach)
        panel.set_axis_off()
    return of


def _radius(mesh: SetMesh) -> float:
    """How far from the axis the gears of a mesh reach (mm)."""
    planet = abs(mesh.pair.centre_distance) + mesh.rim.gear.tip_diameter / 2
    return planet if mesh.external else max(planet, outer_diameter(mesh.central.gear) / 2)


def _draw_gears(axes: Axes, train: PlanetaryTrain, pose: TrainPose, rim: Rim, chord: float) -> None:
    """Centrals and planets that the plane through the middle of a rim cuts."""
    height = pose.heights[rim.name] + rim.gear.face_width / 2
    for central in train.centrals:
        if central.meshes == rim.name:
            turn = pose.rotations[central.name] + _section(central.gear, height - pose.heights[central.name])
            fill_gear(axes, central.gear, (0.0, 0.0), math.radians(turn), colour_of(train, central.name), chord)
    for planet in pose.planets:
        turn = planet.rotations[rim.name] + _section(rim.gear, rim.gear.face_width / 2)
        fill_gear(axes, rim.gear, (planet.x, planet.y), math.radians(turn), PLANETS, chord)


def _section(gear: Gear, height: float) -> float:
    """How far (degrees) the section at a height above the bottom of the teeth is turned."""
    return math.degrees(float(section_turn(gear, np.array([height]))[0]))


def _draw_circles(axes: Axes, train: PlanetaryTrain, pose: TrainPose, meshes: list[SetMesh]) -> None:
    """Working circles of all gears, and the axis."""
    from matplotlib.patches import Circle

    for mesh in meshes:
        diameters = mesh.pair.working_pitch_diameters
        places = [((0.0, 0.0), mesh.central_role), *(((each.x, each.y), mesh.rim_role) for each in pose.planets)]
        for place, role in places:
            radius = abs(diameters.pick(role)) / 2
            axes.add_patch(Circle(place, radius, fill=False, edgecolor=DARK, linestyle="-.", linewidth=0.5))
    axes.plot(0, 0, "+", color=DARK, markersize=9, markeredgewidth=0.8)
    pins, colour = float(train.centre_distance), colour_of(train, train.carrier.name)
    axes.add_patch(Circle((0.0, 0.0), pins, fill=False, edgecolor=colour, linewidth=0.6))


def _turns(train: PlanetaryTrain, pose: TrainPose, rim: Rim, turning: Mapping[str, float], reach: float) -> Iterator[_Turn]:
    """Arrows: in suns, round rings, in every planet, and on the circle of the pins half-way to the next planet."""
    for central in train.centrals:
        if central.meshes == rim.name:
            ring = central.gear.internal
            radius = outer_diameter(central.gear) / 2 + _BESIDE * reach if ring else _inside(central.gear)
            yield _Turn((0.0, 0.0), radius, 90.0, turning.get(central.name, 0.0), colour_of(train, central.name))
    for planet in pose.planets:
        yield _Turn((planet.x, planet.y), _inside(rim.gear), planet.angle, turning.get("planet", 0.0), PLANETS)
    first, last = pose.planets[0], pose.planets[-1]
    middle = (last.angle + first.angle + (360 if last.angle > first.angle or last is first else 0)) / 2
    speed, colour = turning.get(train.carrier.name, 0.0), colour_of(train, train.carrier.name)
    yield _Turn((0.0, 0.0), float(train.centre_distance), middle, speed, colour)


def _inside(gear: Gear) -> float:
    """Radius of an arrow in the body of a gear (mm)."""
    return (gear.body.bore + 2 * gear.root_diameter) / 6


def _draw_turn(axes: Axes, turn: _Turn) -> None:
    """An arc with a head, in the sense of the speed; none of what stands."""
    if not turn.speed:
        return
    sense = math.copysign(1.0, turn.speed)
    angles = np.radians(turn.middle + sense * np.linspace(-_SWEEP / 2, _SWEEP / 2, 25))
    points = np.array(turn.centre) + turn.radius * np.stack([np.cos(angles), np.sin(angles)], -1)
    axes.plot(*points.T, color=turn.colour, linewidth=1.6, solid_capstyle="butt")
    head = {"arrowstyle": "-|>", "color": turn.colour, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tuple(points[-1] + 0.02 * (points[-1] - points[-2])), tuple(points[-2]), arrowprops=head)
