"""The size of teeth in inches: the normal diametral pitch P_nd, teeth per inch of a spur gear's reference diameter."""

from __future__ import annotations

from typing import Annotated, Protocol

from gearcad.errors import GeometryError
from gearcad.geometry.derived import derive, is_given
from gearcad.ranges import Range
from gearcad.schema import InPlaceOf, Words

__all__ = ["MODULE_OR_PITCH", "NormalDiametralPitch", "NormalModule", "derive_module", "module_of_pitch"]

_PITCH = Range("1/inch", 0.127, 2540)
"""That of the modules which are permitted."""

NormalModule = Annotated[
    float, Range("mm", 0.01, 200), Words("normal module", "m_n", "4.2"), InPlaceOf("normal_diametral_pitch")
]
NormalDiametralPitch = Annotated[float, _PITCH, Words("normal diametral pitch", "P_nd")]

MODULE_OR_PITCH = ("normal_module", "normal_diametral_pitch")
"""Fields one of which is to be given."""

_MM_PER_INCH = 25.4


class _Sized(Protocol):
    @property
    def normal_module(self) -> float: ...
    @property
    def normal_diametral_pitch(self) -> float: ...


def module_of_pitch(pitch: float) -> float:
    """m_n = 25.4 mm/P_nd (mm)."""
    return _MM_PER_INCH / pitch


def derive_module(instance: _Sized) -> None:
    """Let the normal module follow from the diametral pitch that was given, or that from it. Raises GeometryError for both."""
    module, pitch = instance.normal_module, instance.normal_diametral_pitch
    if not is_given(pitch):
        derive(instance, "normal_diametral_pitch", _MM_PER_INCH / module)
    elif not is_given(module):
        derive(instance, "normal_module", module_of_pitch(pitch))
    else:
        permitted = f"must be left out where normal_module is given ({module:g} mm is {_MM_PER_INCH / module:.6g}/inch)"
        raise GeometryError("normal_diametral_pitch", pitch, permitted, "1/inch")
