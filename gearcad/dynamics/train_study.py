"""Study of a train: its modes, the overload of meshes and shafts over speed, and the course at one speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats, Notice
from gearcad.core.runtime import Expected, Share, Tell, cores, unheard, untold
from gearcad.dynamics.engagement import engaged, pair_notices
from gearcad.dynamics.options import DynamicsOptions, operating_range
from gearcad.dynamics.response.kv_chart import idle_shafts, lines_that_matter
from gearcad.dynamics.response.order_chart import OrderChart, order_chart
from gearcad.dynamics.response.speed_charts import OverSpeed, over_speed
from gearcad.dynamics.time_domain.campbell import campbell_seconds, mesh_campbell
from gearcad.dynamics.time_domain.spectra import MeshCampbell
from gearcad.dynamics.time_domain.transient import run_transient
from gearcad.dynamics.time_domain.transient_result import Transient
from gearcad.dynamics.tooth_errors.error_result import ToothLaw
from gearcad.dynamics.tooth_errors.error_sources import MeshTeeth, engaged_teeth, mesh_teeth
from gearcad.dynamics.tooth_errors.error_study import ErrorPlan, errors_seconds, study_errors
from gearcad.dynamics.train_result import Course, ModalStudy, TrainStudy
from gearcad.dynamics.trains.mesh_excitation import Excitation, train_excitation, train_torques
from gearcad.dynamics.trains.pair_on_bearings import BearingModes, PairOnBearings
from gearcad.dynamics.trains.shaft_lines import System, system
from gearcad.dynamics.trains.speed_orders import SpeedOrder, least_even_speed, speed_orders, torque_notices
from gearcad.dynamics.trains.steady_response import PeriodicResponse, require_damping, senses
from gearcad.dynamics.trains.train import EngagedMesh, Train, coarse_elements, fitted, require_pressed, static_forces
from gearcad.dynamics.trains.train_modes import NaturalModes, natural_modes
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.options import RatingOptions

_BEYOND = 1.5
"""Highest speed of a chart over the speed of the last resonance."""

_SHARE = 0.02
"""Share of a mode's potential energy that a mesh must hold for the mode to be a resonance of it."""

_DRAWN, _DRAWN_OF_MANY = 1024, 256
"""Samples of a course over a tooth, at least, and over each of many; 8 of the quickest vibration that could be felt."""

_LEAST_LINE, _MOST_LINES = 1e-4, 512
"""Part of the greatest line of a spectrum that a line must have to be listed, and greatest number of lines."""
_LINES = 4
"""Natural frequencies that a Campbell diagram has."""

_QUICK, _CHART_SECONDS, _MEMORY = "potential-energy", 10.0, 3e8
"""Values for the estimate of a study: the method of its pairs, CPU seconds of all but runs in time, and bytes."""

_LOWER, _RUN_UP = 3.0, 60
"""Ratio of the speed at which flanks part, beyond the chart, to the first speed of the run up to it, and the number of steps.
"""


def study_modes(train: Train, options: DynamicsOptions | None = None) -> ModalStudy:
    """Return the natural modes alone, of any train. Raises ParameterError."""
    options = options or DynamicsOptions()
    train = engaged(train, options)
    return ModalStudy(train=train, options=options, modes=natural_modes(train, count=options.frequencies))


def study_torques(train: Train, options: DynamicsOptions | None = None, *, tell: Tell = untold) -> ModalStudy:
    """Return modes, amplitudes over speed and, where the options ask for it, the run in time of a train without meshes.

    Its excitations shake it. `tell` receives the current step. Raises ParameterError, GeometryError and SolverError.
    """
    options = options or DynamicsOptions()
    tell("modes")
    modes = natural_modes(train, count=options.frequencies)
    shaken, excitation = system(train), Excitation(meshes=(), torques=train_torques(train))
    orders = speed_orders(train, excitation)
    speeds = _torque_speeds(train, options, modes, min(each.order for each in orders))
    tell("chart")
    chart = order_chart(train, shaken, excitation, speeds, orders)
    found, run = torque_notices(train, float(speeds[0])), None
    if not shaken.damping.any():
        text = "without damping amplitudes have no finite value at a resonance: give damping or damping_ratio of a shaft"
        found = (*found, Notice("no-damping", text))
    if options.transient is not None:
        otherwise, heard = abs(train.speed) or float(speeds[-1]), partial(tell, "transient")
        run = run_transient(train, shaken, excitation, options.transient, otherwise=otherwise, tell=heard)
        found = (*found, *run.notices)
    return ModalStudy(train=train, options=options, modes=modes, transient=run, orders=chart, found=found)


