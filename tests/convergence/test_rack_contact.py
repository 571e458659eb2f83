"""A pinion and a rack in plane contact: the limit of wheels of many teeth, equilibrium, Hertz, the ends of the strip."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.calculix import needs_ccx

from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.plane.rack_body import rack_body
from gearcad.contact.plane.sector import PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.contact.shared.tip_edge import tip_edges
from gearcad.core.errors import GeometryError
from gearcad.core.records import PerGear
from gearcad.decks.rack import plane_decks
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.meshing.outline import MeshSizes
from gearcad.verification.calculix import PLANE_PERMITTED, judge_calculix
from gearcad.verification.claims import ClaimSubject, Judge, VerificationLevel

TORQUE = 60.0
PINION = Gear(teeth=20, normal_module=2, face_width=20, tooth_thinning=0.03)
RACK = Rack(teeth=75, normal_module=2, face_width=20, height=10.5, tooth_thinning=0.03)
PAIR = RackPair(pinion=PINION, rack=RACK)
ANGLES = (-7.0, -4.0, -1.5, 3.0, 6.0)
ROOT_ANGLES = (-7.0, -1.5, 3.0, 6.0)
"""Roll angles (deg) of root tensions: at -4 the pinion's tip presses beside the rack's fillet, as in no wheel."""

OF_CONTACT = 1e-4
"""Permitted difference of stiffness, share and pressure from the limit: 0.003 % found."""

OF_ROOT = 1e-3
"""Permitted difference of root tensions: the mesh of each wheel's fillets scatters by some 0.05 %."""


def wheel_pair(teeth: int) -> tuple[GearPair, BodyModel]:
    """A wheel with teeth like the rack's, held as far below its reference circle as the rack's back is."""
    wheel = Gear(teeth=teeth, normal_module=2, face_width=20, tooth_thinning=0.03)
    held = wheel.reference_diameter - 2 * RACK.height
    return GearPair(pinion=PINION, wheel=wheel, centre_distance=PINION.reference_diameter / 2 + teeth), BodyModel(
        inner_diameters=PerGear(None, held)
    )


def contact_figures(model: PlanePair) -> np.ndarray:
    """Single stiffness, and at each angle approach, share of the first pair of teeth, and pressure."""
    cycle, found = PlaneCycle(model, TORQUE), [model.single_stiffness(TORQUE, count=9)]
    for angle in ANGLES:
        position = cycle.solve(angle)
        found += [position.approach, position.contacts[0].share, position.contact_pressure]
    return np.array(found)


def root_figures(model: PlanePair) -> np.ndarray:
    """Root tensions of both gears at each angle."""
    cycle = PlaneCycle(model, TORQUE)
    return np.array([stress.stress for angle in ROOT_ANGLES for stress in cycle.solve(angle).tension])


def limits(figures, sizes: MeshSizes, teeth: tuple[int, ...], degree: int) -> np.ndarray:
    """Extrapolate figures of wheels to infinitely many teeth by a polynomial in 1/z."""
    found = []
    for count in teeth:
        pair, body = wheel_pair(count)
        found.append(figures(plane_pair(pair, Material(), body=body, sizes=sizes)))
    return np.polyfit(1 / np.array(teeth), np.array(found), degree)[-1]


def test_stiffness_share_and_pressure_are_the_limit_of_wheels():
    sizes = MeshSizes()
    expected = limits(contact_figures, sizes, (500, 2000), 1)
    assert contact_figures(plane_pair(PAIR, Material(), sizes=sizes)) == pytest.approx(expected, rel=3 * OF_CONTACT)


@pytest.mark.long
def test_all_figures_are_the_limit_of_wheels_of_500_1000_and_2000_teeth():
    sizes = MeshSizes(fillet=0.0125)
    teeth = (500, 1000, 2000)
    model = plane_pair(PAIR, Material(), sizes=sizes)
    assert contact_figures(model) == pytest.approx(limits(contact_figures, sizes, teeth, 2), rel=OF_CONTACT)
    assert root_figures(model) == pytest.approx(limits(root_figures, sizes, teeth, 1), rel=OF_ROOT)


