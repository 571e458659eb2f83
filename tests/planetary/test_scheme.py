"""Scheme, front view, lever speeds and poses of a train: gears that mesh lie on each other and do not overlap."""

import math
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.path import Path
from support.planetary import clearance, gear, simple_train, stage_clearance, thesis_train, train_clearance
from support.planetary_trains import TRAINS
from support.ring_pairs import CHORD_ERROR

from gearcad import BasicRack, Gear, GearPair
from gearcad.geometry import DoubleHelix
from gearcad.geometry.gear import halves
from gearcad.planetary import Carrier, Central, GearPlace, PairStage, PlanetaryTrain, Rim, TrainLoad
from gearcad.planetary.power import power_flow
from gearcad.planetary.train_data import speeds
from gearcad.plots.paper import new_figure
from gearcad.plots.planetary import plot_front, plot_ladder, spread
from gearcad.plots.planetary_scheme import Plan, SchemeLine, Weight, plan_of, plot_scheme, scheme_inches
from gearcad.report.planetary_tables import speed_table

LONG = "a name that is far longer than any column of a picture has room for, and goes on and on"
"""A name of more lines than are shown."""


def _gear(teeth: int, shift: float = 0.0, **given: float) -> Gear:
    return Gear(teeth=teeth, normal_module=2, profile_shift=shift, face_width=20, **given)


def _plain(**given: object) -> PlanetaryTrain:
    return simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, **given)


def _renamed() -> PlanetaryTrain:
    names = f"{LONG} sun", "planet_with_neither_blank_nor_hyphen_anywhere", f"{LONG} $ring$"
    sun, ring = (
        Central(name=name, gear=central.gear, meshes=names[1])
        for name, central in zip(names[::2], _plain().centrals, strict=True)
    )
    carrier = Carrier(name=f"{LONG} <carrier>", support_stiffness=0.0)
    rims = (Rim(name=names[1], gear=_plain().rims[0].gear),)
    return _plain(centrals=(sun, ring), rims=rims, carrier=carrier, input=sun.name, output=carrier.name, fixed=None)


def _stages() -> PlanetaryTrain:
    """Two stages before the sun, and a pinion inside a ring behind the carrier."""
    first, second = (GearPair(pinion=_gear(z), wheel=_gear(3 * z)) for z in (18, 20))
    drum = GearPair(pinion=_gear(22), wheel=_gear(-70, tip_diameter=-137.0))
    return _plain(
        input="motor",
        output="drum",
        stages=(
            PairStage(name="second", pair=second, pinion="middle", wheel="sun"),
            PairStage(name="first", pair=first, pinion="motor", wheel="middle"),
            PairStage(name="last", pair=drum, pinion="drum", wheel="carrier"),
        ),
    )


def _roles(train: PlanetaryTrain) -> dict[str, PlanetaryTrain]:
    """The same with every member in every role."""
    names = train.members
    ways = [(a, b, c) for a in names for b in names for c in (*names, None) if len({a, b, c}) == 3]
    return {f"{a}, {b}, {c}": replace(train, input=a, output=b, fixed=c) for a, b, c in ways}


SHAPES = {
    **TRAINS,
    "thesis": thesis_train(),
    "long names": _renamed(),
    "stages": _stages(),
    "one planet": simple_train((24, 21, -66), (0.3, 0.2, -0.7), 1),
    "many small planets": simple_train((159, 21, -201), (0.0, 0.0, 0.0), 20),
    "tiny sun": simple_train((14, 100, -214), (0.3, -0.3, 0.3), 2),
    "teeth of other numbers": simple_train((24, 20, -66), (0.4, 0.6, -0.4843), 3),
}


def _teeth(plan: Plan, part: str) -> list[SchemeLine]:
    return [stroke for stroke in plan.strokes if stroke.part == part and stroke.weight is Weight.TEETH]


@pytest.mark.parametrize("name", SHAPES)
def test_gears_that_mesh_lie_on_each_other(name: str) -> None:
    train = SHAPES[name]
    plan = plan_of(train)
    for mesh in train.meshes:
        (central,) = _teeth(plan, mesh.central.name)[-1:]
        sign = 1 if mesh.external else -1  # a sun lies below its planet
        found = []
        for rim in _teeth(plan, mesh.rim.name):
            apart = sign * (rim.points[0][1] - central.points[0][1])
            beside = min(rim.points[1][0], central.points[1][0]) - max(rim.points[0][0], central.points[0][0])
            found.append(apart == pytest.approx(0.06) and beside > 0.1)
        assert found.count(True) == 1


