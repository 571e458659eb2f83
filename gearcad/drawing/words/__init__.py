"""What is written on sheets: words in three languages, numbers as each writes them, sizes with their limits."""

from gearcad.drawing.words.draughting import Draughting
from gearcad.drawing.words.language import Language
from gearcad.drawing.words.size import Size
from gearcad.drawing.words.words import Words

__all__ = ["Draughting", "Language", "Size", "Words"]
