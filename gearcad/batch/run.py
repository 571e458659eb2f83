"""A run of a design table, from the first fault to the last file: journal, results, summary.

Beside it, columns.csv says what its columns hold.
"""

from __future__ import annotations

import errno
import importlib.util
import pickle
import shutil
import sqlite3
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, Protocol

from filelock import FileLock, Timeout

from gearcad.batch.pool import ClusterLostError, Outcome, Pool, WorkerLostError, open_pool
from gearcad.batch.row import Checked, Record, Status, Task, check_rows, make_row, stages
from gearcad.core.errors import OutputError, SpecError, format_number, require_number
from gearcad.core.output import MARK, UNWRITABLE, has_mark, mark_folder, staged_files, unwritable
from gearcad.core.records import Verdict
from gearcad.core.runtime import Progress
from gearcad.core.symbols import Symbol
from gearcad.designs.cells import Decimal, cell_text, write_csv
from gearcad.designs.table import DesignRow, Table, open_table
from gearcad.designs.variations import column_of_train, column_symbol
from gearcad.jobs.job import Job


@dataclass(frozen=True, kw_only=True)
class BatchSummary:
    """Result of a run: its files, rows by status, a line for each failed row, and the reason if it stopped early.

    `short` of the rows that are ok have a check with a gate that is not passed, or a rating that is not.
    """

    results: tuple[Path, ...]
    ok: int
    failed: int
    not_run: int
    short: int
    errors: tuple[str, ...]
    stopped: str = ""

    @property
    def passed(self) -> bool:
        """Whether every row was made, and no check, rating or verification falls short."""
        return not (self.failed or self.not_run or self.short or self.stopped)


class InterruptedRunError(KeyboardInterrupt):
    """Ctrl-C, and how far the run was: a row that is not finished counts as not run."""

    def __init__(self, summary: BatchSummary) -> None:
        super().__init__()
        self.summary = summary


RESULTS = "results.csv"
COLUMNS = "columns.csv"
PARQUET = "results.parquet"
FILES = (RESULTS, COLUMNS, PARQUET)
"""Files that `write_results` writes; neither a design nor the table itself may have these names."""

_ROWS_PER_GROUP = 300
"""Rows that Parquet holds in memory before it writes: more rows make smaller files, fewer a smaller process."""


class Results(Protocol):
    """Something that yields every row with its record, again on each call."""

    def results(self) -> Iterator[tuple[DesignRow, Record]]: ...


def write_results(journal: Results, folder: Path, workspace: Path, decimal: Decimal = Decimal.POINT) -> list[Path]:
    """Write results.csv and columns.csv, and results.parquet where pyarrow is installed, by way of `workspace`.

    Texts that a spreadsheet would run as a formula get an apostrophe in front. Raises OutputError.
    """
    columns = _columns(journal)
    found = (_cells(row, record) for row, record in journal.results())
    lines = ([cell_text(cells.get(heading), decimal) for heading in columns] for cells in found)
    with staged_files(folder, workspace) as staging:
        write_csv(lines, columns, staging / RESULTS, decimal)
        of_trains = any(heading.startswith("planetary.") for heading in columns)
        explained = map(partial(_explained, column_of_train if of_trains else column_symbol), columns)
        write_csv(explained, _EXPLAINED, staging / COLUMNS, decimal)
        if importlib.util.find_spec("pyarrow") is not None:
            _write_parquet(journal, columns, staging / PARQUET)
        return [folder / name for name in FILES if (staging / name).exists()]


def _groups(row: DesignRow, record: Record) -> tuple[dict[str, Any], ...]:
    """One line under its headings: how the row ended, its files, its inputs, and what is derived.

    What was derived stands in the place of the input it came from, such as "auto".
    """
    states = {
        "name": row.name,
        "status": record.status.value,
        "error": record.error or None,
        "warnings": "; ".join(record.warnings) or None,
        "seconds": record.seconds,
    }
    files = {f"files.{file}": f"{row.name}/{file}" for file in record.files}
    inputs = {key: record.values.get(key, row.values.get(key)) for key in row.columns if key not in ("", "name")}
    derived = {key: value for key, value in record.values.items() if key not in inputs}
    return states, files, inputs, derived


def _cells(row: DesignRow, record: Record) -> dict[str, Any]:
    return {heading: value for group in _groups(row, record) for heading, value in group.items()}


def _columns(journal: Results) -> dict[str, type]:
    """Headings in order, group by group, and the one type (int, float, bool or str) that holds all cells of each.

    Several numbers in a cell are a text.
    """
    columns: list[dict[str, type | None]] = [{}, {}, {}, {}]
    for row, record in journal.results():
        for kinds, cells in zip(columns, _groups(row, record), strict=True):
            for heading, value in cells.items():
                kinds[heading] = _common(kinds.get(heading), None if value is None else type(value))
    return {heading: str if kind in (None, tuple) else kind for kinds in columns for heading, kind in kinds.items()}


def _common(one: type | None, other: type | None) -> type | None:
    """Return the type that can hold the cells of both; None for the type of no cell."""
    if one is None or other is None or one is other:
        return one or other
    return float if {one, other} == {int, float} else str


_EXPLAINED = ("column", "symbol", "unit", "of", "words", "source")


def _explained(symbol_of: Callable[[str], tuple[str, Symbol] | None], heading: str) -> Sequence[str]:
    """The line of columns.csv for a column."""
    if heading.startswith("files."):
        return heading, "", "", "", "path of a file, from the folder of this table", ""
    owner, symbol = symbol_of(heading) or ("", Symbol("", "", "", ""))
    return heading, symbol.symbol, symbol.unit, owner, symbol.words, symbol.source