def _touch(one: SchemeLine, other: SchemeLine) -> bool:
    """Whether a point of one lies on the other: strokes run along x or along y only."""
    for a, b in ((one, other), (other, one)):
        for x, y in a.points:
            for (x0, y0), (x1, y1) in pairwise(b.points):
                if min(x0, x1) - 1e-9 <= x <= max(x0, x1) + 1e-9 and min(y0, y1) - 1e-9 <= y <= max(y0, y1) + 1e-9:
                    return True
    return False


def _crosses(one: SchemeLine, other: SchemeLine) -> bool:
    for (x0, y0), (x1, y1) in pairwise(one.points):
        for (u0, v0), (u1, v1) in pairwise(other.points):
            for level, post in (((x0, x1, y0, y1), (u0, u1, v0, v1)), ((u0, u1, v0, v1), (x0, x1, y0, y1))):
                if level[2] == level[3] and post[0] == post[1]:
                    inside = min(level[:2]) < post[0] < max(level[:2]) and min(post[2:]) < level[2] < max(post[2:])
                    if inside:
                        return True
    return False


@pytest.mark.parametrize("train", [*TRAINS.values(), _plain(), thesis_train()], ids=[*TRAINS, "A again", "thesis"])
def test_parts_hang_together_and_cross_no_other_in_any_role(train: PlanetaryTrain) -> None:
    for words, turned in ({"": train} if train.stages else _roles(train)).items():
        plan = plan_of(turned)
        rims = {rim.name: "planets" for rim in turned.rims}
        parts: dict[str, list[SchemeLine]] = {}
        for stroke in plan.strokes:
            parts.setdefault(rims.get(stroke.part, stroke.part), []).append(stroke)
        axis = parts.pop("")
        assert len(axis) == 1
        parts["above"] = [stroke for stroke in parts["planets"] if max(y for _, y in stroke.points) > _pin(plan, turned)]
        parts["below"] = [stroke for stroke in parts.pop("planets") if stroke not in parts["above"]]
        for name, strokes in parts.items():
            joined, waiting = [strokes[0]], strokes[1:]
            while near := [each for each in waiting if any(_touch(each, other) for other in joined)]:
                joined += near
                waiting = [each for each in waiting if each not in near]
            assert not waiting, f"{name} falls apart with {words}"
        for (name, one), (other, two) in combinations(parts.items(), 2):
            crossed = [pair for pair in ((a, b) for a in one for b in two) if _crosses(*pair)]
            assert not crossed or {name, other} <= {"above", "below"}, f"{name} crosses {other} with {words}"


@pytest.mark.parametrize(("torque", "carrier"), [(-200.0, 300.0), (200.0, 300.0), (-200.0, -2000.0), (0.0, 300.0)])
def test_arrows_are_where_power_goes_in_and_out(torque: float, carrier: float) -> None:
    """Of a differential at every member that has power: one that goes in begins away from the train."""
    train = _plain(input="sun", output="ring", fixed=None)
    flow = power_flow(train, TrainLoad(torque=torque, speed=900.0), {"carrier": carrier})
    found = {arrow.part: "in" if abs(arrow.start[0]) > abs(arrow.end[0]) else "out" for arrow in plan_of(train, flow).arrows}
    powers = {name: "in" if power > 0 else "out" for name, power in flow.powers.items() if power}
    assert found == (powers or {"sun": "in", "ring": "out"})
    words = {row[0]: row[1] for row in speed_table(train, flow.speeds, flow, "rpm").rows}
    for name, way in powers.items():
        assert words[name] in (f"{way}put", f"power {way}", f"input, power {way}", f"output, power {way}")


def _pin(plan: Plan, train: PlanetaryTrain) -> float:
    return plan.strokes[[stroke.part for stroke in plan.strokes].index(train.carrier.name)].points[0][1]


