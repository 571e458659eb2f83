"""Job `mesh`: finite elements of a design's gears with named sides, and decks that run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Unpack

from gearcad.check.options import CheckOptions, Model
from gearcad.check.task import CheckTask
from gearcad.core.errors import ParameterError
from gearcad.core.records import JsonObject, Notice, PerGear, Role
from gearcad.core.runtime import Agenda, Expected, Progress
from gearcad.decks.pair import PairDecks
from gearcad.decks.plane import PlaneDecks, plane_tooth_deck
from gearcad.decks.rack import plane_decks
from gearcad.decks.solid import SolidDecks, shaft_task, solid_task, solid_tooth_deck
from gearcad.designs import Design, DesignKind, GearedDesign, Inputs, PairDesign, RackPairDesign, SplineDesign
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.jobs.job import Job, Writer, as_design
from gearcad.jobs.train import suited
from gearcad.load import Load
from gearcad.material import Material, Materials
from gearcad.meshing.bodies.body_mesh import contacts
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import Element
from gearcad.meshing.options import SUFFIXES, DeckKind, MeshOptions
from gearcad.meshing.plan import MeshPlan, expected_mesh, plan_mesh, plan_rack_mesh, replace_zones, require_room
from gearcad.meshing.result import Deck, MeshResult, mesh_document, run_mesh
from gearcad.rating.contact_stress import base_normal_force, contact_at

_EDGES = 4
"""Edges over the half width of a contact: with one of them the pressure is 2 % low (measured)."""

_REACH = 1.6
"""Half widths on each side of a contact over which edges stay short."""

_SHORTEST = 0.002
"""Shortest edge in normal modules: near the base circle flanks are curved most, and contacts narrower than is of any use."""


def contact_zones(
    pair: GearPair, material: Materials, load: Load, roll_angle: float
) -> PerGear[Mapping[int, ContactRefinement]]:
    """Zones of the teeth of pinion and wheel that touch at a roll angle (deg), which share the load evenly.

    A negative torque presses right flanks. No torque makes no zones.
    """
    torque = load.torque * load.application_factor
    if not torque:
        return PerGear({}, {})
    left = torque > 0
    touching = contacts(pair, roll_angle, left=left)
    force = base_normal_force(pair, torque) / max(len(touching.pinion), 1)

    def zone(place: float, own: float) -> ContactRefinement:
        half = contact_at(pair, material, distance=place, force=force).half_width
        edge = max(half / _EDGES, _SHORTEST * pair.pinion.normal_module)
        return ContactRefinement(length=own, half_width=_REACH * half, edge=edge, left=left)

    whole = pair.base_tangent.length
    return PerGear(
        {tooth: zone(place, place) for tooth, place in touching.pinion.items()},
        {tooth: zone(whole - place, place) for tooth, place in touching.wheel.items()},
    )


def make_decks(design: PairDesign | RackPairDesign, plan: MeshPlan, progress: Progress | None) -> dict[str, Deck]:
    """Return the decks that the options of a plan ask for, by the names of their files.

    Raises ParameterError, GeometryError and SolverError for what cannot be checked.
    """
    if not plan.options.decks:
        return {}
    makers = dict[str, Callable[[], Deck]]()
    if isinstance(design, RackPairDesign):
        own = plane_decks(_rack_task(design))
        return {f"pair_deck{place}.inp": own.at(angle) for place, angle in _places(plan.options, own)}
    if set(plan.options.decks) - {DeckKind.SHAFTS}:
        makers |= dict(_makers(plan.options, *_decks(design, plan)))
    if DeckKind.SHAFTS in plan.options.decks:
        on_shafts = SolidDecks(shaft_task(_task(design, Model.SOLID)))
        makers |= {f"shafts_deck{place}.inp": partial(on_shafts.at, angle) for place, angle in _places(plan.options, on_shafts)}
    agenda = Agenda(progress, dict.fromkeys(makers, 1.0))
    made: dict[str, Deck] = {}
    for name, make in makers.items():
        agenda(name)
        made[name] = make()
    return made


def _decks(design: PairDesign, plan: MeshPlan) -> tuple[PairDecks, Callable[[float, Role], Deck]]:
    """Decks of the pair, and what makes that of one gear at a roll angle (deg)."""
    if plan.solid:
        solid = SolidDecks(solid_task(_task(design, Model.SOLID)))
        return solid, partial(solid_tooth_deck, solid)
    plane = PlaneDecks(_task(design, Model.PLANE))
    return plane, partial(plane_tooth_deck, plane)


def _makers(
    options: MeshOptions, decks: PairDecks, tooth: Callable[[float, Role], Deck]
) -> Iterator[tuple[str, Callable[[], Deck]]]:
    """Yield the names of files, and what makes their decks: at the roll angle of the options, or at so many over one base
    pitch.
    """
    for place, angle in _places(options, decks):
        if DeckKind.PAIR in options.decks:
            yield f"pair_deck{place}.inp", partial(decks.at, angle)
        if DeckKind.TOOTH in options.decks:
            yield from ((f"{role.value}_deck{place}.inp", partial(tooth, angle, role)) for role in Role)


def _places(options: MeshOptions, decks: PairDecks) -> Iterator[tuple[str, float]]:
    """Yield the ends of the names of files, and roll angles (deg)."""
    count, pitch = options.positions, 360 / decks.pair.pinion.teeth
    for number in range(count):
        place = "" if count == 1 else f"_{number + 1:0{len(str(count))}}"
        yield place, options.roll + pitch * ((number + 0.5) / count - 0.5)


def _task(design: PairDesign, model: Model) -> CheckTask:
    options = replace(design.check or CheckOptions(), model=model.value)
    return design.check_task("a deck is of pressed flanks", options)


@dataclass(frozen=True, kw_only=True)
class Mesh(Job[GearedDesign | RackPairDesign | SplineDesign, MeshResult]):
    """Meshes of a design in the formats of its options: `gear.vtu`, or `pinion.vtu` and `wheel.vtu`, or `pair.vtu` in mesh; of
    a spline `shaft.vtu` and `hub.vtu`.

    What is `given` of the options by their names wins over those of the design's own [mesh]. Raises ParameterError.
    """

    verb = "mesh"
    accepts = (DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK_PAIR, DesignKind.SPLINE)
    why = "there are no teeth"
    writes_long = True

    given: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        MeshOptions(**self.given)

    def run(self, design: Design, progress: Progress | None = None) -> MeshResult:
        design = self.accepted(design, progress)
        plan = self._plan(design)
        require_room(plan)
        decks = make_decks(design, plan, progress) if isinstance(design, PairDesign | RackPairDesign) else {}
        return replace(run_mesh(plan, design.name, progress), decks=decks)

    def _plan(self, design: GearedDesign | RackPairDesign | SplineDesign) -> MeshPlan:
        options = replace(design.mesh or MeshOptions(), **self.given)
        for kind in options.formats:
            kind.require()
        if isinstance(design, SplineDesign):
            if "gear" in self.given:
                raise ParameterError("gear", self.given["gear"], "must be left out: shaft and hub of a spline are both meshed")
            return plan_mesh(options, design.gears, None).counted()
        if isinstance(design, RackPairDesign):
            return _rack_plan(design, options)
        pair = design.assembly
        if pair is not None and design.mounting is not None:
            pair = design.mounting.mounted(pair)
        plan = plan_mesh(options, design.gears, pair)
        if isinstance(plan.pair, GearPair) and design.load is not None and isinstance(design, PairDesign):
            plan = _pressed(plan, plan.pair, design.material or Material(), design.load)
        return plan.counted()

    def expected(self, design: Design) -> Expected | None:
        design = self.accepted(design)
        plan = self._plan(design)
        require_room(plan)
        return expected_mesh(plan)

    def document(self, result: MeshResult) -> JsonObject:
        """Return the content of mesh.json."""
        beside = [f"{name}{end}" for name in result.meshes for kind in result.plan.options.formats for end in kind.entry.beside]
        return mesh_document(result, [*self.files(result), *beside])

    def notices(self, result: MeshResult) -> Sequence[Notice]:
        return result.notices

    def files(self, result: MeshResult) -> dict[str, Writer]:
        """Return every mesh in every format, then the document."""
        found: dict[str, Writer] = {}
        for name, each in result.meshes.items():
            found |= {f"{name}.{kind.value}": partial(kind.entry.write, each) for kind in result.plan.options.formats}
        found |= {name: deck.write for name, deck in result.decks.items()}
        return {**found, "mesh.json": partial(self.write_document, result)}

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """All files together, because they belong to one mesh."""
        return {self.verb: dict(self.given)}

    def part_of(self, file: str) -> str:
        """Every file of a format is its own."""
        return self.verb if file == "mesh.json" or file.rpartition(".")[2] in SUFFIXES else ""

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the verdict and the summary."""
        return {"passed": document["passed"], **document["summary"], "warnings": document["warnings"]}


