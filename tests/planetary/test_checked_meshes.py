"""Structural checks of the meshes of planetary trains, in the plane: equilibrium, load sharing, Hertz."""

import pytest
from support.loaded_trains import alm_set, pre_stage, simple_set

from gearcad import check
from gearcad.check.comparison import ComparisonRole
from gearcad.designs import MeshPairs, PairDesign, PlanetaryDesign
from gearcad.planetary import TrainLoad

ALM = PlanetaryDesign(
    name="alm", train=alm_set(stages=(pre_stage(),), input="pinion_1"), load=TrainLoad(torque=1600, speed=954.93)
)
SIMPLE = PlanetaryDesign(
    name="simple",
    train=simple_set(24, 21, rim_diameter=165.0),
    load=TrainLoad(torque=200, speed=1500, mesh_load_factor=1.2, application_factor=1.25),
)
PAIRS = [*MeshPairs(design=ALM).designs.values(), *MeshPairs(design=SIMPLE).designs.values()]

BALANCE = 1e-6
"""Relative: what forces at the held circle are off the torque that is applied."""


@pytest.mark.long
@pytest.mark.parametrize("design", PAIRS, ids=lambda design: design.name)
def test_gates_of_the_check(design: PairDesign) -> None:
    found = check(design)
    gates = [each for each in found.comparisons if each.role is ComparisonRole.GATE]
    assert len(gates) == 9
    assert all(each.passed for each in gates)
    torque = abs(design.load.torque) * design.load.application_factor
    reactions = {each.quantity: each for each in gates if each.quantity.startswith("torque reaction")}
    assert reactions["torque reaction of the pinion"].reference == pytest.approx(torque, rel=1e-12)
    on_wheel = torque * abs(design.pair.gear_ratio)
    assert reactions["torque reaction of the wheel"].reference == pytest.approx(on_wheel, rel=1e-12)
    for each in reactions.values():
        assert each.computed == pytest.approx(each.reference, rel=BALANCE)
    assert {each.quantity for each in gates} >= {"peak contact pressure", "half width of contact"}
    for position in found.cycle.positions:
        shares = [contact.share for contact in position.contacts]
        assert sum(shares) == pytest.approx(1, abs=1e-9)
    # One pair carries all of it for part of the mesh, as contact ratios below 2 have it.
    assert {len(position.contacts) for position in found.cycle.positions} == {1, 2}
