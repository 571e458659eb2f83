"""Verbs `export` and `import`: a gear or a pair as a file that other programs for drives read, and specs of such a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from gearcad.core.errors import ParameterError
from gearcad.core.output import staged_files
from gearcad.jobs.job import Subject, as_design, with_summary
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.core.records import JsonObject
    from gearcad.exchange.rexs_export import RexsExport
    from gearcad.exchange.rexs_import import RexsImport

__all__ = ["export_rexs", "import_rexs", "write_export", "write_import"]


def export_rexs(subject: Subject) -> RexsExport:
    """Return the file of REXS 1.6 for a gear, a pair, or the design of one: its text, and a line for each key it keeps aside.

    >>> from gearcad import Gear
    >>> found = export_rexs(Gear(teeth=20, normal_module=2, face_width=20))
    >>> "number_of_teeth" in found.text
    True

    Raises ParameterError for another kind of design.
    """
    from gearcad.exchange.rexs_export import export_rexs as exported

    return exported(as_design(subject))


def import_rexs(path: Path | str) -> RexsImport:
    """Return the specs of a file of REXS (.rexs, versions 1.0 to 1.7): one for each cylindrical stage, or for each gear.

    Each has its text, its design, and lines about what was left out or assumed. Raises SpecError, one line that names the file.
    """
    from gearcad.exchange.rexs_import import import_rexs as imported

    return imported(path)


def export_document(result: RexsExport) -> JsonObject:
    """Return what `gearcad export --json` prints."""
    from gearcad.exchange.rexs_attributes import VERSION

    head = {"kind": "export", "name": result.name, "gearcad": __version__, "format": "rexs", "version": VERSION}
    return with_summary(head | {"kept": list(result.kept)})


def import_document(result: RexsImport) -> JsonObject:
    """Return what `gearcad import --json` prints; its warnings are the lines of the file and of each spec."""
    head = {"kind": "import", "file": result.file, "gearcad": __version__, "format": "rexs"}
    specs = [{"name": each.name, "kind": each.design.kind.value, "told": list(each.told)} for each in result.specs]
    told = [*result.told, *(f"{each.name}: {line}" for each in result.specs for line in each.told)]
    return with_summary(head | {"version": result.version, "application": result.application, "specs": specs}, told)


def write_export(result: RexsExport, folder: Path) -> Path:
    """Write NAME.rexs, UTF-8 with a byte order mark as REXS asks for, and return its path. Raises OutputError."""
    name = f"{result.name}.rexs"
    with staged_files(folder) as staging:
        (staging / name).write_text(result.text, encoding="utf-8-sig", newline="\n")
    return folder / name


def write_import(result: RexsImport, folder: Path, *, force: bool = False) -> list[Path]:
    """Write NAME.toml for each spec, all or none, and return the paths.

    Raises OutputError, and ParameterError for a file that is there already, without `force`.
    """
    paths = [folder / f"{each.name}.toml" for each in result.specs]
    for path in paths:
        if (path.exists() or path.is_symlink()) and not force:
            raise ParameterError("output", str(path), "exists; give another folder, or --force to replace it")
    with staged_files(folder) as staging:
        for path, each in zip(paths, result.specs, strict=True):
            (staging / path.name).write_text(each.text, encoding="utf-8", newline="\n")
    return paths
