"""Figures that gearcad makes while the manual is built.

Each module of `docs/figures` has FIGURES: the name of a file, and the function that writes it. A page shows one as
`/figures/made/NAME`. It is made where it is missing, or older than the code.
"""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import gearcad

__all__ = ["MADE", "figures", "make", "setup"]

SOURCES = Path(__file__).parents[1] / "figures"
MADE = SOURCES / "made"


def figures() -> Iterator[tuple[str, Callable[[Path], object], Path]]:
    """Name, function and module of every figure."""
    for source in sorted(SOURCES.glob("*.py")):
        spec = spec_from_file_location(f"figures_{source.stem}", source)
        assert spec is not None and spec.loader is not None
        module = module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
        for name, draw in module.FIGURES.items():
            yield name, draw, source


def make(*names: str) -> None:
    """Make the figures of these names, or of none: those that are missing or older than the code."""
    logging.getLogger("ezdxf").setLevel(logging.WARNING)  # Sphinx lets all loggers tell what they do
    MADE.mkdir(exist_ok=True)
    newest = max(source.stat().st_mtime for source in Path(gearcad.__file__).parent.rglob("*.py"))
    for name, draw, source in figures():
        path = MADE / name
        stale = not path.exists() or path.stat().st_mtime < max(newest, source.stat().st_mtime)
        if name in names if names else stale:
            draw(path)


def setup(app: Any) -> dict[str, bool]:
    app.connect("builder-inited", lambda _app: make(), priority=100)  # before the pages' files are looked for
    return {"parallel_read_safe": True, "parallel_write_safe": True}