def _rack_plan(design: RackPairDesign, options: MeshOptions) -> MeshPlan:
    """Return the plan of a pinion and a rack; in mesh, under a load, their flanks are fine where our own check has contact."""
    plan, load = plan_rack_mesh(options, design.pair), design.load
    if plan.pair is None or load is None or not load.torque:
        return plan
    decks = plane_decks(_rack_task(design))
    zones = PerGear.each(lambda role: decks.zones(options.roll, role))
    fine = {"pinion": replace_zones(plan.gears["pinion"], zones.pinion), "rack": replace_zones(plan.gears["rack"], zones.wheel)}
    return replace(plan, gears=fine, left=load.torque > 0)


def _rack_task(design: RackPairDesign) -> CheckTask:
    """Return the check of sections of a pinion and a rack."""
    return design.check_task("a deck is of pressed flanks", replace(design.check or CheckOptions(), model="section"))


def _pressed(plan: MeshPlan, pair: GearPair, material: Materials, load: Load) -> MeshPlan:
    """Return the plan of a pair in mesh with the flanks that its load presses, and where these are meshed finely.

    In helical bodies the lines of contact run across whole flanks, which are as fine as their edges are everywhere.
    """
    across = plan.solid and pair.pinion.helix_angle and plan.element is not Element.TET10
    zones = (
        PerGear[Mapping[int, ContactRefinement]]({}, {}) if across else contact_zones(pair, material, load, plan.options.roll)
    )
    return plan.pressed(zones, left=load.torque >= 0)


