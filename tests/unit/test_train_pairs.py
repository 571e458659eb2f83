"""Real pairs in trains: what a mesh takes from its pair, forces and flanks, and a train of one pair as the pair alone."""

import math
import tomllib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gearcad
from gearcad import BasicRack, Gear, GearPair, Load, Mounting
from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.records import Role
from gearcad.designs import PairDesign, design_from_tables
from gearcad.designs.spec_writers import pair_specs
from gearcad.dynamics import DynamicsOptions, Inertia, Shaft, ToothMesh, Train
from gearcad.dynamics.engagement import _in_range, engaged
from gearcad.dynamics.pair_result import PairStudy
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import MeshPair
from gearcad.dynamics.trains.mesh_excitation import train_excitation
from gearcad.dynamics.trains.train import EngagedMesh, static_forces
from gearcad.rating.options import RatingOptions
from gearcad.stiffness.beam import PotentialEnergy

SAME = 1e-9
"""Relative: the same equations on the same numbers, once through the statics of a train."""

RUNS = 2e-3
"""Relative: loads of runs in time whose steps do not begin at the same place of a tooth."""

MEANS = 1e-5
"""Relative: a cycle has its mean by Simpson's rule, straight lines by the trapezoidal one."""

QUICK = DynamicsOptions(stiffness="potential-energy", speeds=12, harmonics=12)
CALM = replace(QUICK, speeds=4, speed_from=5500.0, speed_to=6500.0)
"""Without a resonance to be looked for."""

J = (0.0024, 0.011)


def gears(pinion: int = 20, wheel: int = 30, module: float = 2.0, **more: Any) -> GearPair:
    shared = {"normal_module": module, "face_width": 20.0, "tooth_thinning": 0.03, **more}
    helix = shared.pop("helix_angle", 0.0)
    first = Gear(teeth=pinion, helix_angle=helix, **shared)
    if wheel < 0:
        shared["rack"] = BasicRack(addendum=0.8)
    second = Gear(teeth=wheel, helix_angle=helix if wheel < 0 else -helix, **shared)
    return GearPair(pinion=first, wheel=second, name="z")


def one(pair: GearPair | MeshPair, torque: float = 50.0, speed: float = 6000.0, **of_mesh: Any) -> Train:
    """The pair on two inertias, nothing else."""
    mesh = ToothMesh(name="m", pinion="p", wheel="w", pair=pair, **of_mesh)
    ratio = mesh.base_radii.wheel / mesh.base_radii.pinion * (-1 if mesh.internal else 1)
    return Train(
        inertias=(Inertia(name="p", inertia=J[0]), Inertia(name="w", inertia=J[1])),
        meshes=(mesh,),
        torques={"p": torque, "w": torque * ratio},
        speed=speed,
    )


def alone(pair: GearPair, options: DynamicsOptions, torque: float = 50.0, **inputs: Any) -> PairStudy:
    options = replace(options, pinion_inertia=J[0], wheel_inertia=J[1])
    found = gearcad.dynamics(pair, Load(torque=torque, speed=6000.0), dynamics=options, **inputs)
    assert isinstance(found, PairStudy)
    return found


def held_against(study: TrainStudy, other: TrainStudy) -> float:
    """The greatest relative difference of natural frequencies, of the whole chart both ways, and of the course."""
    assert np.array_equal(study.up.stable, other.up.stable) and (study.down is None) == (other.down is None)
    pairs = [(study.modes.frequency[1:], other.modes.frequency[1:]), (study.up.factors, other.up.factors)]
    pairs += [(getattr(study.course, name), getattr(other.course, name)) for name in ("kv", "force", "approach")]
    if study.down is not None and other.down is not None:
        pairs.append((study.down.factors, other.down.factors))
    return max(float(np.abs(ours - theirs).max() / np.abs(theirs).max()) for ours, theirs in pairs)


@pytest.mark.parametrize(
    ("pair", "changes", "method"),
    [
        (gears(), {}, "potential-energy"),
        (
            gears(helix_angle=18.0),
            {"tooth_errors": "on", "accuracy_grade": 5, "speeds": 4, "speed_from": 5500.0, "speed_to": 6500.0},
            "potential-energy",
        ),
        pytest.param(gears(24, -80), {}, "strain-energy", marks=pytest.mark.long),
    ],
    ids=["spur, flanks that part", "helical, errors of teeth", "a ring"],
)
def test_a_train_of_one_pair_is_the_pair_alone(pair: GearPair, changes: dict[str, Any], method: str) -> None:
    options = replace(QUICK, stiffness=method, **changes)
    train, of_pair = gearcad.dynamics(one(pair), dynamics=options), alone(pair, options)
    assert isinstance(train, TrainStudy)
    assert held_against(train, of_pair.study) < SAME
    assert train.train.meshes[0].backlash == of_pair.study.train.meshes[0].backlash > 10


