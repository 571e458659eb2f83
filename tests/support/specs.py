"""Specs from tables of Python, the starters, and what jobs say of a spec: the way of a user, who has a file and a document."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from gearcad.core.runtime import templates
from gearcad.designs import Design
from gearcad.designs.reader import NO_DESIGNS, read_spec, starters
from gearcad.jobs.strength import Rate

Tables = Mapping[str, Mapping[str, Any]]


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
    """All that ship with gearcad, by name."""
    files = (templates() / f"{name}.toml" for name in sorted(starters()) if name not in NO_DESIGNS)
    return sorted(path for path in files if path.is_file())
