"""Packages whose names are imported when they are first asked for, so that a command is as quick to start as to be stopped."""

from __future__ import annotations

import sys
from importlib import import_module

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable

__all__ = ["lazily"]


def lazily(package: str, names: Collection[str], homes: Iterable[str], rooms: Iterable[str] = ()) -> Callable[[str], object]:
    """The `__getattr__` of a package: its `names` come from its modules `homes`, the light ones first; these and the modules
    `rooms` are there themselves.
    """

    def found(name: str) -> object:
        if name in (*homes, *rooms):
            return import_module(f"{package}.{name}")
        for home in homes if name in names else ():
            module = import_module(f"{package}.{home}")
            if name in module.__all__:
                setattr(sys.modules[package], name, getattr(module, name))
                return getattr(module, name)
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return found
