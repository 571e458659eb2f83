"""Inputs of the page: fields of every kind of spec, text under change, a second design, and the shift diagram."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomlkit

from gearcad.core.errors import GearcadError, ParameterError, SpecError
from gearcad.core.runtime import templates
from gearcad.designs.reader import read_spec, starter_text
from gearcad.page.fields import LimitMap, fields_of, given_texts, limit_map, used_texts
from gearcad.page.folder import pack
from gearcad.page.workbench import BesideDesign, DesignStatus, Fault, Workbench, linked_bench
from gearcad.sizing.geometry import Free, LimitKind


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
    assert (
        len(used_texts(bench.design, bench.tables).keys() & fields.keys()) > len(fields) / 5
    )  # the others are keys of what a design may have


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


def test_parts_of_a_train_are_edited_as_text() -> None:
    bench = _bench("train-1-stage")
    fields = _fields(bench)
    assert {key.partition(".")[0] for key in fields} == {"train", "dynamics"}
    assert not [key for key in fields if key.startswith(("train.mesh", "train.shaft", "train.inertia"))]
    bench.change({"train.speed": "900", "dynamics.speed_to": "4000"})
    assert (bench.fault, bench.tables["train"]["speed"], bench.tables["dynamics"]["speed_to"]) == (None, 900, 4000)


GEAR = '[gear]\nname = "{name}"\nteeth = {teeth}\nnormal_module = 2.0\nface_width = 10.0\n'


@pytest.fixture
def bench(tmp_path: Path) -> Workbench:
    (tmp_path / "other.toml").write_text(GEAR.format(name="other", teeth=40), encoding="utf-8")
    return Workbench(GEAR.format(name="trial", teeth=20), "trial", tmp_path)


def teeth(design: object) -> int:
    return int(design.gears["gear"].teeth)  # type: ignore[attr-defined]


def test_the_kept_design_stays_while_the_other_changes(bench: Workbench) -> None:
    beside = BesideDesign(bench)
    assert beside.design is None
    beside.keep()
    bench.change({"gear.teeth": "25"})
    assert (teeth(beside.design), teeth(bench.design)) == (20, 25)
    beside.let_go()
    assert beside.design is None


def test_both_change_places_and_back(bench: Workbench) -> None:
    beside = BesideDesign(bench)
    beside.swap()
    assert beside.design is None
    beside.open("other.toml")
    text = bench.text
    beside.swap()
    assert (bench.design.name, teeth(bench.design), teeth(beside.design)) == ("other", 40, 20)
    assert bench.can_undo
    beside.swap()
    assert (bench.text, teeth(beside.design)) == (text, 40)


def test_what_makes_no_gear_is_not_kept(bench: Workbench) -> None:
    beside = BesideDesign(bench)
    beside.open("other.toml")
    bench.change({"gear.teeth": "2"})
    for ask in (beside.keep, beside.swap):
        with pytest.raises(GearcadError, match=r"gear\.teeth = 2: must be a whole number"):
            ask()
    assert teeth(beside.design) == 40


@pytest.mark.parametrize("file", ["../other.toml", "/etc/passwd", "none.toml", ""])
def test_only_specs_of_the_folder_are_opened(bench: Workbench, file: str) -> None:
    with pytest.raises(ParameterError):
        BesideDesign(bench).open(file)


def _map(bench: Workbench) -> LimitMap:
    found = limit_map(bench.design, bench.tables)
    assert found is not None
    return found


def test_a_pair_at_a_centre_distance_has_shift_and_helix() -> None:
    bench = _bench("fzg-c")
    found = _map(bench)
    assert [each.free for each in found.variables] == [Free.FIRST, Free.HELIX]
    bench.change(found.across.typed(0.25) | found.up.typed(12.0))
    assert (bench.fault, bench.design.gears["wheel"].helix_angle) == (None, -12)
    assert bench.tables["pinion"]["profile_shift"] == 0.25


def test_a_pair_without_has_both_shifts() -> None:
    bench = _bench("fzg-c")
    bench.change(
        {"pair.centre_distance": "", "wheel.profile_shift": "-0.1", "pinion.helix_angle": "-10", "wheel.helix_angle": "10"}
    )
    found = _map(bench)
    assert [each.free for each in found.variables] == [Free.FIRST, Free.SECOND, Free.HELIX]
    assert found.others[0].value == 10
    assert found.others[0].typed(15.0) == {"pinion.helix_angle": "-15.0", "wheel.helix_angle": "15.0"}


def test_the_map_has_the_design_where_it_stands() -> None:
    bench = _bench("reducer-21-43")
    found, pair = _map(bench), bench.design.gears
    ratio = next(each.values for each in found.map.limits if each.kind is LimitKind.CONTACT_RATIO)
    column = np.interp(found.across.value, found.map.across.values, np.arange(ratio.shape[1]))
    row = np.interp(found.up.value, found.map.up.values, np.arange(ratio.shape[0]))
    exact = bench.design.to_dict()["pair"]["transverse_contact_ratio"]
    assert ratio[round(row), round(column)] == pytest.approx(exact, abs=0.05)
    assert found.across.value == pair["pinion"].profile_shift


def test_a_gear_has_teeth_and_shift() -> None:
    bench = _bench("spur")
    found = _map(bench)
    assert [each.free for each in found.variables] == [Free.TEETH, Free.FIRST, Free.HELIX]
    assert found.across.typed(24.4) == {"gear.teeth": "24"}


@pytest.mark.parametrize("name", ["ring-22-70", "planetary-24-21-66"])
def test_others_have_none(name: str) -> None:
    bench = _bench(name)
    assert limit_map(bench.design, bench.tables) is None


def test_a_rack_and_pinion_has_that_of_its_pinion() -> None:
    bench = Workbench((Path(templates()) / "rack.toml").read_text(encoding="utf-8"), "rack", templates())
    assert list(_map(bench).up.keys) == ["pinion.profile_shift"]


SPEC = """\
# a pair
[pair]
normal_module = 4.5  # mm
face_width = 14.0

