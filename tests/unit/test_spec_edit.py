"""Editing the text of a spec: new values in, everything else as it was."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from gearcad.core.errors import SpecError
from gearcad.designs import read_spec
from gearcad.designs.reader import edit_spec

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
