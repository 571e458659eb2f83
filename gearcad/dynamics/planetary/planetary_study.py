"""Study of a planetary train at its load, part by part."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeVar

from gearcad.core.errors import InputError, ParameterError, SolverError
from gearcad.core.runtime import Agenda, Progress, distribution_of
from gearcad.dynamics.options import AUTO, DynamicsOptions
from gearcad.dynamics.planetary.gyroscopic_modes import GyroscopicModes, gyroscopic_modes
from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planar_model import TrainMasses, train_masses, train_springs
from gearcad.dynamics.planetary.planetary_excitation import QUICK, PlanetMeshStiffness, train_stiffness
from gearcad.dynamics.planetary.planetary_modes import PlanetaryCampbell, PlanetaryModes, planetary_campbell, planetary_modes
from gearcad.dynamics.planetary.planetary_response import planetary_response
from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy
from gearcad.dynamics.planetary.planetary_statics import torsional_stiffness
from gearcad.dynamics.planetary.planetary_strength import asks_strength, rate_train
from gearcad.dynamics.planetary.quasi_static_run import CycleCourse, StiffnessCourse, run_train
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.members import TrainMaterial, stage_material
from gearcad.planetary.poses import Drive, MeshPhases, drive_of, mesh_phases
from gearcad.planetary.power import PowerFlow, forces, mesh_loads, power_flow, stage_loads
from gearcad.planetary.train_data import Speeds, shafts_of, speeds
from gearcad.rating.options import RatingOptions
from gearcad.stiffness.methods import METHODS

_BEYOND = 2.0
"""Highest speed of a Campbell diagram over that of the load, if none is given."""

Part = TypeVar("Part")


class _Findings:
    """Parts of a study as they become available, and the reasons why others are missing."""

    def __init__(self) -> None:
        self.why_not: dict[str, str] = {}

    def part(self, name: str, needs: tuple[str, ...], make: Callable[[], Part]) -> Part | None:
        """Return the result of `make`, or None and note why.

        It is None where a part that it needs is missing, or where `make` raises InputError or SolverError, or lacks a package.
        """
        for need in needs:
            if need in self.why_not:
                self.why_not[name] = self.why_not[need]
                return None
        try:
            return make()
        except (InputError, SolverError) as error:
            self.why_not[name] = str(error)
        except ModuleNotFoundError as error:
            package = distribution_of(str(error.name))
            self.why_not[name] = f"the package {package} is not installed: pip install {package}"
        return None


def study_planetary(
    train: PlanetaryTrain,
    load: TrainLoad | None = None,
    given_speeds: Mapping[str, float] | None = None,
    *,
    material: TrainMaterial | None = None,
    dynamics: DynamicsOptions | None = None,
    rating: RatingOptions | None = None,
    response: bool = False,
    progress: Progress | None = None,
) -> PlanetaryStudy:
    """Return the study of a train, with all parts that can be computed.

    `given_speeds` (rpm) are of members, beside that of the input in `load`. The method of the mesh stiffness is that of
    `dynamics`; where it names none, strain energy, and for a `response` a method whose course does not jump. The highest speed
    is that of `dynamics` too. Otherwise it is twice that of the load for a Campbell diagram, and beyond the last resonance for
    a `response`. Raises ParameterError for speeds that contradict each other and an unknown method; other reasons why a part is
    missing are in `why_not`.
    """
    tell = Agenda(
        progress,
        {
            "mesh stiffness": 3.0,
            "load sharing": 1.0,
            "running": 1.0,
            "masses": 2.0,
            "modes": 1.0,
            "response": 100.0 * response,
            "rating": 1.0,
        },
    )
    found, asked = _Findings(), (dynamics or DynamicsOptions()).stiffness
    method = QUICK if asked == AUTO else asked
    turning, load, others = _speeds(train, load, given_speeds or {}, found)
    flow = found.part("power", ("speeds",), lambda: power_flow(train, _loaded(train, load), others))
    drive = drive_of(train, load) if flow is None else _drive(train, flow)
    loads = found.part("loads", ("power",), lambda: mesh_loads(train, _there(flow)))
    tell("mesh stiffness")
    stiffness = found.part(
        "stiffness", (), lambda: train_stiffness(train, loads if _carries(load) else None, method=method, material=material)
    )
    on_stages = stage_loads(train, flow) if flow is not None else {}
    cycles = None
    if flow is not None:
        cycles = found.part("stiffness", ("stiffness",), lambda: _stage_cycles(train, on_stages, method, material))
    secant = {name: each.mean for name, each in (stiffness or {}).items()}
    of_stages = {name: cycle.mean for name, cycle in (cycles or {}).items()}
    tell("load sharing")
    sharing = found.part("sharing", ("power", "stiffness"), lambda: share_load(train, _loaded(train, load), secant, others))
    torsion = found.part(
        "torsion",
        ("stiffness",) if train.fixed else ("speeds", "stiffness"),
        lambda: torsional_stiffness(train, _loaded(train, load), secant | of_stages, others),
    )
    tell("running")
    running = found.part(
        "running",
        ("power", "stiffness"),
        lambda: run_train(
            train, _loaded(train, load), _courses(train, _there(stiffness), _there(cycles), _there(flow)), given_speeds=others
        ),
    )
    tell("masses")
    masses = train_masses(train, material)
    tell("modes")
    modes = found.part("modes", ("stiffness",), lambda: _modes(train, _there(stiffness), masses, drive))
    phases = mesh_phases(train, drive)
    campbell = found.part(
        "campbell", ("speeds", "modes"), lambda: _campbell(train, load, others, _there(modes), phases, dynamics)
    )
    turned = None
    if campbell is not None and modes is not None and turning is not None:
        turned = _turned(campbell, modes, masses, turning)
    answer = None
    if response:
        tell("response")
        answer = found.part(
            "response",
            ("power", "stiffness", "modes"),
            lambda: planetary_response(
                train,
                _loaded(train, load),
                _there(stiffness) if asked != AUTO else train_stiffness(train, loads, method=AUTO, material=material),
                masses,
                dynamics,
                given_speeds=others,
            ),
        )
    tell("rating")
    shared = None if sharing is None else sharing.mesh_load_factor
    loads = None if flow is None else found.part("loads", (), lambda: mesh_loads(train, _there(flow), shared))
    return PlanetaryStudy(
        train=train,
        load=load,
        given_speeds=others,
        pose=train.pose(),
        phases=phases,
        speeds=turning,
        flow=flow,
        forces=found.part("forces", ("power",), lambda: forces(_weighed(train, masses), _there(flow))),
        loads=loads,
        stage_loads=on_stages,
        stiffness=stiffness,
        stage_cycles=cycles or {},
        sharing=sharing,
        torsion=torsion,
        running=running,
        masses=masses,
        modes=modes,
        campbell=campbell,
        gyroscopic=turned,
        response=answer,
        rating=found.part("rating", ("loads",), lambda: rate_train(train, _there(loads), on_stages, masses, material, rating)),
        asks_strength=asks_strength(material, rating),
        why_not=found.why_not,
    )


def _there(part: Part | None) -> Part:
    """Return a part that is not missing, as `needs` has made sure. Raises RuntimeError if it is missing."""
    if part is None:
        raise RuntimeError("a part that is needed is missing")
    return part


def _loaded(train: PlanetaryTrain, load: TrainLoad | None) -> TrainLoad:
    if load is None:
        permitted = f"must be given, in N·m on {train.output}, or load.input_torque, on {train.input}"
        raise ParameterError("load.output_torque", None, permitted)
    return load


def _carries(load: TrainLoad | None) -> bool:
    return load is not None and bool(load.given_torque)


def _speeds(
    train: PlanetaryTrain, load: TrainLoad | None, given: Mapping[str, float], found: _Findings
) -> tuple[Speeds | None, TrainLoad | None, dict[str, float]]:
    """Return all speeds, the load with that of the input, and the given speeds of others, one of a differential.

    Raises ParameterError where more is given than is free.
    """
    needed, known = 1 if train.fixed else 2, dict(given)
    if load is not None and load.speed and train.input in known:
        permitted = f"must not be given too: load.speed is that of {train.input}"
        raise ParameterError(f"speeds.{train.input}", known[train.input], permitted, "rpm")
    if load is not None and train.input not in known and (load.speed or len(known) < needed):
        known = {train.input: load.speed} | known
    if len(known) < needed:
        found.why_not["speeds"] = _what_is_missing(train, known)
        return None, load, known
    turning = speeds(train, known)
    if load is not None:
        load = replace(load, speed=turning.members[train.input])
    others = {name: speed for name, speed in known.items() if name != train.input}
    return turning, load, dict(list(others.items())[: needed - 1])


def _what_is_missing(train: PlanetaryTrain, known: Mapping[str, float]) -> str:
    shafts = shafts_of(train)
    taken = {shafts[name].member for name in known if name in shafts}
    free = [name for name in train.members if name not in taken]
    if train.fixed:
        return f"no speed is given: that of {train.input} stands in [load], others in [planetary.speeds]"
    count = "a second speed is" if known else "two speeds are"
    return f"{count} needed, as no member is fixed: of {', '.join(free)}, in [load] or [planetary.speeds]"


def _drive(train: PlanetaryTrain, flow: PowerFlow) -> Drive:
    """Return the drive: the senses of the torque on the first central and of its turn against the carrier."""
    first, carrier = train.centrals[0].name, train.carrier.name
    relative = flow.speeds.members[first] - flow.speeds.members[carrier]
    torque = flow.set_torques[first]
    if not relative or not torque:
        return drive_of(train, flow.load)
    return Drive(1 if torque > 0 else -1, 1 if relative > 0 else -1)


def _stage_cycles(
    train: PlanetaryTrain, loads: Mapping[str, Load], method: str, material: TrainMaterial | None
) -> dict[str, MeshCycle]:
    """Return the mesh cycles of the stages under their loads, by the names of stages."""
    kind = METHODS[method]
    return {
        stage.name: kind(pair=stage.pair, material=stage_material(material, stage))(loads[stage.name])
        for stage in train.stages
        if loads[stage.name].torque
    }


def _courses(
    train: PlanetaryTrain, stiffness: Mapping[str, PlanetMeshStiffness], cycles: Mapping[str, MeshCycle], flow: PowerFlow
) -> dict[str, StiffnessCourse]:
    """Return the stiffness courses of meshes and stages, by their names.

    They are over the distance of contact past the pitch point.
    """
    found: dict[str, StiffnessCourse] = {**stiffness}
    for stage in train.stages:
        if stage.name in cycles:
            entering = flow.stage_torques[stage.name].pinion * flow.speeds.members[stage.pinion]
            found[stage.name] = CycleCourse(cycle=cycles[stage.name], reverse=entering < 0)
    return found


def _modes(
    train: PlanetaryTrain, stiffness: Mapping[str, PlanetMeshStiffness], masses: TrainMasses, drive: Drive
) -> PlanetaryModes:
    """Return the natural modes at the mean tangent stiffness of the meshes."""
    first, second = (stiffness[mesh.name].tangent_mean for mesh in train.meshes)
    return planetary_modes(train_springs(train, (first, second), sense=drive.sense), masses)


def _campbell(
    train: PlanetaryTrain,
    load: TrainLoad | None,
    others: Mapping[str, float],
    modes: PlanetaryModes,
    phases: Mapping[str, MeshPhases],
    options: DynamicsOptions | None,
) -> PlanetaryCampbell:
    """Return the Campbell diagram up to the speed of the options, or _BEYOND times that of the load."""
    speed = 0.0 if load is None else load.speed
    highest = None if options is None else options.speed_to
    if highest is None and not speed:
        raise ParameterError("load.speed", 0.0, f"must be given, in rpm of {train.input}, or dynamics.speed_to", "rpm")
    highest = _BEYOND * abs(speed) if highest is None else highest
    # By the signed speed: where the input turns clockwise all senses are reversed alike, as `highest` has none.
    given = {name: each * highest / speed if speed else each for name, each in others.items()}
    return planetary_campbell(train, modes, phases, highest, given_speeds=given, speed=speed)


def _turned(campbell: PlanetaryCampbell, modes: PlanetaryModes, masses: TrainMasses, turning: Speeds) -> GyroscopicModes:
    """Return the natural frequencies up to the speed of the carrier at the end of the Campbell diagram."""
    train = campbell.train
    carrier, entering = (abs(turning.members[name]) for name in (train.carrier.name, train.input))
    highest = carrier * campbell.highest_speed / entering if entering else carrier
    return gyroscopic_modes(modes.springs, masses, highest, operating=carrier if campbell.speed else None)


def _weighed(train: PlanetaryTrain, masses: TrainMasses) -> PlanetaryTrain:
    """Return the train with the mass of its planets, which press their pins outwards; unchanged if that is unknown."""
    if masses.planet.mass is None:
        return train
    return replace(train, carrier=replace(train.carrier, planet_mass=masses.planet.mass))
