"""Contact of spline joints: invariants, the closed form of its mean pressure, another solution of the ring, and CalculiX."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from gearcad.check.spline import MeanStresses, check_spline
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import Plane
from gearcad.contact.plane.spline_contact import FlankCells, SplineContact, joint_contact, of_hub, spline_body
from gearcad.contact.shared.bodies import Cuts, Support
from gearcad.core.errors import GeometryError
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_inputs import HubInputs, ShaftInputs
from gearcad.load import Load
from gearcad.material import Material

CALCULIX = json.loads((Path(__file__).parents[1] / "data" / "spline_calculix.json").read_text(encoding="utf-8"))
STEEL = Material()
OWN = {"tolerance_actual": 20.0, "tolerance_effective": 10.0}
JOINT = SplineJoint(
    designation="N 15 x 1.25 x 10 x 9H / W 15 x 1.25 x 10 x 9g", shaft=ShaftInputs(**OWN), hub=HubInputs(**OWN), length=20.0
)
PLAY = JOINT.parts["hub"].built_size - JOINT.parts["shaft"].built_size
TORQUE = 4000.0
"""N mm per mm of length."""


def contact(torque: float = TORQUE, force: float = 0.0, cells: int = 12, play: float = PLAY) -> SplineContact:
    return joint_contact(JOINT, torque, (STEEL, STEEL), play=play, radial_force=force, cells=cells)


@pytest.mark.parametrize("force", [0.0, 60.0, 300.0, 900.0])
def test_pressures_carry_what_they_are_given(force: float) -> None:
    """The sum of tooth torques, and the force that the pressures give along x and y by their own normals."""
    found = contact(force=force)
    assert found.torques.sum() == pytest.approx(TORQUE, rel=1e-9)
    assert found.pressures.min() >= 0 and found.overlap < 1e-9
    given, gear = np.zeros(2), JOINT.parts["shaft"].gear
    arcs = (found.cells.ends[:-1] + found.cells.ends[1:]) / 2
    radius = np.sqrt(found.cells.base_radius**2 + 2 * found.cells.base_radius * arcs)
    lean = np.arccos(found.cells.base_radius / radius)
    half = gear.profile.involute.half_angle(radius)
    for tooth, pressures in enumerate(found.pressures):
        at = 2 * math.pi * tooth / JOINT.count
        for pressure, sign in ((pressures[: len(arcs)], 1), (pressures[len(arcs) :], -1)):
            heading = at + sign * (half + math.pi / 2 - lean)  # of the normal, which touches the base circle
            given += found.cells.width * np.array([pressure @ np.cos(heading), pressure @ np.sin(heading)])
    assert given == pytest.approx([force, 0.0], abs=2e-3 * max(force, 1.0))


def test_centred_teeth_carry_alike_with_the_mean_pressure_of_the_closed_form() -> None:
    found = contact()
    assert np.ptp(found.shares) < 1e-12
    mean = MeanStresses.of(JOINT, Load(torque=TORQUE * JOINT.length / 1000))
    assert found.mean_pressures.max() * 1 / 0.75 == pytest.approx(mean.flank_pressure, rel=5e-4)
    assert np.ptp(found.root_stresses[0]) < 1e-9 * found.root_stresses[0].max()


def test_the_other_direction_is_the_mirror_image() -> None:
    """In the mirror y -> -y tooth t is tooth -t, and left flanks are right ones. gmsh's triangles are no mirror images."""
    one, other = contact(force=300.0), contact(torque=-TORQUE, force=300.0)
    count = one.cells.count
    seen = np.roll(other.pressures[::-1], 1, axis=0)
    assert one.pressures[:, :count] == pytest.approx(seen[:, count:], abs=2e-3 * one.pressures.max())
    for mine, theirs in zip(one.root_stresses, other.root_stresses, strict=True):
        assert mine.max() == pytest.approx(theirs.max(), rel=3e-3)


def test_a_hub_has_the_flanks_that_face_those_of_the_shaft() -> None:
    values = np.arange(20.0).reshape(10, 2)  # a cell on each flank: 2 t on the left one, 2 t + 1 on the right one
    assert of_hub(values).tolist() == [[(2 * t + 3) % 20, 2 * t] for t in range(10)]


def test_play_turns_the_shaft_and_nothing_else() -> None:
    near, far = contact(play=0.01), contact(play=0.11)
    assert near.pressures == pytest.approx(far.pressures, rel=1e-8, abs=1e-8)
    turned = 0.1 / 2 * math.cos(math.pi / 6) / near.cells.base_radius
    assert far.turn - near.turn == pytest.approx(turned, rel=1e-9)


def test_responses_are_those_of_the_ring_that_gears_have() -> None:
    """Sums of waves against the body of gears: nine of the ten teeth in full, the last one condensed from the same mesh."""
    cells = FlankCells.of(JOINT, 4)
    body = spline_body(JOINT.parts["shaft"], cells, STEEL, Plane.STRAIN)
    mesh = body.sector.mesh
    ring = assemble(mesh, mesh, JOINT.count, 4, body.elasticity, None, Cuts.FREE, Support(teeth=JOINT.count))
    moved, _ = ring.solve(body.loads)
    for place, tooth in enumerate(range(-4, 5)):
        theirs = body.loads.T @ moved[place]
        assert body.responses[tooth % JOINT.count] == pytest.approx(theirs, rel=1e-8, abs=1e-12), tooth


@pytest.mark.parametrize("case", CALCULIX["cases"], ids=lambda case: f"{case['radial_force']:g}")
def test_calculix_gives_teeth_the_same_shares(case: dict[str, list[float]]) -> None:
    """Shares within 0.5 % of the greatest, root stresses within 1.5 %: those of the deck's own mesh are good to 1 %."""
    found = contact(force=float(case["radial_force"]), cells=24)  # type: ignore[arg-type]
    theirs = np.array(case["forces"])
    shares = theirs / theirs.sum()
    assert np.abs(found.shares - shares).max() < 0.005 * shares.max()
    for own, name in zip(found.root_stresses, ("shaft", "hub"), strict=True):
        assert own.max() == pytest.approx(max(case[f"root_stress_{name}"]), rel=0.015)


def test_a_finer_model_says_the_same() -> None:
    result = check_spline(JOINT, Load(torque=80.0), STEEL)
    assert result.passed and max(map(abs, result.convergence.values())) < 0.02
    document = result.to_dict()
    assert sum(document["contact"]["torques"]) == pytest.approx(80.0, rel=1e-9)
    assert sum(document["contact"]["shares"]) == pytest.approx(1.0, rel=1e-12)


def test_a_shaft_alone_has_no_contact() -> None:
    with pytest.raises(GeometryError, match="must name a shaft and a hub"):
        check_spline(SplineJoint(designation="W 15 x 1.25 x 10 x 9g"), Load(torque=1.0), STEEL)
