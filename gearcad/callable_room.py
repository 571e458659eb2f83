"""Rooms that are also the verb of their name, `gearcad.check(pair, load)`; functions of higher rooms that lower ones call."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

TYPE_CHECKING = False  # typing takes longer to import than all of this
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any


HOMES: dict[str, str] = {}
"""Full name of the module of each function that lower rooms call by its name. The package fills it: no import points up."""


def function_of(name: str) -> Callable[..., Any]:
    """Return the function of this name in HOMES; its module is imported when it is asked for."""
    function: Callable[..., Any] = getattr(import_module(HOMES[name]), name)
    return function


class CallableRoom(ModuleType):
    """A room that can be called as the verb of its name. The room gives itself this class, so the order of imports is free."""

    @property
    def __wrapped__(self) -> Callable[..., Any]:
        """The function of the verb, whose signature `inspect.signature` takes for that of the room."""
        return function_of(self.__name__.rpartition(".")[2])

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Call the verb."""
        return self.__wrapped__(*arguments, **options)

    @property
    def __doc__(self) -> str:  # type: ignore[override]
        """Docstring of the room, then that of the verb without its examples, which doctest finds at the verb."""
        from inspect import cleandoc

        paragraphs = cleandoc(self.__wrapped__.__doc__ or "").split("\n\n")
        return "\n\n".join((vars(self)["__doc__"], *(each for each in paragraphs if not each.startswith(">>>"))))
