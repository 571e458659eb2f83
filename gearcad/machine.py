"""What the machine has."""

from __future__ import annotations

import math
import os

__all__ = ["machine_memory"]


def machine_memory() -> float:
    """Bytes that the machine has, or less where the system permits less; endless where that is not told."""
    try:
        import resource

        machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        permitted = resource.getrlimit(resource.RLIMIT_AS)[0]
    except (ImportError, AttributeError, ValueError, OSError):  # Windows has neither
        return math.inf
    return float(machine if permitted == resource.RLIM_INFINITY else min(machine, permitted))