@pytest.mark.parametrize("name", SHAPES)
def test_no_name_covers_another_or_leaves_the_picture(name: str) -> None:
    train = SHAPES[name]
    figure = new_figure(scheme_inches(train))
    axes = plot_scheme(train, figure.add_axes((0.0, 0.0, 1.0, 1.0)))
    figure.canvas.draw()
    boxes = {text.get_text(): text.get_window_extent() for text in axes.texts if text.get_text()}
    parts = {
        *train.members,
        *(rim.name for rim in train.rims),
        *(s for each in train.stages for s in (each.pinion, each.wheel)),
    }
    assert len(boxes) == len(parts)
    width, height = figure.canvas.get_width_height()
    for box in boxes.values():
        assert box.x0 > 0 and box.y0 > 0 and box.x1 < width and box.y1 < height
    for one, other in combinations(boxes.values(), 2):
        assert not one.overlaps(other)
    drawn = np.array([point for line in axes.lines if line.get_linewidth() > 1 for point in line.get_xydata()])
    left, right = axes.transData.transform(drawn)[:, 0].min(), axes.transData.transform(drawn)[:, 0].max()
    assert all(box.x1 < left or box.x0 > right for box in boxes.values())


def test_names_move_no_further_than_others_make_them() -> None:
    assert spread([0.0, 5.0], [1.0, 1.0], gap=0.0) == [0.0, 5.0]
    assert spread([1.0, 1.0, 1.0], [1.0, 1.0, 1.0], gap=0.0) == pytest.approx([0.0, 1.0, 2.0])
    rng = np.random.default_rng(1)
    for count in range(1, 9):
        wanted, heights = rng.uniform(0, 3, count), rng.uniform(0.2, 1, count)
        placed = np.array(spread(wanted.tolist(), heights.tolist(), gap=0.1))
        order = np.argsort(wanted)
        apart = np.diff(placed[order]) - (heights[order][1:] + heights[order][:-1]) / 2 - 0.1
        assert (apart > -1e-12).all()
        # No step that keeps the names apart makes the sum of squares less: of the least one, with convex bounds.
        least = ((placed - wanted) ** 2).sum()
        for _ in range(200):
            trial = placed[order] + rng.normal(0, 0.05, count)
            free = np.diff(trial) - (heights[order][1:] + heights[order][:-1]) / 2 - 0.1
            assert (free < 0).any() or ((trial - wanted[order]) ** 2).sum() > least - 1e-12


THINNING = 0.15
"""Of all teeth (mm): more than pictures leave out of an outline."""

TURN = 0.02
"""Radians by which a gear is turned that must then be seen to overlap: more than that backlash."""


def _thinned(train: PlanetaryTrain) -> PlanetaryTrain:
    def thin(part: Central | Rim) -> Central | Rim:
        return replace(part, gear=replace(part.gear, tooth_thinning=THINNING))

    distance = float(train.centre_distance)
    return replace(train, centrals=(*map(thin, train.centrals),), rims=(*map(thin, train.rims),), centre_distance=distance)  # type: ignore[arg-type]


def _wide(train: PlanetaryTrain) -> PlanetaryTrain:
    """Planets wider than the centrals: sections through their middles are turned by helices otherwise than at the bottoms."""
    return replace(train, rims=tuple(replace(rim, gear=replace(rim.gear, face_width=33.0)) for rim in train.rims))


SHOWN = {
    name: _thinned(train)
    for name, train in {**TRAINS, "wide planets": _wide(TRAINS["A helical"]), "thesis": thesis_train()}.items()
}


def _overlaps(axes: Axes) -> int:
    """Points of the outlines of planets that lie in suns, or beyond the teeth of rings, and of these in planets."""
    filled = [np.asarray(each.get_xy(), float)[:-1] for each in axes.patches if isinstance(each, Polygon)]
    centred = [outline for outline in filled if np.hypot(*outline.mean(axis=0)) < 1e-6]
    planets = [outline for outline in filled if np.hypot(*outline.mean(axis=0)) > 1e-6]
    found = 0
    for sun in centred:
        for planet in planets:
            found += int(Path(sun).contains_points(planet).sum() + Path(planet).contains_points(sun).sum())
    for ring in (each.get_path() for each in axes.patches if type(each).__name__ == "PathPatch"):
        opening = ring.vertices[np.flatnonzero(ring.codes == Path.MOVETO)[-1] :]
        for planet in planets:
            found += int((~Path(opening).contains_points(planet)).sum() + Path(planet).contains_points(opening).sum())
    return found


