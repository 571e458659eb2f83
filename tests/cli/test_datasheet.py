"""The sheet shows everything that the data hold."""

import io

import pytest
from rich.console import Console
from support.specs import TEMPLATES

from gearcad import Body, Gear, Rack
from gearcad.cli.basics import plain_datasheet, print_datasheet
from gearcad.core import symbols
from gearcad.core.quantities import symbols_of
from gearcad.designs import GearDesign, read_spec
from gearcad.designs.design import Design
from gearcad.geometry import ShaperCutter
from gearcad.sheet import blocks


def sheet(design: Design, width: int = 80) -> str:
    file = io.StringIO()
    print_datasheet(design, Console(file=file, width=width))
    return file.getvalue()


def test_every_quantity_has_its_place() -> None:
    gear = {key for keys in blocks._GEAR_BLOCKS.values() for key in keys.split()}
    pair = {key for keys in blocks._PAIR_BLOCKS.values() for key in keys.split()} | set(symbols.PER_GEAR)
    assert gear == {*symbols_of(Gear), *symbols.GEAR} - {"name"}
    of_racks = {"mounting_distance", "tip_clearances.pinion", *symbols.RACK_PAIR, *symbols.DRIVE}
    assert pair == {"centre_distance", "centre_distance_tolerance", "axial_offset", *symbols.PAIR, *of_racks}
    rack = {key for keys in blocks._RACK_BLOCKS.values() for key in keys.split()}
    assert rack == {*symbols_of(Rack), *symbols.RACK} - {"name"}


@pytest.mark.parametrize("width", [80, 120])
@pytest.mark.parametrize("spec", ["spur", "planetary-24-21-66", "train-pairs"])
def test_what_knows_no_styles_has_the_same_text(spec: str, width: int) -> None:
    design = read_spec(TEMPLATES / f"{spec}.toml")
    assert plain_datasheet(design, width) == sheet(design, width)


def test_clauses_stand_apart_from_any_number_of_gears() -> None:
    for spec, count in (("volvo-13-44", 2), ("planetary-24-21-66", 3), ("planetary-alm", 6)):
        text = sheet(read_spec(TEMPLATES / f"{spec}.toml"), 160)
        (line,) = [line for line in text.splitlines() if line.startswith("  tip diameter")]
        *_, symbol_and_values = line.partition("d_a")
        assert len([float(value) for value in symbol_and_values.split()[1:-1]]) == count and line.split()[-1] == "4.5"


def test_pair_shows_both_gears_side_by_side_then_the_pair() -> None:
    text = sheet(read_spec(TEMPLATES / "volvo-13-44.toml"))
    lines = {line[:39].strip(): line[39:].split() for line in text.splitlines()}
    assert lines["number of teeth"] == ["z", "13", "44"]
    assert lines["tip diameter"] == ["d_a", "mm", "42.3073", "127.6565"]
    assert lines["working pitch diameter"] == ["d_w", "mm", "36.4912", "123.5088"]
    assert lines["total contact ratio"] == ["ε_γ", "2.2657"]
    assert lines["Young's modulus"] == ["E", "MPa", "205000"]
    assert "keyway" not in text
    assert "yield strength" not in text


def test_body_shows_what_is_there_and_nothing_else() -> None:
    gear = Gear(teeth=30, normal_module=2.0, face_width=9.0, body=Body(bore=20.0, keyway_width=6.0, keyway_depth=2.8))
    text = sheet(GearDesign(name="x", gear=gear))
    body = text[text.index("\nBody\n") : text.index("\n\n", text.index("\nBody\n"))]
    assert [line.split()[-1] for line in body.strip().splitlines()[1:]] == ["20.0000", "6.0000", "2.8000"]
    assert text.endswith("\nNo warnings.\n")


@pytest.mark.parametrize("width", [80, 120])
def test_terminal_gets_colour_and_the_same_words(width: int) -> None:
    design = read_spec(TEMPLATES / "spur.toml")
    file = io.StringIO()
    print_datasheet(design, Console(file=file, width=width, force_terminal=True, color_system="standard"))
    assert "\x1b[" in file.getvalue()
    assert file.getvalue().count("\n") == sheet(design, width).count("\n")


def test_spur_gear_has_no_lead_and_zero_has_no_sign() -> None:
    gear = Gear(teeth=30, normal_module=2.0, face_width=9.0, profile_shift=-0.00001)
    lines = sheet(GearDesign(name="x", gear=gear)).splitlines()
    assert not any("lead" in line for line in lines)
    assert next(line for line in lines if "profile shift" in line).endswith(" 0.0000")


def _lines(gear: Gear) -> dict[str, list[str]]:
    text = sheet(GearDesign(name="trial", gear=gear))
    return {line[:39].strip(): line[39:].split() for line in text.splitlines()}


def test_a_ring_is_measured_inside_and_has_its_shift_in_both_signs() -> None:
    lines = _lines(Gear(teeth=-70, normal_diametral_pitch=8, face_width=10, profile_shift=-0.5))
    assert "trial: internal spur gear, z = -70" in lines
    assert lines["profile shift coefficient"] == ["x", "-0.5000"]
    assert lines["profile shift in KHK's sign (rings)"] == ["x", "0.5000"]
    assert lines["normal diametral pitch"] == ["P_nd", "1/inch", "8.0000"]
    assert lines["between two balls (rings)"][0] == "M_dK"
    assert not {"over two balls", "over two pins", "teeth spanned", "cutter, profile shift coefficient"} & lines.keys()
    assert any("form root: no cutter given" in line for line in lines)


def test_a_helical_ring_says_what_it_is_not_measured_by() -> None:
    lines = _lines(Gear(teeth=-70, normal_module=2, face_width=10, helix_angle=15, cutter=ShaperCutter(teeth=25)))
    assert lines["span measurement"] == ["W_k", "mm", "spur", "only"]
    assert lines["between two pins (spur rings)"] == ["M_dR", "mm", "spur", "only"]
    assert lines["cutter, number of teeth"] == ["z_0", "25"]
    assert lines["cutter, tip diameter for this root"][:2] == ["d_a0", "mm"]
    assert not {"normal diametral pitch", "spaces spanned (spur rings)"} & lines.keys()
