"""Two flexible gears in mesh: the model that is loaded at any position and torque."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.contact import ContactSolution, solve_contact
from gearcad.contact.plane.elasticity import Plane, PlaneElasticity
from gearcad.contact.plane.flank import FlankCompliance, flank_compliance
from gearcad.contact.plane.mesh_positions import MeshLine, contact_pairs, mesh_line, rigid_approach
from gearcad.contact.plane.ring import Cuts, Ring, assemble
from gearcad.contact.plane.root import Fillets
from gearcad.contact.plane.support import STEEL, Hold, Support, support_of
from gearcad.errors import GeometryError, ParameterError, format_number, require_number, require_whole
from gearcad.geometry import Gear, GearPair
from gearcad.material import Material
from gearcad.meshing import MeshSizes, mesh_sector

__all__ = ["BodyModel", "FlexiblePair", "PairInMesh", "flank_body", "flexible_pair"]


_RIM = 4.0
"""Depth of the body below the root circle, in normal modules, where no bore is given."""

_CELLS = 66
_FIRST_CELLS = 24
_WINDOW = 3.0
"""Cells in the window of contact - fewer to find out how wide it is - and its half width in Hertz half widths."""

_LEAST_SHARE = 0.03
"""Share of the load for which the window of a pair is wide enough, however little it carries."""

_SOFT = 4000.0
"""A stiffness (N/mm per mm of width) that no pair of teeth falls below: bounds how far a tip corner can get."""


@dataclass(frozen=True, kw_only=True)
class BodyModel:
    """The part of each gear that is flexible: all teeth, or `teeth` of them (odd) between cuts; held on an inner circle.

    `inner_diameters` (mm) None stands for the bore, or 4 m_n below the root circle where there is none; `holds` is how they are
    held there, with a shaft of `shaft_modulus` (MPa) and `shaft_bores` (mm, 0 for solid ones). `solid` bodies know no shaft and
    no key. Raises ParameterError.
    """

    teeth: int | None = None
    cuts: Cuts = Cuts.FIXED
    inner_diameters: tuple[float | None, float | None] = (None, None)
    holds: tuple[Hold, Hold] = (Hold.AUTO, Hold.AUTO)
    shaft_modulus: float = STEEL
    shaft_bores: tuple[float, float] = (0.0, 0.0)
    solid: bool = False

    def __post_init__(self) -> None:
        if self.teeth is None:
            return
        require_whole("teeth", self.teeth, at_least=3, at_most=999)
        if self.teeth % 2 == 0:
            raise ParameterError("teeth", self.teeth, "must be odd: the loaded tooth stands in the middle")

    def inner_radii(self, pair: GearPair) -> tuple[float, float]:
        """Where the bodies of pinion and wheel are held (mm). Raises ParameterError and GeometryError."""
        found = []
        for owner, gear, inner in zip(_OWNERS, (pair.pinion, pair.wheel), self.inner_diameters, strict=True):
            with _of(owner):
                found.append(inner_radius(gear, inner))
        return found[0], found[1]

    def supports(self, pair: GearPair) -> tuple[Support, Support]:
        """What holds the bodies of pinion and wheel there. Raises ParameterError and GeometryError."""
        radii, gears = self.inner_radii(pair), (pair.pinion, pair.wheel)
        return self.support(gears[0], radii[0], 0), self.support(gears[1], radii[1], 1)

    def support(self, gear: Gear, radius: float, which: int) -> Support:
        """What holds the pinion (0) or the wheel (1), or another gear in its place, at a radius (mm)."""
        hold, ring = self.holds[which], self.teeth is None or self.teeth >= gear.teeth
        key = f"check.{_OWNERS[which]}_support"
        if not ring and hold not in (Hold.AUTO, Hold.RIGID):
            raise ParameterError(key, hold.value, 'must be "rigid" where body_teeth is less than the full ring')
        if self.solid and hold in (Hold.SHAFT, Hold.KEY):
            raise ParameterError(key, hold.value, 'must be "rigid" or "free" for solid bodies')
        if hold is Hold.AUTO and (not ring or self.inner_diameters[which] is not None):
            hold = Hold.RIGID  # a circle that is given is where the body is held
        shaft = Material(youngs_modulus=self.shaft_modulus)
        with _of(_OWNERS[which]):
            found = support_of(gear, radius, hold, shaft, self.shaft_bores[which])
        return replace(found, hold=Hold.FREE) if self.solid and found.hold is Hold.KEY else found

    def of_solids(self) -> BodyModel:
        """The same bodies as solids: of what can hold them, only "rigid" and "free"."""
        return replace(self, solid=True)

    def describe(self, pair: GearPair) -> dict[str, str]:
        """The bodies of pinion and wheel in words."""
        gears = zip(_OWNERS, (pair.pinion, pair.wheel), self.inner_radii(pair), self.supports(pair), strict=True)
        return {owner: self._words(gear, radius, support) for owner, gear, radius, support in gears}

    def _words(self, gear: Gear, radius: float, support: Support) -> str:
        inner = f"{support.words} diameter {format_number(round(radius * 2, 4))} mm"
        if self.teeth is None or self.teeth >= gear.teeth:
            return f"full ring, {inner}"
        return f"{self.teeth} teeth with {self.cuts.value} cuts, {inner}"


_OWNERS = ("pinion", "wheel")


@contextmanager
def _of(owner: str) -> Iterator[None]:
    """Let errors name the gear."""
    try:
        yield
    except (ParameterError, GeometryError) as error:
        raise error.within(owner) from error


def inner_radius(gear: Gear, inner_diameter: float | None) -> float:
    """Where the body is held (mm)."""
    root = gear.root_diameter / 2
    if inner_diameter is not None:
        require_number("inner_diameter", inner_diameter, "mm", above=0)
        if inner_diameter / 2 > root - 0.1 * gear.normal_module:
            most = gear.root_diameter - 0.2 * gear.normal_module
            raise GeometryError("inner_diameter", inner_diameter, f"must be at most {most:.6g} mm, below the root circle", "mm")
        return inner_diameter / 2
    return gear.body.bore / 2 if gear.body.bore else max(root - _RIM * gear.normal_module, 0.3 * root)


@dataclass(frozen=True)
class PairInMesh:
    """A pair as it rolls: where it touches at a roll angle, and the force of a torque."""

    pair: GearPair

    @property
    def repeats(self) -> bool:
        """True if one base pitch is like the next: no tooth differs from the others."""
        return True

    @property
    def width(self) -> float:
        """Common face width (mm), on which all of the load is."""
        return self.pair.common_width.width

    @property
    def base_radius(self) -> float:
        """The pinion's (mm)."""
        return self.pair.pinion.base_diameter / 2

    def force(self, torque: float) -> float:
        """Normal force in the transverse section (N per mm of common width) at a torque on the pinion (N m)."""
        return abs(torque) * 1000 / self.base_radius / self.width

    def require_narrow_contact(self, torque: float, modulus: float) -> None:
        """Raise ParameterError where the contact at the pitch point would be wider than teeth are deep: no small deformation.

        `modulus` is E* (MPa); half width by Hertz.
        """
        whole, place = mesh_line(self.pair).whole, self.pair.path_of_contact.C
        radius = place * (whole - place) / whole
        half_width = math.sqrt(4 * self.force(torque) * radius / (math.pi * modulus))
        depth = min((gear.tip_diameter - gear.root_diameter) / 2 for gear in (self.pair.pinion, self.pair.wheel))
        if half_width > depth:
            most = abs(torque) * (depth / half_width) ** 2  # the half width goes with the root of the load
            permitted = f"must be at most {most:.4g} N·m in size for these teeth and this modulus of elasticity"
            why = f"the contact would be {2 * half_width:.4g} mm wide on teeth {depth:.4g} mm deep"
            raise ParameterError("torque", torque, f"{permitted}: {why}", "N·m")

    def roll_length(self, roll_angle: float) -> float:
        """Where the middle pair touches in the middle of the common width (mm from T1) at a roll angle of the pinion (deg)."""
        return self.pair.path_of_contact.C + math.radians(roll_angle) * self.base_radius

    def roll_angles(self, count: int) -> Floats:
        """Roll angles (deg) over one base pitch, as many before the pitch point as after it."""
        pitch = 360 / self.pair.pinion.teeth
        return (np.arange(count) + 0.5) / count * pitch - pitch / 2


