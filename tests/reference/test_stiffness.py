"""Mesh stiffness in closed form against independent values, and against the two programs printed in the Alm thesis."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from alm_listings import BASE_PITCH, Correction, Floats, base_pitch_mean, over_base_pitch, over_path, path, tian, weber
from support.cases import THESIS_LOAD, stiffness_case, thesis_pair
from support.published import Published

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.contact.shared.bodies import BodyModel
from gearcad.core.records import PerGear, Role
from gearcad.rating.tooth_stiffness import mesh_stiffness_alpha, mesh_stiffness_beta
from gearcad.stiffness import MethodB, PotentialEnergy, WeberBanaschek
from gearcad.stiffness.methods import compare_methods

COMPONENT, MEAN = 1e-7, 1e-4
"""Relative, as the reference states them: compliances at a position, mean, greatest and least of the mesh."""

JUMPS = 1e-3
"""Relative: where the stiffness jumps between two of 2,001 places of a path."""

STEEL = Material()
POSITIONS: list[dict[str, Any]] = stiffness_case("s000_12_components")["verified"]["positions"]


@pytest.mark.parametrize("place", range(5))
@pytest.mark.parametrize(("role", "key"), [(Role.PINION, "gear1"), (Role.WHEEL, "gear2")])
def test_compliances_of_a_tooth(place: int, role: Role, key: str) -> None:
    expected = POSITIONS[place][key]
    at = np.array([POSITIONS[place]["s1"]])
    energy, weber = (method(pair=thesis_pair(), material=STEEL) for method in (PotentialEnergy, WeberBanaschek))
    load = energy.teeth.pick(role).load_at(energy.curvatures(at).pick(role))
    assert load.x[0] == pytest.approx(expected["x_c"], rel=1e-12)
    assert load.h[0] == pytest.approx(expected["h_c"], rel=1e-11)
    assert load.angle[0] == pytest.approx(expected["load_angle_rad"], rel=1e-9)
    parts = {name: part[0] / 10 for name, part in energy.tooth_parts(role, load).items()}  # 10 mm wide
    for name, symbol in (("bending", "inv_kb"), ("shear", "inv_ks"), ("axial", "inv_ka")):
        assert parts[name] == pytest.approx(expected["fillet"][symbol], rel=COMPONENT)
    assert parts["foundation"] == pytest.approx(expected["sainsot"]["inv_kf"], rel=COMPONENT)
    beam = {name: part[0] / 10 for name, part in weber.tooth_parts(role, load).items()}
    assert beam["bending"] + beam["shear"] + beam["axial"] == pytest.approx(expected["WB_root"]["w_bend_per_N"], rel=COMPONENT)
    assert beam["foundation"] == pytest.approx(expected["WB_root"]["w_found_per_N"], rel=COMPONENT)


@pytest.mark.parametrize("place", range(5))
def test_compliance_of_a_contact(place: int) -> None:
    at, expected = np.array([POSITIONS[place]["s1"]]), POSITIONS[place]["WB_hertz"]["w_per_N"]
    weber = WeberBanaschek(pair=thesis_pair()).single(at, THESIS_LOAD)
    assert weber.parts["contact"][0] / 1e4 == pytest.approx(expected, rel=COMPONENT)  # mm·µm/N per 10 mm
    energy = PotentialEnergy(pair=thesis_pair()).single(at, THESIS_LOAD)
    whatever_load = stiffness_case("s000_12_components")["verified"]["inv_kh"]
    assert energy.parts["contact"][0] / 1e4 == pytest.approx(whatever_load, rel=COMPONENT)


@pytest.mark.parametrize(("method", "key"), [(PotentialEnergy, "fillet+sainsot"), (WeberBanaschek, "WB_root")])
def test_mesh(method: Any, key: str) -> None:
    expected = stiffness_case("s000_12_mesh")["verified"][key]
    cycle = method(pair=thesis_pair(), material=STEEL)(THESIS_LOAD)
    assert 1000 * cycle.mean == pytest.approx(expected["mean"], rel=MEAN)
    assert 1000 * cycle.maximum == pytest.approx(expected["max"], rel=MEAN)
    assert 1000 * cycle.minimum == pytest.approx(expected["min"], rel=MEAN)
    assert 1000 * cycle.pitch_point == pytest.approx(expected["k_pitch"], rel=MEAN)
    assert 1000 * cycle.single_stiffness == pytest.approx(expected["k_single_max"], rel=MEAN)


def test_method_b() -> None:
    """The reference rounds the contact ratio to 1.573; with it the formulas give its digits."""
    expected = stiffness_case("s000_12_iso6336")["verified"]
    cycle = MethodB(pair=thesis_pair(), material=STEEL)(THESIS_LOAD)
    low = expected["light_load_factor"]
    assert cycle.single_stiffness == pytest.approx(10 * low * expected["c_prime"], rel=1e-9)
    ratio = thesis_pair().transverse_contact_ratio
    exact = mesh_stiffness_alpha(expected["c_prime"], ratio)
    assert mesh_stiffness_alpha(expected["c_prime"], 1.573) == pytest.approx(expected["c_gamma_alpha"], rel=1e-9)
    assert cycle.tangent_per_width == pytest.approx(low * exact, rel=1e-9)
    assert cycle.secant_per_width == pytest.approx(low * mesh_stiffness_beta(exact), rel=1e-9)
    assert 10 * mesh_stiffness_beta(expected["c_gamma_alpha"]) * 1000 == pytest.approx(
        expected["c_gamma_beta_times_b"], rel=1e-9
    )


ROSS = {
    20: (6266.013, 1943.363, 78837.31),
    40: (9795.435, 2156.034, 65649.59),
    60: (11386.663, 2232.952, 62229.22),
    62: (11497.942, 2238.030, 62022.00),
}
"""k_b, k_s, k_a (N/µm) of a tooth at the pressure angle of 20 deg: gear element of ROSS 2.3.0, m 2, b 20, x 0."""


@pytest.mark.parametrize("teeth", sorted(ROSS))
def test_another_programs_teeth(teeth: int) -> None:
    """ROSS integrates the same energies with scipy's quad along its own involute and trochoid."""
    # Its tool's tip is round for the whole of the clearance.
    rack = BasicRack(root_radius=0.25 / (1 - math.sin(math.radians(20))))
    gear = Gear(teeth=teeth, normal_module=2.0, face_width=20.0, rack=rack)
    method = PotentialEnergy(pair=GearPair(pinion=gear, wheel=gear), body=BodyModel(inner_diameters=PerGear(20.0, 20.0)))
    load = method.teeth.pinion.load_at(np.array([gear.base_diameter / 2 * math.tan(math.radians(20))]))
    parts = method.tooth_parts(Role.PINION, load)
    found = [20 / (1000 * parts[name][0]) for name in ("bending", "shear", "axial")]
    assert found == pytest.approx(ROSS[teeth], rel=2.6e-7)  # half a unit of the last printed digit


