"""Solids and masses of whole trains: parts and names after STEP, volumes, annuli in closed form."""

import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import cadquery
import numpy as np
import pytest
from support.clearance import solid_volume
from support.planetary_trains import alm_set
from support.planetary_trains import simple_set as mass_simple_set
from support.rings import RingSection
from support.train_solids import TrainSolids, sets, simple_set, small_train

from gearcad import Body, GeometryError
from gearcad.dynamics.planetary.planar_model import MemberMass, train_masses
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.planetary import Carrier, PlanetaryTrain
from gearcad.solids import train_assembly, write_step
from gearcad.solids.train_plan import Standing

TOUCH = 1e-6
"""mm: flanks are within 1 nm of exact ones, distances of the kernel within a few tenths of a micrometre."""


TRAIN = small_train()


@pytest.fixture(scope="module")
def step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("train") / "assembly.step"
    write_step(train_assembly(TRAIN, carrier=True), path, name=TRAIN.name)
    return path


@pytest.fixture(scope="module")
def again(step: Path) -> cadquery.Assembly:
    return cadquery.Assembly.importStep(str(step))


def test_all_parts_reopen_named_coloured_and_in_their_places(again: cadquery.Assembly) -> None:
    planets = ["small planet_1", "small planet_2", "small planet_3"]
    assert [child.name for child in again.children] == ["a", "b", *planets, "pre-pinion", "pre-wheel", "carrier"]
    rims = [[rim.name for rim in again.objects[name].children] for name in planets]
    assert rims == [[f"planet_{n} rim_a", f"planet_{n} rim_b"] for n in (1, 2, 3)]
    leaves = [leaf for name, leaf in again.objects.items() if not leaf.children]
    assert all(leaf.obj.isValid() for leaf in leaves)
    assert len({leaf.color.toTuple() for leaf in leaves}) == 7  # each made part has its own
    for place, planet in zip(TRAIN.pose().planets, planets, strict=True):
        assert again.objects[planet].loc.toTuple()[0] == pytest.approx((place.x, place.y, 0.0), abs=1e-9)


def test_parts_that_are_alike_are_one_product(step: Path) -> None:
    """N planets do not cost N times: seven bodies are in the file, each once, and fourteen places."""
    text = step.read_text()
    assert text.count("MANIFOLD_SOLID_BREP(") == 7
    assert text.count("=NEXT_ASSEMBLY_USAGE_OCCURRENCE(") == 14
    products = re.findall(r"=PRODUCT\('([^']*)'", text)
    made = ["a", "b", "rim_a", "rim_b", "pre-pinion", "pre-wheel", "carrier"]
    assert sorted(products) == sorted(["small", *(f"small {each}" for each in (*made, "planet_1", "planet_2", "planet_3"))])


def test_volumes_of_parts_are_the_exact_ones(again: cadquery.Assembly) -> None:
    """By quadrature of the exact outlines, without the code that makes solids."""
    gears = {central.name: central.gear for central in TRAIN.centrals}
    gears |= {f"planet_2 {rim.name}": rim.gear for rim in TRAIN.rims}
    gears["pre-wheel"] = TRAIN.stages[0].pair.wheel
    for name, gear in gears.items():
        part = again.objects[name] if name in again.objects else again.objects["small planet_2"].objects[name]
        exact = RingSection(gear).volume if gear.internal else solid_volume(gear)
        assert part.obj.Volume() == pytest.approx(exact, rel=2e-7), name


# ---------------------------------------------------------------------- nothing stands in anything


def _check(solids: TrainSolids, carrier_angle: float, *, sides: bool) -> None:
    """Every mesh is apart by half of its normal backlash; on both sides, nothing is left after half the circumferential one."""
    layout = solids.layout(carrier_angle)
    for mesh, central, rim in solids.pairs(layout):
        words = f"{mesh.name}, {rim.name} at {carrier_angle}"
        assert solids.distance(mesh, central, rim) == pytest.approx(mesh.pair.normal_backlash / 2, abs=TOUCH), words
        if sides:
            radius = abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2
            half = math.degrees(mesh.pair.circumferential_backlash / 2 / radius)
            for side in (1, -1):
                left = solids.distance(mesh, central, rim, turned=0.98 * side * half)
                assert left == pytest.approx(0.02 * mesh.pair.normal_backlash / 2, abs=TOUCH), words
                assert solids.distance(mesh, central, rim, turned=1.02 * side * half) < 1e-9, words
    for stage, distance in zip(solids.train.stages, solids.stage_distance(layout), strict=True):
        assert distance == pytest.approx(stage.pair.normal_backlash / 2, abs=TOUCH)


def test_backlash_of_solids_is_that_of_the_pairs() -> None:
    _check(TrainSolids(sets()["C 2"]), -41.3, sides=True)


@pytest.mark.long
@pytest.mark.parametrize("name", sets())
def test_solids_of_sets_of_all_types_are_apart(name: str) -> None:
    """At carrier angles over several pitches; flanks on both sides at the first."""
    solids = TrainSolids(sets()[name])
    for number, angle in enumerate((0.0, 2.9, 17.3, 111.1)):
        _check(solids, angle, sides=not number)


