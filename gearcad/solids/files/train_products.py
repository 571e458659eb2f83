"""Products of a planetary train: its gears, the solid of its carrier, and the train in mesh, moved apart, or turning."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gearcad.core.dxf import drawing
from gearcad.core.records import Floats
from gearcad.geometry import Gear
from gearcad.geometry.gear_data import section_turn
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.train_data import shafts_of, speeds
from gearcad.solids.body_plan import BRIGHT_STEEL, TRAIN_COLOURS
from gearcad.solids.exact.boundary import ORIGIN, Boundary, Chain, Point, Recorder, level_plane
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.kernel_mesh import kernel_facets
from gearcad.solids.exact.solid import (
    AssembledProduct,
    Occurrence,
    SolidProduct,
    cad_assembly,
    cad_solid,
    gear_boundary,
    placed,
)
from gearcad.solids.exact.teeth import tube
from gearcad.solids.facets.tessellation import Facets
from gearcad.solids.files.dxf import draw_circles, draw_section, extent_of, gear_contour
from gearcad.solids.files.products import FileOptions, GearProduct
from gearcad.solids.files.scenes import ScenePart, Turning
from gearcad.solids.train_plan import CarrierPlan, Standing, TrainLayout, TrainPlan

if TYPE_CHECKING:
    import cadquery
    from ezdxf.document import Drawing


_TOLERANCE = 1e-7
"""Tolerance (mm) of edges and vertices: planes, cylinders and circles are exact."""


def carrier_boundary(plan: CarrierPlan) -> Boundary:
    """Plates and pins as one closed boundary; pins end flush with the outer faces of plates."""
    recorder = Recorder(_TOLERANCE / 2)
    holes: dict[float, list[Chain]] = {end: [] for plate in plan.plates for end in plate}
    for stretch in _free_stretches(plan):
        for pin in plan.pins:
            contours = tube(recorder, plan.diameter / 2, stretch, pin, outward=True)
            for z, contour, outward in zip(stretch, contours, (False, True), strict=True):
                if z in holes:
                    holes[z].append(contour.loop(along=False))
                else:
                    recorder.face(level_plane(z), [contour.loop(along=True)], outward=outward)
    for plate in plan.plates:
        outer = tube(recorder, plan.outer, plate, outward=True)
        inner = tube(recorder, plan.inner, plate, outward=False) if plan.inner else []
        for which, z in enumerate(plate):
            loops = [outer[which].loop(along=True), *(ring.loop(along=False) for ring in inner[which : which + 1]), *holes[z]]
            recorder.face(level_plane(z), loops, outward=which == 1)
    return recorder.boundary()


def carrier_solid(plan: CarrierPlan) -> cadquery.Solid:
    """Return the carrier as a CadQuery solid: see `carrier_boundary`."""
    return cad_solid(carrier_boundary(plan))


def _free_stretches(plan: CarrierPlan) -> Iterator[tuple[float, float]]:
    """Yield the heights (mm) between which pins are outside of plates."""
    at, end = plan.reach
    for bottom, top in sorted(plan.plates):
        if at < bottom:
            yield at, bottom
        at = top
    if at < end:
        yield at, end


def train_assembly(
    train: PlanetaryTrain, *, carrier_angle: float = 0.0, carrier: bool = False, exploded: bool = False
) -> cadquery.Assembly:
    """Return the train with its axis on z, its carrier turned by `carrier_angle` (degrees), backlash split evenly.

    Its parts are called as members and rims are, and `planet_1` and so on, which are assemblies where planets are stepped.
    `carrier` adds pins and plates; `exploded` moves members apart along the axis. Raises GeometryError for rings without a
    rim, bodies that stand in each other, and a carrier for planets without bores.
    """
    return cad_assembly(train_product(TrainPlan.of(train, carrier_angle=carrier_angle, carrier=carrier, exploded=exploded)))


def train_product(plan: TrainPlan) -> AssembledProduct:
    """Return the assembly of a plan; bodies that are alike are one product."""
    layout = plan.layout
    train, parts = layout.train, _parts(layout)
    found = [_occurrence(standing, parts) for standing in layout.centrals]
    for planet in layout.planets:
        if train.stepped:
            axle = planet[0].axle
            rims = tuple(_occurrence(standing, parts, origin=(axle.x, axle.y)) for standing in planet)
            body = AssembledProduct(f"{train.name} {axle.name}", rims)
            found.append(Occurrence(axle.name, body, placed((axle.x, axle.y, 0.0))))
        else:
            found.append(_occurrence(planet[0], parts))
    found += [_occurrence(standing, parts) for standing in layout.stages]
    if plan.carrier is not None:
        name = layout.carrier.name
        product = SolidProduct(f"{train.name} {name}", carrier_boundary(plan.carrier), TRAIN_COLOURS["carrier"][0])
        found.append(Occurrence(name, product, placed()))
    return AssembledProduct(train.name, tuple(found))


def _parts(layout: TrainLayout) -> dict[str, SolidProduct]:
    """Return the bodies of a train by their keys."""
    return {key: SolidProduct(body.name, gear_boundary(body.gear), body.colour) for key, body in layout.bodies.items()}


def _occurrence(standing: Standing, parts: dict[str, SolidProduct], origin: Point = ORIGIN) -> Occurrence:
    """Return a body in its place, seen from an axis through `origin` (x, y)."""
    x, y, z = standing.offset
    frame = placed((x - origin[0], y - origin[1], z), standing.rotation)
    return Occurrence(standing.name, parts[standing.body.key], frame)


def carrier_facets(plan: CarrierPlan, chord_error: float) -> Facets:
    """Return the solid in triangles of the kernel, nowhere more than `chord_error` (mm) from it."""
    return kernel_facets(kernel_solid(carrier_boundary(plan)), chord_error)


_SECONDS = 10.0
"""Least duration (s) of an animation."""

_MOST_TURNS = 60.0
"""Largest number of turns of any part; then an animation ends even if the carrier has not completed a turn."""

_FASTEST = 1.5
"""Turns a second of anything: what is faster cannot be followed."""

_WHOLE = 1e-6
"""Largest deviation from whole pitches, as a share of a pitch, at which a part has come round."""


def turning_of(layout: TrainLayout, given: Mapping[str, float] | None = None) -> Turning:
    """Return the turning of a train by `turns_of`: once, or repeated until all teeth come round.

    No part turns more than _MOST_TURNS times; a single turning in which one would is cut short. Raises ParameterError for
    speeds that contradict each other.
    """
    turns = turns_of(layout, given)
    most = max(map(abs, turns.values()))
    times = _times_round(layout, turns, most) if most <= _MOST_TURNS else _MOST_TURNS / most
    return Turning(duration=max(_SECONDS, times * most / _FASTEST), turns={name: times * turn for name, turn in turns.items()})


def turns_of(layout: TrainLayout, given: Mapping[str, float] | None = None) -> dict[str, float]:
    """Turns of all axles by name, seen from what carries each, while the carrier turns once, or the input where it does not.

    As `given` speeds (rpm) say; where they do not suffice, the input turns with its sign in them, or positively. Then a
    differential's member that is neither input nor output stands still. Raises ParameterError for speeds that contradict each
    other.
    """
    train = layout.train
    found = speeds(train, _given_speeds(train, given or {}))
    turns = {**found.members, **{planet[0].axle.name: found.planet_relative for planet in layout.planets}}
    once = next((abs(turns[name]) for name in (train.carrier.name, train.input) if turns[name]), max(map(abs, turns.values())))
    return {name: speed / once for name, speed in turns.items()}


def _times_round(layout: TrainLayout, turns: Mapping[str, float], most: float) -> int:
    """Return how many times these turns bring every body to where it looks as at first; 1 if that takes too long."""
    pitches: dict[str, int] = {layout.carrier.name: 1}
    for standing in layout.standing:
        # All gears of an axle come round together.
        name, teeth = standing.axle.name, standing.body.gear.tooth_count
        pitches[name] = math.gcd(pitches.get(name, 0), teeth)
    for times in range(1, int(_MOST_TURNS / most) + 1):
        passed = [times * turns[name] * count for name, count in pitches.items()]
        if all(abs(each - round(each)) < _WHOLE for each in passed):
            return times
    return 1


def _given_speeds(train: PlanetaryTrain, known: Mapping[str, float]) -> Mapping[str, float]:
    """Return the speeds (rpm) that define the motion of the train."""
    if len(known) >= (1 if train.fixed else 2) and any(known.values()):
        return known
    given = {train.input: math.copysign(1.0, known.get(train.input, 1.0))}
    if train.fixed is None:
        shafts = shafts_of(train)
        busy = {shafts[name].member for name in (train.input, train.output)}
        given[next(name for name in train.members if name not in busy)] = 0.0
    return given


_SHADES = (1, 5, 3, 30, 6, 4, 2, 40)
"""Colours (AutoCAD index) of the layers, in turn."""

_NOT_IN_LAYERS = re.compile(r'[<>/\\":;?*|=`,]')


def write_train_dxf(layout: TrainLayout, path: Path | str, *, accuracy: float = 0.0005, circles: bool = False) -> None:
    """Write the transverse sections of all gears as DXF (R2010, mm), each a closed polyline of arcs in its place.

    Gears that mesh are cut by one plane: rims and centrals in the middle of their teeth, a stage in the middle of its pinion's.
    What is of one gear, bore, rim and bolt holes included, is on a layer of its name; all planets share those of their rims.
    `circles` draws tip, reference, base and root circles on a layer CIRCLES. The header states how far the drawing reaches.
    Equal input gives equal bytes. Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    layers = {key: _NOT_IN_LAYERS.sub("_", key) for key in layout.bodies}
    contours = {key: gear_contour(body.gear, accuracy) for key, body in layout.bodies.items()}
    colours = {layers[key]: (_SHADES[i % len(_SHADES)], "CONTINUOUS") for i, key in enumerate(layers)}
    low, high = np.full(2, math.inf), np.full(2, -math.inf)
    with drawing(path, colours) as document:
        for standing in layout.standing:
            key = standing.body.key
            turn = section_angle(layout, standing)
            placed = _draw(document, standing, contours[key], turn, layers[key], accuracy=accuracy, circles=circles)
            least, most = extent_of(placed)
            rim = standing.body.gear.body.rim_diameter or 0.0
            place = np.array(standing.offset[:2])
            low, high = np.minimum(low, least), np.maximum(high, most)
            if rim:
                low, high = np.minimum(low, place - rim / 2), np.maximum(high, place + rim / 2)
        document.modelspace().reset_extents((*low, 0.0), (*high, 0.0))


