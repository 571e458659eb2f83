"""Texts of specs: edited with everything else as it was, and written so that reading gives the same design."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.strategies import MODIFICATIONS, build_pair, modified, pair_inputs

from gearcad import Gear, GearPair, Load, Material
from gearcad.core.errors import GearcadError, SpecError
from gearcad.designs import PairDesign, design_from_tables, read_spec
from gearcad.designs.reader import edit_spec, starter_text, starters
from gearcad.designs.spec_writers import pair_text
from gearcad.rating.editions import Edition
from gearcad.rating.options import RatingOptions

TEMPLATES = Path(__file__).parents[2] / "templates"

CHANGES: dict[str, float | str] = {
    "pair.name": "fzg-c-modified",
    "pinion.modification.tip_relief": 35.0,
    "pinion.modification.tip_relief_length": 4.95,
    "pinion.modification.tip_relief_shape": "parabolic",
    "wheel.modification.tip_relief": 39.0,
    "wheel.modification.tip_relief_length": 5.2,
}

NOTES = {"pinion.modification.tip_relief": "µm"}


def test_a_starter_gets_its_keys_and_keeps_its_comments(tmp_path: Path) -> None:
    text = (TEMPLATES / "fzg-c.toml").read_text(encoding="utf-8")
    edited = edit_spec(text, CHANGES, NOTES)
    old, new = text.splitlines(), edited.splitlines()
    changed = [line for line in new if line not in old]
    assert changed == [
        'name = "fzg-c-modified"                # the results go to output/fzg-c/',
        "modification.tip_relief = 35.0  # µm",
        "modification.tip_relief_length = 4.95",
        'modification.tip_relief_shape = "parabolic"',
        "modification.tip_relief = 39.0",
        "modification.tip_relief_length = 5.2",
    ]
    assert [line for line in old if line not in new] == ['name = "fzg-c"                # the results go to output/fzg-c/']
    path = tmp_path / "spec.toml"
    path.write_text(edited, encoding="utf-8")
    design = read_spec(path)
    assert design.name == "fzg-c-modified"
    assert design.pair is not None
    assert design.pair.pinion.modification.in_use == {
        "tip_relief": 35.0,
        "tip_relief_length": 4.95,
        "tip_relief_shape": "parabolic",
    }
    assert design.pair.wheel.modification.tip_relief_length == 5.2


KEY = "pinion.modification.tip_relief"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("[pinion]\nteeth = 20\n", "[pinion]\nteeth = 20\nmodification.tip_relief = 7.0\n"),
        ("[pinion]\n", "[pinion]\nmodification.tip_relief = 7.0\n"),
        (
            "[pinion]\nmodification.tip_relief = 20  # much\n# end\n\n[wheel]\n",
            "[pinion]\nmodification.tip_relief = 7.0  # much\n# end\n\n[wheel]\n",
        ),
        (
            "[pinion]\nteeth = 20 # z\n\n# the mate\n[wheel]\n",
            "[pinion]\nteeth = 20 # z\nmodification.tip_relief = 7.0\n\n# the mate\n[wheel]\n",
        ),
        (
            "[pinion]\nmodification = {tip_relief_length = 2, tip_relief = 3}\n",
            "[pinion]\nmodification = {tip_relief_length = 2, tip_relief = 7.0}\n",
        ),
        ("[pinion]\nmodification = {twist = 2} # one\n", "[pinion]\nmodification = {twist = 2, tip_relief = 7.0} # one\n"),
        ("[pinion]\nmodification = {}\n", "[pinion]\nmodification = {tip_relief = 7.0}\n"),
        (
            "[pinion.modification]\ntwist = 2\n[pinion]\nteeth = 20\n",
            "[pinion.modification]\ntwist = 2\ntip_relief = 7.0\n[pinion]\nteeth = 20\n",
        ),
        ("pinion.teeth = 20\n[wheel]\n", "pinion.teeth = 20\npinion.modification.tip_relief = 7.0\n[wheel]\n"),
        ("pinion = {teeth = 20}\n", "pinion = {teeth = 20, modification.tip_relief = 7.0}\n"),
        ("[pinion]\r\nteeth = 20\r\n", "[pinion]\r\nteeth = 20\r\nmodification.tip_relief = 7.0\r\n"),
        (
            "[pinion]\nmodification.tip_relief = 1\nz = 2\nmodification.twist = 3\n",
            "[pinion]\nmodification.tip_relief = 7.0\nz = 2\nmodification.twist = 3\n",
        ),
        ('[pinion]\nmodification."tip_relief" = 1\n', '[pinion]\nmodification."tip_relief" = 7.0\n'),
        (
            "pinion = {modification = {tip_relief = 3}, z = 2}\n",
            "pinion = {modification = {tip_relief = 7.0}, z = 2}\n",
        ),
        (
            '[pinion]\nname = """\n[wheel]\n"""\nteeth = 20\n',
            '[pinion]\nname = """\n[wheel]\n"""\nteeth = 20\nmodification.tip_relief = 7.0\n',
        ),
        (
            "[pinion.body]\nbore = 9\n[wheel]\nteeth = 20\n[pinion]\nteeth = 20\n# end\n",
            "[pinion.body]\nbore = 9\n[wheel]\nteeth = 20\n[pinion]\nteeth = 20\nmodification.tip_relief = 7.0\n# end\n",
        ),
        ("[check]\ntorques = [\n  1,\n]\n[pinion]", "[check]\ntorques = [\n  1,\n]\n[pinion]\nmodification.tip_relief = 7.0\n"),
    ],
)
def test_layouts(before: str, after: str) -> None:
    assert edit_spec(before, {KEY: 7.0}) == after
    assert tomllib.loads(after)["pinion"]["modification"]["tip_relief"] == 7.0


def test_a_name_comes_first_in_its_table() -> None:
    assert edit_spec("[pair]\nnormal_module = 2\n", {"pair.name": "b"}) == '[pair]\nname = "b"\nnormal_module = 2\n'


def test_a_table_that_is_not_there_comes_to_the_end() -> None:
    edited = edit_spec("[wheel]\nteeth = 20\n", {KEY: 7.0})
    assert edited == "[wheel]\nteeth = 20\n\n[pinion]\nmodification.tip_relief = 7.0\n"


def test_what_cannot_be_edited_is_said_and_not_spoilt() -> None:
    with pytest.raises(SpecError, match=r"write by hand: pinion\.modification\.tip_relief = 7\.0"):
        edit_spec("[[pinion]]\nteeth = 20\n", {KEY: 7.0})


def test_a_table_in_one_line_gets_its_keys_without_notes() -> None:
    text = "[pinion]\nmodification = { lead_crowning = 5.0 }\n"
    edited = edit_spec(text, {"pinion.modification.tip_relief": 3.0}, NOTES)
    assert edited == "[pinion]\nmodification = { lead_crowning = 5.0, tip_relief = 3.0 }\n"


PAIRS = [name for name in starters() if "[wheel]" in starter_text(name)[1]]


def read(text: str) -> PairDesign:
    """Without a name of its own it would be "unnamed"."""
    design = design_from_tables(tomllib.loads(text), where=lambda key: key, default_name="unnamed")
    assert isinstance(design, PairDesign)
    return design


@pytest.mark.parametrize("name", PAIRS)
def test_starters_are_written_as_they_were_read(name: str) -> None:
    design = read(starter_text(name)[1])
    again = read(pair_text(design))
    assert again == design
    assert again.pair.to_dict() == design.pair.to_dict()
    assert pair_text(again) == pair_text(design)


@settings(max_examples=25, deadline=None)
@given(pair_inputs(), MODIFICATIONS, st.booleans())
def test_any_pair_is_written_to_the_last_digit(inputs: dict[str, object], changes: dict[str, float] | None, held: bool) -> None:
    try:
        pair = build_pair(inputs)
        gears = [modified(gear, changes) for gear in pair.gears]
        distance = {"centre_distance": float(pair.centre_distance)} if held else {}
        pair = GearPair(pinion=gears[0], wheel=gears[1], name="any", axial_offset=pair.axial_offset, **distance)
    except GearcadError:
        assume(False)
    again = read(pair_text(PairDesign(name="any", pair=pair)))
    assert again.pair == pair
    assert again.pair.to_dict() == pair.to_dict()


def test_what_a_spec_would_guess_is_written() -> None:
    """The other hand, automatic tips, names of gears, and enums, digits and words of the tables beside them."""
    gears = [
        Gear(name=name, teeth=teeth, normal_module=1 / 3, face_width=20 / 7, tooth_thinning=0.01)
        for name, teeth in (("sun", 20), ('planet ü "1"', 21))
    ]
    pair = GearPair(pinion=gears[0], wheel=gears[1], name="sun-planet")
    beside = {
        "material": Material(name="16MnCr5", density=7.1e3, contact_limit=(1.1e3, 1.3e3)),
        "load": Load(torque=1e-5 / 3, speed=-1e3 / 7),
        "rating": RatingOptions(standard=Edition.DIN_1987, accuracy_grade=5),
    }
    design = PairDesign(name="sun-planet", pair=pair, **beside)
    text = pair_text(design, ["one line,", "another"])
    assert text.startswith("# one line,\n# another\n\n[pair]\n")
    assert text.count("tip_alteration = 0.0") == text.count("helix_angle = 0.0") == 2
    assert "auto" not in text
    assert read(text) == design