def _rolled(solids: TrainSolids, turn: float) -> tuple[Standing, Standing, Standing]:
    """Both centrals, and the first planet rolled on along the sun, which stands, by so much (degrees)."""
    layout, train = solids.layout(), solids.train
    mesh, planet = train.meshes[0], layout.planets[0][0]
    angle, distance = math.radians(turn), float(train.centre_distance)
    axle = replace(planet.axle, x=distance * math.cos(angle), y=distance * math.sin(angle))
    rotation = planet.rotation + turn * (1 + mesh.central.gear.teeth / mesh.rim.gear.teeth)
    return *layout.centrals, replace(planet, axle=axle, rotation=rotation)


@pytest.mark.parametrize(("turn", "fits"), [(90.0, True), (72.0, False)])
def test_a_planet_where_it_cannot_stand_is_in_the_ring(turn: float, fits: bool) -> None:
    """20/28/-76 takes planets at multiples of 360/96 degrees: four at equal angles, and not five."""
    solids = TrainSolids(simple_set(20, 28, -76, 4))
    sun, ring, planet = _rolled(solids, turn)
    at_sun, at_ring = solids.train.meshes
    assert solids.distance(at_sun, sun, planet) == pytest.approx(at_sun.pair.normal_backlash / 2, abs=TOUCH)
    assert (solids.distance(at_ring, ring, planet) > 1e-9) is fits
    if not fits:
        common = solids.placed(planet).intersect(solids.placed(ring)).Volume()
        assert common > 1.0  # mm³


def _placed(assembly: cadquery.Assembly) -> dict[str, cadquery.Shape]:
    return {name.rpartition("/")[2]: shape.moved(place) for shape, name, place, _ in assembly}


def test_a_carrier_fills_the_bores_and_is_in_nothing() -> None:
    train = simple_set(24, 21, -66, 3)
    parts = _placed(train_assembly(train, carrier=True))
    assert sorted(parts) == ["a", "b", "carrier", "planet_1", "planet_2", "planet_3"]
    for other in ("a", "b", "planet_2"):
        assert parts["carrier"].intersect(parts[other]).Volume() < 1e-9, other
    bore, place = train.rims[0].gear.body.bore, train.pose().planets[1]
    for share, inside in ((0.499, True), (0.501, False)):
        assert parts["carrier"].isInside(cadquery.Vector(place.x + share * bore, place.y, 5.0)) is inside


def _with_stage_at(height: float) -> PlanetaryTrain:
    return replace(TRAIN, stages=(replace(TRAIN.stages[0], axial_position=height),))


def test_a_carrier_leaves_out_the_plate_that_a_stage_leaves_no_room_for() -> None:
    def heights(train: PlanetaryTrain) -> tuple[float, float]:
        box = _placed(train_assembly(train, carrier=True))["carrier"].BoundingBox()
        return box.zmin, box.zmax

    bore = TRAIN.rims[1].gear.body.bore  # the smaller one: a gap of a tenth, a plate of a half
    (low, high), (low_near, high_near) = heights(TRAIN), heights(_with_stage_at(-13.5))
    assert (low, high, high_near) == pytest.approx((-1 - 0.6 * bore, 23 + 0.6 * bore, high), abs=1e-6)
    assert low_near == pytest.approx(0.0, abs=1e-6)  # the pins end with the planets


def test_an_exploded_train_has_its_members_above_each_other() -> None:
    parts = _placed(train_assembly(TRAIN, carrier=True, exploded=True))
    groups = [["pre-pinion", "pre-wheel"], ["a"], [name for name in parts if name.startswith("planet")], ["b"], ["carrier"]]
    boxes = [[parts[name].BoundingBox() for name in group] for group in groups]
    ends = [(min(box.zmin for box in group), max(box.zmax for box in group)) for group in boxes]
    assert all(above[0] - below[1] > 20 for below, above in pairwise(ends))


# ---------------------------------------------------------------------- what is refused


def _with_first_ring(body: Body) -> PlanetaryTrain:
    sun, ring = TRAIN.centrals
    return replace(TRAIN, centrals=(sun, replace(ring, gear=replace(ring.gear, body=body))))


def test_what_has_no_body_or_no_room_is_refused_in_a_line() -> None:
    rim, other = TRAIN.rims
    hub = Body(bore=10, hub_diameter=20, hub_length=5)
    close = replace(TRAIN, rims=(replace(rim, gear=replace(rim.gear, body=hub)), other))
    solid = tuple(replace(rim, gear=replace(rim.gear, body=Body())) for rim in TRAIN.rims)
    cases = {
        r"^b\.body\.rim_diameter is missing: must be given, at least": _with_first_ring(Body()),
        r"^rim_b\.axial_position = 13 mm: must be at least 15 or at most -11 mm: rim_b and rim_a stand in each other$": close,
        r"^pre\.axial_position = -5 mm: must be at least 23 or at most -12 mm: .* in each other$": _with_stage_at(-5.0),
        r"^rim_a\.body\.bore = 0 mm: must be above 0 mm: the pins of the carrier go through it$": replace(TRAIN, rims=solid),
    }
    for words, train in cases.items():
        with pytest.raises(GeometryError, match=words):
            train_assembly(train, carrier=True)


