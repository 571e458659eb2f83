"""What the figures of a study of dynamics show, in sentences made of its numbers."""

from __future__ import annotations

from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.plots.paper import short
from gearcad.plots.trains import MOST_SHAPES
from gearcad.report.dynamics.tables import factor_text
from gearcad.stiffness import METHODS

__all__ = ["campbell", "course", "cycle", "energies", "factors", "greatest", "history", "shaft_overload", "shapes"]


def shapes(study: TrainStudy | ModalStudy) -> str:
    """Caption of the mode shapes."""
    modes = study.modes
    drawn = f"The first {MOST_SHAPES} of {len(modes)} natural modes" if len(modes) > MOST_SHAPES else "The natural modes"
    text = f"{drawn}, without damping, at the mean stiffness of the teeth: how far each place of the train turns. "
    if modes.shafts:
        lengths = [shaft.length is not None for shaft in study.train.shafts]
        scale = "Shafts are drawn to scale; " if any(lengths) else ""
        unit = "those without a length are as long as their mean; " if any(lengths) and not all(lengths) else ""
        unit = unit or ("" if any(lengths) else "Shafts have no length: all are drawn alike; ")
        text += f"{scale}{unit}dots are inertias, upright strokes the ends that do not turn. "
    text += "Dotted: the jump from one gear to its mate, which turns the other way. "
    if study.train.meshes:
        text += "Each mode is met at the speed of the first pinion at which a tooth frequency is its natural frequency."
    return text


def energies(study: TrainStudy | ModalStudy) -> str:
    """Caption of the modal energies."""
    modes = study.modes
    text = "Where a mode has its energy: bodies that move, and springs that give way. "
    if modes.most_toothed is not None:
        mode, share = modes.most_toothed
        text += (
            f"The teeth hold most in mode {mode + 1}, {100 * share:.0f} %: only modes that bend "
            "teeth are excited by them, and feel their damping."
        )
    return text


def factors(study: TrainStudy) -> str:
    """Caption of the K_v chart."""
    up = study.up
    text = (
        "K_v is the greatest force k(t) (y - e) between the flanks over a period, the dampers' part left out, over the static "
        f"one. {greatest(study)} Thin lines: a tooth frequency meets a natural frequency (whole) or half of one (f/2, dashed)"
    )
    text += ", in the colour of its mesh. " if len({mesh.frequency_ratio for mesh in study.excitation.meshes}) > 1 else ". "
    if study.down is not None:
        jumps = [f"{sense} at {', '.join(short(float(study.rpm(jump))) for jump in each)} rpm"
                 for sense, each in zip(("up", "down"), study.jumps, strict=True) if len(each)]  # fmt: skip
        text += f"Vibration jumps (arrows) running {' and '.join(jumps)}. " if jumps else "Running up and down are the same. "
    if not up.stable.all():
        text += "Shaded: parametric instability; what is drawn there is a periodic motion that does not last. "
    if (up.least <= 0).any():
        parted = "the flanks part" if study.excitation.parting else "flanks would part, if they had backlash"
        text += f"The bar below: at some time of the period {parted}. "
    if up.standard is not None:
        text += (
            f"ISO 6336-1 is for accuracy grade {study.options.accuracy_grade} and its deviations; "
            f"{'the teeth here have random ones' if study.options.errors else 'the teeth here have none'}."
        )
    return text


def greatest(study: TrainStudy) -> str:
    """The greatest K_v of all meshes, up and down."""
    found = study.greatest
    where = f" in {found.mesh}" if len(study.up.mesh_names) > 1 else ""
    sense = f", running {found.direction.value}" if found.direction is not None else ""
    last = "" if found.stable else ", where the motion is unstable"
    return f"Its greatest value is {factor_text(found.factor)}{where} at {short(found.speed)} rpm{sense}{last}."


def shaft_overload(study: TrainStudy) -> str:
    """Caption of the overload of shafts."""
    kept = set(study.up.referred_shafts)
    out = [name for number, name in enumerate(study.up.shaft_names) if number not in kept]
    text = "Greatest torque of a shaft, in the sense of the static one, over the static one"
    text += "; dashed running down. " if study.down is not None else ". "
    if out:
        text += f"Left out, because they carry nothing at rest: {', '.join(out)}."
    return text


def course(study: TrainStudy) -> str:
    """Caption of the course at one speed."""
    of = study.course
    why = "the speed asked for, or the nearest of the chart" if study.train.speed else "where K_v of the first mesh is greatest"
    text = f"At {short(of.speed)} rpm of the first pinion ({why}). "
    text += "The force is that of springs and dampers, which act also where flanks have parted; K_v counts the springs only. "
    if not study.course_lasts:
        text += "This motion is unstable and would not last. "
    return text


def cycle(study: PairStudy) -> str:
    """Caption of the mesh stiffness."""
    of = study.cycle
    return (
        f"Stiffness of the mesh over one base pitch; method: {METHODS[of.method].title}. The tangent is what small vibrations "
        f"see: its mean, {short(of.tangent_mean)} N/µm, makes the natural frequency, and its course excites."
    )


def campbell(study: ContactStudy) -> str:
    """Caption of the Campbell diagram."""
    of = study.study
    text = (
        f"Spectra of the pinion's speed at {len(of.speeds)} speeds, each over {short(of.duration)} s from the same start; "
        "four decades of colour. The numbers are harmonics of the tooth frequency. "
    )
    chaotic = of.speeds[of.chaotic]
    if len(chaotic):
        text += f"Triangles: chaotic speeds ({', '.join(f'{speed:g}' for speed in chaotic)} rpm), of which one sample is drawn."
    return text


def history(study: ContactStudy) -> str:
    """Caption of one speed."""
    of = study.history
    state = "chaotic: only its statistics mean anything" if of.chaotic else "not chaotic"
    return (
        f"At {short(of.speed)} rpm, {state}. Above: the last tooth meshes, the mean speed dashed; below: the spectrum of all "
        f"{short(len(of.approach) / of.sampling)} s, tooth frequencies dotted. The flanks have parted for "
        f"{100 * of.out_of_contact:.1f} % of the second half of the time."
    )
