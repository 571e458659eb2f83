"""Trains with bodies, and how far their solids are from each other in mesh: distances between faces by the CAD kernel."""

import math
from dataclasses import replace

import cadquery
from OCP.BRepExtrema import BRepExtrema_DistShapeShape

from gearcad import Body, Gear, GearPair
from gearcad.planetary import Central, PairStage, PlanetaryTrain, Rim, SetMesh
from gearcad.solids.exact.solid import gear_solid
from gearcad.solids.train_plan import Standing, TrainLayout

_WIDTH, _THINNING = 10.0, 0.04


def _gear(teeth: int, module: float = 2.0, shift: float = 0.0, helix: float = 0.0, width: float = _WIDTH) -> Gear:
    """A gear with a body: a bore, or a rim outside. Tips of rings are drawn in: they stay off the fillets of planets."""
    shared = {"teeth": teeth, "normal_module": module, "profile_shift": shift, "helix_angle": helix, "face_width": width}
    gear = Gear(**shared, tooth_thinning=_THINNING, tip_alteration=-0.3 if teeth < 0 else 0.0)
    root = abs(gear.root_diameter)
    return replace(gear, body=Body(rim_diameter=round(root + 6 * module)) if gear.internal else Body(bore=round(0.45 * root)))


def _train(
    gears: tuple[tuple[Gear, Gear], ...], planets: int, clocking: float = 0.0, distance: float | None = None, **given: object
) -> PlanetaryTrain:
    """Centrals each with its rim, the rim of the second 1 mm above the first where it is another."""
    (a, rim_a), (b, rim_b) = gears
    rims = [Rim(name="rim_a", gear=rim_a)]
    if rim_b is not rim_a:
        rims.append(Rim(name="rim_b", gear=rim_b, clocking=clocking, axial_position=rim_a.face_width + 3.0))
    if distance is None:
        distance = abs(GearPair(pinion=rim_a, wheel=a).centre_distance)
    centrals = Central(name="a", gear=a, meshes="rim_a"), Central(name="b", gear=b, meshes=rims[-1].name)
    defaults = {"fixed": "b", "input": "a", "output": "carrier", "centre_distance": distance, "name": "train"}
    return PlanetaryTrain(planets=planets, centrals=centrals, rims=tuple(rims), **{**defaults, **given})


def simple_set(sun: int, planet: int, ring: int, planets: int, helix: float = 0.0, **given: object) -> PlanetaryTrain:
    """Type A."""
    rim = _gear(planet, helix=helix)
    return _train(((_gear(sun, helix=-helix, width=12.0), rim), (_gear(ring, helix=helix, width=8.0), rim)), planets, **given)


def stepped_set(
    a: int, rim_a: int, rim_b: int, b: int, planets: int, helix: float = 0.0, clocking: float = 0.0
) -> PlanetaryTrain:
    """Types B, C and D of module 2, whose rims are of opposite hands where they are helical."""
    signs = [1 if teeth < 0 else -1 for teeth in (a, b)]
    first = _gear(a, helix=signs[0] * helix, width=12.0), _gear(rim_a, helix=helix)
    second = _gear(b, helix=-signs[1] * helix, width=8.0), _gear(rim_b, helix=-helix)
    return _train((first, second), planets, clocking)


def alm_train() -> PlanetaryTrain:
    """The train of the Alm thesis with its pre-stage below, the profile shift of ring 5 as its 69 mm ask for."""
    first = _gear(-70, 2.8, -1.2025, width=8.0), _gear(22, 2.8, 0.5)
    second = _gear(-72, 2.6, -1.6794, width=8.0), _gear(21, 2.6, 0.5)
    pair = GearPair(pinion=_gear(18, 1.5, 0.3422, width=12.0), wheel=_gear(161, 1.5, 0.1682, width=8.0), centre_distance=135.0)
    stage = PairStage(name="pre", pair=pair, pinion="shaft", wheel="carrier", angle=25.0, axial_position=-26.0)
    given = {"fixed": "a", "input": "shaft", "output": "b", "stages": (stage,), "name": "alm"}
    return _train((first, second), 3, distance=69.0, **given)


def adjusted_train() -> PlanetaryTrain:
    """That of the thesis with four planets, which fit because each is clocked by itself."""
    train = alm_train()
    rims = (train.rims[0], replace(train.rims[1], clocking="adjusted"))
    return replace(train, planets=4, rims=rims)


def small_train() -> PlanetaryTrain:
    """Type B with few teeth, three planets and a pre-stage below."""
    pair = GearPair(pinion=_gear(15, width=12.0), wheel=_gear(23, width=8.0))
    stage = PairStage(name="pre", pair=pair, pinion="shaft", wheel="carrier", angle=25.0, axial_position=-26.0)
    return replace(stepped_set(18, 18, 15, -51, 3), name="small", stages=(stage,), input="shaft", output="a")


