"""A train with its torques and its model, the parts that a model has (SI units), and its document."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from enum import Enum
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import GeometryError, ParameterError, require_name
from gearcad.core.quantities import SPEED, TORQUE, Whole, Words, require_fields
from gearcad.core.records import Floats, JsonObject, Notice, concise
from gearcad.dynamics.trains.members import GROUND, Graph, Inertia, MeshCourse, MeshPair, Shaft, ToothMesh, turning_pieces
from gearcad.dynamics.trains.solid_inertias import with_solids
from gearcad.dynamics.trains.torque_excitation import TorqueExcitation, require_excitations


class TrainModel(Enum):
    """Model of the shafts of a train: the levels of modelling of Osinski's paper, and what lies beyond them."""

    ISOLATED = "isolated"
    """No shafts: the meshes and the inertias in them, loaded by the mesh forces of the whole train."""
    MASSLESS = "massless"
    """Shafts are springs without mass."""
    MODES = "modes"
    """Shafts have mass; each line of shafts and inertias keeps its first modes (the paper's quasi-normal coordinates)."""
    ELEMENTS = "elements"
    """Shafts have mass; one hierarchical element of degree `order` each, which is good for order/3 half waves or so."""
    EXACT = "exact"
    """Natural frequencies of the wave equation itself; response as with elements, of a higher degree where it is needed."""


@dataclass(frozen=True, kw_only=True)
class Train:
    """Inertias, the shafts between them, the meshes of their teeth, the torques on them, and what excites them besides teeth.

    `model` says what is known of the shafts: one word changes it. `torques` in N·m by the names of inertias, counter-clockwise
    positive; on a train that no shaft holds they must balance. `speed` in rpm is that of the first mesh's pinion. `order` is
    the degree of the polynomials on a shaft with mass. Raises ParameterError and GeometryError.
    """

    name: str = "train"
    model: Annotated[TrainModel, Words("what is known of the shafts")] = TrainModel.ELEMENTS
    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...] = ()
    meshes: tuple[ToothMesh, ...] = ()
    torques: Mapping[str, float] = field(default_factory=dict)
    speed: Annotated[float, SPEED, Words("speed of the first mesh's pinion", "n_1")] = 0.0
    order: Annotated[int, Whole(2, 40), Words("degree of the polynomials on a shaft with mass")] = 12
    excitations: tuple[TorqueExcitation, ...] = ()

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("name", self.name)
        require_fields(self)
        for parameter in ("inertias", "shafts", "meshes", "excitations"):
            object.__setattr__(self, parameter, tuple(getattr(self, parameter)))
        object.__setattr__(self, "torques", dict(self.torques))
        for inertia, torque in self.torques.items():
            TORQUE.require(f"torques.{inertia}", torque)
        self._graph.require_one_train(self.torques)
        require_excitations(self.excitations, [inertia.name for inertia in self.inertias])
        object.__setattr__(self, "inertias", with_solids(self.inertias, self.meshes))
        object.__setattr__(self, "shafts", tuple(shaft.on_gears(self.meshes) for shaft in self.shafts))
        if self.model is TrainModel.ISOLATED and not self.meshes:
            raise GeometryError(
                "model", self.model, "must be a model with shafts: this one leaves shafts out, and the train has no meshes"
            )
        if not self.held:
            self._graph.require_balance(self.torques)
        self._check_modes()

    def _check_modes(self) -> None:
        """Raise ParameterError for a shaft with too many modes: elements of a low degree have no accurate high modes."""
        for shaft in self.shafts if self.model is TrainModel.MODES else ():
            if shaft.torsional_stiffness is None and shaft.modes is not None and 2 * shaft.modes > self.order:
                permitted = f"must be at most half the order {self.order} of the elements, for accurate modes"
                raise ParameterError(f"{shaft.name}.modes", shaft.modes, permitted)

    @property
    def held(self) -> bool:
        """Whether a shaft holds the train; otherwise the train can turn as a whole, at 0 Hz."""
        return any(shaft.held for shaft in self.shafts)

    @property
    def _graph(self) -> Graph:
        return Graph(self.inertias, self.shafts, self.meshes)

    @property
    def reference(self) -> str:
        """Name of the inertia whose speed is that of the train: the first mesh's pinion, or else the first inertia."""
        return self._graph.reference

    @cached_property
    def speed_ratios(self) -> dict[str, float]:
        """Nominal turns of every inertia per turn of the first mesh's pinion, counter-clockwise positive."""
        return self._graph.speed_ratios()

    @property
    def tooth_frequencies(self) -> dict[str, float]:
        """Tooth frequency (Hz) of every mesh at `speed`, by the names of meshes."""
        return {mesh.name: abs(self.speed_ratios[mesh.pinion] * self.speed) * mesh.teeth / 60 for mesh in self.meshes}


