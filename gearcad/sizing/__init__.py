"""Sizing: pairs for a task. Every variant within ranges is rated as one array, and the best are refined and rated in full."""

from gearcad.sizing.run import search_pairs
from gearcad.sizing.sized import SizedPair, Sizing
from gearcad.sizing.task import ISO_54_I, ISO_54_II, Criterion, SizeTask

__all__ = ["ISO_54_I", "ISO_54_II", "Criterion", "SizeTask", "SizedPair", "Sizing", "search_pairs"]
