"""Job `shafts`: the shafts of a spec under their loads, and their document shafts.json."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from gearcad.core.errors import SpecError
from gearcad.core.output import json_text, staged_files
from gearcad.core.records import JsonObject, Role, texts
from gearcad.designs.design import read_tables, require_plain_name
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.reader import read_spec
from gearcad.designs.shaft_spec import ShaftArrangement, read_shaft
from gearcad.jobs.job import with_summary
from gearcad.shafts.arrangement import ArrangementResult, ShaftResult, with_stations
from gearcad.version import __version__

_FILE = "shafts.json"


@dataclass(frozen=True)
class ShaftsDone:
    """The result of shafts of a name."""

    name: str
    result: ArrangementResult

    def document(self) -> JsonObject:
        """Return the content of shafts.json."""
        about: JsonObject = {"kind": "shafts", "name": self.name, "gearcad": __version__}
        document = about | self.result.to_dict() | {"not_judged": self.result.not_judged}
        return with_summary(document, texts(self.result.notices))

    def write(self, folder: Path) -> list[Path]:
        """Write shafts.json, all or nothing, and return its path. Raises OutputError."""
        with staged_files(folder) as staging:
            (staging / _FILE).write_text(json_text(self.document()), encoding="utf-8")
        return [folder / _FILE]


def done_shafts(spec: Path | str) -> ShaftsDone:
    """Return what the shafts of a spec do under their loads. Raises SpecError and InputError."""
    found = read_arrangement(spec)
    return ShaftsDone(found.name, result_of(found))


def read_arrangement(path: Path | str) -> ShaftArrangement:
    """Return the shafts of a spec. Raises SpecError and ParameterError."""
    tables, where = read_tables(path)
    if "shaft" in tables or "bearing" in tables:
        require_plain_name(name := Path(path).stem)
        shaft, options = read_shaft(tables, where)
        return ShaftArrangement(name, {"shaft": with_stations(shaft)}, {"shaft": options.speed}, options)
    design = read_spec(path)
    if not isinstance(design, PairDesign) or design.shafts is None:
        permitted = "must have [[shaft]] and [[bearing]], or a pair with [[pinion.shaft]] or [[wheel.shaft]]"
        raise SpecError(f"{where('')}: {permitted}")
    design.loaded("shafts are loaded by it")
    assert design.arrangement is not None
    return design.arrangement


def result_of(found: ShaftArrangement) -> ArrangementResult:
    """Return the result of an arrangement: under the load over the face where there is a mesh, otherwise under its forces."""
    results = {}
    for name, shaft in found.shafts.items():
        state = None if found.mesh is None else found.mesh.state(Role(name))
        results[name] = ShaftResult(shaft.solve() if state is None else state, found.speeds[name], found.options)
    return ArrangementResult(results, None if found.mesh is None else found.mesh.to_dict())
