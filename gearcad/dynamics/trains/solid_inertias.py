"""Inertias of a train that are not given: those of the solids of the gears of its pairs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import Derived, is_given
from gearcad.core.records import Notice, Role
from gearcad.dynamics.trains.members import Inertia, MeshPair, ToothMesh
from gearcad.geometry.gear import Gear
from gearcad.material import of_both


def with_solids(inertias: Sequence[Inertia], meshes: Sequence[ToothMesh]) -> tuple[Inertia, ...]:
    """Return the inertias, those that are not given as the sum of the solids of their gears, as Derived numbers.

    Once found they stay where the meshes have no pairs any more. Raises ParameterError for one that is no gear of a pair.
    """
    return tuple(each if is_given(each.inertia) else _from_solids(each, meshes) for each in inertias)


def _from_solids(inertia: Inertia, meshes: Sequence[ToothMesh]) -> Inertia:
    gears = _gears_of(inertia.name, meshes)
    if gears:
        return replace(inertia, inertia=Derived(sum(_solid(gear, density) for gear, density, _ in gears)))
    if inertia.inertia != inertia.inertia:  # nan: never found
        permitted = "must be given in kg·m²: it is no gear of a pair, whose solid has one"
        raise ParameterError(f"{inertia.name}.inertia", None, permitted)
    return inertia


def _gears_of(name: str, meshes: Sequence[ToothMesh]) -> list[tuple[Gear, float, str]]:
    """Return the gears on an inertia, each with its density (kg/m³) and in words; equal ones, as an idler's two, once."""
    found: list[tuple[Gear, float, str]] = []
    for mesh in meshes:
        for role in Role:
            if mesh.gears.pick(role) == name and isinstance(mesh.pair, MeshPair):
                gear, density = mesh.pair.pair.gears.pick(role), of_both(mesh.pair.material).pick(role).density
                if not any(replace(gear, name=other.name) == other for other, _, _ in found):
                    found.append((gear, density, f"{role.value} of {mesh.name}"))
    return found


@lru_cache(256)
def _solid(gear: Gear, density: float) -> float:
    """Return the moment of inertia (kg·m²) of the solid of a gear by exact integrals over its boundary."""
    from gearcad.solids.exact.inertia import mass_properties

    return mass_properties(gear, density).inertia


def solid_notices(inertias: Sequence[Inertia], meshes: Sequence[ToothMesh]) -> Iterator[Notice]:
    """Yield a notice for each inertia that is that of solids of gears."""
    for each in inertias:
        if is_given(each.inertia):
            continue
        gears = " and ".join(words for _, _, words in _gears_of(each.name, meshes))
        given = "what else turns with it counts where it is given"
        text = f"its inertia of {each.inertia:.5g} kg·m² is from its solid, {gears}: {given}"
        yield Notice("inertia-from-solid", text, each.name)
