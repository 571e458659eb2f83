"""Safeties by the stresses of finite elements, and K_Hbeta from the load along the face width."""

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np
import pytest
from support.checks import small_check, small_solid_check

from gearcad import Gear, GearPair, Load, Material, Mounting, read
from gearcad.batch.run import falls_short
from gearcad.check.comparison import ComparisonRole, Subject, strength_comparisons, verdict
from gearcad.check.result import CheckResult, check_document
from gearcad.check.run import load_distribution
from gearcad.check.task import check_task
from gearcad.core.errors import ParameterError
from gearcad.core.output import json_text
from gearcad.core.quantities import schema_of
from gearcad.core.records import Verdict
from gearcad.designs import PairDesign
from gearcad.drawing.drawing_subjects import DrawnGear, material_text
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.words import Language, SheetWords
from gearcad.geometry import FlankModification
from gearcad.jobs.strength import Rate, rate_columns
from gearcad.page.panels.sheet_content import strength_figures
from gearcad.rating import RatingOptions
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.strength import RatedPart
from gearcad.report import report_html

EXACT = 1e-12

OPTIONS = RatingOptions(life=1000.0, mesh_load_factor=1.1)


def strong(check: CheckResult, options: RatingOptions = OPTIONS, **inputs: object) -> CheckResult:
    """A check whose material is Eh MQ, at a speed, with the gates of that."""
    load = Load(torque=check.load.torque, speed=1500.0)
    task = replace(check.task, material=Material(name="Eh MQ"), load=load, rating_options=options, **inputs)
    found = replace(check, task=task, comparisons=())
    return replace(found, comparisons=tuple(strength_comparisons(found.safeties)))


def test_stresses_are_raised_by_what_the_model_lacks() -> None:
    result = strong(small_check())
    found, k = result.safeties, result.safeties.rating.load_factors
    assert k is not None
    assert found.applied[RatedPart.ROOT] == {
        "K_gamma": 1.1,
        "K_v": k.dynamic,
        "K_Fbeta": k.face_root,
        "K_Falpha": k.transverse_root,
    }
    factors = k.mesh_load * k.dynamic * k.face_root * k.transverse_root
    root = found.root.wheel
    assert root.raised == pytest.approx(result.summary.root_tension.wheel * factors, rel=EXACT)
    assert root.safety == pytest.approx(root.rated.strength / root.raised, rel=EXACT)
    factors = k.mesh_load * k.dynamic * k.face_flank * k.transverse_flank
    spur = math.sqrt((4 - result.pair.transverse_contact_ratio) / 3)  # Z_eps, which the endurance limit has in it
    assert found.flank.pinion.raised == pytest.approx(result.summary.contact_pressure * math.sqrt(factors) * spur, rel=EXACT)


def test_a_spectrum_is_held_against_the_stress_of_its_nominal_torque() -> None:
    several = replace(OPTIONS, spectrum=[[0.1, 1.25], [0.9, 0.8]])
    one, other = (strong(small_check(), options).safeties.root.pinion for options in (OPTIONS, several))
    assert other.raised == one.raised
    assert other.safety / other.rated.safety == pytest.approx(one.safety / one.rated.safety, rel=EXACT)
    assert other.rated.stress > one.rated.stress


def test_what_the_model_has_is_not_multiplied_again() -> None:
    solid = strong(small_solid_check())
    assert set(solid.safeties.contained) == {"K_A", "K_Hbeta", "K_Fbeta"}  # it is misaligned
    assert set(solid.safeties.applied[RatedPart.FLANK]) == {"K_gamma", "K_v", "K_Halpha"}
    proud = strong(small_check(), mounting=Mounting(pinion_pitch_error=5.0))
    assert set(proud.safeties.applied[RatedPart.ROOT]) == {"K_gamma", "K_v", "K_Fbeta"}
    aligned = strong(small_solid_check(), mounting=Mounting())
    assert set(aligned.safeties.contained) == {"K_A"}


