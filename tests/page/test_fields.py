"""What the page has of the inputs of every kind of spec: a field for each key, what is given and what is used."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gearcad.core.runtime import templates
from gearcad.page.fields import fields_of, given_texts, used_texts
from gearcad.page.workbench import Workbench


def _bench(name: str) -> Workbench:
    return Workbench((templates() / f"{name}.toml").read_text(encoding="utf-8"), name, templates())


def _fields(bench: Workbench) -> dict[str, dict[str, Any]]:
    tables = fields_of(bench.design, bench.tables)
    return {field["key"]: field for table in tables for group in table["groups"] for field in group["fields"]}


_KINDS = ("spur", "fzg-c", "ring-22-70", "rack", "double-23-81", "planetary-differential", "planetary-alm")


@pytest.mark.parametrize("name", _KINDS)
def test_every_key_that_is_given_has_a_field(name: str) -> None:
    bench = _bench(name)
    fields = _fields(bench)
    assert not given_texts(bench.tables).keys() - fields.keys()
    assert len(used_texts(bench.design, bench.tables).keys() & fields.keys()) > len(fields) / 4


def test_what_is_used_is_shared_derived_or_by_default() -> None:
    bench = _bench("fzg-c")
    used = used_texts(bench.design, bench.tables)
    assert used["pinion.normal_module"] == "4.5"
    assert used["pinion.tip_alteration"] == f"{bench.design.gears['pinion'].tip_alteration:.7g}"
    assert used["pinion.rack.dedendum"] == "1.25"
    assert used["check.model"] == "auto"


def test_gears_of_a_train_are_used_under_the_names_of_their_tables() -> None:
    bench = _bench("planetary-alm")
    used = used_texts(bench.design, bench.tables)
    assert used["planet.teeth"] == str(bench.design.gears["rim_3"].teeth)
    assert used["ring_2.normal_module"] == f"{bench.design.gears['ring_5'].normal_module:.7g}"


def test_fields_say_what_the_schema_says() -> None:
    fields = _fields(_bench("planetary-24-21-66"))
    assert fields["planetary.input"]["offered"] == ["sun", "ring", "carrier"]
    assert fields["sun.profile_shift"]["offered"] == ["auto"]
    assert fields["sun.helix_angle"]["unit"] == "°"
    assert fields["sun.teeth"]["whole"]
    assert fields["sun.body.keyway"]["choices"] == ["true", "false"]
    assert (fields["rating.life"]["least"], fields["rating.life"]["number"]) == (1e-6, True)


def test_pairs_and_racks_have_distances_of_their_own() -> None:
    gears, racks = _fields(_bench("fzg-c")), _fields(_bench("rack"))
    assert ("pair.centre_distance" in gears, "pair.mounting_distance" in gears) == (True, False)
    assert ("pair.centre_distance" in racks, "pair.mounting_distance" in racks) == (False, True)


def test_a_train_is_edited_as_text() -> None:
    bench = Workbench((Path(templates()) / "train-1-stage.toml").read_text(encoding="utf-8"), "train", templates())
    assert fields_of(bench.design, bench.tables) == []
