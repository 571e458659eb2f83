"""Dynamics of gear pairs and trains."""
