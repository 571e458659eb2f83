"""The judge of geometry: designs that are right pass, and each fault that is put in is noticed by its claim."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.cases import volvo_pair
from support.samples import RINGS, SAMPLES, SHAPED
from support.specs import TEMPLATES

from gearcad import BasicRack, Body, Gear, GearPair, Rack, RackPair
from gearcad.core.quantities import Derived
from gearcad.core.records import Floats
from gearcad.designs import GearDesign, PairDesign, PlanetaryDesign, RackPairDesign, read_spec
from gearcad.geometry import DoubleHelix, ShaperCutter
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.profile import ToothProfile
from gearcad.verification import geometry
from gearcad.verification.claims import Claim
from gearcad.verification.geometry import judge_gear, judge_outline, judge_pair, judge_rack

HOBBED = Gear(teeth=23, normal_module=2, face_width=12, helix_angle=15, profile_shift=0.1, body=Body(tip_chamfer=0.2))
SHAPER = ShaperCutter(teeth=25, tip_radius=0.2)
SHAPED_GEAR = Gear(teeth=30, normal_module=2, face_width=10, cutter=SHAPER)
RING = Gear(teeth=-70, normal_module=2, face_width=12, profile_shift=-0.2, cutter=SHAPER, body=Body(rim_diameter=170.0))
FORM_ROOT = Gear(teeth=-60, normal_module=2, face_width=12, body=Body(rim_diameter=140.0))
HELICAL_RING = replace(RING, helix_angle=12.0, cutter=SHAPER)
DOUBLE = replace(HOBBED, face_width=30, double_helix=DoubleHelix(gap_width=6.0, offset=0.5))
KINDS = {
    "hobbed": HOBBED,
    "shaped": SHAPED_GEAR,
    "ring": RING,
    "form root": FORM_ROOT,
    "helical ring": HELICAL_RING,
    "double helical": DOUBLE,
}

PINION = Gear(teeth=22, normal_module=2, face_width=12, helix_angle=15, profile_shift=0.2, tooth_thinning=0.04)
WHEEL = Gear(teeth=37, normal_module=2, face_width=12, helix_angle=-15, profile_shift=0.1, tooth_thinning=0.03)
PAIR = GearPair(pinion=PINION, wheel=WHEEL)
INTERNAL = GearPair(pinion=replace(PINION, helix_angle=0.0), wheel=replace(RING, tooth_thinning=0.05, tip_diameter=-137.3))
RACK = Rack(teeth=8, normal_module=2, face_width=12, height=20, helix_angle=-15, tooth_thinning=0.02, tip_chamfer=0.2)
RACK_PAIR = RackPair(pinion=PINION, rack=RACK)
PAIRS = {"external": PAIR, "internal": INTERNAL, "rack": RACK_PAIR}

MICROMETRE = 1e-3


def failed(claims: Iterable[Claim]) -> dict[str, Claim]:
    """Claims that failed, by their quantities."""
    return {claim.quantity: claim for claim in claims if claim.passed is False}


def with_profile_of(gear: Gear, **changed: Any) -> Gear:
    """A gear whose outline is that of other inputs."""
    other, liar = replace(gear, **changed), replace(gear)
    liar.__dict__["profile"] = other.profile
    return liar


def starters() -> list[str]:
    """Names of all starters that are designs of gears."""
    paths = (path for path in TEMPLATES.glob("*.toml") if not path.stem.startswith("drawing"))
    return sorted(path.stem for path in paths if "\nnormal_module =" in path.read_text(encoding="utf-8"))


def judged(name: str) -> list[Claim]:
    """The claims on all gears and pairs of a starter."""
    design: Any = read_spec(TEMPLATES / f"{name}.toml")
    claims: list[Claim] = []
    if isinstance(design, GearDesign):
        claims += judge_gear(design.gear, name)
    elif isinstance(design, RackPairDesign):
        claims += [*judge_gear(design.pair.pinion, name), *judge_rack(design.pair.rack, name), *judge_pair(design.pair, name)]
    elif isinstance(design, PairDesign | PlanetaryDesign):
        pairs = [design.pair] if isinstance(design, PairDesign) else [mesh.pair for mesh in design.train.meshes]
        for pair in pairs:
            claims += [*judge_gear(pair.pinion, name), *judge_gear(pair.wheel, name), *judge_pair(pair, name)]
    return claims


# ---------------------------------------------------------------------- what is right


@pytest.mark.parametrize("name", [*SAMPLES, *(f"ring, {name}" for name in RINGS), *(f"shaped, {name}" for name in SHAPED)])
def test_every_feature_of_an_outline_is_judged_right(name: str) -> None:
    gears = {**SAMPLES, **{f"ring, {key}": ring for key, ring in RINGS.items()}}
    gears |= {f"shaped, {key}": gear for key, gear in SHAPED.items()}
    claims = list(judge_gear(gears[name], name, sections=2))
    assert not failed(claims)
    assert sum(claim.passed is True for claim in claims) >= 8


@pytest.mark.parametrize("kind", KINDS)
def test_all_sections_of_each_kind_of_gear_pass(kind: str) -> None:
    assert not failed(judge_gear(KINDS[kind], kind, sections=5))


@pytest.mark.parametrize("kind", PAIRS)
def test_each_kind_of_pair_passes_with_nothing_left_out(kind: str) -> None:
    claims = list(judge_pair(PAIRS[kind], kind))
    assert [claim.quantity for claim in claims if claim.passed is not True] == []


@pytest.mark.parametrize("name", starters())
def test_starters_pass(name: str) -> None:
    assert not failed(judged(name))


def test_a_starter_of_each_kind_is_judged() -> None:
    kinds = {type(read_spec(TEMPLATES / f"{name}.toml")).__name__ for name in starters() if judged(name)}
    assert kinds >= {"GearDesign", "PairDesign", "PlanetaryDesign", "RackPairDesign"}


# ---------------------------------------------------------------------- faults of an outline


@pytest.mark.parametrize("kind", ["hobbed", "double helical"])
def test_a_tip_radius_of_the_hob_that_is_one_percent_off_is_noticed(kind: str) -> None:
    liar = with_profile_of(KINDS[kind], rack=BasicRack(root_radius=0.38 * 1.01))
    assert any("outline" in quantity and "tool" in quantity for quantity in failed(judge_outline(liar, kind)))


@pytest.mark.parametrize("kind", ["shaped", "ring", "helical ring"])
def test_a_corner_of_the_cutter_that_is_one_percent_off_is_noticed(kind: str) -> None:
    liar = with_profile_of(KINDS[kind], cutter=replace(SHAPER, tip_radius=0.2 * 1.01))
    assert any("outline" in quantity and "tool" in quantity for quantity in failed(judge_outline(liar, kind)))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "fault", [{"profile_shift": 0.001}, {"tooth_thinning": MICROMETRE}, {"helix_angle": 0.01}, {"normal_module": 1e-4}]
)
def test_an_input_that_the_outline_does_not_follow_is_noticed(kind: str, fault: dict[str, float]) -> None:
    gear = KINDS[kind]
    if "helix_angle" in fault and not gear.helix_angle:
        pytest.skip("the section of a spur gear does not feel a hundredth of a degree")
    changed = {name: getattr(gear, name) + change for name, change in fault.items()}
    given = {"tip_diameter": float(gear.tip_diameter), "root_diameter": float(gear.root_diameter)}
    liar = with_profile_of(gear, **changed, **given)
    assert any("outline" in quantity and "tool" in quantity for quantity in failed(judge_outline(liar, kind)))


@pytest.mark.parametrize("kind", ["shaped", "ring"])
def test_a_cutter_with_another_number_of_teeth_is_noticed(kind: str) -> None:
    liar = with_profile_of(KINDS[kind], cutter=replace(SHAPER, teeth=26))
    assert any("outline" in quantity and "tool" in quantity for quantity in failed(judge_outline(liar, kind)))


@pytest.mark.parametrize("kind", KINDS)
def test_any_point_that_is_a_micrometre_off_is_noticed(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    gear, told = KINDS[kind], ToothProfile.points
    exact = told(gear.profile, 5e-4 * gear.normal_module)
    along = np.gradient(exact, axis=0)
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    rng = np.random.default_rng(2)
    for number in [0, len(exact) - 1, *rng.integers(1, len(exact) - 1, 12)]:
        moved = exact.copy()
        moved[number] += rng.choice([-1.0, 1.0]) * MICROMETRE * normals[number]

        def points(self: ToothProfile, chord_error: float = 0.001, moved: Floats = moved) -> Floats:
            return moved

        monkeypatch.setattr(ToothProfile, "points", points)
        assert failed(judge_outline(gear, kind)), (number, exact[number])


def test_the_place_of_a_fault_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    exact = HOBBED.profile.points(5e-4 * HOBBED.normal_module)
    moved = exact * np.where(np.arange(len(exact)) == 20, 1 + 1e-4, 1.0)[:, None]
    monkeypatch.setattr(ToothProfile, "points", lambda self, chord_error=0.001: moved)
    (claim,) = failed(judge_outline(HOBBED, "hobbed")).values()
    assert claim.reason.startswith(f"at radius {np.hypot(*moved[20]):.6g} mm")


@pytest.mark.parametrize("kind", ["hobbed", "helical ring", "double helical"])
def test_a_section_that_is_turned_the_wrong_way_is_noticed(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    right = geometry.section_turn
    monkeypatch.setattr(geometry, "section_turn", lambda gear, heights: right(gear, heights) * (1 + 1e-3))
    assert failed(judge_outline(KINDS[kind], kind, sections=3))


def test_tip_circle_and_chamfer_are_held_against_the_inputs() -> None:
    assert "distance of the tip chamfers from 45° lines" in failed(
        judge_outline(with_profile_of(HOBBED, body=Body(tip_chamfer=0.201)), "x")
    )
    longer = with_profile_of(HOBBED, tip_diameter=HOBBED.tip_diameter + 2 * MICROMETRE)
    assert "tip diameter of the outline" in failed(judge_outline(longer, "x"))
    told = replace(HOBBED)
    object.__setattr__(told, "tip_diameter", Derived(HOBBED.tip_diameter + 2 * MICROMETRE))
    assert "tip diameter by the inputs" in failed(judge_outline(told, "x"))
    deeper = with_profile_of(HOBBED, root_diameter=HOBBED.root_diameter - 2 * MICROMETRE)
    assert "root diameter of the outline" in failed(judge_outline(deeper, "x"))


# ---------------------------------------------------------------------- faults of gauges


@pytest.mark.parametrize("kind", ["hobbed", "shaped", "ring", "form root"])
def test_a_base_tangent_length_that_is_a_micrometre_off_is_noticed(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    gear = KINDS[kind]
    told = type(gear.inspection).span_measurement
    monkeypatch.setattr(type(gear.inspection), "span_measurement", lambda self, count: told(self, count) + MICROMETRE)
    (quantity,) = failed(judge_gear(gear, kind))
    assert quantity.startswith(f"base tangent length over {gear.inspection.spanned} ")


@pytest.mark.parametrize(("kind", "gauge"), [("hobbed", "over_balls"), ("hobbed", "over_pins"), ("ring", "between_balls")])
def test_a_dimension_over_balls_that_is_a_micrometre_off_is_noticed(kind: str, gauge: str) -> None:
    liar = replace(KINDS[kind])
    liar.__dict__[gauge] = getattr(liar, gauge) + MICROMETRE
    found = failed(judge_gear(liar, kind))
    assert found and all(quantity.startswith("dimension") for quantity in found)


def test_gauges_of_another_ball_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = Inspection.over_balls
    monkeypatch.setattr(Inspection, "over_balls", lambda self, ball: right(self, ball * 1.001))
    assert failed(judge_gear(replace(HOBBED), "x"))


# ---------------------------------------------------------------------- faults of pairs and racks


@pytest.mark.parametrize("kind", PAIRS)
@pytest.mark.parametrize(
    ("fault", "quantity"),
    [
        ("circumferential_backlash", "circumferential backlash"),
        ("normal_backlash", "normal backlash"),
        ("transverse_contact_ratio", "transverse contact ratio"),
        ("usable_contact_ratio", "usable contact ratio"),
    ],
)
def test_a_figure_of_a_pair_that_is_off_is_noticed(
    kind: str, fault: str, quantity: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    off = getattr(PAIRS[kind], fault) + (3e-4 if "ratio" in fault else 1e-4)
    monkeypatch.setattr(type(PAIRS[kind]), fault, off)
    assert quantity in failed(judge_pair(replace(PAIRS[kind]), kind))


@pytest.mark.parametrize("kind", ["external", "internal"])
def test_a_centre_distance_that_is_a_micrometre_off_is_noticed(kind: str) -> None:
    told = replace(PAIRS[kind])
    object.__setattr__(told, "centre_distance", Derived(told.centre_distance + MICROMETRE))
    assert "centre distance" in failed(judge_pair(told, kind))


def test_flanks_of_another_pressure_angle_do_not_roll_evenly() -> None:
    liar = replace(PAIR, wheel=with_profile_of(WHEEL, rack=BasicRack(pressure_angle=20.2)))
    assert "change of the gaps while flanks roll in contact" in failed(judge_pair(liar, "x"))


def test_a_tip_that_cuts_a_fillet_must_be_told() -> None:
    pair = volvo_pair()
    pair.__dict__["notices"] = ()
    assert "depth of tips in fillets with flanks touching" in failed(judge_pair(pair, "x"))


def test_a_wrong_rack_is_noticed() -> None:
    for fault in ({"rack": BasicRack(root_radius=0.38 * 1.01)}, {"tooth_thinning": 0.02 + MICROMETRE}, {"helix_angle": -15.01}):
        liar = replace(RACK)
        liar.__dict__["profile"] = replace(RACK, **fault).profile
        assert "distance of the outline from the basic rack" in failed(judge_rack(liar, "x"))
    higher = replace(RACK)
    higher.__dict__["inspection"] = replace(RACK.inspection, height=RACK.height + MICROMETRE)
    assert list(failed(judge_rack(higher, "x"))) == [f"height over a pin of {RACK.pin_diameter:g} mm"]


def test_what_is_not_judged_says_why() -> None:
    (ring,) = (claim for claim in judge_gear(HELICAL_RING, "ring") if claim.passed is None)
    assert "helical ring" in ring.reason
    assert {claim.quantity for claim in judge_pair(volvo_pair(), "x") if claim.passed is None} == {
        "transverse contact ratio",
        "depth of tips in fillets with flanks touching",
        "centre distance",
    }


def test_a_ball_that_the_root_circle_holds_off_the_flanks_is_noticed() -> None:
    gear = Gear(teeth=3, normal_module=1, face_width=1, root_diameter=2.0937, rack=BasicRack(root_radius=0.3775))
    (notice,) = (each.text for each in gear.notices if each.code == "balls-off-involute")
    assert notice == "balls: a ball of 2.4 mm would touch the root circle, diameter 2.0937 mm, off the involute"
    assert notice in {claim.reason for claim in judge_gear(gear, "x") if claim.passed is None}
    assert not failed(judge_gear(gear, "x"))
