"""Level full of a verification: meshes made for other readers, and the deck of a pair run by CalculiX."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

from gearcad.check.options import CheckOptions, Model
from gearcad.core.errors import GearcadError
from gearcad.core.records import JsonObject
from gearcad.decks.pair import PairDecks
from gearcad.decks.plane import PlaneDecks
from gearcad.decks.solid import SolidDecks, solid_task
from gearcad.designs import DesignKind, GearDesign, ToothedDesign
from gearcad.geometry import Gear
from gearcad.jobs.mesh import Mesh
from gearcad.meshing.bodies.quality import LEAST_SCALED_JACOBIAN
from gearcad.meshing.options import Extent, MeshOptions, What
from gearcad.meshing.result import MeshResult
from gearcad.verification.calculix import PLANE_PERMITTED, SOLID_PERMITTED, judge_calculix, missing
from gearcad.verification.claims import Claim, Judge, Level, Subject
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.mesh_files import StatedMesh, judge_mesh

if TYPE_CHECKING:
    from gearcad.designs import PairDesign

MESH_FORMATS = ("vtu", "inp", "msh")
"""Formats of the meshes that are made and judged."""

_WHAT = "elements, sides, volume, nodes on the surface"


def judge_meshes(design: ToothedDesign, folder: Path, exact: Mapping[str, ExactPart], *, made: bool) -> Iterator[Claim]:
    """Make the mesh of each gear in a folder, by the design's own options as far as they are of one gear, and judge it.

    Unless they are to be `made`, nothing is judged: of other meshes nobody says what they have.
    """
    for name, part in exact.items():
        judge = Judge(Subject.MESH, Level.FULL, name, "meshio")
        if part.gear is None:
            yield judge.not_judged(_WHAT, "racks are not meshed")
            continue
        if not made:
            yield judge.not_judged(_WHAT, "meshes are judged where they are made: leave out the folder")
            continue
        try:
            result, solid = _meshed(design, name, part.gear)
        except GearcadError as error:
            yield judge.not_judged(_WHAT, f"no mesh can be made: {error}")
            continue
        (mesh,), (stated,) = result.meshes.values(), result.judged.values()
        for kind in result.plan.options.formats:
            kind.entry.write(mesh, folder / f"{name}.{kind.value}")
        document: JsonObject = {**stated.to_dict(), "end_radius": next(iter(result.plan.gears.values())).end_radius}
        least = LEAST_SCALED_JACOBIAN[result.plan.element]
        whole = result.plan.extent.what is What.PART
        yield from judge_mesh(folder, name, StatedMesh(part, document, solid, least, whole))


def _meshed(design: ToothedDesign, name: str, gear: Gear) -> tuple[MeshResult, bool]:
    """The mesh of one gear alone, and whether it is of a body. Raises GearcadError."""
    options = _options(getattr(design, "mesh", None), gear)
    result = Mesh().run(GearDesign(name=name, gear=gear, mesh=options))
    return result, result.plan.solid


def _options(own: MeshOptions | None, gear: Gear) -> MeshOptions:
    """The options of a design for one gear: not in mesh with another, without decks, in the formats that are judged.

    Without any a body of three teeth is meshed, or all of a section; a double helical gear as a whole, of tetrahedra.
    """
    formats = ",".join(MESH_FORMATS)
    plain = replace(own or MeshOptions(), format=formats, gear="both", deck="", positions=1, roll=0.0)
    extent: Extent | None = plain.extent
    if extent is not None and extent.what is not What.PAIR:
        return plain
    if gear.double_helix.gap_width:
        return replace(plain, what=What.PART.value, element="tet10", model="3d")
    solid = plain.model == "3d" or (plain.model == "auto" and bool(gear.helix_angle))
    if solid:
        return replace(plain, what="teeth:3", element="hex20" if plain.element == "auto" else plain.element)
    return replace(plain, what=What.RING.value, element="tri6" if plain.element == "auto" else plain.element)


_ROLL_ANGLES = (-0.225, 0.275)
"""Roll angles at which decks run, as shares of the angle between two teeth of the pinion: no teeth begin or end contact there
by a rule, and one has mostly more teeth in contact than the other."""


def judge_by_calculix(design: ToothedDesign) -> Iterator[Claim]:
    """Let CalculiX run the deck of a pair under its load, and judge our figures by its own."""
    judge = Judge(Subject.CALCULIX, Level.FULL, design.name, "CalculiX")
    what = "transmission error, load share, root stress, pressure"
    reason = (
        f"decks are of pairs, this is a {design.kind.words}"
        if design.kind is not DesignKind.PAIR
        else "the design has no load"
        if getattr(design, "load", None) is None
        else missing()
    )
    if reason:
        yield judge.not_judged(what, reason)
        return
    try:
        decks = _decks(cast("PairDesign", design))
    except GearcadError as error:
        yield judge.not_judged(what, f"no deck can be made: {error}")
        return
    permitted = SOLID_PERMITTED if decks.solid else PLANE_PERMITTED
    for share in _ROLL_ANGLES:
        yield from judge_calculix(decks, share * 360 / decks.pair.pinion.tooth_count, judge, permitted)


def _decks(design: PairDesign) -> PairDecks:
    """The decks of a pair: of sections, or of bodies where its teeth are helical. Raises GearcadError."""
    solid = bool(design.pair.pinion.helix_angle)
    model = Model.SOLID if solid else Model.PLANE
    options = replace(design.check or CheckOptions(), model=model.value)
    task = design.check_task("a deck is of pressed flanks", options)
    return SolidDecks(solid_task(task)) if solid else PlaneDecks(task)