def _torque_speeds(train: Train, options: DynamicsOptions, modes: NaturalModes, order: float) -> Floats:
    """Return the speeds (rpm) of the chart of a train without meshes; `order` is the lowest one of its torques."""
    elastic = modes.frequency[modes.rigid :]
    last = options.speed_to or _BEYOND * 60 * float(elastic.min(initial=math.inf)) / order
    if not math.isfinite(last):
        last = abs(train.speed) or 1000.0
    first = options.speed_from or max(last * options.slowest, min(least_even_speed(train), last / 2))
    return np.linspace(first, last, options.chart_speeds)


def study_train(
    train: Train,
    options: DynamicsOptions | None = None,
    *,
    speeds: Floats | None = None,
    excitation: Excitation | None = None,
    method_b: DynamicFactor | None = None,
    bearings: PairOnBearings | None = None,
    teeth: Sequence[MeshTeeth] | None = None,
    tell: Tell = untold,
    share: Share = unheard,
    drawn: Share = unheard,
) -> TrainStudy:
    """Return modes, charts and the course at the train's speed (or at its highest resonance).

    `speeds` (rpm, rising) are those of the chart, at least, in place of the options'. `excitation` is that of the train's own
    meshes unless given; `method_b` is K_v by ISO 6336-1 of the first mesh. With `bearings` the charts are those of the same
    mesh between gears that travel as well. `teeth` are those of the meshes, for errors that are drawn, unless the train's own.
    `tell` receives the current step and how much of a run in time is done, `share` how much of the chart, `drawn` how much of
    the errors. Raises ParameterError, GeometryError and SolverError.
    """
    if not train.meshes:
        raise GeometryError(
            "meshes", 0, "must be at least 1: without teeth nothing excites a train; study_modes gives its natural modes"
        )
    train = engaged(train, options)
    require_pressed(train)
    options = (options or DynamicsOptions()).graded(RatingOptions())
    _require_no_torques(train, options)
    tell("modes")
    modes = natural_modes(train, count=options.frequencies)
    on_bearings = None if bearings is None else bearings.modes()
    excitation = excitation or _own_excitation(train, options)
    charted_speeds = chart_speeds(train, options, modes, on_bearings) if speeds is None else speeds
    highest = max(float(charted_speeds[-1]), abs(train.speed))
    train = fitted(train, highest)
    charted = system(train) if bearings is None else bearings.system()
    frequencies, asked = _frequencies(train, charted_speeds)
    tell("chart")
    require_damping(charted, excitation)
    over = over_speed(charted, excitation, frequencies, harmonics=options.harmonics, method_b=method_b, share=share)
    tell("course")
    course, more = _course(train, over, asked, options)
    errors = None
    if options.drawn:
        tell("tooth errors")
        own = _own_teeth(train, options) if teeth is None else teeth
        places = _error_speeds(train, options, charted_speeds)
        errors = study_errors(charted, excitation, own, places, train.meshes[0].teeth, _plan(options), drawn)
    transient = None
    if options.transient is not None:
        heard, references = partial(tell, "transient"), over.up.shaft_references
        shaken = (train, charted, excitation)
        transient = run_transient(*shaken, options.transient, references=references, otherwise=course.speed, tell=heard)
    spectra = _spectra(train, charted, excitation, options, charted_speeds, modes, tell) if options.spectra else None
    tracked = options.transient is not None and options.transient.tracked
    orders = None
    if train.excitations or tracked:
        tell("orders")
        asked_orders = options.transient.orders if options.transient is not None else ()
        orders = _order_chart(train, charted, excitation, over, speed_orders(train, excitation, asked_orders))
    return TrainStudy(
        train=train,
        options=options,
        system=charted,
        excitation=excitation,
        modes=modes,
        on_bearings=on_bearings,
        up=over.up,
        down=over.down,
        jumps=over.jumps,
        course=course,
        found=(
            *pair_notices(train),
            *coarse_elements(train, highest),
            *torque_notices(train, float(charted_speeds[0])),
            *over.notices,
            *more,
            *_notices(transient),
            *_notices(spectra),
        ),
        method_b=method_b,
        errors=errors,
        transient=transient,
        campbell=spectra,
        orders=orders,
    )


