"""Pairs of a train's meshes as designs of their own, each under the load that the train gives it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from gearcad.core.errors import GeometryError, InputError, ParameterError, SolverError
from gearcad.core.records import JsonObject, Role
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.shaft_spec import ShaftArrangement
from gearcad.designs.train_designs import DesignedPair, TrainDesign, plain_name
from gearcad.designs.train_shafts import gears_of, mesh_shafts, train_arrangement
from gearcad.dynamics.engagement import PinionLoad, pinion_loads
from gearcad.dynamics.trains.members import MeshPair, ToothMesh
from gearcad.load import Load

NO_PAIR = "the mesh has no pair: give pair = FILE or [train.mesh.pair]"
"""Reason why nothing of a mesh is judged that is given by its base radii alone."""


@dataclass(frozen=True, kw_only=True)
class TrainMesh:
    """A mesh of a train: its name, the folder of its files, its pair under the train's load, and the gear that drives."""

    name: str
    folder: str
    design: PairDesign
    driver: Role

    @property
    def load(self) -> JsonObject:
        """Load of the pinion (N·m, rpm), and the gear that drives."""
        load = self.design.loaded("a mesh of a train has one")
        return {"torque": load.torque, "speed": load.speed, "driver": self.driver.value}


@dataclass(frozen=True, kw_only=True)
class TrainMeshes:
    """The meshes of a train that are pairs, in their order, and the names of those that have none."""

    meshes: tuple[TrainMesh, ...]
    without: tuple[str, ...] = ()


def _on_shafts(design: TrainDesign, mesh: TrainMesh, every: Sequence[TrainMesh]) -> PairDesign:
    """Return the design of a mesh with the train's shafts under its gears, loaded by their other gears.

    Raises GeometryError for a pair that has shafts of its own beside those of the train.
    """
    shafts = mesh_shafts(design.train, mesh.name, loads_of(every), design.shafts)
    if shafts is not None and mesh.design.shafts is not None:
        permitted = "must be left out where a shaft of the train has segments and the gear on it"
        raise GeometryError(f"{mesh.name}.pair.pinion.shaft", mesh.design.name, permitted)
    return mesh.design if shafts is None else replace(mesh.design, shafts=shafts)


def loads_of(meshes: Iterable[TrainMesh]) -> dict[str, Load]:
    """Return the loads of pairs by the names of meshes."""
    return {each.name: each.design.loaded("a mesh of a train has one") for each in meshes}


def shafts_of_train(design: TrainDesign) -> ShaftArrangement | None:
    """Return the shafts of a train with segments and bearings under the forces of their gears; None without any."""
    if not has_shafts(design):
        return None
    loads = loads_of(train_meshes(design).meshes) if has_pairs(design) else {}
    return train_arrangement(design.name, design.train, loads, design.shafts)


def has_shafts(design: TrainDesign) -> bool:
    """Return whether a shaft of a train has segments or gears at places."""
    return any(gears_of(shaft) or shaft.layout for shaft in design.train.shafts)


def has_pairs(design: TrainDesign) -> bool:
    """Return whether a mesh of a train at least is a pair of gears."""
    return any(mesh.pair is not None for mesh in design.train.meshes)


def train_meshes(design: TrainDesign) -> TrainMeshes:
    """Return the pairs of a train's meshes under the loads that `pinion_loads` finds.

    Materials, rating and all else are those of the pair; so is the application factor of its own load. Raises ParameterError
    for a pair that carries nothing, and the errors of `pinion_loads`.
    """
    train = design.train
    loads = pinion_loads(train, design.dynamics)
    taken: set[str] = set()
    found = []
    for mesh in train.meshes:
        if mesh.pair is not None:
            folder = free_name(folder_name(mesh.name), taken)
            taken.add(folder.casefold())
            loaded = under_load(mesh_design(mesh), loads[mesh.name])
            found.append(TrainMesh(name=mesh.name, folder=folder, design=loaded, driver=loads[mesh.name].driver))
    found = [replace(each, design=_on_shafts(design, each, found)) for each in found]
    return TrainMeshes(meshes=tuple(found), without=tuple(mesh.name for mesh in train.meshes if mesh.pair is None))


def require_pairs(design: TrainDesign, why: str) -> None:
    """Raise ParameterError for a mesh without a pair; the message ends with `why` all need one."""
    without = next((mesh.name for mesh in design.train.meshes if mesh.pair is None), None)
    if without is not None:
        raise ParameterError(f"{without}.pair", None, f"must be given, the spec of a pair: {why}")


def folder_name(mesh: str) -> str:
    """Return the name of the folder of a mesh, which is no name of a file."""
    name = plain_name(mesh)
    return name.replace(".", "-") if any(each.isalpha() for each in name.rpartition(".")[2]) and "." in name else name


def free_name(name: str, taken: set[str]) -> str:
    """Return the name, with a number where it is taken, also where large and small letters are the same."""
    tried = (name if number == 1 else f"{name}-{number}" for number in range(1, len(taken) + 2))
    return next(each for each in tried if each.casefold() not in taken)


def mesh_design(mesh: ToothMesh) -> PairDesign:
    """Return the design of the pair of a mesh with its own load, if it has one."""
    of = mesh.pair
    assert isinstance(of, MeshPair)  # it became one when the mesh was made
    if isinstance(of, DesignedPair):
        return of.design
    return PairDesign(name=plain_name(mesh.name), pair=of.pair, material=of.material, mounting=of.mounting, rating=of.rating)


def under_load(design: PairDesign, load: PinionLoad) -> PairDesign:
    """Return the design of a pair under the load of its pinion, with the application factor of its own load."""
    factor = design.load.application_factor if design.load is not None else 1.0
    torque, speed = without_rounding(load.torque), without_rounding(load.speed)
    return replace(design, load=Load(torque=torque, speed=speed, application_factor=factor))


def without_rounding(value: float) -> float:
    """Return the value rounded to 12 digits, without the rounding errors of a train's equations."""
    return float(f"{value:.12g}")


def mesh_documents(design: TrainDesign) -> dict[str, JsonObject]:
    """Return the documents of `data.json` of the pairs of a train's meshes by the names of meshes.

    Their loads are those of the train; where these are not known, the pairs' own.
    """
    try:
        return {mesh.name: mesh.design.to_dict() for mesh in train_meshes(design).meshes}
    except (InputError, SolverError):
        return {mesh.name: mesh_design(mesh).to_dict() for mesh in design.train.meshes if mesh.pair is not None}
