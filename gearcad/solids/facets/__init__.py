"""Structured triangulation of gears and racks: points on the exact surfaces, joined to watertight triangles."""
