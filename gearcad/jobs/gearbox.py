"""Job `planetary` of a gearbox of several planetary sets: what each of its states does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gearcad.core.records import JsonObject
from gearcad.core.runtime import Progress, one_thread
from gearcad.designs.design import Design
from gearcad.designs.gearbox_spec import PlanetaryGearboxDesign
from gearcad.designs.keys import DesignKind
from gearcad.jobs.job import Job
from gearcad.planetary.gearbox import Gearbox, StateResult
from gearcad.version import __version__


@dataclass(frozen=True, kw_only=True, eq=False)
class GearboxStudy:
    """A gearbox, and the results of its states by their names."""

    gearbox: Gearbox
    states: Mapping[str, StateResult]


@dataclass(frozen=True, kw_only=True)
class PlanetaryGearbox(Job[PlanetaryGearboxDesign, GearboxStudy]):
    """The states of a gearbox: speeds, torques, efficiency. Its document is planetary.json, as that of a planetary train."""

    verb = "planetary"
    accepts = (DesignKind.GEARBOX,)
    why = "others have no states"

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> GearboxStudy:
        """Return the study of a gearbox. Raises GeometryError and SolverError for a state in which it cannot run."""
        gearbox = self.accepted(design, progress).gearbox
        return GearboxStudy(gearbox=gearbox, states={state.name: gearbox.solve(state) for state in gearbox.states})

    def document(self, result: GearboxStudy) -> JsonObject:
        """Return what each state does, by its name."""
        gearbox = result.gearbox
        return {
            "kind": self.verb,
            "name": gearbox.name,
            "gearcad": __version__,
            "input": gearbox.input,
            "output": gearbox.output,
            "mesh_efficiency": gearbox.mesh_efficiency,
            "states": {name: each.to_dict() for name, each in result.states.items()},
        }
