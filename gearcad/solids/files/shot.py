"""Shot: a product before the camera, still or in a loop that closes, and its picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, Notice, Role
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.bore_teeth import bore_teeth, with_round_bore
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.train_data import shafts_of
from gearcad.solids.files.cutaway import Camera, Cutaway, CutPlanes, SceneView, ViewDirection, close_up, framed, points_of
from gearcad.solids.files.gear_train_products import GearTrainProduct
from gearcad.solids.files.products import GearProduct, PairProduct, RackPairProduct, RackProduct
from gearcad.solids.files.scenes import ScenePart
from gearcad.solids.files.shaft_products import ShaftProduct
from gearcad.solids.files.studio import Animation, Pixels, studio, write_animation, write_png
from gearcad.solids.files.train_products import TrainProduct, turns_of
from gearcad.solids.train_plan import Standing, TrainLayout


def looks_alike_after(gear: Gear) -> int:
    """Return the number of equal parts in a turn of the gear: its teeth, fewer with bolt holes or a splined bore, one with a
    keyway.
    """
    body, spline = gear.body, bore_teeth(gear)
    return 1 if body.keyway_width else math.gcd(gear.tooth_count, body.bolt_holes, spline.tooth_count if spline else 0)


def plain_gear(gear: Gear) -> Gear:
    """Return the gear without keyway, bolt holes and teeth in its bore."""
    gear = with_round_bore(gear)
    plain = replace(gear.body, keyway=False, keyway_width=0.0, keyway_depth=0.0)
    return replace(gear, body=replace(plain, bolt_circle=0.0, bolt_holes=0, bolt_diameter=0.0))


def plain_pair(pair: GearPair) -> GearPair:
    """Return both gears without keyways and bolt holes."""
    return replace(pair, pinion=plain_gear(pair.pinion), wheel=plain_gear(pair.wheel))


def plain_train(train: PlanetaryTrain) -> PlanetaryTrain:
    """Return all gears of a train without keyways and bolt holes."""
    return replace(
        train,
        centrals=tuple(replace(each, gear=plain_gear(each.gear)) for each in train.centrals),
        rims=tuple(replace(each, gear=plain_gear(each.gear)) for each in train.rims),
        stages=tuple(replace(each, pair=plain_pair(each.pair)) for each in train.stages),
    )


FRAMES_PER_SECOND = 25

_SMOOTH, _SHORT = 24, 96
"""Frames a tooth pitch, and up to how many frames that is: a longer loop is quicker."""

QUICK, _QUICKEST = 4.0, 2.5
"""Frames a pitch of the gear whose teeth pass fastest, and the least: with 2 nobody sees which way it turns."""

MOST_FRAMES = 480
"""Largest number of frames of a loop."""

_SWING = 2.0
"""Pitches that a rack goes either way at the most; the pinion stays on the rack."""


@dataclass(frozen=True)
class Loop:
    """A motion: the `scene` at a share of it, 0 ... 1, in so many `frames` (the last one ends where the first begins).

    `pitches` pass on the gear whose teeth pass fastest. It `closes` where all then looks as at first.
    """

    scene: Callable[[float], Sequence[ScenePart]]
    frames: int
    pitches: float
    closes: bool = True
    notices: tuple[Notice, ...] = ()

    @property
    def seconds(self) -> float:
        """Duration of the loop (s)."""
        return self.frames / FRAMES_PER_SECOND

    @property
    def turns(self) -> dict[str, float]:
        """Turns of each part over the loop, counter-clockwise positive."""
        begun, ended = self.scene(0.0), self.scene(1.0)
        return {one.name: (other.rotation - one.rotation) / 360 for one, other in zip(begun, ended, strict=True)}


def come_round(passed: Iterable[Fraction]) -> Fraction:
    """Return after how many times all that passes so much each time has passed whole numbers; at least one passes anything."""
    moving = [each for each in passed if each]
    return Fraction(math.lcm(*(each.denominator for each in moving)), math.gcd(*(each.numerator for each in moving)))


def frames_for(pitches: float) -> int | None:
    """Frames of a loop in which so many pitches pass; None where that is too long."""
    if pitches * _QUICKEST > MOST_FRAMES:
        return None
    wanted = min(_SMOOTH * pitches, max(_SHORT, min(QUICK * pitches, MOST_FRAMES)))
    return math.ceil(round(wanted, 6))  # pitches that are whole but for rounding


def gear_loop(product: GearProduct) -> Loop:
    """Return a gear about its axis: by one pitch, or as many as bring a keyway or bolt holes round."""
    gear = product.gear
    pitches = gear.tooth_count // looks_alike_after(gear)
    if (frames := frames_for(pitches)) is None:
        return simpler(gear_loop(replace(product, gear=plain_gear(gear))), [gear])
    return Loop(lambda share: product.scene(360 * share * pitches / gear.tooth_count), frames, pitches)


def pair_loop(product: PairProduct) -> Loop:
    """Return a pair by one pitch, or by as many as bring keyways and bolt holes round."""
    gears = list(product.pair.gears)
    pitches = int(come_round(Fraction(looks_alike_after(gear), gear.tooth_count) for gear in gears))
    if (frames := frames_for(pitches)) is None:
        return simpler(pair_loop(replace(product, pair=plain_pair(product.pair))), gears)
    return Loop(lambda share: product.scene(360 * share * pitches / gears[0].tooth_count), frames, pitches)


def rack_loop(product: RackPairProduct) -> Loop:
    """Return the loop of a rack, which has ends: it moves to and fro from its place, and its pinion with it."""
    rack, pinion = product.pair.rack, product.pair.pinion
    pitches = min(_SWING, max(rack.length / rack.transverse_pitch / 2 - 1, 0.5))
    turn = 360 * pitches / pinion.tooth_count
    return Loop(lambda share: product.scene(turn * math.sin(math.tau * share)), _SHORT, 4 * pitches)


def simpler(loop: Loop, gears: Iterable[Gear]) -> Loop:
    """Return a loop of gears without keyways, bolt holes and teeth in their bores, which says so."""
    splined = any(gear.body.bore_spline for gear in gears)
    left_out = "keyways, bolt holes and the teeth of splined bores" if splined else "keyways and bolt holes"
    text = f"{left_out} are left out: with them it would come round in more than {MOST_FRAMES} frames only"
    return replace(loop, notices=(Notice("features-left-out", text, where="turning"), *loop.notices))


_LARGEST = 10**6
"""Denominator of the fractions that turns, which are floats, are taken for."""

_EXACT = 1e-9
"""Relative error within which gears must return to their places, and turn by whole pitches."""

_SAME = 1e-6
"""Distance (mm), and share of a pitch, that counts as none."""


def train_loop(product: TrainProduct, *, carrier_held: bool = False) -> Loop:
    """Return a train as its speeds say, until all of it looks as at first; where that is too long, or if asked for, its carrier
    held.

    Raises ParameterError for speeds that contradict each other.
    """
    simple = plain_train(product.train)
    if simple != product.train:
        train = product.train
        gears = [each.gear for each in train.centrals] + [each.gear for each in train.rims]
        gears += [gear for stage in train.stages for gear in stage.pair.gears]
        return simpler(train_loop(replace(product, train=simple), carrier_held=carrier_held), gears)
    carrier, central = _driven(product)
    held = _closed(product, 0.0, central - carrier)
    if carrier_held and held is not None:
        return held
    if (loop := _closed(product, carrier, central)) is not None:
        return loop
    if held is not None:
        text = f"it would come round in more than {MOST_FRAMES} frames only: its carrier is held still, as if seen from there"
        return replace(held, notices=(Notice("carrier-held", text, where="turning"),))
    return _cut_short(product, carrier, central)


def _driven(product: TrainProduct) -> tuple[float, float]:
    """Return the turns of the carrier, and of the central that defines a pose beside it (see `PlanetaryTrain.pose`)."""
    train = product.train
    turns, (first, second) = turns_of(product.plan.layout, product.speeds), train.centrals
    held_first = train.fixed is not None and shafts_of(train)[train.fixed].member == first.name
    return turns[train.carrier.name], turns[first.name if held_first else second.name]


def _closed(product: TrainProduct, carrier: float, central: float) -> Loop | None:
    """Return the shortest loop with turns in this proportion; None where nothing turns, or it is too long."""
    turning = _Turning(product, carrier, central)
    rates = turning.rates
    if rates is None or not any(rates):
        return None
    once = come_round(rates)
    for times in range(1, product.train.planets + 1):
        turns = float(times * once)
        pitches = turning.pitches(turns)
        if (frames := frames_for(pitches)) is None:
            return None
        if turning.looks_alike_after(turns):
            return Loop(lambda share: turning.scene(share * turns), frames, pitches)  # noqa: B023 - returned at once
    return None


def _cut_short(product: TrainProduct, carrier: float, central: float) -> Loop:
    """Return the part of the motion that the longest loop can show; this loop does not close."""
    turning = _Turning(product, carrier, central)
    turns = MOST_FRAMES / QUICK / turning.pitches(1.0)
    text = f"it would come round in more than {MOST_FRAMES} frames only: at its end the loop jumps"
    return Loop(
        lambda share: turning.scene(share * turns),
        MOST_FRAMES,
        turning.pitches(turns),
        closes=False,
        notices=(Notice("does-not-close", text, where="turning"),),
    )


@dataclass(frozen=True, eq=False)
class _Turning:
    """A train whose carrier and told central turn in a proportion."""

    product: TrainProduct
    carrier: float
    central: float

    def scene(self, turns: float) -> list[ScenePart]:
        """Return the parts in their places after the motion has run `turns` times."""
        return self.product.scene(360 * self.carrier * turns, 360 * self.central * turns)

    def layout(self, turns: float) -> TrainLayout:
        """Return the layout, without bodies, after the motion has run `turns` times."""
        return self.product.plan.turned(360 * self.carrier * turns, 360 * self.central * turns).layout

    @cached_property
    def _both(self) -> list[tuple[Standing, float]]:
        """Standing gears of the train, each with its own turns (counter-clockwise positive) in one unit of the motion."""
        begun, turned = self.layout(0.0).standing, self.layout(1.0).standing
        return [(one, (other.rotation - one.rotation) / 360) for one, other in zip(begun, turned, strict=True)]

    @property
    def rates(self) -> list[Fraction] | None:
        """Pitches that pass each time of all with an axis at rest, and equal parts of the carrier; None where not exact."""
        passed = [self.carrier * _symmetry(self.product.train)]
        passed += [turns * each.body.gear.tooth_count for each, turns in self._both if each.axle.on is None]
        found = [Fraction(each).limit_denominator(_LARGEST) for each in passed]
        exact = all(abs(each - one) <= _EXACT * max(1.0, abs(one)) for each, one in zip(found, passed, strict=True))
        return found if exact else None

    def pitches(self, turns: float) -> float:
        """Most pitches that pass of any gear in so many times."""
        return max(abs(turns * each * standing.body.gear.tooth_count) for standing, each in self._both)

    def looks_alike_after(self, turns: float) -> bool:
        """Return whether every body then stands where one of its kind stood at first, its teeth where teeth were."""
        begun = list(self.layout(0.0).standing)
        return all(any(_alike(one, other) for one in begun) for other in self.layout(turns).standing)


def _alike(one: Standing, other: Standing) -> bool:
    if one.body.key != other.body.key or math.dist(one.offset, other.offset) > _SAME:
        return False
    passed = (other.rotation - one.rotation) / 360 * one.body.gear.tooth_count
    return abs(passed - round(passed)) < _SAME


def _symmetry(train: PlanetaryTrain) -> int:
    """Return the number of equal parts of the carrier."""
    angles = sorted(angle % 360 for angle in train.angles)
    for parts in range(train.planets, 1, -1):
        turned = sorted((angle + 360 / parts) % 360 for angle in angles)
        if all(abs((a - b + 180) % 360 - 180) < _SAME for a, b in zip(angles, turned, strict=True)):
            return parts
    return 1


Product = GearProduct | PairProduct | RackProduct | RackPairProduct | TrainProduct | GearTrainProduct | ShaftProduct

_FIXED = {
    SceneView.FRONT: ViewDirection((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    SceneView.SIDE: ViewDirection((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    SceneView.TOP: ViewDirection((0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),
    SceneView.MESH: ViewDirection((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
}
"""Third-angle views of what stands along z."""

_UP = (0.0, 0.0, 1.0)
_OF_GEAR = ViewDirection((0.45, -0.9, 0.8), _UP)
_OF_PAIR = ViewDirection((-0.3, -1.0, 0.75), _UP)
_OF_RING = ViewDirection((0.35, -0.8, 1.3), _UP)
_SETTINGS_OF_RACK = ViewDirection((0.5, 0.8, 1.1), (0.0, 1.0, 0.0))
_OF_RACK_PAIR = ViewDirection((-1.1, -0.35, 0.9), _UP)
_OF_TRAIN = ViewDirection((0.45, -0.85, 1.1), _UP)
_OF_TRAIN_APART = ViewDirection((0.55, -0.9, 0.6), _UP)
"""Direction from above the corner from which most of the teeth is seen."""

_GAP, _GAP_OF_RING = 0.3, 0.8
"""Distance between parts that were moved apart, as a share of the pinion's diameter; a ring needs more, as it is seen from high
above.
"""


def direction_of(product: Product, view: SceneView) -> ViewDirection:
    """Return the direction from which a product is seen in a view."""
    if view is not SceneView.CORNER:
        return _FIXED[view]
    if isinstance(product, TrainProduct):
        return _OF_TRAIN_APART if product.options.exploded else _OF_TRAIN
    if isinstance(product, PairProduct):
        return _OF_RING if product.pair.internal else _OF_PAIR
    if isinstance(product, GearTrainProduct):
        return _OF_PAIR
    if isinstance(product, GearProduct):
        return _OF_RING if product.gear.internal else _OF_GEAR
    if isinstance(product, ShaftProduct):
        return _OF_GEAR
    return _SETTINGS_OF_RACK if isinstance(product, RackProduct) else _OF_RACK_PAIR


def cuts_of(product: Product, parts: Sequence[ScenePart], cutaway: Cutaway) -> dict[str, CutPlanes]:
    """Return the cut of each part by name. A cutaway takes off all on the near side of the plane through the axes along x.

    A quarter takes off only the side of the part's own axis that faces the eye. A train is cut about its own axis, a rack
    across its width or in the middle of it. Shafts are not cut lengthways.
    """
    near, aside = (
        np.array([0.0, -1.0, 0.0]),
        np.array([math.copysign(1.0, direction_of(product, SceneView.CORNER).eye[0]), 0.0, 0.0]),
    )
    upper = np.array([0.0, 0.0, 1.0])
    found = {}
    for part in parts:
        if isinstance(product, PairProduct) and part.name in product.shaft_roles:
            continue
        if isinstance(product, GearTrainProduct) and part.name in product.bodies:
            continue
        point, normals = np.array(part.offset), (near, aside)
        if isinstance(product, TrainProduct):
            point = np.zeros(3)
        elif isinstance(product, RackProduct):
            point, normals = np.array([product.rack.length / 2, 0.0, product.rack.face_width / 2]), (upper, aside)
        elif isinstance(product, RackPairProduct) and part is parts[1]:
            point, normals = np.array([0.0, 0.0, part.offset[2] + product.pair.rack.face_width / 2]), (near, upper)
        found[part.name] = CutPlanes(point, normals if cutaway is Cutaway.QUARTER else normals[:1])
    return found


def apart(product: PairProduct | RackPairProduct, parts: Sequence[ScenePart]) -> tuple[float, float, float]:
    """Return the shift (x, y, z) in mm that frees the mate of a pair from the pinion: a ring down, others aside.

    A gap is left between both. Trains move themselves apart.
    """
    diameter = product.pair.pinion.tip_diameter
    own = beside_pinion(product, parts)
    pinion, mate = (points_of([part for part, here in zip(parts, own, strict=True) if here is side]) for side in (True, False))
    if isinstance(product, PairProduct) and product.pair.internal:
        return 0.0, 0.0, float(pinion[:, 2].min() - mate[:, 2].max()) - _GAP_OF_RING * diameter
    return float(pinion[:, 0].max() - mate[:, 0].min()) + _GAP * diameter, 0.0, 0.0


def beside_pinion(product: PairProduct | RackPairProduct, parts: Sequence[ScenePart]) -> list[bool]:
    """Return which parts of a scene are the pinion, which comes first, or its shaft."""
    roles = product.shaft_roles if isinstance(product, PairProduct) else {}
    return [number == 0 or roles.get(part.name) is Role.PINION for number, part in enumerate(parts)]


class Close(NamedTuple):
    """The pitch point (mm) of a mesh, and its normal module."""

    x: float
    y: float
    module: float


def close_by(product: Product) -> Close:
    """Return the pitch point of the mesh; of a train that of its first central with the first planet, or of its first mesh.

    Raises GeometryError without a mesh.
    """
    if isinstance(product, GearProduct | RackProduct | ShaftProduct):
        raise GeometryError("view", SceneView.MESH, "needs a pair or a train: one part has no mesh")
    if isinstance(product, TrainProduct):
        mesh, planet = product.train.meshes[0], product.plan.layout.planets[0][0]
        central, rim = mesh.central.gear, mesh.rim.gear
        share = central.teeth / (central.teeth + rim.teeth)  # a ring has negative teeth
        return Close(planet.axle.x * share, planet.axle.y * share, central.normal_module)
    if isinstance(product, GearTrainProduct):
        return Close(*product.plan.pitch_point, product.plan.meshes[0].pair.pinion.normal_module)
    pair = product.pair
    radius = pair.working_pitch_diameters.pinion / 2 if isinstance(pair, GearPair) else pair.pitch_radius
    return Close(radius, 0.0, pair.pinion.normal_module)


_CLOSE, _WIDE = 4.0, 1.2
"""Half the height (normal modules) that a mesh shows close by, and the least width over height at which it does."""

_OF_RACK = 1.5
"""Length of rack shown to either side of its pinion from the corner, in tip diameters."""

_LOOKED_AT = 8
"""Scenes of a loop for which the camera is set."""


@dataclass(frozen=True, kw_only=True)
class Shot:
    """A picture of a product in `size` (width, height) pixels; of one in a `loop` it moves. See `gearcad.picture`."""

    product: Product
    view: SceneView = SceneView.CORNER
    size: tuple[int, int]
    cutaway: Cutaway | None = None
    exploded: bool = False
    transparent: bool = False
    loop: Loop | None = None

    def write_png(self, path: Path) -> None:
        """Write it as it is at first."""
        with studio(self.size, transparent=self.transparent) as room:
            write_png(room.photograph(*self._set(0.0)), path)

    def write_animation(self, kind: Animation, path: Path) -> None:
        """Write all frames of its loop."""
        write_animation(self.frames(), path, kind, 1000 // FRAMES_PER_SECOND)

    def frames(self) -> Iterator[Pixels]:
        """Yield one picture after the other; what leads on to the first is the last."""
        count = self.loop.frames if self.loop else 1
        with studio(self.size, transparent=self.transparent) as room:
            for number in range(count):
                yield room.photograph(*self._set(number / count))

    def scene(self, share: float) -> list[ScenePart]:
        """Return the parts in their places at a share of the loop."""
        parts = list(self.loop.scene(share) if self.loop else self.product.scene())
        if not any(self._apart) or not isinstance(self.product, PairProduct | RackPairProduct):
            return parts
        own = beside_pinion(self.product, parts)
        return [part if here else _moved(part, self._apart) for part, here in zip(parts, own, strict=True)]

    def _set(self, share: float) -> tuple[Sequence[ScenePart], Camera, dict[str, CutPlanes]]:
        parts = self.scene(share)
        return parts, self.camera, cuts_of(self.product, parts, self.cutaway) if self.cutaway else {}

    @cached_property
    def camera(self) -> Camera:
        """Camera of the shot, the same at every share of the loop."""
        width, height = self.size
        direction = direction_of(self.product, self.view)
        points = np.concatenate([self._looked_at(number / _LOOKED_AT) for number in range(_LOOKED_AT if self.loop else 1)])
        if self.view is not SceneView.MESH:
            return framed(points, direction, width / height)
        place = close_by(self.product)
        return close_up(points, direction, (place.x, place.y), _CLOSE * place.module * max(1.0, _WIDE * height / width))

    def _looked_at(self, share: float) -> Floats:
        """Return the points (n, 3) that the picture must contain at a share of the loop."""
        parts = self.scene(share)
        cuts = cuts_of(self.product, parts, self.cutaway) if self.cutaway else {}
        found = []
        for part in parts:
            points = points_of([part])
            if part.name in cuts:
                points = points[cuts[part.name].left(points)]
            if self.view is SceneView.CORNER and isinstance(self.product, RackPairProduct):
                points = points[abs(points[:, 1]) <= _OF_RACK * self.product.pair.pinion.tip_diameter]
            found.append(points)
        return np.concatenate(found)

    @cached_property
    def _apart(self) -> tuple[float, float, float]:
        """Shift (x, y, z) in mm of parts other than the first; trains move their parts themselves."""
        if not self.exploded or not isinstance(self.product, PairProduct | RackPairProduct):
            return 0.0, 0.0, 0.0
        return apart(self.product, self.product.scene())


def loop_of(product: Product, view: SceneView) -> Loop:
    """Return the loop in which a product turns; in a close view, a train is seen from its carrier.

    Raises GeometryError for a product that does not turn.
    """
    if isinstance(product, TrainProduct):
        return train_loop(product, carrier_held=view is SceneView.MESH)
    if isinstance(product, PairProduct):
        return pair_loop(product)
    if isinstance(product, RackPairProduct):
        return rack_loop(product)
    if isinstance(product, GearProduct):
        return gear_loop(product)
    if isinstance(product, ShaftProduct):
        raise GeometryError("turning", True, "needs teeth: a round shaft looks the same as it turns")
    raise GeometryError("turning", True, "needs something that turns: a rack by itself does not")


def _moved(part: ScenePart, by: tuple[float, float, float]) -> ScenePart:
    x, y, z = part.offset
    return replace(part, offset=(x + by[0], y + by[1], z + by[2]))
