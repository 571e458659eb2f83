"""The pairs of a train as specs of their own, under what the train gives them: every command of pairs takes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from gearcad.designs.design import LONGEST_NAME
from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.train_pairs import DesignedPair, plain_name
from gearcad.designs.pair_text import pair_text
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.engaged_mesh import EngagedMesh
from gearcad.dynamics.trains.train import Train
from gearcad.load import Load
from gearcad.per_gear import Role

__all__ = ["loaded_pair", "pair_specs"]


def pair_specs(study: TrainStudy) -> dict[str, str]:
    """The spec of each pair of a train, under the name of its file."""
    found: dict[str, str] = {}
    for place, mesh in enumerate(study.train.meshes):
        if isinstance(mesh, EngagedMesh):
            found[_file(mesh, found)] = pair_text(loaded_pair(study.train, mesh), list(_comments(study, mesh, place)))
    return found


def _file(mesh: EngagedMesh, taken: dict[str, str]) -> str:
    """A name that no other has, also where large and small letters are the same."""
    name, others = plain_name(mesh.name), {each.casefold() for each in taken}
    tried = (f"{name}.toml" if number == 1 else f"{name}-{number}.toml" for number in range(1, len(taken) + 2))
    return next(each for each in tried if each.casefold() not in others)


def loaded_pair(train: Train, mesh: EngagedMesh) -> PairDesign:
    """The pair of a mesh, with the torque and speed that the train gives its pinion, and the inertias of the train."""
    of = mesh.teeth_of
    own = of.design if isinstance(of, DesignedPair) else _plain_design(mesh)
    name = plain_name(f"{train.name}-{mesh.name}"[:LONGEST_NAME])
    factor = own.load.application_factor if own.load is not None else 1.0
    torque, speed = (_plain(each) for each in (mesh.course.torque, train.speed * train.speed_ratios[mesh.pinion]))
    load = Load(torque=torque, speed=speed, application_factor=factor)
    return replace(own, name=name, pair=replace(own.pair, name=name), load=load, dynamics=_dynamics(train, mesh, own))


def _plain(value: float) -> float:
    """Without the rounding of the equations of a train."""
    return float(f"{value:.12g}")


def _plain_design(mesh: EngagedMesh) -> PairDesign:
    """Of a pair that came without one."""
    of = mesh.teeth_of
    return PairDesign(name=plain_name(mesh.name), pair=of.pair, material=of.material, mounting=of.mounting, rating=of.rating)


def _dynamics(train: Train, mesh: EngagedMesh, own: PairDesign) -> DynamicsOptions:
    """By the method and with the damping of the train, on the inertias that its gears are part of there."""
    inertias = {each.name: each.inertia for each in train.inertias}
    options = replace(
        own.dynamics or DynamicsOptions(),
        stiffness=mesh.course.cycle.method,
        pinion_inertia=inertias[mesh.pinion],
        wheel_inertia=inertias[mesh.wheel],
    )
    ratio = mesh.damping_ratio
    return options if ratio is None or not 0 < ratio < 1 else replace(options, damping_ratio=ratio)


def _comments(study: TrainStudy, mesh: EngagedMesh, place: int) -> Iterator[str]:
    """What a spec says of where it comes from, line by line."""
    yield f"Mesh {mesh.name} of the train {study.train.name}, written by `gearcad dynamics`: a pair for `gearcad check`,"
    yield "`gearcad build` and every other command of pairs; the rest of the train is left out."
    drives = "the pinion drives" if mesh.course.driver is Role.PINION else "the wheel drives: the torque is against the turn"
    yield f"The load is what the train at rest gives the pinion; {drives}."
    if mesh.course.driver is Role.WHEEL:
        yield "`gearcad dynamics` of this pair alone meets flanks as if the pinion drove: K_v of modified flanks may differ."
    course, chart = study.course, study.up
    most = int(chart.factors[:, place].argmax())
    yield (
        f"Its dynamic factor in the train is {course.kv[place]:.4g} at {course.speed:.6g} rpm of the first pinion, and"
        f" {chart.factors[most, place]:.4g} at most, at {study.speeds[most]:.6g} rpm; ratings take that of ISO 6336-1."
    )
