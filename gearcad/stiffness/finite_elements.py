"""Mesh stiffness by finite elements: strain energy after Pedersen and Jorgensen, and contact as in the structural check.

2 U/F is the mean displacement of the flank under the pressure, weighted with it. The bodies are those of the FE contact:
a spline of unit loads for what is smooth, Flamant's straight edge in closed form for the rest.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from gearcad.contact.plane.cycle import thin_faces
from gearcad.contact.plane.flank import PlaneCompliance, PlaneFlank
from gearcad.contact.plane.pair import PlanePair, flank_body, plane_pair
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.line_of_action import loaded_left
from gearcad.contact.shared.loaded import EngagedPair
from gearcad.contact.solid.pair import POSITION_SECONDS, SolidPair, SolidSizes, expected_bodies, solid_pair
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, Notice, PerGear
from gearcad.core.runtime import Expected
from gearcad.geometry import Body, Gear, RackPair
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.stiffness.method import SinglePair, SliceMethod, StiffnessMethod, left_out

_POINTS = 7
"""Number of points of Gauss's rule for an ellipse, across the width of contact."""

WeightedBody = tuple[float, PlaneCompliance]
"""Share of a gear's section that a body represents, and the body."""


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
        """Plane elasticities of both sections."""
        return self.materials.map(lambda material: PlaneElasticity(material, self.plane))

    def notices(self, load: Load) -> Iterator[Notice]:
        yield from thin_faces(self.mounted, self.material, self.plane)
        yield from super().notices(load)

    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """Return one pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""
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
    assert isinstance(flank, PlaneFlank)  # of a gear
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
        assert isinstance(body.flank, PlaneFlank)  # of a gear
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


def _precut_roots(gear: Gear, size: float, virtual: float) -> dict[str, Any]:
    """Return the circles of a section that is larger by `size` (mm), of a gear that is cut before its flanks are finished."""
    pre, end = gear.premachining, gear.finishing.end_diameter
    if pre.cutter_teeth is not None:
        pre = replace(pre, cutter_teeth=round(pre.cutter_teeth * virtual / gear.tooth_count))
    tips = {} if pre.topping is not None else {"tip_diameter": gear.tip_diameter + size}
    return tips | {"premachining": pre, "finishing": replace(gear.finishing, end_diameter=None if end is None else end + size)}


def _sections(gear: Gear, inner_radius: float) -> list[tuple[float, Gear, float]]:
    """Return the weights, spur gears and inner radii (mm) for the gear's section: itself, or the neighbours of its virtual
    gear.
    """
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
        if gear.premachining.present:
            roots: dict[str, Any] = _precut_roots(gear, size, virtual)
        else:
            roots = {"tip_diameter": gear.tip_diameter + size, "root_diameter": gear.root_diameter + size, "cutter": cutter}
        section = replace(
            gear,
            teeth=teeth,
            helix_angle=0.0,
            **roots,
            body=_bare(gear.body),
        )
        found.append((weight, section, section.profile.root_diameter / 2 - depth))
    return found


def _bare(body: Body) -> Body:
    """Return the body without the parts that are as large as the gear itself, and not as its virtual one."""
    bored = replace(body, bore=0.0, keyway=False, keyway_width=0.0, keyway_depth=0.0)
    return replace(bored, rim_diameter=None, bolt_circle=0.0, bolt_holes=0, bolt_diameter=0.0)


_STEP = 0.02
"""Relative change of the torque on both sides of the load between which the tangent stiffness is taken."""


_SOLUTIONS = 2
"""Time for all loads at a position, for slopes and load dependence, over that for the first."""


class _Position(NamedTuple):
    """One under load: approach, its rigid part and the parts of pinion and wheel (mm), forces of the pairs (N)."""

    approach: float
    rigid: float
    parts: PerGear[float]
    forces: Mapping[int, float]


@dataclass(frozen=True, kw_only=True)
class ContactMethod(StiffnessMethod):
    """Flexible gears pressed together at every position; pairs of teeth share the load as their bodies and gaps make them."""

    holds = ("contact under each pair's own load", "teeth", "bodies down to where they are held", "neighbouring teeth")

    @abstractmethod
    def _position(self, roll_angle: float, torque: float) -> _Position:
        """Return the mesh at a roll angle (deg) under a torque on the pinion (N·m), signed."""

    @abstractmethod
    def _single(self, torque: float) -> float:
        """Return the greatest stiffness of one pair alone (N/(mm·µm))."""

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        torque, force = math.copysign(self.torque(load), load.torque), self.force(load)
        angles = EngagedPair(self.engaged).roll_angles(count)
        # All torques at one position after another: what a model knows of flanks there serves all of them.
        loads = [torque * (1 + sign * _STEP) for sign in (0, -1, 1)]
        found, softer, harder = zip(
            *([self._position(angle, each) for each in loads] for angle in angles.tolist()), strict=True
        )
        further = np.array([more.approach - less.approach for more, less in zip(harder, softer, strict=True)])
        approach, rigid = (np.array([getattr(each, name) for each in found]) for name in ("approach", "rigid"))
        parts = np.array([each.parts for each in found])
        pairs = tuple(sorted(set().union(*(each.forces for each in found))))
        shares = np.array([[each.forces.get(pair, 0.0) for pair in pairs] for each in found])
        gaps = approach - rigid - parts.sum(1)
        um = 1000 / force
        return MeshCycle(
            **self.inputs(load),
            roll_angle=np.r_[angles, angles[0] + 360 / self.engaged.pinion.teeth],
            mesh_stiffness=_closed(1 / (um * (approach - rigid))),
            tangent_stiffness=_closed(2 * _STEP / (um * further)),
            transmission_error=_closed(1000 * approach),
            pairs=pairs,
            load_share=_closed(shares / shares.sum(1, keepdims=True)),
            compliance_parts={
                "pinion": _closed(um * parts[:, 0]),
                "wheel": _closed(um * parts[:, 1]),
                "gaps closed": _closed(um * gaps),
            },
            single_stiffness=self._single(torque) * self.width,
        )

    def notices(self, load: Load) -> Iterator[Notice]:
        """None: bodies and flanks are taken as they are."""
        return iter(())


@dataclass(frozen=True, kw_only=True)
class PlaneContact(ContactMethod):
    """Contact in the transverse section, for spur gears."""

    bodies: PlanePair | None = field(default=None, repr=False)
    """Those of a check, if there was one; else they are made."""

    plane: ClassVar[Plane]
    rack_form = True
    default_positions: ClassVar[int] = 120
    seconds: ClassVar[float] = 3.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if helix := self.pair.pinion.helix_angle:
            permitted = f"must be 0 for {self.name}: lines of contact of helical teeth run across the flank, as 3d has them"
            raise GeometryError("pair.helix_angle", helix, permitted, "deg")

    @cached_property
    def model(self) -> PlanePair:
        """The bodies, factorised."""
        if self.bodies is not None:
            return self.bodies
        error = self.mounting.pitch_error
        return plane_pair(self.engaged, self.material, plane=self.plane, body=self.body, pitch_error=error)

    def _position(self, roll_angle: float, torque: float) -> _Position:
        found = self.model.solve(roll_angle, torque)
        forces = {
            pair.tooth: float(force) * self.width for pair, force in zip(found.pairs, found.forces, strict=True) if force > 0
        }
        return _Position(found.approach, self.model.rigid_approach(roll_angle), found.parts, forces)

    def _single(self, torque: float) -> float:
        return self.model.single_stiffness(torque)

    def notices(self, load: Load) -> Iterator[Notice]:
        """Yield notices on thin gears, and on what a section leaves out."""
        pair = self.engaged
        yield from thin_faces(pair, self.material, self.plane)
        gears = (pair.pinion,) if isinstance(pair, RackPair) else pair.gears
        along = any(gear.modification.along_face for gear in gears)
        found = [
            *(["modifications along the face width"] if along else []),
            *(["misalignment"] if self.mounting.tilted else []),
        ]
        yield from left_out(found)


@dataclass(frozen=True, kw_only=True)
class PlaneStressContact(PlaneContact):
    """FE contact in plane stress: a section that is free to change its thickness."""

    name = "plane-stress"
    title = "FE contact, plane stress"
    plane = Plane.STRESS


@dataclass(frozen=True, kw_only=True)
class PlaneStrainContact(PlaneContact):
    """FE contact in plane strain: a section of a gear that is wide."""

    name = "plane-strain"
    title = "FE contact, plane strain"
    plane = Plane.STRAIN


@dataclass(frozen=True, kw_only=True)
class SolidContact(ContactMethod):
    """FE contact of solid bodies over their face widths, along the lines of contact."""

    name = "3d"
    title = "FE contact, solid bodies"
    default_positions: ClassVar[int] = 60
    load_positions: ClassVar[int] = 0  # the bodies' responses are known there

    bodies: SolidPair | None = field(default=None, repr=False)
    """Those of a check, if there was one, for the sign of torque that it had; else they are made."""

    def model(self, torque: float) -> SolidPair:
        """Return the bodies, condensed; under a negative torque on the pinion those of the mirrored pair."""
        if self.bodies is not None:
            return self.bodies
        return self._loaded_left if torque > 0 else self._loaded_right

    @cached_property
    def _loaded_left(self) -> SolidPair:
        return self._made(1.0)

    @cached_property
    def _loaded_right(self) -> SolidPair:
        return self._made(-1.0)

    def _made(self, torque: float) -> SolidPair:
        """Return the bodies for the sign of a torque."""
        mounting, share = replace(self.mounting, centre_distance_change=0.0), self._bodies.seconds / self.expected.seconds
        pair = loaded_left(self.mounted, torque)
        return solid_pair(pair, self.material, body=self.body, mounting=mounting, tell=lambda done: self.tell(share * done))

    @cached_property
    def _bodies(self) -> Expected:
        return expected_bodies(self.mounted, self.body, SolidSizes())

    @property
    def expected(self) -> Expected:
        positions = self.positions or self.default_positions
        return Expected(self._bodies.seconds + _SOLUTIONS * positions * POSITION_SECONDS, self._bodies.memory)

    def _position(self, roll_angle: float, torque: float) -> _Position:
        model = self.model(torque)
        found = model.solve(roll_angle, torque)
        flat, forces = math.cos(model.helix), dict[int, float]()
        for line, cells in zip(found.given.lines, found.given.split(found.forces), strict=True):
            if cells.sum() > 0:
                forces[line.tooth] = float(cells.sum()) * flat
        approach = found.approach - found.by_supports  # supports are no part of the stiffness of a mesh
        return _Position(approach / flat, found.rigid / flat, found.parts.map(lambda part: part / flat), forces)

    def _single(self, torque: float) -> float:
        return self.model(torque).single_stiffness(torque)


def _closed(values: Floats) -> Floats:
    """Return the values (n, ...) over a base pitch, and the first again at its end."""
    return np.concatenate([values, values[:1]])
