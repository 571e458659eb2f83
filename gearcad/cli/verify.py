"""Command `verify`: evidence that the files and figures of a design, or of all rows of a table, are right."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gearcad.cli.group import debug_option
from gearcad.cli.job import json_option, output_option, perform, quiet_option
from gearcad.cli.language import say
from gearcad.core.errors import ParameterError, as_choice

if TYPE_CHECKING:
    from gearcad.verification.baseline import MovedFigure
    from gearcad.verification.result import Verification

_TABLES = (".csv", ".xlsx")

_MOST_TOLD = 20
"""Claims that failed and figures that moved which the screen shows; pages and index.html have all."""


@click.command(short_help="Prove files and figures of DESIGN, a spec or a table: every claim judged by another program.")
@click.argument("design", type=click.Path(path_type=Path))
@output_option
@click.option(
    "--level",
    help="files, strength (with finite elements and rating), or full (CalculiX).  [default: that of [verify], or files]",
)
@click.option("--files", "judged", type=click.Path(path_type=Path), metavar="DIR", help="Judge the files in this folder.")
@click.option("--baseline", type=click.Path(path_type=Path), metavar="DIR|CSV", help="Compare all figures with an earlier run.")
@click.option(
    "--tolerance",
    type=float,
    metavar="X",
    help="Relative change of a figure that is no change.  [default: that of [verify], or 1e-6]",
)
@click.option("--junit", type=click.Path(path_type=Path), metavar="FILE", help="Write the claims as test cases (JUnit XML).")
@click.option("-j", "--jobs", type=int, metavar="N", help="Processes at work on a table.  [default: the cores]")
@click.option("--cluster", metavar="ADDRESS", help="Work on a Dask cluster: tcp://HOST:PORT, or local.")
@json_option
@quiet_option
@debug_option
def verify(
    design: Path,
    output: Path | None,
    level: str | None,
    judged: Path | None,
    baseline: Path | None,
    tolerance: float | None,
    junit: Path | None,
    jobs: int | None,
    cluster: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Make the files of DESIGN, a spec or a design table, and let every claim about them be judged by another program.

    \b
    level files      STEP by Open CASCADE, STL, 3MF and GLB by trimesh, DXF and drawings by ezdxf, each against the exact
                     gear; the outline against a sweep of the tool; inspection sizes, contact ratio, backlash
    level strength   also contact (Hertz, equilibrium, errors), root stress and stiffness (ISO 6336), safeties
    level full       also meshes in other readers, and the deck run by CalculiX, where ccx is installed

    Of a train of pairs each pair is judged, and the assembly of all gears and shafts.

    What nothing judged is named with its reason, and never counts as passed. Writes verify.json, verify.html and verify.pdf
    beside the files; of a table a folder for each row, index.html, results.csv and junit.xml. Exit status 1 if a claim
    failed, a required safety is not reached, or a figure moved from the baseline.
    """
    from gearcad.jobs.verification import Verify
    from gearcad.verification.claims import VerificationLevel, VerificationOptions

    chosen = None if level is None else as_choice("level", level.lower(), VerificationLevel)
    if tolerance is not None:
        VerificationOptions(tolerance=tolerance)
    before = _before(baseline)
    if design.suffix.lower() in _TABLES:
        if judged is not None:
            raise ParameterError("files", str(judged), "must be left out for a table: each row has a folder of its own")
        of_table = baseline is not None and baseline.is_file()
        _verify_table(
            design,
            output,
            chosen,
            before,
            tolerance,
            junit,
            jobs,
            cluster,
            baseline_of_table=of_table,
            as_json=as_json,
            quiet=quiet,
        )
        return
    if baseline is not None and baseline.is_file():
        permitted = "must be a folder with verify.json of an earlier run: a results.csv is the baseline of a table"
        raise ParameterError("baseline", str(baseline), permitted)
    for option, value in (("jobs", jobs), ("cluster", cluster)):
        if value is not None:
            raise ParameterError(option, value, "needs a design table: a spec is one design")
    if judged is not None and not judged.is_dir():
        raise ParameterError("files", str(judged), "must be a folder with the files of the design")
    job = Verify(level=chosen, folder="" if judged is None else str(judged))
    result = perform(job, design, output, show_claims, as_json=as_json, quiet=quiet)
    if junit is not None:
        _write_junit(junit, [job.document(result)])
    moved = _moved(before, _figures([job.document(result)]), [job.document(result)], tolerance)
    _tell_moved(moved)
    if result.passed is False or result.strength is False or moved:
        click.get_current_context().exit(1)


def _before(baseline: Path | None) -> Mapping[str, Any] | None:
    """The figures of the baseline, read before any work; None without one."""
    if baseline is None:
        return None
    from gearcad.verification.baseline import read_figures

    if not baseline.exists():
        raise ParameterError("baseline", str(baseline), "must be a folder of an earlier run, or its results.csv")
    return read_figures(baseline)


