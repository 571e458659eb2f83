"""Tooth numbers of planetary sets for a ratio: all that meet the conditions of assembly and mesh, ranked."""

from gearcad.planetary.search.candidate import Candidate
from gearcad.planetary.search.run import SearchResult, search
from gearcad.planetary.search.task import SearchTask

__all__ = ["Candidate", "SearchResult", "SearchTask", "search"]