def _write_parquet(journal: Results, columns: Mapping[str, type], path: Path) -> None:
    import pyarrow
    from pyarrow.parquet import ParquetWriter

    kinds = {int: pyarrow.int64(), float: pyarrow.float64(), bool: pyarrow.bool_(), str: pyarrow.string()}
    schema = pyarrow.schema([(heading, kinds[kind]) for heading, kind in columns.items()])
    lines = (_cells(row, record) for row, record in journal.results())
    with ParquetWriter(path, schema) as writer:
        while group := list(islice(lines, _ROWS_PER_GROUP)):
            arrays = [
                pyarrow.array([_as(kind, cells.get(heading)) for cells in group], kinds[kind])
                for heading, kind in columns.items()
            ]
            writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))


def _as(kind: type, value: Any) -> Any:
    if isinstance(value, tuple):
        return cell_text(value)
    return None if value is None else kind(value)


class Journal:
    """A temporary database that vanishes with the process, however that ends. Not for more than one thread."""

    def __init__(self) -> None:
        self._database = sqlite3.connect("", isolation_level=None)  # "": on disk, without a name
        self._database.execute("PRAGMA journal_mode = OFF")
        self._database.execute("BEGIN")  # and never commit: nobody reads it after us
        self._database.execute(
            "CREATE TABLE rows (number INTEGER PRIMARY KEY, name TEXT, folded TEXT UNIQUE, row BLOB, checked BLOB, record BLOB)"
        )

    def close(self) -> None:
        """Remove the database."""
        self._database.close()

    def add(self, row: DesignRow) -> list[str]:
        """Note a row of the table; faults of its name beside the other names."""
        folded = unicodedata.normalize("NFC", row.name).casefold() or None
        taken = self._execute("SELECT number, name FROM rows WHERE folded = ?", (folded,)).fetchone()
        content = (row.number, row.name, None if taken else folded, pickle.dumps(row))
        self._execute("INSERT INTO rows (number, name, folded, row) VALUES (?, ?, ?, ?)", content)
        said = f"{row.where('name')}: name = {format_number(row.name)}"
        if taken is not None:
            number, name = taken
            same = "has it too" if name == row.name else f"has {format_number(name)}, which some file systems take for the same"
            return [f"{said}: must be unique, for it names a folder; row {number} {same}"]
        if folded in FILES:
            return [f"{said}: must be another one; this is the name of a table of results"]
        return []

    def keep(self, number: int, checked: Checked) -> None:
        """Record the result of the check of a row."""
        self._execute("UPDATE rows SET checked = ? WHERE number = ?", (pickle.dumps(checked), number))

    def finish(self, record: Record) -> None:
        """Note how a row ended."""
        self._execute("UPDATE rows SET record = ?, checked = NULL WHERE number = ?", (pickle.dumps(record), record.number))

    def open_rows(self) -> Iterator[tuple[DesignRow, Checked]]:
        """The rows without a record, in the order of the table, with what their checks have found."""
        last = -1
        query = "SELECT number, row, checked FROM rows WHERE record IS NULL AND number > ? ORDER BY number LIMIT 1"
        while (found := self._execute(query, (last,)).fetchone()) is not None:
            last = found[0]
            yield pickle.loads(found[1]), pickle.loads(found[2]) if found[2] else Checked()

    def results(self) -> Iterator[tuple[DesignRow, Record]]:
        """Every row and its record, in the order of the table."""
        with _writable():
            for number, row, record in self._execute("SELECT number, row, record FROM rows ORDER BY number"):
                yield pickle.loads(row), pickle.loads(record) if record else Record(number=number, status=Status.NOT_RUN)

    def _execute(self, statement: str, values: tuple[Any, ...] = ()) -> sqlite3.Cursor:
        with _writable():
            return self._database.execute(statement, values)


@contextmanager
def _writable() -> Iterator[None]:
    try:
        yield
    except sqlite3.DatabaseError as error:  # the disk for temporary files is full, or was: then the database is in pieces
        raise OutputError("temporary files", "", f"cannot be written ({error}); TMPDIR names their folder") from error


WORKSPACE = ".gearcad-batch"
"""Folder inside the output folder where rows are made; it exists during a run, and after one that was killed."""

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
) -> BatchSummary:
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

    def _chunks(self, table: Table, faults: dict[int, list[str]]) -> Iterator[list[DesignRow]]:
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

    def summary(self, results: list[Path]) -> BatchSummary:
        """Return the summary of the run for the user."""
        states = dict.fromkeys(Status, 0)
        errors, short = [], 0
        for _, record in self.journal.results():
            states[record.status] += 1
            short += falls_short(record.values)
            if record.error:
                errors.append(record.error)
        return BatchSummary(
            results=tuple(results),
            ok=states[Status.OK],
            failed=states[Status.FAILED],
            not_run=states[Status.NOT_RUN],
            short=short,
            errors=tuple(errors),
            stopped=self.stopped,
        )


def falls_short(values: Mapping[str, Any]) -> bool:
    """Return whether a check, a rating or a verification of a row ends its command with exit status 1."""
    if any(values.get(key) is False for key in ("check.passed", "verify.passed", "verify.strength")):
        return True
    return values.get("rate.passed", True) is not True and values.get("rate.strength") != Verdict.NOT_ASKED.value


def _checked(outcome: Outcome[list[DesignRow], list[Checked]]) -> list[Checked]:
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
    """Yield a folder on the file system of `folder` where files are written until they are finished, for one run at a time.

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
