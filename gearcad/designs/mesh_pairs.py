"""The meshes of a planetary train, and its stages, as designs of pairs: every job of pairs takes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.planetary import PlanetaryDesign
from gearcad.designs.pair_text import pair_text
from gearcad.dynamics.planetary.mesh_rating import ALTERNATING
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.planetary.materials import mesh_material, stage_material
from gearcad.planetary.mesh_loads import FactorSource, MeshLoad, mesh_loads, stage_loads
from gearcad.planetary.power import PowerFlow, power_flow
from gearcad.schema import is_assumed

__all__ = ["MeshPairs"]

_SOURCES = {
    FactorSource.GIVEN: "as given",
    FactorSource.COMPUTED: "computed of the train's errors",
    FactorSource.EQUAL: "equal shares",
}


@dataclass(frozen=True, kw_only=True)
class MeshPairs:
    """The pairs of a planetary train by the names of its meshes and stages, under what one planet carries.

    `computed_factor` is the K_gamma that is taken if the load gives none. Without a load the pairs have none. What asks for
    loads raises what `power_flow` and `mesh_loads` raise.
    """

    design: PlanetaryDesign
    computed_factor: float | None = None

    @cached_property
    def flow(self) -> PowerFlow | None:
        """The flow of power; None without a load."""
        design = self.design
        return None if design.load is None else power_flow(design.train, design.load, design.speeds)

    @cached_property
    def loads(self) -> dict[str, MeshLoad]:
        """Those of the set's meshes; none without a load."""
        return {} if self.flow is None else mesh_loads(self.design.train, self.flow, self.computed_factor)

    @cached_property
    def stage_loads(self) -> dict[str, Load]:
        """Those of the stages; none without a load."""
        return {} if self.flow is None else stage_loads(self.design.train, self.flow)

    @cached_property
    def designs(self) -> dict[str, PairDesign]:
        """A design for each mesh, and for each stage, with the train's material and options of [rating], [check] and [mesh]."""
        found, material = dict[str, PairDesign](), self.design.material
        for mesh in self.design.train.meshes:
            load = self.loads.get(mesh.name)
            found[mesh.name] = self._design(
                mesh.name, mesh.pair, load.load if load else None, mesh_material(material, mesh) if material else None
            )
        for stage in self.design.train.stages:
            made_of = stage_material(material, stage) if material else None
            found[stage.name] = self._design(stage.name, stage.pair, self.stage_loads.get(stage.name), made_of)
        return found

    @property
    def texts(self) -> dict[str, str]:
        """The spec of each pair under the name of its file."""
        return {f"{name}.toml": pair_text(design, list(self._comments(name))) for name, design in self.designs.items()}

    def _design(self, name: str, pair: GearPair, load: Load | None, material: Materials | None) -> PairDesign:
        own = self.design
        # By the train's name, too: results of the suns of two trains have folders of their own.
        full = own.pair_name(name)
        return PairDesign(
            name=full,
            pair=replace(pair, name=full),
            load=load,
            material=material,
            rating=own.rating,
            check=own.check,
            mesh=own.mesh,
        )

    def _comments(self, name: str) -> Iterator[str]:
        """What a spec of a pair says of where it comes from, line by line."""
        train = self.design.train
        mesh = next((mesh for mesh in train.meshes if mesh.name == name), None)
        yield f"{'Mesh' if mesh else 'Stage'} {name} of the planetary train {self.design.name}, written by `gearcad planetary`:"
        yield "a pair for `gearcad check`, `gearcad stiffness` and every other command of pairs; other meshes are left out."
        if mesh is None:
            return
        if (load := self.loads.get(name)) is None:
            yield "The train has no load."
            return
        factor = load.mesh_load_factor
        yield f"The load is that of one of {train.planets} planets, on the pinion; its speed is that against the carrier."
        assumed = " (assumed)" if is_assumed(load.application_factor) else ""
        product = f"K_A {load.application_factor:g}{assumed} times K_gamma {factor.value:g} ({_SOURCES[factor.source]})"
        yield f"application_factor is {product}."
        if not train.stepped:
            yield f"Teeth of {mesh.rim.name} bend both ways in every turn: of a root limit for teeth that bend one way"
            yield f"they have {ALTERNATING:g} (Y_M of ISO 6336-3, recalled)."
