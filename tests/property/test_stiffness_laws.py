"""What every mesh stiffness must obey, whatever the pair: scaling, exchange of the gears, sums, and limits."""

import math
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from support.cases import THESIS_LOAD, thesis_pair
from support.strategies import build_pair, pair_inputs

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.contact.shared.bodies import BodyModel, Cuts
from gearcad.core.errors import GearcadError
from gearcad.core.records import PerGear
from gearcad.geometry import ShaperCutter
from gearcad.mesh_cycle import MeshCycle
from gearcad.stiffness import CLOSED_FORMS, METHODS, PlaneStrainContact, PotentialEnergy, StrainEnergy, WeberBanaschek

SMALL = BodyModel(teeth=3, cuts=Cuts.FIXED)
BEAMS = (PotentialEnergy, WeberBanaschek)
STEEL = Material()
DOUBLE = Material(youngs_modulus=2 * STEEL.youngs_modulus)


def _pair(teeth: tuple[int, int] = (20, 43), helix: float = 0.0, width: float = 30.0, **more: Any) -> GearPair:
    pinion, wheel = (
        Gear(teeth=z, normal_module=2.0, face_width=width, helix_angle=sign * helix, **more)
        for z, sign in zip(teeth, (1, -1), strict=True)
    )
    return GearPair(pinion=pinion, wheel=wheel)


def _sound(cycle: MeshCycle) -> None:
    """Positive, whole, and of one piece."""
    assert np.isfinite(cycle.mesh_stiffness).all() and cycle.minimum > 0
    assert cycle.minimum <= cycle.mean <= cycle.maximum
    assert cycle.tangent_mean >= cycle.mean * (1 - 1e-12)
    if not cycle.mean_only:
        assert cycle.load_share.sum(axis=1) == pytest.approx(np.ones(len(cycle.roll_angle)), abs=1e-9)
        total = np.sum(list(cycle.compliance_parts.values()), axis=0)
        assert total * cycle.mesh_stiffness == pytest.approx(np.ones(len(total)), abs=1e-6)


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_twice_the_modulus_halves_every_part_of_the_teeth(helix: float) -> None:
    pair, load = _pair(helix=helix), Load(torque=80.0)
    for method in BEAMS:
        soft, hard = (method(pair=pair, material=material) for material in (STEEL, DOUBLE))
        lengths = soft.slices.lengths
        before, after = soft.single(lengths, load).parts, hard.single(lengths, load).parts
        for name in before:
            if name != "contact" or method is PotentialEnergy:
                assert after[name] == pytest.approx(before[name] / 2, rel=1e-13)
        # Where the load enters, twice of it goes with twice the modulus.
        assert hard(Load(torque=160.0)).mean == pytest.approx(2 * soft(load).mean, rel=1e-12)
    contact = WeberBanaschek(pair=pair, material=DOUBLE).single(lengths, load).parts["contact"]
    assert (contact < before["contact"] / 2 * 1.2).all() and (contact > before["contact"] / 2 * 1.01).all()


