"""The same pair by several methods: what each of them holds, and how far they lie apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.errors import GearcadError, ParameterError
from gearcad.fea.flexible_pair import BodyModel
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.stiffness.method import StiffnessMethod
from gearcad.stiffness.methods import METHODS

__all__ = ["LoadPoint", "StiffnessComparison", "compare_methods"]

Floats = NDArray[np.float64]

_PARTS = (0.1, 0.3, 0.55, 0.77)
"""Of the load, at which the stiffness is wanted beside that at the load."""


class LoadPoint(NamedTuple):
    """Mean secant and tangent stiffness (N/µm) by a method at a torque on the pinion (N·m)."""

    method: str
    torque: float
    mean: float
    tangent_mean: float


@dataclass(frozen=True, kw_only=True)
class StiffnessComparison:
    """A pair as mounted, its load, and its mesh cycle by each method; `left_out` says why the others have none."""

    pair: GearPair
    material: Material
    load: Load
    body: BodyModel
    cycles: tuple[MeshCycle, ...]
    load_points: tuple[LoadPoint, ...]
    left_out: Mapping[str, str]

    @property
    def reference(self) -> MeshCycle | None:
        """What the others are measured by: the 3D contact, if it is there."""
        return next((cycle for cycle in self.cycles if cycle.method == "3d"), None)

    def deviation(self, cycle: MeshCycle) -> float | None:
        """Of the mean from that of the 3D contact (1 is 100 %)."""
        return cycle.mean / self.reference.mean - 1 if self.reference is not None else None

    def path_position(self, roll_angle: Floats) -> Floats:
        """Where the middle pair touches in the middle plane (n,) in mm from T1, at roll angles (n,) in degrees."""
        result: Floats = self.pair.path_of_contact.C + np.radians(roll_angle) * self.pair.pinion.base_diameter / 2
        return result

    @property
    def bodies(self) -> dict[str, str]:
        """How each body is taken, in words."""
        return self.body.describe(self.pair)

    def to_dict(self, harmonics: int = 0) -> dict[str, Any]:
        """The document of `stiffness.json`, with so many Fourier coefficients of each curve."""
        return {
            "load": asdict(self.load),
            "material": asdict(self.material),
            "body": self.bodies,
            "common_width": self.pair.common_width.width,
            "transverse_contact_ratio": self.pair.transverse_contact_ratio,
            "overlap_ratio": self.pair.overlap_ratio,
            "methods": {
                cycle.method: {
                    "title": METHODS[cycle.method].title,
                    **cycle.to_dict(),
                    "deviation_from_3d": self.deviation(cycle),
                    **({"fourier": cycle.fourier(harmonics).to_dict()} if harmonics and not cycle.mean_only else {}),
                }
                for cycle in self.cycles
            },
            "load_dependence": [point._asdict() for point in self.load_points],
            "left_out": dict(self.left_out),
        }


def compare_methods(
    pair: GearPair,
    material: Material,
    load: Load,
    methods: Sequence[str | StiffnessMethod] = tuple(METHODS),
    *,
    body: BodyModel | None = None,
    mounting: Mounting | None = None,
    positions: int = 0,
    progress: Callable[[str, int, int], None] = lambda _method, _done, _all: None,
) -> StiffnessComparison:
    """Mesh stiffness of a pair by several methods: their names, or methods that are made already.

    A method that cannot treat the pair is left out with its reason; if none can, the first reason is raised. `progress` is
    called with what is being done, how much is done, and how much there is.
    """
    body, mounting = body or BodyModel(), mounting or Mounting()
    cycles, points, left_out, failures = [], [], dict[str, str](), []
    for done, wanted in enumerate(methods):
        name = wanted if isinstance(wanted, str) else wanted.name
        if name not in METHODS:
            raise ParameterError("method", name, f"must be one of {', '.join(METHODS)}")
        progress(name, done, len(methods))
        try:
            if isinstance(wanted, str):
                wanted = METHODS[name](pair=pair, material=material, body=body, mounting=mounting, positions=positions)
            cycles.append(wanted(load))
            points += _over_load(wanted, load, cycles[-1])
        except GearcadError as error:
            left_out[name] = str(error)
            failures.append(error)
    if not cycles:
        raise failures[0]
    return StiffnessComparison(
        pair=mounting.mounted(pair),
        material=material,
        load=load,
        body=body,
        cycles=tuple(cycles),
        load_points=tuple(points),
        left_out=left_out,
    )


def _over_load(method: StiffnessMethod, load: Load, at_load: MeshCycle) -> list[LoadPoint]:
    """Means at parts of the load, and at the load itself."""
    loads = [replace(load, torque=part * load.torque) for part in _PARTS] if method.load_dependent else []
    cycles = [method(each, method.load_positions) for each in loads]
    return [LoadPoint(method.name, cycle.torque, cycle.mean, cycle.tangent_mean) for cycle in (*cycles, at_load)]
