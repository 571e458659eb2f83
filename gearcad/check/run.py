"""The structural check of a pair: one mesh cycle, refined meshes, a torque sweep, and the verdict."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from gearcad.check.comparison import SECTION
from gearcad.check.convergence import FACTORS, FEW_POSITIONS, SOLID_FACTORS, sweep_points, three_meshes, three_solid_meshes
from gearcad.check.depth import depth_notices, material_exposure
from gearcad.check.friction import friction_notices, mesh_losses
from gearcad.check.gates import compare_plane, compare_solid
from gearcad.check.notices import common_notices
from gearcad.check.oil_film import film_notices, oil_film
from gearcad.check.on_shafts import load_on_shafts, shaft_notices
from gearcad.check.options import Model
from gearcad.check.pictures import tooth_stresses
from gearcad.check.plastic import plastic_check, plastic_notices
from gearcad.check.relief_start import relief_starts, start_comparisons, start_notices
from gearcad.check.result import CheckResult, PlaneCheck, SolidCheck
from gearcad.check.summary import PLANE, SOLID, SolidSummary, summarise_plane, summarise_solid
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle, plane_pressure, thin_faces, wide_plane_contacts
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.shared.line_of_action import loaded_left
from gearcad.contact.shared.loaded import EngagedPair
from gearcad.contact.solid.cycle import SolidCycle, wide_solid_contacts
from gearcad.contact.solid.pair import LEFT, POSITION_SECONDS, SolidPair, SolidSizes, expected_bodies, solid_pair
from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, JsonObject, Notice, freeze
from gearcad.core.runtime import Agenda, Expected, Progress, Share, machine_memory, unheard
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.meshing.outline import MeshSizes, NotchPlace
from gearcad.mounting import Mounting
from gearcad.rating.load_factors import BodyLoad, LoadedMesh, Misalignment, dynamic_factor
from gearcad.rating.nominal_rating import require_ratable
from gearcad.rating.options import ContactPattern, HelixModification

BODIES, CYCLE, SWEEP, RATING = "bodies of pinion and wheel", "mesh cycle", "torque sweep", "rating"
COARSER, FINER = "coarser bodies, for the error", "finer bodies, for the error"

_SINGLE_POSITIONS = 15

_EXPECTED_SOUGHT = 2.5
"""Factor on the number of positions for those between them, where extremes are sought."""
_RATING_SECONDS = 0.2

_PROGRAM = 0.27e9
"""Bytes of Python and its libraries, and of contacts."""


def sizes_of(task: CheckTask, factor: float) -> SolidSizes:
    """Return the sizes of the check's mesh, refined by a factor."""
    return SolidSizes().refined(factor * task.options.refinement)


def _bodies(task: CheckTask) -> dict[str, Expected]:
    factors = dict(zip((COARSER, BODIES, FINER), SOLID_FACTORS, strict=True))
    wanted = (BODIES, COARSER, FINER) if task.options.refines else (BODIES,)
    pair = loaded_left(task.gear_pair, task.torque)
    return {name: expected_bodies(pair, task.body, sizes_of(task, factors[name]), fields=name == BODIES) for name in wanted}


def solid_steps(task: CheckTask) -> dict[str, float]:
    """Return the seconds expected of each step, in order."""
    few = _EXPECTED_SOUGHT * FEW_POSITIONS * POSITION_SECONDS
    cycle = _EXPECTED_SOUGHT * task.options.positions_of(Model.SOLID)
    bodies = {name: each.seconds + cycle * POSITION_SECONDS for name, each in _bodies(task).items()}
    positions = cycle + _SINGLE_POSITIONS
    return {
        BODIES: bodies.pop(BODIES) - cycle * POSITION_SECONDS,
        CYCLE: positions * POSITION_SECONDS,
        SWEEP: len(task.torques) * few,
        **bodies,
        RATING: _RATING_SECONDS,
    }


def expected_solid(task: CheckTask) -> Expected:
    """Return the seconds and the memory that the whole check is expected to take.

    The bodies of the check's own mesh are kept, without factors, while the others are solved.
    """
    own, *others = (each.memory for each in _bodies(task).values())
    return Expected(sum(solid_steps(task).values()), _PROGRAM + max(own, LEFT * own + max(others, default=0.0)))


