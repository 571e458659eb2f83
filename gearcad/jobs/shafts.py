"""Job `shafts`: the shafts of a pair, or one by itself, under their loads: deflection, bearing life, load over the face."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from gearcad.core.errors import ParameterError
from gearcad.core.records import JsonObject, Notice, Role
from gearcad.core.runtime import one_thread
from gearcad.designs.keys import DesignKind
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.shaft_spec import ShaftArrangement, ShaftDesign
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import shafts_of_train
from gearcad.jobs.job import ReportedJob, Subject, Writer, as_design
from gearcad.shafts.arrangement import ArrangementResult, ShaftResult
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.core.runtime import Progress
    from gearcad.designs import Design, Inputs
    from gearcad.load import Load
    from gearcad.shafts.face_load import MeshOnShafts

_NO_LOAD = "shafts are loaded by it"


@dataclass(frozen=True, kw_only=True)
class Shafts(ReportedJob[PairDesign | ShaftDesign | TrainDesign, ArrangementResult]):
    """Shafts under their loads. Without `report` there is shafts.json alone."""

    verb = "shafts"
    accepts = (DesignKind.PAIR, DesignKind.SHAFT, DesignKind.TRAIN)
    why = "others have no shafts that bend"
    with_shafts = True

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> ArrangementResult:
        design = self.accepted(design, progress)
        result = result_of(_of_train(design) if isinstance(design, TrainDesign) else _arrangement_of(design))
        result.notices  # noqa: B018 - what they need is computed here, in one thread
        return result

    def document(self, result: ArrangementResult) -> JsonObject:
        """Return reactions, stations, lives and critical speeds of each shaft, and the load over the face of a pair."""
        about: JsonObject = {"kind": self.verb, "name": result.name, "gearcad": __version__}
        return about | result.to_dict() | {"not_judged": result.not_judged}

    def notices(self, result: ArrangementResult) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the least lives and safeties, the greatest deflection and stress, the first critical speed, f_sh, K_Hbeta."""
        return shaft_columns(document)

    def files(self, result: ArrangementResult) -> dict[str, Writer]:
        """Return the document and the report."""
        found: dict[str, Writer] = {"shafts.json": partial(self.write_document, result)}
        return {**found, "shafts.html": partial(_write_report, result, self.head)} if self.report else found


def _arrangement_of(design: PairDesign | ShaftDesign) -> ShaftArrangement:
    """Return the shafts of a pair under its load, or a shaft by itself. Raises ParameterError without shafts or a load."""
    if (found := design.arrangement) is None:
        permitted = "must be described: [[pinion.shaft]] and [[pinion.bearing]], or those of the wheel"
        raise ParameterError("pinion.shaft", None, permitted)
    if isinstance(design, PairDesign):
        design.loaded(_NO_LOAD)
    return found


def _of_train(design: TrainDesign) -> ShaftArrangement:
    """Return the shafts of a train under the forces of their gears. Raises ParameterError without segments and bearings."""
    if (found := shafts_of_train(design)) is None:
        permitted = "must be described: segments, bearings and gears of a [[train.shaft]]"
        raise ParameterError("train.shaft", None, permitted)
    return found


def result_of(found: ShaftArrangement) -> ArrangementResult:
    """Return the result of an arrangement: under the load over the face where there is a mesh, otherwise under its forces."""
    results = _shafts_under(found, found.mesh)
    mesh = found.mesh
    if mesh is not None and found.spectrum:
        bins = [
            (
                each.life,
                _shafts_under(found, replace(mesh, torque=mesh.torque * each.torque) if each.torque else None, each.speed),
            )
            for each in found.spectrum
        ]
        results = {name: replace(own, bins=tuple((share, of[name]) for share, of in bins)) for name, own in results.items()}
    return ArrangementResult(found.name, results, None if found.mesh is None else found.mesh.to_dict())


def _shafts_under(found: ShaftArrangement, mesh: MeshOnShafts | None, speed: float = 1.0) -> dict[str, ShaftResult]:
    """Return the shafts under the load of a mesh, or without one, at a share of their speeds."""
    results = {}
    for name, shaft in found.shafts.items():
        state = None if mesh is None else mesh.state(Role(name))
        own = found.speeds[name] * speed
        results[name] = ShaftResult(shaft.solve() if state is None else state, own, found.options, found.discs.get(name, ()))
    return results


def _write_report(result: ArrangementResult, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report import write_shafts_report

    write_shafts_report(result, result.name, path, head)


def shaft_columns(document: Mapping[str, Any]) -> JsonObject:
    """Return the figures of a shafts.json for one line of a table; None for a life that is not judged or without end."""
    shafts = document["shafts"].values()
    lives = {key: [each[key] for shaft in shafts for each in shaft["bearings"]] for key in ("L10h", "Lnmh")}
    stations = [each for shaft in shafts for each in shaft["stations"]]
    sides = [each[side] for each in stations for side in ("left", "right") if side in each]
    speeds = [speed for shaft in shafts for speed in shaft["critical_speeds"][:1]]
    mesh = document.get("mesh", {})
    return {
        **{key: min((value for value in found if value is not None), default=None) for key, found in lives.items()},
        "deflection": max((each["deflection"][0] ** 2 + each["deflection"][1] ** 2) ** 0.5 for each in stations),
        "equivalent_stress": max(each["equivalent_stress"] for each in sides),
        **{
            key: min((each[key] for shaft in shafts for each in shaft["shoulders"] if each[key] is not None), default=None)
            for key in ("S_D", "S_F")
        },
        "critical_speed": min(speeds, default=None),
        **{key: mesh[name] for key, name in (("f_sh", "f_sh"), ("K_Hbeta", "K_Hbeta_end_of_face")) if name in mesh},
        "warnings": document.get("warnings", []),
    }


def shafts(subject: Subject, load: Load | None = None, **inputs: Unpack[Inputs]) -> ArrangementResult:
    """Return how the shafts of a pair, or a shaft by itself, bend under their loads: reactions, lives, load over the face.

    A pair needs `shafts` (PairShafts) and a load; a design such as `read` gives has its own.

    >>> from gearcad.designs import ShaftDesign
    >>> from gearcad.shafts import ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft
    >>> ends = ShaftBearing(position=0.0, axial_stiffness="rigid"), ShaftBearing(position=300.0)
    >>> force = ShaftForce(position=100.0, force=(0.0, -900.0, 0.0))
    >>> shaft = SteppedShaft(segments=(ShaftSegment(length=300.0, outer_diameter=40.0),), bearings=ends, forces=(force,))
    >>> found = shafts(ShaftDesign(name="plain", shaft=shaft)).shafts["shaft"].state
    >>> [round(float(each[1]), 6) for each in found.reactions]
    [600.0, 300.0]

    Raises ParameterError without shafts or a load.
    """
    return Shafts(report=False).run(as_design(subject, load, **inputs))
