"""Reference cases of `tests/data/geometry.json`: inputs, printed values, and values verified in two independent ways."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from gearcad import BasicRack, Gear, GearPair

_FILE = Path(__file__).parent.parent / "data" / "geometry.json"
_CASES: dict[str, dict[str, Any]] = {entry["id"]: entry for entry in json.loads(_FILE.read_text(encoding="utf-8"))}

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
