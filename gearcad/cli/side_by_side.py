"""What the screen shows of a train several times side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gearcad.dynamics.side_by_side import SideBySide
    from gearcad.dynamics.tooth_errors.result import ErrorStudy

__all__ = ["beside_lines"]


def beside_lines(study: SideBySide) -> list[str]:
    """The greatest loads of each study, and the highest resonances of all."""
    from gearcad.dynamics.levels.result import LevelStudy

    wide = max(len(label) for label in (study.what, *study.labels))
    what = f"{study.what} ({study.key})" if study.key else study.what
    lines = [f"natural frequencies in 1/s, those that move alike below each other; {what}:"]
    for at, label in enumerate(study.labels):
        shown = ("–" if group[at] is None else f"{group[at]:.6g}" for group in study.natural_frequencies)
        lines.append(f"  {label:<{wide}}  {' '.join(f'{each:<9}' for each in shown)}".rstrip())
    for mesh in study.mesh_names:
        lines.append(f"K_v of {mesh}")
        lines += [f"  {label:<{wide}}  {_resonance_line(study, mesh, at)}" for at, label in enumerate(study.labels)]
    for mesh in study.mesh_names if study.errors else ():
        lines.append(f"K_v of {mesh} with tooth errors")
        lines += [f"  {label:<{wide}}  {_errors_line(found, mesh)}" for label, found in study.errors.items()]
    for shaft in study.shaft_names:
        lines.append(f"overload of {shaft}")
        own = [each for each in study.shaft_overloads if each.shaft == shaft]
        lines += [f"  {each.label:<{wide}}  {each.factor:.3f} at {each.speed:.5g} rpm" for each in own]
    return [*lines, *study.headlines] if isinstance(study, LevelStudy) else lines


def _errors_line(found: ErrorStudy, mesh: str) -> str:
    """The greatest median of a mesh, and the greatest of its upper quantile where there are several samples."""
    (most,) = (each for each in found.greatest if each.mesh == mesh)
    upper = f", 95 % quantile {most.upper:.3f} at {most.upper_speed:.5g} rpm" if found.samples > 1 else ""
    return f"at most {most.median:.3f} at {most.median_speed:.5g} rpm{' (median)' if upper else ''}{upper}"


def _resonance_line(study: SideBySide, mesh: str, at: int) -> str:
    """The resonances of a mesh in one study, under those of the others; else its greatest K_v."""
    shown = [each.shown[at] for each in study.resonances if each.mesh == mesh]
    if not any(shown):
        (found,) = (each for each in study.greatest if each.mesh == mesh and each.label == study.labels[at])
        return f"at most {found.factor:.3f}, at {found.speed:.5g} rpm: no resonance in the chart"
    return " ".join(f"{'' if peak is None else f'{peak.factor:.3f} at {peak.speed:.5g} rpm':<21}" for peak in shown).rstrip()