def sets() -> dict[str, PlanetaryTrain]:
    """Admissible sets of all types: 2 to 6 planets, spur and helical, rims clocked and in planes of their own, a pre-stage."""
    return {
        "A 3": simple_set(24, 21, -66, 3),
        "A 6": simple_set(30, 18, -66, 6),
        "A 4 helical": simple_set(24, 20, -64, 4, 15.0),
        "A 5 unequal": simple_set(30, 18, -66, 5, planet_angles="permitted"),
        "B 4": stepped_set(24, 24, 18, -66, 4),
        "B 3 helical, clocked": stepped_set(24, 24, 18, -66, 3, 15.0, 7.3),
        "C 2": stepped_set(30, 18, 22, 26, 2),
        "C 4 clocked": stepped_set(30, 18, 22, 26, 4, clocking=-3.1),
        "C 3 helical": stepped_set(30, 18, 22, 26, 3, 20.0),
        "D 3 helical": stepped_set(-70, 22, 21, -69, 3, 12.0),
        "D 3 Alm": alm_train(),
        "D 4 adjusted": adjusted_train(),
        "D 3 in phase": _train(
            ((_gear(-75, 2.7, -0.156), _gear(24, 2.7)), (_gear(-72, 2.6, -1.6794), _gear(21, 2.6, 0.5))), 3, distance=69.0
        ),
    }


class TrainSolids:
    """The solids of a train, in whatever poses they are asked for."""

    def __init__(self, train: PlanetaryTrain) -> None:
        self.train = train
        self.solids = {key: gear_solid(body.gear) for key, body in TrainLayout(train, train.pose()).bodies.items()}

    def layout(self, carrier_angle: float = 0.0) -> TrainLayout:
        """Where they stand."""
        return TrainLayout(self.train, self.train.pose(carrier_angle))

    def placed(self, standing: Standing, turned: float = 0.0) -> cadquery.Shape:
        """A body in its place, turned on by so much (degrees)."""
        place = cadquery.Location(cadquery.Vector(*standing.offset), cadquery.Vector(0, 0, 1), standing.rotation + turned)
        return self.solids[standing.body.key].moved(place)

    def pairs(self, layout: TrainLayout) -> list[tuple[SetMesh, Standing, Standing]]:
        """Each mesh: the central, and the rim of each planet."""
        return [
            (mesh, central, next(each for each in planet if each.body.key == mesh.rim.name))
            for mesh, central in zip(self.train.meshes, layout.centrals, strict=True)
            for planet in layout.planets
        ]

    def distance(self, mesh: SetMesh, central: Standing, rim: Standing, turned: float = 0.0) -> float:
        """Least distance (mm) of a rim from a central turned on by so much (degrees), near where they mesh; 0 in each other."""
        angle = math.atan2(rim.axle.y, rim.axle.x)
        radius = abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2
        near = radius * math.cos(angle), radius * math.sin(angle), 6 * mesh.rim.gear.normal_module
        return distance_of(faces_near(self.placed(central, turned), *near), faces_near(self.placed(rim), *near))

    def stage_distance(self, layout: TrainLayout) -> list[float]:
        """Of the gears of each stage."""
        found = []
        for pinion, wheel in zip(*2 * [iter(layout.stages)], strict=True):
            x, y = (getattr(wheel.axle, name) - getattr(pinion.axle, name) for name in ("x", "y"))
            share = pinion.body.gear.reference_diameter / 2 / math.hypot(x, y)
            near = pinion.axle.x + share * x, pinion.axle.y + share * y, 6 * pinion.body.gear.normal_module
            found.append(distance_of(faces_near(self.placed(pinion), *near), faces_near(self.placed(wheel), *near)))
        return found


def faces_near(shape: cadquery.Shape, x: float, y: float, radius: float) -> cadquery.Compound:
    """The faces of teeth that come nearer than a radius to an upright axis."""
    found = []
    for face in shape.Faces():
        box = face.BoundingBox()
        across, along = min(max(x, box.xmin), box.xmax), min(max(y, box.ymin), box.ymax)
        if face.geomType() != "PLANE" and math.hypot(across - x, along - y) < radius:
            found.append(face)
    return cadquery.Compound.makeCompound(found)


def distance_of(one: cadquery.Shape, other: cadquery.Shape) -> float:
    measured = BRepExtrema_DistShapeShape(one.wrapped, other.wrapped)
    assert measured.IsDone()
    return float(measured.Value())