_GROWTH = 4.0
"""Power of the refinement with which memory grows: of edges and layers together."""

_MARGIN = 1.25
"""Margin of the proposed refinement below what would just fit: memory is known roughly."""


def require_room(task: CheckTask) -> None:
    """Raise ParameterError for bodies that take more memory than the machine has, with what would do."""
    needed, there = expected_solid(task).memory, machine_memory()
    if needed <= there:
        return
    coarser = task.options.refinement * (there / needed / _MARGIN) ** (1 / _GROWTH)
    fewer = ", or fewer without convergence" if task.options.refines else ""
    raise ParameterError(
        "check.refinement",
        task.options.refinement,
        f"the solid bodies take about {needed / 1e9:.3g} GB of memory{fewer}, and there are {there / 1e9:.3g} GB; "
        f"about {coarser:.2g} would do",
    )


_WORTH_A_WORD = 0.01
"""Excess of the face width at the root over the width in mesh, as a share of the latter, from which a notice is given."""

_BODIES = (0.1, 0.13)
"""Seconds for two bodies: whatever their mesh, and times the square of its refinement."""

_POSITION, _SOUGHT, _SINGLE, _RATING = 0.003, 30, 25, 0.5
"""Seconds for a position; how many are sought between those of a cycle, and of one pair alone; seconds for the rest."""

PLANE_MEMORY = 0.4e9
"""Memory (bytes) that a check of plane sections needs."""


def plane_steps(task: CheckTask) -> dict[str, float]:
    """Return the seconds expected of each step, in order."""

    def bodies(factor: float) -> float:
        whatever, refined = _BODIES
        return whatever + refined * (factor * task.options.refinement) ** 2

    few = (FEW_POSITIONS + _SOUGHT) * _POSITION
    own = (task.options.positions_of(Model.PLANE) + _SOUGHT + _SINGLE) * _POSITION
    others = [bodies(factor) + own for factor in FACTORS if factor != 1] if task.options.refines else []
    return {
        "mesh cycle": bodies(1.0) + own,
        "convergence": sum(others),
        "torque sweep": len(task.torques) * few,
        "rating": _RATING,
    }


def check_plane(task: CheckTask, tell: Agenda) -> PlaneCheck:
    """Check in the transverse section through the middle of the common face width. Raises what `check_pair` does."""
    tell("mesh cycle")
    model = plane_model(task)
    cycle = PlaneCycle.run(model, task.torque, task.options.positions_of(Model.PLANE)).searched(PLANE)
    summary = summarise_plane(cycle, model.single_stiffness(task.torque))
    starts, exposure, film = relief_starts(cycle), material_exposure(task, cycle), oil_film(task, cycle)
    tell("convergence")
    convergence = three_meshes(_refined(task, cycle)) if task.options.refines else ()
    tell("torque sweep")
    sweep = sweep_points(cycle, task.torques)
    tell("rating")
    plastic = plastic_check(task, cycle, summary)
    beside_guideline = () if plastic is None else plastic.comparisons(task.options.root_band / 100)
    comparisons = (
        *compare_plane(task, cycle, summary, convergence),
        *start_comparisons(task, starts),
        *beside_guideline,
    )
    notices = (
        *plastic_notices(task, plastic),
        *common_notices(task, cycle, summary),
        *plane_notices(task),
        *wide_plane_contacts(cycle),
        *start_notices(task, starts),
        *friction_notices(task),
        *depth_notices(exposure),
        *film_notices(task, film),
    )
    return PlaneCheck(
        task=task,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        comparisons=comparisons,
        notices=notices,
        relief_starts=starts,
        losses=mesh_losses(task, cycle),
        plastic=plastic,
        exposure=exposure,
        film=film,
    )


def plane_load(task: CheckTask) -> float:
    """Return the normal force in the transverse section (N per mm of common width)."""
    return EngagedPair(task.pair).force(task.torque)


def plane_model(task: CheckTask, factor: float = 1.0) -> PlanePair:
    """Return the sections of both gears of a task, with elements `factor` times smaller than it asks for. Raises what
    `check_pair` does.
    """
    options = task.options
    sizes = MeshSizes().refined(factor * options.refinement)
    error = task.mounting.pitch_error
    made = plane_pair(task.pair, task.material, plane=options.plane_state, body=task.body, sizes=sizes, pitch_error=error)
    return made.rubbing(task.friction)


