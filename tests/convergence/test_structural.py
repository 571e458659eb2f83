"""Rates at which the finite elements and the cells converge, and the hybrid against brute force on the same bodies.

The pair is that of the Alm thesis, z 18/161, m 1.5, 12.7 N·m on 10 mm.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from support.brute import nodal_compliance

import gearcad.contact.plane.pair as flexible_pairs
from gearcad import Gear, GearPair, Material
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.flank import flank_compliance
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel, Cuts
from gearcad.meshing.outline import MeshSizes
from gearcad.meshing.sector import mesh_sector

TORQUE = 12.7
THREE_TEETH = BodyModel(teeth=3)
SHORTENED = -0.0104


def thesis_pair() -> GearPair:
    return GearPair(
        pinion=Gear(teeth=18, normal_module=1.5, face_width=10, profile_shift=0.3422, tip_alteration=SHORTENED),
        wheel=Gear(teeth=161, normal_module=1.5, face_width=10, profile_shift=0.1682, tip_alteration=SHORTENED),
        centre_distance=135.0,
    )


def cycle(
    body: BodyModel, positions: int, sizes: MeshSizes | None = None, solve: Callable[..., Any] = flank_compliance
) -> PlaneCycle:
    model = plane_pair(thesis_pair(), Material(), body=body, sizes=sizes, solve=solve)
    return PlaneCycle.run(model, TORQUE, positions)


class Figures(NamedTuple):
    """Mean stiffness (N/(mm·µm)), greatest root tension and compression of both gears (MPa), range of the approach (mm)."""

    stiffness: float
    tension: tuple[float, float]
    compression: tuple[float, float]
    error: float


def figures(of: PlaneCycle) -> Figures:
    tension = [max(position.tension[gear].stress for position in of.positions) for gear in (0, 1)]
    compression = [min(position.compression[gear].stress for position in of.positions) for gear in (0, 1)]
    return Figures(
        float(of.values("stiffness").mean()),
        (tension[0], tension[1]),
        (compression[0], compression[1]),
        float(np.ptp(of.values("approach"))),
    )


def brute_sizes(flank: float) -> MeshSizes:
    """Flank edges in modules; all else as the hybrid has it."""
    return replace(MeshSizes(), flank=flank, corner=min(flank, MeshSizes().corner))


def assert_agree(hybrid: PlaneCycle, brute: PlaneCycle, *, stiffness: float, root: float, error: float) -> None:
    """Mean stiffness, root stress of both gears on both sides, and the transmission error's range."""
    one, other = figures(hybrid), figures(brute)
    assert one.stiffness == pytest.approx(other.stiffness, rel=stiffness)
    assert one.tension == pytest.approx(other.tension, rel=root)
    assert one.compression == pytest.approx(other.compression, rel=2 * root)
    assert one.error == pytest.approx(other.error, rel=error)


@pytest.mark.long
@pytest.mark.parametrize("body", [BodyModel(), THREE_TEETH], ids=["full rings", "3 teeth"])
def test_hybrid_is_the_converged_brute_force(body: BodyModel) -> None:
    """Flank edges of 8 µm, a ninth of the half width: 0.1 % of stiffness, 0.5 % of root stress and of transmission error.

    Position by position too, where no corner touches: there both depend on the mesh of the corner.
    """
    hybrid, brute = cycle(body, 24), cycle(body, 24, brute_sizes(0.0053), nodal_compliance)
    assert_agree(hybrid, brute, stiffness=1e-3, root=5e-3, error=5e-3)
    inside = [
        [
            (one.approach, one.tension[0].stress, one.tension[1].stress),
            (other.approach, *(each.stress for each in other.tension)),
        ]
        for one, other in zip(hybrid.positions, brute.positions, strict=True)
        if all(contact.interior for contact in one.contacts)
    ]
    assert len(inside) > 10
    ours, theirs = np.array(inside).transpose(1, 0, 2)
    assert ours[:, 0] == pytest.approx(theirs[:, 0], rel=1.5e-3)
    assert ours[:, 1:] == pytest.approx(theirs[:, 1:], rel=3e-3)


@pytest.mark.long
def test_hybrid_is_near_a_coarser_brute_force() -> None:
    """Flank edges of 18 µm, a quarter of the half width: it is itself 0.3 % off in stiffness, 0.5 % in the range."""
    assert_agree(
        cycle(THREE_TEETH, 8),
        cycle(THREE_TEETH, 8, brute_sizes(0.012), nodal_compliance),
        stiffness=5e-3,
        root=1e-2,
        error=1.5e-2,
    )


# Orders of the finite elements


@cache
def refined(factor: float) -> tuple[float, float, float]:
    found = figures(cycle(THREE_TEETH, 6, MeshSizes().refined(factor)))
    return found.stiffness, *found.tension


def test_default_mesh_is_within_its_error_of_a_very_fine_one() -> None:
    """Against four times finer edges: 0.05 % of stiffness, 0.3 % of root stress; twice as coarse, three times that."""
    coarse, default, finest = (np.array(refined(factor)) for factor in (0.5, 1.0, 4.0))
    assert np.abs(default / finest - 1) == pytest.approx(0, abs=3e-3)
    assert default[0] == pytest.approx(finest[0], rel=5e-4)
    assert np.abs(coarse / finest - 1) == pytest.approx(0, abs=9e-3)


def test_stiffness_converges() -> None:
    """Four times finer edges leave less than a third of the error, which is 0.04 % on the coarsest mesh."""
    finest = refined(4.0)[0]
    errors = [abs(refined(factor)[0] / finest - 1) for factor in (0.5, 2.0)]
    assert errors[1] < errors[0] / 3
    assert errors[0] < 1e-3


def across(sizes: MeshSizes) -> float:
    """How one flank of z 18 moves under a load in the middle of the next: nothing is taken off, nothing singular is near."""
    gear = thesis_pair().pinion
    radius = gear.root_diameter / 2 - 4 * gear.normal_module
    steel = PlaneElasticity(Material())
    fine = mesh_sector(gear, radius, sizes)
    body = flank_compliance(gear, assemble(fine, fine, gear.teeth, 1, steel, 3, Cuts.FIXED), steel)
    place = np.array([6.2])
    return float(body.response(1)(place, place)[0, 0])


def test_order_of_a_compliance() -> None:
    """Edges halved twice, against eight times finer ones: order 2.3 on average, 2 expected.

    Quadratic elements have order 4 where the solution is smooth; the clamped corners of cuts and hub leave about 2.
    """
    edges = MeshSizes(flank=0.4, corner=0.2, fillet=0.3, outline=0.5, cut=0.4, rim=1.5)
    values = np.array([across(edges.refined(factor)) for factor in (1, 2, 4, 8)])
    errors = np.abs(values[:3] / values[3] - 1)
    assert np.log2(errors[0] / errors[2]) / 2 > 1.8
    assert errors[2] < 5e-4


# Cells of contact


def test_cells_of_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    """The approach where no corner touches: half the width leaves about a quarter of the error, 0.006 % with the default."""
    model = plane_pair(thesis_pair(), Material(), body=THREE_TEETH)
    approaches = []
    for cells in (33, 66, 132, 264):
        monkeypatch.setattr(flexible_pairs, "_CELLS", cells)
        model.known.clear()
        approaches.append([model.solve(angle, TORQUE).approach for angle in (-8.0, 2.0, 4.0)])
    errors = np.abs(np.array(approaches[:3]) / approaches[3] - 1).max(axis=1)
    assert errors[1] < 1e-4
    assert np.log2(errors[0] / errors[2]) / 2 > 1.2
