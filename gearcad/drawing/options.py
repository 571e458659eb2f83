"""The [drawing] table, and that of each gear: title block, sheet, and what dimensions are toleranced with."""

from __future__ import annotations

__all__: list[str] = []
