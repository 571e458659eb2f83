"""Words and symbols cover what the objects hold; sentences of templates are plain text on one line."""

from dataclasses import fields, replace
from typing import Any

import pytest

from gearcad import Gear, GearPair, Load, Material, Mounting
from gearcad.check.explanation import Compared, LinesExplanation
from gearcad.check.options import CheckOptions
from gearcad.check.summary import PlaneSummary, SolidSummary
from gearcad.core import symbols
from gearcad.core.quantities import schema_of, symbols_of
from gearcad.core.records import PerGear
from gearcad.designs.train_keys import COLUMNS
from gearcad.designs.variations import column_symbol
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.torque_excitation import TorqueExcitation
from gearcad.geometry.gear_parts import Body
from gearcad.geometry.making import Making
from gearcad.geometry.premachining import Premachining
from gearcad.meshing.options import MeshOptions
from gearcad.rating import RatingOptions
from gearcad.report.document import sentences


def _keys(document: dict[str, Any]) -> set[str]:
    """Dotted keys of a document, without the warnings, which are sentences."""
    found = set()
    for key, value in document.items():
        found |= {f"{key}.{inner}" for inner in _keys(value)} if isinstance(value, dict) else {key}
    return found - {"warnings", "notices"}


def test_every_field_of_a_gear_has_a_symbol_and_every_symbol_a_field() -> None:
    """Those of measurements are of external gears, or of rings; their limits where the tooth thickness has an allowance."""
    gear, ring = (Gear(teeth=teeth, normal_module=2.0, face_width=10.0, tooth_allowance="cd25") for teeth in (20, -60))
    plain = Premachining(tool_addendum=1.4, tool_tip_radius=0.2)
    tool = replace(plain, stock=0.02, stock_tolerance=0.01, protuberance=0.04, protuberance_angle=8.0)
    made_twice = [replace(gear, premachining=tool), replace(ring, premachining=plain)]
    spur = {"shrinkage_radial": 1.0}
    makings = [Making(process="mould", **spur), Making(process="print", **spur), Making(process="wire", kerf=0.1)]
    as_made = [replace(each, making=making) for each in (gear, ring) for making in makings]
    others = replace(gear, body=Body(step="blank.step")), replace(gear, tool="ISO 53 A")
    every = set().union(*(_keys(each.to_dict()) for each in (gear, ring, *made_twice, *as_made, *others)))
    assert every == {*symbols_of(Gear), *symbols.GEAR}
    of_rings = {"profile_shift_khk", "span_spaces", "between_balls", "between_pins"}
    of_rings |= {f"thickness_limits.between_{gauge}_{side}" for gauge in ("balls", "pins") for side in ("least", "greatest")}
    assert _keys(ring.to_dict()) - _keys(gear.to_dict()) == of_rings


def test_words_of_gears_and_pairs_fit_their_column_of_the_sheet() -> None:
    for table in (symbols_of(Gear) | symbols.GEAR, symbols_of(GearPair) | symbols.PAIR):
        assert [symbol.words for symbol in table.values() if len(symbol.words) > 37] == []


def test_every_field_of_a_pair_has_a_symbol_and_every_symbol_a_field() -> None:
    gear = Gear(teeth=20, normal_module=2.0, face_width=10.0)
    inputs = {name for name, field in schema_of(GearPair).items() if field.part is None} - {"name"}
    pair = GearPair(pinion=gear, wheel=gear, centre_distance_tolerance="js7")
    ring = Gear(teeth=-70, normal_module=2.0, face_width=10.0, profile_shift=-0.3)
    internal = GearPair(pinion=gear, wheel=ring, centre_distance_tolerance="js7")
    assert "centre_distance_tolerance" not in _keys(GearPair(pinion=gear, wheel=gear).to_dict())
    assert _keys(internal.to_dict()) == {*inputs, *symbols.PAIR, *symbols.COURSES}
    only_with_a_ring = {key for key in symbols.PAIR if key.startswith("interference_margins.")}
    assert _keys(pair.to_dict()) == {*inputs, *symbols.PAIR, *symbols.COURSES} - only_with_a_ring
    assert {key for key in symbols.PAIR if isinstance(getattr(pair, key, None), PerGear)} == set(symbols.PER_GEAR)


