"""Tables behind sheets, whole columns of them, and keyways of DIN 6885-1, against what is printed elsewhere."""

import re
from dataclasses import replace

import pytest

import gearcad
from gearcad import Body, Gear
from gearcad.core.errors import GeometryError, InputError
from gearcad.designs import open_table, read_spec
from gearcad.geometry.fits import limit_deviations, tooth_thickness_allowance
from gearcad.geometry.gear_parts import depth_allowance, keyway_of
from gearcad.rating.tolerances import Accuracy, GearTolerances
from gearcad.solids.facets.tessellation import tessellate

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


# Keyway sizing chart of Martin Sprocket & Gear (2007), metric column: above, to, groove width W, T2.
MARTIN = """
6 8 2 1 | 8 10 3 1.4 | 10 12 4 1.8 | 12 17 5 2.3 | 17 22 6 2.8 | 22 30 8 3.3 | 30 38 10 3.3 | 38 44 12 3.3 | 44 50 14 3.8
50 58 16 4.3 | 58 65 18 4.4 | 65 75 20 4.9 | 75 85 22 5.4 | 85 95 25 5.4 | 95 110 28 6.4 | 110 130 32 7.4 | 130 150 36 8.4
150 170 40 9.4 | 170 200 45 10.4 | 200 230 50 11.4 | 230 260 56 12.4 | 260 290 63 12.4 | 290 330 70 14.4 | 330 380 80 15.4
380 440 90 17.4 | 440 500 100 19.5
"""
ROWS = [tuple(map(float, each.split())) for each in re.split(r"[|\n]", MARTIN) if each.strip()]


def test_every_step_is_that_of_the_chart():
    for above, to, width, depth in ROWS:
        for bore in (above * (1 + 1e-12), (above + to) / 2, to):
            assert keyway_of(bore) == (width, depth)
    assert keyway_of(6.0) == (2, 1)  # as charts by single bores have it
    assert [row[0] for row in ROWS[1:]] == [row[1] for row in ROWS[:-1]]


# Keyways in hubs by JIS B 1301:1996, which has the same keys, in Misumi's data: widths, JS9 (±) and P9 in µm, more depth in mm.
MISUMI = (
    ((2, 3), 12.5, (-6, -31), 0.1),
    ((4, 5, 6), 15, (-12, -42), 0.1),
    ((8, 10), 18, (-15, -51), 0.2),
    ((12, 14, 16, 18), 21.5, (-18, -61), 0.2),
    ((20, 22, 25, 28), 26, (-22, -74), 0.2),
    ((32,), 31, (-26, -88), 0.2),
    ((36,), 31, (-26, -88), 0.3),
)


def test_widths_and_depths_have_the_limits_of_another_chart():
    for widths, either_way, tight, deeper in MISUMI:
        for width in widths:
            assert limit_deviations("JS9", width) == (either_way, -either_way)
            assert limit_deviations("P9", width) == tight
            assert depth_allowance(width) == deeper * 1000
    assert depth_allowance(100) == 300 and depth_allowance(100.5) is None


def test_a_body_has_the_keyway_of_its_bore_and_of_another_bore_another():
    body = Body(bore=30, keyway=True)
    assert (body.keyway_width, body.keyway_depth) == (8, 3.3)
    moved = replace(body, bore=40)
    assert (moved.keyway_width, moved.keyway_depth) == (12, 3.3)
    assert eval(repr(body)) == body
    assert replace(body, keyway=False).keyway_width == 0


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({}, "keyway = True: must be left out without a bore"),
        ({"bore": 5.999}, "bore = 5.999 mm: must be from 6 to 500 mm for a keyway of DIN 6885"),
        ({"bore": 500.001}, "bore = 500.001 mm: must be from 6 to 500 mm"),
        ({"bore": 30, "keyway_width": 8.0, "keyway_depth": 3.3}, "keyway_width = 8 mm: must be left out where keyway is true"),
        ({"bore": 30, "keyway_depth": 3.3}, "keyway_depth = 3.3 mm: must be left out"),
    ],
)
def test_what_is_no_keyway_by_the_bore_is_said_in_a_line(given, says):
    with pytest.raises(GeometryError, match=re.escape(says)) as caught:
        Body(keyway=True, **given)
    assert "\n" not in str(caught.value)


def test_keyway_is_true_or_false():
    with pytest.raises(InputError, match="must be true or false"):
        Body(bore=30, keyway="yes")


def test_specs_and_tables_ask_for_it_and_data_has_the_sizes(tmp_path):
    spec = tmp_path / "gear.toml"
    spec.write_text("[gear]\nteeth = 40\nnormal_module = 2\nface_width = 20\nbody.bore = 30\nbody.keyway = true\n")
    body = gearcad.data(read_spec(spec))["gear"]["body"]
    assert (body["keyway"], body["keyway_width"], body["keyway_depth"]) == (True, 8, 3.3)
    table = tmp_path / "gears.csv"
    table.write_text("name,teeth,normal_module,face_width,body.bore,body.keyway\na,40,2,20,30,true\nb,40,2,20,40,false\n")
    designs = [row.design() for row in open_table(table).rows()]
    assert [design.gear.body.keyway_width for design in designs] == [8, 0]


def test_the_solid_is_that_of_the_sizes():
    given = Gear(teeth=40, normal_module=2, face_width=20, body=Body(bore=30, keyway_width=8, keyway_depth=3.3))
    assert tessellate(replace(given, body=Body(bore=30, keyway=True))).volume == tessellate(given).volume