[pinion]
teeth = 16
profile_shift = 0.1817

[wheel]
teeth = 24
"""


class Clock:
    """Seconds that pass when a test says so."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def session(clock: Clock) -> Workbench:
    return Workbench(SPEC, "pair", Path(), clock)


def test_what_is_typed_without_a_pause_is_one_step(session: Workbench, clock: Clock) -> None:
    for at, typed in enumerate(("1", "17", "170")):
        clock.now = 0.9 * at
        session.change({"pinion.teeth": typed})
    assert session.tables["pinion"]["teeth"] == 170
    assert session.former["pinion"]["teeth"] == 16
    session.undo()
    assert session.text == SPEC
    assert not session.can_undo
    session.redo()
    assert session.tables["pinion"]["teeth"] == 170


@pytest.mark.parametrize(("key", "seconds"), [("pinion.teeth", 1.1), ("wheel.teeth", 0.1)])
def test_a_pause_or_another_field_begins_a_step(session: Workbench, clock: Clock, key: str, seconds: float) -> None:
    session.change({"pinion.teeth": "17"})
    clock.now = seconds
    session.change({key: "25"})
    session.undo()
    assert (session.tables["pinion"]["teeth"], session.tables["wheel"]["teeth"]) == (17, 24)


def test_numbered_steps_are_undone_as_they_were_typed(session: Workbench, clock: Clock) -> None:
    """However late they come, or how soon one after the other."""
    for step, seconds, typed in ((1, 0.0, "17"), (1, 5.0, "18"), (2, 5.1, "19")):
        clock.now = seconds
        session.change({"pinion.teeth": typed}, step)
    session.undo()
    assert session.tables["pinion"]["teeth"] == 18
    session.undo()
    assert session.text == SPEC


def test_after_undo_typing_begins_a_step(session: Workbench) -> None:
    session.change({"pinion.teeth": "17"})
    session.undo()
    session.change({"pinion.teeth": "18"})
    assert session.can_undo
    assert not session.can_redo
    session.undo()
    assert session.text == SPEC


