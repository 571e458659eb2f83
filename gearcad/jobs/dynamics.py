"""Job `dynamics`: vibration of a pair or a train, also of several designs side by side."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from gearcad.check.options import CheckOptions
from gearcad.core.errors import GeometryError, InputError, ParameterError, SolverError
from gearcad.core.quantities import with_assumed
from gearcad.core.records import JsonObject, Notice, PerGear, Role
from gearcad.core.runtime import Agenda, Expected, Progress, one_thread
from gearcad.designs import Design, DesignKind, Inputs, PairDesign, RackPairDesign, TrainDesign
from gearcad.designs.cells import cell_text, guarded_text, write_csv
from gearcad.designs.spec_writers import pair_specs
from gearcad.designs.variations import Variants
from gearcad.dynamics.engagement import engaged
from gearcad.dynamics.level_study import study_levels
from gearcad.dynamics.level_verdict import LevelStudy, finest_first
from gearcad.dynamics.options import DynamicsOptions, PairModel, idle_without_levels
from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.pair_study import require_rack_options, study_contact, study_pair
from gearcad.dynamics.sound import sound_of
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.dynamics.train_study import expected_train, study_modes, study_torques, study_train, study_undamped
from gearcad.dynamics.trains.steady_response import UndampedError
from gearcad.dynamics.trains.train import Train
from gearcad.dynamics.variant_comparison import SideBySide
from gearcad.geometry import GearPair, RackPair
from gearcad.geometry.gear import refuse_halves
from gearcad.jobs.job import ReportedJob, Writer, as_design
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.version import __version__


def table_files(verb: str, tables: Mapping[str, Mapping[str, NDArray[Any] | Sequence[Any]]]) -> dict[str, Writer]:
    """Return the writers of a result's tables by file name, `VERB-NAME.csv`.

    Each table holds columns by their headings.
    """
    return {file_name(verb, name): partial(_write_table, columns) for name, columns in tables.items()}


def file_name(verb: str, table: str) -> str:
    """Return the file name of a table: `VERB-TABLE.csv`."""
    return f"{verb}-{table.replace(' ', '-').replace('_', '-')}.csv"


def _write_table(columns: Mapping[str, NDArray[Any] | Sequence[Any]], path: Path) -> None:
    write_csv(zip(*map(_cells, columns.values()), strict=True), map(guarded_text, columns), path)


def _cells(values: NDArray[Any] | Sequence[Any]) -> list[str]:
    """Return the cells of a column as texts; nan gives an empty cell."""
    if isinstance(values, np.ndarray) and values.dtype == float:
        return [repr(value) if value == value else "" for value in values.tolist()]
    listed = values.tolist() if isinstance(values, np.ndarray) else values
    return ["" if isinstance(value, float) and math.isnan(value) else cell_text(value) for value in listed]


_OF_PAIRS = (
    "model stiffness_method mesh_stiffness_mean mesh_stiffness_tangent_mean pinion_inertia wheel_inertia tooth_stiffness"
    " tooth_damping natural_frequency damping_ratio static_approach contact_ratio resonance_speed_iso6336"
).split()
"""Values that a line takes from the document unchanged."""

_MOST_FREQUENCIES = 6
"""Natural frequencies above 0 that a line has of a train."""


def dynamics_columns(document: Mapping[str, Any]) -> JsonObject:
    """Return the figures of a document of dynamics for one line of a table.

    Of a pair: inertias and stiffness, its natural frequency, K_v at the speed and the highest. Of a train: its first natural
    frequencies, K_v of each mesh at the speed and the highest, and the highest overload of each shaft.
    """
    if document["model"] not in (model.value for model in PairModel):
        return _dynamics_columns_of_train(document)
    found = {name: document[name] for name in _OF_PAIRS if name in document}
    if document["model"] != PairModel.MESH.value:
        return {**found, "warnings": document["campbell"]["warnings"]}
    modes, course = document["modes"], document["course"]
    (kv,) = course["kv"]
    (over_speed,) = document["chart"]["kv"].values()
    highest = max(range(len(over_speed)), key=over_speed.__getitem__)
    found |= {
        "natural_frequency": modes["frequency"][modes["rigid"]],
        "course_speed": course["speed"],
        "kv": kv,
        "kv_highest": over_speed[highest],
        "kv_highest_speed": document["speed"][highest],
        **dict(_with_errors(document, named=False)),
    }
    return {**found, "warnings": document["warnings"]}


def _dynamics_columns_of_train(document: Mapping[str, Any]) -> JsonObject:
    modes = document["modes"]
    elastic = modes["frequency"][modes["rigid"] :][:_MOST_FREQUENCIES]
    found = {f"frequency_{number}": each for number, each in enumerate(elastic, 1)}
    if "chart" in document:
        greatest, course = document["greatest"], document["course"]
        found |= {
            "kv_highest": greatest["factor"],
            "kv_highest_speed": greatest["speed"],
            "kv_highest_mesh": greatest["mesh"],
            "course_speed": course["speed"],
            **{f"kv.{name}": kv for name, kv in zip(document["chart"]["kv"], course["kv"], strict=True)},
            **dict(_highest(document, "kv", "kv_highest")),
            **dict(_highest(document, "shaft_overload", "shaft_overload")),
            **dict(_with_errors(document, named=True)),
        }
    return {**found, "warnings": document["warnings"]}


def _highest(document: Mapping[str, Any], of: str, column: str) -> Iterator[tuple[str, float]]:
    """Yield the highest value of each mesh or shaft, running up or down, and its speed; none of shafts without load at rest."""
    charts = [chart for chart in (document["chart"], document["chart_down"]) if chart is not None]
    for name in charts[0][of]:
        over_speed = [
            max(factors) for factors in zip(*(chart[of][name] for chart in charts), strict=True) if None not in factors
        ]
        if over_speed:
            row = max(range(len(over_speed)), key=over_speed.__getitem__)
            yield f"{column}.{name}", over_speed[row]
            yield f"{column}_speed.{name}", document["speed"][row]


def _with_errors(document: Mapping[str, Any], *, named: bool) -> Iterator[tuple[str, float]]:
    """Yield the highest median of K_v and its highest upper quantile, where errors of teeth were drawn; of which mesh, if
    `named`.
    """
    drawn = document.get("tooth_errors")
    for each in () if drawn is None else drawn["greatest"]:
        behind = f".{each['mesh']}" if named else ""
        for column, key in (("kv_errors_median", "median"), ("kv_errors_upper", "upper")):
            yield column + behind, each[key]


Study = TrainStudy | ModalStudy | SideBySide | PairStudy | ContactStudy

_TRAIN = {"modes": 1.0, "chart": 20.0, "course": 2.0}
"""Steps with a guess of what each takes."""

_PAIR = {
    PairModel.MESH: {"inertias": 1.0, "mesh stiffness": 10.0, **_TRAIN},
    PairModel.CONTACT: {"inertias": 1.0, "mesh stiffness": 5.0, "campbell": 40.0, "history": 1.0},
}

_ERRORS = "tooth errors"
"""A step of those that draw them, and their table."""

_OVER_SPEED = ("displacements", "transmission error", "bearings")
_TABLES = (
    *("chart", *_OVER_SPEED, *(f"{name} down" for name in _OVER_SPEED), "modes", "component modes", "course", "course lines"),
    *("mesh stiffness", "campbell", "history", "spectrum", _ERRORS, "transient", "orders", "order tracks"),
)
"""Names of the tables that every result has."""


@dataclass(frozen=True, kw_only=True)
class Dynamics(ReportedJob[PairDesign | RackPairDesign | TrainDesign, Study]):
    """The study for which [dynamics] of a design asks; with `wav` its sound as well, in dynamics.wav."""

    wav: bool = False
    verb = "dynamics"
    accepts = (DesignKind.PAIR, DesignKind.RACK_PAIR, DesignKind.TRAIN)
    why = "a single gear has no mesh"
    sometimes = ("dynamics.wav", *(file_name("dynamics", name) for name in _TABLES))

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> Study:
        design = self.accepted(design, progress)
        if isinstance(design, TrainDesign):
            return _of_train(design, progress)
        return _of_pair(design, progress)

    def expected(self, design: Design) -> Expected | None:
        """Return the expected effort of a train's runs in time, which may take minutes, or None."""
        design = self.accepted(design)
        if not isinstance(design, TrainDesign) or not design.train.meshes:
            return None
        if design.other_models or not (design.dynamics.drawn or design.dynamics.spectra):
            return None
        try:
            return expected_train(design.train, design.dynamics)
        except (InputError, SolverError):
            return None  # `run` says why

    def document(self, result: Study) -> JsonObject:
        """Return the content of dynamics.json: everything but the long arrays."""
        sound = {"sound": sound_of(result).to_dict()} if self.wav else {}
        return with_assumed({"kind": "dynamics", "name": result.name, "gearcad": __version__, **result.to_dict(), **sound})

    def notices(self, result: Study) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the figures for one line of a table."""
        return dynamics_columns(document)

    def files(self, result: Study) -> dict[str, Writer]:
        """Return the report, the document, the arrays, the tables, and the specs of a train's pairs."""
        return {
            **({"dynamics.html": partial(_write_report, result, self.head)} if self.report else {}),
            "dynamics.json": partial(self.write_document, result),
            "dynamics.npz": partial(_write_arrays, result),
            **({"dynamics.wav": sound_of(result).write} if self.wav else {}),
            **table_files(self.verb, result.tables()),
            **{name: partial(_write_text, text) for name, text in specs_of(result).items()},
        }


