"""What the views of a part are dimensioned with: sizes and their limits, roughness, geometrical tolerances."""

from gearcad.drawing.requirements.requirements import Requirements

__all__ = ["Requirements"]
