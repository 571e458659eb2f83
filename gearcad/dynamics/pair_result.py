"""Results for a pair of gears by itself: as a mesh of varying stiffness, or as springs between its teeth."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.core.records import Floats, JsonObject, Notice, PerGear, Pictured, Role, texts
from gearcad.dynamics.options import idle_without_levels, undamped_bearings
from gearcad.dynamics.result_tables import Tables, campbell_columns, cycle_columns, history_columns, spectrum_columns
from gearcad.dynamics.time_domain.contact_model import ContactModel
from gearcad.dynamics.time_domain.time_history import CampbellStudy, TimeHistory
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.geometry import GearPair, RackPair
from gearcad.mesh_cycle import MeshCycle

__all__ = ["ContactStudy", "PairStudy"]


_STANDS_STILL = 1e6
"""Inertia (kg·m²) of what hardly turns at all."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PairStudy(Pictured):
    """A pair as mounted, its mesh cycle and inertias (kg·m²), and the study of both as a train of one mesh.

    A rack of the mass m counts as a wheel with the pinion's base circle and the inertia m r².

    `method` is the title of what found the cycle. With `bearings` the charts are those of six degrees of freedom; the natural
    modes are still those of the turning alone.
    `unrated` says why K_v of ISO 6336-1 is missing, "" if it is not. `driver` is the gear that drives: the wheel if the torque
    of the load is against its speed.
    """

    pair: GearPair | RackPair
    cycle: MeshCycle
    inertias: PerGear[float]
    method: str
    study: TrainStudy
    bearings: PairOnBearings | None
    unrated: str = ""
    driver: Role = Role.PINION

    def __repr__(self) -> str:
        return f"<PairStudy of {self.pair.name!r}: {self.study!r}>"

    @property
    def name(self) -> str:
        """Name of the pair."""
        return self.pair.name

    @property
    def rack_mass(self) -> float | None:
        """Mass (kg) that moves with the rack: m = J/r²; None of gears."""
        if not isinstance(self.pair, RackPair):
            return None
        return self.inertias.wheel / (self.pair.pitch_radius / 1000) ** 2

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results."""
        factor = self.study.method_b
        unrated = Notice("no-standard-factor", f"no K_v of ISO 6336-1: {self.unrated}")
        standard = factor.notices if factor is not None else (unrated,)
        own = (*idle_without_levels(self.study.options), *undamped_bearings(self.study.options))
        of_gears = (*self._rack(), *self._driving_wheel(), *self._full_discs(), *self._free_ring())
        return (*own, *self.study.notices, *self.cycle.notices, *of_gears, *standard)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def _rack(self) -> Iterator[Notice]:
        """Yield a notice of what the turn of a rack is."""
        if self.rack_mass is not None and isinstance(self.pair, RackPair):
            travel = 1000 * self.pair.pitch_radius * math.radians(1 / 3600)
            text = (
                f"the rack ({self.rack_mass:.4g} kg) counts as a wheel of the inertia m r² on the pinion's reference circle: "
                f"1 arcsec of its turn is {travel:.4g} µm of travel"
            )
            yield Notice("rack-as-wheel", text)

    def _driving_wheel(self) -> Iterator[Notice]:
        """Yield a notice if the torque of the load is against its speed."""
        if self.driver is Role.WHEEL:
            text = "the torque is against the speed: the wheel drives, and contact moves from tip to root of the pinion"
            yield Notice("wheel-drives", text)

    def _full_discs(self) -> Iterator[Notice]:
        """Yield a notice for each gear with a web whose moment of inertia is not given."""
        pair = self.pair
        gears = [(Role.PINION, pair.pinion)] if isinstance(pair, RackPair) else list(pair.gears.items())
        for role, gear in gears:
            if gear.body.web_thickness and self.study.options.inertias.pick(role) is None:
                own = role.value
                text = f"the {own}'s moment of inertia is that of a full disc, without its web; {own}_inertia gives another"
                yield Notice("full-disc", text)

    def _free_ring(self) -> Iterator[Notice]:
        """Yield a notice if the moment of inertia of a ring is not given, because most rings stand still."""
        ring = isinstance(self.pair, GearPair) and self.pair.internal
        if ring and self.study.options.inertias.wheel is None:
            text = (
                "the ring turns with its pinion, with the inertia of its solid, in m_red of ISO 6336-1 too; for one that"
                f" stands still give wheel_inertia = {_STANDS_STILL:g} kg·m²"
            )
            yield Notice("free-ring", text)

    def to_dict(self) -> JsonObject:
        """Return the document of the study for `dynamics.json`."""
        return {
            "model": "mesh",
            "stiffness_method": self.cycle.method,
            "mesh_stiffness_mean": self.cycle.mean,
            "mesh_stiffness_tangent_mean": self.cycle.tangent_mean,
            "pinion_inertia": self.inertias.pinion,
            "wheel_inertia": self.inertias.wheel,
            **({} if self.rack_mass is None else {"rack_mass": self.rack_mass}),
            "frequencies_on_bearings": None if self.bearings is None else list(self.bearings.frequencies()),
            **{key: value for key, value in self.study.to_dict().items() if key != "model"},
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return self.study.arrays()

    def tables(self) -> Tables:
        """Return the tables of the CSV files by name."""
        return {**self.study.tables(), "mesh stiffness": cycle_columns(self.cycle)}


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactStudy(Pictured):
    """Results for a pair as mounted: its contact model, the Campbell study of it and the time history at one speed.

    `idle` are notices of options without effect.
    """

    pair: GearPair
    model: ContactModel
    study: CampbellStudy
    history: TimeHistory
    idle: tuple[Notice, ...] = ()

    def __repr__(self) -> str:
        return f"<ContactStudy of {self.pair.name!r}: {len(self.study.speeds)} speeds up to {self.study.speeds.max():.6g} rpm>"

    @property
    def name(self) -> str:
        """Name of the pair."""
        return self.pair.name

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results."""
        return (*self.idle, *self.study.notices)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the document of the study for `dynamics.json`."""
        model = self.model
        return {
            "model": "contact",
            "zone": model.zone.value,
            "tooth_stiffness": model.pair_stiffness,
            "tooth_damping": model.damping,
            "pinion_inertia": model.inertias.pinion,
            "wheel_inertia": model.inertias.wheel,
            "natural_frequency": model.natural_frequency(),
            "damping_ratio": model.damping_ratio,
            "static_approach": model.static_approach,
            "contact_ratio": model.contact_ratio,
            "campbell": self.study.to_dict(),
            "history_speed": self.history.speed,
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {
            "speed": self.study.speeds,
            "frequency": self.study.frequency,
            "pinion_speed_amplitude": self.study.pinion_speed,
            "approach_amplitude": self.study.approach,
            "history_time": self.history.time,
            "history_approach": self.history.approach,
            "history_pinion_speed": self.history.pinion_speed,
            "history_wheel_speed": self.history.wheel_speed,
            "history_pinion_angle": self.history.pinion_angle,
            "history_wheel_angle": self.history.wheel_angle,
        }

    def tables(self) -> Tables:
        """Return the tables of the CSV files by name."""
        return {
            "campbell": campbell_columns(self.study),
            "history": history_columns(self.history),
            "spectrum": spectrum_columns(self.history, float(self.study.frequency[-1])),
        }
