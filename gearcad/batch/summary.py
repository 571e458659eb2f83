"""How a run ended, also where it was interrupted."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

__all__ = ["InterruptedRunError", "Summary"]


@dataclass(frozen=True, kw_only=True)
class Summary:
    """How a run ended: its files, rows by status, one line for each failed row, and why it stopped early if it did.

    `short` of the rows that are ok have a check with a gate that is not passed, or a rating that is not.
    """

    results: tuple[Path, ...]
    ok: int
    failed: int
    not_run: int
    short: int
    errors: tuple[str, ...]
    stopped: str = ""


class InterruptedRunError(KeyboardInterrupt):
    """Ctrl-C, and how far the run was: a row that is not finished counts as not run."""

    def __init__(self, summary: Summary) -> None:
        super().__init__()
        self.summary = summary
