"""Rings against values worked out elsewhere: Hertz along the path of contact, and root sections."""

import pytest

from gearcad import Body, Gear, GearPair, Load, Material, rate
from gearcad.geometry import ShaperCutter
from gearcad.rating import VirtualGear, contact_at
from gearcad.rating.root_section import load_point, ring_section, root_section, substitute_radius
from gearcad.rating.root_stress import form_factor

PRINTED = 6e-4
"""Relative: four or more digits."""

FORMULA = 1e-9
"""Relative, of formulas evaluated elsewhere."""

SEEN = 1e-3
"""Relative, of curvatures from neighbouring points there."""

STEEL = Material()

THESIS_RING = Gear(
    teeth=-70,
    normal_module=2.8,
    face_width=14.0,
    profile_shift=-1.2025,
    cutter=ShaperCutter(teeth=25, tip_radius=0.15),
    body=Body(rim_diameter=240.0),
)
THESIS = GearPair(
    pinion=Gear(teeth=22, normal_module=2.8, face_width=16.0, profile_shift=0.5), wheel=THESIS_RING, centre_distance=-69.0
)
"""Rim 3 of a planet and the ring that stands still of a master's thesis."""


def test_hertz_along_the_path_of_an_internal_pair() -> None:
    """One pair of teeth carries 5374.6 N on 14 mm."""
    expected = {"A": (9.263, 1221.9), "B": (16.100, 926.9), "C": (18.588, 862.6), "D": (24.344, 753.8), "E": (33.608, 641.5)}
    for point, distance in THESIS.path_of_contact._asdict().items():
        contact = contact_at(THESIS, STEEL, distance=distance, force=5374.6)
        assert (contact.radius, contact.peak_pressure) == pytest.approx(expected[point], rel=PRINTED / 10)


def test_pitch_point_of_an_internal_pair() -> None:
    """All of a torque is on one pair there; a pair of the same radii, both convex, would have R = 9.70 mm."""
    rating = rate(THESIS, Load(torque=5374.6 * THESIS.pinion.base_diameter / 2000)).nominal
    assert rating.pitch_point.peak_pressure == pytest.approx(862.6, rel=PRINTED / 10)
    assert rating.to_dict()["rho_C"] == pytest.approx(18.588, rel=PRINTED / 10)


Z80 = Gear(teeth=-80, normal_module=2.0, face_width=14.0, cutter=ShaperCutter(teeth=30, tip_radius=0.3))

SECTIONS = [
    (
        THESIS_RING,
        1.494,
        (8.670899295885024, 0.52156705143141),
        (0.3076103945766891, 8.3114922499587, 3.835356515692559, 0.12941158229861013, 0.9059329117208689, 24.119766285765845),
    ),
    (
        Z80,
        1.7,
        (5.528582948800044, 0.7177909999209667),
        (0.39922734552364336, 5.456589620969806, 2.701332851396659, 0.7352617109695181, 1.0936528064924185, 19.274320196200385),
    ),
]
"""Ring, contact ratio; chord, radius on the generated fillet; rho_fPv/m_n, s_Fn, h_Fe, rho_F, Y_F, alpha_Fen by formula."""


@pytest.mark.parametrize("ring, contact_ratio, exact, formula", SECTIONS)
def test_root_sections_of_rings(ring: Gear, contact_ratio: float, exact: tuple[float, ...], formula: tuple[float, ...]) -> None:
    virtual = VirtualGear.of(ring)
    load = load_point(virtual, contact_ratio)
    generated = root_section(ring, virtual, load)
    assert generated.chord == pytest.approx(exact[0], rel=1e-6)
    assert generated.fillet_radius == pytest.approx(exact[1], rel=SEEN)
    assert ring.cutter.teeth is not None
    radius = substitute_radius(ring, ring.cutter.teeth)
    section = ring_section(ring, virtual, load, radius)
    assert section is not None
    found = (
        radius / ring.normal_module,
        section.chord,
        section.moment_arm,
        section.fillet_radius,
        form_factor(section, load, virtual),
        load.load_angle,
    )
    assert found == pytest.approx(formula, rel=FORMULA)
