"""What a sheet is made of, before it is a file: shapes in mm of paper, y upwards, whose boxes are known."""

from gearcad.drawing.shapes.box import Box
from gearcad.drawing.shapes.clashes import Occupied
from gearcad.drawing.shapes.dimension import Dimension, Measured
from gearcad.drawing.shapes.figure import Figure
from gearcad.drawing.shapes.font import fitted, text_width
from gearcad.drawing.shapes.pens import Pen
from gearcad.drawing.shapes.shapes import Anchor, Arc, Circle, Filled, Hatching, Line, Point, Polyline, Shape, Text, Vertex

__all__ = [
    "Anchor",
    "Arc",
    "Box",
    "Circle",
    "Dimension",
    "Figure",
    "Filled",
    "Hatching",
    "Line",
    "Measured",
    "Occupied",
    "Pen",
    "Point",
    "Polyline",
    "Shape",
    "Text",
    "Vertex",
    "fitted",
    "text_width",
]
