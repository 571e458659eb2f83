"""Load factors of a pinion and a rack: those that are given, as the standard has no methods for racks."""

from __future__ import annotations

from gearcad.errors import ParameterError
from gearcad.load import Load
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.options import RatingOptions

__all__ = ["given_factors"]


def given_factors(load: Load, options: RatingOptions) -> LoadFactors:
    """Of a load. Raises ParameterError for one that is not given."""
    given = {"dynamic_factor": options.dynamic_factor, "face_load_factor": options.face_load_factor}
    given["transverse_load_factor"] = options.transverse_load_factor
    for name, value in given.items():
        if isinstance(value, str):
            raise ParameterError(f"rating.{name}", value, "must be a number for a rack, for which the standard has no method")
    dynamic, face, transverse = (float(value) for value in given.values())
    return LoadFactors(
        application=load.application_factor,
        mesh_load=options.mesh_load_factor,
        dynamic=dynamic,
        face_flank=face,
        face_root=face,
        transverse_flank=transverse,
        transverse_root=transverse,
    )