def show_claims(name: str, result: Verification) -> None:
    """Print how many claims of each subject passed, those that failed, what was not judged, and the verdict."""
    from gearcad.jobs.verification import Verify
    from gearcad.verification.claims import counted

    for subject in dict.fromkeys(claim.subject for claim in result.claims):
        claims = [claim for claim in result.claims if claim.subject is subject]
        judges = ", ".join(dict.fromkeys(claim.judge for claim in claims))
        counts = ", ".join(f"{count} {words}" for words, count in counted(claims).items() if count)
        say(f"{subject.value:<13}{counts}  ({judges})")
    for claim in result.failed:
        say(f"FAILED {claim.text}", fg="red")
    for reason, whats in _not_judged(result).items():
        say(f"Not judged: {', '.join(whats)}: {reason}", fg="yellow")
    say(Verify().conclusion(name, result), fg="red" if result.failed else "green", bold=True)


def _not_judged(result: Verification) -> dict[str, list[str]]:
    """Return the quantities that were not judged, by the reason, each once."""
    found: dict[str, list[str]] = {}
    for claim in result.not_judged:
        whats = found.setdefault(claim.reason, [])
        if (what := f"{claim.subject.value} {claim.quantity}") not in whats:
            whats.append(what)
    return found


def _verify_table(
    table: Path,
    output: Path | None,
    level: Any,
    before: Mapping[str, Any] | None,
    tolerance: float | None,
    junit: Path | None,
    jobs: int | None,
    cluster: str | None,
    *,
    baseline_of_table: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Verify every row of a table, and write the index of all."""
    import time

    from gearcad.batch import run_table
    from gearcad.cli.batch import report_summary
    from gearcad.cli.job import row_progress
    from gearcad.core.output import staged_files
    from gearcad.jobs.verification import Verify
    from gearcad.report.verification import junit_xml, verification_index
    from gearcad.verification.baseline import RESULTS, VerifiedRows, read_figures

    folder, began = output if output is not None else Path("output") / table.stem, time.perf_counter()
    with row_progress(shown=not quiet) as progress:
        summary = run_table(
            table, folder, [Verify(level=level)], jobs=jobs, cluster=cluster, keep_going=True, progress=progress
        )
    documents = VerifiedRows.of(folder)
    now: Mapping[str, Any] = {}
    if before is not None:
        now = read_figures(folder / RESULTS) if baseline_of_table else _figures(documents)
    moved = _moved(before, now, documents, tolerance)
    with staged_files(folder) as staging:
        (staging / "junit.xml").write_text(junit_xml(documents, summary.errors), encoding="utf-8", newline="\n")
        (staging / "index.html").write_text(
            verification_index(table.stem, documents, summary.errors, moved), encoding="utf-8", newline="\n"
        )
    if junit is not None:
        _write_junit(junit, documents, summary.errors)
    report_summary(summary, time.perf_counter() - began, as_json=as_json, quiet=quiet)
    if not as_json:
        click.echo(f"{folder / 'index.html'}\n{folder / 'junit.xml'}")
    _tell_moved(moved)
    if _tell_failed(documents) or moved or summary.failed or summary.not_run or summary.stopped:
        click.get_current_context().exit(1)


def _tell_failed(documents: Iterable[dict[str, Any]]) -> bool:
    """Print the claims that failed, each with its design, and return whether there are any."""
    failed = [
        f"{document['name']}: {claim['claim']}, {claim['where']}: {claim['quantity']}{f': {reason}' if reason else ''}"
        for document in documents
        for claim in document["claims"]
        if claim["passed"] is False
        for reason in [claim["reason"]]
    ]
    for line in failed[:_MOST_TOLD]:
        say(f"FAILED {line}", fg="red", err=True)
    if len(failed) > _MOST_TOLD:
        say(f"FAILED {len(failed) - _MOST_TOLD} more claims", err=True)
    return bool(failed)


def _write_junit(path: Path, documents: Iterable[dict[str, Any]], errors: Iterable[str] = ()) -> None:
    """Write claims as test cases to a file that the user has named."""
    from gearcad.core.errors import OutputError
    from gearcad.report.verification import junit_xml

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(junit_xml(documents, errors), encoding="utf-8", newline="\n")
    except OSError as error:
        raise OutputError("junit", str(path), f"cannot be written ({error.strerror})") from error


def _figures(documents: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """The figures of each document by the name of its design."""
    from gearcad.verification.baseline import figures_of

    return {str(document["name"]): figures_of(document) for document in documents}


def _moved(
    before: Mapping[str, Any] | None,
    now: Mapping[str, Any],
    documents: Iterable[dict[str, Any]],
    tolerance: float | None,
) -> list[MovedFigure]:
    """Return the quantities that differ from the baseline, the greatest change first.

    Without a tolerance it is that of each design, as its document has it.
    """
    if before is None:
        return []
    from gearcad.verification.baseline import compare, tolerance_of

    return compare(before, now, {str(each["name"]): tolerance_of(each) for each in documents}, tolerance)


def _tell_moved(moved: list[MovedFigure]) -> None:
    """Print the figures that moved most."""
    for each in moved[:_MOST_TOLD]:
        say(f"Moved: {each}", err=True)
    if len(moved) > _MOST_TOLD:
        say(f"Moved: {len(moved) - _MOST_TOLD} more figures", err=True)
