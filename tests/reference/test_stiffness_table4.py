"""What the finite element rows of table 4 of the Alm thesis hold: `Strain Energy`, `FEM Plane Stress`, `FEM Plane Strain`.

Pair: m_n 1.5 mm, z 18/161, x 0.3422/0.1682, b 15/10 mm, a = 135 mm, 12.7 N·m on the pinion. One set of conditions,
found among those that the text leaves open and not fitted, gives all nine figures within 1.0 % (positions 1° apart, there 2°):

- three teeth of each gear between fixed cuts: "only the teeth in mesh and their neighbours", held "on the inside and where the
  teeth end" (4.3.2). The depth of the bodies is not given: 4 m_n below the root circle is what gearcad takes where there is no
  bore. 3.5 m_n is within 1.6 % as well, the bores of 12 and 120 mm within 2.8 %;
- the plane elements as thick as each gear is wide: the pinion 15 mm, the wheel 10 mm, though they touch on 10 mm only;
- the mean over the path of contact, which counts double contact twice, and not over a base pitch;
- strain energy: in plane strain (4.3.3; 6.1 says plane stress, which is 8 to 9 % softer), the pressure even over the width that
  Hertz gives for 10 mm of face, pairs of teeth as springs that know nothing of each other.

The ratio of the two FE rows, which no common factor can change, is met within 0.002. The least figure stands where single
contact begins and stiffness jumps: 2° apart it is 196 to 203 N/µm in plane stress, with where one starts; the thesis has 200.
Section 6.1's contacts that come out too wide are not needed.

From whole bodies of 10 mm, three teeth make the mean 46 % stiffer, the wider pinion another 19 %, the path 6 %. Not decided by
numbers alone: with both gears 10 mm wide, held 0.5 and 2 m_n below the root circles, the rows are within 2.5 % too, but then
plane strain is 7.8 % above plane stress, where the thesis has 8.9 %. With both 15 mm wide, all is 22 to 25 % too stiff.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from support.cases import THESIS_LOAD, thesis_pair
from support.published import Published
from thesis_conditions import (
    AS_WIDE,
    COMMON,
    PAIR,
    POSITIONS,
    STEEL,
    THREE,
    WHOLE,
    WIDEST,
    EvenPressureInPlaneStress,
    OfWidths,
    bodies,
    cycle,
    path_mean,
    row,
    three_teeth,
)

from gearcad.contact.plane.pair import PlanePair
from gearcad.contact.plane.sector import Plane
from gearcad.contact.shared.bodies import BodyModel, Cuts
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.core.records import PerGear
from gearcad.stiffness import METHODS, PlaneStrainContact, PlaneStressContact, SolidContact
from gearcad.stiffness.finite_elements import PlaneContact

ROW = 0.011
"""Relative, mean, greatest and smallest: the conditions above meet the rows within 1.0 %."""

RATIO = 0.0025
"""Plane strain over plane stress, mean, greatest and smallest."""

RECORDED = 0.002
"""Relative: what was recorded to four digits, over 20 positions of a base pitch instead of 120."""

PRINTED = {
    "strain-energy": (357.98, 414.62, 218.32),
    "plane-stress": (304.74, 344.36, 199.68),
    "plane-strain": (331.77, 375.32, 217.92),
}
"""N/µm: mean, greatest, smallest."""


def test_the_pair_of_the_manual_is_that_of_the_references() -> None:
    assert thesis_pair() == PAIR


@pytest.mark.parametrize("method", PRINTED)
def test_row(method: str, published: Published) -> None:
    source = "Alm, master's thesis, table 4, finite elements under its conditions: three teeth, pinion of 15 mm, over the path"
    for quantity, found, printed in zip(("mean", "greatest", "smallest"), row(cycle(method)), PRINTED[method], strict=True):
        published(f"{quantity}, N/µm", found, f"{printed:.2f}", ROW * printed, source, method)


def strain_over_stress(strain: Sequence[float], stress: Sequence[float]) -> list[float]:
    return [one / other for one, other in zip(strain, stress, strict=True)]


def test_plane_strain_over_plane_stress() -> None:
    """No common factor on stiffness or width can give it: it tells deep narrow bodies from shallow ones."""
    printed = strain_over_stress(PRINTED["plane-strain"], PRINTED["plane-stress"])
    assert printed == pytest.approx([1.0887, 1.0899, 1.0914], abs=1e-4)
    found = strain_over_stress(row(cycle("plane-strain")), row(cycle("plane-stress")))
    assert found == pytest.approx(printed, abs=RATIO)


def test_strain_energy_was_taken_in_plane_strain() -> None:
    """Section 4.3.3 says so, 6.1 says plane stress."""
    stress = EvenPressureInPlaneStress(pair=PAIR, material=STEEL, body=THREE, widths=AS_WIDE)(THESIS_LOAD)
    against = [found / printed - 1 for found, printed in zip(row(stress), PRINTED["strain-energy"], strict=True)]
    assert against == pytest.approx([-0.080, -0.084, -0.093], abs=0.002)


@pytest.mark.parametrize("roll_angle", [-3.0, 0.0, 2.0, 6.0])
def test_contact_of_one_pair_is_its_strain_energy_and_the_gaps_that_close(roll_angle: float) -> None:
    """Two ways through the elements: the approach is the displacement under the pressure, weighted with it, and a²/(8 rho).

    Hertz's parabola of gaps under his ellipse; a²/(8 rho) = F/(2 pi E*), 2.4 % of the compliance. Near the pinion's root, where
    the flank's curvature changes within the contact, 0.03 % are left.
    """
    pinion, wheel = bodies(Plane.STRAIN, THREE, COMMON)
    model = PlanePair(PAIR, line_of_action(PAIR, 0.0), PerGear(pinion, wheel))
    pressed = model.solve(roll_angle, THESIS_LOAD.torque, single=True).approach / model.force(THESIS_LOAD.torque)
    energy = OfWidths(pair=PAIR, material=STEEL, body=THREE)
    stored = 1 / energy.single(np.array([model.roll_length(roll_angle)]), THESIS_LOAD).stiffness[0] / 1000
    assert pressed == pytest.approx(stored + 1 / (2 * math.pi * model.modulus), rel=5e-4)


# ------------------------------------------------------------------ what is not decided, and the page's own numbers


STEPS = {
    "strain-energy": [210.2, 276.9, 332.7, 359.4],
    "plane-stress": [167.4, 244.4, 290.7, 307.5],
    "plane-strain": [179.1, 265.5, 316.1, 334.4],
}
"""N/µm: whole bodies, 10 mm wide; three teeth; the pinion 15 mm wide; mean over the path."""


@pytest.mark.long
@pytest.mark.parametrize("method", STEPS)
def test_what_each_condition_is_worth(method: str) -> None:
    whole, three, wider = (cycle(method, *model) for model in ((WHOLE, COMMON), (THREE, COMMON), (THREE, AS_WIDE)))
    assert [whole.mean, three.mean, wider.mean, path_mean(wider)] == pytest.approx(STEPS[method], abs=0.06)


@pytest.mark.long
@pytest.mark.parametrize(("bore", "mean"), [(60.0, 145.5), (200.0, 203.2)])
def test_bore_of_the_wheel(bore: float, mean: float) -> None:
    """Not in the thesis, and worth more than the choice among the better methods."""
    found = cycle("plane-strain", BodyModel(inner_diameters=PerGear(12.0, bore)), COMMON)
    assert found.mean == pytest.approx(mean, rel=RECORDED)


@pytest.mark.long
@pytest.mark.parametrize(
    ("body", "within"),
    [(three_teeth(3.5, 3.5), 0.017), (BodyModel(teeth=3, cuts=Cuts.FIXED, inner_diameters=PerGear(12.0, 120.0)), 0.028)],
    ids=["3.5 m_n", "bores"],
)
@pytest.mark.parametrize("method", PRINTED)
def test_depth_of_the_bodies(method: str, body: BodyModel, within: float) -> None:
    assert row(cycle(method, body)) == pytest.approx(PRINTED[method], rel=within)


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "between"), [(PlaneStressContact, (196.2, 202.7)), (PlaneStrainContact, (214.1, 221.2))], ids=["stress", "strain"]
)
def test_least_stiffness_2_degrees_apart(kind: type[PlaneContact], between: tuple[float, float]) -> None:
    """It depends on where one starts; the printed figure is one of those."""
    model = PlanePair(PAIR, line_of_action(PAIR, 0.0), bodies(kind.plane, THREE, AS_WIDE))
    fine = kind(pair=PAIR, material=STEEL, body=THREE, bodies=model, positions=120)(THESIS_LOAD).mesh_stiffness[:-1]
    least = [float(fine[start::12].min()) for start in range(12)]
    assert (min(least), max(least)) == pytest.approx(between, rel=RECORDED)
    assert min(least) < PRINTED[kind.name][2] < max(least)


@pytest.mark.long
def test_what_is_left_of_another_explanation() -> None:
    """Both gears 10 mm wide, the bodies cut close below the roots: the rows are near as well, their ratio is not."""
    shallow = three_teeth(0.5, 2.0)
    stress, strain = (row(cycle(method, shallow, COMMON)) for method in ("plane-stress", "plane-strain"))
    assert stress == pytest.approx(PRINTED["plane-stress"], rel=0.025)
    assert strain == pytest.approx(PRINTED["plane-strain"], rel=0.025)
    assert strain_over_stress(strain, stress) == pytest.approx([1.078, 1.079, 1.082], abs=0.001)


@pytest.mark.long
@pytest.mark.parametrize("method", ["plane-stress", "plane-strain"])
def test_both_gears_15_mm_wide_are_too_stiff(method: str) -> None:
    too_stiff = np.array(row(cycle(method, THREE, WIDEST))) / PRINTED[method]
    assert too_stiff == pytest.approx([1.240, 1.220, 1.252], abs=0.004)


PAGE = {
    # N/µm: mean, greatest, smallest, tangent mean
    "potential-energy": (209.0, 258.8, 140.7, 209.0),
    "weber-banaschek": (245.9, 304.6, 164.2, 257.3),
    "strain-energy": (208.0, 259.4, 138.4, 212.0),
    "plane-stress": (167.4, 187.5, 129.2, 175.9),
    "plane-strain": (179.1, 200.5, 139.0, 188.1),
    "3d": (189.5, 211.7, 143.4, 199.9),
    "iso6336": (175.6, 175.6, 175.6, 206.6),
}
"""The table of gearcad/stiffness/README.md: whole bodies held in bores of 12 and 120 mm."""


@pytest.mark.long
@pytest.mark.parametrize("method", PAGE)
def test_the_page(method: str) -> None:
    of = METHODS[method](pair=PAIR, material=STEEL)(THESIS_LOAD)
    assert [of.mean, of.maximum, of.minimum, of.tangent_mean] == pytest.approx(PAGE[method], abs=0.06)


@pytest.mark.long
def test_unloaded_width_of_the_pinion_in_solid_bodies() -> None:
    """The 5 mm that carry nothing stiffen the mesh by 9 %, not by 19 %; without them the plane states enclose it."""
    narrow = replace(PAIR, pinion=replace(PAIR.pinion, face_width=10.0))
    found = SolidContact(pair=narrow, material=STEEL, positions=POSITIONS)(THESIS_LOAD).mean
    assert found == pytest.approx(174.1, rel=RECORDED)
    assert PAGE["plane-stress"][0] < found < PAGE["plane-strain"][0]
