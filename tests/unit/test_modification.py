"""Flank modifications: each term against a formula by hand, both flanks and hands, and what changed gears really have."""

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import BasicRack, FlankModification, Gear, ParameterError, ReliefShape
from gearcad.core.errors import GeometryError

GEAR = Gear(teeth=23, normal_module=2.5, face_width=16.0, helix_angle=12.0, profile_shift=0.2)

FIRST, LAST = (math.sqrt(diameter**2 - GEAR.base_diameter**2) / 2 for diameter in (GEAR.form_diameter, GEAR.tip_form_diameter))
"""Roll lengths of the ends of the flank (mm)."""

ROLL = LAST - FIRST


def depth(length: float, z: float, *, left: bool = True, gear: Gear = GEAR, **amounts: Any) -> float:
    """How far a flank of the gear with these modifications is taken back, in µm."""
    form = replace(gear, modification=FlankModification(**amounts)).flank_form
    return 1000 * float(form.depth(length, z, left=left))


def test_nothing_is_taken_off_an_exact_flank() -> None:
    form = GEAR.flank_form
    assert not form.depth(np.linspace(FIRST, LAST, 7)[:, None], np.linspace(0, 16, 5)).any()
    assert form.depth(np.linspace(FIRST, LAST, 7)[:, None], np.linspace(0, 16, 5)).shape == (7, 5)
    assert not form.modification.present
    assert (form.roll_breaks, form.height_breaks, form.modification.in_use) == ((), (), {})


@pytest.mark.parametrize(
    ("amounts", "up", "along", "expected"),
    [
        ({"tip_relief": 20, "tip_relief_length": 1.5}, 1.0, 0.3, 20.0),
        ({"tip_relief": 20, "tip_relief_length": ROLL / 4}, 0.85, 0.3, 20 * 0.1 / 0.25),
        ({"tip_relief": 20, "tip_relief_length": ROLL / 4}, 0.74, 0.3, 0.0),
        ({"tip_relief": 20, "tip_relief_length": ROLL / 4, "tip_relief_shape": "parabolic"}, 0.85, 0.3, 20 * 0.4**2),
        ({"root_relief": 12, "root_relief_length": ROLL / 5}, 0.0, 0.3, 12.0),
        ({"root_relief": 12, "root_relief_length": ROLL / 5}, 0.15, 0.3, 12 * 0.05 / 0.2),
        ({"root_relief": 12, "root_relief_length": ROLL / 5, "root_relief_shape": "parabolic"}, 0.15, 0.3, 12 / 16),
        ({"root_relief": 12, "root_relief_length": ROLL / 5}, 0.21, 0.3, 0.0),
        ({"profile_crowning": 8}, 0.0, 0.3, 8.0),
        ({"profile_crowning": 8}, 0.5, 0.3, 0.0),
        ({"profile_crowning": 8}, 0.75, 0.3, 2.0),
        ({"profile_crowning": -8}, 1.0, 0.3, -8.0),
        ({"pressure_angle_modification": 10}, 0.0, 0.3, 0.0),
        ({"pressure_angle_modification": 10}, 0.3, 0.3, 3.0),
        ({"pressure_angle_modification": -10}, 1.0, 0.3, -10.0),
        ({"lead_crowning": 6}, 0.3, 0.0, 6.0),
        ({"lead_crowning": 6}, 0.3, 0.5, 0.0),
        ({"lead_crowning": 6}, 0.3, 0.25, 1.5),
        ({"end_relief": 9, "end_relief_length": 4}, 0.3, 0.0, 9.0),
        ({"end_relief": 9, "end_relief_length": 4}, 0.3, 15 / 16, 9 * 3 / 4),
        ({"end_relief": 9, "end_relief_length": 4, "end_relief_shape": "parabolic"}, 0.3, 15 / 16, 9 * 9 / 16),
        ({"end_relief": 9, "end_relief_length": 4}, 0.3, 0.5, 0.0),
        ({"twist": 10}, 1.0, 0.0, -2.5),
        ({"twist": 10}, 0.0, 0.0, 2.5),
        ({"twist": 10}, 1.0, 1.0, 2.5),
        ({"twist": 10}, 0.5, 0.8, 0.0),
    ],
)
def test_each_term(amounts: dict[str, Any], up: float, along: float, expected: float) -> None:
    """At a part `up` of the roll and `along` of the width; nothing here but the helix knows one flank from the other."""
    for left in (True, False):
        found = depth(FIRST + up * ROLL, 16 * along, left=left, **amounts)
        assert found == pytest.approx(expected, abs=1e-9)


