"""Normal modules of ISO 54:1996 (mm)."""

from __future__ import annotations

__all__ = ["ISO_54_I", "ISO_54_II"]

ISO_54_I = (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 32, 40, 50)
"""Those that the standard prefers."""

ISO_54_II = (1.125, 1.375, 1.75, 2.25, 2.75, 3.5, 4.5, 5.5, 6.5, 7, 9, 11, 14, 18, 22, 28, 36, 45)
