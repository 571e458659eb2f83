"""Strength of a spline joint: mean pressure, shear and torsion by hand, and the contact of all teeth in the plane.

Forces in N, torques in N·m, stresses in MPa, lengths in mm.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from functools import cached_property

from gearcad.contact.plane.sector import Plane
from gearcad.contact.plane.spline_contact import CELLS, SplineContact, joint_contact
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, JsonObject, Notice
from gearcad.core.runtime import Agenda, Progress
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_standards import HUB, SHAFT
from gearcad.load import Load
from gearcad.material import Material

_FINER = 2
"""Factor by which cells and elements of the second solution are finer."""

_ENDS = 0.1
"""Share of a flank at each end where pressure hangs on the sharpness of an edge, and is not told."""

_PERMITTED = 0.02
"""Largest difference of two meshes in root stresses and shares that passes."""


@dataclass(frozen=True)
class MeanStresses:
    """Stresses (MPa) of a joint whose teeth carry in equal parts, so far as they carry at all.

    `flank_pressure` T K_A/(r_m h z b phi) on the common height h of the flanks, r_m in its middle; `tooth_shear` on the
    reference circle; `torsion` of the core of the shaft within its roots, without a notch factor.
    """

    flank_pressure: float
    tooth_shear: float
    torsion: float

    @classmethod
    def of(cls, joint: SplineJoint, load: Load) -> MeanStresses:
        """Return the mean stresses of a joint under its load."""
        shaft, hub = joint.parts[SHAFT], joint.parts[HUB]
        torque, carrying = 1000 * abs(load.torque) * load.application_factor, joint.carrying_share * joint.count
        middle, height = (shaft.tip_diameter + hub.tip_diameter) / 4, (shaft.tip_diameter - hub.tip_diameter) / 2
        on_flank = torque / (middle * height * joint.length * carrying)
        sheared = torque / (joint.reference_diameter / 2 * shaft.built_size * joint.length * carrying)
        ratio = joint.shaft.bore / shaft.root_diameter
        return cls(on_flank, sheared, 16 * torque / (math.pi * shaft.root_diameter**3 * (1 - ratio**4)))


@dataclass(frozen=True)
class SplineCheck:
    """Contact of a joint under its load, once and with finer cells and elements; what is told is of the finer one.

    `play` (mm) is that between the flanks, and `of_play` says of what size.
    """

    joint: SplineJoint
    load: Load
    play: float
    of_play: str
    mean: MeanStresses
    coarse: SplineContact
    contact: SplineContact

    @cached_property
    def convergence(self) -> dict[str, float]:
        """Difference of both solutions over the finer one: of the greatest share, and of the root stresses."""
        found = {"greatest_share": _relative(self.coarse.shares, self.contact.shares)}
        for name, coarse, fine in zip((SHAFT, HUB), self.coarse.root_stresses, self.contact.root_stresses, strict=True):
            found[f"root_stress_{name}"] = _relative(coarse, fine)
        return found

    @property
    def passed(self) -> bool:
        """Whether both solutions agree."""
        return max(map(abs, self.convergence.values())) <= _PERMITTED

    @property
    def carrying(self) -> float:
        """Share of the teeth that would carry if all of these carried like the most loaded one."""
        return float(1 / (self.contact.shares.max() * self.joint.count))

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about the result."""
        text = (
            "the pressure at the ends of the flanks hangs on how sharp their edges are: it is told for the rest of the height"
        )
        found = [Notice("pressure-at-edges", text)]
        if self.play < 0:
            found.append(Notice("spline-press-fit", "the flanks overlap before they are loaded: both sides of the teeth press"))
        return tuple(found)

    def to_dict(self) -> JsonObject:
        """Return the content of check.json: teeth in order, counter-clockwise from tooth 0 of the shaft on the x axis."""
        contact, length = self.contact, self.joint.length
        shaft, hub = contact.root_stresses
        return {
            "model": "2d",
            "torque": self.load.torque,
            "application_factor": self.load.application_factor,
            "radial_force": self.joint.radial_force,
            "play": self.play,
            "of_play": self.of_play,
            "mean": asdict(self.mean) | {"carrying_share": self.joint.carrying_share},
            "contact": {
                "turn": math.degrees(contact.turn),
                "shift": contact.shift.tolist(),
                "carrying_share": self.carrying,
                "shares": contact.shares.tolist(),
                "torques": (contact.torques * length / 1000).tolist(),
                "forces": (contact.forces * length).tolist(),
                "mean_pressures": contact.mean_pressures.tolist(),
                "greatest_mean_pressure": float(contact.mean_pressures.max()),
                "greatest_pressure": _inner_pressure(contact),
                "root_stress": {SHAFT: shaft.tolist(), HUB: hub.tolist()},
                "greatest_root_stress": {SHAFT: float(shaft.max()), HUB: float(hub.max())},
            },
            "convergence": self.convergence,
        }


def _relative(coarse: Floats, fine: Floats) -> float:
    return float(coarse.max() / fine.max() - 1)


def _inner_pressure(contact: SplineContact) -> float:
    """Greatest pressure (MPa) away from the ends of the flanks."""
    count = contact.cells.count
    skip = math.ceil(_ENDS * count)
    sides = contact.pressures.reshape(-1, count)
    return float(sides[:, skip : count - skip].max())


def check_spline(joint: SplineJoint, load: Load, material: Material, progress: Progress | None = None) -> SplineCheck:
    """Return the contact of all teeth under K_A times the torque, through the effective play where that is known.

    Raises GeometryError for a shaft or a hub alone, and SolverError.
    """
    if len(joint.parts) < 2:
        raise GeometryError("designation", joint.designation, "must name a shaft and a hub: strength is that of both")
    play, of_play = _play_of(joint)
    factor = load.application_factor / joint.length
    torque, force = 1000 * load.torque * factor, joint.radial_force * factor
    agenda = Agenda(progress, {"contact": 1.0, "finer": 4.0})
    found = []
    for step, finer in (("contact", 1), ("finer", _FINER)):
        agenda(step)
        found.append(
            joint_contact(
                joint,
                torque,
                (material, material),
                play=play,
                radial_force=force,
                plane=Plane.STRAIN,
                cells=CELLS * finer,
                refinement=finer,
            )
        )
    return SplineCheck(joint, load, play, of_play, MeanStresses.of(joint, load), *found)


def _play_of(joint: SplineJoint) -> tuple[float, str]:
    """Return the play (mm) through which the flanks come together: the mean effective one, else that of the solids."""
    least, most = joint.effective_play_min, joint.effective_play_max
    if least is not None and most is not None:
        return (least + most) / 2, "mean effective play"
    return joint.parts[HUB].built_size - joint.parts[SHAFT].built_size, "play of the solids"
