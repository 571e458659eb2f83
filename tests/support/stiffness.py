"""The pair of the Alm thesis's table 4, and the reference cases of `tests/data/stiffness.json`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from gearcad import BasicRack, Body, Gear, GearPair, Load

_FILE = Path(__file__).parent.parent / "data" / "stiffness.json"
_CASES: dict[str, dict[str, Any]] = {entry["id"]: entry for entry in json.loads(_FILE.read_text(encoding="utf-8"))}

THESIS_LOAD = Load(torque=12.7)


def stiffness_case(name: str) -> dict[str, Any]:
    """One reference case: `inputs`, `verified` (N/mm, mm/N), `source`, `notes`."""
    return _CASES[name]


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