def mesh(
    subject: Design | GearPair | RackPair | Gear,
    load: Load | None = None,
    *,
    progress: Progress | None = None,
    what: str | None = None,
    model: str | None = None,
    element: str | None = None,
    gear: str | None = None,
    size: float | None = None,
    elements: int | None = None,
    fillet_elements: int | None = None,
    roll: float | None = None,
    **inputs: Unpack[Inputs],
) -> MeshResult:
    """Mesh a gear or a pair with finite elements whose sides have names, nodes exactly on the flanks.

    `what` is "sector", "teeth:5", "ring", "pair", "pair:5" or "part"; `model` "2d" or "3d"; `element` "quad8", "tri6", "hex20",
    "hex8" or "tet10"; `gear` "pinion", "wheel" or "both"; `size` (mm) the edge on the flanks, or
    `elements` how many there are; `fillet_elements` how many over 30 degrees of a fillet; `roll` (deg, of the pinion) where a
    pair stands in mesh. What is None is as the design's [mesh] has it, or the MeshOptions given as `mesh`.

    >>> from gearcad import Body, Gear
    >>> result = mesh(Gear(teeth=20, normal_module=2, face_width=10, body=Body(bore=12)), what="sector")
    >>> result.passed, result.mesh.element
    (True, <Element.QUAD8: 'quad8'>)
    >>> result.mesh.points.shape[1], result.mesh.cells.shape[1], sorted(result.mesh.sides)[:3]
    (3, 8, ['bore', 'cut_ahead', 'cut_behind'])

    Raises ParameterError and GeometryError for what cannot be meshed, SolverError where elements come out folded.
    """
    options = {
        "what": what,
        "model": model,
        "element": element,
        "gear": gear,
        "size": size,
        "elements": elements,
        "fillet_elements": fillet_elements,
        "roll": roll,
    }
    job = Mesh(given={name: value for name, value in options.items() if value is not None})
    design = as_design(subject, load, **inputs)
    return suited(job, design).run(design, progress)
