"""Plane elasticity of gears by finite elements (scikit-fem), and contact between them."""
