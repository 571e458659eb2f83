"""Shafts on their bearings: deflection, reactions, bearing life, and the gap that shafts leave over the face of a mesh."""
