"""The structural check: finite element contact over a mesh cycle, its error, and comparisons with Hertz and ISO 6336."""