def test_twist_turns_the_profile_slope_from_end_to_end() -> None:
    """The slope over the whole roll changes by S_alpha; a line from one corner to the other rises by half of it."""
    slopes = [depth(LAST, z, twist=14.0) - depth(FIRST, z, twist=14.0) for z in (0.0, 16.0)]
    assert slopes[1] - slopes[0] == pytest.approx(14.0)
    assert sum(slopes) == pytest.approx(0, abs=1e-12)


def test_terms_add_up() -> None:
    amounts = {
        "tip_relief": 20.0,
        "tip_relief_length": 2.0,
        "root_relief": 7.0,
        "root_relief_length": 1.0,
        "profile_crowning": 3.0,
        "pressure_angle_modification": -4.0,
        "lead_crowning": 5.0,
        "end_relief": 6.0,
        "end_relief_length": 3.0,
        "helix_angle_modification": 8.0,
        "twist": 9.0,
    }
    lengths = {name: value for name, value in amounts.items() if name.endswith("_length")}
    alone = [depth(LAST - 0.3, 1.1, **lengths | {name: value}) for name, value in amounts.items() if name not in lengths]
    assert depth(LAST - 0.3, 1.1, **amounts) == pytest.approx(sum(alone), abs=1e-9)


def test_beyond_its_ends_a_flank_is_what_it_is_there() -> None:
    amounts = {"tip_relief": 20.0, "tip_relief_length": 2.0, "lead_crowning": 5.0}
    assert depth(LAST + 1, -3.0, **amounts) == depth(LAST, 0.0, **amounts) == pytest.approx(25.0)
    assert depth(0.0, 19.0, **amounts) == depth(FIRST, 16.0, **amounts) == pytest.approx(5.0)


def test_starts_of_reliefs_are_breaks() -> None:
    modification = FlankModification(
        tip_relief=1, tip_relief_length=2.0, root_relief=1, root_relief_length=1.5, end_relief=1, end_relief_length=3.0
    )
    form = replace(GEAR, modification=modification).flank_form
    assert form.roll_breaks == pytest.approx((FIRST + 1.375, FIRST + 1.625, LAST - 2.125, LAST - 1.875))
    assert form.height_breaks == pytest.approx((3.0, 13.0))
    kinks = replace(modification, tip_relief_transition=0.0, root_relief_shape=ReliefShape.PARABOLIC)
    assert replace(GEAR, modification=kinks).flank_form.roll_breaks == pytest.approx((FIRST + 1.5, LAST - 2.0))
    halves = replace(modification, end_relief_length=8.0, tip_relief_length=ROLL, root_relief_length=ROLL)
    form = replace(GEAR, modification=halves).flank_form
    assert form.height_breaks == pytest.approx((8.0,))
    assert form.roll_breaks == ()


# Transitions of linear reliefs


def test_a_transition_rounds_the_start_and_leaves_amount_and_length() -> None:
    """C_a t/(8 l_a) at the onset: 0.675 µm of 18 over 1 mm with 0.3 mm; nothing half before it, and the line half behind."""
    amounts = {"tip_relief": 18.0, "tip_relief_length": 1.0, "tip_relief_transition": 0.3}
    onset = LAST - 1.0
    assert depth(onset, 4.0, **amounts) == pytest.approx(0.675, abs=1e-9)
    assert depth(LAST, 4.0, **amounts) == pytest.approx(18.0, abs=1e-9)
    assert depth(onset - 0.15, 4.0, **amounts) == pytest.approx(0.0, abs=1e-9)
    assert depth(onset + 0.15, 4.0, **amounts) == pytest.approx(18 * 0.15, abs=1e-9)
    assert depth(onset + 0.075, 4.0, **amounts) == pytest.approx(18 * 0.225**2 / 0.6, abs=1e-9)
    root = {"root_relief": 18.0, "root_relief_length": 1.0, "root_relief_transition": 0.3}
    assert depth(FIRST + 1.0, 4.0, **root) == pytest.approx(0.675, abs=1e-9)
    assert depth(FIRST, 4.0, **root) == pytest.approx(18.0, abs=1e-9)