def test_twice_the_modulus_and_the_load_of_finite_elements() -> None:
    for method in (PlaneStrainContact, StrainEnergy):
        soft, hard = (
            method(pair=_pair(), material=material, body=SMALL, positions=12)(Load(torque=torque))
            for material, torque in ((STEEL, 80.0), (DOUBLE, 160.0))
        )
        assert hard.mesh_stiffness == pytest.approx(2 * soft.mesh_stiffness, rel=1e-9)
        assert hard.tangent_stiffness == pytest.approx(2 * soft.tangent_stiffness, rel=1e-6)
        assert hard.transmission_error == pytest.approx(soft.transmission_error, rel=1e-9)
        _sound(soft)


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_width_and_load(name: str) -> None:
    narrow = METHODS[name](pair=_pair(width=15.0))(Load(torque=100.0))
    wide = METHODS[name](pair=_pair(width=30.0))(Load(torque=200.0))
    assert wide.mean == pytest.approx(2 * narrow.mean, rel=1e-12)
    assert wide.tangent_per_width == pytest.approx(narrow.tangent_per_width, rel=1e-12)
    light = METHODS[name](pair=_pair(width=30.0))(Load(torque=20.0))
    if name == "potential-energy":
        assert light.mean == pytest.approx(wide.mean, rel=1e-14)
    else:
        assert light.mean < wide.mean


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_driver_and_wheel_exchanged(helix: float) -> None:
    pair = _pair(helix=helix)
    other = GearPair(pinion=pair.wheel, wheel=pair.pinion)
    for method in BEAMS:
        one = method(pair=pair)(Load(torque=100.0))
        two = method(pair=other)(Load(torque=100.0 * pair.gear_ratio))
        assert two.mean == pytest.approx(one.mean, rel=1e-7)
        assert (two.maximum, two.minimum) == pytest.approx((one.maximum, one.minimum), rel=1e-6)
        assert two.pitch_point == pytest.approx(one.pitch_point, rel=1e-4)
        assert one.mean_of(one.compliance_parts["pinion bending"]) == pytest.approx(
            two.mean_of(two.compliance_parts["wheel bending"]), rel=1e-5
        )


@pytest.mark.parametrize("helix", [4.0, pytest.param(15.0, marks=pytest.mark.long), 30.0])
def test_slices_against_many_thin_ones(helix: float) -> None:
    """Sums over 4,000 slices, each with its own compliance, without splines: at some roll angles."""
    method, load = WeberBanaschek(pair=_pair(helix=helix)), Load(torque=100.0)
    cycle, zone = method(load), method.slices
    heights = (np.arange(4000) + 0.5) / 4000 * zone.width - zone.width / 2
    lean = math.tan(math.radians(method.pair.pinion.base_helix_angle))
    for row in (0, 37, 90, 151):
        middle = method.pair.path_of_contact.C + math.radians(cycle.roll_angle[row]) * method.pair.pinion.base_diameter / 2
        places = (middle + np.arange(-4, 5)[:, None] * zone.pitch + heights * lean).ravel()
        touching = places[(places > zone.path[0]) & (places < zone.path[1])]
        total = method.single(touching, load).stiffness.sum() * zone.width / 4000
        assert cycle.mesh_stiffness[row] == pytest.approx(total, rel=5e-4)


def test_a_spur_pair_is_the_limit_of_helical_ones() -> None:
    for method in (*BEAMS, StrainEnergy):
        spur, nearly = (method(pair=_pair(helix=helix), body=SMALL)(Load(torque=100.0)) for helix in (0.0, 0.02))
        assert nearly.mean == pytest.approx(spur.mean, rel=2e-4)
        assert nearly.pitch_point == pytest.approx(spur.pitch_point, rel=2e-4)


def test_the_nearer_a_body_is_held_the_stiffer() -> None:
    for method, bores in ((PotentialEnergy, (60.0, 160.0, 200.0)), (StrainEnergy, (200.0, 229.0, 235.0))):
        bodies = [BodyModel(inner_diameters=PerGear(12.0, bore)) for bore in bores]
        means = [method(pair=thesis_pair(), body=body)(THESIS_LOAD).mean for body in bodies]
        assert means == sorted(means)
        assert means[-1] > 1.05 * means[0]


HIGH_RACK = BasicRack(addendum=1.35, dedendum=1.6, root_radius=0.2)

LIMITS = {
    "root circle above base circle, z 161": thesis_pair(),
    "undercut, z 10": _pair((10, 40)),
    "contact ratio above 2": _pair((50, 70), rack=HIGH_RACK),
    "overlap above 1, helix 30": _pair(helix=30.0),
    "overlap of exactly 1": _pair(helix=30.0, width=2 * math.pi * 2.0),
    "tips chamfered": _pair(tip_alteration=-0.2),
}


