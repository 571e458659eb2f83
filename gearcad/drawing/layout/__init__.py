"""Where views and their marks stand on a sheet, on which sheet, and at what scale."""

from gearcad.drawing.layout.arrangement import Arrangement, Fixed, Views, arranged
from gearcad.drawing.layout.dressing import dressed
from gearcad.drawing.layout.view import Candidates, View

__all__ = ["Arrangement", "Candidates", "Fixed", "View", "Views", "arranged", "dressed"]
