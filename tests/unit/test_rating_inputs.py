"""What a user tells a rating: its table in a spec, the material's group, web and rim of a blank, and the way they go."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gearcad import Body, Gear, GeometryError, ParameterError
from gearcad.core.errors import SpecError
from gearcad.core.output import json_text
from gearcad.designs import open_table, read_spec
from gearcad.dynamics.options import DynamicsOptions
from gearcad.material import Material, MaterialGroup
from gearcad.rating import Accuracy, Edition, RatingOptions

SPEC = """
[pair]
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 20
[wheel]
teeth = 60
body.bore = 30.0
body.web_thickness = 6.0
body.rim_thickness = 5.0
[load]
torque = 50.0
[material]
group = "V"
contact_endurance_limit = 700
[rating]
standard = "DIN 3990:1987"
accuracy = "ISO 1328-1:2013"
accuracy_grade = 7
"""


def spec(folder: Path, text: str = SPEC) -> Path:
    path = folder / "it.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_spec_tells_the_rating(tmp_path: Path) -> None:
    design = read_spec(spec(tmp_path))
    assert design.rating == RatingOptions(standard=Edition.DIN_1987, accuracy=Accuracy.ISO_2013, accuracy_grade=7)
    assert design.material == Material(group=MaterialGroup.THROUGH_HARDENED, contact_endurance_limit=700.0)
    assert design.gears["wheel"].body == Body(bore=30.0, web_thickness=6.0, rim_thickness=5.0)
    assert design.warnings == (
        "wheel: web: it counts in the rating alone (C_R, Y_B); the solid and its elements are a full disc",
    )
    document = json.loads(json_text(design.to_dict()))
    given = {"standard": "DIN 3990:1987", "accuracy": "ISO 1328-1:2013", "accuracy_grade": 7}
    assert {key: document["rating"][key] for key in given} == given
    assert document["material"]["group"] == "V"


def test_row_of_a_table_tells_the_same(tmp_path: Path) -> None:
    path = tmp_path / "it.csv"
    heads = "rating.standard,rating.accuracy,rating.accuracy_grade,material.group,material.contact_endurance_limit,load.torque"
    path.write_text(
        f"name,normal_module,face_width,pinion.teeth,wheel.teeth,wheel.body.bore,wheel.body.web_thickness,"
        f"wheel.body.rim_thickness,{heads}\nit,2,20,20,60,30,6,5,DIN 3990:1987,ISO 1328-1:2013,7,V,700,50\n",
        encoding="utf-8",
    )
    (row,) = open_table(path).rows()
    expected, found = read_spec(spec(tmp_path)), row.design()
    assert (found.rating, found.material, found.gears) == (expected.rating, expected.material, expected.gears)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"DIN 3990:1987"', '"ISO 6336:1996"', "rating.standard = 'ISO 6336:1996': must be one of 'ISO 6336:2006', 'ISO"),
        ('group = "V"', 'group = "case"', "material.group = 'case': must be one of 'St', 'St (cast)', 'V',"),
        ("accuracy_grade = 7", "accuracy_grade = 0", "rating.accuracy_grade = 0: must be a whole number from 1 to 11"),
        ("accuracy_grade = 7", "accuracy_grad = 7", "rating.accuracy_grad: unknown key; did you mean accuracy_grade?"),
        ("[rating]", "[ratings]", "did you mean [rating]?"),
        ("body.rim_thickness = 5.0", "", "wheel.body.rim_thickness = 0 mm (by default): must be above 0 mm, as web_thickness"),
        ("body.rim_thickness = 5.0", "body.rim_thickness = 45.0", "must be at most 42.5 mm, what bore and keyway leave"),
    ],
)
def test_faults_name_key_and_choices(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(SpecError) as caught:
        read_spec(spec(tmp_path, SPEC.replace(old, new)))
    assert message in str(caught.value)


def test_blank_by_itself() -> None:
    with pytest.raises(GeometryError, match="web_thickness"):
        Body(rim_thickness=3.0)
    with pytest.raises(ParameterError, match="must be a number at least 0 mm"):
        Body(rim_thickness=3.0, web_thickness=-1.0)
    assert Gear(teeth=60, normal_module=2.0, face_width=20.0, body=Body(web_thickness=25.0, rim_thickness=5.0)).warnings


def test_one_accuracy_grade() -> None:
    """That of the rating; the dynamics may have another one."""
    rating = RatingOptions(accuracy_grade=8)
    assert DynamicsOptions().graded(rating).accuracy_grade == 8
    assert DynamicsOptions(accuracy_grade=5).graded(rating).accuracy_grade == 5


def test_check_goes_by_the_rating(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import gearcad.jobs.strength

    seen: list[Any] = []
    monkeypatch.setattr(gearcad.jobs.strength, "check_pair", lambda *arguments: seen.extend(arguments))
    design = read_spec(spec(tmp_path))
    gearcad.check(design)
    assert seen[0].rating_options is design.rating