@dataclass(frozen=True, kw_only=True)
class EngagedMesh(ToothMesh):
    """A mesh of a pair, and the `course` of its stiffness and transmission error: `stiffness` is the mean of the tangent."""

    course: MeshCourse

    __repr__ = concise

    @property
    def teeth_of(self) -> MeshPair:
        """Pair of the mesh."""
        assert isinstance(self.pair, MeshPair)  # it became one when the mesh was made
        return self.pair

    def pair_document(self) -> JsonObject:
        """Return the pair's part of `dynamics.json`.

        Torque in N·m on the pinion, force in N, stiffness in N/µm, errors and backlash in µm, phase in tooth periods.
        """
        course, cycle = self.course, self.course.cycle
        return {
            "pair": self.teeth_of.pair.name,
            "stiffness_method": cycle.method,
            "torque": course.torque,
            "driver": course.driver.value,
            "force": cycle.force,
            "mesh_stiffness_mean": cycle.mean,
            "mesh_stiffness_tangent_mean": cycle.tangent_mean,
            "transmission_error_peak_to_peak": cycle.error_peak_to_peak,
            "backlash": self.backlash,
            "damping_ratio": self.damping_ratio,
            "damping": self.damping,
            "phase": self.phase,
            "rounds": course.rounds,
        }

    @property
    def _stiffness_of_pair(self) -> float:
        return self.course.cycle.tangent_mean


def require_known(mesh: ToothMesh) -> None:
    """Raise ParameterError for a mesh of a pair whose stiffness is not known yet."""
    if mesh.pair is not None and not isinstance(mesh, EngagedMesh):
        permitted = "is not known before the load of its pair: gearcad.dynamics.engaged(train) has it"
        raise ParameterError(f"{mesh.name}.stiffness", None, permitted, "N/µm")


_NO_FORCE = 1e-9
"""Share of the greatest mesh force below which a force is rounding and does not decide which flanks carry."""


@dataclass(frozen=True, eq=False)
class Parts:
    """Parts of a train's model: `inertia` (i,) in kg·m², `approach` (i, m) in m/rad and `stiffness` (m,) in N/m of each mesh.

    `torque` (i,) in N·m on each inertia includes that of preloads. `free` (i, r): speeds of each of r pieces that no shaft
    holds.
    """

    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...]
    meshes: tuple[ToothMesh, ...]
    inertia: Floats
    approach: Floats
    stiffness: Floats
    torque: Floats
    free: Floats

    @property
    def ends(self) -> NDArray[np.int64]:
        """Places (s, 2) of each shaft's ends among the inertias, -1 for ground."""
        places = {inertia.name: place for place, inertia in enumerate(self.inertias)} | {GROUND: -1}
        return np.array([(places[s.start], places[s.end]) for s in self.shafts], dtype=np.int64).reshape(-1, 2)


def _whole_train(train: Train) -> Parts:
    """Return the parts of a train with all shafts, whatever the model.

    The approach of a mesh is positive where its flanks are pressed.
    """
    parts = _parts(train)
    parts = _turned(parts, _mesh_forces(parts))
    parts = replace(parts, torque=parts.torque + parts.approach @ _preloads(train))
    # Once more, for meshes that the torques leave alone: another's preload may turn them round.
    return _turned(parts, _mesh_forces(parts))


def parts_of(train: Train) -> Parts:
    """Return the parts of the train's model.

    Isolated meshes carry the forces that torques give them in the whole train, and their preloads.
    """
    if train.model is not TrainModel.ISOLATED:
        return _whole_train(train)
    whole = _parts(train)
    forces = _mesh_forces(whole)
    whole = _turned(whole, forces)
    geared = [place for place, row in enumerate(whole.approach) if row.any()]
    inertias = tuple(whole.inertias[place] for place in geared)
    return replace(
        whole,
        inertias=inertias,
        shafts=(),
        inertia=whole.inertia[geared],
        approach=whole.approach[geared],
        torque=whole.approach[geared] @ (np.abs(forces) + _preloads(train)),
        free=_free_turns(inertias, (), whole.meshes),
    )


def static_forces(train: Train) -> Floats:
    """Return the mean force (m,) in every mesh (N), with torques and preloads at rest."""
    return np.abs(_mesh_forces(parts_of(train)))


def require_pressed(train: Train) -> None:
    """Raise GeometryError for a mesh without a force on its flanks: loads over speed refer to that force."""
    forces = static_forces(train)
    if forces.min() <= _NO_FORCE * forces.max():
        mesh = train.meshes[int(forces.argmin())]
        permitted = "must be above 0 where no torque presses the flanks of this mesh: K_v refers to that force"
        raise GeometryError(f"{mesh.name}.preload", mesh.preload, permitted, "N")


