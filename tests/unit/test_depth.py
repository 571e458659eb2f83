"""Stresses below line contacts against Johnson's figures, hardness over depth, and the material exposure below flanks."""

import numpy as np
import pytest

from gearcad.check.depth import C_1, MaterialExposure, _Contact, exposure_of
from gearcad.contact.plane.cycle import strip_stresses
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.hardness_depth import HardnessProfile, depth_points, depth_profile_of
from gearcad.material import Material
from gearcad.rating.subsurface import PlaneStresses, below_line_contact, largest_shear

FIGURES = 1e-4
"""Digits of K. L. Johnson, Contact Mechanics, 4.2.3: 0.30 p_0 at 0.78 a and others, here with more digits."""

LIKE_HERTZ = 2e-4
"""400 strips under an ellipse against the ellipse itself."""


def by_strips(x: np.ndarray, z: np.ndarray) -> PlaneStresses:
    """Stresses below 400 strips that are as high as the ellipse in their middles."""
    edges = np.linspace(-1.0, 1.0, 401)
    middles = (edges[1:] + edges[:-1]) / 2
    return PlaneStresses(*strip_stresses(x, z, middles, 1 / 200, np.sqrt(1 - middles**2)))


@pytest.mark.parametrize("below", [below_line_contact, by_strips])
def test_figures_of_a_line_contact(below: object) -> None:
    z = np.linspace(0.3, 1.2, 9001)
    stresses = below(np.zeros_like(z), z)
    shear = (stresses.across - stresses.down) / 2
    along = 0.3 * (stresses.across + stresses.down)
    mises = np.sqrt(
        ((stresses.across - stresses.down) ** 2 + (stresses.down - along) ** 2 + (along - stresses.across) ** 2) / 2
        + 3 * stresses.shear**2
    )
    for found, value, depth in ((shear, 0.3003, 0.7861), (mises, 0.5575, 0.7042)):
        assert found.max() == pytest.approx(value, abs=FIGURES)
        assert z[found.argmax()] == pytest.approx(depth, abs=2e-3)  # flat at the top
    x, deep = np.meshgrid(np.linspace(0.6, 1.1, 251), np.linspace(0.4, 0.6, 101), indexing="ij")
    orthogonal = np.abs(below(x, deep).shear)
    at = np.unravel_index(orthogonal.argmax(), orthogonal.shape)
    assert orthogonal[at] == pytest.approx(0.25, abs=FIGURES)
    assert (x[at], deep[at]) == pytest.approx((0.866, 0.5), abs=6e-3)


def test_closed_form_is_the_sum_of_strips() -> None:
    rng = np.random.default_rng(7)
    x, z = rng.uniform(-2, 2, 200), rng.uniform(0.1, 3, 200)
    for closed, summed in zip(below_line_contact(x, z), by_strips(x, z), strict=True):
        assert closed == pytest.approx(summed, abs=LIKE_HERTZ)


def test_forces_balance_at_any_depth() -> None:
    """The stress down, over a wide line at a depth, adds up to the load: pi/2 in half widths and p_0."""
    x = np.tan(np.linspace(-1.0, 1.0, 200001) * (np.pi / 2 - 1e-4))
    for depth in (0.2, 1.0, 5.0):
        down = below_line_contact(x, np.full_like(x, depth)).down
        assert -np.trapezoid(down, x) == pytest.approx(np.pi / 2, rel=1e-6)


def even(hardness: float, scale: float = 1.0, **others: object) -> HardnessProfile:
    values: dict[str, object] = {"points": ((0.0, hardness), (2.0 * scale, hardness)), "residual": ()}
    values |= {"law": "points", "surface": 0.0, "core": 0.0, "case_depth": 0.0, "ratio": 0.4, "assumed": True}
    return HardnessProfile(**(values | others))


