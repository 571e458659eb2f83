"""gearcad: from a handful of numbers to an exact cylindrical gear.

Everywhere, in every argument, field, property, file and message: lengths in mm, angles in degrees, forces in N, torques in N·m,
stresses in MPa, speeds in rpm, masses in kg, times in s; deviations and deflections in µm. z is the gear axis; tooth 0
is centred on +x at z = 0; the teeth span z = 0 ... face width. Right-hand helix angles are positive. Profile shift is
in normal modules.

>>> from gearcad import Gear, GearPair, Load
>>> pair = GearPair(pinion=Gear(teeth=20, normal_module=2, face_width=20), wheel=Gear(teeth=30, normal_module=2, face_width=20))
>>> pair.wheel
Gear(teeth=30, normal_module=2.0, face_width=20.0)
>>> round(pair.transverse_contact_ratio, 3)
1.605

What is done with a pair under a load is a job: `gearcad.jobs.check.assess(pair, Load(torque=60))` checks it,
`gearcad.jobs.stiffness.compare` tells its mesh stiffness by every method, `gearcad.jobs.dynamics.simulate` its dynamics,
`gearcad.jobs.modify.propose` its tip relief, and `gearcad.rating.rate(pair, material, load)` rates it. Each takes, beside the
pair and the load, `material`, `mounting` and the options of the tables of a spec by their names. `gearcad.solids` makes solids
and files.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.errors import GearcadError, GeometryError, ParameterError, SolverError, SpecError
    from gearcad.geometry import (
        ISO53_A,
        ISO53_B,
        ISO53_C,
        ISO53_D,
        BasicRack,
        Body,
        FlankModification,
        Gear,
        GearPair,
        HubSide,
        ReliefShape,
        ShiftSplit,
        ToothProfile,
    )
    from gearcad.load import Load
    from gearcad.material import Material
    from gearcad.mounting import Mounting

__all__ = [
    "ISO53_A",
    "ISO53_B",
    "ISO53_C",
    "ISO53_D",
    "BasicRack",
    "Body",
    "FlankModification",
    "Gear",
    "GearPair",
    "GearcadError",
    "GeometryError",
    "HubSide",
    "Load",
    "Material",
    "Mounting",
    "ParameterError",
    "ReliefShape",
    "ShiftSplit",
    "SolverError",
    "SpecError",
    "ToothProfile",
    "__version__",
]

__version__ = "0.1.0"

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        ("errors", "geometry", "load", "material", "mounting"),
        ("batch", "check", "contact", "designs", "dynamics", "jobs", "rating", "solids", "stiffness"),
    )


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