def specs_of(result: Study) -> dict[str, str]:
    """Return the specs of a train's pairs, by file name; empty if it has none.

    For several studies of one train, the specs are those of the reference study.
    """
    first = result.studies[result.reference] if isinstance(result, SideBySide) else result
    return pair_specs(first) if isinstance(first, TrainStudy) else {}


def _write_text(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")


def _write_report(study: Study, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report import write_dynamics_report

    write_dynamics_report(study, study.name, path, head)


def _write_arrays(study: Study, path: Path) -> None:
    with path.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **study.arrays())


def _of_train(design: TrainDesign, progress: Progress | None) -> TrainStudy | ModalStudy | LevelStudy:
    """Return the study of a train by one model, or by several side by side."""
    train, options, before = design.train, design.dynamics, dict[str, float]()
    if not train.meshes and not train.excitations:
        return study_modes(train, options)
    if not train.meshes:
        return study_torques(train, options, tell=Agenda(progress, _steps({"modes": 1.0, "chart": 2.0}, options)))
    every, steps = finest_first(design.models), _steps(_TRAIN, options, orders=bool(train.excitations))
    if any(mesh.pair is not None for mesh in train.meshes):
        before = {"mesh stiffness": 10.0}
        Agenda(progress, {**before, **steps})("mesh stiffness")
        train = engaged(replace(train, model=every[0]), options)
    if design.other_models:
        agenda = Agenda(progress, before | {f"{each.value}: {step}": took for each in every for step, took in steps.items()})
        try:
            return study_levels(train, design.models, options, tell=agenda)
        except UndampedError as error:
            raise UndampedError(f"{error}; one model alone {_ALONE}") from None
    agenda = Agenda(progress, {**before, **steps})
    study: TrainStudy | ModalStudy
    try:
        study = study_train(train, options, tell=agenda, share=agenda.within("chart"), drawn=agenda.within(_ERRORS))
    except UndampedError:
        study = study_undamped(train, options, tell=agenda)
    return replace(study, found=(*idle_without_levels(options), *study.found))


_ALONE = "has its natural frequencies without damping and, with [dynamics.transient], a run in time"
"""End of the message for an undamped train that is not overlaid with another: what it does have."""


def _of_pair(design: PairDesign | RackPairDesign, progress: Progress | None) -> PairStudy | ContactStudy:
    if design.load is None or not design.load.torque:
        given = None if design.load is None else design.load.torque
        raise ParameterError(
            "load.torque", given, "must be given, in N·m on the pinion: without load the flanks rattle, which is not modelled"
        )
    refuse_halves(design.pair.pinion, "dynamics")
    options, material = design.dynamics or DynamicsOptions(), design.material or Material()
    if isinstance(design, RackPairDesign):
        return _of_rack(design, design.load, options, progress)
    if options.rack_mass is not None:
        raise ParameterError("dynamics.rack_mass", options.rack_mass, "must be left out for a pair of gears", "kg")
    pair = design.pair if design.mounting is None else design.mounting.mounted(design.pair)
    contact = options.pair_model is PairModel.CONTACT
    if contact and pair.pinion.helix_angle:
        permitted = 'must be 0 for model "contact": its pairs of teeth touch over their whole width at once'
        raise GeometryError("pair.helix_angle", pair.pinion.helix_angle, permitted, "deg")
    agenda = Agenda(progress, _steps(_PAIR[options.pair_model], options))
    agenda("inertias")
    inertias = PerGear.each(lambda role: _inertia(role, pair, design.materials.pick(role), options))
    agenda("mesh stiffness")
    if contact:
        cycle = _mesh_cycle(design, design.load, options) if options.tooth_stiffness is None else None
        return study_contact(
            pair, design.load, cycle, inertias, options, tell=agenda, counted=agenda.counted("campbell", "speed")
        )
    cycle = _mesh_cycle(design, design.load, options)
    masses = _masses(pair, design.materials) if options.pinion_bearing_stiffness is not None else None
    return study_pair(
        pair,
        material,
        design.load,
        cycle,
        inertias,
        options,
        rating=design.rating,
        masses=masses,
        tell=agenda,
        share=agenda.within("chart"),
        drawn=agenda.within(_ERRORS),
    )


def _of_rack(design: RackPairDesign, load: Load, options: DynamicsOptions, progress: Progress | None) -> PairStudy:
    """Return the study of a pinion and a rack, whose mass is that of its solid unless it is given."""
    from gearcad.solids.exact.inertia import mass_properties, rack_mass
    from gearcad.stiffness.methods import METHODS

    pair, materials = design.pair, design.materials
    if options.pair_model is PairModel.CONTACT:
        raise ParameterError("dynamics.model", options.model, 'must be "mesh" for a rack: "contact" is of gears only')
    if options.wheel_inertia is not None:
        permitted = "must be left out for a rack, which has rack_mass (kg)"
        raise ParameterError("dynamics.wheel_inertia", options.wheel_inertia, permitted, "kg·m²")
    require_rack_options(pair, options)
    kind = METHODS[options.method_for(pair)]
    agenda = Agenda(progress, _steps(_PAIR[options.pair_model], options))
    agenda("inertias")
    turning = options.pinion_inertia or mass_properties(pair.pinion, materials.pinion.density).inertia
    mass = options.rack_mass or rack_mass(pair.rack, materials.wheel.density)
    inertias = PerGear(turning, mass * (pair.pitch_radius / 1000) ** 2)
    agenda("mesh stiffness")
    material = design.material or Material()
    cycle = kind(pair=pair, material=material, body=(design.check or CheckOptions()).body)(load)
    return study_pair(
        pair, material, load, cycle, inertias, options, rating=design.rating, tell=agenda, share=agenda.within("chart")
    )


def _steps(steps: Mapping[str, float], options: DynamicsOptions, *, orders: bool = False) -> Mapping[str, float]:
    """Return the steps with their expected seconds, and with those for drawn tooth errors, motions in time and spectra.

    `orders`: amplitudes of orders are charted, whatever the options.
    """
    drawn = options.drawn and options.pair_model is PairModel.MESH
    more = {_ERRORS: 2.0 * options.error_samples} if drawn else {}
    more |= {} if options.transient is None else {"transient": 10.0}
    more |= {"orders": 2.0} if orders or (options.transient is not None and options.transient.tracked) else {}
    return {**steps, **more, **({"campbell": 40.0} if options.spectra else {})}


def _mesh_cycle(design: PairDesign, load: Load, options: DynamicsOptions) -> MeshCycle:
    """Return the mesh cycle by the method of the options; [check] says how the bodies are held."""
    from gearcad.stiffness.methods import METHODS  # only here: trains without pairs do not need them

    mounting, body = design.mounting or Mounting(), (design.check or CheckOptions()).body
    kind = METHODS[options.method_for(mounting.mounted(design.pair))]
    return kind(pair=design.pair, material=design.material or Material(), body=body, mounting=mounting)(load)


def _inertia(role: Role, pair: GearPair, material: Material, options: DynamicsOptions) -> float:
    """Return the inertia of a gear (kg·m²): the given one, otherwise that of its solid."""
    if (given := options.inertias.pick(role)) is not None:
        return given
    from gearcad.solids.exact.inertia import mass_properties

    return mass_properties(pair.gears.pick(role), material.density).inertia


def _masses(pair: GearPair, materials: PerGear[Material]) -> PerGear[float]:
    """Return the masses of pinion and wheel (kg), computed from their solids."""
    from gearcad.solids.exact.inertia import mass_properties

    return PerGear.each(lambda role: mass_properties(pair.gears.pick(role), materials.pick(role).density).mass)


def dynamics(
    subject: Design | GearPair | RackPair | Train,
    load: Load | None = None,
    *,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> Study:
    """Return the dynamics of a pair as mounted, under a load, or of a train: natural frequencies, K_v over speed, one speed's
    course.

    `material`, `mounting`, `check` (CheckOptions: where bodies are held), `dynamics` (DynamicsOptions) and `rating`, as the
    load, stand in place of those of a design; a pair has the defaults, and a train holds its own.

    Raises ParameterError without a pair or a load, and what the solvers raise.
    """
    design = TrainDesign(name=subject.name, train=subject) if isinstance(subject, Train) else subject
    return Dynamics().run(as_design(design, load, **inputs), progress)


@dataclass(frozen=True, kw_only=True)
class DynamicsBeside(Dynamics):
    """The studies for which [dynamics] of each of the `variants` asks; the design that is run is the first of them."""

    variants: Variants

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> Study:
        design = self.accepted(design, progress)
        designs = [self.accepted(each) for each in self.variants.designs]
        for each in designs:
            _require_chart(each)
        count, studies = len(designs), []
        for number, (label, each) in enumerate(zip(self.variants.labels, designs, strict=True)):
            own = None if progress is None else partial(_report_progress, progress, label, number, count)
            studies.append(_over_speed(super().run(each, own), label))
        of = self.variants
        return SideBySide(name=design.name, what=of.what, labels=of.labels, studies=tuple(studies), key=of.key)


def _report_progress(progress: Progress, label: str, before: int, count: int, step: str, done: float, of: float) -> None:
    """Tell how far one of several studies is."""
    progress(f"{label}: {step}", before + done / of, count)


def _require_chart(design: PairDesign | RackPairDesign | TrainDesign) -> None:
    """Raise ParameterError for a design without a chart of K_v, or with several."""
    if isinstance(design, TrainDesign):
        if design.other_models:
            listed = ", ".join(each.value for each in design.models)
            permitted = "must be one word beside other values that vary: write one, or give several by --vary train.model=..."
            raise ParameterError("train.model", listed, permitted)
        if not design.train.meshes:
            raise ParameterError(
                "vary", None, "needs meshes: without teeth a train has no load over speed to be laid over another"
            )
    elif (design.dynamics or DynamicsOptions()).pair_model is PairModel.CONTACT:
        permitted = (
            'must be "mesh" to vary something: a contact model has a Campbell diagram, and no K_v over speed to be laid over '
            "another; give one value at a time by --vary, with a folder of its own for each (-o)"
        )
        raise ParameterError("dynamics.model", PairModel.CONTACT.value, permitted)


def _over_speed(study: Study, label: str) -> TrainStudy:
    """Return the study of a train, or of a pair as a train, with all its notices.

    Raises UndampedError, with the label of the variant, if it has no loads over speed.
    """
    if isinstance(study, ModalStudy):
        raise UndampedError(f"{label}: no loads over speed without damping to be laid over others; this variant alone {_ALONE}")
    if isinstance(study, PairStudy):
        return replace(study.study, found=tuple(dict.fromkeys((*study.study.found, *study.notices))))
    assert isinstance(study, TrainStudy)  # _require_chart has seen to it
    return study
