"""Specs of pairs that are written: reading one gives the very same design."""

import tomllib

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.strategies import MODIFICATIONS, build_pair, modified, pair_inputs

from gearcad import Gear, GearPair, Load, Material
from gearcad.core.errors import GearcadError
from gearcad.designs import PairDesign, design_from_tables
from gearcad.designs.reader import starter_text, starters
from gearcad.designs.spec_writers import pair_text
from gearcad.rating.editions import Edition
from gearcad.rating.options import RatingOptions

PAIRS = [name for name in starters() if "[wheel]" in starter_text(name)[1]]


def read(text: str) -> PairDesign:
    """Without a name of its own it would be "unnamed"."""
    design = design_from_tables(tomllib.loads(text), where=lambda key: key, default_name="unnamed")
    assert isinstance(design, PairDesign)
    return design


@pytest.mark.parametrize("name", PAIRS)
def test_starters_are_written_as_they_were_read(name: str) -> None:
    design = read(starter_text(name)[1])
    again = read(pair_text(design))
    assert again == design
    assert again.pair.to_dict() == design.pair.to_dict()
    assert pair_text(again) == pair_text(design)


@settings(max_examples=25, deadline=None)
@given(pair_inputs(), MODIFICATIONS, st.booleans())
def test_any_pair_is_written_to_the_last_digit(inputs: dict[str, object], changes: dict[str, float] | None, held: bool) -> None:
    try:
        pair = build_pair(inputs)
        gears = [modified(gear, changes) for gear in pair.gears]
        distance = {"centre_distance": float(pair.centre_distance)} if held else {}
        pair = GearPair(pinion=gears[0], wheel=gears[1], name="any", axial_offset=pair.axial_offset, **distance)
    except GearcadError:
        assume(False)
    again = read(pair_text(PairDesign(name="any", pair=pair)))
    assert again.pair == pair
    assert again.pair.to_dict() == pair.to_dict()


def test_what_a_spec_would_guess_is_written() -> None:
    """The other hand, automatic tips, names of gears, and enums, digits and words of the tables beside them."""
    gears = [
        Gear(name=name, teeth=teeth, normal_module=1 / 3, face_width=20 / 7, tooth_thinning=0.01)
        for name, teeth in (("sun", 20), ('planet ü "1"', 21))
    ]
    pair = GearPair(pinion=gears[0], wheel=gears[1], name="sun-planet")
    beside = {
        "material": Material(name="16MnCr5", density=7.1e3, contact_limit=(1.1e3, 1.3e3)),
        "load": Load(torque=1e-5 / 3, speed=-1e3 / 7),
        "rating": RatingOptions(standard=Edition.DIN_1987, accuracy_grade=5),
    }
    design = PairDesign(name="sun-planet", pair=pair, **beside)
    text = pair_text(design, ["one line,", "another"])
    assert text.startswith("# one line,\n# another\n\n[pair]\n")
    assert text.count("tip_alteration = 0.0") == text.count("helix_angle = 0.0") == 2
    assert "auto" not in text
    assert read(text) == design
