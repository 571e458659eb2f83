"""Wear by Archard's law: volume as force times sliding, profiles in closed form, and convergence over steps and positions."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.commands import run
from support.specs import TEMPLATES

import gearcad
from gearcad import Material
from gearcad.check.options import CheckOptions
from gearcad.check.run import plane_model
from gearcad.check.task import CheckTask, check_task
from gearcad.check.wear import WearOptions, wear_pair
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.wear import cycle_wear, flank_grids, worn_pair
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.designs import PairDesign, read_spec

COEFFICIENT = 1e-6  # mm³/(N·m)
SMALL = 0.01  # µm: a fortieth of the deflection of the teeth, so that their sharing does not change
CONVERGED = 0.01  # of the life, where steps or positions are halved


@pytest.fixture(scope="module")
def design() -> PairDesign:
    found = read_spec(TEMPLATES / "plastic-51-52.toml")
    assert isinstance(found, PairDesign)
    return found


@pytest.fixture(scope="module")
def task(design: PairDesign) -> CheckTask:
    return task_of(design, PerGear(*design.materials))


def task_of(design: PairDesign, materials: PerGear[Material], part: float = 1.0) -> CheckTask:
    assert design.load is not None
    load = replace(design.load, torque=part * design.load.torque)
    return check_task(design.pair, materials, load, CheckOptions(convergence="off"), None, design.rating)


def test_volume_is_the_coefficient_times_force_times_sliding(design: PairDesign) -> None:
    """Of both gears, whose teeth slide over each other: each loses k W s of its own passages, to the last digits."""
    pinion, wheel = (replace(each, wear_coefficient=k) for each, k in zip(design.materials, (5e-7, COEFFICIENT), strict=True))
    result = wear_pair(task_of(design, PerGear(pinion, wheel)), WearOptions(loss=4.0, steps=2, positions=12))
    last = result.states[-1]
    assert last.volume.wheel == pytest.approx(COEFFICIENT * last.work * 51 / 52, rel=1e-6)
    assert last.volume.pinion == pytest.approx(5e-7 * last.work, rel=1e-6)
    assert max(last.depth) == pytest.approx(4.0, rel=1e-6)
    # the profile itself: depth over the arc of the involute, whose length is s ds/r_b
    for role in Role:
        grid = result.grids.pick(role)
        lengths = np.linspace(grid.first, grid.last, 40001)
        depth = grid.values(lengths) @ last.worn.pick(role)
        volume = 15 * np.trapezoid(depth * lengths / grid.base_radius, lengths)
        assert volume == pytest.approx(last.volume.pick(role), rel=1e-6)


@pytest.mark.long
def test_work_of_a_cycle_is_the_loss_by_friction_over_its_coefficient(task: CheckTask) -> None:
    """Force times sliding of all pairs is what the losses of a check have, from forces and an integral of their own."""
    rubbed = replace(task, options=replace(task.options, friction=1e-4))
    model = plane_model(task)
    cycle = PlaneCycle.run(model.rubbing(rubbed.friction), task.torque, 60)
    mean_torque = float(cycle.mean("lost_torque")[0])
    found = cycle_wear(cycle, flank_grids(model, 60)).work * model.width  # N mm, of one passage of a tooth
    assert found == pytest.approx(1000 * mean_torque / 1e-4 * 2 * math.pi / 51, rel=2e-3)


@pytest.mark.long
def test_a_little_wear_under_a_little_load_has_a_closed_form(design: PairDesign) -> None:
    """Depth is k F'/b times the specific sliding times the passages where one pair carries, and teeth do not bend.

    Under all of the load they do: contact is then up to 0.1 mm of roll nearer to the root or the tip.
    """
    task = task_of(design, design.materials, 0.01)
    result = wear_pair(task, WearOptions(loss=SMALL, steps=2, positions=60))
    last, pair = result.states[-1], task.gear_pair
    force = task.torque * 1000 / (pair.pinion.base_diameter / 2) / 15
    places = pair.path_of_contact.C + np.array([-0.55, -0.4, -0.25, 0.25, 0.4, 0.55])
    sliding = np.abs(pair.specific_sliding_at(places).wheel)
    expected = COEFFICIENT * 1e-3 * force * sliding * last.cycles * 51 / 52
    found = result.grids.wheel.values(pair.base_tangent.length - places) @ last.worn.wheel
    assert found == pytest.approx(expected, rel=0.01)
    assert np.all(last.worn.pinion == 0)


@pytest.mark.long
def test_flanks_without_wear_are_the_involutes(task: CheckTask) -> None:
    model = plane_model(task)
    grids = flank_grids(model, 60)
    plain, worn = (
        model.solve(0.7, 7.8),
        worn_pair(model, grids, grids.map(lambda grid: np.zeros(grid.spans + 3))).solve(0.7, 7.8),
    )
    assert worn.approach == pytest.approx(plain.approach, rel=1e-6)
    even = worn_pair(model, grids, grids.map(lambda grid: np.full(grid.spans + 3, 0.01))).solve(0.7, 7.8)
    assert even.approach - plain.approach == pytest.approx(0.02, rel=1e-3)  # both flanks stand back by 10 µm


@pytest.mark.long
def test_halved_steps_and_positions_move_the_life_by_less_than_a_percent(task: CheckTask) -> None:
    lives = [
        wear_pair(task, WearOptions(loss=30.0, steps=steps, positions=positions)).life_cycles
        for steps, positions in ((10, 30), (20, 30), (20, 60))
    ]
    assert lives[0] == pytest.approx(lives[1], rel=CONVERGED)
    assert lives[1] == pytest.approx(lives[2], rel=CONVERGED)


def test_command_writes_states_and_profiles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run("new", "plastic-51-52")
    result = run("wear", "plastic-51-52.toml", "--loss", "2", "--steps", "2", "--positions", "12")
    assert "2 µm of wear (wheel) after" in result.stdout
    document = json.loads((tmp_path / "output/plastic-51-52/wear.json").read_text(encoding="utf-8"))
    assert document["kind"] == "wear"
    assert document["states"][0]["cycles"] == 0
    assert document["states"][-1]["depth"] == {"pinion": 0.0, "wheel": pytest.approx(2.0, rel=1e-6)}
    assert document["life"]["hours"] == pytest.approx(document["life"]["cycles"] / 60 / 2250)
    assert max(document["profiles"][-1]["wheel"]["depth"]) == pytest.approx(2.0, rel=0.02)  # at 121 places
    assert "wear of the pair" not in (tmp_path / "output/plastic-51-52/wear.html").read_text(encoding="utf-8")


def test_what_cannot_be_worn_is_refused(design: PairDesign) -> None:
    steel = read_spec(TEMPLATES / "fzg-c.toml")
    with pytest.raises(ParameterError, match=r"material\.wear_coefficient is missing: must be given for one gear"):
        gearcad.wear(steel)
    helical = read_spec(TEMPLATES / "volvo-13-44.toml")
    with pytest.raises(GeometryError, match="must be of two external spur gears for wear"):
        gearcad.wear(helical, material=Material(wear_coefficient=1e-9))
    with pytest.raises(ParameterError, match="steps = 1: must be"):
        gearcad.wear(design, steps=1)