def passing(profile: HardnessProfile, scale: float = 1.0) -> MaterialExposure:
    contacts = [_Contact(place * scale, 1200.0, 0.2 * scale, None) for place in (8.0, 9.0, 10.0)]
    return exposure_of(Role.PINION, profile, contacts, 0.3)


def test_even_hardness_is_most_exposed_where_shear_is_largest() -> None:
    found = passing(even(600.0))
    assert found.worst == pytest.approx(0.30028 / 2 * 1200 / (0.4 * 600), rel=1e-3)
    assert found.worst_depth == pytest.approx(0.7861 * 0.2, rel=0.06)  # as far apart as the depths
    # From the half width down the stress falls: 1/sqrt(2) p_0 down, (3/sqrt(2) - 2) p_0 across.
    shear = (1 / np.sqrt(2) - (3 / np.sqrt(2) - 2)) / 2
    assert found.line_contact == pytest.approx(shear / 2 * 1200 / 240 + C_1, rel=1e-6)
    assert found.line_depth == pytest.approx(0.2, rel=1e-9)


def test_exposure_scales_with_the_gears() -> None:
    points = ((0.0, 700.0), (0.5, 650.0), (1.0, 550.0), (2.0, 400.0))
    one = passing(even(0.0, points=points, residual=((0.0, -300.0), (1.0, 0.0))))
    scaled = tuple((3 * depth, value) for depth, value in points)
    three = passing(even(0.0, points=scaled, residual=((0.0, -300.0), (3.0, 0.0))), 3.0)
    assert three.worst == pytest.approx(one.worst, rel=1e-9)
    assert three.worst_depth == pytest.approx(3 * one.worst_depth, rel=1e-9)
    assert three.exposure == pytest.approx(one.exposure, rel=1e-9, nan_ok=True)
    assert three.line_contact == pytest.approx(one.line_contact, rel=1e-9)


def test_compression_along_the_surface_relieves() -> None:
    """Down is the greatest compression there: 100 MPa along the surface take 50 MPa of the largest shear stress under load, and
    leave 50 MPa without: half of both is missing in the amplitude.
    """
    plain, pressed = (passing(even(600.0, residual=residual)) for residual in ((), ((0.0, -100.0), (9.0, -100.0))))
    at = int(np.argmin(np.abs(plain.depths - 0.2)))
    assert plain.shear[at] - pressed.shear[at] == pytest.approx((50 + 50) / 2, rel=1e-6)


def test_lang_has_surface_case_depth_and_core() -> None:
    profile = depth_profile_of(Material(hardness=720.0, case_core_hardness=380.0, case_depth=0.8))
    assert profile is not None
    assert profile.hardness(np.array([0.0, 0.8, 50.0])) == pytest.approx([720.0, 550.0, 380.0], rel=1e-12)
    assert (np.diff(profile.hardness(np.linspace(0, 3, 50))) < 0).all()
    assert profile.unconfirmed == ("K_tau", "hardness over depth by Lang")
    assert depth_profile_of(Material()) is None


def test_points_of_a_cell_and_bad_ones() -> None:
    assert depth_points("hardness_profile", "0:700 1,5:400", 50, 1500, "HV") == ((0.0, 700.0), (1.5, 400.0))
    for bad in ("0:700", [[0.0, 700.0]], [[0.0, 700.0], [0.0, 600.0]], [[0.0, 7.0], [1.0, 600.0]], [[0.0], [1.0]], 3.0):
        with pytest.raises(ParameterError, match="hardness_profile"):
            depth_points("hardness_profile", bad, 50, 1500, "HV")
    for material in (Material(case_depth=1.0, hardness=700.0), Material(case_depth=1.0, case_core_hardness=350.0)):
        with pytest.raises(ParameterError, match="must be given with case_depth"):
            depth_profile_of(material)


def test_largest_shear_stress_counts_the_third_direction() -> None:
    pressed = PlaneStresses(np.array(-300.0), np.array(-300.0), np.array(0.0))
    assert largest_shear(pressed, np.array(0.0)) == pytest.approx(150.0)
