"""Trains of shafts and meshes: their members, models and natural modes, and the excitation of their meshes."""

from __future__ import annotations
