"""Cases of `tests/data/rating.json`, and the pairs and ratings they describe."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.rating import Edition, Rating, RatingOptions, rate

_FILE = Path(__file__).parent.parent / "data" / "rating.json"
_CASES: dict[str, dict[str, Any]] = {entry["id"]: entry for entry in json.loads(_FILE.read_text(encoding="utf-8"))}

THINNING = {"fzg_c_iso6336_stiffness": 0.002}
"""mm on either gear: the shifts printed for the FZG gears need 91.503 mm, and overlap by 2.7 µm at 91.5 mm."""


def rating_case(name: str) -> dict[str, Any]:
    """One case: `inputs`, `expected` (or `verified`, or printed texts), `source`, `notes`."""
    return _CASES[name]


def shortened(pair: GearPair) -> GearPair:
    """The pair with its tips shortened by the k that it asks for."""
    k = pair.tip_alteration
    return replace(pair, pinion=replace(pair.pinion, tip_alteration=k), wheel=replace(pair.wheel, tip_alteration=k))


def pair_of(name: str, *, rack: BasicRack | None = None, short: bool | None = None) -> GearPair:
    """The pair of a case; `short` decides about the tip alteration where the case gives both."""
    given = _CASES[name]["inputs"]
    helix, widths, distance = given.get("beta_deg", 0.0), given["b_mm"], given.get("a_mm")
    widths = widths if isinstance(widths, list) else [widths, widths]
    drawn = given["rack"] if isinstance(given.get("rack"), dict) else {}
    gears = [
        Gear(
            teeth=given["z"][index],
            normal_module=given["m_n_mm"],
            face_width=widths[index],
            helix_angle=(helix, -helix)[index],
            profile_shift=given["x"][index],
            tooth_thinning=THINNING.get(name, 0.0),
            rack=rack or BasicRack(**drawn),
        )
        for index in (0, 1)
    ]
    distance = distance if isinstance(distance, int | float) else None
    pair = GearPair(pinion=gears[0], wheel=gears[1], centre_distance=distance)
    return shortened(pair) if ("tip_alteration" in given if short is None else short) else pair


def rated(pair: GearPair, name: str, edition: Edition = Edition.ISO_2006) -> Rating:
    """A pair under the load and material of a case."""
    given = _CASES[name]["inputs"]
    load = Load(torque=given["T1_Nm"], speed=given.get("n1_rpm", 0.0), application_factor=given.get("K_A", 1.0))
    return rate(pair, Material(youngs_modulus=given.get("E_MPa", 206000.0)), load, RatingOptions(standard=edition))


def rating_of(name: str, edition: Edition = Edition.ISO_2006) -> Rating:
    """The pair of a case under its load."""
    return rated(pair_of(name), name, edition)


STEEL = Material()


def sample_pair(helix: float = 15.0, **changes: Any) -> GearPair:
    """Gears of 19 and 47 teeth, m_n 3 mm, 32 and 28 mm wide, unequal shifts; `changes` of both gears."""
    pinion = Gear(teeth=19, normal_module=3.0, face_width=32.0, helix_angle=helix, profile_shift=0.35)
    wheel = replace(pinion, teeth=47, face_width=28.0, helix_angle=-helix, profile_shift=-0.12)
    return shortened(GearPair(pinion=replace(pinion, **changes), wheel=replace(wheel, **changes)))


def swapped(pair: GearPair) -> GearPair:
    """The same gears, the wheel driving."""
    return replace(pair, pinion=pair.wheel, wheel=pair.pinion, axial_offset=-pair.axial_offset)


def numbers(document: dict[str, Any]) -> dict[str, float]:
    """All numbers of a nested document under dotted names."""
    found: dict[str, float] = {}
    for key, value in document.items():
        if isinstance(value, dict):
            found |= {f"{key}.{name}": number for name, number in numbers(value).items()}
        elif not isinstance(value, str | list):
            found[key] = value
    return found
