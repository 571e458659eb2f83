"""The pair that started this project, z 13/44, 28 degrees, as solid bodies: the Volvo/Chalmers thesis and its analysis.

The thesis (2017) found 690 to 694 N·m at the wheel where 744.6 are due, a loss of 7 %; a root stress of 250 MPa at 120 N·m, so
about 460 at 220, by a coarse mesh of a few tooth sectors; and von Mises stress of some 1000 MPa at the contact, about half of
what its own formulas gave.
"""

from __future__ import annotations

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from gearcad import Material
from gearcad.contact.shared.bodies import BodyModel, Cuts
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidSizes, solid_pair
from gearcad.core.records import PerGear
from gearcad.designs import read_spec
from gearcad.designs.reader import starter_text
from gearcad.rating import rate

pytestmark = pytest.mark.long

TORQUE = 220.0
STEEL = Material(youngs_modulus=205e3)


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory):  # type: ignore[no-untyped-def]
    spec = tmp_path_factory.mktemp("volvo") / "volvo-13-44.toml"
    spec.write_text(starter_text("volvo")[1], encoding="utf-8")
    return read_spec(spec)


def cycle_of(pair, body: BodyModel, sizes: SolidSizes | None = None) -> SolidCycle:  # type: ignore[no-untyped-def]
    with threadpool_limits(1):
        return SolidCycle.run(solid_pair(pair, STEEL, body=body, sizes=sizes), TORQUE, 24)


@pytest.fixture(scope="module")
def whole(pair) -> SolidCycle:  # type: ignore[no-untyped-def]
    return cycle_of(pair.pair, BodyModel())


def test_reactions_are_the_torques(whole: SolidCycle) -> None:
    """220 and 744.6 N·m at every position within 0.5 %."""
    for position in whole.positions:
        assert position.torques == pytest.approx((TORQUE, TORQUE * 44 / 13), rel=0.005)


def test_figures_beside_iso_6336(pair, whole: SolidCycle) -> None:  # type: ignore[no-untyped-def]
    """Softer than ISO's discs for the deep rings (14 m_n below the wheel's teeth); pressure and root stress near its values
    on the width that carries. The bands are what the reasons of the report explain."""
    rating = rate(pair.pair, STEEL, pair.load)
    stiffness = whole.values("stiffness")
    assert stiffness.mean() == pytest.approx(0.755 * rating.stiffness.mesh_alpha, rel=0.03)
    assert whole.model.single_stiffness(TORQUE) == pytest.approx(0.785 * rating.stiffness.single, rel=0.03)
    on_common_width = [
        stress * width / whole.model.width for stress, width in zip(rating.root_stresses, (18.3, 15.1), strict=True)
    ]
    for role, nominal in PerGear(*on_common_width).items():
        stress = max(position.tension.pick(role).stress for position in whole.positions)
        assert stress == pytest.approx(nominal * whole.root_face_load_factor(role), rel=0.08)
    pitch = next(contact for contact in whole.positions[12].contacts if contact.tooth == 0)
    middle = int(np.argmin(np.abs(pitch.line.across)))
    assert pitch.pressures[middle] == pytest.approx(1930, rel=0.02)


def test_rings_of_four_modules(pair) -> None:  # type: ignore[no-untyped-def]
    """ISO's stiffness is that of usual bodies: with 4 m_n below the teeth it is met within 12 %.

    The trials of the method had 14.64 N/(mm·µm) there, with neither finer meshes nor tip edges that touch.
    """
    inner = pair.pair.gears.map(lambda gear: gear.root_diameter - 8 * gear.normal_module)
    found = cycle_of(pair.pair, BodyModel(inner_diameters=inner)).values("stiffness").mean()
    assert found == pytest.approx(14.35, rel=0.12)


def test_meshes_of_twice_the_dofs(pair) -> None:  # type: ignore[no-untyped-def]
    """c_gamma changes by under 0.5 %, root stress by under 2 %, on three-tooth sectors."""
    inner = pair.pair.gears.map(lambda gear: gear.root_diameter - 4 * gear.normal_module)
    body = BodyModel(teeth=3, cuts=Cuts.FREE, inner_diameters=inner)
    one, other = (cycle_of(pair.pair, body, SolidSizes().refined(factor)) for factor in (1.0, 1.26))
    assert other.values("stiffness").mean() == pytest.approx(one.values("stiffness").mean(), rel=0.005)
    for gear in (0, 1):
        stresses = [max(position.tension[gear].stress for position in cycle.positions) for cycle in (one, other)]
        assert stresses[1] == pytest.approx(stresses[0], rel=0.02)