_MOST_CHARTED = 1500
"""Greatest number of speeds at which amplitudes of orders are given."""


def _order_chart(
    train: Train, charted: System, excitation: Excitation, over: OverSpeed, orders: tuple[SpeedOrder, ...]
) -> OrderChart:
    """Return the amplitudes of orders at the speeds of the chart, or at some of very many."""
    frequencies = over.up.frequencies[:: -(-len(over.up.frequencies) // _MOST_CHARTED)]
    return order_chart(train, charted, excitation, frequencies * 30 / (math.pi * train.meshes[0].teeth), orders)


def _require_no_torques(train: Train, options: DynamicsOptions) -> None:
    """Raise GeometryError for torques on inertias beside errors that are drawn, whose study does not have them."""
    if train.excitations and options.drawn:
        key = "premature_engagement" if options.premature else "error_samples"
        permitted = "must be left out beside [[train.excitation]]: a study of drawn tooth errors has no torques on inertias"
        raise GeometryError(f"dynamics.{key}", getattr(options, key), permitted)


def study_undamped(train: Train, options: DynamicsOptions | None = None, *, tell: Tell = untold) -> ModalStudy:
    """Return the natural modes of a train without damping and, where the options ask for it, its run in time.

    A notice says that loads over speed are left out, and why. `tell` receives how much of the run is done. Raises
    ParameterError, GeometryError and SolverError.
    """
    train = engaged(train, options)
    require_pressed(train)
    options = (options or DynamicsOptions()).graded(RatingOptions())
    modes = natural_modes(train, count=options.frequencies)
    found = (*pair_notices(train), _no_steady_motion(options))
    if options.transient is None:
        return ModalStudy(train=train, options=options, modes=modes, found=found)
    speed = abs(train.speed)
    if not speed and options.transient.speed_from is None and options.transient.speed_to is None:
        permitted = "must be given, or train.speed: without loads over speed there is no highest resonance to run at"
        raise ParameterError("dynamics.transient.speed_from", None, permitted, "rpm")
    highest = max(map(abs, options.transient.speeds(speed)))
    train = fitted(train, highest)
    shaken, excitation = system(train), _own_excitation(train, options)
    run = run_transient(train, shaken, excitation, options.transient, otherwise=speed, tell=partial(tell, "transient"))
    run = _without_idle_shafts(run)
    found = (*found, *coarse_elements(train, highest), *run.notices, *_pulled(shaken, excitation, run))
    return ModalStudy(train=train, options=options, modes=modes, transient=run, found=found)


def _no_steady_motion(options: DynamicsOptions) -> Notice:
    """Return the notice of what an undamped train has no values of, and what to give."""
    left_out = ["loads over speed"]
    left_out += ["drawn tooth errors"] if options.drawn else []
    left_out += ["the Campbell diagram"] if options.spectra else []
    in_time = "" if options.transient is not None else ", or [dynamics.transient] for a run in time, which needs no damping"
    text = (
        f"{' and '.join(left_out)} are left out: without damping a steady motion has no finite value where a harmonic "
        f"of a tooth frequency meets a natural frequency; give damping or damping_ratio of a mesh or shaft{in_time}"
    )
    return Notice("no-damping", text)


def _without_idle_shafts(run: Transient) -> Transient:
    """Return a run in which shafts that carry next to nothing at rest have no reference, as in charts."""
    idle = idle_shafts(np.nan_to_num(run.shaft_factor), np.ones(run.shaft_factor.shape[1]))
    references, factors = (np.where(idle, np.nan, each) for each in (run.shaft_references, run.shaft_factor))
    return replace(run, shaft_references=references, shaft_factor=factors)


def _pulled(shaken: System, excitation: Excitation, run: Transient) -> tuple[Notice, ...]:
    """Return a notice if flanks that cannot part pull in a run in time."""
    pressing = senses(shaken) * np.sign(run.torque)[:, None] * run.force
    bonded = np.isnan(excitation.backlashes)
    if not bonded.any() or pressing[:, bonded].min() >= 0:
        return ()
    text = "flanks would part in this run: give the mesh a backlash to see what happens then"
    return (Notice("flanks-would-part", text, "transient"),)


def expected_train(train: Train, options: DynamicsOptions) -> Expected:
    """Return what `study_train` takes of drawn tooth errors and a Campbell diagram, about: pairs are as stiff as beams."""
    train = engaged(train, replace(options, stiffness=_QUICK))
    options = options.graded(RatingOptions())
    charted = chart_speeds(train, options, natural_modes(train, count=options.frequencies))
    train = fitted(train, max(float(charted[-1]), abs(train.speed)))
    shaken = (system(train), _own_excitation(train, options))
    seconds = _CHART_SECONDS
    if options.drawn:
        places = _error_speeds(train, options, charted)
        seconds += errors_seconds(*shaken, _own_teeth(train, options), places, train.meshes[0].teeth, _plan(options))
    if options.spectra:
        places = _spectrum_speeds(options, charted)
        seconds += campbell_seconds(train, *shaken, places, duration=options.duration, sampling=options.sampling)
    return Expected(seconds / cores(), _MEMORY)


def _spectrum_speeds(options: DynamicsOptions, speeds: Floats) -> Floats:
    """Return the speeds of a Campbell diagram (rpm), evenly spaced up to the last speed of a chart."""
    count = options.mesh_campbell_speeds
    return np.linspace(options.speed_from or speeds[-1] / count, speeds[-1], count)


def _notices(run: Transient | MeshCampbell | None) -> tuple[Notice, ...]:
    return () if run is None else run.notices


def _spectra(
    train: Train,
    charted: System,
    excitation: Excitation,
    options: DynamicsOptions,
    speeds: Floats,
    modes: NaturalModes,
    tell: Tell,
) -> MeshCampbell:
    """Return the spectra over the speeds of the chart; their lines are the natural frequencies whose modes bend teeth most."""
    tell("campbell")
    bent = modes.potential_meshes.max(axis=1, initial=0.0)
    most = [number for number in np.argsort(-bent)[:_LINES].tolist() if bent[number] > _SHARE]
    return mesh_campbell(
        train,
        charted,
        excitation,
        _spectrum_speeds(options, speeds),
        {f"mode {number + 1}": float(modes.frequency[number]) for number in sorted(most)},
        duration=options.duration,
        sampling=options.sampling,
        counted=lambda done, of: tell("campbell", done / of),
    )


def _own_excitation(train: Train, options: DynamicsOptions) -> Excitation:
    """Return the excitation by the train's own meshes, with random tooth errors if the options ask for them.

    Errors that have a study of their own are left out.
    """
    grade = options.accuracy_grade if options.errors and not options.drawn else None
    return train_excitation(train, grade=grade, seed=options.seed, distribution=options.distribution)


def _own_teeth(train: Train, options: DynamicsOptions) -> list[MeshTeeth]:
    """Return the teeth of the train's own meshes; meshes of pairs have the teeth of their pairs."""
    grade, single = options.accuracy_grade if options.errors else None, options.premature
    forces = static_forces(train).tolist()
    return [
        engaged_teeth(mesh, number, errors=options.errors, single=single)
        if isinstance(mesh, EngagedMesh)
        else mesh_teeth(mesh, number, force, grade, single=single)
        for number, (mesh, force) in enumerate(zip(train.meshes, forces, strict=True))
    ]


def _plan(options: DynamicsOptions) -> ErrorPlan:
    return ErrorPlan(
        law=ToothLaw.SINGLE if options.premature else ToothLaw.SMOOTH,
        samples=options.error_samples,
        distribution=options.distribution,
        seed=options.seed,
        grade=options.accuracy_grade if options.errors else None,
    )


def _error_speeds(train: Train, options: DynamicsOptions, charted: Floats) -> Floats:
    """Return speeds (rpm) at which errors are drawn: evenly over the chart, and the speed asked for."""
    asked = abs(train.speed)
    first = options.speed_from or charted[-1] / options.error_speeds
    even = np.linspace(first, charted[-1], options.error_speeds)
    return np.union1d(even, asked) if even[0] <= asked <= even[-1] else even


def _frequencies(train: Train, speeds: Floats) -> tuple[Floats, float]:
    """Return tooth frequencies of the first mesh (1/s) for the chart, and the one at the speed asked for.

    The chart includes the latter if it lies within.
    """
    frequency = math.pi * train.meshes[0].teeth / 30
    charted, asked = speeds * frequency, abs(train.speed) * frequency
    return np.union1d(charted, asked) if charted[0] <= asked <= charted[-1] else charted, asked


def chart_speeds(
    train: Train, options: DynamicsOptions, modes: NaturalModes, on_bearings: BearingModes | None = None
) -> Floats:
    """Return the speeds of the chart (rpm of the first pinion)."""
    last = options.speed_to
    if last is None:
        felt = (modes.potential_meshes > _SHARE).any(axis=1)
        last = _BEYOND * float(modes.rpm[felt].max()) if felt.any() else _BEYOND * float(modes.rpm.max())
        if on_bearings is not None:
            # Gears that travel are shaken at higher speeds than those that only turn.
            highest = on_bearings.frequency[on_bearings.potential[:, 0] > _SHARE].max() * 60 / train.meshes[0].teeth
            last = last if highest < last else _BEYOND * float(highest)
    first = options.speed_from if options.speed_from else max(last * options.slowest, min(least_even_speed(train), last / 2))
    return np.linspace(first, last, options.chart_speeds)


def _course(train: Train, over: OverSpeed, asked: float, options: DynamicsOptions) -> tuple[Course, tuple[Notice, ...]]:
    """Return the course at the train's speed, or where the first mesh's K_v is greatest in operation, and notices about it."""
    frequency = asked or _greatest_in_operation(train, over, options)
    response, notices = over.response(frequency), tuple[Notice, ...]()
    within = over.up.frequencies[0] <= frequency <= over.up.frequencies[-1]
    if not within and over.excitation.parting and _pull(response):
        run_up = np.geomspace(frequency / _LOWER, frequency, _RUN_UP)
        beyond = over_speed(over.curves.system, over.excitation, run_up, harmonics=over.curves.harmonics)
        response, notices = beyond.response(frequency), beyond.notices
    samples = max(_DRAWN, _DRAWN_OF_MANY * max(over.excitation.orders))
    if over.curves.resolvable:
        felt, most = float(over.curves.felt_orders(np.array([frequency]))[0]), over.curves.most_orders
        samples = max(samples, 8 * int(min(felt, most)))
        if felt > most:
            notices = (*notices, _unresolved(most))
    return _sampled_course(train, response, samples), notices


def _greatest_in_operation(train: Train, over: OverSpeed, options: DynamicsOptions) -> float:
    """Return the tooth frequency (1/s) at which K_v of the first mesh is greatest where the train runs under load."""
    frequencies, factors = over.up.frequencies, over.up.factors[:, 0]
    speeds = frequencies * 30 / (math.pi * train.meshes[0].teeth)
    rows = operating_range(train.speed, options, (float(speeds[0]), float(speeds[-1]))).rows(speeds) & np.isfinite(factors)
    return float(frequencies[np.nanargmax(np.where(rows, factors, np.nan) if rows.any() else factors)])


def _unresolved(most: int) -> Notice:
    text = (
        f"at the speed asked for, harmonics beyond the {most} orders that are solved meet natural frequencies that can be felt:"
        " K_v and the course there are not those of the whole motion"
    )
    return Notice("course-unresolved", text)


def _pull(response: PeriodicResponse) -> bool:
    """Return whether flanks pull in a linear motion."""
    return bool((response.senses * response.spring_forces()).min() <= 0)


def _sampled_course(train: Train, response: PeriodicResponse, samples: int) -> Course:
    """Return the course of a response with about so many samples; K_v is taken from more samples."""
    step = max(1, 8 * int(response.harmonics[-1]) // samples)
    count = max(samples, 8 * int(response.harmonics[-1]) // step * step)
    spring = response.spring_forces(count=count)
    phases = response.phases(count) / (2 * np.pi) * response.excitation.orders[0]
    crests = (response.senses * spring).max(axis=(0, 1))
    lines = 2e6 * np.abs(response.approach_coefficients[0])
    kept = 1 + lines_that_matter(lines[1:], _LEAST_LINE, _MOST_LINES)
    return Course(
        speed=float(response.frequencies[0] * 30 / (math.pi * train.meshes[0].teeth)),
        kv=crests / np.abs(response.system.stiffness * response.static.approach),
        turn=phases[::step],
        approach=1e6 * response.approach(count=count)[0, ::step],
        force=(spring + response.damping_forces(count=count))[0, ::step],
        spring_force=spring[0, ::step],
        shaft_torque=response.shaft_torques(count=count)[0, ::step],
        order=response.harmonics[kept] / response.excitation.orders[0],
        line=lines[kept],
    )