@pytest.mark.parametrize(
    ("amounts", "length", "source"),
    [
        ({"tip_relief_length": 1.0}, 0.25, "assumed"),
        ({"tip_relief_length": 0.05}, 0.1, "shortened"),
        ({"tip_relief_length": ROLL - 0.03}, 0.06, "shortened"),
        ({"tip_relief_length": 1.0, "tip_relief_transition": 0.7}, 0.7, "given"),
        ({"tip_relief_length": 1.0, "tip_relief_transition": 0.0}, 0.0, "given"),
    ],
)
def test_documents_have_the_transition_that_is_used(amounts: dict[str, Any], length: float, source: str) -> None:
    """0.1 m_n where nobody gave one, or twice what is left of the flank on the shorter side of the onset."""
    gear = replace(GEAR, modification=FlankModification(tip_relief=16.0, **amounts))
    used = gear.to_dict()["modification"]
    assert used["tip_relief_transition"] == pytest.approx(length)
    assert used["tip_relief_transition_source"] == source
    assert used["tip_relief_rounding"] == pytest.approx(16.0 * length / 8 / amounts["tip_relief_length"])


def test_a_relief_without_a_kink_has_no_transition() -> None:
    for amounts in ({"tip_relief_length": ROLL}, {"tip_relief_length": 1.0, "tip_relief_shape": "parabolic"}):
        gear = replace(GEAR, modification=FlankModification(tip_relief=16.0, **amounts))
        assert not gear.flank_form.transitions
        assert gear.to_dict()["modification"]["tip_relief_transition"] is None


@pytest.mark.parametrize(
    ("amounts", "message"),
    [
        ({"tip_relief_transition": 2.1}, "modification.tip_relief_transition = 2.1 mm: must be at most 2 mm: its halves fit"),
        ({"tip_relief_transition": 1e-4}, "tip_relief_transition = 0.0001 mm: must be 0 or at least 0.001 mm"),
        (
            {"tip_relief_transition": 0.2, "tip_relief_shape": "parabolic"},
            "tip_relief_transition = 0.2 mm: must be left out: a parabolic tip_relief starts without a kink",
        ),
    ],
)
def test_transitions_that_do_not_fit_are_refused(amounts: dict[str, Any], message: str) -> None:
    with pytest.raises(GeometryError, match=re.escape(message)):
        replace(GEAR, modification=FlankModification(tip_relief=16.0, tip_relief_length=1.0, **amounts))


# What gears with other angles really have


def involute_turn(base: float, radius: float) -> float:
    """Polar angle (rad) of an involute at a radius, from its start on the base circle."""
    return math.sqrt(radius**2 / base**2 - 1) - math.acos(base / radius)


@pytest.mark.parametrize("up", [0.2, 0.6, 1.0])
def test_a_pressure_angle_modification_is_an_involute_of_a_smaller_base_circle(up: float) -> None:
    """C_H_alpha = (r_b - r_b') roll/r_b from the root form circle on; what differs is of second order."""
    errors = []
    for share in (2e-3, 1e-3):
        base = GEAR.base_diameter / 2
        other = base * (1 - share)
        amount = 1000 * share * ROLL
        radius = math.hypot(base, FIRST + up * ROLL)
        turn = involute_turn(other, radius) - involute_turn(base, radius)
        start = involute_turn(other, GEAR.form_diameter / 2) - involute_turn(base, GEAR.form_diameter / 2)
        # An involute of a smaller circle has turned further: taken back from the tooth's own side.
        found = depth(FIRST + up * ROLL, 4.0, pressure_angle_modification=amount)
        errors.append(abs((turn - start) * base * 1000 - found))
    assert errors[1] < 0.02 * abs(found)
    assert errors[1] / errors[0] == pytest.approx(0.25, abs=0.05)


@pytest.mark.parametrize("hand", [1, -1])
@pytest.mark.parametrize("left", [True, False])
def test_a_helix_angle_modification_is_a_steeper_helix(hand: int, left: bool) -> None:
    """Sections of a gear with more of its own hand turn further about the middle one, by r_b times their turn."""
    gear = replace(GEAR, helix_angle=hand * 12.0)
    amount = 15.0
    form = replace(gear, modification=FlankModification(helix_angle_modification=amount)).flank_form
    twist = math.degrees(amount / 1000 / (gear.base_diameter / 2))
    # The same transverse section with a shorter lead: 360 b/p_z grows by that twist.
    lead = 360 * gear.face_width / (360 * gear.face_width / gear.lead + twist)
    for z in (0.0, 5.0, 16.0):
        turned = hand * 2 * math.pi * (z - 8.0) * (1 / lead - 1 / gear.lead)
        assert float(form.turn(LAST - 1, z, left=left)) == pytest.approx(turned, abs=1e-12)