def test_load_without_torque() -> None:
    with pytest.raises(ValueError, match=r"load\.torque = 0 N·m: must not be 0"):
        PotentialEnergy(pair=thesis_pair())(Load(torque=0.0))


PRINTED = 3e-5
"""Relative: rounded to 10 N/mm, and MATLAB's `integral` stops at 1e-10 mm/N, of some 6e-6 mm/N for a pair."""

VERIFIED = 1e-8
"""Relative: the same formulas evaluated by another hand."""

SINGLE = 1e-6
"""Relative: what the steps were recorded to; the smallest that moves anything moves 2e-4."""

Listing = Callable[..., Floats]

TABLE_4 = {tian: (274090.0, 318770.0, 161730.0), weber: (204990.0, 237670.0, 120780.0)}
"""N/mm: mean, greatest, smallest."""

AS_PRINTED = {
    tian: (274085.9022246308, 318777.05876480916, 161726.57815056658),
    weber: (204990.73418763236, 237668.1690607032, 120779.02723540322),
}

POINTS = {
    tian: [
        *(115642.02973219073, 169513.8526920002, 142773.17670518951),
        *(285546.70940739574, 317808.4257562236, 169513.8526920002, 312677.85638039454),
    ],
    weber: [
        *(93066.13566031076, 124923.91356372257, 107856.0583472601),
        *(218184.45432211075, 236995.96039176866, 124923.91356372257, 232974.3770090601),
    ],
}
"""N/mm: a single pair at positions 1, 50, 100; the mesh at positions 1, 37, 50, 100."""

