"""What parts weigh, by volumes of exact solids (CadQuery) and by formulas; and that title blocks say it."""

from __future__ import annotations

import math

import pytest

from gearcad import Body, DoubleHelix, Gear, GearPair, Material, Rack
from gearcad.drawing.assembly_sheets import draw_pair
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair
from gearcad.drawing.gear_sheet import draw_gear, mass_of
from gearcad.drawing.options import DrawingOptions

PROMISED = 2e-4
"""Of volumes: the chords of the solid, a thousandth of a module off it."""

STEEL = Material()
KEYED = Body(bore=20, keyway_width=6, keyway_depth=2.8, hub_diameter=34, hub_length=8, end_chamfer=1, tip_chamfer=0.2)
RIM = Body(rim_diameter=170, bolt_circle=155, bolt_holes=8, bolt_diameter=6.6, end_chamfer=1)


# Volumes in mm³ of the exact solids, by OCP's VolumeProperties.
@pytest.mark.parametrize(
    ("part", "volume"),
    [
        (Gear(teeth=30, normal_module=2, face_width=20, body=KEYED), 53932.11),
        (Gear(teeth=23, normal_module=4, face_width=60, helix_angle=28, body=Body(bore=40, end_chamfer=1)), 431347.87),
        (Gear(teeth=23, normal_module=4, face_width=150, helix_angle=28, double_helix=DoubleHelix(gap_width=30)), 1213948.56),
        (Gear(teeth=-66, normal_module=2, face_width=20, body=RIM), 173995.13),
        (Rack(teeth=20, normal_module=2, face_width=20, height=18, helix_angle=15, tip_chamfer=0.15), 46560.57),
    ],
    ids=["keyed", "helical", "double helical", "ring", "rack"],
)
def test_masses_are_those_of_exact_solids(part: Gear | Rack, volume: float) -> None:
    found = mass_of(DrawnGear(role="gear", gear=part, material=Material(density=2700)))
    assert found == pytest.approx(volume * 2.7e-6, rel=PROMISED)


def test_what_is_not_known_has_no_mass() -> None:
    """Neither without a material, nor a ring that ends nowhere, nor what such a part belongs to."""
    ring, wheel = Gear(teeth=-60, normal_module=2, face_width=20), Gear(teeth=20, normal_module=2, face_width=20)
    assert mass_of(DrawnGear(role="ring", gear=ring, material=STEEL)) is None
    assert mass_of(DrawnGear(role="gear", gear=wheel)) is None
    for material, told in ((STEEL, True), (None, False)):
        parts = (DrawnGear(role="pinion", gear=wheel, material=STEEL), DrawnGear(role="wheel", gear=wheel, material=material))
        sheet = draw_pair(DrawnPair(name="p", pair=GearPair(pinion=wheel, wheel=wheel), parts=parts), DrawingOptions())
        assert ("mass" in sheet.shown) is told
        assert any(text.words.endswith(" kg") for text in sheet.figure.texts) is told


def test_title_blocks_say_the_mass() -> None:
    """Between those of steel cylinders through tips and through roots; a pair has twice that of its gears."""
    gear = Gear(teeth=30, normal_module=2, face_width=20, body=Body(bore=20))
    drawn = DrawnGear(role="gear", gear=gear, material=STEEL)
    sheet = draw_gear(drawn, DrawingOptions())
    least, most = (math.pi / 4 * (each**2 - 20**2) * 20 * 7.85e-6 for each in (gear.root_diameter, gear.tip_diameter))
    assert least < sheet.shown["mass"] < most
    assert f"{sheet.shown['mass']:.3g} kg" in [text.words for text in sheet.figure.texts]
    pair = draw_pair(DrawnPair(name="p", pair=GearPair(pinion=gear, wheel=gear), parts=(drawn, drawn)), DrawingOptions())
    assert pair.shown["mass"] == pytest.approx(2 * sheet.shown["mass"])
