"""StiffnessComparison: the same pair by several methods, how far they lie apart, and its curves as a table."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.loaded import width_in_mesh
from gearcad.core.quantities import inputs_document
from gearcad.core.records import Floats, JsonObject, Notice, Pictured, texts
from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Materials, materials_document
from gearcad.mesh_cycle import MeshCycle

_PATH_PLACES = 2001
"""Places over which a mean over the path of contact is taken."""


class MeanAtTorque(NamedTuple):
    """Mean secant and tangent stiffness (N/µm) by a method at a torque on the pinion (N·m)."""

    method: str
    torque: float
    mean: float
    tangent_mean: float


@dataclass(frozen=True, kw_only=True)
class StiffnessComparison(Pictured):
    """A pair as mounted, its load, and its mesh cycle by each method; `left_out` says why the others have none.

    `titles` are those of all methods that there are, by name, in their order.
    """

    pair: GearPair | RackPair
    material: Materials
    load: Load
    body: BodyModel
    cycles: tuple[MeshCycle, ...]
    load_points: tuple[MeanAtTorque, ...]
    left_out: Mapping[str, str]
    titles: Mapping[str, str]

    def __repr__(self) -> str:
        means = ", ".join(f"{cycle.method} {cycle.mean:.4g}" for cycle in self.cycles)
        return f"<StiffnessComparison of {self.pair.name!r} at {self.load.torque:g} N·m: {means} N/µm>"

    @property
    def reference(self) -> MeshCycle | None:
        """Mesh cycle by which the others are measured: the 3D contact, None if it is not there."""
        return next((cycle for cycle in self.cycles if cycle.method == "3d"), None)

    def deviation(self, cycle: MeshCycle) -> float | None:
        """Return the relative deviation of the mean from that of the 3D contact (1 is 100 %); None without a 3D contact."""
        return cycle.mean / self.reference.mean - 1 if self.reference is not None else None

    def path_position(self, roll_angle: Floats) -> Floats:
        """Return the places (n,) in mm from T1 where the middle pair touches in the middle plane, at roll angles (n,) in
        degrees.
        """
        result: Floats = self.pair.path_of_contact.C + np.radians(roll_angle) * self.pair.pinion.base_diameter / 2
        return result

    def mean_over_path(self, cycle: MeshCycle) -> float:
        """Return the mean secant stiffness (N/µm) over the path of contact, which counts double contact twice.

        That is how many papers average their curves; `cycle.mean` is over one base pitch.
        """
        path = self.pair.path_of_contact
        places = np.linspace(path.A, path.E, _PATH_PLACES)
        return float(cycle.stiffness_at(np.degrees((places - path.C) / (self.pair.pinion.base_diameter / 2))).mean())

    # ------------------------------------------------------------------ at a glance

    @property
    def softest(self) -> MeshCycle:
        """Mesh cycle of the least mean stiffness."""
        return min(self.cycles, key=lambda cycle: cycle.mean)

    @property
    def stiffest(self) -> MeshCycle:
        """Mesh cycle of the greatest mean stiffness."""
        return max(self.cycles, key=lambda cycle: cycle.mean)

    @property
    def divided(self) -> list[MeshCycle]:
        """Mesh cycles that know more than one part of their compliance."""
        return [cycle for cycle in self.cycles if len(cycle.telling_parts) > 1]

    def divided_with(self, part: str) -> list[MeshCycle]:
        """Return the `divided` cycles that know this part of their compliance."""
        return [cycle for cycle in self.divided if part in cycle.compliance_parts]

    @property
    def over_load(self) -> dict[str, list[MeanAtTorque]]:
        """Means of each method by rising torque."""
        points = sorted(self.load_points, key=lambda point: point.torque)
        return {name: own for name in self.titles if (own := [point for point in points if point.method == name])}

    @property
    def torques(self) -> tuple[float, float]:
        """Least and greatest torque (N·m) for which there are means."""
        torques = [point.torque for point in self.load_points]
        return min(torques), max(torques)

    @property
    def load_rises(self) -> dict[str, float]:
        """Relative growth of the mean secant stiffness from the least to the greatest load (1 is 100 %).

        It is there for methods that depend on the load.
        """
        over_load = self.over_load
        own = {cycle.method: over_load[cycle.method] for cycle in self.cycles if len(over_load.get(cycle.method, ())) > 1}
        return {name: points[-1].mean / points[0].mean - 1 for name, points in own.items()}

    # ------------------------------------------------------------------ documents

    @property
    def bodies(self) -> dict[str, str]:
        """Words on how each body is modelled."""
        return self.body.describe(self.pair)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before trusting a method with this pair."""
        return tuple(notice.within(self.titles[cycle.method]) for cycle in self.cycles for notice in cycle.notices)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self, harmonics: int = 0) -> JsonObject:
        """Return the document of `stiffness.json`, with so many Fourier coefficients of each curve."""
        return {
            "load": inputs_document(self.load),
            **materials_document(self.material),
            "body": self.bodies,
            "common_width": width_in_mesh(self.pair),
            "transverse_contact_ratio": self.pair.transverse_contact_ratio,
            "overlap_ratio": self.pair.overlap_ratio,
            "methods": {
                cycle.method: {
                    "title": self.titles[cycle.method],
                    **cycle.to_dict(),
                    "mean_over_path": self.mean_over_path(cycle),
                    "deviation_from_3d": self.deviation(cycle),
                    "compliance_shares": {name: cycle.part_share(name) for name in cycle.compliance_parts},
                    **({"fourier": cycle.fourier(harmonics).to_dict()} if harmonics and not cycle.mean_only else {}),
                }
                for cycle in self.cycles
            },
            "load_dependence": [point._asdict() for point in self.load_points],
            "load_rises": self.load_rises,
            "left_out": dict(self.left_out),
        }


_COLUMNS = ("method", "roll_angle", "path_position", "mesh_stiffness", "tangent_stiffness", "transmission_error")


def curves_csv(comparison: StiffnessComparison) -> str:
    """Return the curves of all methods, one row for each roll angle of each: degrees, mm from T1, N/µm, µm, µm/N.

    Load shares stand under `load_share.PAIR`, compliances under `compliance.PART`; blank where a method has none.
    """
    cycles = comparison.cycles
    pairs = sorted({pair for cycle in cycles for pair in cycle.pairs})
    parts = list(dict.fromkeys(part for cycle in cycles for part in cycle.compliance_parts))
    headings = [*_COLUMNS, *(f"load_share.{pair}" for pair in pairs), *(f"compliance.{part}" for part in parts)]
    text = io.StringIO()
    writer = csv.DictWriter(text, headings, lineterminator="\n", restval="")
    writer.writeheader()
    for cycle in cycles:
        places = comparison.path_position(cycle.roll_angle)
        for row, (angle, place) in enumerate(zip(cycle.roll_angle.tolist(), places.tolist(), strict=True)):
            writer.writerow(
                {
                    "method": cycle.method,
                    "roll_angle": angle,
                    "path_position": place,
                    "mesh_stiffness": cycle.mesh_stiffness[row],
                    "tangent_stiffness": cycle.tangent_stiffness[row],
                    "transmission_error": cycle.transmission_error[row],
                    **{f"load_share.{pair}": cycle.load_share[row, at] for at, pair in enumerate(cycle.pairs)},
                    **{f"compliance.{name}": part[row] for name, part in cycle.compliance_parts.items()},
                }
            )
    return text.getvalue()
