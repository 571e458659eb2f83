"""gearcad: from a handful of numbers to an exact cylindrical gear.

Everywhere, in every argument, field, property, file and message: lengths in mm, angles in degrees, forces in N, torques in N·m,
stresses in MPa, speeds in rpm, masses in kg, times in s; deviations and deflections in µm. z is the gear axis; tooth 0
is centred on +x at z = 0; the teeth span z = 0 ... face width. Right-hand helix angles are positive. Profile shift is
in normal modules.
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
else:

    def __getattr__(name: str) -> object:
        """A name is imported when it is first asked for: until then the command line is as quick to start as to be stopped."""
        from importlib import import_module

        homes = ("errors", "geometry", "load", "material", "mounting")
        if name in homes:
            return import_module(f"{__name__}.{name}")
        for home in homes if name in __all__ else ():
            module = import_module(f"{__name__}.{home}")
            if name in module.__all__:
                return globals().setdefault(name, getattr(module, name))
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


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


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