def test_every_figure_of_a_check_has_a_symbol() -> None:
    names = {field.name for kind in (PlaneSummary, SolidSummary) for field in fields(kind)}
    of_figures = {"missing", "extremes", "mean_error"}  # why there is none, where it is, how exact: no figures themselves
    assert (names - of_figures) | {"passed", "numerics", "strength"} == set(symbols.CHECK)


def test_every_key_of_a_table_has_a_symbol() -> None:
    keys = {f"{table}.{field}" for table, fields in COLUMNS.items() for field in fields}
    assert {key for key in keys if column_symbol(key) is None} == set()


def test_a_column_is_whose_its_heading_says() -> None:
    expected = {
        "pinion.tip_diameter": ("pinion", "d_a", "mm"),
        "pair.tip_clearances.wheel": ("wheel", "c", "mm"),
        "check.root_tension_pinion": ("pinion", "σ_F", "MPa"),
        "check.rating.wheel.Y_F": ("wheel", "Y_F", ""),
        "check.rating.p_0": ("", "p_0", "MPa"),
        "check.pinion_inner_diameter": ("", "", "mm"),
        "load.torque": ("", "T_1", "N·m"),
        "seconds": ("", "", "s"),
    }
    found = {heading: column_symbol(heading) for heading in expected}
    assert {key: (owner, symbol.symbol, symbol.unit) for key, (owner, symbol) in found.items()} == expected
    assert [column_symbol(key) for key in ("", "pinion", "pinion.", "check.rating.pinion", "files.data.json", "_pinion")] == [
        None
    ] * 6


TRAIN = (Inertia, Shaft, ToothMesh, TorqueExcitation)
WRITTEN = [
    symbols_of(Gear) | symbols.GEAR,
    {key: symbol for key, symbol in symbols_of(GearPair).items() if "." not in key} | symbols.PAIR,
    symbols_of(CheckOptions) | symbols.CHECK,
    *(symbols_of(kind) for kind in (Material, Load, Mounting, RatingOptions, DynamicsOptions, MeshOptions)),
    *(
        {name: symbol for name, symbol in symbols_of(kind).items() if name not in ("name", "start", "end", "pinion", "wheel")}
        for kind in TRAIN
    ),
]


@pytest.mark.parametrize("table", WRITTEN)
def test_words_tell_the_rows_of_a_sheet_apart(table: dict[str, symbols.Symbol]) -> None:
    words = [symbol.words for symbol in table.values()]
    assert len(set(words)) == len(words)
    assert all(words)


LINES = LinesExplanation(
    greatest_pressure=None,
    length=Compared(computed=31.25, standard=30.0),
    mean_line_load=12345.6,
    pitch_point_radius=9.5,
    face_load_factor=Compared(computed=1.25, standard=1.5),
    greatest_across=-4.0,
    misalignment=-8.0,
)


def test_branches_and_lines_follow_each_other_after_one_space() -> None:
    assert sentences("reasons_solid.txt", "pressure", LINES) == (
        "Pressure: none away from the edges. ISO has the mean, F_bn K_A over 30 mm of lines: 12\u202f350 N/mm, on the radius "
        "9.5 mm of the pitch point, and carries it to the inner point of single contact by Z_B and Z_D."
    )


def test_nothing_is_escaped_before_the_page_does_it() -> None:
    said = sentences("reasons_solid.txt", "lines", LINES)
    assert said.startswith("Lines of contact: 31.25 mm carry on the mean; the rigid gears' lines are 30 mm long. Teeth that")
