"""Risk: what scuffing temperatures come to, in one word."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["Risk", "flash_risk", "integral_risk"]

LEAST_MARGIN = 50.0
"""Distance (K) to the scuffing temperature that ISO/TR 13989-1, 10.5, gives as one to ask for."""


class Risk(StrEnum):
    """How likely flanks scuff."""

    HIGH = "high"
    CRITICAL = "critical"
    LOW = "low"


def integral_risk(safety: float) -> Risk:
    """That of S_int (ISO/TR 13989-2, 6.1.1): high below 1, critical up to 2, low above."""
    return Risk.HIGH if safety < 1 else Risk.CRITICAL if safety <= 2 else Risk.LOW


def flash_risk(margin: float) -> Risk:
    """That of Theta_S - Theta_B (K): high below 0, critical below 50 K, low from there on."""
    return Risk.HIGH if margin < 0 else Risk.CRITICAL if margin < LEAST_MARGIN else Risk.LOW