def section_angle(layout: TrainLayout, standing: Standing) -> float:
    """Return the angle (rad) by which the section of a gear is turned in the plane that cuts its mesh."""
    gear = standing.body.gear
    height = gear.face_width / 2
    if standing in layout.stages:
        number = layout.stages.index(standing)
        pinion = layout.stages[number - number % 2]
        height = pinion.z + pinion.body.gear.face_width / 2 - standing.z
    return math.radians(standing.rotation) + float(section_turn(gear, np.array([height]))[0])


def _draw(
    document: Drawing, standing: Standing, contour: Floats, turn: float, layer: str, *, accuracy: float, circles: bool
) -> Floats:
    """Draw a gear in its place; its contour there. The teeth of a splined bore are straight: they turn with the body."""
    from ezdxf.math import Matrix44

    space = document.modelspace()
    x, y, _ = standing.offset
    place = Matrix44.z_rotate(turn) @ Matrix44.translate(x, y, 0.0)
    before = len(space)
    draw_section(space, standing.body.gear, contour, accuracy)
    if standing.body.gear.body.bore_spline:
        for entity in space[before:]:
            if entity.dxf.layer == "BORE":
                entity.transform(Matrix44.z_rotate(math.radians(standing.rotation) - turn))
    for entity in space[before:]:
        entity.dxf.layer = layer
    if circles:
        draw_circles(document, standing.body.gear)
    for entity in space[before:]:
        entity.transform(place)
    cosine, sine = math.cos(turn), math.sin(turn)
    across, along, bulge = contour.T
    return np.stack([cosine * across - sine * along + x, sine * across + cosine * along + y, bulge], -1)


