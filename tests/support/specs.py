"""Specs from tables of Python, the starters, and what jobs say of a spec: the way of a user, who has a file and a document."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from gearcad.core.runtime import templates
from gearcad.designs import Design
from gearcad.designs.reader import NOT_ON_PAGE, read_spec, starters
from gearcad.jobs.strength import Rate
from gearcad.solids import Format

TEMPLATES = Path(__file__).parents[2] / "templates"

Tables = Mapping[str, Mapping[str, Any]]

FACETED_OR_FLAT = [kind.value for kind in Format if kind not in (Format.STEP, Format.PNG)]
"""Formats whose files need no exact solid and no window."""

WITHOUT_ASSEMBLY = (Format.STL, Format.DXF, Format.CSV)
"""Formats that hold one part only, as the manual says."""


def spec_text(tables: Tables) -> str:
    """The TOML of {"pair": {"normal_module": 2, ...}, ...}; a key may be dotted."""
    return "\n".join(_lines(tables)) + "\n"


def _lines(tables: Tables) -> Iterator[str]:
    for name, values in tables.items():
        yield f"[{name}]"
        yield from (f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in values.items())


def read_tables(tables: Tables, folder: Path) -> Design:
    """The design of a spec that has been written to a folder."""
    (path := folder / "spec.toml").write_text(spec_text(tables), encoding="utf-8")
    return read_spec(path)


def rate_document(tables: Tables, folder: Path) -> dict[str, Any]:
    """rate.json of a spec, as it is read back."""
    job = Rate()
    found: dict[str, Any] = json.loads(json.dumps(job.document(job.run(read_tables(tables, folder)))))
    return found


def figures(document: Any, symbol: str) -> list[float]:
    """The values under a symbol wherever the document has it first: one, or those of pinion and wheel."""
    if not isinstance(document, dict):
        return []
    if symbol in document:
        return _values(document[symbol])
    if "pinion" in document and (found := figures(document["pinion"], symbol)):
        return found + figures(document["wheel"], symbol)
    return next(filter(None, (figures(part, symbol) for part in document.values())), [])


def _values(value: Any) -> list[float]:
    return list(value.values()) if isinstance(value, dict) else [value]


def starter_specs() -> list[Path]:
    """All that ship with gearcad and that the page takes, by name: no gearboxes of planetary sets."""
    files = (templates() / f"{name}.toml" for name in sorted(starters()) if name not in NOT_ON_PAGE)
    return sorted(path for path in files if path.is_file())