def test_the_model_has_a_face_load_factor_of_its_own() -> None:
    solid = small_solid_check()
    own = solid.summary.face_load_factor
    assert own > 1
    assert strong(solid).safeties.own == {}  # what a tilted model has is all in it
    uneven = strong(solid, replace(OPTIONS, face_load_factor=2.0), mounting=Mounting()).safeties
    assert uneven.applied[RatedPart.FLANK]["K_Hbeta"] == pytest.approx(2 / own, rel=EXACT)
    k, root = uneven.rating.load_factors, min(solid.summary.root_face_load_factor)
    assert uneven.applied[RatedPart.ROOT]["K_Fbeta"] == pytest.approx(k.face_root / root, rel=EXACT)
    even = strong(solid, replace(OPTIONS, face_load_factor=1.0), mounting=Mounting()).safeties
    assert even.applied[RatedPart.FLANK]["K_Hbeta"] == 1.0
    assert "K_Hbeta beyond its own 1" in even.applied_words(RatedPart.FLANK)
    assert even.to_dict()["factors_of_model"]["K_Hbeta"] == own


def test_safeties_of_the_standard_are_gates_and_those_of_finite_elements_inform() -> None:
    result = strong(small_check())
    quantities = [each.quantity for each in result.comparisons]
    assert quantities[:2] == ["S_H of the pinion, ISO 6336", "S_H of the pinion, finite elements"]
    assert len(quantities) == 8
    roles = {each.quantity.split(", ")[1]: each.role for each in result.comparisons}
    assert roles == {"ISO 6336": ComparisonRole.GATE, "finite elements": ComparisonRole.INFORMATION}
    assert all(each.subject is Subject.STRENGTH for each in result.comparisons)
    assert "of both flanks" in result.comparisons[1].note
    assert result.strength is Verdict.FAILED
    assert verdict(result.comparisons, Subject.NUMERICS) is Verdict.NOT_JUDGED
    weak = [each for each in result.comparisons if not each.passed]
    assert weak
    assert all(each.computed < each.reference for each in weak)
    easy = strong(small_check(), replace(OPTIONS, required_safety_flank=0.5, required_safety_root=0.5))
    assert easy.strength is Verdict.PASSED
    assert "von Mises stress below the flank" in easy.verdict
    assert "contact pressure" not in easy.verdict  # the rating judges it


def test_what_finite_elements_have_below_the_required_is_said() -> None:
    check = small_check()
    rated = strong(check).safeties.flank.pinion.rated.safety
    harder = replace(check, summary=replace(check.summary, contact_pressure=3 * check.summary.contact_pressure))
    result = strong(harder, replace(OPTIONS, required_safety_flank=0.9 * rated, required_safety_root=0.1))
    low = result.safeties.flank.pinion
    assert low.safety < 0.9 * rated
    assert result.strength is Verdict.PASSED
    beside = f"S_H of the pinion is {low.safety:.3g}, below {0.9 * rated:.3g} required"
    assert f"strength passed by ISO 6336; by finite elements {beside}" in result.verdict
    document = check_document(result)
    assert document["verdict"] == result.verdict
    assert len(document["safeties"]["below_required"]) == 2


def test_documents_have_both() -> None:
    document = check_document(strong(small_check()))
    json_text(document)
    root = document["safeties"]["root"]["pinion"]
    assert root["fe_safety"] / root["rated_safety"] == pytest.approx(root["rated_stress"] / root["fe_stress_with_factors"])
    assert document["strength_rating"]["strength"] == "failed"
    assert document["strength_rating"]["load"]["speed"] == 1500


@pytest.mark.long
def test_reports_have_a_section_of_it() -> None:
    page = report_html(strong(small_check()), "pair")
    assert "Strength by ISO 6336:2006" in page
    assert "What the roots bear" in page


@pytest.mark.parametrize(
    ("material", "speed", "words"),
    [
        (Material(), 1500.0, "strength not asked for"),
        (Material(name="Eh MQ"), 0.0, "strength not judged: the speed is 0 rpm"),
    ],
)
def test_strength_that_was_not_judged_is_said(material: Material, speed: float, words: str) -> None:
    check = small_check()
    task = replace(check.task, material=material, load=Load(torque=302.0, speed=speed))
    result = replace(check, task=task, comparisons=())
    assert list(strength_comparisons(result.safeties)) == []
    assert words in result.verdict
    document = check_document(result)
    assert document["strength"] == ("not judged" if material.asks_strength else "not asked for")
    assert document["strength"] == document["strength_rating"]["strength"]
    assert document["safeties"]["root"]["pinion"]["fe_safety"] is None


ASKING = {
    "material": [name for name in schema_of(Material) if name.endswith("_limit") or name == "quality"],
    "rating": [name for name in schema_of(RatingOptions) if name.startswith("required_safety_")],
}
"""Keys that ask for a verdict on strength, as the schema has them."""

