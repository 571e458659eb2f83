"""Teeth that are cut before they are finished: inputs of the pre-cutting tool and of the finishing wheel.

Lengths in mm but for those of the tool's tooth, which are in normal modules; angles in degrees, those inside formulas radians.
Equations: ISO 6336-3 (E with a residual undercut), DIN 3972 (tools III and IV); the rest is geometry.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Annotated, Literal

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import Choice, Range, Whole, Words, require_fields
from gearcad.core.records import Notice, concise

_TALL = Range("", 0, 5, ends="(]")
_ROUND = Range("", 0, 5)
_MM = Range("mm", 0, 100)
_ANGLE = Range("deg", 0, 45)

_DIN3972 = {"din3972-III": 0.25, "din3972-IV": 0.6}
"""Factors (mm^(2/3)) of m^(1/3) in addendum and stock of the tools III and IV."""


@dataclass(frozen=True, kw_only=True)
class SemiTopping:
    """Ramp near the root of the tool that chamfers the tips: its `angle` to the middle of the tool's tooth (degrees).

    `height` (mm) is the distance of its beginning from the tool's reference line. Raises ParameterError, or GeometryError where
    one of them is given alone.
    """

    angle: Annotated[float | None, Range("deg", 20, 80), Words("semi-topping, angle of the ramp", "α_K")] = None
    height: Annotated[float | None, Range("mm", 0, 1000, ends="(]"), Words("semi-topping, height of the ramp", "h_K0")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        for one, other in (("angle", "height"), ("height", "angle")):
            if getattr(self, one) is not None and getattr(self, other) is None:
                raise GeometryError(other, None, f"must be given where {one} is")

    @property
    def present(self) -> bool:
        """Whether there is a ramp."""
        return self.angle is not None


@dataclass(frozen=True, kw_only=True)
class RackPremachining:
    """Tool that cuts the teeth of a rack before they are finished; without `tool_addendum` or a stock of DIN 3972 none does.

    `tool_addendum` h_aP0 and `tool_tip_radius` are in normal modules; the tool reaches h_aP0 m_n below its reference line.
    `protuberance` (mm) is how far the tip arc stands out of the flank of the tool, `stock` (mm) what it leaves on each
    flank, both normal to the flank; "din3972-III" and "din3972-IV" follow from the module, and give the addendum too.
    `stock_tolerance` (mm): the stock is within plus and minus of it. `topping` (mm) is the depth of the tool's root below its
    reference line if it cuts the tips. `protuberance_angle` (degrees) is that of its flank to the middle of the tool's tooth.
    Raises ParameterError, or GeometryError for keys that do not belong together.
    """

    tool_addendum: Annotated[float | None, _TALL, Words("pre-cutting tool, addendum", "h_aP0*")] = None
    tool_tip_radius: Annotated[float | None, _ROUND, Words("pre-cutting tool, tip radius", "ρ_aP0*")] = None
    protuberance: Annotated[float, _MM, Words("protuberance", "p_rP0")] = 0.0
    protuberance_angle: Annotated[float | None, _ANGLE, Words("protuberance, angle of its flank", "α_prP0")] = None
    stock: Annotated[
        float | Literal["din3972-III", "din3972-IV"], _MM, Words("stock on each flank (normal)", "q", "DIN 3972")
    ] = 0.0
    stock_tolerance: Annotated[float, _MM, Words("tolerance of the stock, ±")] = 0.0
    topping: Annotated[float | None, _MM, Words("topping tool, dedendum", "h_fP0")] = None
    semi_topping: SemiTopping = field(default=SemiTopping())

    __repr__ = concise

    def __post_init__(self) -> None:
        if isinstance(self.stock, str) and self.stock not in _DIN3972:
            raise ParameterError("stock", self.stock, 'must be a number from 0 to 100 mm, or "din3972-III" or "din3972-IV"')
        require_fields(self)
        if not self.present:
            if any(getattr(self, each.name) != each.default for each in fields(self)):
                raise GeometryError("tool_addendum", None, "must be given where the pre-cutting tool is described")
            return
        if self.tool_tip_radius is None:
            raise GeometryError("tool_tip_radius", None, "must be given where the pre-cutting tool is described (in m_n)")
        if self.protuberance and self.protuberance_angle is None:
            raise GeometryError("protuberance_angle", None, "must be given where protuberance is (in degrees)")
        if self.protuberance_angle is not None and not self.protuberance:
            raise GeometryError("protuberance_angle", self.protuberance_angle, "must be left out without protuberance", "deg")
        if isinstance(self.stock, float) and self.stock_tolerance > self.stock:
            permitted = f"must be at most {self.stock:g} mm, the stock"
            raise GeometryError("stock_tolerance", self.stock_tolerance, permitted, "mm")
        if self.topping is not None and self.semi_topping.present:
            raise GeometryError("topping", self.topping, "must be left out where semi_topping is given", "mm")

    @property
    def present(self) -> bool:
        """Whether the teeth are cut by a tool of their own before they are finished."""
        return self.tool_addendum is not None or isinstance(self.stock, str)

    def stock_of(self, normal_module: float) -> float:
        """Return the stock q (mm); that of DIN 3972 is .25 or .6 m_n^(1/3) sin 20 deg."""
        if not isinstance(self.stock, str):
            return self.stock
        return _DIN3972[self.stock] * math.cbrt(normal_module) * math.sin(math.radians(20))

    def addendum_of(self, normal_module: float) -> float:
        """Return the addendum h_aP0 in normal modules; that of DIN 3972 is 1.25 m_n + .25 or .6 m_n^(1/3)."""
        if self.tool_addendum is not None:
            return self.tool_addendum
        assert isinstance(self.stock, str)
        return 1.25 + _DIN3972[self.stock] * math.cbrt(normal_module) / normal_module

    def notices(self, normal_module: float, *, ends: bool) -> Iterator[Notice]:
        """Yield a notice if the greatest stock is more than the protuberance, and no wheel `ends` above the root."""
        most = self.stock_of(normal_module) + self.stock_tolerance if self.present else 0.0
        if self.stock_tolerance and not ends and most > self.protuberance:
            beyond = f"the greatest stock {most:.4g} mm is {most - self.protuberance:.4g} mm more than the protuberance"
            yield Notice("stock-beyond-protuberance", f"stock: {beyond}: the wheel then reaches the root")


@dataclass(frozen=True, kw_only=True)
class Premachining(RackPremachining):
    """Tool that cuts the teeth of a gear before they are finished.

    It reaches (h_aP0 - x) m_n below the reference circle. `tool_pressure_angle` (degrees), less than that of the gear, is of a
    hob with a short lead, whose module follows; `tool_module` may say so too. With `cutter_teeth` the tool is a shaper cutter.
    Raises as its parent.
    """

    tool_pressure_angle: Annotated[float | None, Range("deg", 1, 45), Words("pre-cutting tool, pressure angle", "α_n0")] = None
    tool_module: Annotated[float | None, Range("mm", 0.01, 200), Words("pre-cutting tool, module", "m_0")] = None
    cutter_teeth: Annotated[int | None, Whole(3, 2000), Words("pre-cutting cutter, teeth", "z_0")] = None
    cutter_profile_shift: Annotated[float, Range("", -5, 5), Words("pre-cutting cutter, profile shift", "x_0")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.cutter_teeth is None:
            if self.cutter_profile_shift:
                raise GeometryError("cutter_profile_shift", self.cutter_profile_shift, "must be left out without cutter_teeth")
            return
        for name in ("tool_pressure_angle", "tool_module", "topping"):
            if (value := getattr(self, name)) is not None:
                raise GeometryError(name, value, "must be left out where cutter_teeth is given: it is of a hob")
        if self.semi_topping.present:
            raise GeometryError("semi_topping.angle", self.semi_topping.angle, "must be left out: it is of a hob", "deg")


_WheelTip = Annotated[float | None, Range("mm", 0.001, 100), Words("tip radius of the wheel", "ρ_g")]
_NotchDepth = Annotated[float | None, Range("mm", 0, 100), Words("depth of the grinding notch", "t_g", "ISO 6336-3")]

WHEEL_TIP = 0.2
"""Radius of a finishing wheel's tip that nobody gives, in normal modules."""


