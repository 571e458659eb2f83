"""What the response of a planetary train says of itself: what it leaves out, what lasts, and that `at` is as its charts."""

from dataclasses import replace

import numpy as np
import pytest
from support.planetary_trains import MASSES, TRAINS, on_springs
from support.specs import TEMPLATES
from support.transient import integrate

import gearcad
from gearcad.cli.planetary import _frequency_lines
from gearcad.dynamics.options import DynamicsOptions, OperatingRange, RangeSource
from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planar_model import train_masses
from gearcad.dynamics.planetary.planetary_excitation import PlanetMeshStiffness, train_stiffness
from gearcad.dynamics.planetary.planetary_response import PlanetaryResponse, errors_left_out, planetary_response
from gearcad.dynamics.planetary.planetary_study import study_planetary
from gearcad.geometry import Gear
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim, TrainLoad
from gearcad.planetary.power import mesh_loads, power_flow
from gearcad.report.planetary import sections_of_vibration

LOAD = TrainLoad(torque=300.0, speed=1500.0)
BARE = DynamicsOptions(stiffness="weber-banaschek", speed_to=600.0)
"""A method that knows no rings: the rest of a study is soon there."""


def _gear(teeth: int, shift: float, **keys: float) -> Gear:
    return Gear(teeth=teeth, normal_module=2.0, profile_shift=shift, face_width=20.0, tooth_thinning=0.04, **keys)


def _train(teeth: tuple[int, int, int], shifts: tuple[float, float, float], planets: int) -> PlanetaryTrain:
    """With all members on springs: light and fast enough for parametric resonances within its chart."""
    sun, ring = _gear(teeth[0], shifts[0]), _gear(teeth[2], shifts[2], tip_alteration=-0.1)
    return PlanetaryTrain(
        planets=planets,
        centrals=(
            Central(name="a", gear=sun, meshes="p", support_stiffness=100.0, mass=0.5, inertia=2e-4),
            Central(name="b", gear=ring, meshes="p", support_stiffness=300.0, mass=2.0, inertia=1e-2),
        ),
        rims=(Rim(name="p", gear=_gear(teeth[1], shifts[1])),),
        carrier=Carrier(
            name="c",
            pin_stiffness=300.0,
            support_stiffness=400.0,
            mass=3.0,
            inertia=5e-3,
            planet_mass=0.25,
            planet_inertia=7e-5,
        ),
        fixed="b",
        input="a",
        output="c",
    )


def _stiffness(train: PlanetaryTrain) -> dict[str, PlanetMeshStiffness]:
    return train_stiffness(train, mesh_loads(train, power_flow(train, LOAD)), method="strain-energy", positions=24)


def _respond(train: PlanetaryTrain, speeds: int, start: float, end: float) -> PlanetaryResponse:
    options = DynamicsOptions(speeds=speeds, speed_from=start, speed_to=end)
    return planetary_response(train, LOAD, _stiffness(train), train_masses(train), options)


UNREPEATED = 36_312.5
"""rpm at which the motion of three planets out of phase is quasi-periodic: each planet in turn has the greatest load."""


@pytest.fixture(scope="module")
def unrepeated() -> PlanetaryResponse:
    """Three planets out of phase, about that speed."""
    return _respond(_train((25, 20, -65), (0.2, 0.2, -0.6), 3), 9, 34_500.0, 37_500.0)


@pytest.fixture(scope="module")
def folded() -> PlanetaryResponse:
    """Four planets, every second of which does the same, where flanks part and loads jump."""
    return _respond(_train((22, 20, -62), (0.4, 0.3, -1.0), 4), 9, 36_500.0, 42_000.0)


@pytest.fixture(scope="module")
def steady() -> PlanetaryResponse:
    """Three planets in phase, far from any such speed."""
    return _respond(_train((24, 21, -66), (0.3, 0.2, -0.7), 3), 5, 4000.0, 6000.0)


# ---------------------------------------------------------------------- what is not computed


def test_speeds_without_loads_recommend_only_what_planetary_trains_have(monkeypatch: pytest.MonkeyPatch) -> None:
    """[dynamics.transient] and campbell are unknown keys in the spec of a planetary train."""
    monkeypatch.setattr("gearcad.dynamics.response.run_up._MOST_SECONDS", 0.0)
    found = _respond(_train((22, 20, -62), (0.4, 0.3, -1.0), 4), 5, 37_500.0, 38_500.0)
    (text,) = (each.text for each in found.notices if each.code == "no-value")
    assert text.endswith("s; more damping ([dynamics] damping_ratio) or fewer [dynamics] speeds give some")
    assert "transient" not in text and "campbell" not in text and "integrate" not in text
    assert not found.up.known.all()


