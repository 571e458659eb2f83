"""The kinds of designs: each in the module that its DesignKind names, its class named alike."""

from __future__ import annotations

from importlib import import_module
from typing import cast

from gearcad.designs.design import Design, DesignKind

__all__ = ["type_of"]


def type_of(kind: DesignKind) -> type[Design]:
    """The class of a kind's designs; a train's is not imported for a gear."""
    module = import_module(f"gearcad.designs.kinds.{kind.value}")
    name = "".join(word.capitalize() for word in kind.value.split("_"))
    return cast("type[Design]", getattr(module, f"{name}Design"))