@dataclass(frozen=True, kw_only=True)
class Finishing:
    """Finishing of flanks that were cut before: by a wheel that rolls as a rack, or by a form wheel.

    `end_diameter` (mm, negative on a ring) is the circle at which the finished flank ends. None lets the wheel run free of the
    root, which takes a protuberance of at least the stock. `wheel_tip_radius` (mm) is the radius of the wheel's tip, None a
    fifth of the normal module. `notch_depth` (mm) replaces the depth t_g of a grinding notch in the rating; None takes the
    stock that is left beside it. Raises ParameterError.
    """

    kind: Annotated[str, Choice(("generating", "form")), Words("kind of finishing")] = "generating"
    end_diameter: Annotated[float | None, Range("mm", -2e6, 2e6), Words("end of the finished flank", "d_FfG")] = None
    wheel_tip_radius: _WheelTip = None
    notch_depth: _NotchDepth = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)


@dataclass(frozen=True, kw_only=True)
class RackFinishing:
    """Finishing of the flanks of a rack that were cut before, by a wheel with the profile of a space.

    `end_depth` (mm) is the depth below the reference line at which the finished flank ends, negative above the line. None lets
    the wheel run free of the root, which takes a protuberance of at least the stock. `wheel_tip_radius` and `notch_depth` (mm)
    are as in `Finishing`. Raises ParameterError.
    """

    end_depth: Annotated[float | None, Range("mm", -1000, 1000), Words("end of the finished flank, below", "h_FfG")] = None
    wheel_tip_radius: _WheelTip = None
    notch_depth: _NotchDepth = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
