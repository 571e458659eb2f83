"""The gear data table of a sheet, in the order of DIN 3966-1 and ISO 1340."""

from gearcad.drawing.gear_data.row import Row
from gearcad.drawing.gear_data.rows import gear_notices, gear_rows

__all__ = ["Row", "gear_notices", "gear_rows"]