@dataclass(frozen=True)
class FlexiblePair(PairInMesh):
    """The bodies of pinion and wheel, factorised and solved for loads on the flank; any position and torque is quick."""

    line: MeshLine
    pinion: FlankCompliance
    wheel: FlankCompliance

    @property
    def repeats(self) -> bool:
        """True unless the middle pair of teeth stands proud."""
        return not self.line.proud

    @cached_property
    def fillets(self) -> tuple[Fillets, Fillets]:
        """Stresses of the roots of both gears, as responses to loads on their flanks."""
        return Fillets(self.pinion), Fillets(self.wheel)

    @property
    def modulus(self) -> float:
        """Reduced modulus of the contact (MPa): 1/E* = 1/E'_1 + 1/E'_2."""
        return 1 / (1 / self.pinion.elasticity.modulus + 1 / self.wheel.elasticity.modulus)

    def rigid_approach(self, roll_angle: float, *, single: bool = False) -> float:
        """How far (mm) the gears would approach at a roll angle (deg) before the first pair of teeth touches, unloaded."""
        return rigid_approach(self.line, self.roll_length(roll_angle), single=single)

    def solve(self, roll_angle: float, torque: float, *, single: bool = False) -> ContactSolution:
        """The contact at a roll angle (deg) and torque (N m); `single` lets no other pair of teeth touch.

        Raises SolverError, and GeometryError where nothing can touch.
        """
        self.require_narrow_contact(torque, self.modulus)
        force = self.force(torque)
        # The first solution tells what each pair carries, and so how wide its contact is.
        carried = self._solve(roll_angle, force, lambda _tooth: force, single, _FIRST_CELLS)
        shares = {pair.tooth: share for pair, share in zip(carried.pairs, carried.forces, strict=True)}
        return self._solve(roll_angle, force, lambda tooth: max(shares.get(tooth, 0.0), _LEAST_SHARE * force), single, _CELLS)

    def _solve(
        self, roll_angle: float, force: float, carried: Callable[[int], float], single: bool, cells: int
    ) -> ContactSolution:
        """The contact, with windows for what each pair of teeth is thought to carry (N per mm)."""

        def span(tooth: int, radius: float) -> float:
            return _WINDOW * math.sqrt(4 * carried(tooth) * radius / (math.pi * self.modulus))

        least_width = max(self.pinion.resolution, self.wheel.resolution)
        farthest = self.rigid_approach(roll_angle, single=single) + force / _SOFT
        pairs = contact_pairs(self.line, self.roll_length(roll_angle), span, cells, farthest, least_width)
        if single:
            pairs = tuple(pair for pair in pairs if pair.tooth == 0)
        if not pairs:
            raise GeometryError("roll_angle", roll_angle, "must be one at which teeth can touch", "deg")
        return solve_contact(pairs, self.pinion, self.wheel, force)