def test_comments_stay_and_a_key_goes(session: Workbench) -> None:
    session.change({"pair.normal_module": "5,5"})
    assert "normal_module = 5.5  # mm" in session.text
    session.change({"pinion.profile_shift": ""})
    assert "profile_shift" not in session.text
    assert session.design.gears["pinion"].profile_shift == 0


def test_a_fault_is_the_line_of_the_command_line_and_the_last_good_design_stays(session: Workbench, tmp_path: Path) -> None:
    session.change({"pinion.teeth": "3"})
    (spec := tmp_path / "pair.toml").write_text(session.text)
    with pytest.raises(SpecError) as refused:
        read_spec(spec)
    assert session.fault is not None
    assert str(refused.value) == f"{tmp_path}/{session.fault.line}"
    assert session.fault.key == refused.value.key
    assert session.design.gears["pinion"].teeth == 16
    session.change({"pinion.teeth": "18"})
    assert session.fault is None


def test_text_that_is_no_toml_says_where(session: Workbench) -> None:
    session.write(SPEC.replace("teeth = 24", "teeth = "), "text")
    assert session.fault is not None
    assert session.fault.line.startswith("pair.toml line 11")
    assert session.tables["wheel"]["teeth"] == 24


def test_what_cannot_be_written_is_no_step(session: Workbench) -> None:
    assert not session.change({"pair.normal_module": "1.234,5"})
    assert session.fault == Fault(
        "pair.normal_module = '1.234,5': has a comma and a point; write it without a thousands separator",
        "pair.normal_module",
        written=False,
    )
    assert session.text == SPEC
    assert not session.can_undo