@pytest.mark.parametrize("name", SHOWN)
def test_gears_are_drawn_in_mesh(name: str) -> None:
    train = SHOWN[name]
    panels = plot_front(train, train.pose(17.0), {}).axes
    assert len(panels) == len(train.rims)
    assert [sum(text.get_text().isdigit() for text in panel.texts) for panel in panels] == [train.planets] * len(panels)
    assert [_overlaps(panel) for panel in panels] == [0] * len(panels)
    pose = train.pose(17.0)
    turned = replace(pose, rotations={name: turn + np.degrees(TURN) for name, turn in pose.rotations.items()})
    assert all(_overlaps(panel) > 0 for panel in plot_front(train, turned, {}).axes)


def test_arrows_have_the_sense_of_the_speeds() -> None:
    train = TRAINS["A"]
    (panel,) = plot_front(train, train.pose(), {"a": 5.0, "b": 0.0, "carrier": -1.0, "planet": -2.0}).axes
    found = []
    for line in panel.lines:
        x, y = np.asarray(line.get_data(), float)
        if len(x) == 25:
            middle = np.array([x.mean(), y.mean()])
            centre = next((c for c in _centres(train) if np.ptp(np.hypot(x - c[0], y - c[1])) < 1e-6), None)
            assert centre is not None, middle
            turn = np.unwrap(np.arctan2(y - centre[1], x - centre[0]))
            found.append((str(line.get_color()), float(np.sign(turn[-1] - turn[0]))))
    # One sun, three planets, the carrier; the ring stands.
    assert found == [("#0072b2", 1.0), *[("#cc79a7", -1.0)] * 3, ("#009e73", -1.0)]


def _centres(train: PlanetaryTrain) -> list[tuple[float, float]]:
    return [(0.0, 0.0), *((planet.x, planet.y) for planet in train.pose().planets)]


@pytest.mark.parametrize("name", TRAINS)
def test_speeds_lie_on_one_line(name: str) -> None:
    train = TRAINS[name]
    found = speeds(train, {train.input: 1470.0})
    axes = plot_ladder(train, found.members, found.planet, "rpm")
    points = np.array([line.get_xydata()[0] for line in axes.lines if line.get_marker() == "o"])
    assert points[:, 0].tolist() == [*(found.members[each] for each in train.members), found.planet]
    line = np.polyfit(points[:, 1], points[:, 0], 1)
    assert np.polyval(line, points[:, 1]) == pytest.approx(points[:, 0], abs=1e-9 * np.abs(points[:, 0]).max())
    texts = [text.get_text() for text in axes.texts]
    assert any("1500" not in text and "1470, input" in text for text in texts) and any("0, fixed" in text for text in texts)


POLYGONS = 8 * CHORD_ERROR
"""What chords of a ring's polygons may seem to overlap (mm, module 2), where there is no backlash."""

REFERENCE = {
    (24, 21, -66): ((0.3, 0.2, -0.7), 7.5, (351.42857142857144, 94.28571428571433, 197.14285714285722)),
    (20, 28, -76): ((0.3, 0.3, -0.9), 0.0, (353.57142857142856, 199.28571428571428, 45.00000000000006, 250.71428571428578)),
    (22, 20, -62): ((0.4, 0.3, -1.0), 0.0, (351.0, 162.0, 333.00000000000006, 144.0000000000001)),
    (21, 18, -57): ((0.3, 0.2, -0.7), 17.14285714285711, (350.0, 90.0, 190.0)),
    (25, 20, -65): ((0.2, 0.2, -0.6), 14.4, (351.0, 81.00000000000006, 171.0)),
}
"""By teeth: shifts; rotation of the sun in its pitch, and of the planets (degrees), from an own computation apart from this."""


@pytest.mark.parametrize("teeth", REFERENCE)
def test_plain_sets_stand_as_computed_elsewhere(teeth: tuple[int, int, int]) -> None:
    shifts, sun, planets = REFERENCE[teeth]
    train = simple_train(teeth, shifts, len(planets))
    pose = train.pose()
    pitch = 360 / teeth[0]
    assert (pose.rotations["sun"] - sun + pitch / 2) % pitch - pitch / 2 == pytest.approx(0, abs=1e-9)
    assert [planet.rotations["planet"] for planet in pose.planets] == pytest.approx(planets, abs=1e-9)
    assert train_clearance(train, train.pose(3.7)) > -POLYGONS


