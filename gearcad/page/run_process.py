"""Process of one run: one job on the text of a spec, its progress, and its files in a folder.

It reads one line of JSON and answers by lines of JSON:
{"expected": ...}, {"step", "done", "whole"}, of searches {"found": ...}, and last {"result": ...} or {"error": "the line of the
command line"}.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from gearcad.batch.pool import close_workers, isolated, own_worker
from gearcad.core.child_process import become_child, end_with_input
from gearcad.core.errors import GearcadError, out_of_memory, printable, shown
from gearcad.core.records import JsonObject
from gearcad.core.runtime import Expected
from gearcad.designs.design import Design, files_only_in, tables_of_text
from gearcad.designs.keys import DesignKind
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.reader import design_from_tables
from gearcad.designs.train_designs import TrainDesign
from gearcad.jobs.job import Job
from gearcad.solids import Format


@dataclass(frozen=True, kw_only=True)
class RunKind:
    """A job with its options; `report` is the file to read, `taken` the pattern of the files to download.

    `takes` says which designs it accepts, of the kinds that the job accepts, or of `kinds` where the run makes another design
    of what is given. `mesh` is the number of the mesh of a planetary train that the run is about. `shown` gives what the page
    shows of a result and its document.
    """

    job: Callable[[], Job[Any, Any]]
    report: str = ""
    taken: str = "*"
    made: Callable[[Design], Design] = lambda design: design
    takes: Callable[[Design], bool] = lambda design: True
    foreseen: bool = True
    """Whether the page asks what the run would take. gmsh counts the elements of a mesh: never in a thread of the server."""

    kinds: tuple[DesignKind, ...] = ()
    mesh: int | None = None
    shown: Callable[[Any, JsonObject], JsonObject | None] | None = None

    def accepts(self, design: Design) -> bool:
        """Return whether this job takes designs of a kind."""
        return design.kind in (self.kinds or self.job().accepts) and self.takes(design)

    def expected(self, design: Design) -> Expected | None:
        """Return what a run takes; of a mesh of a train with roughly its load, which sharing among planets may raise."""
        of = self.made(design) if self.mesh is None else mesh_pair(design, self.mesh, shared=False)
        return self.job().expected(of)


def _check(model: str) -> Callable[[], Job[Any, Any]]:
    def job() -> Job[Any, Any]:
        from gearcad.jobs.strength import Check

        return Check(model=model)

    return job


def _stiffness() -> Job[Any, Any]:
    from gearcad.jobs.strength import Stiffness

    return Stiffness()


def _dynamics() -> Job[Any, Any]:
    from gearcad.jobs.dynamics import Dynamics

    return Dynamics()


def _planetary() -> Job[Any, Any]:
    from gearcad.jobs.planetary import Planetary

    return Planetary()


def _shafts() -> Job[Any, Any]:
    from gearcad.jobs.shafts import Shafts

    return Shafts()


def _has_shafts(design: Design) -> bool:
    if isinstance(design, TrainDesign):
        from gearcad.designs.train_meshes import has_shafts

        return has_shafts(design)
    return not isinstance(design, PairDesign) or design.shafts is not None


def _rate() -> Job[Any, Any]:
    from gearcad.jobs.strength import Rate

    return Rate()


def _mesh() -> Job[Any, Any]:
    from gearcad.jobs.mesh import Mesh

    return Mesh()


def _verify() -> Job[Any, Any]:
    from gearcad.jobs.verification import Verify

    return Verify()


def _data() -> Job[Any, Any]:
    from gearcad.jobs.job import Data

    return Data()


def _build(*formats: str) -> Callable[[], Job[Any, Any]]:
    def job() -> Job[Any, Any]:
        from gearcad.jobs.build import Build

        return Build(formats=formats)  # type: ignore[arg-type]

    return job


def _draw(*formats: str) -> Callable[[], Job[Any, Any]]:
    def job() -> Job[Any, Any]:
        from gearcad.jobs.draw import Draw

        return Draw(formats=formats)  # type: ignore[arg-type]

    return job


def _with_bodies(design: Design) -> Design:
    """The face load factor by the load distribution of solid bodies."""
    from gearcad.rating.options import RatingOptions

    if not isinstance(design, PairDesign):
        return design
    return replace(design, rating=replace(design.rating or RatingOptions(), face_load_factor="fe"))


def _is_pair(design: Design) -> bool:
    return isinstance(design, PairDesign)


def mesh_pair(design: Design, mesh: int, *, shared: bool = True) -> Design:
    """The pair of a mesh of a planetary train, with the load that one planet carries, as the files of `planetary` have it.

    Without `shared` the load sharing is not computed, which takes seconds.
    """
    if not isinstance(design, PlanetaryDesign):
        return design
    from gearcad.designs.spec_writers import MeshPairs
    from gearcad.jobs.planetary import Planetary

    sharing = Planetary(report=False).run(design).study.sharing if shared else None
    pairs = MeshPairs(design=design, computed_factor=None if sharing is None else sharing.mesh_load_factor)
    return pairs.designs[design.train.meshes[mesh].name]


def _loaded(design: Design) -> bool:
    return isinstance(design, PlanetaryDesign) and design.load is not None


def _shown_check(result: Any, document: JsonObject) -> JsonObject | None:
    from gearcad.page.shown_results import shown_check

    return shown_check(result, document)


def _shown_dynamics(result: Any, document: JsonObject) -> JsonObject | None:
    from gearcad.page.shown_results import shown_dynamics

    return shown_dynamics(result, document)


def _any(_design: Design) -> bool:
    return True


def _has_bodies(design: Design) -> bool:
    """Return whether a design has solid bodies in contact: a rack has none."""
    return design.kind is not DesignKind.RACK_PAIR


def _check_run(model: str) -> RunKind:
    return RunKind(job=_check(model), report="report.html", shown=_shown_check, takes=_has_bodies if model == "3d" else _any)


def _mesh_run(model: str, mesh: int) -> RunKind:
    """A check of one mesh of a planetary train."""
    return replace(
        _check_run(model), made=lambda design: mesh_pair(design, mesh), takes=_loaded, kinds=(DesignKind.PLANETARY,), mesh=mesh
    )


ANALYSES = {
    "check-2d": _check_run("2d"),
    "check-3d": _check_run("3d"),
    "check-2d-first": _mesh_run("2d", 0),
    "check-2d-second": _mesh_run("2d", 1),
    "check-3d-first": _mesh_run("3d", 0),
    "check-3d-second": _mesh_run("3d", 1),
    "rate": RunKind(job=_rate, report="rate.html"),
    "rate-fe": RunKind(job=_rate, report="rate.html", made=_with_bodies, takes=_is_pair),
    "stiffness": RunKind(job=_stiffness, report="stiffness.html"),
    "dynamics": RunKind(job=_dynamics, report="dynamics.html", shown=_shown_dynamics),
    "planetary": RunKind(job=_planetary, report="planetary.html"),
    "shafts": RunKind(job=_shafts, report="shafts.html", takes=_has_shafts),
    "mesh": RunKind(job=_mesh, foreseen=False),
    "verify": RunKind(job=_verify, report="verify.html"),
}
"""Jobs that solve, in the order in which users need them."""

DOWNLOADS: dict[str, RunKind] = {
    **{each.value: RunKind(job=_build(each.value), taken=f"*.{each.value}") for each in Format if each is not Format.PNG},
    "drawing-pdf": RunKind(job=_draw("pdf"), taken="drawing.pdf"),  # which has all sheets
    "drawing-dxf": RunKind(job=_draw("dxf"), taken="*.dxf"),
    "drawing-svg": RunKind(job=_draw("svg"), taken="*.svg"),
    "data": RunKind(job=_data, taken="data.json"),
}
"""Kinds of runs that make files for download: every format of solids, whose pictures the page has already, and drawings."""

RUNS = ANALYSES | DOWNLOADS


def design_of(text: str, name: str, folder: Path) -> Design:
    """The design of a text, called `name` where it says no other; files that it names are in `folder`. Raises SpecError."""
    with files_only_in(folder):
        tables, where = tables_of_text(text, f"{name}.toml", folder)
        return design_from_tables(tables, where=where, default_name=name)


_LONGEST = 120.0
"""Time (s) after which a run is stopped."""

_NICENESS = 5
"""Niceness of a run's process, so that the page itself comes first."""

