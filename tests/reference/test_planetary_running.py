"""Figures 53 to 55 of the Alm thesis, as far as statics have them: shares and twist of its train and of the variant in phase.

Its multibody histories cannot be repeated (contact damping, no data of its bearings). Meshes are trapezoids of tables 4 and 5.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.sets import alm_train
from support.sharing_trains import Trapezoid

from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.quasi_static_run import Running, run_train
from gearcad.planetary import Carrier, TrainLoad

COURSES = {
    "ring_4-rim_3": Trapezoid(212.207, 354.224, 0.7206),
    "ring_5-rim_3p": Trapezoid(208.207, 356.886, 0.622),
    "pre_stage": Trapezoid(121.070, 214.695, 0.573),
}
"""Least and greatest stiffness as printed; two pairs for as long as the mean asks for."""

SECONDS = 3600
"""Arc seconds in a degree."""


@cache
def run(in_phase: bool, carrier: float | None, ring: float | None) -> Running:
    """With stiffnesses (N/µm) of the bearings of carrier and ring 5, None held; pins of 1e7 N/mm."""
    train = alm_train(in_phase=in_phase, carrier=Carrier(support_stiffness=carrier, pin_stiffness=1e4))
    fourth, fifth = train.centrals
    train = replace(train, centrals=(fourth, replace(fifth, support_stiffness=ring)))
    return run_train(train, TrainLoad(torque=1600.0, speed=955.0), COURSES, steps=64)


def test_figure_53_planets_out_of_phase_share_unevenly_at_mesh_frequency() -> None:
    found = run(False, None, None)
    assert (found.shares.min(), found.shares.max()) == pytest.approx((0.837, 1.081), abs=0.0006)
    assert found.mesh_load_factor == found.shares.max()


def test_figure_54_planets_in_phase_share_evenly() -> None:
    assert np.abs(run(True, None, None).shares - 1).max() < 3e-5


@pytest.mark.parametrize(("in_phase", "percent"), [(False, 14.07), (True, 18.76)])
def test_a_floating_carrier_leaves_the_wave_of_the_stage_only(in_phase: bool, percent: float) -> None:
    found = run(in_phase, 0.0, 100.0)
    assert found.mesh_share_ripple < 1e-9
    assert 100 * (found.shares.max() - 1) == pytest.approx(percent, abs=0.05)
    assert 100 * (1 - found.shares.min()) == pytest.approx(percent, abs=0.05)
    # Synchronous with the carrier: planets carry most a third of its turn after each other.
    most = found.carrier_angle[found.shares.argmax(axis=1)]
    assert np.sort(np.mod(most - most[0], 360)) == pytest.approx([0, 120, 240], abs=0.2)


@pytest.mark.parametrize("ring", [1000.0, 1.0])
def test_the_slow_part_is_what_sharing_has_with_mean_compliances(ring: float) -> None:
    """7.7 % and 0.09 % here; 7.9 % with the means of the stiffnesses as printed."""
    found = run(False, 100.0, ring)
    places = np.linspace(0, 1, 100001)
    mean = {name: 1 / np.mean(1 / each.stiffness_at(places)) for name, each in COURSES.items()}
    still = share_load(found.train, TrainLoad(torque=1600.0), mean)
    assert found.slow_shares.max(axis=1) == pytest.approx(still.greatest_shares, abs=1e-6)
    assert found.slow_shares.min(axis=1) == pytest.approx(still.least_shares, abs=1e-6)


@pytest.mark.parametrize(
    ("in_phase", "carrier", "ring", "seconds"),
    [(False, None, None, 34.67), (True, None, None, 48.25), (False, 0.0, 100.0, 38.03), (True, 0.0, 100.0, 49.09)],
)
def test_planets_in_phase_make_more_ripple_of_the_twist(
    in_phase: bool, carrier: float | None, ring: float | None, seconds: float
) -> None:
    """Peak to peak, by an own dense computation in 6,000 steps of a quarter turn; the other way round than the shares."""
    assert SECONDS * run(in_phase, carrier, ring).mesh_ripple == pytest.approx(seconds, abs=0.05)


def test_the_greatest_ripple_is_that_of_all_meshes_together() -> None:
    """In phase, held: all planets go from one pair to two at once; both meshes and the stage meet sooner or later."""
    found = run(True, None, None)
    forces = {name: force[0] for name, force in found.forces.items()}
    work = sum(
        3 * forces[name].mean() ** 2 * (1 / each.least - 1 / each.most) for name, each in COURSES.items() if name in forces
    )
    stage = COURSES["pre_stage"]
    work += 1248.518**2 * (1 / stage.least - 1 / stage.most)
    assert found.mesh_ripple == pytest.approx(np.degrees(work / 1600e6), rel=1e-3)