def test_what_a_named_file_names_must_be_in_the_folder_too(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (tmp_path / "title.toml").write_text("", encoding="utf-8")
    tables = tomllib.loads(starter_text("train-pairs")[1])
    mesh = tables["train"]["mesh"][0]
    inner = {"pair": mesh["pair"], "drawing": {"template": "../title.toml"}}
    inner |= {role: inner["pair"].pop(role) for role in ("pinion", "wheel")}
    (folder / "inner.toml").write_text(tomlkit.dumps(inner), encoding="utf-8")
    mesh["pair"] = "inner.toml"
    with pytest.raises(SpecError, match="must be a file in the folder of the page"):
        Workbench(tomlkit.dumps(tables), "train", folder)


def test_the_eldest_steps_go_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.page.workbench._MOST_STEPS", 3)
    bench = Workbench(SPEC, "pair", Path())
    for teeth in range(17, 22):
        bench.write(SPEC.replace("teeth = 16", f"teeth = {teeth}"))
    for _ in range(5):
        bench.undo()
    assert "teeth = 18\n" in bench.text


@pytest.mark.parametrize(
    ("name", "key", "bounds"),
    [
        ("reducer-21-43", "pinion.teeth", (3, 2000, None)),
        ("reducer-21-43", "wheel.teeth", (3, 2000, -10)),
        ("spur", "gear.teeth", (3, 2000, -10)),
        ("planetary-24-21-66", "planet.teeth", (3, 2000, None)),
        ("planetary-24-21-66", "ring.teeth", (-2000, -10, None)),
    ],
)
def test_bounds_of_numbers_of_teeth(name: str, key: str, bounds: tuple[int, int, int | None]) -> None:
    field = _fields(_bench(name))[key]
    assert (field["least"], field["most"], field["negative"]) == bounds


def test_a_part_that_has_parts_stands_with_them() -> None:
    bench = _bench("planetary-alm")
    groups = [group for table in fields_of(bench.design, bench.tables) for group in table["groups"]]
    assert {group["part"] for group in groups if group["family"] == "Pre stage"} == {
        group["part"] for group in groups if group["part"].startswith("pre_stage")
    }
    assert not any("Pre stage" in group["titles"] for group in groups)


def test_all_faults_are_found() -> None:
    bench = _bench("reducer-21-43")
    wrong = {"pinion.teeth": "2", "wheel.profile_shift": "9", "load.speed": "fast", "pair.normal_module": "-3"}
    for key, text in wrong.items():
        bench.change({key: text})
    assert {fault.key for fault in bench.faults()} == wrong.keys()
    assert bench.faults()[0] == bench.fault
    bench.change({"pinion.teeth": "21"})
    assert len(bench.faults()) == len(wrong) - 1
    bench.write("[pair")
    assert bench.faults() == (bench.fault,)


NOTHING = "[gear]\nteeth = 2\n"
"""A spec that makes no gear."""


def test_a_fault_leaves_the_last_good_design_of_the_same_spec_only(bench: Workbench) -> None:
    assert (bench.status, bench.shown_design) == (DesignStatus.PRESENT, bench.design)
    for wrong in ("2", "1.2,3"):
        bench.change({"gear.teeth": wrong})
        assert (bench.status, bench.shown_design) == (DesignStatus.LAST_GOOD, bench.design)
    bench.open(NOTHING, "nothing")
    assert (bench.status, bench.shown_design) == (DesignStatus.OTHER, None)
    bench.undo()
    assert (bench.status, bench.name) == (DesignStatus.LAST_GOOD, "trial")
    bench.undo()
    assert bench.status is DesignStatus.PRESENT
    for _ in range(2):
        bench.redo()
    assert (bench.status, bench.name, bench.tables) == (DesignStatus.OTHER, "nothing", {"gear": {"teeth": 2}})
    bench.write(GEAR.format(name="mended", teeth=30), "text")
    assert bench.status is DesignStatus.PRESENT
    bench.undo()
    assert bench.status is DesignStatus.LAST_GOOD


def test_inputs_of_a_spec_that_cannot_be_read_are_none_of_another(bench: Workbench) -> None:
    bench.open("no TOML", "broken")
    assert (bench.status, bench.tables) == (DesignStatus.OTHER, {})
    bench.blame("a line about no input")
    assert bench.status is DesignStatus.OTHER
    bench.undo()
    bench.blame("a line about no input")
    assert bench.status is DesignStatus.PRESENT


def test_fields_of_a_spec_that_makes_nothing_are_those_of_its_kind(bench: Workbench) -> None:
    bench.open("[planetary]\nplanets = 3\n[sun]\nteeth = 24\n", "train")
    keys = {field["key"] for table in fields_of(None, bench.tables) for group in table["groups"] for field in group["fields"]}
    assert {"planetary.planets", "sun.teeth"} <= keys and "gear.teeth" not in keys


def test_a_design_is_saved_while_its_file_has_its_text(bench: Workbench) -> None:
    assert bench.is_saved
    bench.change({"gear.teeth": "21"}, 1)
    changed = bench.text
    assert not bench.is_saved
    bench.open(GEAR.format(name="other", teeth=40), "other")
    assert (bench.is_saved, bench.name) == (True, "other")
    bench.undo()
    assert (bench.is_saved, bench.name) == (False, "trial")
    copied = bench.copied()
    bench.note_saved("renamed", changed)
    assert (bench.is_saved, bench.name, copied.is_saved, copied.name) == (True, "renamed", False, "trial")
    bench.undo()
    assert (bench.is_saved, bench.name) == (False, "renamed")


def test_a_design_of_a_link_is_saved_if_its_file_has_its_text(bench: Workbench) -> None:
    text = (bench.folder / "other.toml").read_text(encoding="utf-8")
    for linked, is_saved in ((text, True), (f"# new\n{text}", False), (NOTHING, False)):
        assert linked_bench(pack("other", linked), bench.text, "trial", bench.folder).is_saved is is_saved
    assert linked_bench(pack("nowhere", text), bench.text, "trial", bench.folder).is_saved


def test_parts_of_a_pair_that_a_train_does_not_have_are_inner() -> None:
    bench = Workbench(starter_text("planetary-24-21-66")[1], "x", Path())
    tables = {table["table"]: table["groups"] for table in fields_of(bench.design, bench.tables)}
    stage = [group for group in tables["planetary"] if group["family"] == "Pre stage"]
    assert [group["titles"] for group in stage if not group["inner"]] == [[], ["Pinion"], ["Wheel"]]
    assert len(stage) > 20 and not any(group["inner"] for group in tables["sun"] if not group["family"])
