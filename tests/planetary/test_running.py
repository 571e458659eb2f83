"""Running trains against the dense matrix at single instants; torques by the member on which they act."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.commands import run
from support.dense_trains import dense_sharing
from support.planetary_trains import Square, Trapezoid, alm_train, simple_set

from gearcad import Material, read
from gearcad.core.errors import GeometryError, ParameterError, SpecError
from gearcad.core.runtime import templates
from gearcad.designs import PlanetaryDesign
from gearcad.designs.table import open_table
from gearcad.dynamics.planetary.planetary_excitation import train_stiffness
from gearcad.dynamics.planetary.planetary_statics import torsional_stiffness, twist_of
from gearcad.dynamics.planetary.quasi_static_run import CycleCourse, run_train
from gearcad.load import Load
from gearcad.planetary import Carrier, PlanetaryTrain, TrainLoad
from gearcad.planetary.poses import drive_of, mesh_phases
from gearcad.planetary.power import lossless_flow, mesh_loads, power_flow
from gearcad.planetary.tooth_numbers import SearchTask
from gearcad.sizing.planetary_sets import SetSizeTask, size_sets
from gearcad.solids.train_plan import TrainLayout, carrier_plan
from gearcad.stiffness.methods import METHODS

DENSE = 1e-5
"""Of the mean share: what open meshes of the one matrix still carry."""

COURSES = {"ring_4-rim_3": Trapezoid(212.2, 354.2, 0.72), "ring_5-rim_3p": Trapezoid(208.2, 356.9, 0.62)}
STAGE = Trapezoid(121.1, 214.7, 0.57)


def floating(train: PlanetaryTrain, *names: str, **carrier: Any) -> PlanetaryTrain:
    centrals = tuple(replace(each, support_stiffness=0.0 if each.name in names else None) for each in train.centrals)
    support = 0.0 if "carrier" in names else carrier.pop("support_stiffness", None)
    return replace(train, centrals=centrals, carrier=Carrier(support_stiffness=support, **carrier))


@pytest.mark.parametrize("speed", [955.0, -955.0])
@pytest.mark.parametrize("torque", [1600.0, 40.0])
def test_every_instant_is_that_of_the_dense_matrix(speed: float, torque: float) -> None:
    """With errors, run-out of a ring and the force of the stage, which the carrier sees turn back; at little load parted."""
    train = floating(alm_train(), support_stiffness=80.0, pin_stiffness=300.0, pin_errors=(9.0, -4.0, 2.0))
    fourth, fifth = train.centrals
    train = replace(train, centrals=(fourth, replace(fifth, run_out=15.0, support_stiffness=60.0)))
    load, courses = TrainLoad(torque=torque, speed=speed), {**COURSES, "pre_stage": STAGE}
    found = run_train(train, load, courses)
    phases, flow = mesh_phases(train, drive_of(train, load)), power_flow(train, load)
    speeds = flow.speeds.members
    assert found.turning == ("forces of stages", "run-out of ring_5")
    assert abs(found.carrier_angle[-1]) >= 360 - 1e-9
    for place in (0, 777, len(found.rolled) // 2, len(found.rolled) - 40):
        rolled = found.rolled[place]
        carrier = 360 * rolled / 70 * np.sign(speeds["carrier"])  # against ring 4, which stands
        ring = carrier * (speeds["ring_5"] / speeds["carrier"] - 1)
        stiffness: dict[str, Any] = {
            "ring_4-rim_3": COURSES["ring_4-rim_3"].stiffness_at(rolled + np.array(phases["ring_4-rim_3"].ahead)),
            "ring_5-rim_3p": COURSES["ring_5-rim_3p"].stiffness_at(rolled * 21 / 22 + np.array(phases["ring_5-rim_3p"].ahead)),
            "pre_stage": STAGE.stiffness_at(rolled * 161 / 70),
        }
        forces, twist = dense_sharing(train, load, stiffness, carrier_angle=carrier, run_out_angles={"ring_5": ring})
        assert found.shares[:, place] == pytest.approx(forces[1] / forces[1].mean(), abs=DENSE)
        assert found.twist[place] == pytest.approx(twist, rel=1e-4)
        assert found.carrier_angle[place] == pytest.approx(carrier)
    assert (found.shares == 0).any() is np.bool_(torque < 1000)


def test_where_three_planets_float_no_mesh_shows_in_their_shares() -> None:
    train = floating(alm_train(), "carrier")
    courses = {**COURSES, "pre_stage": STAGE}
    found = run_train(train, TrainLoad(torque=1600.0, speed=955.0), courses)
    assert found.mesh_share_ripple < 1e-9
    held = run_train(floating(alm_train()), TrainLoad(torque=1600.0, speed=955.0), courses)
    assert held.mesh_share_ripple > 0.2 and np.ptp(held.slow_shares) < 1e-9


def test_the_ripple_of_jumps_is_seen_in_full() -> None:
    """Planets in phase, all alike: theta = N sum F²/k/T, whose jumps are seen from both sides with few steps, too."""
    train, load = simple_set(), TrainLoad(torque=900.0, speed=100.0)
    courses = {"sun-planet": Square(200.0, 300.0, 0.37), "ring-planet": Square(250.0, 280.0, 0.51)}
    force = power_flow(train, load).set_torques["sun"] / 3 / (train.meshes[0].central_base_radius / 1e3)
    lead = mesh_phases(train, drive_of(train, load))
    places = np.linspace(0, 1, 20001)
    work = sum(3 * force**2 / courses[name].stiffness_at(places + lead[name].ahead[0]) for name in courses)
    found = run_train(train, load, courses, steps=4)
    assert found.twist_ripple == pytest.approx(np.ptp(twist_of(work, 900.0)), rel=1e-9)
    assert found.rolled[-1] == 1 and found.ripple.period == 1


@pytest.mark.parametrize(("sun", "planet", "kept"), [(24, 21, 1), (25, 20, 3)])
def test_planets_out_of_phase_leave_every_third_harmonic(sun: int, planet: int, kept: int) -> None:
    """Harmonic m is seen by the torque where m z is a multiple of N; the others cancel."""
    train = floating(simple_set(sun, planet), "sun")
    courses = {"sun-planet": Trapezoid(200.0, 300.0, 0.6, 0.1), "ring-planet": Trapezoid(250.0, 330.0, 0.7, 0.1)}
    amplitude = run_train(train, TrainLoad(torque=900.0, speed=100.0), courses, steps=300).ripple.amplitude["sun-planet"]
    seen = amplitude > 1e-3 * amplitude.max()
    assert seen[:3].tolist() == [order % kept == 0 for order in (1, 2, 3)]


def test_ripple_converges_with_steps() -> None:
    train, load = floating(alm_train()), TrainLoad(torque=1600.0, speed=955.0)
    courses = {**COURSES, "pre_stage": STAGE}
    coarse, usual, fine = (run_train(train, load, courses, steps=steps) for steps in (16, 32, 128))
    for name in ("mesh_ripple", "mesh_share_ripple", "mesh_load_factor"):
        assert getattr(usual, name) == pytest.approx(getattr(fine, name), rel=2e-3)
        assert getattr(coarse, name) == pytest.approx(getattr(fine, name), rel=1e-2)
    assert usual.ripple.period == 22 and usual.ripple.speed == pytest.approx(0.873, rel=2e-3)


def test_the_mean_twist_is_that_of_the_torsional_stiffness() -> None:
    """Forces that balance decides alone: the mean compliance makes the mean twist."""
    train = floating(alm_train(stages=()), "carrier", pin_stiffness=400.0)
    load = TrainLoad(torque=1600.0, speed=955.0)
    mean = {
        name: 1 / np.mean(1 / each.stiffness_at(np.linspace(0, 1, 100000, endpoint=False))) for name, each in COURSES.items()
    }
    found = run_train(train, load, COURSES, steps=400)
    assert found.rolled[-1] == 22
    twist = np.trapezoid(found.twist, found.rolled) / found.rolled[-1]
    assert twist == pytest.approx(torsional_stiffness(train, load, mean).twist, rel=1e-6)
    assert found.to_dict()["mean_twist"] == pytest.approx(twist)


def test_courses_of_real_meshes_run() -> None:
    """Cycles of meshes, with their jumps; the document and the arrays are plain."""
    train, load = floating(alm_train(), pin_stiffness=400.0), TrainLoad(torque=1600.0, speed=955.0)
    meshes = train_stiffness(train, mesh_loads(train, power_flow(train, load)), positions=12)
    found = run_train(train, load, meshes)
    assert 1.0 < found.mesh_load_factor < 1.3
    assert found.rigid == ("pre_stage",) and "taken for rigid" in found.warnings[-1]
    assert found.time is not None and found.time[-1] == pytest.approx(60 / (955 * 18 / 161))
    document = found.to_dict()
    assert document["mesh_ripple_arcsec"] == pytest.approx(document["mesh_ripple_urad"] * 0.2062648, rel=1e-6)
    assert {len(each.T) for each in found.arrays().values()} == {len(found.rolled)}
    assert found.warnings[0].startswith("running: run over 70 base pitches of ring_4-rim_3, in which the carrier turns 360 deg")


def test_a_reversed_cycle_is_seen_backwards() -> None:
    cycle = METHODS["strain-energy"](pair=simple_set().meshes[0].pair, positions=12)(Load(torque=50.0))
    ahead = np.random.default_rng(0).uniform(0, 3, 50)
    forward, back = CycleCourse(cycle=cycle), CycleCourse(cycle=cycle, reverse=True)
    assert forward.stiffness_at(ahead) == pytest.approx(cycle.stiffness_at(cycle.pitch_angle * ahead))
    assert back.stiffness_at(-ahead) == pytest.approx(forward.stiffness_at(ahead), rel=1e-9)
    assert len(forward.jumps) and np.sort(np.mod(-back.jumps, 1)) == pytest.approx(np.sort(forward.jumps), abs=1e-12)
    beside = forward.jumps[:, None] + [-1e-9, 1e-9]
    assert (np.abs(np.diff(forward.stiffness_at(beside), axis=1)) > 1).all()


def test_limits() -> None:
    train, courses = simple_set(), {"sun-planet": Square(200.0, 300.0, 0.4), "ring-planet": Square(250.0, 280.0, 0.5)}
    rest = run_train(train, TrainLoad(torque=900.0), courses)
    assert rest.time is None and rest.rate == 0 and rest.ripple.speed is not None
    back = run_train(train, TrainLoad(torque=-900.0, speed=-50.0), courses)
    assert back.twist_ripple == pytest.approx(rest.twist_ripple, rel=0.5)
    one = run_train(simple_set(planets=1), TrainLoad(torque=900.0), courses)
    assert one.shares == pytest.approx(1)
    differential = simple_set(fixed=None)
    with pytest.raises(ParameterError, match="the set turns as one"):
        run_train(differential, TrainLoad(torque=900.0, speed=10.0), courses, given_speeds={"ring": 10.0})
    with pytest.raises(ParameterError, match="steps"):
        run_train(train, TrainLoad(torque=900.0), courses, steps=1)
    star = simple_set(input="sun", output="ring", fixed="carrier")
    assert run_train(star, TrainLoad(torque=900.0, speed=100.0), courses).rolled[-1] == 1


EXACT = 1e-12
"""Relative: torques that follow from each other by a balance of a few terms."""

STARTERS = ("planetary-24-21-66", "planetary-alm", "planetary-differential")


def design_of(name: str) -> PlanetaryDesign:
    """The design of a starter."""
    found = read(templates() / f"{name}.toml")
    assert isinstance(found, PlanetaryDesign) and found.load is not None
    return found


@pytest.mark.parametrize("name", STARTERS)
@pytest.mark.parametrize("torque", [80.0, -80.0])
@pytest.mark.parametrize("speed", [1500.0, -1500.0, 0.0])
@pytest.mark.parametrize("efficiency", [1.0, 0.995])
def test_either_torque_gives_the_same_flow(name: str, torque: float, speed: float, efficiency: float) -> None:
    """What a torque on the output asks of the input, given there, gives the same torques on all members."""
    design = design_of(name)
    train, speeds = design.train, dict(design.speeds)
    if speed <= 0:
        speeds = {member: math.copysign(given, speed) for member, given in speeds.items()}
    by_output = TrainLoad(output_torque=torque, speed=speed, mesh_efficiency=efficiency)
    flow = power_flow(train, by_output, speeds)
    own = flow.torques[train.input] * math.copysign(1.0, speed)
    by_input = replace(by_output, output_torque=None, input_torque=own)
    assert math.copysign(1.0, own) == math.copysign(1.0, torque)  # both are positive where power goes from input to output
    other = power_flow(train, by_input, speeds)
    for found in ("torques", "set_torques", "powers", "losses"):
        assert getattr(other, found) == pytest.approx(getattr(flow, found), rel=EXACT, abs=EXACT)
    assert drive_of(train, by_input) == drive_of(train, by_output)
    plain = [lossless_flow(train, load, speeds).set_torques for load in (by_input, by_output)]
    assert plain[0] == pytest.approx(plain[1], rel=EXACT)


def test_the_old_name_means_the_output_and_is_told() -> None:
    train = design_of(STARTERS[0]).train
    old, new = TrainLoad(torque=80.0, speed=100.0), TrainLoad(output_torque=80.0, speed=100.0)
    assert power_flow(train, old).torques == power_flow(train, new).torques
    assert [each.code for each in old.notices] == ["old-name"]
    assert "write output_torque instead" in str(next(old.notices))
    assert list(new.notices) == []
    assert replace(old, speed=50.0).given_torque == replace(new, speed=50.0).given_torque == 80.0
    assert old.times(2.0).given_torque == 160.0


@pytest.mark.parametrize("given", [{}, {"torque": 1.0, "output_torque": 1.0}, {"input_torque": 1.0, "output_torque": 1.0}])
@pytest.mark.parametrize("made", ["load", "task"])
def test_one_torque_is_given(given: dict[str, float], made: str) -> None:
    sets = SearchTask(ratio=4.0, module=1.0)
    with pytest.raises(ParameterError, match="torque"):
        if made == "load":
            TrainLoad(**given)
        else:
            SetSizeTask(sets=sets, speed=100.0, material=Material(name="Eh MQ"), **given)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("speed = 1.0", "load.output_torque is missing: must be given, in N·m on the output, or input_torque, on the input"),
        ("torque = 1.0\ninput_torque = 2.0", "load.torque = 1 N·m: must be left out beside input_torque"),
    ],
)
def test_specs_say_which_torque(tmp_path: Path, lines: str, said: str) -> None:
    text = (templates() / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    path = tmp_path / "it.toml"
    path.write_text(text[: text.index("[load]")] + f"[load]\n{lines}\n", encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        read(path)
    assert said in str(caught.value)


def test_commands_tell_the_old_name(tmp_path: Path) -> None:
    path = tmp_path / "it.toml"
    text = (templates() / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    for key, told in (("output_torque", False), ("torque", True)):
        path.write_text(text.replace("output_torque = ", f"{key} = "), encoding="utf-8")
        shown = run("data", str(path))
        assert ("torque is the old name of output_torque" in shown.output) is told
    designs = [row.design() for row in open_table(templates() / "planetary-sets.csv").rows()]
    assert all(isinstance(each, PlanetaryDesign) and each.load and each.load.output_torque for each in designs)


def test_the_torque_of_a_pair_is_the_pinions() -> None:
    """No key of trains is one of pairs."""
    reducer = (templates() / "reducer-21-43.toml").read_text(encoding="utf-8")
    assert "\ntorque = " in reducer and "input_torque" not in reducer


def size(**torque: float) -> Any:
    """The lightest set of a small search."""
    sets = SearchTask(ratio=4.0, module=1.0, planets=(3, 3), teeth=(18, 22), ring_teeth=(54, 66), tolerance=0.5)
    task = SetSizeTask(
        sets=sets, speed=1000.0, material=Material(name="Eh MQ"), considered=4, modules=(1.0, 2.0, 3.0), **torque
    )
    return size_sets(task, 1)


def test_sets_are_sized_for_either_torque() -> None:
    by_input, by_output, old = size(input_torque=50.0), size(output_torque=200.0), size(torque=50.0)
    masses = [each.found[0].mass for each in (by_input, by_output, old)]
    assert masses[0] == masses[2]
    ratio = by_input.found[0].train.ratio
    assert masses[1] == pytest.approx(masses[0], rel=1e-3 if ratio == pytest.approx(4.0, rel=EXACT) else 0.02)
    assert by_output.task.torque_words == "200 N·m on the output"
    assert [len(each.task.notices) for each in (by_input, by_output, old)] == [0, 0, 1]
    assert (by_output.to_dict()["torque"], by_output.to_dict()["torque_of"]) == (200.0, "output")


def carrier_of(train: PlanetaryTrain, diameter: float | None) -> float:
    """The diameter of the pins of the carrier that is made."""
    own = replace(train, carrier=replace(train.carrier, pin_diameter=diameter))
    return carrier_plan(TrainLayout(own, own.pose())).diameter


def test_pins_have_the_diameter_that_is_given() -> None:
    train = design_of(STARTERS[0]).train
    bore = train.rims[0].gear.body.bore
    assert carrier_of(train, None) == bore
    assert carrier_of(train, 0.6 * bore) == 0.6 * bore
    with pytest.raises(GeometryError, match=f"carrier.pin_diameter = .* must be at most {bore:g} mm, the bore of the planets"):
        carrier_of(train, 1.01 * bore)
