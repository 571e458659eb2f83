"""The two methods that take a tooth for a beam on an elastic body: potential energy, and Weber and Banaschek.

In a helical pair a slice is cut across the lines of contact: the tooth's normal section under F_n/l = F_bt/b, whose
deflection delta_n is delta_t = delta_n/cos beta_b along the transverse line of action. Compliances of the section over
cos beta_b are so those of the transverse section - the factor cos beta of ISO 6336-1 (80).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import GeometryError, ParameterError
from gearcad.load import Load
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.rim import RIM_LIMIT
from gearcad.stiffness.foundation import sainsot_foundation, sainsot_range, weber_foundation
from gearcad.stiffness.section import BeamLoad, BeamTooth
from gearcad.stiffness.slice_method import SliceMethod
from gearcad.stiffness.slices import SinglePair

__all__ = ["BeamMethod", "PotentialEnergy", "WeberBanaschek"]


@dataclass(frozen=True, kw_only=True)
class BeamMethod(SliceMethod):
    """A method in closed form: compliances of both teeth and of their contact at any place on the line of action."""

    @cached_property
    def teeth(self) -> PerGear[BeamTooth]:
        """The teeth of both gears as beams."""
        return PerGear(*map(BeamTooth.from_gear, self.mounted.gears))

    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """One pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""
        parts: dict[str, Floats] = {}
        curvatures = self.curvatures(lengths)
        loads = PerGear.each(lambda role: self.teeth.pick(role).load_at(curvatures.pick(role)))
        for role, pressed in loads.items():
            parts |= {f"{role.value} {name}": part for name, part in self.tooth_parts(role, pressed).items()}
        parts["contact"] = self.contact(lengths, loads, load)
        self._refuse_negative(parts, load)
        factor = self.to_transverse
        return SinglePair(lengths, {name: factor * part for name, part in parts.items()}, factor * self.tangent_less)

    def _refuse_negative(self, parts: dict[str, Floats], load: Load) -> None:
        """Raise where a formula, far outside its range, gives less than nothing."""
        if (parts["contact"] <= 0).any():
            permitted = "must be lower: Hertz's contact would be as wide as the teeth are thick"
            raise ParameterError("load.torque", load.torque, permitted, "N·m")
        for role, gear in self.mounted.gears.items():
            if (parts[f"{role.value} foundation"] <= 0).any():
                permitted = "must leave another ring below the teeth: Sainsot's series gives less than nothing for this one"
                raise GeometryError(f"{role.value}.body.bore", gear.body.bore, permitted, "mm")

    @abstractmethod
    def tooth_parts(self, role: Role, load: BeamLoad) -> dict[str, Floats]:
        """Compliances (n,) of a tooth of a gear in its section, per width (mm²/N)."""

    @abstractmethod
    def contact(self, lengths: Floats, loads: PerGear[BeamLoad], load: Load) -> Floats:
        """Compliance (n,) of the contact of both flanks, per width (mm²/N)."""

    @property
    def tangent_less(self) -> float:
        """By how much the tangent compliance is below the secant one, per width (mm²/N)."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class PotentialEnergy(BeamMethod):
    """Bending, shear and axial energy of the true tooth (Yang and Lin 1987, Tian 2004) on Sainsot's elastic ring (2004).

    1/k_b = 12/(8 E b) int (u - x)^2 cos^2 a_F/h^3 dx,  1/k_s = 1.2 cos^2 a_F/(2 G b) int dx/h,
    1/k_a = sin^2 a_F/(2 E b) int dx/h, from the root circle along trochoid and involute to the contact,
    and 1/k_h = 4 (1 - nu^2)/(pi E b) whatever the load.
    """

    name = "potential-energy"
    title = "Potential energy"
    holds = ("contact, whatever the load", "bending", "shear", "axial", "foundation in an elastic ring")
    load_dependent: ClassVar[bool] = False
    no_internal_form: ClassVar[str] = "Sainsot's elastic ring lies inside the teeth, held at its bore, not outside them"

    @cached_property
    def rims(self) -> PerGear[float]:
        """h_f = r_f/r_i: root radius over that where the body is held."""
        gears, held = self.mounted.gears, self.body.inner_radii(self.mounted)
        return PerGear.each(lambda role: gears.pick(role).root_diameter / 2 / held.pick(role))

    def tooth_parts(self, role: Role, load: BeamLoad) -> dict[str, Floats]:
        material, tooth = self.materials.pick(role), self.teeth.pick(role)
        e, nu = material.youngs_modulus, material.poisson_ratio
        across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
        cubic, plain = tooth.integrals(load.x, load.crossing)
        return {
            "bending": 1.5 / e * across * cubic,
            "shear": 1.2 * (1 + nu) / e * across * plain,
            "axial": along / (2 * e) * plain,
            "foundation": sainsot_foundation(tooth, load, material, self.rims.pick(role)),
        }

    def contact(self, lengths: Floats, loads: PerGear[BeamLoad], load: Load) -> Floats:
        return np.full(len(lengths), _hertz(self))

    def notices(self, load: Load) -> Iterator[Notice]:
        for role, tooth in self.teeth.items():
            yield from (notice.within(role.value) for notice in sainsot_range(tooth, self.rims.pick(role)))
        yield from super().notices(load)


@dataclass(frozen=True, kw_only=True)
class WeberBanaschek(BeamMethod):
    """Tooth on its root chord, an elastic half-plane below it, and Hertz's flattening (Weber and Banaschek 1953).

    Beam: (1 - nu^2) cos^2 a_F/E [12 int (u - y)^2/(2 h)^3 dy + (2.4/(1 - nu) + tan^2 a_F) int dy/(2 h)] from the root chord to
    where the force crosses the centre line; contact, once for both teeth: 4 (1 - nu^2)/(pi E)
    [ln(2 sqrt(k_1 k_2)/a) - nu/(2 (1 - nu))] with the half width a under all of the load; of two materials half of either's.
    """

    name = "weber-banaschek"
    title = "Weber-Banaschek"
    holds = ("contact under all of the load", "bending", "shear", "axial", "foundation in a half-plane")
    no_internal_form: ClassVar[str] = "its beam and half-plane are those of teeth that stand out from their body"

    def tooth_parts(self, role: Role, load: BeamLoad) -> dict[str, Floats]:
        material, tooth = self.materials.pick(role), self.teeth.pick(role)
        e, nu = material.youngs_modulus, material.poisson_ratio
        across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
        cubic, plain = tooth.integrals(load.crossing, load.crossing)
        factor = (1 - nu**2) / e
        return {
            "bending": 1.5 * factor * across * cubic,
            "shear": 1.2 * (1 + nu) / e * across * plain,
            "axial": 0.5 * factor * along * plain,
            "foundation": weber_foundation(tooth, load, material),
        }

    def contact(self, lengths: Floats, loads: PerGear[BeamLoad], load: Load) -> Floats:
        first, second = self.curvatures(lengths)
        radius = first * second / (first + second)
        # a^2 = 8 F rho (1 - nu^2)/(pi E b): the load per length of the line is F_bt/b
        half_width = np.sqrt(2 * self.force(load) / self.width * radius * _hertz(self))
        to_centre = loads.map(lambda load: load.to_centre_line)
        depth = np.sqrt(to_centre.pinion * to_centre.wheel)
        pinion, wheel = (_flattening(material) for material in self.materials)
        across = [material.poisson_ratio / (2 * (1 - material.poisson_ratio)) for material in self.materials]
        mean = across[0] + (across[1] - across[0]) * wheel / (pinion + wheel)
        result: Floats = _hertz(self) * (np.log(2 * depth / half_width) - mean)
        if pinion != wheel:
            result = result + (pinion - wheel) / 4 * np.log(to_centre.pinion / to_centre.wheel)
        return result

    @property
    def tangent_less(self) -> float:
        """d(F ln(1/sqrt F))/dF: half of the factor before the logarithm."""
        return _hertz(self) / 2

    def notices(self, load: Load) -> Iterator[Notice]:
        yield from self._thin_rims()
        ends = self.curvatures(np.array(self.slices.path))
        for role, tooth in self.teeth.items():
            if (tooth.load_at(ends.pick(role)).crossing < tooth.root_chord[0]).any():
                text = "near the root the force crosses the centre line below the root chord: no beam there"
                yield Notice("below-root-chord", text, role.value)
        yield from super().notices(load)

    def _thin_rims(self) -> Iterator[Notice]:
        """Bodies that are no half-plane to their teeth."""
        for role, radius in self.body.inner_radii(self.mounted).items():
            gear = self.mounted.gears.pick(role)
            height = (gear.root_diameter - 2 * radius) / (gear.tip_diameter - gear.root_diameter)
            if height < RIM_LIMIT:
                text = f"only {height:.3g} tooth heights of body lie under the root, where the method has a half-plane"
                yield Notice("thin-rim", text, role.value)


def _hertz(method: BeamMethod) -> float:
    """4 (1 - nu^2)/(pi E) in mm²/N, the mean of both gears."""
    pinion, wheel = (_flattening(material) for material in method.materials)
    return (pinion + wheel) / 2


def _flattening(material: Material) -> float:
    return 4 * (1 - material.poisson_ratio**2) / (math.pi * material.youngs_modulus)
