"""What the gears of a train are made of: one material, or one each."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad.material import Material, Materials
from gearcad.per_gear import PerGear
from gearcad.planetary.members import PairStage
from gearcad.planetary.mesh import SetMesh

__all__ = ["TrainMaterial", "material_of", "mesh_material", "stage_material"]

TrainMaterial = Material | Mapping[str, Material]
"""That of all gears of a train, or of each by its name; steel where that is not there."""


def material_of(material: TrainMaterial | None, gear: str) -> Material:
    """That of a gear, by the name of the central or rim, or of the gear of a stage."""
    if isinstance(material, Mapping):
        return material.get(gear, Material())
    return material or Material()


def mesh_material(material: TrainMaterial | None, mesh: SetMesh) -> Materials:
    """That of the pair of a mesh."""
    names = {mesh.central_role: mesh.central.name, mesh.rim_role: mesh.rim.name}
    return _of_pair(material, PerGear.each(lambda role: names[role]))


def stage_material(material: TrainMaterial | None, stage: PairStage) -> Materials:
    """That of the pair of a stage."""
    return _of_pair(material, stage.pair.gears.map(lambda gear: gear.name))


def _of_pair(material: TrainMaterial | None, names: PerGear[str]) -> Materials:
    pinion, wheel = (material_of(material, name) for name in names)
    return pinion if pinion == wheel else PerGear(pinion, wheel)
