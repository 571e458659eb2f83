"""What every train must obey: counts, limits, scaling, names and order, sums of energies; and what is refused."""

import math
import pickle
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from support.trains import one_stage, random_trains, two_stages

from gearcad.core.errors import InputError
from gearcad.core.records import PerGear
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import GROUND, Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.shaft_lines import dynamic_inertia, dynamic_stiffness, element_matrices, system
from gearcad.dynamics.trains.train import Train, static_forces
from gearcad.dynamics.trains.train_modes import count_below, natural_modes

QUICK = settings(max_examples=30, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))

ELEMENTS = 1e-6
"""Relative: eight modes, the eighth of five half waves on one shaft at most, by elements of degree 24 and graded matrices."""


@QUICK
@given(train=random_trains())
def test_every_frequency_is_counted(train: Train) -> None:
    """The count of the wave equation is that of the frequencies which elements, an eigenproblem of their own, find."""
    elements = natural_modes(train, count=8)
    exact = natural_modes(replace(train, model="exact"), count=8)
    assert exact.rigid == elements.rigid == (not train.held)
    assert exact.circular == pytest.approx(elements.circular, rel=ELEMENTS)
    for place in range(exact.rigid, len(exact)):
        for modes, step in ((exact, 1e-9), (elements, 2 * ELEMENTS)):
            near = np.abs(modes.circular / modes.circular[place] - 1) < 3 * step
            if near.sum() == 1:
                assert count_below(train, modes.frequency[place] * (1 - step)) == place
                assert count_below(train, modes.frequency[place] * (1 + step)) == place + 1
    assert exact.missed == elements.missed == 0


@QUICK
@given(train=random_trains())
def test_energies_sum_up_to_one(train: Train) -> None:
    for model in ("massless", "elements", "exact"):
        modes = natural_modes(replace(train, model=model), count=6)
        kinetic = modes.kinetic_inertias.sum(axis=1) + modes.kinetic_shafts.sum(axis=1)
        potential = modes.potential_shafts.sum(axis=1) + modes.potential_meshes.sum(axis=1)
        assert kinetic == pytest.approx(np.ones(len(modes)), abs=1e-7)
        assert potential[modes.rigid :] == pytest.approx(np.ones(len(modes) - modes.rigid), abs=1e-7)
        assert not potential[: modes.rigid].any()
        names = [inertia.name for inertia in train.inertias]
        for place, shaft in enumerate(train.shafts):
            for end, along in ((shaft.start, modes.shaft_shape[:, place, 0]), (shaft.end, modes.shaft_shape[:, place, -1])):
                turns = 0 * along if end == GROUND else modes.shape[:, names.index(end)]
                assert along == pytest.approx(turns, abs=1e-6 * np.abs(modes.shape).max())


@QUICK
@given(train=random_trains())
def test_order_and_scale_do_not_matter(train: Train) -> None:
    train = replace(train, model="exact")
    before = natural_modes(train, count=5).circular
    back = replace(
        train,
        inertias=train.inertias[::-1],
        shafts=[replace(shaft, start=shaft.end, end=shaft.start) for shaft in train.shafts[::-1]],
        meshes=train.meshes[::-1],
    )
    assert natural_modes(back, count=5).circular == pytest.approx(before, rel=1e-9)
    twice = replace(
        train,
        inertias=[replace(inertia, inertia=2 * inertia.inertia) for inertia in train.inertias],
        shafts=[
            replace(shaft, torsional_stiffness=2 * shaft.torsional_stiffness)
            if shaft.torsional_stiffness
            else replace(shaft, shear_modulus=2 * shaft.shear_modulus, density=2 * shaft.density)
            for shaft in train.shafts
        ],
        meshes=[replace(mesh, stiffness=2 * mesh.stiffness) for mesh in train.meshes],
    )
    assert natural_modes(twice, count=5).circular == pytest.approx(before, rel=1e-9)


@QUICK
@given(train=random_trains())
def test_a_cut_through_a_shaft_changes_nothing(train: Train) -> None:
    """A disc of nearly no inertia, anywhere on a shaft with mass."""
    place = next((place for place, shaft in enumerate(train.shafts) if shaft.length is not None), None)
    assume(place is not None)
    shaft = train.shafts[place]
    first = replace(shaft, name="one", end="cut", length=0.3 * shaft.length)
    second = replace(shaft, name="two", start="cut", length=0.7 * shaft.length)
    cut = replace(
        train,
        model="exact",
        inertias=(*train.inertias, Inertia(name="cut", inertia=1e-15)),
        shafts=(*train.shafts[:place], first, second, *train.shafts[place + 1 :]),
    )
    whole = natural_modes(replace(train, model="exact"), count=5).circular
    assert natural_modes(cut, count=5).circular == pytest.approx(whole, rel=1e-8)