def pressing_forces(train: Train) -> Floats:
    """Return the mean forces (m,) in N of the meshes with their signs.

    They are positive where a torque that is counter-clockwise on the pinion presses the flanks.
    """
    parts = parts_of(train)
    places = [inertia.name for inertia in parts.inertias]
    turned = [parts.approach[places.index(mesh.pinion), column] for column, mesh in enumerate(parts.meshes)]
    return np.copysign(_mesh_forces(parts), turned)


def _parts(train: Train) -> Parts:
    """Return the parts of the whole train under its torques alone, with the approach as both gears turn counter-clockwise."""
    names = [inertia.name for inertia in train.inertias]
    approach = np.zeros((len(names), len(train.meshes)))
    for column, mesh in enumerate(train.meshes):
        require_known(mesh)
        for gear, radius in zip(mesh.gears, mesh.radii, strict=True):
            approach[names.index(gear), column] = radius
    return Parts(
        inertias=train.inertias,
        shafts=train.shafts,
        meshes=train.meshes,
        inertia=np.array([inertia.inertia for inertia in train.inertias]),
        approach=approach,
        stiffness=np.array([mesh.stiffness * 1e6 for mesh in train.meshes]),
        torque=np.array([train.torques.get(name, 0.0) for name in names]),
        free=_free_turns(train.inertias, train.shafts, train.meshes),
    )


def _preloads(train: Train) -> Floats:
    """Return the force (m,) in N that presses each mesh beside the torques."""
    return np.array([mesh.preload for mesh in train.meshes])


def _free_turns(inertias: Sequence[Inertia], shafts: Sequence[Shaft], meshes: Sequence[ToothMesh]) -> Floats:
    """Return the speeds (i, r) of the inertias of each piece that turns as a whole."""
    names = [inertia.name for inertia in inertias]
    held = {end for shaft in shafts if shaft.held for end in (shaft.start, shaft.end)}
    pieces = [piece for piece in turning_pieces(names, shafts, meshes) if not held & piece.keys()]
    return np.array([[piece.get(name, 0.0) for piece in pieces] for name in names]).reshape(len(names), len(pieces))


def _mesh_forces(parts: Parts) -> Floats:
    """Return the mesh forces (m,) in N of the static train with massless shafts; parts that turn freely are held in place."""
    k = (parts.approach * parts.stiffness) @ parts.approach.T
    for shaft, ends in zip(parts.shafts, parts.ends, strict=True):
        twist = np.zeros(len(k))
        twist[[end for end in ends if end >= 0]] = [sign for end, sign in zip(ends, (-1.0, 1.0), strict=True) if end >= 0]
        k += shaft.stiffness * np.outer(twist, twist)
    turns = parts.free / np.linalg.norm(parts.free, axis=0)
    k += np.trace(k) / len(k) * turns @ turns.T
    result: Floats = parts.stiffness * (parts.approach.T @ np.linalg.solve(k, parts.torque))
    return result


def _turned(parts: Parts, forces: Floats) -> Parts:
    """Return the parts with the approach reversed where the other flanks carry."""
    other = forces < -_NO_FORCE * np.abs(forces).max(initial=0.0)
    return replace(parts, approach=parts.approach * np.where(other, -1.0, 1.0))


_PER_HALF_WAVE, _HIGHEST = 3, 40
"""Degrees of an element for each half wave in it, and the highest degree there is."""


def _half_waves(train: Train) -> float:
    """Return omega L / (pi c) of the longest shaft and the quickest mesh, at 1 rpm of the first pinion.

    It is 0 for shafts without mass.
    """
    quickest = max(abs(train.speed_ratios[mesh.pinion]) * mesh.teeth for mesh in train.meshes) * math.pi / 30
    return quickest / math.pi * max((math.sqrt(shaft.inertia / shaft.stiffness) for shaft in train.shafts), default=0.0)


def fitted(train: Train, speed: float) -> Train:
    """Return the train, its order raised if it is too low for charts up to a speed (rpm of the first pinion).

    Only the order of a train of the model "exact" is raised.
    """
    wanted = math.ceil(_PER_HALF_WAVE * _half_waves(train) * speed)
    if train.model is not TrainModel.EXACT or wanted <= train.order:
        return train
    return replace(train, order=min(wanted, _HIGHEST))


def good_up_to(train: Train) -> float:
    """Return the speed (rpm of the first pinion) up to which elements follow the shafts.

    It is infinite for models without half waves.
    """
    each = _half_waves(train)
    if train.model not in (TrainModel.EXACT, TrainModel.ELEMENTS) or not each:
        return math.inf
    return train.order / _PER_HALF_WAVE / each


