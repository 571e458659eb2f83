"""Random planetary sets: what is admitted stands in mesh without overlap, what is refused overlaps where it is forced.

The outlines are judged by `support.planetary` and `support.ring_mesh`, which know nothing of meshing.
"""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from support.planetary import MeshWitness
from support.random_trains import build_train, train_inputs
from support.ring_mesh import CHORD_ERROR

from gearcad.core.errors import InputError
from gearcad.planetary import PlanetaryTrain, TrainPose
from gearcad.planetary.poses import assembled, train_pose
from gearcad.planetary.train_data import TrainData

STEP = 4e-3
"""How far (mm, on the working circle) before and behind the used-up backlash the sets are looked at."""


def confirm_mesh(train: PlanetaryTrain, angles: tuple[float, ...]) -> None:
    """No overlap with the backlash split, at some angles of the carrier; at the last of them none STEP before the backlash is
    used up either, and overlap STEP behind, at every planet.
    """
    if any(notice.code == "fillet-interference" for notice in train.notices):
        event("told: fillet")
        return
    for mesh in train.meshes:
        witness, half = MeshWitness(mesh), mesh.pair.circumferential_backlash / 2
        always = mesh.pair.usable_contact_ratio >= 1 + 1e-6
        event(f"type {train.set_type.value}, {train.planets} planets")
        event(f"{'helical' if mesh.central.gear.helix_angle else 'spur'}, {'always' if always else 'not always'} in contact")
        rounding = 4 * CHORD_ERROR * mesh.pair.pinion.transverse_module
        for angle in angles:
            pose = train.pose(angle)
            assert witness.in_pose(pose).min() >= (0 if half > rounding else -rounding)
        for side in (1, -1):
            if half > STEP:
                assert witness.in_pose(pose, side * (half - STEP) / witness.working_radius).min() >= 0
            if always:
                assert witness.in_pose(pose, side * (half + STEP) / witness.working_radius).max() < 0


def confirm_refusal(inputs: dict[str, Any], error: InputError) -> None:
    """That what is refused for its neighbours or its teeth overlaps where it is put together all the same."""
    text = str(error)
    assert "\n" not in text
    if "must let the teeth fit" in text:
        confirm_misfit(build_train(inputs, TrainData), text)
    elif "axes of planets" in text:
        confirm_neighbours(build_train(inputs, TrainData))
    else:
        event(f"refused: {error.parameter}")


def confirm_neighbours(train: TrainData) -> None:
    """That the tip circles of two planets of the forced train cut each other."""
    event("refused: neighbours")
    places = [np.array([planet.x, planet.y]) for planet in train_pose(train).planets]
    apart = min(float(np.hypot(*(one - other))) for i, one in enumerate(places) for other in places[:i])
    assert apart <= max(rim.gear.tip_diameter for rim in train.rims) + 1e-9


def confirm_misfit(train: TrainData, text: str) -> None:
    """That the planet which is named overlaps a central however it is turned, if it is off by more than the backlash."""
    number, angle, pitches = re.search(r"planet (\d+) at ([\d.e-]+) deg is ([\d.e-]+) pitches", text).groups()  # type: ignore[union-attr]
    first, second = train.meshes
    off = float(pitches) * math.pi * abs(first.pair.working_pitch_diameters.pinion) / first.pair.pinion.teeth
    # What both meshes leave to the planet, seen on the working circle of the first one.
    rims = [abs(mesh.pair.working_pitch_diameters.pick(mesh.rim_role)) / 2 for mesh in train.meshes]
    free = first.pair.circumferential_backlash + second.pair.circumferential_backlash * rims[0] / rims[1]
    pose = train_pose(train)
    planet = pose.planets[int(number) - 1]
    assert math.isclose(planet.angle, float(angle), rel_tol=1e-6)
    if off < free / 2 + 4 * STEP:
        event("refused: teeth, by less than the backlash")
        return
    event("refused: teeth")
    turns = np.linspace(-1, 1, 41) * (off + free) / rims[0]
    least = [overlap_of(train, pose, int(number) - 1, mesh_at, turns) for mesh_at in (0, 1)]
    assert np.minimum(*least).max() < 0


def overlap_of(train: TrainData, pose: TrainPose, planet: int, at: int, turns: np.ndarray) -> np.ndarray:
    """Clearances (n,) of one planet in one mesh, turned on by `turns` (n,) in rad, in the plane of the rim's bottom."""
    mesh = train.meshes[at]
    placed = pose.planets[planet]
    height = pose.heights[mesh.rim.name] - pose.heights[mesh.central.name]
    lead = math.tan(math.radians(mesh.central.gear.helix_angle)) / (abs(mesh.central.gear.reference_diameter) / 2)
    central = np.full(len(turns), math.radians(pose.rotations[mesh.central.name]) + lead * height)
    rim = math.radians(placed.rotations[mesh.rim.name]) + turns
    return MeshWitness(mesh).clearance(central, rim, np.full(len(turns), math.radians(placed.angle)))


def check(inputs: dict[str, Any], angles: tuple[float, ...]) -> None:
    try:
        train = build_train(inputs)
    except InputError as error:
        confirm_refusal(inputs, error)
        return
    assert isinstance(train, PlanetaryTrain)
    assert max(map(abs, assembled(train).misfits)) < 1e-9
    confirm_mesh(train, tuple(inputs["carrier_angle"] + angle for angle in angles))


@settings(max_examples=25)
@given(train_inputs())
def test_trains_stand_in_mesh_or_are_refused(inputs: dict[str, Any]) -> None:
    check(inputs, (0.0,))


@pytest.mark.long
@settings(max_examples=2500)
@given(train_inputs())
def test_trains_stand_in_mesh_or_are_refused_long(inputs: dict[str, Any]) -> None:
    check(inputs, (0.0, 33.3, 200.0))