def test_stiff_shafts_change_nothing() -> None:
    """Half of each inertia behind a shaft ten thousand times as stiff as the teeth."""
    whole = study_train(one(gears(), backlash=None), CALM)
    halves = [Inertia(name=name, inertia=each / 2) for name, each in zip("pwab", (*J, *J), strict=True)]
    shafts = [Shaft(name=f"{a}{b}", start=a, end=b, torsional_stiffness=1e10) for a, b in ("pa", "wb")]
    # A ratio would be that of the halves.
    mesh = ToothMesh(name="m", pinion="p", wheel="w", pair=gears(), backlash=None, damping=float(whole.system.mesh_damping[0]))
    torques = {"a": whole.train.torques["p"], "b": whole.train.torques["w"]}
    split = replace(whole.train, model="massless", inertias=halves, shafts=shafts, meshes=(mesh,), torques=torques)
    study = study_train(split, CALM)
    assert study.modes.frequency[1] == pytest.approx(whole.modes.frequency[1], rel=2e-5)
    assert study.course.kv == pytest.approx(whole.course.kv, rel=2e-5)


# ---------------------------------------------------------------------- forces and flanks


def two_stages(torque: float = 60.0, speed: float = 3000.0, **of_second: Any) -> Train:
    """Stages of 20/30 and 18/45 teeth, helical and spur."""
    first, second = gears(helix_angle=15.0), gears(18, 45, 2.5)
    names, total = ("a", "b", "c", "d"), 30 / 20 * 45 / 18
    return Train(
        model="massless",
        inertias=[Inertia(name=name, inertia=0.002 * 2**place) for place, name in enumerate(names)],
        shafts=[Shaft(name="middle", start="b", end="c", torsional_stiffness=2e4, damping_ratio=0.02)],
        meshes=[
            ToothMesh(name="first", pinion="a", wheel="b", pair=first),
            ToothMesh(name="second", pinion="c", wheel="d", pair=second, **of_second),
        ],
        torques={"a": torque, "d": -torque * total},
        speed=speed,
    )


@pytest.mark.parametrize(
    ("torque", "speed", "driver"),
    [(60, 3000, "pinion"), (-60, 3000, "wheel"), (60, -3000, "wheel"), (-60, -3000, "pinion"), (-60, 0, "pinion")],
)
def test_torques_speeds_and_flanks(torque: float, speed: float, driver: str) -> None:
    """By hand: 60 N·m on the first pinion, -60 * 30/20 on the second; the coast side where torque and turn are opposed."""
    train = engaged(two_stages(torque, speed), QUICK)
    first, second = (mesh.course for mesh in train.meshes if isinstance(mesh, EngagedMesh))
    assert (first.torque, second.torque) == pytest.approx((torque, -torque * 1.5), rel=1e-9)
    assert (first.driver, second.driver) == (Role(driver), Role(driver))
    assert (first.rounds, second.offset) == (1, 0.0)
    by_hand = PotentialEnergy(pair=gears(18, 45, 2.5))(Load(torque=-torque * 1.5))
    assert train.meshes[1].stiffness == pytest.approx(by_hand.tangent_mean, rel=1e-9)


def test_a_wheel_that_drives_meets_the_course_backwards() -> None:
    driven = train_excitation(engaged(two_stages(), QUICK)).meshes[1]
    coasting = train_excitation(engaged(two_stages(-60), QUICK)).meshes[1]
    phases = np.linspace(-3, 3, 50) + 0.011
    assert coasting.stiffness.values(-phases) == pytest.approx(driven.stiffness.values(phases), rel=1e-9)
    assert driven.error is not None and coasting.error is not None
    assert coasting.error.values(-phases) == pytest.approx(driven.error.values(phases), rel=1e-9)
    assert np.ptp(driven.stiffness.values(phases) - driven.stiffness.values(-phases)) > 0.01


