"""What cannot be put together is refused, with the condition, its numbers and what would do."""

import math
from dataclasses import replace

import pytest
from support.planetary import gear, simple_train, thesis_train

from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.quantities import NOT_GIVEN, is_given
from gearcad.geometry import GearPair
from gearcad.planetary import Central, PairStage, PlanetaryTrain, Rim
from gearcad.planetary.train import fitting_planets, fitting_teeth
from gearcad.planetary.train_data import SetTeeth, fit_planets


def refused(**changes: object) -> str:
    """The message with which the thesis's train is refused after changes."""
    with pytest.raises(InputError) as caught:
        thesis_train(**changes)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def as_printed() -> tuple[Central, Central]:
    """The rings of the thesis, of which x of ring 5 is printed as the sum of both."""
    ring_4, ring_5 = thesis_train().centrals
    return ring_4, replace(ring_5, gear=replace(ring_5.gear, profile_shift=-1.1794))


# ---------------------------------------------------------------------- one centre distance


@pytest.mark.parametrize("distance", [69.0, NOT_GIVEN], ids=["given", "not given"])
def test_the_stage_of_the_thesis_as_printed_is_refused_with_both_distances(distance: float) -> None:
    message = refused(centrals=as_printed(), centre_distance=distance)
    assert "69.000 mm (ring_4-rim_3) and 67.927 mm (ring_5-rim_3p)" in message
    assert "ring_5" in message
    shift = float(message.partition("ring_5.profile_shift = " if is_given(distance) else "must be ")[2].split()[0])
    ring_4, ring_5 = as_printed()
    corrected = replace(ring_5, gear=replace(ring_5.gear, profile_shift=shift))
    assert thesis_train(centrals=(ring_4, corrected), centre_distance=distance).centre_distance == pytest.approx(69.0, abs=1e-3)


def test_overlap_is_told_of_the_mesh_that_it_is_in() -> None:
    for distance, mesh in ((45.5, "sun-planet"), (46.5, "ring-planet")):
        with pytest.raises(GeometryError, match=rf"centre_distance = {distance} mm: .*; {mesh}.centre_distance = "):
            simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, centre_distance=distance)


def test_a_distance_between_those_of_both_meshes_gives_backlash() -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.8), 3, centre_distance=46.0)
    for mesh in train.meshes:
        j = abs(mesh.pair.circumferential_backlash)
        assert 0.02 < j < 0.2


def test_what_a_pair_refuses_begins_with_its_mesh() -> None:
    with pytest.raises(GeometryError, match=r"ring-planet.wheel.normal_module = 2.5 mm"):
        simple_train((24, 21, -66), (0, 0, 0), 3, gears=(gear(24, 2.0), gear(21, 2.0), gear(-66, 2.5)))


def test_rounded_shifts_are_one_distance() -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.69997), 3)
    assert train.centre_distance == pytest.approx(45.93190298194305, abs=1e-12)
    assert ("rounded-shifts", "ring-planet") in {(notice.code, notice.where) for notice in train.notices}


# ---------------------------------------------------------------------- room


def test_neighbours_keep_their_tips_apart() -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3)
    tip = train.rims[0].gear.tip_diameter
    free = 2 * train.centre_distance * math.sin(math.pi / 3) - tip
    assert train.to_dict()["free_tip_distance"] == pytest.approx(free, rel=1e-12)
    assert replace(train, tip_distance=free - 1e-6).planets == 3
    with pytest.raises(GeometryError, match=r"planets = 3: must be at most 2: .* 1 and 2 are 79.5564 mm apart"):
        replace(train, tip_distance=free + 1e-6)
    assert refused(planets=6).startswith("planets = 6: must be at most 5 (3, for teeth to fit too): ")
    message = refused(planet_angles=(0.0, 360 / 114 * 19, 180.0))
    assert "planet_angles" in message and "planets 1 and 2" in message and "rim_3 reach 70" in message


def test_both_are_told_where_neither_room_nor_teeth_let_the_planets_stand() -> None:
    with pytest.raises(GeometryError, match=r"at most 4: .* 61.2 mm; and planet 2 at 72 deg is 0.2 pitches"):
        simple_train((20, 28, -76), (0.3, 0.3, -0.9), 5)


def test_one_planet_has_no_neighbours() -> None:
    train = thesis_train(planets=1, tip_distance=1000.0)
    assert train.unbalance == 1.0 and train.to_dict()["free_tip_distance"] is None


def test_teeth_at_the_same_height_stand_clear() -> None:
    train = thesis_train()

    def at(position: float) -> PlanetaryTrain:
        return replace(train, rims=(train.rims[0], replace(train.rims[1], axial_position=position)))

    for position in (20.0, -20.0):
        assert at(position).rims[1].axial_position == position
    for position in (19.9, -19.9, 0.0):
        with pytest.raises(GeometryError, match=r"rim_3p.axial_position = .* must be at least 20 or at most -20 mm"):
            at(position)


