"""Level full of a verification: meshes made for other readers, and the deck of a pair run by CalculiX."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, cast

from gearcad.check.options import CheckOptions, Model
from gearcad.core.errors import GearcadError
from gearcad.core.records import JsonObject
from gearcad.decks.pair import PairDecks
from gearcad.decks.plane import PlaneDecks
from gearcad.decks.rack import plane_decks
from gearcad.decks.solid import SolidDecks, solid_task
from gearcad.designs import DesignKind, GearDesign, ToothedDesign
from gearcad.geometry import Gear, RackPair
from gearcad.jobs.mesh import Mesh
from gearcad.meshing import MeshSizes
from gearcad.meshing.bodies.quality import LEAST_SCALED_JACOBIAN
from gearcad.meshing.options import Extent, MeshOptions, What
from gearcad.meshing.result import MeshResult
from gearcad.verification.calculix import PLANE_PERMITTED, SOLID_PERMITTED, judge_calculix, missing
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.mesh_files import StatedMesh, judge_mesh

if TYPE_CHECKING:
    from gearcad.designs import PairDesign, RackPairDesign

MESH_FORMATS = ("vtu", "inp", "msh")
"""Formats of the meshes that are made and judged."""

_MOST = 60_000
"""Tetrahedra of a double helical gear, which is meshed as a whole; one that needs more of them is not judged."""

_WHAT = "elements, sides, volume, nodes on the surface"


def judge_meshes(design: ToothedDesign, folder: Path, exact: Mapping[str, ExactPart], *, made: bool) -> Iterator[Claim]:
    """Make the mesh of each gear in a folder, by the design's own options as far as they are of one gear, and judge it.

    Unless they are to be `made`, nothing is judged: of other meshes nobody says what they have.
    """
    for name, part in exact.items():
        judge = Judge(ClaimSubject.MESH, VerificationLevel.FULL, name, "meshio")
        if part.gear is None:
            yield judge.not_judged(_WHAT, "racks are not meshed")
            continue
        if not made:
            yield judge.not_judged(_WHAT, "meshes are judged where they are made: leave out the folder")
            continue
        try:
            result, solid = _meshed(design, name, part.gear)
        except GearcadError as error:
            yield judge.not_judged(_WHAT, f"no mesh is made: {error}")
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
        return replace(plain, what=What.PART.value, element="tet10", model="3d", elements=_MOST)
    solid = plain.model == "3d" or (plain.model == "auto" and bool(gear.helix_angle))
    if solid:
        return replace(plain, what="teeth:3", element="hex20" if plain.element == "auto" else plain.element)
    return replace(plain, what=What.RING.value, element="tri6" if plain.element == "auto" else plain.element)


_REFINEMENT = 2.0
"""Refinement of our own check of sections. With the usual mesh root stress of a ring's tight fillets is 0.7 % off, with this
0.3 %; where the edge of a tip touches, the load share is up to 0.25 % of the load off, with this 0.11 % (measured)."""

_COARSE = MeshSizes(flank=0.8, corner=0.6, fillet=0.2, outline=1.0, cut=1.0, rim=4.0, growth=1.0)
_LAYERS = 2
"""Edges of bodies, and their fewest layers over the face width: with finer ones CalculiX takes hours."""


def judge_by_calculix(design: ToothedDesign) -> Iterator[Claim]:
    """Let CalculiX run the deck of a pair under its load, and judge our figures by its own."""
    judge = Judge(ClaimSubject.CALCULIX, VerificationLevel.FULL, design.name, "CalculiX")
    what = "transmission error, load share, root stress, pressure"
    reason = (
        f"decks are of pairs, this is a {design.kind.words}"
        if design.kind not in (DesignKind.PAIR, DesignKind.RACK_PAIR)
        else "the design has no load"
        if getattr(design, "load", None) is None
        else missing()
    )
    if reason:
        yield judge.not_judged(what, reason)
        return
    try:
        decks = _decks(cast("PairDesign | RackPairDesign", design))
    except GearcadError as error:
        yield judge.not_judged(what, f"no deck can be made: {error}")
        return
    permitted = SOLID_PERMITTED if decks.solid else PLANE_PERMITTED
    try:
        positions = _positions(decks)
    except GearcadError as error:
        yield judge.not_judged(what, f"our own check has no result: {error}")
        return
    for roll_angle in positions:
        yield from judge_calculix(decks, roll_angle, judge, permitted)


_STEPS, _STEPS_OF_BODIES = 48, 16
"""Steps over one base pitch in which the greatest change of load share is looked for."""

_APART = 1 / 8
"""Least distance of two positions of great change, in base pitches."""


def _positions(decks: PairDecks) -> list[float]:
    """Return the roll angles (deg) at which CalculiX is asked, in their order: five or more over the mesh cycle.

    They are the middles of the stretches where more and where fewer pairs of teeth are in contact, the places where load passes
    most quickly from tooth to tooth, by our own check, and the middles of the longest stretches between these. At the quick
    places a loaded tip touches before it should, which a check may have in a simpler way: there a difference shows first.
    """
    pitch = 360.0 / decks.pair.pinion.tooth_count
    angles = [*_middles(decks), *_quickest(decks, pitch)]
    places = sorted(angle % pitch for angle in angles)
    while len(places) < _ASKED:
        ends = [*places[1:], places[0] + pitch]
        low, high = max(zip(places, ends, strict=True), key=lambda stretch: stretch[1] - stretch[0])
        places = sorted([*places, ((low + high) / 2) % pitch])
    return sorted((place + pitch / 2) % pitch - pitch / 2 for place in places)


_ASKED = 5


def _quickest(decks: PairDecks, pitch: float) -> list[float]:
    """Return the two roll angles (deg), apart from each other, at which the load share of a pair of teeth changes most."""
    count = _STEPS_OF_BODIES if decks.solid else _STEPS
    step = pitch / count
    shares = [
        {contact.tooth: float(contact.share) for contact in decks.cycle.solve(-pitch / 2 + step * number).contacts}
        for number in range(count + 1)
    ]
    changes = sorted(
        (
            (max(abs(after.get(tooth, 0.0) - before.get(tooth, 0.0)) for tooth in before | after), -pitch / 2 + step * number)
            for number, (before, after) in enumerate(pairwise(shares))
        ),
        reverse=True,
    )
    found = list[float]()
    for _, angle in changes:
        middle = angle + step / 2
        if all(min((middle - each) % pitch, (each - middle) % pitch) >= _APART * pitch for each in found):
            found.append(middle)
    return found[:2]


def _middles(decks: PairDecks) -> tuple[float, float]:
    """Roll angles (deg) in the middle of the stretches where more and where fewer pairs of teeth are in contact."""
    pair, path = decks.pair, decks.pair.path_of_contact
    pitch = pair.pinion.transverse_base_pitch
    more = (path.E - path.A) % pitch
    places = (path.A + more / 2, path.A + (more + pitch) / 2)
    first, second = (math.degrees(2 * (place - path.C) / pair.pinion.base_diameter) for place in places)
    return (first, second) if decks.left else (-first, -second)


def _decks(design: PairDesign | RackPairDesign) -> PairDecks:
    """The decks of a pair: of sections, or of bodies where its teeth are helical. Raises GearcadError."""
    if isinstance(design.pair, RackPair):
        return plane_decks(design.check_task("a deck is of pressed flanks"))
    solid = bool(design.pair.pinion.helix_angle)
    model = Model.SOLID if solid else Model.PLANE
    own = design.check or CheckOptions()
    options = replace(own, model=model.value, refinement=own.refinement if solid else max(own.refinement, _REFINEMENT))
    task = design.check_task("a deck is of pressed flanks", options)
    if solid:
        return SolidDecks(solid_task(task), sizes=_COARSE, layers=_LAYERS)
    return PlaneDecks(task)
