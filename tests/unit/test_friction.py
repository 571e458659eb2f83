"""Friction of flanks: sense, energy and torques of the contact, Ohlendorf's loss factor, laws of the coefficient."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from gearcad import Gear, GearPair, Load
from gearcad.check.friction import mesh_losses
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.geometry.tooth_friction import MeshFriction, ohlendorf_loss_factor
from gearcad.material import Material, MaterialGroup
from gearcad.rating.friction import mesh_efficiency, mesh_friction
from gearcad.rating.options import RatingOptions

STEEL = Material()
TORQUE = 100.0
FRICTION = MeshFriction(reference=0.1)


def fzg(helix: float = 0.0, relief: float = 0.0) -> GearPair:
    """The FZG type C gears, helical too; tip reliefs in µm keep the tips off the flanks before the path of contact."""
    every = {"normal_module": 4.5, "face_width": 14.0}
    every |= {"modification.tip_relief": relief, "modification.tip_relief_length": 4.0} if relief else {}
    pinion = Gear(teeth=16, profile_shift=0.1817, helix_angle=helix, **_with_parts(every))
    wheel = Gear(teeth=24, profile_shift=0.1715, helix_angle=-helix, **_with_parts(every))
    return GearPair(pinion=pinion, wheel=wheel)


def _with_parts(values: dict[str, float]) -> dict[str, object]:
    from gearcad.geometry import FlankModification

    flat = {name: value for name, value in values.items() if "." not in name}
    parts = {name.split(".")[1]: value for name, value in values.items() if "." in name}
    return flat | ({"modification": FlankModification(**parts)} if parts else {})


@cache
def sections() -> PlanePair:
    return plane_pair(fzg(relief=60.0), STEEL)


@cache
def plain_sections() -> PlanePair:
    return plane_pair(fzg(), STEEL)


@cache
def bodies() -> SolidPair:
    return solid_pair(fzg(helix=12.0, relief=60.0), STEEL, sizes=SolidSizes().refined(0.6), friction=FRICTION)


@pytest.mark.parametrize("driver", list(Role))
def test_power_lost_is_that_which_goes_in_less_that_which_comes_out(driver: Role) -> None:
    cycle = PlaneCycle.run(sections().rubbing(replace(FRICTION, driver=driver)), TORQUE, 12)
    pair = cycle.model.pair
    assert all(contact.arms == (1.0, 1.0) for _, contact in cycle.contacts)  # no tip's edge touches
    wheel = np.array([position.torque_ratios.wheel for position in cycle.positions]) * TORQUE * pair.gear_ratio
    # Speeds are as 1 to 1/u.
    lost = (TORQUE - wheel / pair.gear_ratio) * (1 if driver is Role.PINION else -1)
    assert lost == pytest.approx(cycle.values("lost_torque"), abs=1e-9 * TORQUE)
    assert lost.mean() > 0.01 * TORQUE


def test_finite_elements_have_the_torques_of_the_lever_arms() -> None:
    cycle = PlaneCycle.run(sections().rubbing(FRICTION), TORQUE, 6)
    for position in cycle.positions:
        assert position.torques.pinion == pytest.approx(TORQUE, rel=5e-4)
        assert position.torques.wheel == pytest.approx(1.5 * TORQUE * position.torque_ratios.wheel, rel=5e-4)


def test_friction_turns_over_at_the_pitch_point_and_with_the_driver() -> None:
    model = sections()
    before, after = (model.rubbing(FRICTION).solve(angle, TORQUE) for angle in (-0.01, 0.01))
    plain = model.solve(0.01, TORQUE)
    # On one pair of teeth the normal force is T/(r_b + f rho).
    base, rho = model.base_radius, model.pair.path_of_contact.C
    for found, sign in ((before, -1), (after, 1)):
        expected = model.force(TORQUE) / (1 + sign * 0.1 * rho / base)
        assert found.forces.sum() == pytest.approx(expected, rel=1e-3)
    assert plain.forces.sum() == pytest.approx(model.force(TORQUE), rel=1e-12)
    driven = model.rubbing(replace(FRICTION, driver=Role.WHEEL)).solve(0.01, TORQUE)
    assert driven.forces.sum() == pytest.approx(before.forces.sum(), rel=1e-3)


def test_no_coefficient_is_no_friction() -> None:
    plain, none = (
        PlaneCycle(model, TORQUE).solve(-2.0) for model in (sections(), sections().rubbing(MeshFriction(reference=0.0)))
    )
    assert none.transmission_error == pytest.approx(plain.transmission_error, rel=1e-12)
    assert none.tension.pinion.stress == pytest.approx(plain.tension.pinion.stress, rel=1e-12)
    assert none.lost_torque == 0


def test_loads_along_the_flank_move_other_teeth_by_reciprocity() -> None:
    """Elements under forces along the flank move the flank of the next tooth as normal loads there move the loaded flank."""
    body = sections().pinion
    flank, middle = body.flank, len(body.loads) // 2
    at = body.loads[middle : middle + 1]
    forces = np.zeros((2 * len(body.ring.sector.mesh.points), 1))
    node = flank.nodes[int(np.argmin(np.abs(flank.lengths - at[0])))]
    forces[2 * node : 2 * node + 2, 0] = flank.towards_tip(at)[0]
    moved = body.ring.solve(forces)[0][body.neighbours + 1]
    normals, lengths = flank.inward(flank.lengths), flank.lengths
    next_tooth = moved[2 * flank.nodes, 0] * normals[:, 0] + moved[2 * flank.nodes + 1, 0] * normals[:, 1]
    inside = slice(len(lengths) // 4, 3 * len(lengths) // 4)
    # A normal load on tooth 0 moves tooth -1 towards its tip as a force towards the tip of tooth 0 moves tooth 1 inwards.
    by_reciprocity = body.along_by_unit_loads(at)[0, body.neighbours - 1] @ body.parts_of_loads(lengths[inside]).T
    assert next_tooth[inside] == pytest.approx(by_reciprocity, rel=2e-3)


@pytest.mark.long
def test_solids_lose_what_their_torques_differ_by() -> None:
    cycle = SolidCycle.run(bodies(), TORQUE, 4)
    pair = cycle.model.pair
    for position in cycle.positions:
        ratio = position.torque_ratios.wheel
        if all(contact.arms == (1.0, 1.0) for contact in position.contacts):
            assert 1 - ratio == pytest.approx(position.lost_torque / TORQUE, abs=1e-9)
        assert position.torques.pinion == pytest.approx(TORQUE, rel=2e-3)
        assert position.torques.wheel == pytest.approx(TORQUE * pair.gear_ratio * ratio, rel=2e-3)


@pytest.mark.long
def test_solid_and_plane_spur_gears_are_moved_alike() -> None:
    """Friction changes root stress and transmission error of spur gears in the body as in the plane, by 7 and 0.4 %."""
    solid, plane = solid_pair(fzg(), STEEL, friction=FRICTION), plain_sections()
    for angle in (-1.4, 1.4):
        changes = []
        for cycle in (SolidCycle, PlaneCycle):
            model = solid if cycle is SolidCycle else plane
            with_friction, without = (cycle(model.rubbing(of), TORQUE).solve(angle) for of in (FRICTION, None))
            roots = [with_friction.tension.pick(role).stress / without.tension.pick(role).stress for role in Role]
            changes.append((*roots, with_friction.transmission_error / without.transmission_error))
        assert abs(changes[0][0] - 1) > 0.05
        assert changes[0] == pytest.approx(changes[1], abs=4e-3)


@pytest.mark.parametrize(("teeth", "helix"), [((16, 24), 0.0), ((20, 63), 15.0)])
def test_rigid_shares_have_the_loss_factor_of_ohlendorf(teeth: tuple[int, int], helix: float) -> None:
    sizes = {"normal_module": 3.0, "face_width": 10.0}
    pair = GearPair(
        pinion=Gear(teeth=teeth[0], helix_angle=helix, **sizes), wheel=Gear(teeth=teeth[1], helix_angle=-helix, **sizes)
    )
    path, pitch = pair.path_of_contact, pair.pinion.transverse_base_pitch
    # Sliding lever over base radius, by the share of the load, over one base pitch of the path: the trapezoids are exact.
    lost = 0.0
    for low, high, share in ((path.A, path.B, 0.5), (path.B, path.C, 1.0), (path.C, path.D, 1.0), (path.D, path.E, 0.5)):
        ends = np.array([low, high]) - path.C
        lost += share * float(np.abs(ends).sum() / 2 * (high - low))
    factor = lost / pitch * (1 + 1 / pair.gear_ratio) / (pair.pinion.base_diameter / 2)
    factor /= math.cos(math.radians(pair.pinion.base_helix_angle))
    assert ohlendorf_loss_factor(pair) == pytest.approx(factor, rel=1e-6)


def test_laws_go_with_the_load_and_need_a_speed() -> None:
    pair, load = fzg(), Load(torque=300.0, speed=2000.0)
    steel = PerGear(replace(STEEL, group=MaterialGroup.CASE_HARDENED), replace(STEEL, group=MaterialGroup.CASE_HARDENED))
    for law in ("flash", "integral", "niemann"):
        found = mesh_friction(pair, steel, load, law, RatingOptions())
        force = 300_000 / (pair.pinion.base_diameter / 2) / 14.0
        assert found.coefficient(force) == pytest.approx(found.reference, rel=1e-12)
        assert found.coefficient(2 * force) == pytest.approx(2**0.2 * found.reference, rel=1e-12)
        assert 0.03 < found.reference < 0.1
        with pytest.raises(ParameterError, match=r"check\.friction"):
            mesh_friction(pair, steel, Load(torque=300.0), law, RatingOptions())
    assert mesh_friction(pair, steel, Load(torque=-300.0, speed=100.0), 0.05, RatingOptions()).driver is Role.WHEEL


def test_losses_of_a_check() -> None:
    options = CheckOptions(friction=0.1, positions=12)
    task = check_task(fzg(), STEEL, Load(torque=TORQUE, speed=1500.0), options)
    losses = mesh_losses(task, PlaneCycle.run(plain_sections().rubbing(task.friction), TORQUE, 12))
    assert losses is not None
    document = losses.to_dict()
    power = TORQUE * 1500 * math.pi / 30
    assert document["mean_loss"] == pytest.approx((1 - document["efficiency"]) * power, rel=1e-9)
    # Elastic teeth share the load otherwise than by halves.
    assert document["H_V_contact"] == pytest.approx(losses.ohlendorf, rel=0.05)
    assert document["law"] == "constant"


def test_efficiency_over_a_load_spectrum_is_that_of_the_power() -> None:
    pair, load, steel = fzg(), Load(torque=200.0, speed=1000.0), PerGear(STEEL, STEEL)
    factor = ohlendorf_loss_factor(pair)
    assert factor is not None
    even = mesh_efficiency(pair, steel, load, 0.06, RatingOptions())
    assert even is not None
    assert even.efficiency == pytest.approx(1 - 0.06 * factor, rel=1e-12)
    assert even.mean_loss == pytest.approx(0.06 * factor * 200 * 1000 * math.pi / 30, rel=1e-12)
    options = RatingOptions(life=1000.0, spectrum=[[0.25, 1.0], [0.75, 0.5]])
    found = mesh_efficiency(pair, steel, load, "niemann", options)
    assert found is not None
    # The coefficient goes with the torque to the power 0.2.
    mean = found.coefficient * (0.25 + 0.75 * 0.5 * 0.5**0.2) / (0.25 + 0.75 * 0.5)
    assert found.efficiency == pytest.approx(1 - mean * factor, rel=1e-12)
    power = (0.25 + 0.75 * 0.5) * 200 * 1000 * math.pi / 30
    assert found.mean_loss == pytest.approx(mean * factor * power, rel=1e-12)
