"""Given shafts and meshes on shafts, as tests make them from tests/data/shafts.json."""

import json
from pathlib import Path
from typing import Any

from gearcad.core.records import PerGear
from gearcad.geometry import FlankModification, Gear, GearPair, profile_shift_sum
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft
from gearcad.shafts.face_load import MeshOnShafts

REFERENCE: dict[str, Any] = json.loads((Path(__file__).parents[1] / "data" / "shafts.json").read_text(encoding="utf-8"))


def shaft_of(inputs: dict[str, Any], stations: list[float] | None = None) -> SteppedShaft:
    def plain(value: Any) -> Any:
        return tuple(map(float, value)) if isinstance(value, list) else value if isinstance(value, str) else float(value)

    parts: dict[str, list[Any]] = {
        key: [kind(**{name: plain(value) for name, value in each.items()}) for each in inputs.get(key, [])]
        for key, kind in (("segments", ShaftSegment), ("bearings", ShaftBearing), ("forces", ShaftForce))
    }
    return SteppedShaft(
        **{key: tuple(each) for key, each in parts.items()},
        coupling=float(inputs["coupling"]),
        gravity=tuple(inputs.get("gravity", (0.0, 0.0, 0.0))),
        places=tuple(stations or ()),
    )


def mesh_of(inputs: dict[str, Any], **changed: Any) -> MeshOnShafts:
    module, teeth, helix = inputs["normal_module"], inputs["teeth"], inputs["helix_angle"]
    distance = inputs.get("centre_distance")
    shift = 0.0
    if distance is not None:
        shift = profile_shift_sum(
            normal_module=module, teeth=PerGear(*teeth), helix_angle=helix, pressure_angle=20.0, centre_distance=distance
        )
    gears = [
        Gear(
            teeth=z,
            normal_module=module,
            helix_angle=sign * helix,
            face_width=inputs["width"],
            profile_shift=shift / 2,
            modification=FlankModification(lead_crowning=crowning),
        )
        for z, sign, crowning in zip(teeth, (1, -1), (inputs.get("crowning", 0.0), 0.0), strict=True)
    ]
    pair = GearPair(pinion=gears[0], wheel=gears[1], **({} if distance is None else {"centre_distance": distance}))
    given = {
        "torque": inputs["torque"],
        "shafts": PerGear(shaft_of(inputs["pinion"]), shaft_of(inputs["wheel"])),
        "positions": PerGear(inputs["pinion"]["mesh_position"], inputs["wheel"]["mesh_position"]),
        "mesh_angle": inputs["mesh_angle"],
        "stiffness": inputs["stiffness"],
        "slices": inputs["slices"],
        "misalignment": inputs.get("misalignment", 0.0),
    }
    return MeshOnShafts(pair=pair, **{**given, **changed})
