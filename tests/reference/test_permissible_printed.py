"""Factors of permissible stress against values that others print: reports of commercial programs, worked examples, tests."""

from __future__ import annotations

import math

import pytest
from support.published import Published

from gearcad.material import MaterialGroup as G
from gearcad.rating.factors import (
    flank_life_factor,
    flank_points,
    flank_roughness_factor,
    lubricant_factor,
    mesh_radius,
    notch_sensitivity_factor,
    root_points,
    root_size_factor,
    root_surface_factor,
    speed_factor,
)

# A helical pair 25/40 of an FVA Workbench report, case-hardened: sigma_Hlim 1500 MPa, ISO VG 318, 8.33 m/s, Rz 18 and 36 µm.
RHO_RED = mesh_radius(49.617, 79.387, math.tan(math.radians(21.173)))
Z_L, Z_V = lubricant_factor(1500.0, 318.0), speed_factor(1500.0, 8.33)
Z_R = flank_roughness_factor(1500.0, 18.0, RHO_RED)
Y_DREL, Y_RREL = notch_sensitivity_factor(2.072, G.CASE_HARDENED), root_surface_factor(36.0, G.CASE_HARDENED)

# A spur pair 51/52 of a STplus report, kst-E, case-hardened: q_s 2.56, Rz 20 µm, sigma_FE 860 MPa.
SPUR = (notch_sensitivity_factor(2.56, G.CASE_HARDENED), root_surface_factor(20.0, G.CASE_HARDENED))

PRINTED = {
    "rho_red, 25/40": (RHO_RED, 5.91, 0.02),
    "Z_R, 25/40": (Z_R, 0.854, 0.002),
    "Z_L, 25/40": (Z_L, 1.047, 0.002),
    "Z_v, 25/40": (Z_V, 0.995, 0.002),
    "sigma_HP, 25/40": (1500 * 0.85 * Z_L * Z_V * Z_R, 1135.4, 2.0),
    "Y_RrelT, 25/40": (Y_RREL, 0.915, 0.001),
    "Y_delta_relT, 25/40": (Y_DREL, 0.996, 0.001),
    "sigma_FP, 25/40": (922 * 0.85 * Y_DREL * Y_RREL, 714.1, 2.0),
    "Y_delta_relT, 51/52": (SPUR[0], 1.001, 0.001),
    "Y_RrelT, 51/52": (SPUR[1], 0.957, 0.001),
    "sigma_FP, 51/52": (860 * SPUR[0] * SPUR[1], 823.2, 2.0),
    "Y_RrelT, FZG H701": (root_surface_factor(20.0, G.CASE_HARDENED), 0.957, 0.0006),
    "Z_NT at 4.5e7, KISSsoft": (flank_life_factor(4.5e7, G.CASE_HARDENED), 1.008, 0.0006),
    "Z_NT at 9e7, KISSsoft": (flank_life_factor(9e7, G.CASE_HARDENED), 0.982, 0.0006),
    "Z_NT at 4.186e7, KISSsoft": (flank_life_factor(4.186e7, G.CASE_HARDENED), 1.0135, 0.0001),
    "Y_X, Eh, 10 mm": (root_size_factor(10.0, G.CASE_HARDENED), 0.95, 1e-9),
    "Y_X, Eh, 30 mm": (root_size_factor(30.0, G.CASE_HARDENED), 0.8, 1e-9),
    "Y_X, V, 10 mm": (root_size_factor(10.0, G.THROUGH_HARDENED), 0.97, 1e-9),
    "Y_X, V, 45 mm": (root_size_factor(45.0, G.THROUGH_HARDENED), 0.85, 1e-9),
    "Y_X, GG, 10 mm": (root_size_factor(10.0, G.GREY_IRON), 0.925, 1e-9),
    "Y_X, GG, 30 mm": (root_size_factor(30.0, G.GREY_IRON), 0.7, 1e-9),
    "Y_RrelT, V, Rz 10": (root_surface_factor(10.0, G.THROUGH_HARDENED), 1.00164, 2e-5),
    "Y_RrelT, St, Rz 10": (root_surface_factor(10.0, G.STRUCTURAL_STEEL), 1.001, 1e-5),
    "Y_RrelT, NT, Rz 10": (root_surface_factor(10.0, G.NITRIDING_STEEL), 0.99436, 1e-5),
}

SOURCE = "FVA Workbench, STplus and KISSsoft reports and rounded worked examples, as quoted in public"


@pytest.mark.parametrize("name", PRINTED)
def test_printed_values(name: str, published: Published) -> None:
    found, printed, tolerance = PRINTED[name]
    published(name, found, printed, tolerance, SOURCE)


@pytest.mark.parametrize(
    ("name", "points", "per_torque", "printed", "tolerance"),
    [
        ("flank, Eh", flank_points(G.CASE_HARDENED), 2, 6.61, 0.01),
        ("flank, NV (nitrided)", flank_points(G.NITRIDED), 2, 5.709, 0.01),
        ("flank, NV (nitrocarburised)", flank_points(G.NITROCARBURISED), 2, 15.715, 0.01),
        ("root, Eh", root_points(G.CASE_HARDENED), 1, 8.738, 0.002),
        ("root, V", root_points(G.THROUGH_HARDENED), 1, 6.225, 0.002),
        ("root, NV (nitrided)", root_points(G.NITRIDED), 1, 17.035, 0.002),
        ("root, NV (nitrocarburised)", root_points(G.NITROCARBURISED), 1, 84.003, 0.02),
    ],
)
def test_exponents_of_limited_life(
    name: str, points: tuple, per_torque: int, printed: float, tolerance: float, published: Published
) -> None:
    """ISO 6336-6 prints the exponents of torque; sigma_H goes with the square root of it."""
    (first, static), (last, endurance), *_ = points
    exponent = math.log(last / first) / math.log(static / endurance) / per_torque
    published(f"exponent of limited life, {name}", exponent, printed, tolerance, "ISO 6336-6:2006")