def test_a_massless_shaft_is_the_limit_of_a_light_one() -> None:
    """Frequencies fall in proportion to the density."""
    massless = natural_modes(one_stage("massless")).circular
    errors = []
    for density in (1.0, 0.1):
        train = one_stage("exact")
        light = replace(train, shafts=[replace(shaft, density=density) for shaft in train.shafts])
        errors.append(1 - natural_modes(light, count=2).circular / massless)
    assert errors[0] == pytest.approx(10 * errors[1], rel=1e-2)
    assert 0 < errors[1].min() and errors[1].max() < 1e-5


def test_more_modes_of_the_lines_come_down_to_the_elements() -> None:
    """Ritz: frequencies fall with every mode that a line keeps, and none is below that of all."""
    elements = natural_modes(one_stage("elements"), count=3).circular
    before = np.full(3, np.inf)
    for count in (2, 3, 4, 6):
        train = one_stage("modes")
        train = replace(train, shafts=[replace(shaft, modes=count) for shaft in train.shafts])
        here = natural_modes(train, count=3).circular
        assert (here <= before * (1 + 1e-12)).all() and (here >= elements * (1 - 1e-12)).all()
        before = here
    every = one_stage("modes")
    every = replace(every, shafts=[replace(shaft, modes=None) for shaft in every.shafts])
    assert natural_modes(every, count=3).circular == pytest.approx(elements, rel=1e-12)


@pytest.mark.parametrize("omega", [1e-3, 1.0, 85.0, 120.0, 3e4])
def test_elements_and_wave_equation_of_one_shaft(omega: float) -> None:
    """Condensed to its ends the element is the dynamic stiffness, and its derivative the inertia, for short waves too."""
    k, j = 1e5, 1.2e-3
    stiffness, inertia = element_matrices(k, j, 20)
    whole = stiffness - omega**2 * inertia
    inner = np.linalg.solve(whole[2:, 2:], whole[2:, :2])
    assert whole[:2, :2] - whole[:2, 2:] @ inner == pytest.approx(dynamic_stiffness(k, j, omega), rel=1e-9)
    both = np.vstack([np.eye(2), -inner])
    assert both.T @ inertia @ both == pytest.approx(dynamic_inertia(k, j, omega), rel=1e-9)


def test_damping_of_lines_and_shafts() -> None:
    """A damper that goes with the twist of a massless shaft: c = 2 zeta k / omega; in a line each shaft damps by its share."""
    inertia, k = 0.01, 4e4
    omega = math.sqrt(k / inertia)

    def line(**damping: float) -> Train:
        shaft = Shaft(name="s", start=GROUND, end="disc", torsional_stiffness=k, **damping)
        return Train(model="massless", inertias=[Inertia(name="disc", inertia=inertia)], shafts=[shaft])

    assert system(line(damping_ratio=0.03)).damping == pytest.approx([0.06 * omega], rel=1e-12)
    assert system(line(damping=0.06 * k / omega)).damping == pytest.approx([0.06 * omega], rel=1e-12)
    two = [
        Shaft(name=n, start=GROUND, end="disc", torsional_stiffness=s * k, damping_ratio=z)
        for n, s, z in (("a", 0.25, 0.08), ("b", 0.75, 0.04))
    ]
    assert system(replace(line(), shafts=two)).damping == pytest.approx([2 * 0.05 * omega], rel=1e-12)


def test_preload_presses_as_the_torques_do() -> None:
    """In the second stage of a reduction the other flanks carry."""
    train = replace(two_stages(1e7), meshes=[replace(mesh, preload=1000.0) for mesh in two_stages(1e7).meshes])
    # But for what goes through the shafts that hold the train.
    assert static_forces(train) - static_forces(two_stages(1e7)) == pytest.approx([1000, 1000], rel=1e-3)
    assert (system(two_stages(1e7)).mesh * system(two_stages(1e7)).inertias[:, [0, 2]] >= 0).all(axis=0).tolist() == [
        True,
        False,
    ]
    isolated = static_forces(replace(train, model="isolated"))
    assert isolated == pytest.approx(static_forces(two_stages(1e7)) + 1000, rel=1e-9)


