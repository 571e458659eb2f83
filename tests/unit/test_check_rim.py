"""What a check says of thin rims: a gate that fails where they are held rigidly, and all that bends where they are not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.check.comparison import Subject
from gearcad.check.options import CheckOptions
from gearcad.check.result import CheckResult
from gearcad.check.run import check_pair
from gearcad.check.task import check_task
from gearcad.contact.shared.bodies import BodyModel, Hold
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear

LIMIT = 300.0
"""MPa: above the greatest root tension of the thin rim at half the load, below its compression."""


def _checked(bore: float, load: float = 150.0, **options: Any) -> CheckResult:
    """The FZG pair, its pinion with a bore of 50 mm at half the load of stage 9."""
    pinion = Gear(teeth=16, normal_module=4.5, face_width=14, profile_shift=0.1817, body=Body(bore=bore))
    wheel = replace(pinion, teeth=24, profile_shift=0.1715, body=Body(bore=30))
    chosen = CheckOptions(convergence="off", torques=(load,), positions=12, **options)
    material = Material(root_limit=LIMIT)
    return check_pair(check_task(GearPair(pinion=pinion, wheel=wheel), material, Load(torque=load), chosen))


def _gate(result: CheckResult, quantity: str) -> Any:
    return next((each for each in result.comparisons if each.quantity == quantity), None)


def test_a_thin_rim_held_rigidly_fails_the_check_and_a_free_one_is_judged_by_what_it_bends() -> None:
    rigid, free = _checked(50, pinion_support="rigid"), _checked(50)
    gate = _gate(rigid, "tooth depth over rim, pinion")
    assert not gate.passed and not rigid.passed
    pinion = rigid.pair.pinion
    ratio = (pinion.root_diameter / 2 - 25) / ((pinion.tip_diameter - pinion.root_diameter) / 2)
    assert gate.computed == pytest.approx(1 / ratio, rel=1e-12)
    assert any("held rigidly" in each for each in rigid.warnings)
    assert rigid.summary.bore_tension_pinion is None
    assert _gate(free, "tooth depth over rim, pinion") is None
    assert "free" in free.bodies["pinion"]
    compression = _gate(free, "root compression, pinion")
    assert compression.computed == -free.summary.root_compression.pinion > LIMIT > free.summary.root_tension.pinion
    assert not compression.passed
    bore = free.summary.bore_tension_pinion
    assert _gate(free, "tension on the bore, pinion").computed == bore
    assert any(f"bore is {bore:.0f} MPa" in each and f"{ratio:.3g} tooth depths" in each for each in free.warnings)
    notes = {each.quantity: each.note for each in free.comparisons if each.subject is Subject.STANDARD}
    assert f"({free.summary.root_compression.pinion:.0f} MPa)" in notes["root stress, pinion"]
    assert "Y_B" not in notes["root stress, wheel"]
    # The wheel is thick, and nobody bends it.
    assert _gate(free, "root compression, wheel") is None
    assert free.summary.bore_tension_wheel is None


def test_hertz_holds_for_flanks_of_a_rim_that_bends() -> None:
    """The rim turns the tooth, so that other parts of its involute meet: their curvature is what is compared."""
    free = _checked(50, load=302.0)
    assert _gate(free, "peak contact pressure").passed
    assert _gate(free, "half width of contact").passed


def test_solid_bodies_know_no_shaft_and_no_key() -> None:
    keyed = Gear(teeth=16, normal_module=4.5, face_width=14, body=Body(bore=45, keyway_width=10, keyway_depth=2))
    pair = GearPair(pinion=keyed, wheel=replace(keyed, teeth=24))
    assert [each.hold for each in BodyModel().supports(pair)] == [Hold.KEY, Hold.RIGID]
    assert [each.hold for each in BodyModel().for_solids().supports(pair)] == [Hold.FREE, Hold.RIGID]
    with pytest.raises(ParameterError, match=r'pinion_support.*must be "rigid" or "free" for solid bodies'):
        BodyModel(holds=PerGear(Hold.SHAFT, Hold.AUTO)).for_solids().supports(pair)


@pytest.mark.long
def test_solid_rims_bend_like_those_of_a_plane() -> None:
    """A spur gear of 14 mm: the solid one a little more at the root, where the load is uneven, as a thick one is too."""
    thick, plane, solid = (
        _checked(bore, model=model, refinement=fineness).summary
        for bore, model, fineness in ((30.0, "2d", 1.0), (50.0, "2d", 1.0), (50.0, "3d", 0.7))
    )
    assert plane.root_compression.pinion < 1.5 * thick.root_compression.pinion
    assert solid.root_compression.pinion == pytest.approx(plane.root_compression.pinion, rel=0.05)
    assert solid.bore_tension_pinion == pytest.approx(plane.bore_tension_pinion, rel=0.05)
    assert solid.mesh_stiffness_mean == pytest.approx(plane.mesh_stiffness_mean, rel=0.06)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"pinion_support": "loose"}, "pinion_support.*'rigid'.*'free'"),
        ({"wheel_support": ["free"]}, "wheel_support"),
        ({"shaft_modulus": 0.0}, "shaft_modulus"),
        ({"wheel_shaft_bore": -1.0}, "wheel_shaft_bore"),
    ],
)
def test_options_of_a_support(options: Any, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        CheckOptions(**options)
