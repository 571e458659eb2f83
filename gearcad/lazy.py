"""Packages whose names are imported at their first use, so that commands start quickly."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping
    from inspect import Signature
    from typing import Any

__all__ = ["Entrance", "NamesFirst", "lazily"]


def lazily(
    package: str,
    names: Collection[str],
    homes: Iterable[str],
    rooms: Iterable[str] = (),
    functions: Mapping[str, str] | None = None,
) -> Callable[[str], object]:
    """The `__getattr__` of a package: its `names` come from its modules `homes`, the light ones first; these and the modules
    `rooms` are there themselves. What is called otherwise where it stands is among `functions`: {"read": "designs.read_spec"}.
    """

    def found(name: str) -> object:
        if name in rooms or (name in homes and name not in names):
            return import_module(f"{package}.{name}")
        if functions and name in functions:
            home, _, function = functions[name].rpartition(".")
            setattr(sys.modules[package], name, getattr(import_module(f"{package}.{home}"), function))
            return getattr(sys.modules[package], name)
        for home in homes if name in names else ():
            module = import_module(f"{package}.{home}")
            if hasattr(module, name):
                setattr(sys.modules[package], name, getattr(module, name))
                return getattr(module, name)
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return found


class NamesFirst(ModuleType):
    """A package of which a name is also that of the module where it stands: it is the function that one means by it."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (isinstance(value, ModuleType) and name in self.__all__):
            super().__setattr__(name, value)


class Entrance(ModuleType):
    """A package with verbs among its names. A room of it that is called like one of them becomes a Verb.

    A room is set on its package when it is imported, by whomever and in whatever order, so this is seen here.
    """

    def __setattr__(self, name: str, value: object) -> None:
        if isinstance(value, ModuleType) and name in self.__all__:
            value.__class__ = Verb
        super().__setattr__(name, value)


class Verb(ModuleType):
    """A room that can be called as the job of its name: `gearcad.check(pair, load)`."""

    @property
    def function(self) -> Callable[..., Any]:
        """The function of the job."""
        package, _, name = self.__name__.rpartition(".")
        module = import_module(f"{package}.jobs.verbs").module_of(name)
        found: Callable[..., Any] = getattr(import_module(f"{package}.jobs.{module}"), name)
        return found

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        return self.function(*arguments, **options)

    @property
    def __signature__(self) -> Signature:
        from inspect import signature

        return signature(self.function)

    @property
    def __doc__(self) -> str:  # type: ignore[override]
        """Docstring of the room, then that of the function without its examples, which are tested in their own place."""
        from inspect import cleandoc

        words = cleandoc(self.function.__doc__ or "").split("\n\n")
        said = [each for each in words if not each.startswith(">>>")]
        return "\n\n".join((vars(self)["__doc__"] or "", f"{self.function.__name__}{self.__signature__}", *said))