VALUES = {
    "contact_limit": 1e4,
    "root_limit": 1e4,
    "contact_endurance_limit": 1500.0,
    "root_endurance_limit": 430.0,
    "quality": '"MQ"',
    "required_safety_flank": 1.0,
    "required_safety_root": 1.4,
    "required_safety_scuffing": 0.2,
    "scuffing_stage": 12,
}
FEW = 11
"""Of so many combinations one is rated in a quick run; all of them in a long one."""

PAGE_EACH = 5
"""Of so many combinations the page is asked for one: it shows the same rating."""


def combinations() -> Iterator[tuple[str, ...]]:
    """Yield all choices of the keys that ask, with and without a scuffing stage."""
    keys = [*ASKING["material"], *ASKING["rating"], "scuffing_stage"]
    assert set(keys) == set(VALUES)
    return chain.from_iterable(itertools.combinations(keys, count) for count in range(len(keys) + 1))


def asked_spec(keys: tuple[str, ...]) -> str:
    """The text of a spec that holds with ease, with these keys given."""
    text = "[pair]\nname = 'asked'\nnormal_module = 3.0\nface_width = 30.0\n[pinion]\nteeth = 21\n[wheel]\nteeth = 43\n"
    text += "[load]\ntorque = 20.0\nspeed = 1450.0\n[material]\ngroup = 'Eh'\nhardness = 720.0\n"
    text += "".join(f"{key} = {VALUES[key]}\n" for key in keys if key in ASKING["material"])
    text += "[rating]\nlife = 1000.0\noil_viscosity_40 = 220.0\n"
    return text + "".join(f"{key} = {VALUES[key]}\n" for key in keys if key not in ASKING["material"])


def expected(keys: tuple[str, ...]) -> str:
    """The verdict by the words of the manual."""
    if not set(keys) - {"scuffing_stage"}:
        return "not asked for"
    flank, root = (f"{part}_endurance_limit" in keys or "quality" in keys for part in ("contact", "root"))
    scuffing = "required_safety_scuffing" not in keys or "scuffing_stage" in keys
    return "passed" if flank and root and scuffing else "not judged"


@pytest.mark.parametrize("stride", [FEW, pytest.param(1, marks=pytest.mark.long)])
def test_one_rule_decides_everywhere(tmp_path: Path, stride: int) -> None:
    spec, small = tmp_path / "asked.toml", small_check()
    for number, keys in enumerate(itertools.islice(combinations(), 0, None, stride)):
        spec.write_text(asked_spec(keys), encoding="utf-8")
        design = read(spec)
        assert isinstance(design, PairDesign)
        rating = Rate(report=False).run(design)
        found = rating.to_dict()
        said, status = expected(keys), expected(keys) == "not judged"
        assert (found["strength"], rating.strength.falls_short) == (said, status), keys
        assert said in rating.verdict
        task = replace(small.task, material=design.material, load=design.load, rating_options=design.rating)
        check = replace(small, task=task, comparisons=())
        check = replace(check, comparisons=tuple(strength_comparisons(check.safeties)))
        if said != "passed":  # these gears are others than those of the spec, and need not hold
            assert (check.strength.value, check.passed) == (said, not status), keys
        columns = {f"rate.{name}": value for name, value in rate_columns(found).items()}
        assert falls_short(columns) is status
        if number % PAGE_EACH == 0:
            assert strength_figures(design).title == rating.verdict


def test_a_check_tells_that_scuffing_could_not_be_judged() -> None:
    options = replace(OPTIONS, required_safety_flank=0.1, required_safety_root=0.1, required_safety_scuffing=1.5)
    result = strong(small_check(), options)
    assert (result.strength, result.passed) == (Verdict.NOT_JUDGED, False)
    assert "scuffing_stage" in result.verdict
    judged = replace(options, required_safety_scuffing=0.1, oil_viscosity_40=220.0, scuffing_stage=12)
    found = strong(small_check(), judged)
    assert found.strength is Verdict.PASSED
    assert {each.quantity[:5] for each in found.comparisons if each.quantity.startswith(("S_int", "S_B"))} == {"S_int", "S_B, "}
    assert strong(small_check(), replace(judged, required_safety_scuffing=90.0)).strength is Verdict.FAILED