def test_the_pitch_point_is_in_contact_at_phase_0() -> None:
    """Where the cycle is at roll angle 0; half a tooth of delay comes half a tooth later."""
    plain, late = (train_excitation(engaged(two_stages(phase=phase), QUICK)).meshes[1] for phase in (0.0, 0.5))
    cycle = PotentialEnergy(pair=gears(18, 45, 2.5))(Load(torque=90))
    pitch = cycle.pitch_angle
    for turn in (0.0, 0.11, 0.37):
        expected = cycle.stiffness_at(turn * pitch, tangent=True) / cycle.tangent_mean
        assert plain.stiffness.values(2 * math.pi * turn + plain.lead) == pytest.approx(float(expected), rel=MEANS)
        assert late.stiffness.values(2 * math.pi * (turn + 0.5) + late.lead) == pytest.approx(float(expected), rel=MEANS)


def test_a_train_that_is_held_finds_forces_and_stiffness_together() -> None:
    """Two shafts hold both gears: F = T_1/r_1 k/(k + k_s), with k that of the teeth under this force."""
    pair, stiffness = gears(), 4e4
    mesh = ToothMesh(name="m", pinion="p", wheel="w", pair=pair)
    shafts = [Shaft(name=name, start="ground", end=name, torsional_stiffness=stiffness) for name in "pw"]
    train = replace(one(pair), shafts=shafts, meshes=[mesh], torques={"p": 80.0}, model="massless")
    found = engaged(train, QUICK)
    (course,) = (mesh.course for mesh in found.meshes if isinstance(mesh, EngagedMesh))
    radii = [radius / 1000 for radius in mesh.base_radii]
    k = 1e6 * PotentialEnergy(pair=pair)(Load(torque=course.torque)).tangent_mean
    springs = 1 / sum(radius**2 / stiffness for radius in radii)
    force = 80.0 * radii[0] / stiffness / (1 / k + 1 / springs)
    assert course.torque == pytest.approx(force * radii[0], rel=1e-6)
    assert static_forces(found) == pytest.approx([force], rel=1e-6)
    assert course.rounds > 1
    # At rest under this force the flanks have approached by F/k.
    error = train_excitation(found).meshes[0].error
    assert error is not None and error.line is not None
    lag = error.line.height + course.cycle.force / course.cycle.tangent_stiffness
    assert course.cycle.mean_of(lag) == pytest.approx(1e6 * force / k, rel=MEANS)


def test_torques_beyond_their_range_by_rounding_are_its_ends() -> None:
    """Forces of a train are the solution of equations; a pair can be looked at under 1e-9 to 1e9 N·m."""
    mesh = one(gears()).meshes[0]
    for torque, permitted in ((50.0, 50.0), (-1e9 * (1 + 1e-12), -1e9), (1e-9 * (1 - 1e-12), 1e-9)):
        assert _in_range(mesh, torque) == permitted
    for torque in (1.001e9, -0.999e-9):
        with pytest.raises(ParameterError, match=r"torques = .* its pair can be looked at under 1e-09 to 1e\+09 N·m"):
            _in_range(mesh, torque)


def test_a_mesh_without_load_is_refused() -> None:
    idle = replace(two_stages(), torques={"a": 60.0, "b": 60.0 * 1.5})
    with pytest.raises(ParameterError, match=r"second\.pair = 'z': carries nothing at rest"):
        engaged(idle, QUICK)
    with pytest.raises(ParameterError, match=r"first\.pair = 'z': carries nothing"):
        engaged(replace(two_stages(), torques={}), QUICK)
    loaded = replace(idle, meshes=(idle.meshes[0], replace(idle.meshes[1], preload=2000.0)))
    preloaded = engaged(loaded, QUICK).meshes[1]
    assert isinstance(preloaded, EngagedMesh)
    assert abs(preloaded.course.torque) == pytest.approx(2000 * preloaded.base_radii.pinion / 1000, rel=1e-9)


# ---------------------------------------------------------------------- the mesh


def test_a_mesh_takes_what_its_pair_knows() -> None:
    pair = gears(24, -80)
    mesh = ToothMesh(name="m", pinion="p", wheel="w", pair=pair)
    assert (mesh.teeth, mesh.internal) == (24, True)
    assert mesh.base_radii == pytest.approx((24 * math.cos(math.radians(20)), 80 * math.cos(math.radians(20))))
    assert mesh.backlash == pytest.approx(60, rel=0.1)  # twice 0.03 mm of thinning
    assert math.isnan(mesh.stiffness)
    moved = replace(mesh, pair=MeshPair(pair=pair, mounting=Mounting(centre_distance_change=-0.02)))
    assert moved.backlash is not None and moved.backlash < mesh.backlash
    assert replace(mesh, phase=0.5).teeth == 24
    assert replace(mesh, backlash=None).backlash is None
    assert replace(mesh, backlash=12.0).backlash == 12.0
    assert eval(repr(replace(mesh, backlash=12.0)), {**vars(gearcad), "ToothMesh": ToothMesh, "MeshPair": MeshPair}) is not None


