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

What is done with gears is a verb. It takes a pair and a load, or a design such as `read` makes of a spec, and beside them
`material`, `mounting`, and the options of the other tables of a spec by their names:

>>> import gearcad
>>> load = Load(torque=60)
>>> f"{gearcad.rate(pair, load).nominal.flank.nominal_stress:.0f} MPa"
'1058 MPa'
>>> gearcad.stiffness(pair, load, methods=["iso6336", "potential-energy"])
<StiffnessComparison of 'pair' at 60 N·m: iso6336 303.1, potential-energy 434.8 N/µm>
>>> gearcad.check(pair, 60)
Traceback (most recent call last):
...
gearcad.core.errors.ParameterError: load = 60: must be a Load

    read(file)                     the design in a spec: a gear, a rack, a pair or a train, with its load and options
    data(pair)                     every derived quantity
    build(pair, folder)            STEP, STL, 3MF, GLB, DXF, points
    draw(pair)                     sheets for the workshop, with gear data: DXF, SVG, PDF
    verify(pair)                   every claim about files and figures, judged by something that did not make it
    check(pair, load)              contact and root stress by finite elements, beside Hertz and ISO 6336
    mesh(gear)                     finite elements with named sides, of a section or a body, of a gear or a pair
    rate(pair, load)               safeties by ISO 6336 or DIN 3990, life, permissible torque
    stiffness(pair, load)          mesh stiffness by every method
    dynamics(pair, load)           natural frequencies, K_v over speed; of trains too
    planetary(train, load)         speeds, torques, assembly, load sharing, stiffness and modes of a planetary train
    shafts(pair, load)             deflection of shafts, life of their bearings, load over the face
    modify(pair, load)             tip relief and crowning for the load
    wear(pair, load)               profiles, load sharing and life of flanks that wear
    identify(teeth, ...)           the standard gears that measured diameters, spans or pins may be of
    tools(pair)                    the tools of the shelf that would cut the gears, with the root that each would leave
    export_rexs(pair)              the file of REXS, for other programs for drives; import_rexs(file) reads one

`gearcad.plots` draws gears and results, a call for each picture; a notebook shows them without one.

A class for each in `gearcad.jobs` writes the files of a result: `gearcad.jobs.strength.Check().write(result, folder)`.
"""

from __future__ import annotations

import lazy_loader

from gearcad.callable_room import HOMES
from gearcad.version import __version__ as __version__

TYPE_CHECKING = False  # typing takes four times as long to import as all of this
if TYPE_CHECKING:
    from pathlib import Path

    from gearcad.designs import Design

_CALLABLE_ROOMS = {
    "check": "jobs.strength",
    "dynamics": "jobs.dynamics",
    "identify": "jobs.searches",
    "planetary": "jobs.planetary",
    "shafts": "jobs.shafts",
    "stiffness": "jobs.strength",
}
"""Packages that can also be called as functions, and the module in which the function stands."""

HOMES.update({name: f"{__name__}.{home}" for name, home in (*_CALLABLE_ROOMS.items(), ("shown_in_notebook", "plots.first"))})

_ROOMS = ("batch", "contact", "designs", "jobs", "meshing", "plots", "rating", "sizing", "solids")

_HOMES = ("geometry", "load", "material", "mounting")
"""Rooms whose names are those of the package: `dir` lists the names alone."""

__getattr__, _, _names = lazy_loader.attach(
    __name__,
    (*_CALLABLE_ROOMS, *_ROOMS, *_HOMES),
    {
        "core.errors": ["GearcadError", "GeometryError", "ParameterError", "SolverError", "SpecError"],
        "core.records": ["Notice", "PerGear"],
        "geometry": [
            *("ISO53_A", "ISO53_B", "ISO53_C", "ISO53_D", "BasicRack", "Body", "DoubleHelix", "FlankModification", "Gear"),
            *(
                "GearPair",
                "HubInputs",
                "HubSide",
                "Rack",
                "RackPair",
                "ReliefShape",
                "ShaftInputs",
                "ShaperCutter",
                "ShiftSplit",
            ),
            *("SplineJoint", "SplinedBore", "ToothProfile"),
        ],
        "jobs.build": ["build"],
        "jobs.draw": ["draw", "picture"],
        "jobs.exchange": ["export_rexs", "import_rexs"],
        "jobs.wear": ["wear"],
        "jobs.job": ["data"],
        "jobs.mesh": ["mesh"],
        "jobs.modify": ["modify"],
        "jobs.strength": ["rate"],
        "jobs.tools": ["tools"],
        "jobs.verification": ["verify"],
        "load": ["Load"],
        "material": ["Material"],
        "mounting": ["Mounting"],
        "planetary": ["Carrier", "Central", "PairStage", "PlanetaryTrain", "Rim", "TrainLoad"],
    },
)

__all__ = sorted({*_names, "__version__", "read"} - {*_ROOMS, *_HOMES})


def __dir__() -> list[str]:
    return sorted({*__all__, *_ROOMS, *(name for name in globals() if name.startswith("__"))})


def read(path: Path | str) -> Design:
    """Read a TOML spec: a gear, a rack, a pair or a train, with its load and options. Raises SpecError.

    The name of the design is its own, else the stem of the file.
    """
    from gearcad.designs import read_spec

    return read_spec(path)