@dataclass(frozen=True)
class CarrierProduct:
    """The carrier of a train, called `name`: its lowest plate begins at z = 0."""

    plan: CarrierPlan
    name: str
    options: FileOptions

    @cached_property
    def facets(self) -> Facets:
        return carrier_facets(self.plan, self.options.chord_error)

    blanks: ClassVar[dict[str, Gear]] = {}
    """A carrier has no blank of its own."""

    def solid(self) -> SolidProduct:
        """Pins and plates: see `carrier_boundary`."""
        return SolidProduct(self.name, carrier_boundary(self.plan), BRIGHT_STEEL)

    def scene(self) -> list[ScenePart]:
        """Return the carrier alone, in the middle."""
        return [ScenePart(name=self.name, facets=self.facets, colour=TRAIN_COLOURS["carrier"][0])]


@dataclass(frozen=True)
class TrainProduct:
    """A planetary train, as the options ask for it. Raises GeometryError where it cannot be made: see `TrainPlan`.

    `speeds` (rpm) are those that are given, by which it turns in an animation. With `as_made` its gears are as they are made.
    """

    train: PlanetaryTrain
    options: FileOptions
    speeds: Mapping[str, float] = field(default_factory=dict)
    as_made: bool = False

    @property
    def name(self) -> str:
        return self.train.name

    @cached_property
    def plan(self) -> TrainPlan:
        """Plan of the train: its bodies and their places."""
        return self._plan(exploded=self.options.exploded)

    def _plan(self, *, exploded: bool) -> TrainPlan:
        return TrainPlan.of(self.train, carrier=self.options.carrier, exploded=exploded, as_made=self.as_made)

    @property
    def _layout(self) -> TrainLayout:
        return TrainLayout(self.train, self.train.pose(), as_made=self.as_made)

    def require_room(self) -> None:
        """Raise what making the plan raises."""
        _ = self.plan

    @cached_property
    def parts(self) -> dict[str, GearProduct]:
        """The gears by the names of their files."""
        return {
            key: GearProduct(gear=body.gear, name=body.name, options=self.options, colour=body.colour)
            for key, body in self._layout.bodies.items()
        }

    @property
    def blanks(self) -> dict[str, Gear]:
        """Gears with blanks of their own by their names as products."""
        return {name: gear for part in self.parts.values() for name, gear in part.blanks.items()}

    def solid(self) -> AssembledProduct:
        """Return all exact solids in their places: see `train_product`."""
        return train_product(self.plan)

    def scene(self, carrier_angle: float = 0.0, central_turn: float = 0.0) -> list[ScenePart]:
        """Return all bodies in their places, what is alike with the same facets;
        turned as by `PlanetaryTrain.pose` (degrees).
        """
        return list(self._scene(self.plan.turned(carrier_angle, central_turn)))

    def other_scene(self) -> list[ScenePart]:
        """Return the scene moved apart, or in mesh where the scene is apart already."""
        return list(self._scene(self._plan(exploded=not self.options.exploded)))

    def turning(self) -> Turning | None:
        """Turning of the train; None unless the options ask for it."""
        return turning_of(self.plan.layout, self.speeds) if self.options.turning else None

    def write_dxf(self, path: Path) -> None:
        """All sections in mesh: see `write_train_dxf`."""
        write_train_dxf(self._layout, path, circles=self.options.circles)

    def _scene(self, plan: TrainPlan) -> Iterator[ScenePart]:
        for standing in plan.layout.standing:
            product = self.parts[standing.body.key]
            yield ScenePart(
                name=standing.name,
                facets=product.facets,
                colour=product.colour,
                rotation=standing.rotation,
                offset=standing.offset,
                product=product.name,
                axle=standing.axle,
            )
        if plan.carrier is not None and self.carrier is not None:
            axle, offset = plan.layout.carrier, (0.0, 0.0, plan.carrier.plates[0][0])
            (part,) = self.carrier.scene()
            rotation = plan.layout.pose.carrier_angle
            yield replace(part, name=axle.name, rotation=rotation, offset=offset, product=part.name, axle=axle)

    @cached_property
    def carrier(self) -> CarrierProduct | None:
        """The carrier by itself, if one is made."""
        if not self.options.carrier or self.plan.carrier is None:
            return None
        lowest = self.plan.carrier.plates[0][0]
        return CarrierProduct(self.plan.carrier.lifted(-lowest), f"{self.name} {self.train.carrier.name}", self.options)
