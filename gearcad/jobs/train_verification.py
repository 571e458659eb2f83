"""Verification of a train of pairs: the claims of each pair, and those of the files in which all gears and shafts are posed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from gearcad.core.records import Notice, Role
from gearcad.core.runtime import Progress, one_thread
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.train_designs import TrainDesign
from gearcad.jobs.job import Data, Job, Writer
from gearcad.jobs.train import MeshResults, OverMeshes
from gearcad.jobs.train_bodies import gear_train_plan
from gearcad.jobs.verification import Verify, strength_of, versions_of
from gearcad.solids import FileOptions, Format
from gearcad.solids.files.gear_train_products import GearTrainProduct
from gearcad.solids.gear_train_plan import GearKey
from gearcad.verification.assemblies import PlacedMesh
from gearcad.verification.claims import Claim
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.facets import judge_facets
from gearcad.verification.result import Verification
from gearcad.verification.step import judge_step
from gearcad.verification.turned_parts import ExactShaft

_FORMATS = (Format.STEP, Format.THREE_MF, Format.GLB)
"""Formats in which the train is made and judged as a whole."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainVerification(Verification):
    """Verification of a train: all claims, those of a pair led by the name of its mesh, and the results of the `meshes`."""

    meshes: MeshResults


@dataclass(frozen=True, kw_only=True)
class VerifyTrain(Job[TrainDesign, TrainVerification]):
    """Verification of a train of pairs: each pair with its evidence in a folder of its mesh, and the assembly of all."""

    verb = "verify"
    accepts = (DesignKind.TRAIN,)
    why = "other designs have no meshes of a train"

    job: Verify

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> TrainVerification:
        """Return the verification of a train, whose files are made now."""
        design = self.accepted(design, progress)
        product = GearTrainProduct(gear_train_plan(design), FileOptions())
        with TemporaryDirectory(prefix="gearcad-verify-") as folder:
            for kind in _FORMATS:
                assert kind.entry.write_pair is not None  # these have assemblies
                kind.entry.write_pair(product, Path(folder, f"assembly.{kind.value}"))
            claims = list(_of_assembly(product, Path(folder)))
            contents = {path.name: path.read_bytes() for path in sorted(Path(folder).iterdir())}
        meshes = OverMeshes(job=replace(self.job, folder="")).run(design, progress)
        for each in meshes.meshes:
            claims += [replace(claim, where=f"{each.mesh.name}: {claim.where}") for claim in each.result.claims]
        return TrainVerification(
            name=design.name,
            level=meshes.meshes[0].result.level,
            claims=tuple(claims),
            contents=contents,
            spec=Data().document(design),
            judges=versions_of(claims),
            strength=strength_of(claims),
            notices=(*design.notices, *product.plan.notices),
            meshes=meshes,
        )

    def document(self, result: TrainVerification) -> dict[str, Any]:
        """Return the content of verify.json."""
        return self.job.document(result)

    def notices(self, result: TrainVerification) -> Sequence[Notice]:
        return result.notices

    def conclusion(self, name: str, result: TrainVerification) -> str:
        return self.job.conclusion(name, result)

    def files(self, result: TrainVerification) -> dict[str, Writer]:
        """Return the files of the train with its evidence, and those of each pair in the folder of its mesh."""
        found = self.job.files(result)
        for each in result.meshes.meshes:
            found |= {f"{each.mesh.folder}/{name}": write for name, write in self.job.files(each.result).items()}
        return found

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        return self.job.parts

    def part_of(self, file: str) -> str:
        return self.job.part_of(file)


def _of_assembly(product: GearTrainProduct, folder: Path) -> Iterator[Claim]:
    """Yield the claims of the files of the assembly: parts by other programs, places of teeth by exact outlines."""
    plan = product.plan
    exact: dict[str, ExactPart] = {each.name: ExactPart(each.gear) for each in plan.gears}
    exact |= {each.name: ExactShaft(each.plan.shaft) for each in plan.standing_shafts}
    named = {product.product_name(name): part for name, part in exact.items()}
    for kind in _FORMATS:
        path = folder / f"assembly.{kind.value}"
        if kind is Format.STEP:
            yield from judge_step(path, product.solid(), named, _meshes(product, as_products=True))
        else:
            yield from judge_facets(path, exact, product.options.chord_error, _meshes(product, as_products=False))


def _meshes(product: GearTrainProduct, *, as_products: bool) -> list[PlacedMesh]:
    """Return the meshes with the names of their gears, as products (STEP) or as parts of a scene."""
    plan = product.plan

    def name(mesh: str, role: Role) -> str:
        own = plan.standing[GearKey(mesh, role)].name
        return product.product_name(own) if as_products else own

    return [PlacedMesh(mesh.pair, name(mesh.name, Role.PINION), name(mesh.name, Role.WHEEL)) for mesh in plan.meshes]
