"""Reference cases of `tests/data`: geometry, ratings and stiffness, with the gears and pairs that they describe."""

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from gearcad import BasicRack, Body, Gear, GearPair, Load, Material
from gearcad.rating import Edition, Rating, RatingOptions, rate


def read_cases(name: str) -> dict[str, dict[str, Any]]:
    """The cases of a file of `tests/data`, by their ids."""
    text = (Path(__file__).parents[1] / "data" / f"{name}.json").read_text(encoding="utf-8")
    return {entry["id"]: entry for entry in json.loads(text)}


def data_rows(name: str) -> list[list[str]]:
    """The rows of a CSV file of `tests/data` below its heading."""
    text = (Path(__file__).parents[1] / "data" / f"{name}.csv").read_text(encoding="utf-8")
    return list(csv.reader(text.splitlines()))[1:]


_CASES, _RATINGS, _STIFFNESSES = (read_cases(name) for name in ("geometry", "rating", "stiffness"))

FACE_WIDTHS = (18.3, 15.1)


def case(name: str) -> dict[str, Any]:
    """One reference case: `inputs`, `expected_printed` (texts), `verified` (numbers), `source`, `notes`."""
    return _CASES[name]


def profile_cases() -> list[str]:
    """Names of the cases that hold points of a tooth profile."""
    return [name for name in _CASES if name.endswith(("_profile", "_profile_thin"))]


def diameters(pair: GearPair) -> dict[str, float]:
    """Diameters of both gears under the names of the reference cases: d1, db1, da1, df1, dw1, d2 ..."""
    found = {}
    for number, gear in enumerate((pair.pinion, pair.wheel), start=1):
        found |= {
            f"d{number}": gear.reference_diameter,
            f"db{number}": gear.base_diameter,
            f"da{number}": gear.tip_diameter,
            f"df{number}": gear.root_diameter,
            f"dw{number}": pair.working_pitch_diameters[number - 1],
        }
    return found


def half_unit(printed: str) -> float:
    """Half a unit of the last printed digit."""
    return 0.5 * 10.0 ** -len(printed.partition(".")[2])


def volvo_pair(*, root_radii: tuple[float, float] = (0.48, 0.32), thinning: tuple[float, float] = (0.08, 0.16)) -> GearPair:
    """The pair of the Chalmers/Volvo thesis at 80 mm, its tips shortened by the k that the pair asks for."""

    def gear(index: int) -> Gear:
        return Gear(
            teeth=(13, 44)[index],
            normal_module=2.5,
            face_width=FACE_WIDTHS[index],
            helix_angle=(28.0, -28.0)[index],
            profile_shift=(0.107, -0.378)[index],
            tooth_thinning=thinning[index],
            rack=BasicRack(root_radius=root_radii[index]),
        )

    plain = GearPair(pinion=gear(0), wheel=gear(1), centre_distance=80.0)
    k = plain.tip_alteration
    return replace(plain, pinion=replace(plain.pinion, tip_alteration=k), wheel=replace(plain.wheel, tip_alteration=k))


THINNING = {"fzg_c_iso6336_stiffness": 0.002}
"""mm on either gear: the shifts printed for the FZG gears need 91.503 mm, and overlap by 2.7 µm at 91.5 mm."""


def rating_case(name: str) -> dict[str, Any]:
    """One case: `inputs`, `expected` (or `verified`, or printed texts), `source`, `notes`."""
    return _RATINGS[name]


def shortened(pair: GearPair) -> GearPair:
    """The pair with its tips shortened by the k that it asks for."""
    k = pair.tip_alteration
    return replace(pair, pinion=replace(pair.pinion, tip_alteration=k), wheel=replace(pair.wheel, tip_alteration=k))


def pair_of(name: str, *, rack: BasicRack | None = None, short: bool | None = None) -> GearPair:
    """The pair of a case; `short` decides about the tip alteration where the case gives both."""
    given = _RATINGS[name]["inputs"]
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
    given = _RATINGS[name]["inputs"]
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


THESIS_LOAD = Load(torque=12.7)


def stiffness_case(name: str) -> dict[str, Any]:
    """One reference case: `inputs`, `verified` (N/mm, mm/N), `source`, `notes`."""
    return _STIFFNESSES[name]


def thesis_pair() -> GearPair:
    """z 18/161, m_n 1.5, b 15/10, a 135, tips shortened by 0.0104 m_n, bores 12 and 120 mm."""

    def gear(index: int) -> Gear:
        return Gear(
            teeth=(18, 161)[index],
            normal_module=1.5,
            face_width=(15.0, 10.0)[index],
            profile_shift=(0.3422, 0.1682)[index],
            tip_alteration=(135 - 134.25) / 1.5 - 0.5104,
            rack=BasicRack(root_radius=0.38),
            body=Body(bore=(12.0, 120.0)[index]),
        )

    return GearPair(pinion=gear(0), wheel=gear(1), centre_distance=135.0)