def _refined(task: CheckTask, middle: PlaneCycle) -> Iterator[PlaneCycle]:
    """Yield the cycles of coarser, own and finer meshes at as many positions: the middle one has the figures that are told."""
    for factor in FACTORS:
        if factor == 1:
            yield middle
        else:
            positions = task.options.positions_of(Model.PLANE)
            yield PlaneCycle.run(plane_model(task, factor), task.torque, positions).searched(PLANE)


def plane_notices(task: CheckTask) -> Iterator[Notice]:
    """Yield notices on what a plane model does not know of these bodies."""
    if task.is_section:
        load = plane_load(task)
        text = f"{SECTION}; here every mm of the common width carries {load:.4g} N, and strength is not judged"
        yield Notice("section", text)
    yield from thin_faces(task.pair, task.material, task.options.plane_state)
    yield from plane_pressure(task.material, task.options.plane_state)
    yield from _wider_gears(task)
    yield from _left_out(task)


def _wider_gears(task: CheckTask) -> Iterator[Notice]:
    """Yield the gears whose root carries over more than the common width."""
    common = task.width
    for role, rating in task.rating.roots.items():
        own, name = task.face_widths.pick(role), task.rating.names.pick(role)
        whole = "--model 3d has the whole width" if isinstance(task.pair, GearPair) else "the plane model has no more"
        if rating.width > (1 + _WORTH_A_WORD) * common:
            carry = f"by {task.rating.edition.part(3)} {rating.width:.4g} mm carry at its root"
            yield Notice(
                "wider-root",
                f"the {name} is {own:.4g} mm wide, and the plane model has the {common:.4g} mm in mesh; {carry}, "
                f"with {100 * (1 - common / rating.width):.2g} % less stress; {whole}",
            )


def _left_out(task: CheckTask) -> Iterator[Notice]:
    along = [role for role, gear in task.gears.items() if gear.modification.along_face]
    left_out = [f"the {role.value}'s modifications along the face width" for role in along]
    left_out += ["the misalignment"] if task.mounting.tilted else []
    left_out += ["the shafts"] if task.shafts is not None else []
    if left_out:
        yield Notice("left-out", f"the plane model leaves out {' and '.join(left_out)}; --model 3d has them")


def _unresolved_notches(task: CheckTask) -> Iterator[Notice]:
    """Yield the gears with a grinding notch that is too sharp for the elements of bodies."""
    for role, gear in task.gears.items():
        notch = NotchPlace.of(gear)
        if notch is not None and notch.sharp(gear.normal_module):
            text = f"grinding notch with a radius of {notch.radius:.3g} mm: elements of bodies do not resolve its stress"
            yield Notice("notch-not-resolved", f"{text}; sections (--model 2d) do", role.value)


_EDGE_RATIO = 1.5
"""Ratio of the pressure at an edge to the greatest away from edges from which a warning is given."""


def check_solid(task: CheckTask, agenda: Agenda) -> SolidCheck:
    """Check the bodies over their face widths. Raises what `check_pair` does.

    The model's left flanks carry. A negative torque loads the right ones: the pair is then mirrored in the plane x-z, which
    turns helix angles over and leaves heights and radii as they are, and all results are those of its left flanks. The
    mounting's misalignment is always that of the flanks that carry.
    """
    require_room(task)
    model = solid_model(task, 1.0, agenda.within(BODIES), fields=True)
    positions = task.options.positions_of(Model.SOLID)
    cycle = SolidCycle.run(model, task.torque, positions, agenda.counted(CYCLE, "position")).searched(SOLID)
    summary, stresses = summarise_solid(cycle, model.single_stiffness(task.torque)), tooth_stresses(cycle)
    starts, shafts, exposure = relief_starts(cycle), load_on_shafts(task, cycle), material_exposure(task, cycle)
    film = oil_film(task, cycle)
    model.let_go()
    agenda(SWEEP)
    sweep = sweep_points(cycle, task.torques)
    convergence = three_solid_meshes(_solid_refined(task, cycle, agenda)) if task.options.refines else ()
    agenda(RATING)
    plastic = plastic_check(task, cycle, summary)
    beside_guideline = () if plastic is None else plastic.comparisons(task.options.root_band / 100)
    comparisons = (
        *compare_solid(task, cycle, summary, convergence, shafts),
        *start_comparisons(task, starts),
        *beside_guideline,
    )
    notices = (
        *plastic_notices(task, plastic),
        *common_notices(task, cycle, summary),
        *_edge_notices(task, cycle, summary),
        *_unresolved_notches(task),
        *wide_solid_contacts(cycle),
        *start_notices(task, starts),
        *shaft_notices(task),
        *friction_notices(task),
        *depth_notices(exposure),
        *film_notices(task, film),
    )
    return SolidCheck(
        task=task,
        cycle=cycle,
        summary=summary,
        tooth_stresses=stresses,
        sweep=sweep,
        convergence=convergence,
        comparisons=comparisons,
        notices=notices,
        relief_starts=starts,
        shafts=shafts,
        losses=mesh_losses(task, cycle),
        plastic=plastic,
        exposure=exposure,
        film=film,
    )