def flexible_pair(
    pair: GearPair,
    material: Material,
    *,
    plane: Plane = Plane.STRAIN,
    body: BodyModel | None = None,
    sizes: MeshSizes | None = None,
    pitch_error: float = 0.0,
    solve: Callable[[Gear, Ring, PlaneElasticity], FlankCompliance] = flank_compliance,
) -> FlexiblePair:
    """Mesh, assemble, factorise and `solve` both gears. Raises SolverError, ParameterError and GeometryError.

    The pair is taken as it is mounted; `pitch_error` (um) is how far the flanks of its middle pair of teeth stand proud.
    """
    elasticity, body, sizes = PlaneElasticity(material, plane), body or BodyModel(), sizes or MeshSizes()
    # As many neighbours as can touch at once, with one more place for a corner that touches early or late.
    neighbours = max(1, math.floor(pair.transverse_contact_ratio + 0.2))
    bodies = [
        flank_body(gear, radius, elasticity, body, neighbours, sizes, solve, support)
        for gear, radius, support in zip((pair.pinion, pair.wheel), body.inner_radii(pair), body.supports(pair), strict=True)
    ]
    return FlexiblePair(pair, mesh_line(pair, pitch_error), *bodies)


def flank_body(
    gear: Gear,
    inner_radius: float,
    elasticity: PlaneElasticity,
    body: BodyModel,
    neighbours: int,
    sizes: MeshSizes | None = None,
    solve: Callable[[Gear, Ring, PlaneElasticity], FlankCompliance] = flank_compliance,
    support: Support | None = None,
) -> FlankCompliance:
    """One gear, held at `inner_radius` (mm), with so many `neighbours` in full on each side of the loaded tooth."""
    sizes = sizes or MeshSizes()
    held = body.teeth if body.teeth is not None and body.teeth < gear.teeth else None
    if held is not None:
        held = max(held, 2 * neighbours + 1)
    fine, coarse = mesh_sector(gear, inner_radius, sizes), mesh_sector(gear, inner_radius, sizes.coarse())
    ring = assemble(fine, coarse, gear.teeth, min(neighbours, (gear.teeth - 1) // 2), elasticity, held, body.cuts, support)
    return solve(gear, ring, elasticity)