def helical(widths: tuple[float, float, float]) -> PlanetaryTrain:
    """A train with thinned teeth at 15 degrees, of three face widths."""
    thin = {"tooth_thinning": 0.03}
    sun = gear(24, 2.0, 0.3, helix_angle=15.0, face_width=widths[0], **thin)
    planet = gear(23, 2.0, 0.35, helix_angle=-15.0, face_width=widths[1], **thin)
    distance = float(GearPair(pinion=planet, wheel=sun).centre_distance)
    ring = gear(-72, 2.0, -1.1, helix_angle=-15.0, face_width=widths[2], **thin)
    return simple_train((24, 23, -72), (0.3, 0.35, -1.1), 4, gears=(sun, planet, ring), centre_distance=distance)


@pytest.mark.parametrize("widths", [(20.0, 20.0, 20.0), (25.0, 21.0, 14.0), (10.0, 33.0, 17.0)])
def test_helical_teeth_mesh_at_every_height(widths: tuple[float, float, float]) -> None:
    train = helical(widths)
    for angle in (0.0, 12.3):
        assert train_clearance(train, train.pose(angle)) > 1e-4


@pytest.mark.parametrize("clocking", [0.0, 1.7])
def test_the_thesis_train_stands_in_mesh_with_its_pre_stage(clocking: float) -> None:
    train = thesis_train()
    train = replace(train, rims=(train.rims[0], replace(train.rims[1], clocking=clocking)))
    for angle in (0.0, 5.1, -400.0):
        pose = train.pose(angle)
        assert train_clearance(train, pose) > 0.01
        assert stage_clearance(train.stages[0], pose.stages[0].gears) > 1e-3
        assert pose.rotations["ring_4"] == pytest.approx(train.pose().rotations["ring_4"], abs=1e-9)
        for planet in pose.planets:
            assert planet.rotations["rim_3p"] - planet.rotations["rim_3"] == pytest.approx(clocking, abs=1e-9)


def test_a_turn_of_the_carrier_is_geared_down() -> None:
    train = thesis_train()
    start, pose = train.pose(), train.pose(10.0)
    assert pose.rotations["ring_5"] - start.rotations["ring_5"] == pytest.approx(10 * (1 - 70 * 21 / (22 * 72)), abs=1e-9)
    pinion = pose.stages[0].gears.pinion.rotation - start.stages[0].gears.pinion.rotation
    assert pinion == pytest.approx(-10 * 161 / 18, abs=1e-9)
    assert pose.planets[1].angle - start.planets[1].angle == 10.0


def test_a_central_can_be_turned_while_the_carrier_stands() -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3)
    start, pose = train.pose(), train.pose(0.0, central_turn=4.0)
    assert pose.rotations["ring"] - start.rotations["ring"] == 4.0
    assert pose.rotations["sun"] - start.rotations["sun"] == pytest.approx(-11.0, abs=1e-9)
    assert train_clearance(train, pose) > -POLYGONS


def test_stages_stand_in_mesh_on_whatever_member_and_either_way_round() -> None:
    ring = GearPair(
        pinion=gear(20, 2.0, face_width=12.0, tooth_thinning=0.05, helix_angle=10.0),
        wheel=gear(-70, 2.0, tooth_thinning=0.05, helix_angle=10.0),
        axial_offset=1.5,
    )
    pair = GearPair(pinion=gear(17, 2.0, 0.3, tooth_thinning=0.05), wheel=gear(31, 2.0, tooth_thinning=0.05))
    stages = (
        PairStage(name="behind", pair=ring, pinion="carrier", wheel="drum", angle=40.0, axial_position=40.0),
        PairStage(name="before", pair=pair, pinion="motor", wheel="sun", angle=-100.0, axial_position=-30.0),
        PairStage(name="inner", pair=ring, pinion="lay", wheel="drum", angle=200.0, axial_position=90.0),
    )
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, stages=stages, input="motor", output="lay")
    for angle in (0.0, 33.0):
        pose = train.pose(angle)
        for stage, placed in zip(stages, pose.stages, strict=True):
            assert stage_clearance(stage, placed.gears) > 1e-3
        behind, before, inner = (placed.gears for placed in pose.stages)
        assert math.dist(behind.wheel[1:3], (0, 0)) == pytest.approx(-ring.centre_distance)
        assert math.dist(inner.pinion[1:3], behind.wheel[1:3]) == pytest.approx(-ring.centre_distance)
        assert behind.wheel.height == pytest.approx(40 + (12 - 20) / 2 + 1.5)
    assert before.wheel.rotation == pytest.approx(pose.rotations["sun"] - train.pose().rotations["sun"], abs=1e-9)


