"""DIN 6885-1: keyways by the bore against a printed chart, and as specs and tables ask for them."""

import re
from dataclasses import replace

import pytest

import gearcad
from gearcad import Body, Gear
from gearcad.core.errors import GeometryError, InputError
from gearcad.designs import open_table, read_spec
from gearcad.geometry.fits import limit_deviations
from gearcad.geometry.gear_parts import depth_allowance, keyway_of
from gearcad.solids.facets.tessellation import tessellate

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
