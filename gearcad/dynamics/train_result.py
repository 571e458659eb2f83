"""Results for a train: modes, charts over speed, and the course at one speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats, JsonObject, Notice, Pictured, texts
from gearcad.dynamics.options import DynamicsOptions, OperatingRange, operating_range
from gearcad.dynamics.response.chart_findings import (
    ChartResonance,
    Charts,
    GreatestAmplitude,
    GreatestBearingForce,
    GreatestFactor,
    ModeSpeed,
    ShaftOverload,
    chart_resonances,
    greatest_amplitudes,
    greatest_bearing_forces,
    greatest_factor,
    mode_speeds,
    shaft_overloads,
)
from gearcad.dynamics.response.kv_chart import KvChart
from gearcad.dynamics.response.order_chart import OrderChart
from gearcad.dynamics.result_tables import (
    Columns,
    Tables,
    campbell_columns,
    chart_tables,
    cycle_columns,
    modal_tables,
    named_columns,
    order_tables,
    stacked,
)
from gearcad.dynamics.time_domain.spectra import MeshCampbell
from gearcad.dynamics.time_domain.transient_result import Transient
from gearcad.dynamics.tooth_errors.error_result import ErrorStudy
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.pair_on_bearings import BearingModes
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import Direction
from gearcad.dynamics.trains.train import EngagedMesh, Train, TrainModel
from gearcad.dynamics.trains.train_modes import NaturalModes
from gearcad.rating.dynamic_factor import DynamicFactor

__all__ = ["Course", "ModalStudy", "TrainStudy"]


_CYCLES = "mesh stiffness"
"""The table of a pair's curves over one base pitch."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Course:
    """The course at one speed (rpm of the first pinion) over the common period: `turn` (t,) in tooth periods of the first mesh.

    `approach` (t, m) of the flanks in µm, `force` (t, m) in N with that of the dampers, `spring_force` (t, m) without it,
    `shaft_torque` (t, n) in N·m; `kv` (m,) is K_v of each mesh there. The approach is the dynamic transmission error: `line`
    (q, m) are its amplitudes (µm) at `order` (q,), multiples of the tooth frequency of the first mesh.
    """

    speed: float
    kv: Floats
    turn: Floats
    approach: Floats
    force: Floats
    spring_force: Floats
    shaft_torque: Floats
    order: Floats
    line: Floats

    def to_dict(self) -> JsonObject:
        """Return the entry of the course in `dynamics.json`."""
        return {name: value if isinstance(value, float) else value.tolist() for name, value in vars(self).items()}

    def columns(self, meshes: Sequence[str], shafts: Sequence[str], teeth: int) -> Columns:
        """Return the course as a table; `teeth` is the tooth number of the first mesh's pinion."""
        return {
            "turn (tooth periods)": self.turn,
            "time (s)": self.turn * 60 / (self.speed * teeth),
            **named_columns("approach", meshes, self.approach, "µm"),
            **named_columns("force", meshes, self.force, "N"),
            **named_columns("shaft_torque", shafts, self.shaft_torque, "N·m"),
            **named_columns("spring_force", meshes, self.spring_force, "N"),
        }

    def line_columns(self, meshes: Sequence[str], teeth: int) -> Columns:
        """Return the dynamic transmission error order by order; `teeth` is the tooth number of the first mesh's pinion."""
        return {
            "order (of the teeth)": self.order,
            "order (of the pinion)": self.order * teeth,
            "frequency (Hz)": self.order * self.speed * teeth / 60,
            **named_columns("transmission_error", meshes, self.line, "µm"),
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalStudy:
    """Natural modes of a train without loads over speed: it has no meshes, or no damping.

    `transient` is the run in time, where it was asked for; `orders` are the amplitudes over speed of a train without meshes
    that torques on its inertias shake; `found` are notices of the calculation.
    """

    train: Train
    options: DynamicsOptions
    modes: NaturalModes
    transient: Transient | None = None
    orders: OrderChart | None = None
    found: tuple[Notice, ...] = ()

    @property
    def name(self) -> str:
        """Name of the train."""
        return self.train.name

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results."""
        return (*self.found, *_missed(self.train, self.modes))

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def lasting(self, _mesh: int) -> None:
        """Return None: without loads over speed there is no lasting force to compare a run with."""

    def to_dict(self) -> JsonObject:
        """Return the document of the study for `dynamics.json`, without chart and course."""
        return {
            "model": self.train.model.value,
            "modes": self.modes.to_dict(),
            **({} if self.transient is None else {"transient": self.transient.to_dict()}),
            **({} if self.orders is None else {"orders": self.orders.to_dict()}),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        found = _mode_arrays(self.modes) | ({} if self.transient is None else self.transient.arrays())
        return found | ({} if self.orders is None else self.orders.arrays())

    def tables(self) -> Tables:
        """Return the tables of the CSV files by name."""
        found: Tables = {**modal_tables(self.modes)}
        return found | order_tables(self.orders, self.transient)


def _missed(train: Train, modes: NaturalModes) -> tuple[Notice, ...]:
    """Return a notice if the model has fewer natural frequencies than the train."""
    if not modes.missed or train.model is TrainModel.MODES:
        return ()
    text = (
        f"natural frequencies below the highest listed that this model does not have: {modes.missed}; "
        'the model "exact" has them all'
    )
    return (Notice("missed-frequencies", text),)


def _mode_arrays(modes: NaturalModes) -> dict[str, Floats]:
    return {
        "mode_frequency": modes.frequency,
        "mode_shape": modes.shape,
        "shaft_places": modes.places,
        "shaft_shape": modes.shaft_shape,
    }


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainStudy(Pictured):
    """Results for a train: `up` and, where flanks may part, `down` are charts over the same rising speeds.

    `on_bearings` are the modes of the system of the charts, where its gears travel as well; `method_b` is K_v by ISO 6336-1.
    `found` are notices of the calculation itself; `notices` are also those of the charts and modes. `errors` is K_v with tooth
    errors that were drawn: the charts are then those of teeth without errors. `transient` and `campbell` are a run with
    changing speed or torque, and spectra over speed, where they were asked for. `orders` are amplitudes of single orders over
    speed, of a train with torques on its inertias or a run whose orders are tracked.
    """

    train: Train
    options: DynamicsOptions
    system: System
    excitation: Excitation
    modes: NaturalModes
    on_bearings: BearingModes | None
    up: KvChart
    down: KvChart | None
    jumps: tuple[Floats, Floats]
    course: Course
    found: tuple[Notice, ...]
    method_b: DynamicFactor | None
    errors: ErrorStudy | None = None
    transient: Transient | None = None
    campbell: MeshCampbell | None = None
    orders: OrderChart | None = None

    def __repr__(self) -> str:
        return f"<TrainStudy of {self.train.name!r}: {len(self.speeds)} speeds up to {self.speeds.max():.6g} rpm>"

    @property
    def name(self) -> str:
        """Name of the train."""
        return self.train.name

    @property
    def speeds(self) -> Floats:
        """Speeds (s,) of the charts in rpm of the first mesh's pinion."""
        return self.rpm(self.up.frequencies)

    def rpm(self, frequencies: ArrayLike) -> Floats:
        """Return speeds (...) of the first mesh's pinion (rpm) at circular tooth frequencies (...) of that mesh (1/s)."""
        result: Floats = np.asarray(frequencies, float) * 30 / (math.pi * self.train.meshes[0].teeth)
        return result

    @property
    def pairs(self) -> dict[str, EngagedMesh]:
        """The meshes of pairs, by name."""
        return {mesh.name: mesh for mesh in self.train.meshes if isinstance(mesh, EngagedMesh)}

    @property
    def jump_speeds(self) -> dict[Direction, Floats]:
        """Speeds (j,) in rpm at which vibration jumps, running up and running down."""
        return {direction: self.rpm(jumps) for direction, jumps in zip(Direction, self.jumps, strict=True)}

    # ------------------------------------------------------------------ at a glance

    @property
    def charts(self) -> Charts:
        """The charts of both directions, from which findings are made."""
        ratios = tuple(float(mesh.frequency_ratio) for mesh in self.excitation.meshes)
        return Charts(self.speeds, self.up, self.down, ratios)

    @cached_property
    def greatest(self) -> GreatestFactor:
        """The greatest K_v of all meshes, up and down."""
        return greatest_factor(self.charts)

    @cached_property
    def operating(self) -> OperatingRange:
        """Operating range of the train: the speeds at which it runs under load."""
        ends = float(self.speeds[0]), float(self.speeds[-1])
        return operating_range(self.train.speed, self.options, ends).within(self.speeds)

    @cached_property
    def greatest_in_operation(self) -> GreatestFactor:
        """The greatest K_v of all meshes, up and down, where the train runs under load."""
        return greatest_factor(self.charts, self.operating.rows(self.speeds))

    @cached_property
    def resonances(self) -> tuple[ChartResonance, ...]:
        """Maxima of K_v in the charts, mesh by mesh, with the natural frequencies that they meet."""
        return chart_resonances(self.charts, self.modes.circular if self.on_bearings is None else self.on_bearings.excited)

    @cached_property
    def shaft_overloads(self) -> dict[str, ShaftOverload]:
        """Overloads by name of the shafts that carry a torque at rest."""
        return {each.shaft: each for each in shaft_overloads(self.charts)}

    def lasting(self, mesh: int) -> float | None:
        """Return the greatest lasting force over the static one at the speeds and torques of the run in time, in its direction.

        Returns None beyond the chart, where the torques change and forces do not follow them in proportion, and without a run
        whose speed changes.
        """
        if self.transient is None or not self.transient.speed_changes:
            return None
        speeds = np.abs(self.transient.window_speed)
        rising = abs(self.transient.speeds[1]) >= abs(self.transient.speeds[0])
        chart = self.up if rising or self.down is None else self.down
        within = (self.speeds >= speeds.min()) & (self.speeds <= speeds.max())
        covered = self.speeds[0] <= 1.01 * speeds.max() and speeds.max() <= 1.01 * self.speeds[-1] and within.any()
        if not covered:
            return None
        if self.transient.whole_load.all():
            return float(chart.factors[within, mesh].max())
        lasting = self.lasting_course(chart, mesh)
        return float(lasting.max()) if np.isfinite(lasting).all() else None

    def lasting_course(self, chart: KvChart, mesh: int) -> Floats:
        """Return the lasting force over the static one at the speed and torque of every window (w,) of the run in time.

        Values that are not known are nan. Where flanks stay together and teeth have no errors, forces are proportional to the
        torques.
        """
        run = self.transient
        assert run is not None  # whoever asks has it
        speeds = np.abs(run.window_speed)
        within = (self.speeds >= 0.99 * speeds.min()) & (self.speeds <= 1.01 * speeds.max())
        parts = self.excitation.parting and bool(chart.apart[within].any() or run.window_torque.min() < 0)
        known = run.whole_load if parts or any(each.error is not None for each in self.excitation.meshes) else True
        lasting = np.abs(run.window_torque) * np.interp(speeds, self.speeds, chart.factors[:, mesh])
        return np.where(known, lasting, np.nan)

    @cached_property
    def greatest_amplitudes(self) -> tuple[GreatestAmplitude, ...]:
        """Greatest amplitudes of inertias, meshes, and axes on bearings."""
        return greatest_amplitudes(self.charts)

    @cached_property
    def greatest_bearing_forces(self) -> tuple[GreatestBearingForce, ...]:
        """Greatest bearing forces of gears on bearings."""
        return greatest_bearing_forces(self.charts)

    @property
    def mode_speeds(self) -> tuple[ModeSpeed, ...]:
        """Speeds at which tooth frequencies are natural ones, or half of those that bend teeth."""
        others = () if self.on_bearings is None else tuple((self.on_bearings.excited / (2 * np.pi)).tolist())
        return mode_speeds(self.modes, self.train.meshes[0].teeth, others)

    @property
    def course_lasts(self) -> bool:
        """Whether the motion at the speed of the chart next to that of the course is stable."""
        return bool(self.up.stable[int(np.abs(self.speeds - self.course.speed).argmin())])

    # ------------------------------------------------------------------ documents

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results."""
        down = self.down.notices if self.down is not None else ()
        drawn = self.errors.notices if self.errors is not None else ()
        return tuple(dict.fromkeys((*self.found, *self.up.notices, *down, *drawn, *_missed(self.train, self.modes))))

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the document of the study for `dynamics.json`; frequencies in Hz and 1/s, speeds in rpm."""
        return {
            "model": self.train.model.value,
            "modes": self.modes.to_dict(),
            "modes_on_bearings": None if self.on_bearings is None else self.on_bearings.to_dict(),
            "speed": self.speeds.tolist(),
            "chart": self.up.to_dict(),
            "chart_down": None if self.down is None else self.down.to_dict(),
            **{f"jumps_{direction.value}": speeds.tolist() for direction, speeds in self.jump_speeds.items()},
            "resonance_speed_iso6336": None if self.method_b is None else self.method_b.resonance_speed,
            "course": self.course.to_dict(),
            "tooth_errors": None if self.errors is None else self.errors.to_dict(),
            "greatest": self.greatest.to_dict(),
            "operation": {**self.operating.to_dict(), "greatest": self.greatest_in_operation.to_dict()},
            "transient": None if self.transient is None else self.transient.to_dict(),
            "campbell": None if self.campbell is None else self.campbell.to_dict(),
            "resonances": [each.to_dict() for each in self.resonances],
            "shaft_overloads": [each._asdict() for each in self.shaft_overloads.values()],
            "greatest_amplitudes": [each.to_dict() for each in self.greatest_amplitudes],
            "greatest_bearing_forces": [each.to_dict() for each in self.greatest_bearing_forces],
            **({} if self.orders is None else {"orders": self.orders.to_dict()}),
            **({"pairs": {name: mesh.pair_document() for name, mesh in self.pairs.items()}} if self.pairs else {}),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        found = {
            "speed": self.speeds,
            **self.up.arrays(),
            **_mode_arrays(self.modes),
            **{f"course_{name}": np.asarray(value) for name, value in vars(self.course).items()},
        }
        if self.down is not None:
            found |= {f"{name}_down": values for name, values in self.down.arrays().items()}
        if self.up.standard is not None:
            found["kv_iso6336"] = self.up.standard
        found |= {} if self.errors is None else self.errors.arrays()
        found |= {} if self.transient is None else self.transient.arrays()
        found |= {} if self.orders is None else self.orders.arrays()
        return found | ({} if self.campbell is None else self.campbell.arrays())

    def tables(self) -> Tables:
        """Return the tables of the CSV files by name."""
        up = self.up
        found: Tables = {
            **chart_tables(self.charts),
            **modal_tables(self.modes),
            "course": self.course.columns(up.mesh_names, up.shaft_names, self.train.meshes[0].teeth),
            "course lines": self.course.line_columns(up.mesh_names, self.train.meshes[0].teeth),
            **stacked("mesh", list(self.pairs), [{_CYCLES: cycle_columns(mesh.course.cycle)} for mesh in self.pairs.values()]),
        }
        found |= {} if self.errors is None else {"tooth errors": self.errors.columns()}
        found |= order_tables(self.orders, self.transient)
        return found | ({} if self.campbell is None else {"campbell": campbell_columns(self.campbell)})
