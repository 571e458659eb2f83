"""CallableRoom: a room that is also the verb of its name, `gearcad.check(pair, load)` beside `gearcad.check.CheckOptions`."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any


class CallableRoom(ModuleType):
    """A room that can be called as the verb of its name. The room gives itself this class, so the order of imports is free."""

    @property
    def __wrapped__(self) -> Callable[..., Any]:
        """The function of the verb, whose signature `inspect.signature` takes for that of the room."""
        verb = self.__name__.rpartition(".")[2]
        module = import_module("gearcad.jobs").module_of(verb)
        function: Callable[..., Any] = getattr(import_module(f"gearcad.jobs.{module}"), verb)
        return function

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Call the verb."""
        return self.__wrapped__(*arguments, **options)

    @property
    def __doc__(self) -> str:  # type: ignore[override]
        """Docstring of the room, then that of the verb without its examples, which doctest finds at the verb."""
        from inspect import cleandoc

        paragraphs = cleandoc(self.__wrapped__.__doc__ or "").split("\n\n")
        return "\n\n".join((vars(self)["__doc__"], *(each for each in paragraphs if not each.startswith(">>>"))))