def test_a_ring_turns_with_its_pinion() -> None:
    """Its torque is against the pinion's, where that of an external wheel goes with it."""
    train = _pair(mesh={"internal": True}, torques={"a": 10.0, "b": -20.0})
    assert train.speed_ratios == pytest.approx({"a": 1, "b": 0.5})
    assert _pair(torques={"a": 10.0, "b": 20.0}).speed_ratios == pytest.approx({"a": 1, "b": -0.5})
    assert static_forces(train) == pytest.approx([500.0], rel=1e-12)
    turn, twist = natural_modes(train).shape
    assert turn[1] == pytest.approx(turn[0] / 2) and twist[1] == pytest.approx(-twist[0] * 0.1 * 2)


def test_a_free_line_keeps_its_turn_beside_its_modes() -> None:
    shafts = _shaft(start="a", end="b", modes=3)
    train = _pair(model="modes", meshes=[], shafts=shafts)
    exact = natural_modes(replace(train, model="exact"), count=4)
    modes = natural_modes(train)
    assert modes.rigid == 1 and modes.circular == pytest.approx(exact.circular, rel=1e-9)


def test_limits_of_what_is_asked() -> None:
    train = one_stage("exact")
    modes = natural_modes(train, up_to=3210.0)
    assert modes.circular == pytest.approx(natural_modes(train, count=5).circular, rel=1e-12)
    assert natural_modes(train, up_to=float(modes.frequency[2])).circular == pytest.approx(modes.circular[:3], rel=1e-12)
    assert len(natural_modes(one_stage("elements"), up_to=3210.0)) == 5
    assert len(natural_modes(train, up_to=100.0)) == 0
    assert len(natural_modes(one_stage("massless"), count=50)) == 2
    assert pickle.loads(pickle.dumps(train)) == train
    document = modes.to_dict()
    assert document["frequency"] == modes.frequency.tolist() and document["meshes"] == ["mesh"]


# ---------------------------------------------------------------------- what is refused


def _pair(**changes: Any) -> Train:
    """Two gears that nothing holds."""
    mesh = {"name": "m", "pinion": "a", "wheel": "b", "base_radii": (20.0, 40.0), "stiffness": 300.0, "teeth": 20}
    train: dict[str, Any] = {"inertias": [Inertia(name="a", inertia=1e-3), Inertia(name="b", inertia=1e-2)]}
    train |= {
        "meshes": [ToothMesh(**(mesh | changes.pop("mesh", {})))],
        "shafts": [Shaft(**each) for each in changes.pop("shafts", [])],
    }
    return Train(**(train | changes))


