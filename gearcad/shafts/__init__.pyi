from .arrangement import ArrangementResult as ArrangementResult
from .arrangement import ShaftOptions as ShaftOptions
from .beam import ShaftBearing as ShaftBearing
from .beam import ShaftForce as ShaftForce
from .beam import ShaftSegment as ShaftSegment
from .beam import ShaftState as ShaftState
from .beam import SteppedShaft as SteppedShaft
