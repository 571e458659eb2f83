"""What parts look like: red, green and blue as seen on a screen (sRGB), 0 ... 1."""

__all__ = ["BRIGHT_STEEL", "PART_COLOURS", "STAGE_COLOURS", "STEEL", "TRAIN_COLOURS", "Colour"]

Colour = tuple[float, float, float]

STEEL: Colour = (0.62, 0.66, 0.72)
"""Of a part by itself."""

BRIGHT_STEEL: Colour = (0.809468152636, 0.832283570587, 0.865042042985)
"""Of a part by itself in STEP: the shares of STEEL as shares of light."""

PART_COLOURS: dict[str, Colour] = {
    "pinion": (0.80, 0.55, 0.20),
    "wheel": (0.45, 0.58, 0.72),
    "rack": (0.45, 0.58, 0.72),
    "bracket": (0.55, 0.55, 0.55),
}
"""Of the parts of an assembly."""

TRAIN_COLOURS: dict[str, tuple[Colour, Colour]] = {
    "suns": ((0.80, 0.55, 0.20), (0.72, 0.38, 0.22)),
    "rings": ((0.45, 0.58, 0.72), (0.27, 0.42, 0.60)),
    "rims": ((0.45, 0.66, 0.42), (0.70, 0.74, 0.36)),
    "carrier": ((0.55, 0.55, 0.55), (0.55, 0.55, 0.55)),
}
"""Of the parts of a planetary train, the first and the second of their kind: no two parts that differ are of one colour."""

STAGE_COLOURS: tuple[Colour, Colour] = ((0.66, 0.44, 0.58), (0.52, 0.47, 0.68))
"""Of pinion and wheel of a stage; those of each further stage are darker."""
