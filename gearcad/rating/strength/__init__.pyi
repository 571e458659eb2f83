from .duty import INFINITE as INFINITE
from .duty import PartStrength as PartStrength
from .duty import RatedPart as RatedPart
from .rating import FactorGroup as FactorGroup
from .rating import StrengthRating as StrengthRating
from .task import rate_strength as rate_strength
