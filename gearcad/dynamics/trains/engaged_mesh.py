"""A mesh whose pair is known under its load: its stiffness is that of its teeth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gearcad.dynamics.trains.members import Mesh
from gearcad.dynamics.trains.mesh_pair import MeshCourse, MeshPair
from gearcad.errors import ParameterError
from gearcad.reprs import concise

__all__ = ["EngagedMesh", "require_known"]


@dataclass(frozen=True, kw_only=True)
class EngagedMesh(Mesh):
    """A mesh of a pair, and the `course` of its stiffness and transmission error: `stiffness` is the mean of the tangent."""

    course: MeshCourse

    __repr__ = concise

    @property
    def teeth_of(self) -> MeshPair:
        """The pair."""
        assert isinstance(self.pair, MeshPair)  # it became one when the mesh was made
        return self.pair

    def pair_document(self) -> dict[str, Any]:
        """As `dynamics.json` has it: N·m on the pinion, N, N/µm, µm, degrees."""
        course, cycle = self.course, self.course.cycle
        return {
            "pair": self.teeth_of.pair.name,
            "stiffness_method": cycle.method,
            "torque": course.torque,
            "driver": course.driver.value,
            "force": cycle.force,
            "mesh_stiffness_mean": cycle.mean,
            "mesh_stiffness_tangent_mean": cycle.tangent_mean,
            "transmission_error_peak_to_peak": cycle.error_peak_to_peak,
            "backlash": self.backlash,
            "damping_ratio": self.damping_ratio,
            "damping": self.damping,
            "phase": self.phase,
            "rounds": course.rounds,
        }

    @property
    def _stiffness_of_pair(self) -> float:
        return self.course.cycle.tangent_mean


def require_known(mesh: Mesh) -> None:
    """Raise ParameterError for a mesh of a pair whose stiffness is not known yet."""
    if mesh.pair is not None and not isinstance(mesh, EngagedMesh):
        permitted = "is not known before the load of its pair: gearcad.dynamics.engaged(train) has it"
        raise ParameterError(f"{mesh.name}.stiffness", None, permitted, "N/µm")
