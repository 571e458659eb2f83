"""DXF documents by ezdxf, with equal bytes for equal input."""

from __future__ import annotations

import json
import os
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import RLock
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ezdxf.document import Drawing


Layers = Mapping[str, tuple[int, str]]
"""Colour (AutoCAD index) and line type of layers by their names."""

CUT = (7, "CONTINUOUS")
NOT_CUT = (8, "CENTER")
"""Colour and line type of parts that are not cut: grey and dash-dotted."""

_global_options = RLock()
"""Held while something is changed that is the same for all threads, so that none restores the value of another."""

_MILLIMETRES, _METRIC = 4, 1

_CACHE = "XDG_CACHE_HOME"


@contextmanager
def drawing(path: Path | str, layers: Layers) -> Iterator[Drawing]:
    """Yield a document with these layers, and write it to `path` once it has been drawn."""
    document = new_document(setup=("linetypes",))
    add_layers(document, layers)
    yield document
    write_document(document, path)


def new_document(*, setup: tuple[str, ...] = ()) -> Drawing:
    """Return an empty document; `setup` names the resources of ezdxf that it gets."""
    with _fixed_meta_data():
        document = ezdxf().new("R2010", setup=list(setup))
    # ezdxf adds these from a set when it writes, in an order that changes from process to process.
    document.classes.add_required_classes(document.dxfversion)
    document.classes.classes = OrderedDict(sorted(document.classes.classes.items()))
    document.header["$INSUNITS"], document.header["$MEASUREMENT"] = _MILLIMETRES, _METRIC
    return document


def add_layers(document: Drawing, layers: Layers) -> None:
    """Add layers to a document that does not have them."""
    for name, (colour, linetype) in layers.items():
        if name in document.layers:
            continue
        document.layers.add(name, color=colour, linetype=linetype)


def write_document(document: Drawing, path: Path | str) -> None:
    """Write a document; the same document gives the same bytes."""
    with (
        _fixed_meta_data(),
        Path(path).open("w", encoding=document.output_encoding, errors="dxfreplace", newline="\n") as stream,
    ):
        document.write(stream)


@contextmanager
def _fixed_meta_data() -> Iterator[None]:
    """Keep ezdxf from writing the time and new identifiers into files; only this global option does so."""
    with _global_options:
        options = ezdxf().options
        before = options.write_fixed_meta_data_for_testing
        options.write_fixed_meta_data_for_testing = True
        try:
            yield
        finally:
            options.write_fixed_meta_data_for_testing = before


@cache
def ezdxf() -> ModuleType:
    """Return the library ezdxf. Its import reads the fonts of the system and writes a list of them to the user's home.

    We draw no letters with it: it gets an empty list of fonts, in a folder that is gone when it has read it.
    """
    with _global_options, TemporaryDirectory(prefix="gearcad-") as folder:
        fonts = Path(folder, "ezdxf", "font_manager_cache.json")
        fonts.parent.mkdir()
        fonts.write_text(json.dumps({"version": 2, "font-faces": []}), encoding="ascii", newline="\n")
        before = os.environ.get(_CACHE)
        os.environ[_CACHE] = folder
        try:
            library = import_module("ezdxf")
        finally:
            if before is None:
                del os.environ[_CACHE]
            else:
                os.environ[_CACHE] = before
    return library