def solid_model(task: CheckTask, factor: float = 1.0, tell: Share = unheard, *, fields: bool = False) -> SolidPair:
    """Return the bodies of both gears of a task on its shafts, with elements `factor` times smaller than it asks for; left
    flanks carry.

    They keep what `fields` of teeth need if these are asked for. Raises what `check_pair` does.
    """
    sizes = sizes_of(task, factor)
    pair, mounting = loaded_left(task.gear_pair, task.torque), replace(task.mounting, centre_distance_change=0.0)
    made = solid_pair(
        pair, task.material, body=task.body, sizes=sizes, mounting=mounting, fields=fields, friction=task.friction, tell=tell
    )
    return made if task.supports is None else made.on(task.supports)


def _solid_refined(task: CheckTask, middle: SolidCycle, agenda: Agenda) -> Iterator[SolidCycle]:
    """Yield the cycles of coarser, own and finer bodies at as many positions; none but the own bodies are kept."""
    coarser, _, finer = SOLID_FACTORS
    yield _cycle(solid_model(task, coarser, agenda.within(COARSER)), task)
    yield middle
    yield _cycle(solid_model(task, finer, agenda.within(FINER)), task)


def _cycle(model: SolidPair, task: CheckTask) -> SolidCycle:
    return SolidCycle.run(model, task.torque, task.options.positions_of(Model.SOLID)).searched(SOLID)


def _edge_notices(task: CheckTask, cycle: SolidCycle, summary: SolidSummary) -> Iterator[Notice]:
    greatest = max(contact.edge_pressure for _, contact in cycle.contacts)
    if summary.contact_pressure is None or greatest >= _EDGE_RATIO * summary.contact_pressure:
        modified = any(gear.modification.present for gear in task.gears.values())
        advice = "the modifications given do not prevent it" if modified else "reliefs and crowning would lower it"
        yield Notice(
            "edge-pressure",
            f"beside the edges of the flanks the pressure is up to {greatest:.0f} MPa, by Hertz's formula, which does not hold "
            "at edges; "
            f"it is left out of the verdict; {advice}",
        )


COARSE = 0.5
"""Factor by which the elements are finer than in a check. K_Hbeta is then up to 3 % larger (spur and helical pairs,
measured).
"""


@dataclass(frozen=True, kw_only=True)
class LoadDistribution:
    """`face_load_factor` K_Hbeta of a pair under `torque` (N·m on the pinion, with K_A, K_gamma and K_v).

    `load` (n,) is the load per width (N/mm), mean of a mesh cycle, at places `across` (n,) in mm from the middle of the common
    face width. `misalignment` (µm) is F_beta_y in the plane of action, positive if the gap grows towards larger z, and that of
    the mounting if `mounted`.
    """

    face_load_factor: float
    misalignment: float
    mounted: bool
    torque: float
    across: Floats
    load: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def body_load(self) -> BodyLoad:
        """Face load factor and misalignment in the form that a rating takes."""
        return BodyLoad(factor=self.face_load_factor, misalignment=abs(self.misalignment), mounted=self.mounted)

    def to_dict(self) -> JsonObject:
        """Return the distribution as documents have it."""
        return {
            "K_Hbeta": self.face_load_factor,
            "F_betay": self.misalignment,
            "torque": self.torque,
            "across": self.across.tolist(),
            "load": self.load.tolist(),
        }


