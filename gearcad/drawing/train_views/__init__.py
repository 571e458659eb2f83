"""Views of a planetary train as a general arrangement: the section through its axis, and its set seen along it."""

from gearcad.drawing.train_views.face import train_face
from gearcad.drawing.train_views.pitch import pitch_radii
from gearcad.drawing.train_views.plan import TrainPlan
from gearcad.drawing.train_views.section import train_section

__all__ = ["TrainPlan", "pitch_radii", "train_face", "train_section"]