STEEL = Material().density


def annulus(gear: Gear, inner: float, outer: float) -> tuple[float, float]:
    """kg and kg·m² of a disc of the gear's width between two diameters (mm)."""
    mass = STEEL * 1e-9 * math.pi / 4 * (outer**2 - inner**2) * gear.face_width
    return mass, mass * (outer**2 + inner**2) / 8 * 1e-6


def between(gear: Gear, hole: float = 0.0) -> tuple[tuple[float, float], tuple[float, float]]:
    """Annuli that are within the gear, and around it: to its root and to its tip circle."""
    if gear.internal:
        ends = [annulus(gear, abs(d), float(gear.body.rim_diameter or 0)) for d in (gear.root_diameter, gear.tip_diameter)]
    else:
        ends = [annulus(gear, hole, d) for d in (gear.root_diameter, gear.tip_diameter)]
    return ends[0], ends[1]


def section(gear: Gear) -> tuple[float, float]:
    """kg and kg·m² by the contour of the teeth as a polygon, and the circle of the rim: area and second moment by Green."""
    points = gear.profile.contour(1e-4)
    (x, y), (u, v) = points.T, np.roll(points, -1, axis=0).T
    across = x * v - u * y
    area = abs(float(across.sum())) / 2
    moment = abs(float(across @ (x * x + x * u + u * u + y * y + y * v + v * v))) / 12
    radius = float(gear.body.rim_diameter or 0) / 2
    area, moment = abs(math.pi * radius**2 - area), abs(math.pi / 2 * radius**4 - moment)
    return STEEL * 1e-9 * gear.face_width * area, STEEL * 1e-15 * gear.face_width * moment


def test_the_alm_set_is_weighed() -> None:
    train = alm_set()
    found = train_masses(train)
    for central in train.centrals:
        own = found.members[central.name]
        (least, least_inertia), (most, most_inertia) = between(central.gear)
        assert least < own.mass < most
        assert least_inertia < own.inertia < most_inertia
        assert (own.mass, own.inertia) == pytest.approx(section(central.gear), rel=1e-5)
    rims = [rim.gear for rim in train.rims]
    together = [sum(column) for column in zip(*map(section, rims), strict=True)]
    assert (found.planet.mass, found.planet.inertia) == pytest.approx(together, rel=1e-5)
    assert found.members["carrier"] == MemberMass(mass=None, inertia=None, why=found.missing[0])
    assert found.missing == ("carrier.mass and inertia: must be given: a carrier has no solid here",)


def test_a_ring_without_a_rim_has_no_mass_and_says_why() -> None:
    ring = train_masses(mass_simple_set()).members["ring"]
    assert ring.mass is None
    assert ring.inertia is None
    assert ring.why.startswith("ring.body.rim_diameter is missing: must be given, at least 140.201 mm")


def test_what_is_given_wins() -> None:
    train = mass_simple_set(carrier=Carrier(mass=3.0, inertia=0.01, planet_mass=0.4))
    centrals = [replace(each, mass=1.0, inertia=2e-3) for each in train.centrals]
    found = train_masses(replace(train, centrals=tuple(centrals)))
    assert found.members["ring"] == found.members["sun"] == MemberMass(mass=1.0, inertia=2e-3, given=("mass", "inertia"))
    assert found.members["carrier"] == MemberMass(mass=3.0, inertia=0.01, given=("mass", "inertia"))
    assert found.planet.mass == 0.4
    assert found.planet.given == ("mass",)
    least, most = (each[1] for each in between(train.rims[0].gear))
    assert least < found.planet.inertia < most
    assert not found.missing


def test_densities_by_name() -> None:
    steel, light = (train_masses(pinned(), each) for each in (Material(), {"planet": Material(density=STEEL / 2)}))
    assert light.planet.mass == pytest.approx(steel.planet.mass / 2)
    assert light.planet.inertia == pytest.approx(steel.planet.inertia / 2)


def pinned() -> PlanetaryTrain:
    """A set of which only the planet is weighed."""
    train = mass_simple_set()
    return replace(train, centrals=tuple(replace(each, mass=1.0, inertia=1e-3) for each in train.centrals))


def test_a_bore_is_not_weighed() -> None:
    train = pinned()
    bored = replace(train.rims[0], gear=replace(train.rims[0].gear, body=Body(bore=20)))
    full, hollow = (train_masses(replace(train, rims=(rim,))).planet for rim in (train.rims[0], bored))
    mass, inertia = annulus(bored.gear, 0, 20)
    assert full.mass - hollow.mass == pytest.approx(mass, rel=1e-6)
    assert full.inertia - hollow.inertia == pytest.approx(inertia, rel=1e-6)
