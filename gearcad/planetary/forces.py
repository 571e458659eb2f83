"""Forces on the teeth and pins of a planetary train, all planets loaded alike."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from gearcad.geometry import GearPair
from gearcad.planetary.members import PairStage
from gearcad.planetary.mesh import SetMesh, base_radius
from gearcad.planetary.power import PowerFlow
from gearcad.planetary.train_data import TrainData

__all__ = ["MeshForce", "PinForce", "TrainForces", "forces"]


@dataclass(frozen=True, kw_only=True)
class MeshForce:
    """Force in a mesh (N): of a central on one planet, or of the pinion of a stage on its wheel.

    `normal` is its size in the transverse plane, along the line of action: F_bt = T/r_b. The others are its parts at the
    working pitch circles: `tangential` is positive where it turns counter-clockwise about the central (of a stage: about
    the pinion), `radial` where it pushes the axes apart, as all but rings do, `axial` along +z.
    """

    normal: float
    tangential: float
    radial: float
    axial: float


@dataclass(frozen=True, kw_only=True)
class PinForce:
    """Force of one planet's teeth on its pin (N), in the plane of rotation away from the train's axis and counter-clockwise.

    `axial` is what is left along +z. `tilting_radial` and `tilting_tangential` (N·m) are the moment about the middle of the
    planet's teeth, about the directions of the two forces, of meshes in different planes and of axial forces.
    `centrifugal` (N, away from the axis, not in `radial`) is the planet's own; None where its mass is not known.
    """

    radial: float
    tangential: float
    axial: float
    tilting_radial: float
    tilting_tangential: float
    centrifugal: float | None

    @property
    def size(self) -> float:
        """Of the force in the plane of rotation, with the centrifugal one (N)."""
        return math.hypot(self.radial + (self.centrifugal or 0.0), self.tangential)

    @property
    def tilting_moment(self) -> float:
        """Size of the moment that tilts the planet (N·m)."""
        return math.hypot(self.tilting_radial, self.tilting_tangential)


@dataclass(frozen=True, kw_only=True)
class TrainForces:
    """Forces of a planetary train, at the torques that its members bring in where power is lost.

    `meshes` by the name of the mesh, on one planet; `pin` of one planet; `stages` by name, on their wheels.
    """

    meshes: Mapping[str, MeshForce]
    pin: PinForce
    stages: Mapping[str, MeshForce]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "meshes": {name: asdict(force) for name, force in self.meshes.items()},
            "pin": asdict(self.pin) | {"size": self.pin.size, "tilting_moment": self.pin.tilting_moment},
            "stages": {name: asdict(force) for name, force in self.stages.items()},
        }


def forces(train: TrainData, flow: PowerFlow) -> TrainForces:
    """The forces of a flow of power; each mesh of the set has its N-th part of the torque on its central."""
    return TrainForces(
        meshes={mesh.name: _on_planet(train, mesh, flow) for mesh in train.meshes},
        pin=_on_pin(train, flow),
        stages={stage.name: _on_wheel(stage, flow) for stage in train.stages},
    )


def _on_planet(train: TrainData, mesh: SetMesh, flow: PowerFlow) -> MeshForce:
    torque = flow.set_torques[mesh.central.name] / train.planets
    # Counter-clockwise about the train is clockwise about the planet where it meshes with a sun.
    turning = -torque if mesh.external else torque
    return _force(mesh.pair, torque, mesh.central_base_radius, mesh.rim.gear.helix_angle * math.copysign(1, turning))


def _on_wheel(stage: PairStage, flow: PowerFlow) -> MeshForce:
    wheel, torque = stage.pair.wheel, flow.stage_torques[stage.name].wheel
    # The shaft's torque is held by the teeth, so these turn the wheel the other way.
    about_pinion = torque if not wheel.internal else -torque
    return _force(stage.pair, about_pinion, base_radius(wheel), wheel.helix_angle * math.copysign(1, -torque))


def _force(pair: GearPair, torque: float, radius: float, helix_angle: float) -> MeshForce:
    """From a torque (N·m) at a base radius (mm); `helix_angle` of the gear pushed, negative where it is pushed clockwise."""
    normal = abs(torque) * 1e3 / radius
    angle = math.radians(pair.working_transverse_pressure_angle)
    hand = 0.0 if pair.double_helical else math.copysign(math.radians(pair.pinion.base_helix_angle), helix_angle)
    return MeshForce(
        normal=normal,
        tangential=math.copysign(normal * math.cos(angle), torque) + 0.0,
        radial=normal * math.sin(angle) * (-1 if pair.internal else 1) + 0.0,
        axial=-normal * math.tan(hand) + 0.0,
    )


def _on_pin(train: TrainData, flow: PowerFlow) -> PinForce:
    """Sums over both meshes: of a sun at the near side of the planet, of a ring at its far side."""
    bottom = min(rim.axial_position for rim in train.rims)
    top = max(rim.axial_position + rim.gear.face_width for rim in train.rims)
    radial = tangential = axial = about_radial = about_tangential = 0.0
    for mesh in train.meshes:
        force = _on_planet(train, mesh, flow)
        height = mesh.rim.axial_position + mesh.rim.gear.face_width / 2 - (bottom + top) / 2
        arm = mesh.rim_base_radius / math.cos(mesh.working_pressure_angle) * (-1 if mesh.external else 1)
        radial, tangential, axial = radial + force.radial, tangential + force.tangential, axial + force.axial
        about_radial -= height * force.tangential / 1e3
        about_tangential += (height * force.radial - arm * force.axial) / 1e3
    return PinForce(
        radial=radial,
        tangential=tangential,
        axial=axial,
        tilting_radial=about_radial,
        tilting_tangential=about_tangential,
        centrifugal=_centrifugal(train, flow),
    )


def _centrifugal(train: TrainData, flow: PowerFlow) -> float | None:
    """m a w_c^2 of one planet (N)."""
    mass = train.carrier.planet_mass
    if mass is None:
        return None
    turning = flow.speeds.members[train.carrier.name] * math.pi / 30
    return mass * train.centre_distance / 1e3 * turning**2
