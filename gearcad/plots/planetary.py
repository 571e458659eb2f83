"""Pictures of a planetary train: in mesh, lever diagram, phases and load sharing."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.records import Floats, Role
from gearcad.dynamics.planetary.load_sharing import LoadSharing
from gearcad.dynamics.planetary.planetary_excitation import PlanetMeshStiffness
from gearcad.dynamics.planetary.planetary_statics import TorsionalStiffness, TwistSource
from gearcad.geometry import Gear
from gearcad.geometry.gear_data import outer_diameter, section_turn
from gearcad.planetary import MeshPhases, PairStage, PlanetaryTrain, Rim, SetMesh, TrainPose
from gearcad.planetary.power import PowerFlow
from gearcad.plots.gears import fill_gear
from gearcad.plots.paper import DARK, FIGURE_INCHES, MARKED, SERIES, legend_above, new_figure, plain, prepared, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


PLANETS = SERIES[3]
"""Colour of the planets."""

_ROUNDING = 1e-9
"""Share of the greatest power below which a power counts as none."""


def colour_of(train: PlanetaryTrain, name: str) -> str:
    """Colour of a member, of a rim, or of the shaft of a stage."""
    if name in train.members:
        return SERIES[train.members.index(name)]
    return PLANETS if any(rim.name == name for rim in train.rims) else DARK


def role_of(train: PlanetaryTrain, name: str) -> str:
    """Return the role of a member or shaft in the train: "input", "output", "fixed", or "" for none of these."""
    return {train.input: "input", train.output: "output", train.fixed: "fixed"}.get(name, "")


def power_ways(train: PlanetaryTrain, flow: PowerFlow | None) -> dict[str, str]:
    """Return the direction of power for members and shafts: "in" where it enters the train, "out" where it leaves.

    If no power flows, the input and the output decide.
    """
    powers = {} if flow is None else flow.powers
    least = _ROUNDING * max(map(abs, powers.values()), default=0.0)
    found = {name: "in" if power > 0 else "out" for name, power in powers.items() if abs(power) > least}
    return found or {train.input: "in", train.output: "out"}


def role_words(train: PlanetaryTrain, name: str, ways: Mapping[str, str]) -> str:
    """Return the role of a member, and the direction of power, such as "power in", if the role does not give it."""
    role, way = role_of(train, name), ways.get(name, "")
    said = not way or role == f"{way}put"
    return ", ".join(each for each in (role, "" if said else f"power {way}") if each)


def rim_words(train: PlanetaryTrain, rim: Rim) -> str:
    """Return a text such as "3 × planet"."""
    return f"{train.planets} × {rim.name}" if train.planets > 1 else rim.name


def signed(gear: Gear) -> str:
    """Return the text "z = ..." with the number of teeth, negative for a ring."""
    return f"z = {gear.teeth}".replace("-", "−")


def stage_gear(stage: PairStage, role: Role) -> str:
    """Name of a gear of a stage, or what it is of the stage where both gears are called alike."""
    names = stage.pair.gears.map(lambda gear: gear.name)
    return names.pick(role) if names.pinion != names.wheel else f"{stage.name}, {role.value}"


def placed_stages(train: PlanetaryTrain) -> list[tuple[PairStage, str, str]]:
    """Stages from the set outwards, each with the shaft towards the set, and with the one that it adds."""
    known, waiting, found = set(train.members), list(train.stages), []
    while waiting:
        near = next((each for each in waiting if {each.pinion, each.wheel} & known), waiting[0])
        waiting.remove(near)
        inner, outer = (near.pinion, near.wheel) if near.pinion in known else (near.wheel, near.pinion)
        found.append((near, inner, outer))
        known |= {inner, outer}
    return found


LINE = 0.145
"""Height of a line of text (inches)."""

_CHARACTERS, _LINES = 21, 3
"""Largest number of characters in a line, and of lines in a name."""


def lines_of(*texts: str) -> list[str]:
    """Return the texts in short lines; of one that is too long, the beginning."""
    found = []
    for text in texts:
        lines = textwrap.wrap(text, _CHARACTERS)
        if len(lines) > _LINES:
            lines = [*lines[: _LINES - 1], f"{lines[_LINES - 1][: _CHARACTERS - 1]}…"]
        found += lines
    return found


def spread(wanted: Sequence[float], heights: Sequence[float], gap: float = 0.08) -> list[float]:
    """Middles of blocks of these heights, as near as can be to where they are wanted, without overlap (least squares)."""
    order = sorted(range(len(wanted)), key=lambda each: wanted[each])
    groups: list[list[float]] = []
    offsets, offset = [], 0.0
    for before, each in zip([None, *order], order, strict=False):
        offset += 0.0 if before is None else (heights[before] + heights[each]) / 2 + gap
        offsets.append(offset)
        # Pooled adjacent violators: blocks that would overlap move together, about the mean of their wishes.
        groups.append([wanted[each] - offset, 1.0])
        while len(groups) > 1 and groups[-2][0] > groups[-1][0]:
            (mean, count), (former, others) = groups.pop(), groups.pop()
            groups.append([(mean * count + former * others) / (count + others), count + others])
    starts = [mean for mean, count in groups for _ in range(int(count))]
    placed = [0.0] * len(wanted)
    for each, start, shift in zip(order, starts, offsets, strict=True):
        placed[each] = start + shift
    return placed


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
    """Return the size of the front view: a panel for each rim of a planet."""
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
    """Return the greatest distance (mm) of the gears of a mesh from the axis."""
    planet = abs(mesh.pair.centre_distance) + mesh.rim.gear.tip_diameter / 2
    return planet if mesh.external else max(planet, outer_diameter(mesh.central.gear) / 2)


def _draw_gears(axes: Axes, train: PlanetaryTrain, pose: TrainPose, rim: Rim, chord: float) -> None:
    """Centrals and planets that the plane through the middle of a rim cuts."""
    height = pose.heights[rim.name] + rim.gear.face_width / 2
    for central in train.centrals:
        if central.meshes == rim.name:
            rest = pose.rotations[central.name]
            turn = math.radians(rest + _section(central.gear, height - pose.heights[central.name]))
            colour = colour_of(train, central.name)
            fill_gear(axes, central.gear, (0.0, 0.0), turn, colour, chord, rest=math.radians(rest))
    for planet in pose.planets:
        rest = planet.rotations[rim.name]
        turn = math.radians(rest + _section(rim.gear, rim.gear.face_width / 2))
        fill_gear(axes, rim.gear, (planet.x, planet.y), turn, PLANETS, chord, rest=math.radians(rest))


def _section(gear: Gear, height: float) -> float:
    """Return the turn (degrees) of the section at a height (mm) above the bottom of the teeth."""
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
    """Return the radius of an arrow in the body of a gear (mm)."""
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


def lever_places(train: PlanetaryTrain) -> dict[str, float]:
    """Return the places of members and "planets" on the lever, as distances from the carrier; the first central is at 1.

    Speeds against the carrier are as these: (w_b - w_c)/(w_a - w_c) = 1/i_0, and (w_p - w_c)/(w_a - w_c) = -z_a/z_2.
    """
    first, second = train.meshes
    planet = -first.central.gear.teeth / first.rim.gear.teeth
    return {first.central.name: 1.0, second.central.name: 1 / train.basic_ratio, train.carrier.name: 0.0, "planets": planet}


def plot_ladder(train: PlanetaryTrain, speeds: Mapping[str, float], planet: float, unit: str, ax: Axes | None = None) -> Axes:
    """Draw the speeds of members by name and of a planet, in a unit:
    rungs from standstill to the line that all of them are on.
    """
    axes = prepared(new_figure().subplots() if ax is None else ax, f"speed in {unit}", "")
    places = lever_places(train)
    found = {name: speeds[name] for name in train.members} | {"planets": planet}
    colours = {name: colour_of(train, name) for name in train.members} | {"planets": PLANETS}
    ends = sorted(places, key=lambda name: places[name])
    axes.plot([found[ends[0]], found[ends[-1]]], [places[ends[0]], places[ends[-1]]], color=DARK, linewidth=1.0, zorder=2)
    axes.axvline(0.0, color=MARKED, linewidth=0.8)
    for name, place in places.items():
        axes.plot([0.0, found[name]], [place, place], color=colours[name], linewidth=2.0, solid_capstyle="butt", zorder=3)
        axes.plot(found[name], place, "o", color=colours[name], markersize=6, zorder=4)
    axes.set_yticks([])
    axes.grid(False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.margins(x=0.06, y=0.12)
    axes.autoscale(axis="x", enable=True)
    right = axes.get_xlim()[1]
    axes.hlines(list(places.values()), [found[name] for name in places], right, color=MARKED, linewidth=0.6, zorder=1)
    axes.set_xlim(right=right)
    _name(axes, train, places, found)
    return axes


def _name(axes: Axes, train: PlanetaryTrain, places: Mapping[str, float], speeds: Mapping[str, float]) -> None:
    """Names beside their rungs, apart where these are near each other."""
    low, high = axes.get_ylim()
    inches = (FIGURE_INCHES[1] - 0.7) / (high - low)
    names = list(places)
    texts = []
    for name in names:
        role = role_of(train, name)
        words = f"{short(speeds[name])}{f', {role}' if role else ''}".replace("-", "−")
        texts.append(lines_of(name, words))
    heights = spread([places[name] * inches for name in names], [LINE * len(lines) for lines in texts], gap=0.04)
    for name, lines, height in zip(names, texts, heights, strict=True):
        across = axes.get_yaxis_transform()
        axes.annotate(
            plain("\n".join(lines)),
            (1.0, places[name]),
            (1.05, height / inches),
            across,
            across,
            arrowprops={"arrowstyle": "-", "color": MARKED, "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0, "relpos": (0, 0.5)},
            va="center",
            fontsize=8,
            color=DARK,
            linespacing=1.25,
            annotation_clip=False,
        )


_PLACES = 721
"""Places of a base pitch at which stiffnesses are added up."""

_NAMED = 12
"""Largest number of planets whose numbers have room beside their rows."""


def phases_inches(train: PlanetaryTrain, stiffness: Mapping[str, PlanetMeshStiffness] | None) -> tuple[float, float]:
    """Return the size of the picture: rows for the planets, and curves below where stiffnesses are known."""
    return FIGURE_INCHES[0], 1.3 + 0.17 * min(train.planets, _NAMED) + (2.0 if stiffness else 0.0)


def plot_phases(
    train: PlanetaryTrain,
    phases: Mapping[str, MeshPhases],
    stiffness: Mapping[str, PlanetMeshStiffness] | None = None,
    figure: Figure | None = None,
) -> Figure:
    """Draw a column for each mesh over one base pitch: dots where planets meet the pitch point,
    below the sum of stiffnesses.
    """
    of = new_figure(phases_inches(train, stiffness)) if figure is None else figure
    rows = 0.6 + 0.17 * min(train.planets, _NAMED)
    heights = [rows, 2.0] if stiffness else [rows]
    panels = of.subplots(len(heights), 2, sharex=True, squeeze=False, height_ratios=heights)
    for column, mesh in enumerate(train.meshes):
        _draw_rows(panels[0, column], train, phases[mesh.name].ahead, mesh)
        if stiffness:
            _draw_sum(panels[1, column], train, phases[mesh.name].ahead, stiffness[mesh.name])
        panels[-1, column].set_xlabel("base pitches of this mesh", fontsize=9)
    panels[0, 0].set_xlim(0, 1)
    panels[0, 0].set_ylabel("planet")
    if stiffness:
        panels[1, 0].set_ylabel("stiffness in N/µm")
    return of


def _draw_rows(axes: Axes, train: PlanetaryTrain, ahead: tuple[float, ...], mesh: SetMesh) -> None:
    prepared(axes, "", "")
    colour = colour_of(train, mesh.central.name)
    for planet, place in enumerate(ahead, 1):
        met = -place % 1.0
        met = 0.0 if met > 1 - 1e-9 else met  # a whole pitch but for rounding
        axes.plot([0, 1], [planet, planet], color=PLANETS, linewidth=0.8, alpha=0.6)
        dots = [met, met + 1.0] if met < 1e-9 else [met]  # what is met at the end of the pitch is met at its beginning
        axes.plot(dots, [planet] * len(dots), "o", color=colour, markersize=5, clip_on=False)
    step = -(-train.planets // _NAMED)
    axes.set_yticks(range(1, train.planets + 1, step))
    axes.set_ylim(train.planets + 0.7, 0.3)
    axes.grid(False, axis="y")
    axes.set_title(plain(mesh.name), fontsize=10, loc="left")


def _draw_sum(axes: Axes, train: PlanetaryTrain, ahead: tuple[float, ...], stiffness: PlanetMeshStiffness) -> None:
    prepared(axes, "", "")
    places = np.linspace(0, 1, _PLACES)
    for place in ahead:
        axes.plot(places, stiffness.stiffness_at(place + places), color=MARKED, linewidth=0.8)
    axes.plot(
        places, stiffness_sum(ahead, stiffness, places), color=colour_of(train, stiffness.mesh.central.name), linewidth=1.6
    )
    axes.axhline(len(ahead) * stiffness.mean, color=DARK, linewidth=0.8, linestyle="--")
    axes.set_ylim(bottom=0)


def stiffness_sum(ahead: tuple[float, ...], stiffness: PlanetMeshStiffness, places: Floats) -> Floats:
    """Return the stiffness (N/µm) of all planets together at places (n,) of a base pitch."""
    found: Floats = sum((stiffness.stiffness_at(place + places) for place in ahead), np.zeros_like(places))
    return found


SOURCE_COLOURS = {
    TwistSource.MESH: SERIES[1],
    TwistSource.PIN: PLANETS,
    TwistSource.SUPPORT: SERIES[2],
    TwistSource.SHAFT: SERIES[0],
    TwistSource.STAGE: DARK,
}

_STYLES = ("--", ":", "-.")
"""Line styles of published factors, which are all grey."""


def plot_sharing(sharing: LoadSharing, ax: Axes | None = None) -> Axes:
    """Draw the shares of the planets, with what turns adding and taking; K_gamma as computed, and published ones beside it."""
    axes = prepared(new_figure().subplots() if ax is None else ax, "planet", "share, 1: all alike")
    planets = np.arange(1, len(sharing.shares) + 1)
    reach = np.array([sharing.shares - sharing.least_shares, sharing.greatest_shares - sharing.shares]).clip(min=0.0)
    axes.bar(planets, sharing.shares, width=0.6, color=PLANETS, label="share")
    if sharing.turning:
        # Without what turns there is nothing between least and greatest.
        axes.errorbar(
            planets, sharing.shares, reach, fmt="none", ecolor=DARK, elinewidth=1.2, capsize=4, label="over all turns"
        )
    factor = sharing.mesh_load_factor
    axes.axhline(factor, color=DARK, linewidth=1.4, label=f"$K_\\gamma$ here, {factor:.3f}")
    for published, style in zip(sharing.published, _STYLES, strict=False):
        recalled = ", recalled" if published.recalled else ""
        words = plain(f"{published.source}{recalled}, {short(published.factor)}")
        axes.axhline(published.factor, color=MARKED, linewidth=1.2, linestyle=style, label=words)
    highest = max(factor, *(each.factor for each in sharing.published), 1.0)
    axes.set_ylim(0, 1.08 * highest)
    axes.set_xticks(planets)
    axes.grid(False, axis="x")
    legend_above(axes, 2)
    return axes


def torsion_inches(torsion: TorsionalStiffness) -> tuple[float, float]:
    """Return the size of the picture: a bar for each contribution."""
    return FIGURE_INCHES[0], 1.1 + 0.3 * len(torsion.contributions)


def plot_torsion(torsion: TorsionalStiffness, ax: Axes | None = None) -> Axes:
    """Draw the share of each spring in the twist (%), the greatest first."""
    axes = prepared(new_figure(torsion_inches(torsion)).subplots() if ax is None else ax, "share of the twist in %", "")
    found = sorted(torsion.contributions, key=lambda each: -each.share)
    places = range(len(found))
    bars = axes.barh(
        places, [100 * each.share for each in found], color=[SOURCE_COLOURS[each.source] for each in found], height=0.6
    )
    axes.bar_label(bars, [f"{100 * each.share:.1f}" for each in found], padding=4, fontsize=8, color=DARK)
    axes.set_yticks(places, [plain(each.name) for each in found])
    axes.set_ylim(len(found) - 0.4, -0.6)
    axes.set_xlim(0, 1.12 * max(100 * found[0].share, 1.0))
    axes.grid(False, axis="y")
    return axes
