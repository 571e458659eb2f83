"""Documents of DXF (R2010, mm): layers, and how they are written so that equal input gives equal bytes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ezdxf.document import Drawing

__all__ = ["CUT", "NOT_CUT", "Layers", "add_layers", "drawing"]

Layers = Mapping[str, tuple[int, str]]
"""Colour (AutoCAD index) and line type of layers by their names."""

CUT = (7, "CONTINUOUS")
NOT_CUT = (8, "CENTER")
"""Grey and dash-dotted."""

_fixed_meta_data = Lock()
"""Held while the global option of ezdxf is changed, so that threads do not restore each other's value."""

_MILLIMETRES, _METRIC = 4, 1


@contextmanager
def drawing(path: Path | str, layers: Layers) -> Iterator[Drawing]:
    """A document with these layers, which is written to `path` once it has been drawn."""
    import ezdxf

    with _fixed_meta_data:
        # The only way to keep ezdxf from writing the time and new identifiers into the file is this global option.
        before = ezdxf.options.write_fixed_meta_data_for_testing
        ezdxf.options.write_fixed_meta_data_for_testing = True
        try:
            document = _document(layers)
            yield document
            with Path(path).open("w", encoding=document.output_encoding, errors="dxfreplace", newline="\n") as stream:
                document.write(stream)
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = before


def _document(layers: Layers) -> Drawing:
    import ezdxf

    document = ezdxf.new("R2010", setup=["linetypes"])
    # ezdxf adds these from a set when it writes, in an order that changes from process to process.
    document.classes.add_required_classes(document.dxfversion)
    document.classes.classes = OrderedDict(sorted(document.classes.classes.items()))
    document.header["$INSUNITS"], document.header["$MEASUREMENT"] = _MILLIMETRES, _METRIC
    add_layers(document, layers)
    return document


def add_layers(document: Drawing, layers: Layers) -> None:
    """Add layers to a document that does not have them."""
    for name, (colour, linetype) in layers.items():
        if name in document.layers:
            continue
        document.layers.add(name, color=colour, linetype=linetype)
