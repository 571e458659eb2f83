"""Motion in time: of trains and pairs at any course of speed and torque, and of a pair with springs between single teeth."""

from __future__ import annotations
