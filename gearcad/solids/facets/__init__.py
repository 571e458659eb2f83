"""The structured triangulation."""
