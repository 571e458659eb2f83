"""The panels of the page: each finds what it shows of a design, away from the browser, and shows it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar, Generic, TypeVar

from gearcad.designs.design import Design

__all__ = ["Panel"]

Found = TypeVar("Found")


class Panel(ABC, Generic[Found]):
    """A part of the page that follows the design. It is built where NiceGUI's elements are being put when it is made.

    One that `compares` shows a kept design beside it.
    """

    compares: ClassVar[bool] = False

    @abstractmethod
    def find(self, design: Design) -> Found:
        """What is to be shown of a design: computed in a thread, by jobs and what they are made of; no element is touched.

        A design that this panel has nothing to say of gets what says so; what gearcad raises is such a thing.
        """

    def aside(self, design: Design) -> Callable[[Design], Found] | None:
        """`find` as a function of a module where that takes long: it is asked in another process, when the hand rests."""
        return None

    def wait(self) -> None:
        """Tell that what is shown is of an older design, and another is being found."""

    @abstractmethod
    def show(self, found: Found) -> None:
        """Show it; what was found for an older design than the one that is being shown never comes here."""

    def keep(self, found: Found | None) -> None:
        """Take what was found for the kept design, or that there is none, to be shown with what follows."""
