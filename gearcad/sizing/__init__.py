"""Sizing: pairs for a task. Every variant within ranges is rated as one array, and the best are refined and rated in full."""

from gearcad.geometry.gear_parts import ISO_54_I, ISO_54_II
from gearcad.sizing.proposals import SizedPair, Sizing, search_pairs
from gearcad.sizing.task import Criterion, SizeTask

__all__ = ["ISO_54_I", "ISO_54_II", "Criterion", "SizeTask", "SizedPair", "Sizing", "search_pairs"]
