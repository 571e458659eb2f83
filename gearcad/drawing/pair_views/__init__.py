"""Views of a pair in mesh: the section through both axes, and both parts seen along them (ISO 2203)."""

from gearcad.drawing.pair_views.face import pair_face
from gearcad.drawing.pair_views.places import PairPlaces
from gearcad.drawing.pair_views.section import pair_section

__all__ = ["PairPlaces", "pair_face", "pair_section"]
