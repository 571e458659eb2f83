"""What parts look like: red, green and blue as seen on a screen (sRGB), 0 ... 1."""

__all__ = ["PART_COLOURS", "STEEL", "Colour"]

Colour = tuple[float, float, float]

STEEL: Colour = (0.62, 0.66, 0.72)
"""Of a part by itself."""

PART_COLOURS: dict[str, Colour] = {
    "pinion": (0.80, 0.55, 0.20),
    "wheel": (0.45, 0.58, 0.72),
    "rack": (0.45, 0.58, 0.72),
    "bracket": (0.55, 0.55, 0.55),
}
"""Of the parts of an assembly."""
