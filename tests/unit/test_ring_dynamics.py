"""Dynamics and mesh stiffness of internal pairs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from gearcad import Body, Gear, GearPair, Load, Material, stiffness
from gearcad.contact.plane.pair import plane_pair
from gearcad.core.records import PerGear
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.pair_study import study_contact, study_pair
from gearcad.dynamics.time_domain.contact_model import ContactModel, EngagedPairs
from gearcad.dynamics.time_domain.time_history import time_history
from gearcad.dynamics.trains.mesh_excitation import pair_train
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.dynamics.trains.train import static_forces
from gearcad.geometry import ShaperCutter
from gearcad.mesh_cycle import MeshCycle
from gearcad.stiffness import CLOSED_FORMS, StrainEnergy

PAIR = GearPair(
    pinion=Gear(teeth=24, normal_module=2.0, face_width=20.0, tooth_thinning=0.05),
    wheel=Gear(teeth=-70, normal_module=2.0, face_width=18.0, profile_shift=-0.3, tooth_thinning=0.05),
)
INERTIAS = PerGear(2e-4, 9e-3)
LOAD = Load(torque=80.0, speed=2000.0)


def _cycle() -> MeshCycle:
    """400 N/µm and a tenth of it more and less over a tooth."""
    angle = np.linspace(-7.5, 7.5, 61)
    stiffness = 400 * (1 + 0.1 * np.cos(2 * np.pi * angle / 15))
    force = 2000 * LOAD.torque / PAIR.pinion.base_diameter
    return MeshCycle(
        method="plane-strain",
        holds=(),
        torque=LOAD.torque,
        force=force,
        width=18.0,
        roll_angle=angle,
        mesh_stiffness=stiffness,
        tangent_stiffness=stiffness,
        transmission_error=force / stiffness,
    )


def test_a_pair_with_a_ring_is_two_inertias_that_turn_the_same_way() -> None:
    train = pair_train(PAIR, _cycle(), INERTIAS, torque=80.0, speed=2000.0, damping_ratio=0.07)
    assert train.speed_ratios == pytest.approx({"pinion": 1.0, "wheel": 24 / 70})
    assert sum(train.torques[name] * ratio for name, ratio in train.speed_ratios.items()) == pytest.approx(0, abs=1e-12)
    assert static_forces(train) == pytest.approx([2000 * 80 / PAIR.pinion.base_diameter], rel=1e-12)
    assert train.meshes[0].backlash == pytest.approx(1000 * PAIR.circumferential_backlash, rel=0.15)


def test_natural_frequency_and_dynamic_factor_of_a_pair_with_a_ring() -> None:
    """k (r_b1²/J_1 + r_b2²/J_2) of the two inertias; K_v is that of an external wheel of the same size far from resonance."""
    found = study_pair(PAIR, Material(), LOAD, _cycle(), INERTIAS, DynamicsOptions(speeds=40))
    study = found.study
    assert "free-ring" in {notice.code for notice in found.notices}
    r_1, r_2 = (math.cos(math.radians(20)) * teeth / 1000 for teeth in (24, 70))
    tangent = 400e6  # the mean
    expected = math.sqrt(tangent * (r_1**2 / 2e-4 + r_2**2 / 9e-3)) / (2 * math.pi)
    assert study.modes.frequency[study.modes.rigid] == pytest.approx(expected, rel=1e-4)
    assert study.method_b is not None
    mass = 2e-4 * 9e-3 / (2e-4 * r_2**2 + 9e-3 * r_1**2) / 18.0
    assert study.method_b.reduced_mass == pytest.approx(mass, rel=1e-9)
    assert 1 < study.course.kv[0] < 1.5


def test_pair_on_bearings_approaches_as_its_flanks_do() -> None:
    """Each coordinate by itself: how much nearer the flanks come, along their normal, at a point where they touch."""
    alpha = math.radians(PAIR.working_transverse_pressure_angle)
    normal = np.array([math.sin(alpha), math.cos(alpha)])
    pitch_point = np.array([PAIR.working_pitch_diameters.pinion / 2, 0.0])
    touching = pitch_point + 2.3 * normal
    ring_axis = np.array([PAIR.centre_distance, 0.0])
    assert math.dist(touching, ring_axis) > PAIR.wheel.profile.tip_diameter / 2  # inside the ring's teeth

    def turned(point: np.ndarray) -> np.ndarray:
        return np.array([-point[1], point[0]]) / 1000  # m per rad, counter-clockwise

    moves = [[1, 0], [0, 1], turned(touching), [-1, 0], [0, -1], -turned(touching - ring_axis)]
    pair = PairOnBearings(
        masses=PerGear(1.0, 4.0),
        inertias=INERTIAS,
        base_radii=PAIR.gears.map(lambda gear: gear.base_diameter / 2),
        working_transverse_pressure_angle=PAIR.working_transverse_pressure_angle,
        mesh_stiffness=400.0,
        bearing_stiffness=PerGear((300.0, 300.0), (500.0, 500.0)),
        torque=80.0,
    )
    system, roots = pair.system(), np.sqrt([1.0, 1.0, 2e-4, 4.0, 4.0, 9e-3])
    assert system.mesh[:, 0] * roots == pytest.approx([normal @ np.array(move) for move in moves], rel=1e-9)
    # In balance on the ring as well: its torque is against the pinion's.
    assert (system.load * roots)[5] == pytest.approx(-80.0 * 70 / 24, rel=1e-12)


def test_contact_model_of_a_ring_is_the_matrix_exponential_of_its_equations() -> None:
    """J phi'' + R (b phi' + k phi) = M with R = r r^T, the ring's radius negative: both speeds have one sign."""
    model = ContactModel.from_pair(PAIR, inertias=INERTIAS, pair_stiffness=300.0, damping=900.0, torque=80.0)
    model = type(model)(**{**vars(model), "zone": EngagedPairs.ONE_PAIR})
    radii, inverse = 1e-3 * np.array(model.base_radii), np.diag(1 / np.array(INERTIAS))
    coupling = inverse @ np.outer(radii, radii)
    matrix = np.zeros((5, 5))
    matrix[:2, 2:4] = np.eye(2)
    matrix[2:4, :2], matrix[2:4, 2:4] = -3e8 * coupling, -900 * coupling
    matrix[2:4, 4] = inverse @ [80, -80 * 70 / 24]
    rate = 3000 * math.pi / 30
    start = np.array([0, 0, rate, rate * 24 / 70, 1])
    history = time_history(model, 3000.0, duration=0.002, sampling=20_000.0)
    found = np.column_stack([history.pinion_speed, history.wheel_speed])
    assert found == pytest.approx(np.array([(expm(matrix * time) @ start)[2:4] for time in history.time]), rel=1e-8)
    assert history.wheel_speed.min() > 0


def test_contact_study_of_a_ring() -> None:
    """Campbell study: the tooth frequency is the pinion's, the natural frequency that of one pair by hand."""
    options = DynamicsOptions(model="contact", tooth_stiffness=250.0, speeds=3, duration=0.01, sampling=50_000.0)
    found = study_contact(PAIR, LOAD, None, INERTIAS, options)
    r_1, r_2 = (math.cos(math.radians(20)) * teeth / 1000 for teeth in (24, 70))
    expected = math.sqrt(250e6 * (r_1**2 / 2e-4 + r_2**2 / 9e-3)) / (2 * math.pi)
    assert found.model.natural_frequency() == pytest.approx(expected, rel=1e-12)
    assert found.to_dict()["contact_ratio"] == pytest.approx(PAIR.transverse_contact_ratio, rel=1e-12)


def test_a_ring_that_stands_still_leaves_the_pinion_alone() -> None:
    """With an inertia without end in the ring K_v of ISO 6336-1 knows the pinion's mass only."""
    still = DynamicsOptions(speeds=40, wheel_inertia=1e6)
    found = study_pair(PAIR, Material(), LOAD, _cycle(), PerGear(2e-4, 1e6), still)
    r_1 = math.cos(math.radians(20)) * 24 / 1000
    assert found.study.method_b is not None
    assert found.study.method_b.reduced_mass == pytest.approx(2e-4 / r_1**2 / 18.0, rel=1e-8)
    assert "free-ring" not in {notice.code for notice in found.notices}


def test_stiffness_of_rings_where_none_is_asked_for() -> None:
    helical = GearPair(pinion=replace(PAIR.pinion, helix_angle=10.0), wheel=replace(PAIR.wheel, helix_angle=10.0))
    assert [DynamicsOptions().method_for(pair) for pair in (PAIR, helical)] == ["plane-strain", "strain-energy"]


STIFFNESS_LOAD = Load(torque=50.0)


def _pair(helix: float) -> GearPair:
    return GearPair(
        pinion=Gear(teeth=24, normal_module=2.0, face_width=16.0, helix_angle=helix),
        wheel=Gear(
            teeth=-70,
            normal_module=2.0,
            face_width=16.0,
            helix_angle=helix,
            profile_shift=-0.3,
            cutter=ShaperCutter(teeth=30, tip_radius=0.2),
            body=Body(rim_diameter=170.0),
        ),
    )


def test_strain_energy_of_a_ring_is_what_its_contact_stores() -> None:
    """Away from the tips one pair's approach is its strain energy's and 1/(2 pi E*), though no pressure is solved for."""
    pair = _pair(0.0)
    energy, contact = StrainEnergy(pair=pair), plane_pair(pair, Material())
    lengths = np.linspace(*pair.usable_path, 7)[2:5]
    single = energy.single(lengths, STIFFNESS_LOAD)
    per_width = 2000 * 50 / pair.pinion.base_diameter / 16
    modulus = 206000 / (1 - 0.09) / 2
    for angle, compliance in zip(contact.roll_angle(lengths).tolist(), (1 / single.stiffness).tolist(), strict=True):
        found = contact.solve(angle, 50.0, single=True).approach - contact.rigid_approach(angle, single=True)
        assert 1000 * found / per_width == pytest.approx(compliance + 1000 / (2 * math.pi * modulus), rel=6e-4)


def test_virtual_rings_of_a_nearly_spur_ring() -> None:
    """Two spur rings of whole numbers of teeth stand for the virtual one: next to no helix, next to no difference."""
    lengths = np.linspace(*_pair(0.0).usable_path, 7)[1:-1]
    spur, helical = (StrainEnergy(pair=_pair(helix)).single(lengths, STIFFNESS_LOAD) for helix in (0.0, 0.5))
    for part in ("pinion", "wheel"):
        assert helical.parts[part] == pytest.approx(spur.parts[part], rel=2e-3)


def test_a_method_without_an_internal_form_says_why() -> None:
    found = stiffness(_pair(0.0), STIFFNESS_LOAD, methods=CLOSED_FORMS)
    assert [cycle.method for cycle in found.cycles] == ["weber-banaschek", "iso6336"]
    why = "Sainsot's elastic ring lies inside the teeth, held at its bore, not outside them"
    assert found.left_out == {"potential-energy": f"wheel.teeth = -70: must be above 0 for potential-energy: {why}"}
    flexibility = 0.04723 + 0.15551 / 24 + 0.00193 * 0.3 + 0.00182 * 0.3**2
    assert found.cycles[1].single_stiffness == pytest.approx(0.8 * 0.975 / flexibility * 16, rel=1e-12)
