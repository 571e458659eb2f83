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
from gearcad.rating.iso6336_3 import RIM_LIMIT
from gearcad.stiffness.foundation import sainsot_foundation, sainsot_range, weber_foundation
from gearcad.stiffness.section import BeamLoad, BeamTooth
from gearcad.stiffness.slice_method import SliceMethod
from gearcad.stiffness.slices import SinglePair

__all__ = ["BeamMethod", "PotentialEnergy", "WeberBanaschek"]


_OWNERS = ("pinion", "wheel")


@dataclass(frozen=True, kw_only=True)
class BeamMethod(SliceMethod):
    """A method in closed form: compliances of both teeth and of their contact at any place on the line of action."""

    @cached_property
    def teeth(self) -> tuple[BeamTooth, BeamTooth]:
        """Pinion and wheel."""
        return BeamTooth.of(self.mounted.pinion), BeamTooth.of(self.mounted.wheel)

    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """One pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""
        parts: dict[str, Floats] = {}
        loads = [tooth.load_at(at) for tooth, at in zip(self.teeth, self.curvatures(lengths), strict=True)]
        for gear, owner in enumerate(_OWNERS):
            parts |= {f"{owner} {name}": part for name, part in self.tooth_parts(gear, loads[gear]).items()}
        parts["contact"] = self.contact(lengths, (loads[0], loads[1]), load)
        self._refuse_negative(parts, load)
        factor = self.to_transverse
        return SinglePair(lengths, {name: factor * part for name, part in parts.items()}, factor * self.tangent_less)

    def _refuse_negative(self, parts: dict[str, Floats], load: Load) -> None:
        """Raise where a formula, far outside its range, gives less than nothing."""
        if (parts["contact"] <= 0).any():
            permitted = "must be lower: Hertz's contact would be as wide as the teeth are thick"
            raise ParameterError("load.torque", load.torque, permitted, "N·m")
        for owner, gear in zip(_OWNERS, (self.mounted.pinion, self.mounted.wheel), strict=True):
            if (parts[f"{owner} foundation"] <= 0).any():
                permitted = "must leave another ring below the teeth: Sainsot's series gives less than nothing for this one"
                raise GeometryError(f"{owner}.body.bore", gear.body.bore, permitted, "mm")

    @abstractmethod
    def tooth_parts(self, gear: int, load: BeamLoad) -> dict[str, Floats]:
        """Compliances (n,) of a tooth of the pinion (0) or wheel (1) in its section, per width (mm²/N)."""

    @abstractmethod
    def contact(self, lengths: Floats, loads: tuple[BeamLoad, BeamLoad], load: Load) -> Floats:
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

    @cached_property
    def rims(self) -> tuple[float, float]:
        """h_f = r_f/r_i: root radius over that where the body is held."""
        pair, held = self.mounted, self.body.inner_radii(self.mounted)
        return pair.pinion.root_diameter / 2 / held[0], pair.wheel.root_diameter / 2 / held[1]

    def tooth_parts(self, gear: int, load: BeamLoad) -> dict[str, Floats]:
        e, nu = self.material.youngs_modulus, self.material.poisson_ratio
        tooth = self.teeth[gear]
        across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
        cubic, plain = tooth.integrals(load.x, load.crossing)
        return {
            "bending": 1.5 / e * across * cubic,
            "shear": 1.2 * (1 + nu) / e * across * plain,
            "axial": along / (2 * e) * plain,
            "foundation": sainsot_foundation(tooth, load, self.material, self.rims[gear]),
        }

    def contact(self, lengths: Floats, loads: tuple[BeamLoad, BeamLoad], load: Load) -> Floats:
        return np.full(len(lengths), _hertz(self))

    @property
    def notes(self) -> tuple[str, ...]:
        found = [
            f"{owner}: {text}"
            for owner, tooth, rim in zip(_OWNERS, self.teeth, self.rims, strict=True)
            for text in sainsot_range(tooth, rim)
        ]
        return (*found, *super().notes)


@dataclass(frozen=True, kw_only=True)
class WeberBanaschek(BeamMethod):
    """Tooth on its root chord, an elastic half-plane below it, and Hertz's flattening (Weber and Banaschek 1953).

    Beam: (1 - nu^2) cos^2 a_F/E [12 int (u - y)^2/(2 h)^3 dy + (2.4/(1 - nu) + tan^2 a_F) int dy/(2 h)] from the root chord to
    where the force crosses the centre line; contact, once for both teeth: 4 (1 - nu^2)/(pi E)
    [ln(2 sqrt(k_1 k_2)/a) - nu/(2 (1 - nu))] with the half width a under all of the load.
    """

    name = "weber-banaschek"
    title = "Weber-Banaschek"
    holds = ("contact under all of the load", "bending", "shear", "axial", "foundation in a half-plane")

    def tooth_parts(self, gear: int, load: BeamLoad) -> dict[str, Floats]:
        e, nu = self.material.youngs_modulus, self.material.poisson_ratio
        tooth = self.teeth[gear]
        across, along = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
        cubic, plain = tooth.integrals(load.crossing, load.crossing)
        factor = (1 - nu**2) / e
        return {
            "bending": 1.5 * factor * across * cubic,
            "shear": 1.2 * (1 + nu) / e * across * plain,
            "axial": 0.5 * factor * along * plain,
            "foundation": weber_foundation(tooth, load, self.material),
        }

    def contact(self, lengths: Floats, loads: tuple[BeamLoad, BeamLoad], load: Load) -> Floats:
        nu = self.material.poisson_ratio
        first, second = self.curvatures(lengths)
        radius = first * second / (first + second)
        # a^2 = 8 F rho (1 - nu^2)/(pi E b): the load per length of the line is F_bt/b
        half_width = np.sqrt(2 * self.force(load) / self.width * radius * _hertz(self))
        depth = np.sqrt(loads[0].to_centre_line * loads[1].to_centre_line)
        result: Floats = _hertz(self) * (np.log(2 * depth / half_width) - nu / (2 * (1 - nu)))
        return result

    @property
    def tangent_less(self) -> float:
        """d(F ln(1/sqrt F))/dF: half of the factor before the logarithm."""
        return _hertz(self) / 2

    @property
    def notes(self) -> tuple[str, ...]:
        low = list(self._thin_rims())
        ends = np.array(self.slices.path)
        for owner, tooth, at in zip(_OWNERS, self.teeth, self.curvatures(ends), strict=True):
            if (tooth.load_at(at).crossing < tooth.root_chord[0]).any():
                low.append(f"{owner}: near the root the force crosses the centre line below the root chord: no beam there")
        return (*low, *super().notes)

    def _thin_rims(self) -> Iterator[str]:
        """Bodies that are no half-plane to their teeth."""
        gears, held = (self.mounted.pinion, self.mounted.wheel), self.body.inner_radii(self.mounted)
        for owner, gear, radius in zip(_OWNERS, gears, held, strict=True):
            height = (gear.root_diameter - 2 * radius) / (gear.tip_diameter - gear.root_diameter)
            if height < RIM_LIMIT:
                yield f"{owner}: only {height:.3g} tooth heights of body lie under the root, where the method has a half-plane"


def _hertz(method: BeamMethod) -> float:
    """4 (1 - nu^2)/(pi E) in mm²/N."""
    return 4 * (1 - method.material.poisson_ratio**2) / (math.pi * method.material.youngs_modulus)
