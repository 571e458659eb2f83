"""Columns and data sheet of trains; options without effect are told, and those of the starters can be used."""

import json
import math
import re
import tomllib
from dataclasses import fields, replace
from pathlib import Path

import pytest

import gearcad
from gearcad.batch.row import _warnings, flat_document
from gearcad.batch.study import plan_study, write_study
from gearcad.designs import PairDesign, TrainDesign, design_from_tables, open_table, read_spec
from gearcad.designs.keys import permitted_words
from gearcad.designs.reader import starter_text
from gearcad.designs.variations import column_symbol
from gearcad.dynamics import Inertia, Shaft, ToothMesh, Train
from gearcad.dynamics.options import DynamicsOptions, idle_in_contact, idle_without_levels, undamped_bearings
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.jobs.dynamics import Dynamics, dynamics_columns
from gearcad.jobs.job import Data
from gearcad.rating import RatingOptions, endurance_limits

_, TWO_STAGES = starter_text("train-2-stage")

COUPLE = Train(
    inertias=(Inertia(name="warnings", inertia=0.01), Inertia(name="b", inertia=0.08)),
    meshes=(ToothMesh(name="m", pinion="warnings", wheel="b", base_radii=(50.0, 100.0), stiffness=400.0, teeth=20),),
    torques={"warnings": 100.0, "b": 200.0},
    speed=1500.0,
)


def test_data_of_a_train_by_hand() -> None:
    found = gearcad.data(COUPLE)
    mesh, wheel = found["mesh"]["m"], found["inertia"]["b"]
    assert mesh["reduced_mass"] == pytest.approx(1 / (0.05**2 / 0.01 + 0.1**2 / 0.08), rel=1e-12)
    assert mesh["natural_frequency"] == pytest.approx(math.sqrt(400e6 / mesh["reduced_mass"]) / (2 * math.pi), rel=1e-12)
    assert mesh["static_force"] == pytest.approx(100.0 / 0.05, rel=1e-9)
    assert (mesh["gear_ratio"], mesh["tooth_frequency"]) == (2.0, 500.0)
    assert (wheel["speed_ratio"], wheel["speed"], wheel["torque"]) == (-0.5, -750.0, 200.0)
    assert found["train"]["held"] is False and found["train"]["torques"] == {"warnings": 100.0, "b": 200.0}


def test_data_of_shafts_by_hand() -> None:
    shaft = Shaft(name="s", start="ground", end="warnings", length=500.0, diameter=40.0, inner_diameter=20.0)
    found = gearcad.data(replace(COUPLE, shafts=(shaft,)))["shaft"]["s"]
    polar = math.pi / 32 * (0.04**4 - 0.02**4)
    assert found["torsional_stiffness"] == pytest.approx(80770e6 * polar / 0.5, rel=1e-12)
    assert found["inertia"] == pytest.approx(7850 * polar * 0.5, rel=1e-12)


def test_a_train_without_meshes_has_data(tmp_path: Path) -> None:
    shaft = Shaft(name="s", start="warnings", end="b", torsional_stiffness=1e4)
    found = gearcad.data(Train(inertias=COUPLE.inertias, shafts=(shaft,)))
    assert found["mesh"] == {} and "speed" not in found["inertia"]["b"]


def test_a_part_called_warnings_warns_of_nothing() -> None:
    assert list(_warnings(gearcad.data(COUPLE))) == []


@pytest.fixture(scope="module")
def document() -> dict[str, object]:
    """dynamics.json of a train of two stages, quick to make."""
    design = TrainDesign(
        name="t",
        train=replace(two_stages(), speed=2000.0),
        dynamics=DynamicsOptions(speeds=20, harmonics=2, speed_to=6000.0, frequencies=4),
    )
    job = Dynamics()
    return json.loads(json.dumps(job.document(job.run(design))))  # type: ignore[no-any-return]


def two_stages() -> Train:
    """That of the starter, with meshes that differ."""
    design = design_from_tables(tomllib.loads(TWO_STAGES), where=str, default_name="t")
    assert isinstance(design, TrainDesign)
    first, second = design.train.meshes
    return replace(design.train, meshes=(first, replace(second, name="stage 2.5", stiffness=300.0)))


def test_figures_of_a_line_are_those_of_the_document(document: dict[str, dict[str, dict[str, list[float]]]]) -> None:
    found = dynamics_columns(document)
    kv = document["chart"]["kv"]
    assert list(kv) == ["stage 1", "stage 2.5"]
    for name, factors in kv.items():
        assert found[f"kv_highest.{name}"] == max(factors)
        assert document["speed"][factors.index(max(factors))] == found[f"kv_highest_speed.{name}"]  # type: ignore[index,arg-type]
    assert (
        found["kv_highest"]
        == max(max(factors) for factors in kv.values())
        == kv[found["kv_highest_mesh"]][
            document["speed"].index(found["kv_highest_speed"])  # type: ignore[attr-defined]
        ]
    )
    assert (found["course_speed"], found["kv.stage 1"]) == (pytest.approx(2000.0), document["course"]["kv"][0])  # type: ignore[index]
    elastic = [each for each in document["modes"]["frequency"] if each > 0]
    assert [found[f"frequency_{number}"] for number in range(1, len(elastic) + 1)] == elastic
    overload = document["chart"]["shaft_overload"]
    assert {key.partition(".")[2]: each for key, each in found.items() if key.startswith("shaft_overload.")} == {
        name: max(factors) for name, factors in overload.items() if None not in factors
    }


