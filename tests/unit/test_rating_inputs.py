"""Inputs of a rating, its edition of 2019, and racks as the limit of wheels of ever more teeth."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.cases import STEEL, sample_pair

from gearcad import BasicRack, Body, FlankModification, Gear, GearPair, GeometryError, Load, ParameterError, RackPair
from gearcad import rate as rack_rate
from gearcad.core.errors import SpecError
from gearcad.core.output import json_text
from gearcad.designs import open_table, read_spec
from gearcad.dynamics.options import DynamicsOptions
from gearcad.geometry import Rack
from gearcad.material import Material, MaterialGroup
from gearcad.rating import Accuracy, Edition, RatingOptions, rate, rate_rack
from gearcad.rating.editions import load_distribution_factor, modification_factor, relieved
from gearcad.rating.factors import citations, to_verify
from gearcad.rating.nominal_rating import rack_contact_at
from gearcad.rating.root_stress import deep_tooth_factor

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


LOAD = Load(torque=350.0)
NEW, OLD = RatingOptions(standard=Edition.ISO_2019), RatingOptions(standard=Edition.ISO_2006)
EXACT = 1e-12


def test_load_distribution() -> None:
    """f_eps by eps_alphan and eps_beta; the same of numbers and arrays."""
    ratio = np.array([1.5, 2.2, 1.5, 2.2, 1.5, 2.2])
    overlap = np.array([0, 0, 0.5, 0.5, 1.4, 1.4])
    expected = [1, 0.7, math.sqrt(0.5 + 0.5 / 1.5), math.sqrt(0.25 + 0.5 / 2.2), math.sqrt(1 / 1.5), math.sqrt(1 / 2.2)]
    assert load_distribution_factor(ratio, overlap) == pytest.approx(expected, rel=EXACT)
    assert [load_distribution_factor(float(a), float(b)) for a, b in zip(ratio, overlap, strict=True)] == pytest.approx(
        expected
    )


@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_what_changes_and_what_does_not(helix: float) -> None:
    pair = sample_pair(helix)
    new, old = rate(pair, STEEL, LOAD, NEW), rate(pair, STEEL, LOAD, OLD)
    raised = 1.07 if helix else 1.2
    for role in ("pinion", "wheel"):
        one, other = getattr(new.roots, role), getattr(old.roots, role)
        ratio = pair.transverse_contact_ratio / math.cos(math.radians(pair.pinion.base_helix_angle)) ** 2
        f_eps = load_distribution_factor(ratio, pair.overlap_ratio)
        assert one.form_factor == pytest.approx(other.form_factor * f_eps, rel=EXACT)
        lean = math.cos(math.radians(helix)) ** 3
        assert one.helix_angle_factor == pytest.approx(other.helix_angle_factor / lean, rel=EXACT)
        assert one.nominal_stress == pytest.approx(other.nominal_stress * f_eps / lean, rel=EXACT)
        contact = getattr(old.flank.contact_factors, role) * raised
        assert getattr(new.flank.contact_factors, role) == pytest.approx(contact, rel=EXACT)
    assert new.flank.nominal_stress == old.flank.nominal_stress
    assert new.stiffness == old.stiffness
    assert new.verify == ("Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT")
    assert not old.verify
    assert {notice.code for notice in new.notices} - {notice.code for notice in old.notices} == {
        "edition-2019-to-verify",
        "profile-not-modified",
    }


def test_profiles_that_are_taken_back_need_no_more() -> None:
    relief = FlankModification(tip_relief=20.0, tip_relief_length=2.0)
    pair = sample_pair(15.0)
    both = GearPair(
        pinion=replace(pair.pinion, modification=relief),
        wheel=replace(pair.wheel, modification=relief),
        centre_distance=pair.centre_distance,
    )
    assert rate(both, STEEL, LOAD, NEW).flank == rate(pair, STEEL, LOAD, OLD).flank
    root = FlankModification(root_relief=20.0, root_relief_length=2.0)
    assert relieved(replace(relief, root_relief=20.0, root_relief_length=2.0))
    assert relieved(FlankModification(profile_crowning=5.0))
    assert not relieved(relief)
    assert not relieved(relief, root)  # both where contact ends
    assert not relieved(FlankModification(lead_crowning=9.0), FlankModification(lead_crowning=9.0))
    assert modification_factor(0.0, modified=True) == modification_factor(20.0, modified=True) == 1
    assert modification_factor(np.array([0, 20.0]), modified=False).tolist() == [1.2, 1.07]


def test_deep_teeth_are_not_relieved_twice() -> None:
    assert deep_tooth_factor(2.4, 4, Edition.ISO_2006) == pytest.approx(2.366 - 0.666 * 2.4)
    assert deep_tooth_factor(2.4, 4, Edition.ISO_2019) == 1


def test_rings_and_racks() -> None:
    ring = Gear(teeth=-70, normal_module=2.8, face_width=14.0)
    pinion = Gear(teeth=22, normal_module=2.8, face_width=16.0)
    internal = rate(GearPair(pinion=pinion, wheel=ring), STEEL, LOAD, NEW)
    assert internal.flank.contact_factors.wheel == 1
    assert internal.verify == ("q_prime", "Z_D", "wheel.Y_B", "Z_B", "Y_F", "Y_beta", "Y_DT")
    rack = RackPair(pinion=pinion, rack=Rack(normal_module=2.8, face_width=14.0, teeth=20, height=20.0))
    new, old = rate_rack(rack, STEEL, LOAD, NEW), rate_rack(rack, STEEL, LOAD, OLD)
    assert new.flank.contact_factors.pinion == pytest.approx(1.2 * old.flank.contact_factors.pinion, rel=EXACT)
    assert "Y_F" in new.verify


def test_clauses_and_what_is_to_be_verified() -> None:
    assert citations(Edition.ISO_2006)["Z_NT"] == "ISO 6336-2:2006, clause 11"
    assert citations(Edition.ISO_2006)["Y_M"] == "ISO 6336-3:2006, annex B"
    assert citations(Edition.ISO_2019)["Y_beta"] == "ISO 6336-3:2019"
    assert citations(Edition.DIN_1987)["Z_X"] == "DIN 3990-2:1987"
    assert citations(Edition.DIN_1987)["Z_H"] == "ISO 6336-2:2006, clause 6.1"
    assert to_verify(Edition.ISO_2006) == {}
    assert set(to_verify(Edition.ISO_2006, internal=True)) == {"Z_D"}
    assert set(to_verify(Edition.ISO_2019)) == {"Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT"}
    limited = to_verify(Edition.DIN_1987, limited_flank=True, limited_root=True)
    assert set(limited) == {"Z_L", "Z_v", "Z_R", "Z_W", "Z_X", "Y_delta_relT", "Y_RrelT", "Y_X"}
    for edition in Edition:
        assert set(to_verify(edition, internal=True, limited_flank=True, limited_root=True)) <= set(citations(edition))


RACK_STEEL, RACK_LOAD = Material(), Load(torque=200.0)


def _pair(helix: float = 0.0, **rack: Any) -> RackPair:
    pinion = Gear(teeth=24, normal_module=3.0, face_width=30.0, helix_angle=helix, profile_shift=0.1)
    return RackPair(
        pinion=pinion, rack=Rack(teeth=20, normal_module=3.0, face_width=28.0, helix_angle=-helix, height=25.0, **rack)
    )


def _numbers(document: dict[str, Any], wheel: str) -> np.ndarray:
    """All that a wheel and a rack have in common, in order."""
    pair = [value for value in document.values() if isinstance(value, float)]
    gears = [document[name][key] for name in ("pinion", wheel) for key in sorted(document["pinion"]) if key != "d_en"]
    return np.array([*pair, *gears])


@pytest.mark.parametrize("helix", [0.0, 6.0, 20.0])
def test_a_rack_is_the_limit_of_large_wheels(helix: float) -> None:
    """What differs goes as 1/z_2 and its square: extrapolated from 500, 1000 and 2000 teeth it is gone."""
    pair = _pair(helix)
    limit = _numbers(rate_rack(pair, RACK_STEEL, RACK_LOAD).to_dict(), "rack")
    off, transverse = [], 3 / math.cos(math.radians(helix))
    for teeth in (500, 1000, 2000):
        wheel = replace(pair.pinion, teeth=teeth, face_width=28.0, helix_angle=-helix, profile_shift=0.0)
        mate = GearPair(pinion=pair.pinion, wheel=wheel, centre_distance=(24 + teeth) * transverse / 2 + 0.3)
        off.append(_numbers(rack_rate(mate, RACK_LOAD).nominal.to_dict(), "wheel") / limit - 1)
    assert np.abs(off[2]).max() < 0.02
    assert np.abs(8 * off[2] - 6 * off[1] + off[0]).max() / 3 < 2e-4  # the third order of rho_F


def test_section_of_a_rack_from_its_outline() -> None:
    """Chord, arm and radius where the drawn tooth leans by 30 degrees; the force goes through B, square to the flank."""
    pair = _pair()
    fillet = pair.rack.profile.curves[1]
    (x, y) = fillet.points(np.linspace(0, 1, 20001)).T
    lean = np.degrees(np.arctan2(np.gradient(x), np.gradient(y)))
    at = int(np.argmin(np.abs(lean - 30)))
    path = pair.path_of_contact
    angle = math.radians(20)
    height = pair.pitch_line_height + (path.C - path.B) * math.sin(angle)
    meets = height - pair.rack.profile.half_thickness(height) * math.tan(angle)
    section = rate_rack(pair, RACK_STEEL, RACK_LOAD).roots.wheel.section
    assert section.chord == pytest.approx(-2 * x[at], rel=1e-4)
    assert section.moment_arm == pytest.approx(meets - y[at], rel=1e-4)
    assert section.fillet_radius == pytest.approx(0.38 * 3)


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_contact_with_a_plane_flank(helix: float) -> None:
    """sigma_H0 is Hertz of a cylinder on a plane at the pitch point, r_b tan alpha_t across the transverse section."""
    pair = _pair(helix)
    flank = rate_rack(pair, RACK_STEEL, RACK_LOAD).flank
    a_t = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(helix)))
    beta_b = math.asin(math.sin(math.radians(helix)) * math.cos(math.radians(20)))
    base = 36 / math.cos(math.radians(helix)) * math.cos(a_t)
    radius, force = base * math.tan(a_t) / math.cos(beta_b), 200e3 / base / math.cos(beta_b)
    peak = math.sqrt(force * math.cos(beta_b) / 28 * 206000 / (2 * (1 - 0.09)) / (math.pi * radius))
    assert flank.nominal_stress == pytest.approx(peak * flank.contact_ratio_factor * flank.helix_angle_factor, rel=1e-11)
    contact = rack_contact_at(pair, RACK_STEEL, distance=pair.path_of_contact.C, force=force)
    assert contact.peak_pressure == pytest.approx(peak, rel=1e-11)


def test_what_is_said_and_refused_of_racks() -> None:
    rating = rack_rate(_pair(), RACK_LOAD, material=RACK_STEEL).nominal
    assert [notice.code for notice in rating.notices] == ["rack-as-wheel"]
    assert rating.to_dict()["verify"] == ["q_prime"]
    with pytest.raises(GeometryError, match=r"^rack\.rack\.root_radius = 0: must be above 0 for a rating: stress has no limit"):
        rack_rate(_pair(rack=BasicRack(root_radius=0.0)), RACK_LOAD)
    with pytest.raises(ValueError, match=r"^load\.torque is missing: must be given"):
        rack_rate(_pair())
    with pytest.raises(
        ValueError,
        match=r"^mounting = .*: is not an input of a rack and pinion; permitted: material, load, check, mesh, dynamics, rating",
    ):
        rack_rate(_pair(), RACK_LOAD, mounting=None)
