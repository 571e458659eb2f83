"""Job `planetary`: the study of a planetary train at its load."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple, Unpack, overload

from gearcad.core.errors import ParameterError, require_switch
from gearcad.core.quantities import with_assumed
from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress, one_thread
from gearcad.designs import Design, DesignKind, Inputs, PlanetaryDesign
from gearcad.designs.gearbox_spec import PlanetaryGearboxDesign
from gearcad.designs.spec_writers import MeshPairs
from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy, study_document
from gearcad.dynamics.planetary.planetary_study import study_planetary
from gearcad.jobs.gearbox import GearboxStudy, PlanetaryGearbox
from gearcad.jobs.job import Data, ReportedJob, Writer, as_design
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.gearbox import Gearbox
from gearcad.version import __version__

__all__ = ["Planetary", "Studied", "planetary"]

_FIGURES = "ratio efficiency efficiency_back planet_speed_relative".split()
"""Values that a line of a table takes from the document unchanged."""

_MOST_FREQUENCIES = 3
"""Natural frequencies above 0 that a line of a table has."""


class Studied(NamedTuple):
    """A design, and the study of its train."""

    design: PlanetaryDesign
    study: PlanetaryStudy


@dataclass(frozen=True, kw_only=True)
class Planetary(ReportedJob[PlanetaryDesign, Studied]):
    """The study of a planetary train, with the specs of its meshes for all that takes pairs; its `response` if asked for."""

    verb = "planetary"
    accepts = (DesignKind.PLANETARY,)
    why = "only planets go round"

    response: bool = False

    def __post_init__(self) -> None:
        require_switch("response", self.response)

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> Studied:
        design = self.accepted(design, progress)
        study = study_planetary(
            design.train,
            design.load,
            design.speeds,
            material=design.material,
            dynamics=design.dynamics,
            rating=design.rating,
            response=self.response,
            progress=progress,
        )
        return Studied(replace(design, load=study.load, speeds=study.given_speeds), study)

    def document(self, result: Studied) -> JsonObject:
        """Return the content of planetary.json."""
        head = {"kind": self.verb, "name": result.design.name, "gearcad": __version__}
        return with_assumed(head | study_document(result.study))

    def notices(self, result: Studied) -> Sequence[Notice]:
        return result.study.notices

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the figures for one line of a table.

        They are ratio, efficiencies, speeds and torques, K_gamma, torsional stiffness and the first natural frequencies.
        """
        if "states" in document:
            return PlanetaryGearbox().figures(document)
        found = {name: document[name] for name in _FIGURES}
        for name, member in document["members"].items():
            found |= {f"members.{name}.{key}": member[key] for key in ("speed", "torque")}
        found |= {f"mesh_stiffness.{name}": mesh["mean"] for name, mesh in document["mesh_stiffness"].items()}
        if (sharing := document["load_sharing"]) is not None:
            found["mesh_load_factor"] = sharing["mesh_load_factor"]
        if (torsion := document["torsional_stiffness"]) is not None:
            found["torsional_stiffness"] = torsion["stiffness"]
        above = [each["frequency"] for each in document["frequencies"] or () if each["frequency"] > 0]
        found |= {f"frequency_{number}": each for number, each in enumerate(above[:_MOST_FREQUENCIES], 1)}
        return found | {"warnings": document["warnings"]}

    def files(self, result: Studied) -> dict[str, Writer]:
        """Return the report, both documents, and the specs of the meshes."""
        return {
            **({"planetary.html": partial(_write_report, result, self.head)} if self.report else {}),
            "data.json": partial(Data().write_document, result.design),
            "planetary.json": partial(self.write_document, result),
            **dict(_specs(result)),
        }


def _write_report(result: Studied, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report import write_planetary_report

    write_planetary_report(result.study, result.design.name, path, head)


def _specs(result: Studied) -> Iterator[tuple[str, Writer]]:
    """Yield file name and writer of the spec of each mesh and stage, with the load that it carries."""
    sharing, flow = result.study.sharing, result.study.flow
    design = result.design if flow is not None else replace(result.design, load=None)
    pairs = MeshPairs(design=design, computed_factor=None if sharing is None else sharing.mesh_load_factor)
    for name, text in pairs.texts.items():
        yield name, partial(_write_text, text)


def _write_text(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")


@overload
def planetary(subject: PlanetaryGearboxDesign | Gearbox) -> GearboxStudy: ...  # type: ignore[overload-overlap]


@overload
def planetary(
    subject: Design | PlanetaryTrain,
    load: TrainLoad | None = None,
    *,
    speeds: Mapping[str, float] | None = None,
    response: bool = False,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> PlanetaryStudy: ...


def planetary(
    subject: Design | PlanetaryTrain | Gearbox,
    load: TrainLoad | None = None,
    *,
    speeds: Mapping[str, float] | None = None,
    response: bool = False,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> PlanetaryStudy | GearboxStudy:
    """Return the speeds, torques, efficiency, phases, forces, load sharing, stiffness and natural modes of a planetary train at
    its load.

    `speeds` {member: rpm}: of a differential, the second speed beside that of the input in `load` (TrainLoad). `material`,
    `dynamics` (DynamicsOptions: the method of the mesh stiffness) and `rating`, as load and speeds, stand in place of those of
    a design. With `response` the loads of the meshes over speed are there too, which may take minutes. What cannot be had
    without a load, a speed or a mass is None, and `why_not` of the result says why.

    Of a gearbox of several sets (Gearbox, or a design of one) it returns the results of all states; nothing else is taken with
    it. Raises ParameterError for what is no planetary train, and for speeds that contradict each other.
    """
    if isinstance(subject, Gearbox):
        subject = PlanetaryGearboxDesign(name=subject.name, gearbox=subject)
    if isinstance(subject, PlanetaryGearboxDesign):
        beside = {"load": load, "speeds": speeds, **inputs}
        if given := [name for name, value in beside.items() if value is not None]:
            raise ParameterError(given[0], beside[given[0]], "must be left out: the states of a gearbox have no load")
        return PlanetaryGearbox().run(subject, progress)
    design = as_design(subject, load, **inputs)
    if speeds is not None and not isinstance(speeds, Mapping):
        raise ParameterError("speeds", speeds, 'must be speeds by the names of members, such as {"ring": 0.0}')
    if speeds is not None and isinstance(design, PlanetaryDesign):
        design = replace(design, speeds=dict(speeds))
    return Planetary(response=response).run(design, progress).study