def _shaft(**changes: Any) -> list[dict[str, Any]]:
    return [{"name": "s", "start": GROUND, "end": "a", "length": 100.0, "diameter": 20.0} | changes]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"mesh": {"stiffness": -3.0}},
            "m.stiffness = -3 N/µm: must be a number at least 1e-09 N/µm and at most 1000000000 N/µm",
        ),
        ({"mesh": {"variation": 1.0}}, "m.variation = 1: must be a number at least 0 and below 1"),
        ({"mesh": {"shape": "square"}}, "m.contact_ratio is missing: must be given for a square wave"),
        ({"mesh": {"shape": "saw"}}, "m.shape = 'saw': must be one of 'cosine', 'square'"),
        ({"mesh": {"base_radii": (20.0,)}}, "m.base_radii = (20.0,): must be two lengths in mm: of pinion and wheel"),
        (
            {"mesh": {"damping": 3.0, "damping_ratio": 0.1}},
            "m.damping_ratio = 0.1: must be left out beside damping: one follows from the other",
        ),
        ({"mesh": {"wheel": "c"}}, "m.wheel = 'c': must be one of the inertias a, b"),
        ({"mesh": {"wheel": "a"}}, "m.wheel = 'a': must differ from pinion"),
        ({"mesh": {"internal": 1}}, "m.internal = 1: must be true or false"),
        ({"shafts": _shaft(end="c")}, "s.end = 'c': must be one of the inertias a, b, or \"ground\""),
        ({"shafts": _shaft(start="a")}, "s.end = 'a': must differ from start: a shaft joins two inertias or holds one"),
        (
            {"shafts": _shaft(torsional_stiffness=0.0)},
            "s.torsional_stiffness = 0 N·m/rad: must be a number at least 1e-12 N·m/rad and at most 1e+15 N·m/rad",
        ),
        (
            {"shafts": _shaft(torsional_stiffness=1e5)},
            "s.length = 100 mm: not beside torsional_stiffness: a shaft has either a stiffness or a shape",
        ),
        ({"shafts": _shaft(diameter=None)}, "s.diameter is missing: must be given, or else torsional_stiffness"),
        ({"shafts": _shaft(inner_diameter=20.0)}, "s.inner_diameter = 20 mm: must be below diameter 20 mm"),
        ({"shafts": _shaft(modes=0)}, "s.modes = 0: must be a whole number from 1 to 40"),
        (
            {"shafts": _shaft(modes=7), "model": "modes"},
            "s.modes = 7: must be at most half the order 12 of the elements, for accurate modes",
        ),
        ({"shafts": 2 * _shaft()}, "shafts.name = 's': names must differ"),
        ({"model": "rigid"}, "model = 'rigid': must be one of 'isolated', 'massless', 'modes', 'elements', 'exact'"),
        (
            {"model": "isolated", "meshes": [], "shafts": _shaft(start="b")},
            "model = 'isolated': must be a model with shafts: this one leaves shafts out, and the train has no meshes",
        ),
        ({"meshes": []}, "inertias = 'a': has neither a shaft nor a mesh: give it one, or leave it out"),
        (
            {"meshes": [], "shafts": [*_shaft(), *_shaft(name="t", end="b")]},
            "inertias = 'b': does not hang together with the rest (a | b): join the pieces by a shaft or a mesh",
        ),
        ({"inertias": []}, "inertias = (): must hold one inertia at least"),
        ({"torques": {"c": 1.0}}, "torques = 'c': must be one of the inertias a, b"),
        ({"torques": {"a": math.nan}}, "torques.a = nan N·m: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        (
            {"torques": {"a": 10.0, "b": 10.0}},
            "torques = 5 N·m: on a, the sum of all, must be 0 on a train that no shaft holds: "
            "give b = 20 instead of 10 N·m, or hold the train",
        ),
        (
            {"torques": {"a": 10.0, "b": -20.0}},
            "torques = 20 N·m: on a, the sum of all, must be 0 on a train that no shaft holds: "
            "give b = 20 instead of -20 N·m, or hold the train",
        ),
    ],
)
def test_what_makes_no_train(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as error:
        _pair(**changes)
    assert str(error.value) == message


def test_flanks_that_nothing_presses_are_refused_before_anything_is_solved() -> None:
    train = _pair()
    idle = replace(train, torques={}, meshes=(replace(train.meshes[0], preload=0.0),))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError) as error:
            study_train(idle)
    assert "preload = 0 N: must be above 0 where no torque presses the flanks of this mesh" in str(error.value)


def test_inertias_and_loops_that_make_no_train() -> None:
    with pytest.raises(InputError) as error:
        Inertia(name="a", inertia=0.0)
    assert str(error.value) == "a.inertia = 0 kg·m²: must be a number at least 1e-21 kg·m² and at most 1e+12 kg·m²"
    with pytest.raises(InputError, match="is the name of the ground"):
        Inertia(name=GROUND, inertia=1.0)
    train = _pair()
    again = replace(train.meshes[0], name="n", base_radii=(20.0, 40.001))
    with pytest.raises(InputError) as error:
        replace(train, meshes=(*train.meshes, again))
    assert str(error.value).startswith(
        "meshes = 'b': a loop of meshes and shafts turns b at -0.5 and -0.4999875 times the speed of a"
    )
    assert natural_modes(replace(train, meshes=(*train.meshes, replace(again, base_radii=(40.0, 80.0))))).rigid == 1
    for arguments in ({"count": 0}, {"count": 2, "up_to": 5.0}, {"up_to": -1.0}, {"points": 1}):
        with pytest.raises(InputError):
            natural_modes(train, **arguments)
    with pytest.raises(InputError):
        count_below(train, 0.0)


def test_energies_where_a_shaft_weighs_next_to_nothing() -> None:
    """0.4 millionths of what it joins: modes are of mass 1 all the same."""
    train = Train(
        inertias=[Inertia(name=f"i{number}", inertia=1.0) for number in range(4)],
        shafts=[
            Shaft(name="s2", start="i0", end="i2", torsional_stiffness=100.0),
            Shaft(name="s3", start="i0", end="i3", length=100.0, diameter=15.0),
        ],
        meshes=[ToothMesh(name="m1", pinion="i0", wheel="i1", base_radii=PerGear(20.0, 101.0), stiffness=50.0, teeth=20)],
        model="elements",
    )
    modes = natural_modes(train, count=6)
    kinetic = modes.kinetic_inertias.sum(axis=1) + modes.kinetic_shafts.sum(axis=1)
    assert kinetic == pytest.approx(np.ones(6), abs=1e-9)
    exact = natural_modes(replace(train, model="exact"), count=4).frequency
    assert modes.frequency[:4] == pytest.approx(exact, rel=1e-6, abs=1e-9)
