"""Options without effect, and bearings without damping, are told."""

from __future__ import annotations

from gearcad.designs.keys import permitted_words
from gearcad.dynamics.options import DynamicsOptions, idle_in_contact, idle_without_levels, undamped_bearings

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
