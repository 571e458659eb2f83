"""Planar model of a gearbox of planetary sets in a state: bodies, springs and masses. SI units (N, m, rad) inside.

Every carrier, sun, ring, planet and shaft is a part with x, y and its turn, in a frame at rest. Members that are joined, for
good or by a clutch, are one body. Elongations are positive where flanks press. Planets do not tilt.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GearcadError, ParameterError
from gearcad.core.records import Floats
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.planetary.gearbox import Gearbox, StateResult
from gearcad.planetary.gearbox_assembly import PartMesh, SetAssembly
from gearcad.planetary.gearbox_sets import SetGear

_MICRO = 1e6
"""Factor from N/µm to N/m."""

_SPECIFIC_LOAD = 100.0
"""F_t/b in N/mm from which the single stiffness of ISO 6336-1 does not depend on the load."""

GIVEN, ISO = "given", "ISO 6336-1"
"""Origins of a mesh stiffness."""

Vector = tuple[float, float]


class GearboxSpring(NamedTuple):
    """A spring (N/m) between two points: `kind` is mesh, pin, support, torsion or shaft, `owner` that of which it is one.

    `terms` are the parts that it holds with the elongation for x, y and turn of each. `number` is the planet's, from 1, or 0.
    """

    kind: str
    owner: str
    number: int
    stiffness: float
    terms: tuple[tuple[str, float, float, float], ...]


@dataclass(frozen=True, eq=False)
class GearboxModel:
    """Springs and masses of a gearbox whose gears are known, in a state."""

    gearbox: Gearbox
    state: StateResult
    material: Material = field(default_factory=Material)

    # ------------------------------------------------------------------ parts

    @cached_property
    def planets(self) -> tuple[str, ...]:
        """Names of all bodies of planets, such as "set1.planet 2"."""
        return tuple(
            f"{name}.{body} {number}"
            for name, assembly in self.gearbox.assemblies.items()
            for body in assembly.axes
            for number in range(1, assembly.gearing.planets + 1)
        )

    @cached_property
    def members(self) -> tuple[str, ...]:
        """Names of all members and shafts."""
        return tuple(self.state.speeds)

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """Names of members and shafts, then of planets: each has three rows in all matrices."""
        return (*self.members, *self.planets)

    @cached_property
    def bodies(self) -> Mapping[str, str]:
        """The name of the body of each member and shaft: that of its first one."""
        found = {name: name for name in self.members}
        for group in (*self.gearbox.joined, *self.state.state.joined):
            roots = {found[name] for name in group}
            first = next(name for name in self.members if name in roots)
            found = {name: first if root in roots else root for name, root in found.items()}
        return found

    def _gear(self, member: str) -> SetGear | None:
        """Return the gear of a sun or a ring; None of a carrier or a shaft."""
        name, _, part = member.rpartition(".")
        assembly = self.gearbox.assemblies.get(name)
        return assembly.gearing.gears.get(part) if assembly is not None else None

    def _holds(self, member: str) -> tuple[float | None, float | None]:
        """Return the stiffness of a member's bearing (N/µm) and of what holds its turn (N·m/rad), None where none is given."""
        name = member.rpartition(".")[0]
        if not name:
            return 0.0, None
        own = self._gear(member) or self.gearbox.assemblies[name].gearing.carrier
        return own.support_stiffness, own.torsional_stiffness

    # ------------------------------------------------------------------ coordinates

    @cached_property
    def basis(self) -> Floats:
        """All coordinates (3 P, n) from the n that can move: of each body once, and none that is held or on a rigid pin."""
        columns: list[Floats] = []
        at = {name: 3 * place for place, name in enumerate(self.parts)}

        def add(*rows: tuple[int, float]) -> None:
            column = np.zeros(3 * len(self.parts))
            for row, value in rows:
                column[row] += value
            columns.append(column)

        moving = {
            (spring_part, axis)
            for each in self.springs
            for spring_part, *terms in each.terms
            for axis in range(3)
            if terms[axis]
        }
        for body in dict.fromkeys(self.bodies.values()):
            own = [name for name in self.members if self.bodies[name] == body]
            toothed = [name for name in own if "." in name]
            held = any(self._holds(name)[0] is None for name in toothed)
            carried = [rigid for name in own for rigid in self._carried(name)]
            if toothed and not held:
                for axis in range(2):
                    add(*((at[name] + axis, 1.0) for name in (*own, *(planet for planet, _ in carried))))
            turns = bool(toothed) or any(self._inertia_of_shaft(name) > 0 or (name, 2) in moving for name in own)
            if turns and self._torsion(body) is not None:
                rows = [(at[name] + 2, 1.0) for name in own]
                for planet, (x, y) in carried:
                    rows += [(at[planet], -y), (at[planet] + 1, x)]
                add(*rows)
        for planet in self.planets:
            for axis in (2,) if self._pin(planet) is None else (0, 1, 2):
                add((at[planet] + axis, 1.0))
        return np.array(columns).T if columns else np.zeros((3 * len(self.parts), 0))

    def _carried(self, member: str) -> Iterator[tuple[str, Vector]]:
        """Yield the planets that sit on rigid pins of a carrier, and their places (m)."""
        name, _, part = member.rpartition(".")
        assembly = self.gearbox.assemblies.get(name)
        if assembly is not None and part == assembly.subject.carrier:
            for planet in self.planets:
                if planet.startswith(f"{name}.") and self._pin(planet) is None:
                    yield planet, self._place(planet)

    def _torsion(self, body: str) -> float | None:
        """Return the stiffness (N·m/rad) of what holds the turn of a body: None holds it, 0 leaves it free."""
        own = [name for name in self.members if self.bodies[name] == body]
        given = [torsion for name in own if (torsion := self._holds(name)[1]) is not None]
        held = any(name in self.state.state.held for name in own)
        return None if held and not given else float(sum(given))

    def _assembly(self, planet: str) -> tuple[SetAssembly, str, int]:
        """Return the set of a planet, the name of its body, and its number from 0."""
        name, _, rest = planet.partition(".")
        body, _, number = rest.rpartition(" ")
        return self.gearbox.assemblies[name], body, int(number) - 1

    def _rims(self, planet: str) -> list[SetGear]:
        assembly, body, _ = self._assembly(planet)
        return [
            assembly.gearing.gears[each.name]
            for each in assembly.subject.planets
            if assembly.subject.body_of(each.name) == body
        ]

    def _pin(self, planet: str) -> float | None:
        """Return the stiffness (N/µm) of the pin of a planet, None where it is rigid."""
        return next((rim.pin_stiffness for rim in self._rims(planet) if rim.pin_stiffness is not None), None)

    def _place(self, part: str) -> Vector:
        """Return where the axis of a part stands (m)."""
        if part not in self.planets:
            return 0.0, 0.0
        assembly, body, number = self._assembly(part)
        place = assembly.place_of(body, number)
        return place.real / 1000, place.imag / 1000

    # ------------------------------------------------------------------ springs

    @cached_property
    def springs(self) -> tuple[GearboxSpring, ...]:
        """All springs: meshes, pins, supports of bodies, torsion against the frame, shafts."""
        return tuple(self._springs())

    def _springs(self) -> Iterator[GearboxSpring]:
        for name, assembly in self.gearbox.assemblies.items():
            for mesh in assembly.meshes:
                for number in range(assembly.gearing.planets):
                    yield self._mesh_spring(name, assembly, mesh, number)
        for planet in self.planets:
            if (pin := self._pin(planet)) is not None:
                assembly, _, number = self._assembly(planet)
                carrier, (x, y) = f"{assembly.subject.name}.{assembly.subject.carrier}", self._place(planet)
                for own, on_carrier in (((1.0, 0.0), -y), ((0.0, 1.0), x)):
                    terms = ((carrier, *own, on_carrier), (planet, -own[0], -own[1], 0.0))
                    yield GearboxSpring("pin", planet, number + 1, _MICRO * pin, terms)
        for body in dict.fromkeys(self.bodies.values()):
            supports = [self._holds(name)[0] for name in self.members if self.bodies[name] == body and "." in name]
            total = sum(each for each in supports if each is not None)
            if total and None not in supports:
                for own in ((1.0, 0.0), (0.0, 1.0)):
                    yield GearboxSpring("support", body, 0, _MICRO * total, ((body, *own, 0.0),))
            if torsion := self._torsion(body):
                yield GearboxSpring("torsion", body, 0, torsion, ((body, 0.0, 0.0, 1.0),))
        for shaft in self.gearbox.shafts:
            terms = ((shaft.start, 0.0, 0.0, 1.0), (shaft.end, 0.0, 0.0, -1.0))
            yield GearboxSpring("shaft", shaft.name, 0, shaft.torsional_stiffness, terms)

    def _mesh_spring(self, name: str, assembly: SetAssembly, mesh: PartMesh, number: int) -> GearboxSpring:
        """Return the spring of a mesh: along its line of action, on the flanks that carry in the state."""
        pair = assembly.pairs[mesh.name]
        first = f"{name}.{mesh.first}"
        parts = (
            first if first in self.members else self._body_part(assembly, mesh.first, number),
            self._body_part(assembly, mesh.second, number),
        )
        one, other = (np.array(self._place(part)) for part in parts)
        towards = (other - one) / np.hypot(*(other - one))
        along = np.array([-towards[1], towards[0]])
        internal = assembly.gearing.gears[mesh.first].gear.internal
        sense = (1.0 if internal else -1.0) * self.state.mesh_signs[f"{name}.{mesh.name}"]
        alpha = math.radians(pair.working_transverse_pressure_angle)
        normal = sense * math.cos(alpha) * along + (-1.0 if internal else 1.0) * math.sin(alpha) * towards
        first_gear = assembly.gearing.gears[mesh.first].gear
        role = pair.working_pitch_diameters.pinion if pair.pinion is first_gear else pair.working_pitch_diameters.wheel
        pitch_point = one + towards * abs(role) / 2000
        terms = [
            (part, *(sign * normal), sign * float(_cross(pitch_point - place, normal)))
            for part, place, sign in zip(parts, (one, other), (1.0, -1.0), strict=True)
        ]
        return GearboxSpring(
            "mesh", f"{name}.{mesh.name}", number + 1, _MICRO * self.mesh_stiffness[f"{name}.{mesh.name}"][0], tuple(terms)
        )

    @staticmethod
    def _body_part(assembly: SetAssembly, planet: str, number: int) -> str:
        return f"{assembly.subject.name}.{assembly.subject.body_of(planet)} {number + 1}"

    @cached_property
    def mesh_stiffness(self) -> dict[str, tuple[float, str]]:
        """Mean stiffness of each mesh with one planet (N/µm) and its origin: given, or c_gamma_alpha b of ISO 6336-1."""
        from gearcad.core.records import PerGear
        from gearcad.rating.tooth_stiffness import mesh_stiffness

        found = {}
        materials = PerGear(self.material, self.material)
        for name, assembly in self.gearbox.assemblies.items():
            for mesh in assembly.meshes:
                given = assembly.gearing.gears[mesh.first].mesh_stiffness
                if given is not None:
                    found[f"{name}.{mesh.name}"] = given, GIVEN
                    continue
                pair = assembly.pairs[mesh.name]
                per_width = float(mesh_stiffness(pair, materials, _SPECIFIC_LOAD).mesh_alpha)
                found[f"{name}.{mesh.name}"] = per_width * pair.common_width.width, ISO
        return found

    @cached_property
    def mesh_errors(self) -> dict[str, float]:
        """Amplitude of the transmission error of each mesh at its tooth frequency (µm)."""
        assemblies = self.gearbox.assemblies.items()
        return {
            f"{name}.{mesh.name}": each.gearing.gears[mesh.first].mesh_error
            for name, each in assemblies
            for mesh in each.meshes
        }

    def tooth_order(self, mesh: str) -> float:
        """Return the tooth frequency of a mesh over the speed of the input: z |w - w_carrier| of its second gear."""
        name, _, own = mesh.partition(".")
        assembly = self.gearbox.assemblies[name]
        second = next(each.second for each in assembly.meshes if each.name == own)
        speed = self.state.planet_speeds[f"{name}.{assembly.subject.body_of(second)}"]
        carrier = self.state.speeds[f"{name}.{assembly.subject.carrier}"]
        return assembly.gearing.gears[second].gear.teeth * abs(speed - carrier)

    @cached_property
    def vectors(self) -> Floats:
        """Elongations (m, 3 P) of the springs for all coordinates."""
        at = {name: 3 * place for place, name in enumerate(self.parts)}
        found = np.zeros((len(self.springs), 3 * len(self.parts)))
        for row, spring in enumerate(self.springs):
            for part, *terms in spring.terms:
                found[row, at[part] : at[part] + 3] += terms
        return found

    @cached_property
    def stiffness(self) -> Floats:
        """Stiffness (m,) of the springs in N/m, of those that turn in N·m/rad."""
        return np.array([each.stiffness for each in self.springs])

    # ------------------------------------------------------------------ masses

    @cached_property
    def mass(self) -> Floats:
        """Mass, mass and inertia (3 P,) of the parts in kg and kg·m²; 0 of what cannot move. Raises ParameterError."""
        moving = np.abs(self.basis).max(axis=1, initial=0.0) > 0
        found = np.zeros(3 * len(self.parts))
        for place, part in enumerate(self.parts):
            rows = slice(3 * place, 3 * place + 3)
            if moving[rows].any():
                mass, inertia = self._mass_of(part, travels=bool(moving[3 * place]), turns=bool(moving[3 * place + 2]))
                found[rows] = np.where(moving[rows], (mass, mass, inertia), 0.0)
        return found

    def _mass_of(self, part: str, *, travels: bool, turns: bool) -> Vector:
        """Return mass (kg) and inertia (kg·m²) of a part. Raises ParameterError where they are needed and not known."""
        more = self.gearbox.inertias.get(part, 0.0)
        if part in self.planets:
            own = [_weighed(rim, self.material.density, part, travels=travels, turns=turns) for rim in self._rims(part)]
            return sum(mass for mass, _ in own), sum(inertia for _, inertia in own)
        if "." not in part:
            return 0.0, more
        if (gear := self._gear(part)) is not None:
            mass, inertia = _weighed(gear, self.material.density, part, travels=travels, turns=turns)
            return mass, inertia + more
        carrier = self.gearbox.assemblies[part.rpartition(".")[0]].gearing.carrier
        for key, value, needed in (("mass", carrier.mass, travels), ("inertia", carrier.inertia, turns)):
            if value is None and needed:
                raise ParameterError(f"{part}.{key}", None, "must be given: a carrier has no solid here")
        return carrier.mass or 0.0, (carrier.inertia or 0.0) + more

    def _inertia_of_shaft(self, name: str) -> float:
        return self.gearbox.inertias.get(name, 0.0)


def _cross(one: Floats, other: Floats) -> float:
    return float(one[0] * other[1] - one[1] * other[0])


def _weighed(own: SetGear, density: float, part: str, *, travels: bool, turns: bool) -> Vector:
    """Return mass (kg) and inertia (kg·m²) of a gear: those that are given, else those of its solid. Raises ParameterError."""
    needed = (travels and own.mass is None) or (turns and own.inertia is None)
    mass, inertia = _solid_mass(own.gear, density, part) if needed else (0.0, 0.0)
    return mass if own.mass is None else own.mass, inertia if own.inertia is None else own.inertia


def _solid_mass(gear: Gear, density: float, part: str) -> Vector:
    try:
        return _mass_of_gear(gear, density)
    except GearcadError as error:
        raise ParameterError(f"{part}.mass", None, f"must be given with inertia: the gear has no solid ({error})") from error


@lru_cache(maxsize=64)
def _mass_of_gear(gear: Gear, density: float) -> Vector:
    """Return mass (kg) and inertia (kg·m²) of the solid of a gear: the planets of a name and all states share them."""
    from gearcad.solids.exact.inertia import mass_properties

    found = mass_properties(gear, density)
    return found.mass, found.inertia