_EXECUTOR = ThreadPoolExecutor(1, thread_name_prefix="gearcad-aside", initializer=own_worker)

Found = TypeVar("Found")


async def result_in_process(find: Callable[[Design], Found], design: Design) -> Found:
    """Return the result of a module's function for a design, computed in another process, one at a time for all sessions.

    Raises the errors of the function, and WorkerLostError if its process has ended.
    """
    found: Found = await asyncio.get_running_loop().run_in_executor(
        _EXECUTOR, isolated, _low_priority_result, (find, design), _LONGEST
    )
    return found


def value_in_process(find: Callable[[Any], Found], asked: Any) -> Found:
    """Return what a module's function finds, computed in the other process; for a thread of the server, which waits for it.

    Raises the errors of the function, WorkerLostError if its process has ended, RuntimeError once the server ends.
    """
    found: Found = _EXECUTOR.submit(isolated, _low_priority_result, (find, asked), _LONGEST).result()
    return found


def stop_process() -> None:
    """Stop the computation in the other process when the server ends."""
    _EXECUTOR.shutdown(wait=False, cancel_futures=True)
    close_workers()


def _low_priority_result(asked: tuple[Callable[[Any], Any], Any]) -> Any:
    """Run a function on a design, or what else it takes, with low priority, in the process beside the server."""
    with suppress(AttributeError, OSError):
        os.setpriority(os.PRIO_PROCESS, 0, _NICENESS)
    find, of = asked
    return find(of)