@pytest.mark.parametrize("angles", ["equal", (0.0, 85.0, 171.3, 260.0)])
def test_planets_clocked_by_themselves_stand_in_mesh_anywhere(angles: object) -> None:
    train = thesis_train()
    adjusted = (train.rims[0], replace(train.rims[1], clocking="adjusted"))
    train = replace(train, planets=4, planet_angles=angles, rims=adjusted, tip_distance=1.0)
    pose = train.pose(3.3)
    assert train_clearance(train, pose) > 0.01
    clockings = [planet.rotations["rim_3p"] - planet.rotations["rim_3"] for planet in pose.planets]
    assert clockings[0] == pytest.approx(0, abs=1e-9)
    assert max(map(abs, clockings)) <= 360 / (2 * 21 * 22) + 1e-9  # a turn by pitches of either rim leaves no more
    assert any(abs(each) > 0.01 for each in clockings)
    assert "adjusted-planets" in {notice.code for notice in train.notices}


def test_double_helical_teeth_mesh_in_both_halves() -> None:
    """The halves of each gear, each with its own hand, in the place that it has in the pose."""

    def double(teeth: int, shift: float, helix: float, width: float, gap: float) -> Gear:
        halved = DoubleHelix(gap_width=gap, offset=math.copysign(0.2, helix))
        return gear(teeth, 2.0, shift, helix_angle=helix, face_width=width, tooth_thinning=0.03, double_helix=halved)

    suns = double(30, 0.2, 25.0, 44.0, 4.0), double(31, 0.0, -25.0, 38.0, 5.0)
    planets = double(24, 0.1, -25.0, 40.0, 6.0), double(23, 0.3, 25.0, 42.0, 4.0)
    train = PlanetaryTrain(
        planets=3,
        centrals=tuple(Central(name=name, gear=sun, meshes=f"rim_{name}") for name, sun in zip("ab", suns, strict=True)),
        rims=(Rim(name="rim_a", gear=planets[0]), Rim(name="rim_b", gear=planets[1], clocking=3.0, axial_position=60.0)),
        input="a",
        output="carrier",
        fixed="b",
    )
    pose = train.pose(8.0)
    for mesh in train.meshes:
        central, rim = mesh.central, mesh.rim
        for half in (0, 1):
            lower, upper = halves(central.gear)[half], halves(rim.gear)[half]
            placed = pose.planets[1]
            places = (
                GearPlace(pose.rotations[central.name] + lower.rotation, 0.0, 0.0, pose.heights[central.name] + lower.z),
                GearPlace(placed.rotations[rim.name] + upper.rotation, placed.x, placed.y, pose.heights[rim.name] + upper.z),
            )
            bottom = max(place.height for place in places)
            for height in (bottom, bottom + 10.0):
                assert clearance(lower.gear, upper.gear, places, height) > 1e-4


@pytest.mark.parametrize(("name", "planets"), [("B", 4), ("B", 2), ("C", 3), ("C", 2), ("C", 6), ("A helical", 4), ("D", 3)])
def test_stepped_planets_are_turned_on_by_pitches_until_both_rims_fit(name: str, planets: int) -> None:
    train = replace(TRAINS[name], planets=planets)
    if any(notice.code == "fillet-interference" for notice in train.notices):
        ring = replace(train.centrals[1], gear=replace(train.centrals[1].gear, rack=BasicRack(addendum=0.8)))
        train = replace(train, centrals=(train.centrals[0], ring))
    assert train_clearance(train, train.pose(5.0)) > -2 * POLYGONS