CORRECTED = [
    # listing, what alone is set right, then mean, greatest, smallest in N/mm, and the change of the mean in per cent
    (tian, Correction.SQUARED_COSINE, 294460.5755181187, 344467.08918051433, 171947.16094149117, 7.43),
    (tian, Correction.OWN_GEAR, 277118.37186429504, 321910.58075986407, 163836.55799715655, 1.11),
    (tian, Correction.HERTZ_ONCE, 291442.4685627434, 339040.1856926932, 172167.16108641936, 6.33),
    (tian, Correction.COMMON_WIDTH, 219288.2420991478, 253082.59007425205, 131537.57178438394, -19.99),
    (tian, Correction.THICKNESS_AT_RADIUS, 264667.8184279428, 307909.0707247517, 159023.34113278607, -3.44),
    (tian, Correction.ANGLE_AT_RADIUS, 279753.816504455, 327931.6415655415, 162832.65067094713, 2.07),
    (tian, Correction.LOAD_ANGLE, 269765.8707745125, 312917.40837027447, 160204.05517204775, -1.58),
    (tian, Correction.CENTRE_LINE_LEVER, 317837.51769543404, 370360.70331098174, 187217.6928146186, 15.96),
    (tian, Correction.CONTACT_ON_PATH, 268207.80966706964, 311036.0226760618, 158211.29572921703, -2.14),
    (weber, Correction.SQUARED_COSINE, 209312.9203454276, 243034.78539857856, 122841.42691565436, 2.11),
    # Nothing: as printed, both gears' levers are 2.25 m_n long at most and evenly spaced, so the same.
    (weber, Correction.OWN_GEAR, 204990.73418763257, 237668.1690607035, 120779.02723540332, 0.0),
    (weber, Correction.FOUNDATION_BRACKETS, 165952.06030996406, 192146.2470635872, 97760.56715669412, -19.04),
    (weber, Correction.HERTZ_ONCE, 286432.0877108644, 335158.3489389725, 167322.88773030907, 39.73),
    (weber, Correction.CONJUGATE_RADII, 204953.4581392675, 237619.11020580953, 120772.02823011672, -0.02),
    (weber, Correction.COMMON_WIDTH, 191613.44442739856, 221090.01584936114, 114724.3524609702, -6.53),
    (weber, Correction.HALF_THICKNESS, 222116.2856392693, 257600.88975116157, 131098.5005835988, 8.35),
    (weber, Correction.THICKNESS_AT_RADIUS, 205907.77068484906, 239330.14516186138, 121602.9620772388, 0.45),
    (weber, Correction.ANGLE_AT_RADIUS, 207963.00214593855, 242077.06165525166, 121550.53770760691, 1.45),
    (weber, Correction.LOAD_ANGLE, 203230.46907758882, 235305.221761631, 120154.16845467545, -0.86),
    (weber, Correction.CENTRE_LINE_LEVER, 245595.85529201134, 285544.128212678, 143988.0801861046, 19.81),
    (weber, Correction.CONTACT_ON_PATH, 201971.15000977248, 233967.92258893733, 118585.68182311465, -1.47),
]

OVER_BASE_PITCH = [
    # listing, what is set right, then mean, greatest, smallest in N/mm, and the mean against that over the path in per cent
    (tian, Correction(0), 245713.25823644322, 305220.3603272686, 161371.61647246897, -10.35),
    (tian, ~Correction(0), 245910.21621919775, 299341.23245466145, 167817.94554649366, -11.20),
    (weber, Correction(0), 184376.47313380297, 229647.92395165266, 120583.48821868493, -10.06),
    (weber, ~Correction(0), 226376.15383303474, 277682.2759405209, 150860.21716870583, -10.88),
]
"""2001 points of a base pitch, its ends included; the mean by the trapezoidal rule."""


def extent(mesh: Floats) -> list[float]:
    return [float(np.mean(mesh)), float(np.max(mesh)), float(np.min(mesh))]