def test_a_sheet_names_no_grade_of_iso_6336_as_a_material() -> None:
    words = SheetWords.of(Language.ENGLISH)
    gear = Gear(teeth=20, normal_module=2, face_width=20)
    drawn = DrawnGear(role="gear", gear=gear, material=Material(name="Eh MQ"))
    assert material_text(drawn, DrawingOptions(), words) == words["data.steel"]
    for material, text in (
        (Material(name="steel"), "steel"),
        (Material(), "steel (assumed)"),
        (Material(group="V"), "steel"),
        (Material(name="GG MQ", hardness=200.0), "grey cast iron"),
    ):
        assert material_text(replace(drawn, material=material), DrawingOptions(), words) == text
    named = replace(drawn, material=Material(name="16MnCr5", group="Eh", quality="MQ"))
    assert material_text(named, DrawingOptions(), words) == "16MnCr5"


EH = Material(group="Eh", contact_endurance_limit=1500.0)  # type: ignore[arg-type]
SPUR = GearPair(
    pinion=Gear(teeth=20, normal_module=3.0, face_width=30.0), wheel=Gear(teeth=45, normal_module=3.0, face_width=30.0)
)
LOAD = Load(torque=150.0, speed=1500.0)


def test_needs_what_a_rating_needs() -> None:
    with pytest.raises(ParameterError, match="torque"):
        load_distribution(check_task(SPUR, EH, replace(LOAD, torque=0.0)))
    with pytest.raises(ParameterError, match="contact_endurance_limit"):
        load_distribution(check_task(SPUR, Material(group="V"), LOAD))  # type: ignore[arg-type]


@pytest.mark.long
def test_a_misaligned_spur_pair_beside_method_c() -> None:
    """Method C: 1.54, of springs of 16.2 N/(mm·µm). The bodies: 1.95, because they are stiffer against a tilt.

    Under an even load the mesh of these bodies has 20.8 N/(mm·µm), against c_gamma_alpha 19.1, of which Method C takes 0.85.
    What bodies twist is part of that, but moves all of the width alike: against a tilt there is 1.28 times as much, 26.5
    N/(mm·µm), by the slope of the load over the face width. The ends of an even load carry 3.5 % more besides.
    """
    found, by_method_c = load_distribution(check_task(SPUR, EH, LOAD)), LoadFactors.of(SPUR, EH, LOAD)
    off, mean, c = (by_method_c.details[each] for each in ("F_betay", "F_m_b", "c_gamma_beta"))
    assert isinstance(off, float) and isinstance(mean, float) and isinstance(c, float)
    assert abs(found.misalignment) == pytest.approx(off, rel=1e-12)
    step = found.across[1] - found.across[0]
    force = 1000 * found.torque / (SPUR.pinion.base_diameter / 2)
    assert found.load.sum() * step == pytest.approx(force, rel=1e-6)
    assert by_method_c.face_flank == pytest.approx(1.541, abs=0.001)
    slope = abs(np.polyfit(found.across, found.load, 1)[0]) * 30 / off
    across = math.cos(math.radians(20))  # F_m is at the reference circle, the load along the line of action
    assert slope == pytest.approx(26.5, rel=0.02)
    assert found.face_load_factor == pytest.approx(1.035 * (1 + off * slope * across / (2 * mean)), rel=0.06)
    assert found.face_load_factor == pytest.approx(1.945, rel=0.01)


@pytest.mark.long
def test_flanks_and_mounting_change_it() -> None:
    """The gap grows towards larger z: the low end carries; crowning helps; far off, the end carries all, whatever the model."""
    aside = load_distribution(check_task(SPUR, EH, LOAD, mounting=Mounting(misalignment=20.0)))
    assert aside.misalignment == pytest.approx(17.0)  # 3 µm run in
    assert aside.load[:30].sum() > 2 * aside.load[30:].sum()
    mirrored = load_distribution(check_task(SPUR, EH, replace(LOAD, torque=-150.0), mounting=Mounting(misalignment=20.0)))
    assert mirrored.face_load_factor == pytest.approx(aside.face_load_factor, rel=1e-9)
    crowned = replace(SPUR, pinion=replace(SPUR.pinion, modification=FlankModification(lead_crowning=8.0)))
    assert (
        load_distribution(check_task(crowned, EH, LOAD)).face_load_factor
        < 0.9 * load_distribution(check_task(SPUR, EH, LOAD)).face_load_factor
    )
    given = RatingOptions(dynamic_factor=1.0, mesh_load_factor=1.5)
    far = load_distribution(check_task(SPUR, EH, LOAD, rating=given, mounting=Mounting(misalignment=900.0)))
    assert far.torque == 225.0
    assert far.face_load_factor > 15
