"""glTF 2.0 as one file, GLB: a tree of JSON, and the arrays it speaks of behind it."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats, Wholes

__all__ = ["Arrays", "glb_bytes"]

_COMPONENTS = {"<f4": 5126, "<u4": 5125}
_WIDTHS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_JSON, _BINARY = 0x4E4F534A, 0x004E4942


class Arrays:
    """What stands in the binary chunk, array behind array; the tree knows each by the number of its accessor."""

    def __init__(self) -> None:
        self._arrays: list[bytes] = []
        self._accessors: list[dict[str, Any]] = []

    def add(self, values: Floats | Wholes) -> int:
        """The number of an accessor of values (n,) or (n, k), in single precision or as whole numbers from 0 on."""
        kind = "<f4" if values.dtype.kind == "f" else "<u4"
        rows: NDArray[Any] = values.astype(kind).reshape(len(values), -1)
        self._accessors.append(
            {
                "bufferView": len(self._arrays),
                "componentType": _COMPONENTS[kind],
                "count": len(rows),
                "type": _WIDTHS[rows.shape[1]],
                "min": rows.min(axis=0).tolist(),
                "max": rows.max(axis=0).tolist(),
            }
        )
        self._arrays.append(rows.tobytes())
        return len(self._accessors) - 1

    @property
    def tables(self) -> dict[str, Any]:
        """What the tree says of them."""
        sizes = [len(array) for array in self._arrays]
        starts = np.cumsum([0, *sizes]).tolist()
        views = [{"buffer": 0, "byteOffset": start, "byteLength": size} for start, size in zip(starts, sizes, strict=False)]
        return {"accessors": self._accessors, "bufferViews": views, "buffers": [{"byteLength": starts[-1]}]}

    def joined(self) -> bytes:
        """The chunk: every component takes four bytes, so nothing has to be filled up."""
        return b"".join(self._arrays)


def glb_bytes(tree: dict[str, Any], arrays: Arrays) -> bytes:
    """The file of a tree: the chunk of its JSON, with the tables of its arrays, and that of the arrays."""
    text = json.dumps(tree | arrays.tables, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = arrays.joined()
    head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    return b"".join((head, struct.pack("<II", len(text), _JSON), text, struct.pack("<II", len(binary), _BINARY), binary))