@pytest.mark.parametrize("case", LIMITS)
def test_limits(case: str) -> None:
    pair = LIMITS[case]
    for name in CLOSED_FORMS:
        cycle = METHODS[name](pair=pair)(Load(torque=20.0))
        _sound(cycle)
        assert 8 < cycle.secant_per_width < 30, name
    energy = StrainEnergy(pair=pair, body=SMALL)(Load(torque=20.0))
    _sound(energy)
    weber = WeberBanaschek(pair=pair)(Load(torque=20.0))
    assert energy.mean == pytest.approx(weber.mean, rel=0.35)


def test_undercut_shortens_the_path() -> None:
    """z 10 without shift: the usable contact ratio is 1.09 where the tips would have 1.54."""
    pair = LIMITS["undercut, z 10"]
    cycle = PotentialEnergy(pair=pair)(Load(torque=20.0))
    double = (cycle.load_share > 0).sum(axis=1) > 1
    assert cycle.mean_of(double.astype(float)) == pytest.approx(pair.usable_contact_ratio - 1, abs=1e-9)
    _sound(PlaneStrainContact(pair=pair, body=SMALL, positions=12)(Load(torque=20.0)))


def test_three_pairs_of_teeth() -> None:
    pair = LIMITS["contact ratio above 2"]
    shares = PlaneStrainContact(pair=pair, body=SMALL, positions=12)(Load(torque=100.0)).load_share
    assert ((shares > 0).sum(axis=1) >= 2).all()
    assert ((shares > 0).sum(axis=1) == 3).any()


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_large_shaper_cutters_leave_the_teeth_of_hobs(helix: float) -> None:
    """As beams: what is left of the difference goes as 1/z_0."""
    for name in ("potential-energy", "weber-banaschek"):
        means = [
            METHODS[name](pair=_pair(helix=helix, cutter=cutter))(Load(torque=50.0)).mean
            for cutter in (ShaperCutter(), *(ShaperCutter(teeth=teeth, tip_radius=0.38) for teeth in (1000, 2000)))
        ]
        off = np.array(means[1:]) / means[0] - 1
        assert off[0] / off[1] == pytest.approx(2, rel=0.01)
        assert abs(off[1]) < 1e-3


def test_pairs_that_no_method_can_treat() -> None:
    lost = _pair((8, 12))
    with pytest.raises(ValueError, match=r"pair\.usable_contact_ratio = 0\.82.*: must be at least 1 .* fillets take away"):
        PotentialEnergy(pair=lost)
    with pytest.raises(ValueError, match=r"pair\.helix_angle = 10 deg: must be 0 for plane-strain"):
        PlaneStrainContact(pair=_pair(helix=10.0))
    with pytest.raises(ValueError, match=r"load\.torque = 1000000 N·m: must be lower: the contact by Hertz's formula"):
        WeberBanaschek(pair=_pair())(Load(torque=1e6))


def test_random_pairs() -> None:
    """A right value or an error of ours, never anything else; and a value for a fair number of them."""
    found: Counter[str] = Counter()

    @settings(max_examples=200, deadline=None, suppress_health_check=list(HealthCheck))
    @given(pair_inputs())
    def one(inputs: dict[str, Any]) -> None:
        try:
            pair = build_pair(inputs)
        except GearcadError:
            return
        for name in CLOSED_FORMS:
            try:
                cycle = METHODS[name](pair=pair)(Load(torque=pair.pinion.normal_module**3 / 20))
            except GearcadError:
                continue
            _sound(cycle)
            found[name] += 1

    one()
    assert all(found[name] >= 5 for name in CLOSED_FORMS)


def test_mesh_cycles_of_other_torques() -> None:
    method = WeberBanaschek(pair=_pair())
    signs = [method(replace(Load(torque=50.0), torque=torque)).mean for torque in (50.0, -50.0)]
    assert signs[0] == signs[1]
    factor = method(Load(torque=25.0, application_factor=2.0))
    assert factor.mean == signs[0] and factor.torque == 50.0