_BETWEEN = 0.1
"""Seconds between two lines of progress in one step."""

_LARGEST_FILE = 2 << 30
"""Bytes that one file of a result can have."""


_LONGEST_FAULT = 500


@dataclass(frozen=True, kw_only=True)
class RunRequest:
    """A run: its kind, the text and name of the design, the folder of files that it names, and where results go.

    `options` are those of a search.
    """

    kind: str
    text: str
    name: str
    folder: str
    into: str
    options: Mapping[str, Any] = field(default_factory=dict)

    def line(self) -> bytes:
        """Return the request as a line of JSON."""
        return json.dumps(vars(self)).encode() + b"\n"


def serve() -> None:
    """Do the run that stands on stdin."""
    serve_run(_run)


def serve_run(run: Callable[[RunRequest, Teller], dict[str, Any]]) -> None:
    """Do the run that stands on stdin by a function; the closing of stdin ends it, as nobody waits for it any more."""
    tell = Teller(become_child())
    asked = RunRequest(**json.loads(sys.stdin.buffer.readline()))
    end_with_input(sys.stdin.buffer.read, 1)
    _bound()
    tell(**_outcome(run, asked, tell))


def _bound() -> None:
    """Set the limits that the system can enforce: size of a file, low priority, and ending first if memory runs out."""
    with suppress(AttributeError, OSError):
        os.nice(_NICENESS)
    with suppress(ImportError, ValueError, OSError):  # Windows has no limits
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (_LARGEST_FILE, _LARGEST_FILE))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with suppress(OSError):  # Linux only
        Path("/proc/self/oom_score_adj").write_text("1000", encoding="ascii", newline="\n")


def _outcome(run: Callable[[RunRequest, Teller], dict[str, Any]], asked: RunRequest, tell: Teller) -> Mapping[str, Any]:
    """The last line: what came of it, or the error as the command line prints it."""
    try:
        return {"result": run(asked, tell)}
    except GearcadError as error:
        return {"error": printable(" ".join(str(error).split("\n")))}
    except MemoryError as error:
        return {"error": out_of_memory(error)}
    except Exception as error:
        what = shown(" ".join(f"{type(error).__name__}: {error}".split()), _LONGEST_FAULT)
        return {"error": f"unexpected {what} (a fault of gearcad: please report it)"}


def _run(asked: RunRequest, tell: Teller) -> dict[str, Any]:
    kind = RUNS[asked.kind]
    design = kind.made(design_of(asked.text, asked.name, Path(asked.folder)))
    job = kind.job()
    expected = job.expected(design)
    if expected is not None:
        tell(expected={"seconds": expected.seconds, "memory": expected.memory})
    result = job.run(design, tell.progress)
    files = job.headed(design).write(result, Path(asked.into), tell.progress)
    from gearcad.page.shown_results import write_shown

    if kind.shown is not None and (content := kind.shown(result, job.document(result))) is not None:
        write_shown(content | {"mesh": kind.mesh, "name": design.name}, Path(asked.into))
    return {
        "name": design.name,
        "conclusion": job.conclusion(design.name, result),
        "figures": job.figures(job.document(result)),
        "notices": [str(notice) for notice in job.notices(result)],
        "files": [file.name for file in files],
    }


class Teller:
    """Writes lines of JSON to the parent."""

    def __init__(self, fd: int) -> None:
        self._fd = fd
        self._step, self._last = "", 0.0

    def __call__(self, **content: Any) -> None:
        line = json.dumps(content, default=_plain).encode() + b"\n"
        with suppress(BrokenPipeError):
            while line:
                line = line[os.write(self._fd, line) :]

    def progress(self, step: str, done: float, whole: float) -> None:
        """A Progress: a line for each step, and now and then within it."""
        now = time.monotonic()
        if step != self._step or now - self._last >= _BETWEEN:
            self._step, self._last = step, now
            self(step=step, done=float(done), whole=float(whole))


def _plain(value: Any) -> Any:
    """Numbers of numpy as JSON has them."""
    return value.tolist() if hasattr(value, "tolist") else str(value)