# ---------------------------------------------------------------------- at one speed


def test_at_a_speed_every_planet_carries_its_own_force(steady: PlanetaryResponse) -> None:
    """Three planets taken for one: the mean force of each mesh is that at rest, its greatest that of the chart."""
    found, one = steady, steady.at(5000.0)
    assert found.alike == 3
    forces = one.spring_forces()[0]
    assert forces.mean(axis=0) == pytest.approx(found.up.static_forces, rel=1e-3)  # jumps between samples
    assert len(one.system.names[0]) == one.spring_forces().shape[-1] == 6
    (row,) = np.flatnonzero(np.isclose(found.speeds, 5000.0))
    assert forces.max(axis=0) / found.up.static_forces == pytest.approx(found.up.factors[row], rel=5e-3)
    assert one.system.stiffness * one.static.approach == pytest.approx(found.up.static_forces, rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("which", ["unrepeated", "folded"])
def test_at_a_speed_a_motion_lasts_where_the_chart_says_so(which: str, request: pytest.FixtureRequest) -> None:
    """Loads are those of the chart where its motion in time repeats."""
    found: PlanetaryResponse = request.getfixturevalue(which)
    stable = found.up.stable
    assert stable.all() == (which == "folded") and stable.any()
    rows = [*np.flatnonzero(~stable)[:3], *np.flatnonzero(stable)[::7]]
    for row in rows:
        one = found.at(float(found.speeds[row]))
        assert bool(one.stable[0]) == stable[row]
        if stable[row]:
            most = one.spring_forces()[0].max(axis=0) / found.up.static_forces
            assert most == pytest.approx(found.up.factors[row], rel=0.02)


# ---------------------------------------------------------------------- motions that do not repeat


@pytest.mark.long
def test_loads_of_a_motion_that_does_not_repeat_are_those_of_an_integration_by_events(unrepeated: PlanetaryResponse) -> None:
    """From rest by DOP853, its steps ending where flanks part; it leaves out jumps of the errors, worth 6e-4 of the load."""
    frequency = 2 * np.pi * unrepeated.tooth_frequency * UNREPEATED
    settled, last = (teeth * 2 * np.pi / frequency for teeth in (100, 150))
    motion = integrate(
        unrepeated.system,
        unrepeated.excitation,
        frequency,
        last,
        times=np.linspace(settled, last, 15_001),
        tolerance=1e-5,
    )
    true = np.abs(motion.spring_forces).max(axis=0) / unrepeated.up.static_forces
    row = int(np.abs(unrepeated.speeds - UNREPEATED).argmin())
    assert unrepeated.speeds[row] == pytest.approx(UNREPEATED, rel=1e-5)
    assert unrepeated.up.factors[row] == pytest.approx(true, rel=3e-3)


@pytest.mark.long
def test_a_motion_that_does_not_repeat_is_told(unrepeated: PlanetaryResponse) -> None:
    (notice,) = [each for each in unrepeated.notices if each.code == "unstable"]
    assert "the motion in time does not repeat" in notice.text and "a longer one can show a greater load" in notice.text
    assert not unrepeated.greatest.stable


@pytest.mark.usefixtures("no_pictures")
def test_a_greatest_factor_that_does_not_last_is_marked(steady: PlanetaryResponse) -> None:
    """In the document, on the screen and in the report."""
    row = int(steady.up.factors.max(axis=1).argmax())
    stable = np.arange(len(steady.speeds)) != row
    found = replace(steady, over=replace(steady.over, up=replace(steady.up, stable=stable)))
    assert not found.greatest.stable
    document = found.to_dict()
    assert document["greatest"]["lasts"] is False and document["stable"][row] is False
    study = replace(study_planetary(found.train), response=found)
    (line,) = [line for line in _frequency_lines(study) if line.startswith("dynamic load factor")]
    assert "of a motion that does not last: greater loads can follow" in line
    (section,) = [each for each in sections_of_vibration(study) if each.title == "Loads over speed"]
    assert "That motion does not last: greater loads can follow" in " ".join(section.words)


def test_a_greatest_factor_that_lasts_is_not_marked(steady: PlanetaryResponse) -> None:
    document = steady.to_dict()
    assert document["greatest"]["lasts"] is True and all(document["stable"])
    assert not {"unstable", "planets-differ"} & {notice.code for notice in steady.notices}


# ---------------------------------------------------------------------- where the train runs under load


def test_the_greatest_factor_in_operation_stands_first(steady: PlanetaryResponse) -> None:
    """Up to the load's speed; the whole chart where the load's speed is none of its own."""
    assert steady.at_load is None and steady.greatest_in_operation == steady.greatest
    assert steady.operating.source is RangeSource.CHART
    found = replace(steady, load=replace(LOAD, speed=5000.0), operating=OperatingRange(4000.0, 5000.0, RangeSource.SPEED))
    (row,) = np.flatnonzero(np.isclose(found.speeds, 5000.0))
    at_load, most = found.at_load, found.greatest_in_operation
    assert at_load is not None and at_load.factor == found.up.factors[row].max()
    assert most.factor == found.up.factors[: row + 1].max() and most.speed <= 5000.0 * (1 + 1e-9)
    document = found.to_dict()
    assert document["at_load"]["factor"] == at_load.factor and document["operation"]["greatest"]["factor"] == most.factor
    assert document["operation"]["last"] == 5000.0 and document["greatest"]["factor"] == found.up.factors.max()


@pytest.mark.long
def test_the_response_takes_a_stiffness_that_does_not_jump() -> None:
    """Plane strain for spur teeth: 1.23 and 1.24 in the meshes of a published train at its speed; strain energy tells 2.47."""
    study = gearcad.planetary(gearcad.read(TEMPLATES / "planetary-alm.toml"), response=True)
    assert study.response is not None and study.response.at_load is not None
    assert study.response.at_load.factor == pytest.approx(1.24, abs=0.01)
    assert {each.cycle.method for each in study.response.stiffness.values()} == {"plane-strain"}
    assert "stiffness-jumps" not in {notice.code for notice in study.response.notices}


# ---------------------------------------------------------------------- what is left out


def _with_error(train: PlanetaryTrain, kind: str, size: float) -> PlanetaryTrain:
    one = (size, *[0.0] * (train.planets - 1))
    if kind == "pin errors of carrier":
        return replace(train, carrier=replace(train.carrier, pin_errors=one))
    if kind == "tooth errors of rim1":
        return replace(train, rims=(replace(train.rims[0], tooth_errors=one),))
    if kind == "run-out of a":
        return replace(train, centrals=(replace(train.centrals[0], run_out=size), train.centrals[1]))
    return replace(train, carrier=replace(train.carrier, run_out=size))


ERRORS = ("pin errors of carrier", "tooth errors of rim1", "run-out of a", "run-out of carrier")


def test_errors_that_are_left_out_are_named() -> None:
    """With the K_gamma of their load sharing; those of 0 are none."""
    plain = on_springs(TRAINS["A helical"], support=60.0, pin=200.0)
    stiffness = _stiffness(plain)
    for kind in ERRORS:
        train = _with_error(plain, kind, 40.0)
        (notice,) = errors_left_out(train, LOAD, stiffness, None)
        sharing = share_load(train, LOAD, {name: each.mean for name, each in stiffness.items()})
        assert notice.where == "response" and sharing.mesh_load_factor > 1.01
        assert notice.text.startswith(f"errors are left out ({kind}): here every planet carries an even share")
        assert f"K_gamma at rest is {sharing.mesh_load_factor:.3g}" in notice.text
        assert ("without contact" in notice.text) == bool(sharing.unloaded)
        assert not errors_left_out(_with_error(plain, kind, 0.0), LOAD, stiffness, None)


def test_the_response_says_what_it_leaves_out_and_so_does_the_study() -> None:
    train = _with_error(on_springs(TRAINS["A helical"], support=60.0, pin=200.0), ERRORS[0], 40.0)
    options = DynamicsOptions(speeds=3, speed_from=500.0, speed_to=600.0, harmonics=2)
    found = planetary_response(train, LOAD, _stiffness(train), MASSES, options)
    (notice,) = [each for each in found.notices if each.code == "errors-left-out"]
    assert notice in replace(study_planetary(train, dynamics=BARE), response=found).notices
    assert notice.to_dict() in found.to_dict()["notices"]


def test_errors_without_a_sharing_are_named_too() -> None:
    """Without torque there is none."""
    train = _with_error(TRAINS["A helical"], ERRORS[0], 40.0)
    (notice,) = errors_left_out(train, replace(LOAD, torque=0.0), _stiffness(train), None)
    assert "load sharing at rest could not be had: " in notice.text
