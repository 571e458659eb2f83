"""A second design beside the one that is edited: kept from it, or opened from the folder; the two can change places."""

from __future__ import annotations

from typing import NamedTuple

from gearcad.designs.design import Design
from gearcad.errors import SpecError
from gearcad.page.folder import Folder
from gearcad.page.texts import design_of
from gearcad.page.workbench import Workbench

__all__ = ["BesideDesign", "Kept"]


class Kept(NamedTuple):
    """A design, the text that makes it, and what it is called where its text says no name."""

    text: str
    name: str
    design: Design


class BesideDesign:
    """What is `kept` beside the design of a workbench `bench`, if anything is."""

    def __init__(self, bench: Workbench) -> None:
        self.bench, self.folder = bench, Folder(bench.folder)
        self.kept: Kept | None = None

    @property
    def design(self) -> Design | None:
        return None if self.kept is None else self.kept.design

    def keep(self) -> None:
        """Keep the design that is edited. Raises SpecError while its text makes none."""
        self.kept = self._present()

    def open(self, file: str) -> None:
        """Keep that of a spec in the folder. Raises ParameterError, SpecError."""
        text, name = self.folder.spec(file), file.removesuffix(".toml")
        self.kept = Kept(text, name, design_of(text, name, self.folder.path))

    def swap(self) -> None:
        """Edit what was kept, as a step that can be undone, and keep what was edited. Raises SpecError while that is none."""
        if (kept := self.kept) is not None:
            self.kept = self._present()
            self.bench.open(kept.text, kept.name)

    def let_go(self) -> None:
        """Keep nothing."""
        self.kept = None

    def _present(self) -> Kept:
        bench = self.bench
        if bench.fault is not None and bench.fault.written:
            raise SpecError(bench.fault.line, bench.fault.key)
        return Kept(bench.text, bench.name, bench.design)