def test_on_a_spur_gear_the_modified_helix_is_right_handed() -> None:
    spur = replace(GEAR, helix_angle=0.0)
    form = replace(spur, modification=FlankModification(helix_angle_modification=10.0)).flank_form
    turns = [float(form.turn(form.last, 16.0, left=left)) for left in (True, False)]
    assert turns == pytest.approx([0.005 / (spur.base_diameter / 2)] * 2)


def test_taking_off_turns_each_flank_into_the_tooth() -> None:
    """The left flank is the counter-clockwise one: it turns clockwise, by the depth over the base radius."""
    form = replace(GEAR, modification=FlankModification(profile_crowning=10.0)).flank_form
    assert float(form.turn(LAST, 3.0, left=True)) == pytest.approx(-0.010 / (GEAR.base_diameter / 2))
    assert float(form.turn(LAST, 3.0, left=False)) == pytest.approx(0.010 / (GEAR.base_diameter / 2))


# What is permitted


def test_in_use_is_what_does_something() -> None:
    made = FlankModification(tip_relief=3, tip_relief_length=1.0, root_relief_length=2.0, twist=-1)
    assert made.in_use == {"tip_relief": 3.0, "tip_relief_length": 1.0, "tip_relief_shape": "linear", "twist": -1.0}
    assert FlankModification(twist=1).on_profile and FlankModification(twist=1).along_face
    assert not FlankModification(tip_relief_length=1.0).present


def test_shapes_are_words_or_members() -> None:
    made = FlankModification(end_relief_shape="parabolic")  # type: ignore[arg-type]
    assert made.end_relief_shape is ReliefShape.PARABOLIC
    assert made.to_dict()["end_relief_shape"] == "parabolic"


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"tip_relief": -1}, "tip_relief = -1 µm: must be a number at least 0 µm and at most 1000 µm"),
        ({"profile_crowning": 1001}, "profile_crowning = 1001 µm: must be a number at least -1000 µm and at most 1000 µm"),
        ({"twist": math.nan}, "twist = nan µm: must be a number"),
        ({"end_relief_length": -1}, "end_relief_length = -1 mm: must be a number at least 0 mm"),
        ({"root_relief_shape": "round"}, "root_relief_shape = 'round': must be one of 'linear', 'parabolic'"),
    ],
)
def test_wrong_values_are_refused(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        FlankModification(**wrong)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("relief", ["tip_relief", "root_relief", "end_relief"])
def test_a_relief_needs_a_length(relief: str) -> None:
    with pytest.raises(GeometryError, match=f"{relief}_length = 0 mm: must be at least 0.001 mm for a {relief} above 0 µm"):
        FlankModification(**{relief: 5.0})


@pytest.mark.parametrize(
    ("name", "most"), [("tip_relief_length", ROLL), ("root_relief_length", ROLL), ("end_relief_length", 8.0)]
)
def test_lengths_fit_the_flank(name: str, most: float) -> None:
    replace(GEAR, modification=FlankModification(**{name: 0.999999 * most}))
    with pytest.raises(GeometryError, match=rf"modification\.{name} = .* mm: must be at most {f'{most:.4g}'[:4]}"):
        replace(GEAR, modification=FlankModification(**{name: 1.00001 * most}))


def test_something_of_the_tip_must_be_left() -> None:
    """Both flanks lose C_alpha_a r_a/r_b of the land, measured along the tip circle."""
    tip = GEAR.tip_diameter
    land = tip * math.radians(GEAR.profile.half_angle(tip / 2))
    most = 1000 * land / 2 * GEAR.base_diameter / tip
    assert most < 1000
    for share in (0.99, 1.01):
        modification = FlankModification(tip_relief=share * most, tip_relief_length=2.0, lead_crowning=-0.001)
        if share < 1:
            assert replace(GEAR, modification=modification).modification is modification
        else:
            with pytest.raises(GeometryError, match=r"modification\.tip_relief = .* µm: must be smaller: .* of the tip land"):
                replace(GEAR, modification=modification)


def test_flanks_that_grow_need_space_at_the_root() -> None:
    """A fully rounded root has no land to give; a helix moves both flanks alike and needs none."""
    full = Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius="full"))
    replace(full, modification=FlankModification(helix_angle_modification=50.0, root_relief=5.0, root_relief_length=1.0))
    with pytest.raises(GeometryError, match=r"modification\.profile_crowning = -2 µm: .* of the root of the space"):
        replace(full, modification=FlankModification(profile_crowning=-2.0))


def test_a_modification_is_one() -> None:
    with pytest.raises(ParameterError, match="modification = 3: must be a FlankModification"):
        replace(GEAR, modification=3)  # type: ignore[arg-type]
