"""Steady vibration at one speed and over speed: harmonic balance, flanks that part, stability, K_v charts."""

from __future__ import annotations