def load_distribution(task: CheckTask, tell: Share = unheard) -> LoadDistribution:
    """Return the worst distribution of the load along the face width, on coarse solid bodies with their flank modifications.

    The flanks stand off by the misalignment of the mounting or, where that is 0, by F_beta_x of Method C, to the worse side,
    with B_1 = B_2 = 1; y_beta runs in. The bodies are held all along their width, so that shafts and the pinion itself give
    way in f_sh alone or, where the pair has shafts, in the contact alone: the flanks then stand off by f_ma, to its sides. The
    options of the task say how the bodies are held. Raises ParameterError, GeometryError and SolverError.
    """
    options, mounting = task.rating_options, task.mounting
    plain = replace(options, helix_modification=HelixModification.NONE)  # the flanks have their own
    if task.shafts is not None:
        plain = replace(plain, shaft_deflection=0.0)  # the shafts have their own
    mesh = LoadedMesh(pair=task.gear_pair, materials=task.materials, load=task.load, options=plain)
    require_ratable(mesh.pair, task.load)
    speed_factor = dynamic_factor(mesh).factors["K_v"]
    off = _standing_off(mesh, mounting, speed_factor, on_shafts=task.shafts is not None)
    torque = task.torque * options.mesh_load_factor * speed_factor
    asked = replace(task.options, model=Model.SOLID.value, refinement=COARSE, convergence="off", torques=(), friction=None)
    model = solid_model(replace(task, load=Load(torque=torque), options=asked), tell=tell)
    if mounting.misalignment or not off:
        sides: tuple[float, ...] = (off,)
    else:
        sides = (off, -off) if task.shafts is None else options.sides_of(off)
    found = [_distribution(model, torque, side, mounted=bool(mounting.misalignment)) for side in sides]
    return max(found, key=lambda each: each.face_load_factor)


def _standing_off(mesh: LoadedMesh, mounting: Mounting, speed_factor: float, *, on_shafts: bool) -> float:
    """Return F_beta_y (µm): of the mounting, with its sign, or of what Method C takes shafts and manufacture for.

    On shafts that give way it is f_ma with its sign, or what a proven contact pattern leaves: the least value holds for f_sh
    and f_ma together.
    """
    initial = mounting.misalignment
    if not initial:
        found, options = Misalignment.of(mesh, mesh.specific_load * speed_factor), mesh.options
        alone = on_shafts and options.contact_pattern is not ContactPattern.PROVEN
        initial = math.copysign(found.manufacture, options.manufacturing_misalignment or 0.0) if alone else found.initial
    return initial - math.copysign(float(mesh.wear.beta(abs(initial), mesh.speed)), initial)


def _distribution(model: SolidPair, torque: float, misalignment: float, *, mounted: bool) -> LoadDistribution:
    """Return the distribution by a few positions of a mesh cycle, with another misalignment (µm)."""
    mounting = replace(model.mounting, misalignment=misalignment)
    cycle = SolidCycle.run(model.remade(model.pair, mounting), abs(torque), FEW_POSITIONS)
    across, carried = cycle.load_along_face
    # Where flanks part the ends carry what there is: then they are no longer left out.
    factor = cycle.face_load_factor if (carried > 0).all() else float(carried.max() / carried.mean())
    return LoadDistribution(
        face_load_factor=max(factor, 1.0),
        misalignment=misalignment,
        mounted=mounted,
        torque=torque,
        across=across,
        load=carried,
    )


def check_pair(task: CheckTask, progress: Progress | None = None) -> CheckResult:
    """Check a pair under a load: a plane through the middle of the common face width, or solid bodies.

    Raises ParameterError and GeometryError for input that cannot be checked, SolverError where a solver fails.
    """
    if task.rating_options.face_load_factor == "fe":
        task = replace(task, body_load=load_distribution(task).body_load)
    if task.model is Model.PLANE:
        return check_plane(task, Agenda(progress, plane_steps(task)))
    return check_solid(task, Agenda(progress, solid_steps(task)))


def expected_check(task: CheckTask) -> Expected:
    """Return the seconds and the memory that `check_pair` is expected to take."""
    if task.model is Model.PLANE:
        return Expected(sum(plane_steps(task).values()), PLANE_MEMORY)
    return expected_solid(task)