@pytest.mark.parametrize(
    ("name", "value"),
    [("stiffness", 500.0), ("teeth", 20), ("base_radii", (18.0, 28.0)), ("variation", 0.1), ("contact_ratio", 1.5)],
)
def test_what_a_pair_tells_is_not_given_beside_it(name: str, value: object) -> None:
    with pytest.raises(GeometryError, match=rf"m\.{name} = .*not beside pair"):
        ToothMesh(name="m", pinion="p", wheel="w", pair=gears(), **{name: value})  # type: ignore[arg-type]


def test_what_is_no_pair_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"m\.pair = 'fzg-c\.toml': must be a GearPair"):
        ToothMesh(name="m", pinion="p", wheel="w", pair="fzg-c.toml")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"m\.stiffness"):
        ToothMesh(name="m", pinion="p", wheel="w", base_radii=(1.0, 2.0), teeth=20)
    with pytest.raises(InputError, match=r"m\.base_radii.*or give pair instead"):
        ToothMesh(name="m", pinion="p", wheel="w", stiffness=1.0, teeth=20)
    with pytest.raises(InputError, match=r"half"):
        MeshPair(pair=gears(helix_angle=20.0, double_helix=gearcad.geometry.DoubleHelix(gap_width=5.0)))


def test_stiffness_before_the_load_is_asked_for_in_words() -> None:
    with pytest.raises(ParameterError, match=r"m\.stiffness.*is not known before the load of its pair"):
        static_forces(one(gears()))


# ---------------------------------------------------------------------- options


def test_damping_and_grades() -> None:
    """A mesh's own damping wins over that of the options; the grade of the options over that of the pair's rating."""
    quick = replace(QUICK, damping_ratio=0.03)
    pair = MeshPair(pair=gears(), rating=RatingOptions(accuracy_grade=8))
    ratios = [
        engaged(one(pair, **more), quick).meshes[0].damping_ratio for more in ({}, {"damping_ratio": 0.1}, {"damping": 5.0})
    ]
    assert ratios == [0.03, 0.1, None]
    own, given = (engaged(one(pair), replace(quick, accuracy_grade=grade)) for grade in (None, 4))
    errors = [train_excitation(train, grade=6, seed=3).meshes[0].error for train in (own, given)]
    assert errors[0] is not None and errors[1] is not None
    assert np.abs(errors[0].coefficients[1:]).max() > 3 * np.abs(errors[1].coefficients[1:]).max() > 0


def test_the_load_of_a_pair_is_not_that_of_the_train() -> None:
    pair = MeshPair(pair=gears(), load=Load(torque=40.0, speed=3000.0, application_factor=1.25))
    study = study_train(one(pair, backlash=None), CALM)
    (text, factor) = (notice.text for notice in study.notices if notice.where == "m" and "own load" in notice.text)
    assert text == "the train gives its pinion 50 N·m at 6000 rpm, not 40 N·m at 3000 rpm of the pair's own load"
    assert factor.startswith("the application factor 1.25")
    same = MeshPair(pair=gears(), load=Load(torque=-50.0, speed=6000.0))
    assert not any("own load" in each.text for each in study_train(one(same, backlash=None), CALM).notices)


def test_a_design_in_python() -> None:
    """`gearcad.dynamics` of a train of pairs, by the method of its options."""
    found = gearcad.dynamics(one(gears(), backlash=None), dynamics=replace(CALM, stiffness="weber-banaschek"))
    assert isinstance(found, TrainStudy)
    assert {mesh.course.cycle.method for mesh in found.train.meshes if isinstance(mesh, EngagedMesh)} == {"weber-banaschek"}