def test_every_column_is_explained(document: dict[str, object]) -> None:
    design = TrainDesign(name="t", train=replace(two_stages(), speed=2000.0))
    row = Data().document(design)
    row["dynamics"] |= dynamics_columns(document)
    headings = dict(flat_document(json.loads(json.dumps(row))))
    unexplained = [heading for heading in headings if (found := column_symbol(heading)) is None or not found[1].words]
    assert unexplained == []
    assert (column_symbol("dynamics.shaft_overload.input") or ("",))[0] == "input"


def test_a_row_makes_the_document_of_the_spec_edited_by_hand(tmp_path: Path) -> None:
    text = TWO_STAGES.replace("speed_to = 9000.0", "speed_to = 4000.0\nspeeds = 10\nharmonics = 2")
    path = tmp_path / "t.toml"
    path.write_text(text, encoding="utf-8")
    write_study(plan_study(path, ["shaft.*.damping=2", "mesh.stage 2.stiffness=500,600"]), tmp_path / "t.csv")
    row = list(open_table(tmp_path / "t.csv").rows())[1]
    before, _, second = text.replace("damping = 1.0", "damping = 2.0").rpartition("stiffness = 750.0")
    path.write_text(f"{before}stiffness = 600.0{second}", encoding="utf-8")
    made, by_hand = (Dynamics().run(design).to_dict() for design in (row.design(), read_spec(path)))
    assert made == by_hand


LEVELS = "a train with a list of models, held against each other"


def test_what_is_for_levels_or_for_the_mesh() -> None:
    assert not idle_without_levels(DynamicsOptions(tooth_errors="on")) and not idle_in_contact(DynamicsOptions(model="contact"))
    (one,) = idle_without_levels(DynamicsOptions(operating_to=5000.0, level_tolerance=0.1))
    assert one.text == f"without effect here: level_tolerance, which is for {LEVELS}"
    asked = DynamicsOptions(
        model="contact", tooth_errors="on", error_samples=5, premature_engagement="on", level_tolerance=0.1, zone="one pair"
    )
    assert [each.text for each in idle_in_contact(asked)] == [
        'without effect here: tooth_errors, error_samples, premature_engagement, which are for the model "mesh" of a pair',
        f"without effect here: level_tolerance, which is for {LEVELS}",
    ]


def test_bearings_without_damping() -> None:
    given = {"pinion_bearing_stiffness": 300.0, "wheel_bearing_stiffness": 300.0}
    assert not undamped_bearings(DynamicsOptions()) and not undamped_bearings(DynamicsOptions(**given, bearing_damping=10.0))
    (one,) = undamped_bearings(DynamicsOptions(**given))
    assert one.code == "undamped-bearings" and "bearing_damping" in one.text


def test_an_unknown_key_names_the_nearest_of_many() -> None:
    words = permitted_words("xyzzy", [f"key_{number}" for number in range(30)])
    assert words.startswith("the nearest of the 30 permitted are ") and words.count(",") == 4
    assert permitted_words("xyzzy", ["a", "b"]) == "permitted are a, b"


OPTION = re.compile(r"^# (?=\[dynamics|\w+ = )", re.MULTILINE)


@pytest.mark.parametrize("name", ["train-1-stage", "train-2-stage", "train-pairs", "fzg-c"])
def test_commented_options_of_the_dynamics(name: str, tmp_path: Path) -> None:
    _, text = starter_text(name)
    head, found, options = re.split(r"(?m)^((?:# )?\[dynamics\])", text)
    spec = tmp_path / "all.toml"
    spec.write_text(head + found.removeprefix("# ") + OPTION.sub("", options), encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign | TrainDesign) and design.dynamics is not None
    read = design.dynamics
    assert read.error_samples > 1 and read.distribution.value == "normal" and read.transient is not None
    if name == "train-1-stage":  # it shows all there is
        assert read.level_tolerance == 0.05 and read.operating_to is not None and read.premature
        assert all(f"\n# {field.name} = " in options.partition("[dynamics.transient]")[2] for field in fields(TransientOptions))


@pytest.mark.parametrize("name", ["fzg-c", "volvo-13-44", "ring-22-70"])
def test_commented_options_of_material_and_rating(name: str, tmp_path: Path) -> None:
    _, text = starter_text(name)
    for table in ("material", "rating"):
        head, found, rest = re.split(rf"(?m)^((?:# )?\[{table}\])", text)
        options, gap, others = rest.partition("\n\n")
        text = head + found.removeprefix("# ") + OPTION.sub("", options) + gap + others
    spec = tmp_path / "all.toml"
    spec.write_text(text, encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign) and design.rating is not None
    assert all(endurance_limits(material).contact for material in design.materials)
    assert design.materials.pinion.name == "Eh MQ" and design.rating.life == 20000.0
    if name == "fzg-c":  # it shows all there is
        assert all(re.search(rf"\b{field.name} = ", text) for field in fields(RatingOptions))


def test_lists_of_models_in_comments(tmp_path: Path) -> None:
    for name in ("train-1-stage", "train-2-stage"):
        _, text = starter_text(name)
        (listed,) = re.findall(r"^#.*(model = \[.*?\])|^model.*(model = \[.*?\])", text, re.MULTILINE)[:1]
        spec = tmp_path / f"{name}.toml"
        spec.write_text(re.sub(r"(?m)^model = .*$", listed[0] or listed[1], text), encoding="utf-8")
        design = read_spec(spec)
        assert isinstance(design, TrainDesign) and len(design.models) > 1
