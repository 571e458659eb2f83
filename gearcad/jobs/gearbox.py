"""Job `planetary` of a gearbox of several planetary sets: what each of its states does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from gearcad.core.errors import ParameterError
from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress, one_thread
from gearcad.designs.design import Design
from gearcad.designs.gearbox_spec import PlanetaryGearboxDesign
from gearcad.designs.keys import DesignKind
from gearcad.dynamics.planetary.gearbox_modes import StateVibration, state_vibration
from gearcad.jobs.job import Job
from gearcad.planetary.gearbox import Gearbox, StateResult
from gearcad.planetary.gearbox_assembly import GearboxPhases
from gearcad.version import __version__


@dataclass(frozen=True, kw_only=True, eq=False)
class GearboxStudy:
    """A gearbox, and the results of its states by their names."""

    gearbox: Gearbox
    states: Mapping[str, StateResult]
    notices: tuple[Notice, ...] = ()
    vibrations: Mapping[str, StateVibration] = field(default_factory=dict)
    why_not: Mapping[str, str] = field(default_factory=dict)
    """Reasons why something is missing, such as "modes"."""

    @cached_property
    def phases(self) -> dict[str, dict[str, GearboxPhases | None]]:
        """Phases of the meshes in each state, where the gears are known."""
        return {name: self.gearbox.phases(each) for name, each in self.states.items()} if self.gearbox.assemblies else {}


@dataclass(frozen=True, kw_only=True)
class PlanetaryGearbox(Job[PlanetaryGearboxDesign, GearboxStudy]):
    """The states of a gearbox: speeds, torques, efficiency. Its document is planetary.json, as that of a planetary train."""

    verb = "planetary"
    accepts = (DesignKind.GEARBOX,)
    why = "others have no states"

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> GearboxStudy:
        """Return the study of a gearbox. Raises GeometryError and SolverError for a state in which it cannot run."""
        accepted = self.accepted(design, progress)
        gearbox = accepted.gearbox
        states = {state.name: gearbox.solve(state) for state in gearbox.states}
        vibrations, why_not = _vibrations(gearbox, states)
        return GearboxStudy(gearbox=gearbox, states=states, notices=accepted.notices, vibrations=vibrations, why_not=why_not)

    def document(self, result: GearboxStudy) -> JsonObject:
        """Return what each state does, by its name."""
        gearbox = result.gearbox
        states = {name: each.to_dict() for name, each in result.states.items()}
        for name, phases in result.phases.items():
            states[name]["phases"] = {mesh: None if each is None else each.to_dict() for mesh, each in phases.items()}
        for name, vibration in result.vibrations.items():
            states[name]["vibration"] = {
                "modes": vibration.modes.to_dict(),
                "response": None if vibration.response is None else vibration.response.to_dict(),
            }
        assembly = {name: each.to_dict() for name, each in gearbox.assemblies.items()}
        for name, bottom in gearbox.bottoms.items():
            assembly[name]["axial_position"] = bottom
        return {
            "kind": self.verb,
            "name": gearbox.name,
            "gearcad": __version__,
            "input": gearbox.input,
            "output": gearbox.output,
            "mesh_efficiency": gearbox.mesh_efficiency,
            "states": states,
            "assembly": assembly or None,
            "why_not": dict(result.why_not),
        }

    def figures(self, document: JsonObject) -> JsonObject:
        """Return ratio and efficiency of each state, its first natural frequency, and its greatest dynamic force."""
        found: JsonObject = {}
        for name, state in document["states"].items():
            found |= {f"{name}.{key}": state[key] for key in ("ratio", "efficiency")}
            if (vibration := state.get("vibration")) is None:
                continue
            above = [each["frequency"] for each in vibration["modes"]["families"] if each["frequency"] > 0]
            found[f"{name}.frequency_1"] = min(above, default=None)
            if (response := vibration["response"]) is not None:
                found[f"{name}.dynamic_force"] = max(each["force"] for each in response["greatest"].values())
        return found | {"warnings": document["warnings"]}

    def notices(self, result: GearboxStudy) -> Sequence[Notice]:
        return result.notices


def _vibrations(gearbox: Gearbox, states: Mapping[str, StateResult]) -> tuple[dict[str, StateVibration], dict[str, str]]:
    """Return modes and vibration of each state, or why there are none."""
    if not gearbox.assemblies:
        return {}, {"assembly": "of the sets only teeth are known: give planets, normal_module and face_width"}
    try:
        return {name: state_vibration(gearbox, each) for name, each in states.items()}, {}
    except ParameterError as error:
        return {}, {"modes": str(error)}