def test_forces_along_the_rack_balance_the_torque():
    model = plane_pair(PAIR, Material())
    force = TORQUE * 1000 / (PINION.reference_diameter / 2)
    assert PAIR.rack_force(TORQUE) == pytest.approx(force, rel=1e-12)
    position = PlaneCycle(model, TORQUE).solve(3.0)
    assert not any(contact.edge for contact in position.contacts)
    # From the reactions of the finite elements at the back.
    assert 1000 * position.torques.wheel == pytest.approx(force, rel=1e-9)


def test_contacts_are_those_of_a_cylinder_and_a_plane():
    cycle = PlaneCycle.run(plane_pair(PAIR, Material()), TORQUE, 8)
    contacts = [contact for _, contact in cycle.interior_contacts]
    assert len(contacts) > 8
    for contact in contacts:
        modulus = Material().youngs_modulus / (1 - Material().poisson_ratio ** 2) / 2
        hertz = math.sqrt(contact.force * modulus / (math.pi * contact.place))
        assert contact.peak_pressure == pytest.approx(hertz, rel=5e-3)


def test_twice_as_long_a_strip_changes_nothing():
    sizes, elasticity = MeshSizes().refined(0.5), PlaneElasticity(Material())
    once, twice = (rack_body(RACK, elasticity, 1, sizes, reach=reach) for reach in (6.0, 12.0))
    short, long = (body.by_unit_loads(body.loads) for body in (once, twice))
    assert np.abs(long - short).max() < 1e-4 * np.abs(long).max()


@pytest.mark.long
def test_finer_cells_and_elements_change_little():
    usual, finer = (contact_figures(plane_pair(PAIR, Material(), sizes=MeshSizes().refined(factor))) for factor in (1.0, 2.0))
    assert usual == pytest.approx(finer, rel=2e-3)


@pytest.mark.parametrize("beyond", [-0.15, 0.15])
def test_tip_edges_are_the_limit_of_wheels(beyond):
    def edges(pair) -> np.ndarray:
        line, path = line_of_action(pair), pair.path_of_contact
        place = path.A + beyond if beyond < 0 else path.E + beyond
        found = tip_edges(line, line.lengths(place).map(lambda length: np.array([length])))
        return np.array([found.arms.pinion[0], found.arms.wheel[0], found.tilts.pinion[0], found.tilts.wheel[0]])

    teeth = np.array([500, 1000, 2000])
    wheels = np.array([edges(wheel_pair(count)[0]) for count in teeth.tolist()])
    assert edges(PAIR) == pytest.approx(np.polyfit(1 / teeth, wheels, 2)[-1], abs=2e-6)


def test_rack_of_too_few_teeth_is_refused_in_one_line():
    with pytest.raises(GeometryError, match=r"rack\.teeth = 2: must be at least 3"):
        plane_pair(RackPair(pinion=PINION, rack=Rack(teeth=2, normal_module=2, face_width=20, height=10.5)), Material())


@pytest.mark.long
@needs_ccx
@pytest.mark.parametrize(("torque", "angle"), [(TORQUE, 6.0), (-TORQUE, 6.0)])
def test_calculix_finds_the_same(torque: float, angle: float):
    """Transmission error 0.2 %, root stress 0.5 %, share 0.2 % of the load, pressure 2 %: 0.003, 0.03, 0.004, 0.03 % found."""
    judge = Judge(ClaimSubject.CALCULIX, VerificationLevel.FULL, "rack", "CalculiX")
    task = check_task(PAIR, Material(), Load(torque=torque), CheckOptions(model="2d"))
    claims = list(judge_calculix(plane_decks(task), angle, judge, PLANE_PERMITTED))
    assert len(claims) >= 4
    for claim in claims:
        assert claim.passed, claim.text
