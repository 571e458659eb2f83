"""A design table from the first fault to the last file."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from itertools import islice
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from gearcad.batch.journal import Journal
from gearcad.batch.pool import ClusterLostError, Outcome, Pool, open_pool
from gearcad.batch.results import FILES, Decimal, write_results
from gearcad.batch.row import Checked, Record, Status, Task, check_rows, make_row
from gearcad.batch.stages import stages
from gearcad.batch.summary import InterruptedRunError, Summary
from gearcad.batch.worker import WorkerLostError
from gearcad.designs.table import Row, Table, open_table
from gearcad.errors import OutputError, SpecError, require_number
from gearcad.jobs.job import Job
from gearcad.output import MARK, UNWRITABLE, has_mark, mark_folder, unwritable
from gearcad.progress import Progress
from gearcad.verdict import Verdict

__all__ = ["falls_short", "run_table"]

WORKSPACE = ".gearcad-batch"
"""Folder inside the output folder where rows grow; it is there during a run, and after one that was killed."""

_LOCK = "lock"

_ROWS_PER_CHECK = 50
_CHECK_SECONDS = 600.0
_LONGEST_LIMIT = 1e6


def run_table(
    path: Path | str,
    folder: Path,
    wanted: Sequence[Job[Any, Any]],
    *,
    jobs: int | None = None,
    cluster: str | None = None,
    time_limit: float = 600.0,
    fresh: bool = False,
    keep_going: bool = False,
    decimal: Decimal = Decimal.POINT,
    progress: Progress | None = None,
) -> Summary:
    """Do the `wanted` jobs on every row of the design table at `path`, each row in a folder of its own inside `folder`.

    Their documents and the files of `build` are kept there, and the table of results has their figures.

    First all rows are checked; if any is at fault nothing is made, unless `keep_going`. What a former run has made of the
    same inputs by the same gearcad stays, unless `fresh`. A row gets `time_limit` (s). `jobs` and `cluster` are those of
    `open_pool`. Raises SpecError with one line per fault, ParameterError, OutputError for a folder that cannot be written, and
    InterruptedRunError after Ctrl-C, when the results of what there is are written.
    """
    jobs_of_row = stages(wanted)
    require_number("time_limit", time_limit, "s", above=0, at_most=_LONGEST_LIMIT)
    table = open_table(path)
    if table.path.resolve() in [(folder / name).resolve() for name in FILES]:
        raise OutputError("output", str(folder), f"has the table itself as its {table.path.name}; give another folder")
    with closing(Journal()) as journal, open_pool(jobs, cluster) as pool:
        run = _Run(journal, pool, progress)
        faults = run.check(table)
        if not run.total:
            raise SpecError(f"{table.path}: has a heading but no design; add a row with a name for each gear or pair")
        if faults and not keep_going:
            raise SpecError("\n".join(faults))
        with _workspace(folder) as workspace:
            target = workspace.parent
            tasks = (Task(row, jobs_of_row, target, workspace, fresh, checked) for row, checked in journal.open_rows())
            try:
                run.make(tasks, time_limit)
            except ClusterLostError as error:
                run.stopped = str(error)
            except BaseException as error:  # a run that is cut short too tells what it has
                pool.stop()
                results = run.write_results(folder, workspace, decimal)
                if isinstance(error, KeyboardInterrupt):
                    raise InterruptedRunError(run.summary(results)) from None
                raise
            pool.stop()
            return run.summary(run.write_results(folder, workspace, decimal))


class _Run:
    """One run: the journal, the pool, and the count."""

    def __init__(self, journal: Journal, pool: Pool, progress: Progress | None) -> None:
        self.journal = journal
        self.pool = pool
        self.progress = progress
        self.total = 0
        self.done = 0
        self.failed = 0
        self.stopped = ""

    def check(self, table: Table) -> list[str]:
        """Note every row in the journal; the faults of all of them in the order of the table. A row at fault has failed."""
        faults: dict[int, list[str]] = {}
        for outcome in self.pool.run(check_rows, self._chunks(table, faults), _CHECK_SECONDS):
            for row, checked in zip(outcome.argument, _checked(outcome), strict=True):
                # The name's own fault comes first; that of its place among the others next.
                if checked.faults or row.number in faults:
                    faults[row.number] = [*checked.faults, *faults.get(row.number, ())]
                else:
                    self.journal.keep(row.number, checked)
            self.done += len(outcome.argument)
            self.tell("checking", len(faults), 0)
        for number, lines in faults.items():
            self.journal.finish(Record(number=number, status=Status.FAILED, error="; ".join(lines)))
        self.done = self.failed = len(faults)
        return [line for number in sorted(faults) for line in faults[number]]

    def _chunks(self, table: Table, faults: dict[int, list[str]]) -> Iterator[list[Row]]:
        rows = table.rows()
        while chunk := list(islice(rows, _ROWS_PER_CHECK)):
            for row in chunk:
                if found := self.journal.add(row):
                    faults[row.number] = found
            self.total += len(chunk)
            yield chunk

    def make(self, tasks: Iterator[Task], time_limit: float) -> None:
        """Make the rows until all are done, or one finds that no other can be."""
        self.tell("making", self.failed, self.total)
        for outcome in self.pool.run(make_row, tasks, time_limit):
            record = _record(outcome)
            if record.stop:
                self.stopped = record.error
                return
            self.journal.finish(record)
            self.done += 1
            self.failed += record.status is Status.FAILED
            self.tell("making", self.failed, self.total)

    def tell(self, phase: str, failed: int, whole: int) -> None:
        """Say how many rows are done of all there are, 0 where that is not known yet, and how many of them failed."""
        if self.progress is not None:
            self.progress(f"{phase}, {failed} failed", self.done, whole)

    def write_results(self, folder: Path, workspace: Path, decimal: Decimal) -> list[Path]:
        """The table of results; where even that cannot be written, the run says so."""
        try:
            return write_results(self.journal, folder, workspace, decimal)
        except OutputError as error:
            self.stopped = self.stopped or str(error)
            return []

    def summary(self, results: list[Path]) -> Summary:
        """What to tell the user."""
        states = dict.fromkeys(Status, 0)
        errors, short = [], 0
        for _, record in self.journal.results():
            states[record.status] += 1
            short += falls_short(record.values)
            if record.error:
                errors.append(record.error)
        return Summary(
            results=tuple(results),
            ok=states[Status.OK],
            failed=states[Status.FAILED],
            not_run=states[Status.NOT_RUN],
            short=short,
            errors=tuple(errors),
            stopped=self.stopped,
        )


def falls_short(values: Mapping[str, Any]) -> bool:
    """Return whether a check or a rating of a row ends its command with exit status 1."""
    if values.get("check.passed") is False:
        return True
    return values.get("rate.passed", True) is not True and values.get("rate.strength") != Verdict.NOT_ASKED.value


def _checked(outcome: Outcome[list[Row], list[Checked]]) -> list[Checked]:
    try:
        return outcome.future.result()
    except WorkerLostError:
        return check_rows(outcome.argument)  # it did not die of this: checking calls no kernel


def _record(outcome: Outcome[Task, Record]) -> Record:
    row = outcome.argument.row
    try:
        return outcome.future.result()
    except WorkerLostError as error:
        text = f"{row.where('')}: {error}"
    except Exception as error:  # Dask has errors of its own
        text = f"{row.where('')}: " + " ".join(f"{type(error).__name__}: {error}".split())
    return Record(number=row.number, status=Status.FAILED, error=text)


@contextmanager
def _workspace(folder: Path) -> Iterator[Path]:
    """A folder on the file system of `folder` where files grow until they are finished, for one run at a time.

    Raises OutputError if `folder` cannot be written, or if another run is at it.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        workspace = folder.resolve() / WORKSPACE
        for path in (workspace, workspace / _LOCK):
            if path.is_symlink():  # it would be cleared, or emptied, where it leads
                raise OSError(errno.ELOOP, f"{path.relative_to(folder.resolve())} is a link; remove it")
        workspace.mkdir(exist_ok=True)
        if not has_mark(workspace) and any(path.is_dir() for path in workspace.iterdir()):
            raise OSError(errno.EEXIST, f"{WORKSPACE} there has no mark of gearcad, so it is not cleared; move it away")
        lock = FileLock(workspace / _LOCK)
        lock.acquire(blocking=False)
        if not (workspace / _LOCK).exists():  # its last holder has removed it since
            raise Timeout(lock.lock_file)
        mark_folder(workspace)
    except Timeout as error:
        raise OutputError("output", str(folder), "is in use by another gearcad batch; wait for its end") from error
    except UNWRITABLE as error:
        raise unwritable(folder, error) from error
    try:
        _clear(workspace)
        yield workspace
    finally:
        _clear(workspace)
        with suppress(OSError):  # while it is ours: once released it may be that of the next run
            (workspace / MARK).unlink(missing_ok=True)
            (workspace / _LOCK).unlink(missing_ok=True)
        lock.release()
        with suppress(OSError):
            workspace.rmdir()


def _clear(workspace: Path) -> None:
    """Remove what a killed run has left."""
    with suppress(FileNotFoundError):  # somebody has removed the whole folder
        for path in workspace.iterdir():
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
