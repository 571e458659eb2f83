"""Gears pressed together: loaded tooth contact analysis by finite elements, of sections and of solid bodies."""
