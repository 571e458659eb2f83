"""Tables behind sheets, whole columns of them, against what is printed elsewhere."""

import pytest

from gearcad.geometry.fits import limit_deviations, tooth_thickness_allowance
from gearcad.rating.tolerances import Accuracy, GearTolerances

SIZES = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315)
BRIGHT_BARS = {  # µm, table of a supplier of round bars (ISO h), sizes above the one before up to and with each
    "h6": (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32),
    "h7": (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52),
    "h8": (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81),
    "h9": (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130),
    "h10": (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210),
    "h11": (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320),
    "h12": (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520),
}

DIAMETERS = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10_000)
CD = (40, 54, 70, 95, 130, 175, 240, 320, 430, 580, 780)
SERIES_25 = (20, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250)
"""DIN 3967 in two public transcriptions that agree: -A_sne of cd, T_sn of 25."""

SINGLE_PITCH = {  # f_pt of grades 4 to 8 (µm) for d above 125 to 280 mm, table 1 of ISO 1328-1:1995 (recalled), up to a module
    2.0: (4.2, 6.0, 8.5, 12.0, 17.0),
    3.5: (4.6, 6.5, 9.0, 13.0, 18.0),
    6.0: (5.0, 7.0, 10.0, 14.0, 20.0),
    10.0: (5.5, 8.0, 11.0, 16.0, 23.0),
    16.0: (6.5, 9.5, 13.0, 19.0, 27.0),
    25.0: (8.0, 12.0, 16.0, 23.0, 33.0),
    40.0: (11.0, 15.0, 21.0, 30.0, 43.0),
}
CUMULATIVE_PITCH = {
    10.0: (8, 11, 16, 23, 32),
    50.0: (10, 14, 20, 29, 41),
    125.0: (13, 18, 26, 37, 52),
    280.0: (17, 24, 35, 49, 69),
}
"""F_p of the same grades for a module of 0.5 to 2 mm, table 2 (recalled), by the diameter."""


@pytest.mark.parametrize("name", BRIGHT_BARS)
def test_shafts_h_are_those_of_a_printed_table(name):
    for below, size, tolerance in zip((0, *SIZES), SIZES, BRIGHT_BARS[name], strict=False):
        assert limit_deviations(name, size) == limit_deviations(name, below + 1e-6) == (0, -tolerance)
        assert limit_deviations(name.upper(), size) == (tolerance, 0)


@pytest.mark.parametrize(("name", "size", "limits"), [("H7", 630, (70, 0)), ("h9", 1000, (0, -230)), ("H11", 3150, (1350, 0))])
def test_holes_h_and_shafts_h_reach_as_far_as_their_grades(name, size, limits):
    """Tables of ISO 286-2 go on to 3150 mm; the deviation of the letter is 0 at any size."""
    assert limit_deviations(name, size) == limits


def test_a_column_of_din_3967():
    for below, diameter, upper, tolerance in zip((0, *DIAMETERS), DIAMETERS, CD, SERIES_25, strict=False):
        for each in (diameter, below + 1e-3):
            assert tooth_thickness_allowance("cd25", each) == (-upper, -upper - tolerance)


def _tolerances(grade, diameter, module):
    sizes = {"teeth": 40, "reference_diameter": diameter, "normal_module": module, "face_width": 20.0, "helix_angle": 0.0}
    return GearTolerances(accuracy=Accuracy.ISO_1995, grade=grade, **sizes)


def test_columns_of_iso_1328():
    for module, row in SINGLE_PITCH.items():
        assert [_tolerances(grade, 200.0, module).single_pitch for grade in range(4, 9)] == list(row)
    for diameter, row in CUMULATIVE_PITCH.items():
        assert [_tolerances(grade, diameter, 1.0).cumulative_pitch for grade in range(4, 9)] == list(row)