def coarse_elements(train: Train, speed: float) -> tuple[Notice, ...]:
    """Return a notice if charts go on up to a speed (rpm) beyond `good_up_to`, else none."""
    good = good_up_to(train)
    if speed <= good:
        return ()
    more = "" if train.order == _HIGHEST else f"; raise train.order, up to {_HIGHEST}"
    text = (
        f"charts are accurate up to {good:.5g} rpm of the first pinion: above, the teeth excite more half waves in a shaft than"
        f" {train.order / _PER_HALF_WAVE:.3g}, which elements of order {train.order} can represent{more}"
    )
    return (Notice("coarse-elements", text),)


def train_document(train: Train) -> JsonObject:
    """Return inputs and derived quantities of a train and its parts, under the keys of tables; lengths in mm, otherwise SI.

    Speeds (rpm) and tooth frequencies (Hz) are there where `train.speed` is given. Forces (N) are the mean ones of the model.
    For a pair under no load yet there is its name, but no stiffness, and no forces in its train.
    """
    of_parts = ("name", "inertias", "shafts", "meshes", "excitations")
    own = {key: _plain(value) for key, value in _fields(train).items() if key not in of_parts}
    forces = static_forces(train).tolist() if not _waiting(train) else [None] * len(train.meshes)
    return {
        "train": own | {"held": train.held},
        "inertia": {each.name: _of_inertia(train, each) for each in train.inertias},
        "shaft": {each.name: _of_shaft(each) for each in train.shafts},
        "mesh": {each.name: _of_mesh(train, each, force) for each, force in zip(train.meshes, forces, strict=True)},
        **({"excitation": {each.name: each.document() for each in train.excitations}} if train.excitations else {}),
    }


def _waiting(train: Train) -> bool:
    """Return whether static forces are not known: there are no meshes, or pairs whose stiffness depends on them."""
    return not train.meshes or any(mesh.pair is not None and math.isnan(mesh.stiffness) for mesh in train.meshes)


def _fields(part: Any) -> dict[str, Any]:
    return {each.name: _plain(getattr(part, each.name)) for each in fields(part) if each.name not in ("name", "layout")}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, MeshPair):
        return value.pair.name
    if isinstance(value, float):
        return None if math.isnan(value) else float(value)
    if isinstance(value, int) and not isinstance(value, bool):
        return int(value)
    return value.value if isinstance(value, Enum) else list(map(_plain, value)) if isinstance(value, tuple) else value


def _of_inertia(train: Train, inertia: Inertia) -> dict[str, Any]:
    ratio = train.speed_ratios[inertia.name]
    speed = {"speed": ratio * train.speed} if train.speed else {}
    return {**_fields(inertia), "speed_ratio": ratio, **speed, "torque": train.torques.get(inertia.name, 0.0)}


def _of_shaft(shaft: Shaft) -> dict[str, Any]:
    """Return the document of a shaft, with stiffness and inertia also where it is given by its shape.

    Shear modulus and density are those that stiffness and inertia follow from: of segments theirs, None where they differ.
    """
    layout: dict[str, Any] = {}
    if shaft.layout is not None:
        for key in ("shear_modulus", "density"):
            first, *others = (float(getattr(segment, key)) for segment in shaft.layout.segments)
            layout[key] = first if all(each == first for each in others) else None
        layout["layout"] = _plain(asdict(shaft.layout))
    return {**_fields(shaft), "torsional_stiffness": shaft.stiffness, "inertia": shaft.inertia, **layout}


def _of_mesh(train: Train, mesh: ToothMesh, force: float | None) -> dict[str, Any]:
    """Return the document of a mesh.

    1/m_red = sum of r_b²/J of both gears, whatever else is connected with them; the natural frequency is that of both alone.
    """
    inertias = {each.name: each.inertia for each in train.inertias}
    reduced = 1 / sum(radius**2 / inertias[gear] for gear, radius in zip(mesh.gears, mesh.radii, strict=True))
    speed = {"tooth_frequency": train.tooth_frequencies[mesh.name]} if train.speed else {}
    # A pair has a stiffness of its own, and other meshes no place.
    of_waves = ("mesh_angle",) if mesh.pair is None else ("variation", "shape", "contact_ratio")
    return {
        **{key: value for key, value in _fields(mesh).items() if key not in of_waves},
        "gear_ratio": mesh.base_radii.wheel / mesh.base_radii.pinion,
        "reduced_mass": reduced,
        "natural_frequency": _plain(math.sqrt(mesh.stiffness * 1e6 / reduced) / (2 * math.pi)),
        **speed,
        "static_force": force,
    }