@pytest.mark.parametrize("listing", [tian, weber])
def test_the_formulas_as_printed_give_table_4(listing: Listing, published: Published) -> None:
    source = f"Alm, master's thesis, table 4, {listing.__name__.capitalize()}: its program as printed, with its errors"
    found = extent(over_path(listing()))
    for quantity, value, printed in zip(("mean", "greatest", "smallest"), found, TABLE_4[listing], strict=True):
        published(f"{quantity}, N/mm", value, f"{printed:.0f}", PRINTED * printed, source)
    assert extent(over_path(listing())) == pytest.approx(AS_PRINTED[listing], rel=VERIFIED)


def test_mean_over_the_path_by_sums_of_single_pairs() -> None:
    """Of independent springs: what touches at places of the path, from the stiffness of one pair alone."""
    method = WeberBanaschek(pair=thesis_pair(), material=STEEL)
    first, last = method.pair.usable_path
    pitch, places = method.pair.pinion.transverse_base_pitch, np.linspace(first, last, 4001)
    total = np.zeros(places.shape)
    for at in (places - pitch, places, places + pitch):
        touching = (at >= first) & (at <= last)
        total[touching] += method.single(at[touching], THESIS_LOAD).stiffness * method.width
    found = compare_methods(thesis_pair(), STEEL, THESIS_LOAD, ["weber-banaschek"])
    assert found.mean_over_path(found.cycles[0]) == pytest.approx(float(total.mean()), rel=JUMPS)


@pytest.mark.parametrize("listing", [tian, weber])
def test_positions_of_the_path_as_printed(listing: Listing) -> None:
    single = listing()
    mesh = over_path(single)
    found = [single[0], single[49], single[99], mesh[0], mesh[36], mesh[49], mesh[99]]
    assert found == pytest.approx(POINTS[listing], rel=VERIFIED)
    assert [path()[0], path()[-1]] == pytest.approx([1.904060753121506, 8.929259600369067], rel=VERIFIED)
    alone = np.flatnonzero(mesh == single)
    assert [alone[0], alone.size, 99 - alone[-1]] == [37, 26, 37]


@pytest.mark.parametrize(("listing", "fixed", "mean", "greatest", "smallest", "percent"), CORRECTED)
def test_what_each_error_is_worth(
    listing: Listing, fixed: Correction, mean: float, greatest: float, smallest: float, percent: float
) -> None:
    found = extent(over_path(listing(fixed)))
    assert found == pytest.approx([mean, greatest, smallest], rel=SINGLE)
    assert 100 * (found[0] / float(np.mean(over_path(listing()))) - 1) == pytest.approx(percent, abs=0.006)


@pytest.mark.parametrize(("listing", "fixed", "mean", "greatest", "smallest", "percent"), OVER_BASE_PITCH)
def test_mean_over_a_base_pitch(
    listing: Listing, fixed: Correction, mean: float, greatest: float, smallest: float, percent: float
) -> None:
    mesh = over_base_pitch(listing(fixed))
    found = float(np.trapezoid(mesh)) / (mesh.size - 1)
    assert [found, *extent(mesh)[1:]] == pytest.approx([mean, greatest, smallest], rel=SINGLE)
    assert 100 * (found / float(np.mean(over_path(listing(fixed)))) - 1) == pytest.approx(percent, abs=0.006)


@pytest.mark.parametrize("listing", [tian, weber])
def test_mean_over_a_base_pitch_is_that_of_a_single_pair_times_the_contact_ratio(listing: Listing) -> None:
    single = listing()
    fine = over_base_pitch(single, 200_001)
    # Half of the mean drops away within one interval of 200000 at the end of double contact; both ends are counted besides.
    assert float(np.mean(fine)) == pytest.approx(base_pitch_mean(single), rel=5e-6)
    # The share of double contact: 0.74 of the path's positions, but of a base pitch the contact ratio less one.
    assert float(np.mean(over_path(single) != single)) == pytest.approx(0.74, abs=1e-12)
    assert np.ptp(path()) / BASE_PITCH - 1 == pytest.approx(0.58647, abs=5e-6)