@pytest.mark.parametrize(("width", "what"), [(26.0, "reaches"), (34.0, "ring_4 and ring_5")])
def test_wide_centrals_are_in_the_way_of_what_they_do_not_mesh_with(width: float, what: str) -> None:
    """Of the rings the wider one comes to the height of the other rim (a reach of 104 mm), or of the other ring."""
    train = thesis_train()
    ring_4, ring_5 = train.centrals
    small = replace(ring_4, gear=replace(ring_4.gear, face_width=4.0)) if what == "reaches" else ring_4
    wide = replace(ring_5, gear=replace(ring_5.gear, face_width=width))
    rims = train.rims[0], replace(train.rims[1], axial_position=22.0)
    with pytest.raises(GeometryError, match=what) as caught:
        replace(train, centrals=(small, wide), rims=rims)
    least = float(str(caught.value).partition("at least ")[2].split()[0])
    assert replace(train, centrals=(small, wide), rims=(rims[0], replace(rims[1], axial_position=least))).planets == 3


def test_two_suns_want_two_rims() -> None:
    sun, other = (gear(z, 2.0, x) for z, x in ((24, 0.2), (25, -0.3)))
    centrals = Central(name="a", gear=sun, meshes="p"), Central(name="b", gear=other, meshes="p")
    with pytest.raises(GeometryError, match="rims = 1: must be two, one above the other: a and b"):
        PlanetaryTrain(
            planets=1,
            centrals=centrals,
            rims=(Rim(name="p", gear=gear(30, 2.0, 0.8, tooth_thinning=0.5)),),
            input="a",
            output="b",
            centre_distance=55.7,
        )


@pytest.mark.parametrize("changed", [{"axial_position": 1.0}, {"clocking": 1.0}, {"clocking": "adjusted"}])
def test_the_first_rim_is_what_the_other_is_counted_from(changed: dict[str, float]) -> None:
    first, second = thesis_train().rims
    assert "must be 0" in refused(rims=(replace(first, **changed), second))


# ---------------------------------------------------------------------- teeth


def test_four_planets_of_the_thesis_are_refused_with_the_sets_that_can() -> None:
    """Off by 0.02273 of a pitch of the rim with 22 teeth, or by 1/42 of one of the other."""
    message = refused(planets=4)
    assert "planet 2 at 90 deg is 0.02381 pitches off in ring_4-rim_3, it fits at 88.42105 or 91.57895 deg" in message
    assert "360/114" in message and "planets = 3 fit" in message and "ring_5.teeth = -71" in message
    train = thesis_train()
    other = [math.degrees(angle) for angle in (0, math.pi / 2)]
    off = fit_planets(SetTeeth(-72, 21, 22, -70), [math.radians(angle) for angle in other]).misfits[1]
    assert abs(off) == pytest.approx(0.02273, abs=5e-6)
    assert fitting_planets(train) == (2,)
    for name, teeth in fitting_teeth(replace(train, planets=2)):
        changed = dict(zip(("ring_4", "rim_3", "rim_3p", "ring_5"), train.teeth, strict=True)) | {name: teeth}
        assert SetTeeth(*changed.values()).positions % 2 == 0


def test_planets_stand_where_teeth_permit() -> None:
    """The positions of 20/28/-76 for five planets, by the reference; there is no room for them in one plane."""
    teeth = SetTeeth(20, 28, 28, -76)
    assert teeth.positions == 96
    steps = [0, 19, 38, 58, 77]
    assert max(map(abs, fit_planets(teeth, [2 * math.pi * step / 96 for step in steps]).misfits)) < 1e-12
    equal = fit_planets(teeth, [2 * math.pi * number / 5 for number in range(5)]).misfits
    assert abs(equal[1]) == pytest.approx(0.2, abs=1e-12)
    assert [96 % planets == 0 for planets in (2, 3, 4, 5, 6)] == [True, True, True, False, True]


def test_given_angles_are_where_teeth_fit_or_refused() -> None:
    train = thesis_train(planets=4, planet_angles="permitted", centre_distance=69.0, tip_distance=1.0)
    step = 360 / 114
    assert train.angles == pytest.approx((0, 29 * step, 57 * step, 86 * step), abs=1e-12)
    rounded = replace(train, planet_angles=tuple(round(angle + 7.0, 3) for angle in train.angles))
    assert rounded.angles == pytest.approx([angle + 7.0 for angle in train.angles], abs=1e-9)
    assert "planet 2 at 120.002 deg" in refused(planet_angles=(0.0, 120.002, 240.0))
    message = refused(planets=4, planet_angles=(0.0, 90.0, 180.0, 270.0))
    assert "planet 2 at 90 deg" in message and message.endswith("all multiples of 360/114 deg do")