def test_names_of_specs_do_not_clash() -> None:
    """Letters of file names may be large or small, and mesh names anything; the specs are those of the pairs."""
    first, second = two_stages().meshes
    named = [replace(mesh, name=name, backlash=None) for mesh, name in ((first, "A/b"), (second, "a:B"))]
    texts = pair_specs(study_train(replace(two_stages(), meshes=named), CALM))
    assert list(texts) == ["A-b.toml", "a-B-2.toml"]
    design = design_from_tables(tomllib.loads(texts["a-B-2.toml"]), where=str, default_name="x")
    assert isinstance(design, PairDesign)
    assert replace(design.pair, name="z") == gears(18, 45, 2.5)
    assert design.load == Load(torque=-90.0, speed=-2000.0)


def by_itself(pair: GearPair, torque: float, speed: float, **more: Any) -> PairStudy:
    """The pair alone, below its resonance; a wheel of 20 teeth has the inertia of a pinion of 20."""
    inertias = {20: J[0], 30: J[1], 24: 0.004}
    own = {f"{role.value}_inertia": inertias[gear.teeth] for role, gear in pair.gears.items()}
    last = 2000.0 * 20 / pair.pinion.teeth
    options = replace(QUICK, speeds=6, speed_from=0.8 * last, speed_to=last, **own, **more)
    found = gearcad.dynamics(pair, Load(torque=torque, speed=speed), dynamics=options)
    assert isinstance(found, PairStudy)
    return found


def relieved(first: int, second: int, shift: float) -> GearPair:
    """Gears of which the smaller one has a profile shift, wherever it stands in the pair."""
    shared: dict[str, Any] = {"normal_module": 2.0, "face_width": 20.0, "tooth_thinning": 0.03}
    small = min(first, second)
    gear = [Gear(teeth=teeth, profile_shift=shift * (teeth == small), **shared) for teeth in (first, second)]
    return GearPair(pinion=gear[0], wheel=gear[1], name="z")


@pytest.mark.parametrize("premature", ["off", pytest.param("on", marks=pytest.mark.long)])
def test_a_wheel_that_drives_is_the_pinion_of_the_pair_the_other_way_round(premature: str) -> None:
    """K_v over tooth frequencies, and loads and approaches at one speed; the pinion driving gives other ones."""
    more = {"premature_engagement": premature}
    driven = by_itself(relieved(20, 30, 0.4), -50.0, 6000.0, **more)
    turned = by_itself(relieved(30, 20, 0.4), 75.0, 4000.0, **more)
    driving = by_itself(relieved(20, 30, 0.4), 50.0, 6000.0, **more)
    assert [study.driver for study in (driven, turned, driving)] == [Role.WHEEL, Role.PINION, Role.PINION]
    np.testing.assert_allclose(driven.study.up.frequencies, turned.study.up.frequencies, rtol=SAME)
    np.testing.assert_allclose(driven.study.up.factors, turned.study.up.factors, rtol=1e-6)
    np.testing.assert_allclose(driven.study.course.line, turned.study.course.line, rtol=1e-5, atol=1e-6)
    if premature == "on":
        assert driven.study.errors is not None and turned.study.errors is not None
        assert driving.study.errors is not None
        np.testing.assert_allclose(driven.study.errors.nominal, turned.study.errors.nominal, rtol=RUNS)
        assert np.abs(driving.study.errors.nominal / driven.study.errors.nominal - 1).max() > 10 * RUNS
    off = np.abs(driven.study.course.line[1:9] - driving.study.course.line[1:9]) / driving.study.course.line[1:9]
    assert off.max() > 500 * 1e-5


def test_a_pair_of_equal_gears_does_not_tell_which_of_them_drives() -> None:
    """Whatever the signs of torque and speed; the wheel drives where they differ, which is told."""
    studies = [by_itself(gears(24, 24), torque, speed) for torque, speed in ((50.0, 6e3), (-50.0, -6e3), (-50.0, 6e3))]
    assert ["wheel-drives" in {notice.code for notice in study.notices} for study in studies] == [False, False, True]
    for study in studies[1:]:
        np.testing.assert_allclose(study.study.up.factors, studies[0].study.up.factors, rtol=1e-7)
        np.testing.assert_allclose(study.study.course.line, studies[0].study.course.line, rtol=1e-6, atol=1e-7)


def test_a_wheel_that_drives_does_so_in_a_train_of_the_pair_as_alone() -> None:
    pair = relieved(20, 30, 0.4)
    alone, train = by_itself(pair, -50.0, 6000.0), one(pair, torque=-50.0)
    together = study_train(train, alone.study.options)
    assert together.pairs["m"].course.driver is Role.WHEEL
    np.testing.assert_allclose(together.up.factors, alone.study.up.factors, rtol=1e-7)
