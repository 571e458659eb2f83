"""Strain energy after Pedersen and Jorgensen: what a body stores under the pressure of Hertz's width, 1/K = 2 U/F².

2 U/F is the mean displacement of the flank under the pressure, weighted with it. The bodies are those of the FE contact:
a spline of unit loads for what is smooth, Flamant's straight edge in closed form for the rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.elasticity import Plane, PlaneElasticity
from gearcad.contact.plane.flank import PlaneCompliance
from gearcad.contact.plane.limits import thin_faces
from gearcad.contact.plane.pair import flank_body
from gearcad.geometry import Body, Gear
from gearcad.load import Load
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.stiffness.slice_method import SliceMethod
from gearcad.stiffness.slices import SinglePair

__all__ = ["StrainEnergy", "weighted_displacement"]


_POINTS = 7
"""Of Gauss's rule for an ellipse, across the width of contact."""

WeightedBody = tuple[float, PlaneCompliance]
"""How much of a gear's section a body stands for, and the body."""


@dataclass(frozen=True, kw_only=True)
class StrainEnergy(SliceMethod):
    """Elastic energy of both bodies, each under an ellipse of Hertz's width (Pedersen and Jorgensen 2014).

    In plane strain; of a helical gear it takes the normal section, between the virtual spur gears of whole numbers of teeth.
    The tangent stiffness is that of the energy: dU = F d(delta).
    """

    name = "strain-energy"
    title = "Strain energy"
    holds = ("contact under all of the load, by energy", "teeth", "bodies down to where they are held")
    plane: ClassVar[Plane] = Plane.STRAIN

    @cached_property
    def bodies(self) -> PerGear[list[WeightedBody]]:
        """Bodies of the section of each gear, with their weights."""
        pair = self.mounted
        held = self.body.inner_radii(pair)
        pinion, wheel = (
            [
                (
                    weight,
                    flank_body(section, radius, elasticity, self.body, 1, support=replace(support, teeth=section.tooth_count)),
                )
                for weight, section, radius in _sections(gear, inner)
            ]
            for gear, elasticity, inner, support in zip(
                pair.gears, self.elasticities, held, self.body.supports(pair), strict=True
            )
        )
        return PerGear(pinion, wheel)

    @property
    def elasticities(self) -> PerGear[PlaneElasticity]:
        """Those of both sections."""
        return self.materials.map(lambda material: PlaneElasticity(material, self.plane))

    def notices(self, load: Load) -> Iterator[Notice]:
        yield from thin_faces(self.mounted, self.material, self.plane)
        yield from super().notices(load)

    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """One pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""
        curvatures, gears = self.curvatures(lengths), self.mounted.gears
        first, second = curvatures
        pinion, wheel = (elasticity.modulus for elasticity in self.elasticities)
        modulus = pinion * (wheel / (pinion + wheel))  # exactly half of two that are equal
        half_widths = np.sqrt(4 * self.force(load) / self.width * first * second / (first + second) / (math.pi * modulus))
        factor = self.to_transverse
        parts = {
            role.value: factor * _displacements(gears.pick(role), bodies, curvatures.pick(role), half_widths)
            for role, bodies in self.bodies.items()
        }
        # U = F^2 c/2 with dc/dF = -1/(pi E* F), so dU/dF = F (c - 1/(2 pi E*)).
        return SinglePair(lengths, parts, factor / (2 * math.pi * modulus))


def weighted_displacement(body: PlaneCompliance, length: float, half_width: float) -> float:
    """2 U/F² (mm²/N): displacement of the flank under an ellipse of pressure around a roll length (mm), weighted with it."""
    place = np.arange(_POINTS, 0, -1) * math.pi / (_POINTS + 1)
    weight = 2 / (_POINTS + 1) * np.sin(place) ** 2
    flank = body.flank
    # A distance along the tangent is that much of arc: d(arc) = (length/r_b) d(length).
    arc = flank.arc(np.array([length])) + half_width * np.cos(place)
    lengths = flank.upward * np.sqrt(2 * flank.base_radius * np.maximum(flank.upward * arc, 0.0))
    regular = weight @ body.response(0)(lengths, lengths) @ weight
    elasticity = body.elasticity
    # The mean of ln|x - y| over two ellipses of half width a is ln(a/2) - 1/4.
    edge = -(2 * (math.log(half_width / 2) - 0.25) + 1 + elasticity.ratio) / (math.pi * elasticity.modulus)
    return float(regular + edge)


def _displacements(gear: Gear, bodies: list[WeightedBody], curvatures: Floats, half_widths: Floats) -> Floats:
    """2 U/F² (n,) in mm²/N where the flank's radius of curvature in the section is `curvatures` (n,) in mm."""
    total, side = np.zeros(len(curvatures)), -1 if gear.internal else 1
    for weight, body in bodies:
        section = body.flank.gear
        lengths = curvatures
        if section is not gear:
            # As high over the reference circle as on the virtual gear, whose number of teeth is between these.
            virtual = gear.normal_module * gear.virtual_teeth / 2
            base = virtual * math.cos(math.radians(gear.rack.pressure_angle))
            radius = side * np.hypot(base, curvatures) - virtual + section.reference_diameter / 2
            lengths = side * np.sqrt(np.maximum(radius**2 - (section.base_diameter / 2) ** 2, 0.0))
        ends = body.flank.lengths
        within = np.clip(lengths, ends.min(), ends.max())
        total += weight * np.array(
            [
                weighted_displacement(body, length, half)
                for length, half in zip(within.tolist(), half_widths.tolist(), strict=True)
            ]
        )
    return total


def _sections(gear: Gear, inner_radius: float) -> list[tuple[float, Gear, float]]:
    """Weights, spur gears and inner radii (mm) for the gear's section: itself, or the neighbours of its virtual gear."""
    if not gear.helix_angle:
        return [(1.0, gear, inner_radius)]
    side, virtual = -1 if gear.internal else 1, abs(gear.virtual_teeth)
    low = math.floor(virtual)
    # Compliance goes with 1/z.
    share = (1 / low - 1 / virtual) / (1 / low - 1 / (low + 1))
    depth = gear.profile.root_diameter / 2 - inner_radius
    cutter = gear.cutter
    if cutter.teeth is not None:
        cutter = replace(cutter, teeth=round(cutter.teeth * virtual / gear.tooth_count))
    found = []
    for weight, count in ((1 - share, low), (share, low + 1)):
        teeth = side * count
        size = gear.normal_module * teeth - gear.reference_diameter
        section = replace(
            gear,
            teeth=teeth,
            helix_angle=0.0,
            tip_diameter=gear.tip_diameter + size,
            root_diameter=gear.root_diameter + size,
            cutter=cutter,
            body=_bare(gear.body),
        )
        found.append((weight, section, section.profile.root_diameter / 2 - depth))
    return found


def _bare(body: Body) -> Body:
    """Without what is as large as the gear itself, and not as its virtual one."""
    bored = replace(body, bore=0.0, keyway=False, keyway_width=0.0, keyway_depth=0.0)
    return replace(bored, rim_diameter=None, bolt_circle=0.0, bolt_holes=0, bolt_diameter=0.0)