def test_unequal_planets_are_told_to_be_unbalanced() -> None:
    step = 360 / 114
    train = thesis_train(planets=4, planet_angles=(0.0, 28 * step, 57 * step, 86 * step), tip_distance=1.0)
    psi = [math.radians(angle) for angle in train.angles]
    assert train.unbalance == pytest.approx(math.hypot(sum(map(math.cos, psi)), sum(map(math.sin, psi))), abs=1e-12)
    assert "unbalanced" in {notice.code for notice in train.notices}
    assert "unbalanced" not in {notice.code for notice in thesis_train().notices}


def test_common_factors_of_teeth_are_told() -> None:
    hunting = [notice for notice in thesis_train().notices if notice.code == "no-hunting-tooth"]
    assert [notice.where for notice in hunting] == ["ring_4-rim_3", "ring_5-rim_3p"]  # 2 of 70 and 22, 3 of 72 and 21
    assert not [notice for notice in simple_train((25, 18, -61), (0.2, 0.2, -0.6), 2).notices if "hunting" in notice.code]


@pytest.mark.parametrize("angles", [(0.0, 120.0), "eqal", (0.0, 120.0, "x")])
def test_angles_are_one_a_planet(angles: object) -> None:
    with pytest.raises(ParameterError, match="planet_angles"):
        thesis_train(planet_angles=angles)


def test_errors_are_one_a_planet() -> None:
    train = thesis_train()
    with pytest.raises(ParameterError, match=r"carrier.pin_errors = .*: must be 3 values, one a planet, or none; there are 2"):
        replace(train, carrier=replace(train.carrier, pin_errors=(1.0, 2.0)))
    with pytest.raises(ParameterError, match=r"rim_3.tooth_errors = \[1.0, .*; there are 4"):
        replace(train, rims=(replace(train.rims[0], tooth_errors=(1.0,) * 4), train.rims[1]))


def test_planets_that_do_not_fit_are_named_before_the_count_of_their_errors() -> None:
    train = thesis_train()
    carrier = replace(train.carrier, pin_errors=(1.0, 2.0, 3.0))
    with pytest.raises(GeometryError, match="must let the teeth fit"):
        replace(train, carrier=carrier, planets=4)


def test_the_basic_ratio_of_one_is_refused() -> None:
    ring = Central(name="ring_5", gear=gear(-70, 2.8, -1.2025, tooth_thinning=0.03), meshes="rim_3p")
    train = thesis_train()
    rims = train.rims[0], replace(train.rims[1], gear=train.rims[0].gear)
    with pytest.raises(GeometryError, match="ratio than 1"):
        replace(train, centrals=(train.centrals[0], ring), rims=rims)


def test_stages_that_stand_in_the_way_are_told() -> None:
    def told(position: float) -> list[str]:
        train = thesis_train()
        stage = replace(train.stages[0], axial_position=position)
        return [notice.text for notice in replace(train, stages=(stage,)).notices if notice.code == "stage-in-the-way"]

    assert told(60.0) == told(50.0) == told(-20.0) == []
    assert [text.partition(":")[0] for text in told(49.0)] == [
        "its pinion stands at the height of ring_5",
        "its wheel stands at the height of rim_3p, ring_5",
    ]
    assert "rim_3, ring_4" in told(-19.0)[1]


# ---------------------------------------------------------------------- heights that are not given


def test_rims_and_stages_stand_where_nothing_is_in_their_way() -> None:
    """The ring is wider than its rim, the sun has a hub: what is left free is beyond both."""
    train = thesis_train()
    wide = replace(train.centrals[0], gear=replace(train.centrals[0].gear, face_width=30.0))
    rims = tuple(replace(rim, axial_position=NOT_GIVEN) for rim in train.rims)
    placed = replace(train, centrals=(wide, train.centrals[1]), rims=rims)
    first, second = (rim.gear.face_width for rim in rims)
    level = (first + wide.gear.face_width) / 2 + 2.8 + max(placed.centrals[1].gear.face_width - second, 0.0) / 2
    assert placed.rims[0].axial_position == 0 and placed.rims[1].axial_position == pytest.approx(level, abs=1e-12)
    moved = replace(placed, centrals=train.centrals)
    assert moved.rims[1].axial_position < level, "they are derived again"


@pytest.mark.parametrize(("end", "above"), [("output", True), ("input", False)])
def test_stages_stand_before_and_behind_the_set(end: str, above: bool) -> None:
    pair = GearPair(pinion=gear(18, 1.5, face_width=12.0), wheel=gear(90, 1.5, face_width=10.0))
    simple = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3)
    stages = (
        PairStage(name="outer", pair=pair, pinion="motor", wheel="lay"),
        PairStage(name="inner", pair=pair, pinion="lay", wheel=simple.output if above else simple.input),
    )
    roles = {"output": "motor"} if above else {"input": "motor"}
    train = replace(simple, stages=stages, **roles)
    outer, inner = (float(stage.axial_position) for stage in train.stages)
    assert (outer > inner + 10 > simple.rims[0].gear.face_width) if above else (outer + 10 < inner < -10)
    assert not [notice for notice in train.notices if notice.code == "stage-in-the-way"]
