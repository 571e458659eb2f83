from .duty import INFINITE as INFINITE
from .duty import Part as Part
from .duty import PartStrength as PartStrength
from .rating import StrengthRating as StrengthRating
from .task import rate_strength as rate_strength
