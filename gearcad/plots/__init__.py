"""Pictures of results, drawn on Figures of their own and never through pyplot: no screen is needed, no state stays behind.

`plot(it)` draws what one looks at first of a gear, a pair or a result; each picture has a function too. All take `ax`, the axes
to draw on, and give the axes back: without, those of a new figure. A notebook shows them, and `axes.figure.savefig("it.svg")`
keeps them.

    plot_gear(gear)                         section, with reference and base circle
    plot_modification(gear)                 how far the flank is taken back
    plot_shift_limits(gear)                 shifts that undercut or point, over numbers of teeth
    plot_pair(pair)                         both gears in mesh, with the path of contact
    plot_backlash(pair)                     over the centre distance
    plot_sliding(pair)                      specific sliding along the path of contact
    plot_mesh(elements)                     a section or a body
    plot_stress_field(check)                von Mises stress of a plane check; plot_contact_zone around the contact
    plot_contact_pressure(check)            along the path of contact, of a plane check; plot_load_share
    plot_root_stress(check)                 over the mesh; plot_transmission_error
    plot_line_loads(check)                  over the plane of action, of a check of solid bodies
    plot_stiffness(comparison)              over the mesh by each method; plot_cycle of one
    plot_life(rating)                       strength over load cycles; plot_flash of scuffing
    plot_safeties(strength)                 of every gear of a planetary train
    plot_factors(study)                     K_v over speed, of the study of a train; plot_campbell of spectra
    plot_beside(studies)                    K_v of the first mesh, of a train studied several times
    plot_residuals(identification)          how far candidates of a measured gear are off
    plot_scheme(train)                      a planetary train in symbols
    plot_results(file, x, y)                columns of the results.csv of a batch
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.plots.campbell import plot_campbell
    from gearcad.plots.check import (
        plot_contact_pressure,
        plot_load_share,
        plot_mesh_stiffness,
        plot_root_stress,
        plot_transmission_error,
    )
    from gearcad.plots.first import plot
    from gearcad.plots.gear import plot_gear, plot_modification, plot_shift_limits
    from gearcad.plots.labels import axis_label
    from gearcad.plots.lines import plot_line_loads
    from gearcad.plots.measured import plot_residuals
    from gearcad.plots.mesh import plot_mesh
    from gearcad.plots.pair import plot_backlash, plot_pair, plot_sliding
    from gearcad.plots.planetary.scheme import plot_scheme
    from gearcad.plots.side_by_side import plot_beside
    from gearcad.plots.speeds import plot_cycle, plot_factors
    from gearcad.plots.stiffness import plot_stiffness
    from gearcad.plots.strength import plot_flash, plot_life, plot_safeties
    from gearcad.plots.stresses import plot_contact_zone, plot_stress_field
    from gearcad.plots.study import plot_contours, plot_results, plot_scatter, require_picture, save_plot

__all__ = [
    "axis_label",
    "plot",
    "plot_backlash",
    "plot_beside",
    "plot_campbell",
    "plot_contact_pressure",
    "plot_contact_zone",
    "plot_contours",
    "plot_cycle",
    "plot_factors",
    "plot_flash",
    "plot_gear",
    "plot_life",
    "plot_line_loads",
    "plot_load_share",
    "plot_mesh",
    "plot_mesh_stiffness",
    "plot_modification",
    "plot_pair",
    "plot_residuals",
    "plot_results",
    "plot_root_stress",
    "plot_safeties",
    "plot_scatter",
    "plot_scheme",
    "plot_shift_limits",
    "plot_sliding",
    "plot_stiffness",
    "plot_stress_field",
    "plot_transmission_error",
    "require_picture",
    "save_plot",
]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    _HOMES = {
        "campbell": ["plot_campbell"],
        "check": [
            "plot_contact_pressure",
            "plot_load_share",
            "plot_mesh_stiffness",
            "plot_root_stress",
            "plot_transmission_error",
        ],
        "first": ["plot"],
        "gear": ["plot_gear", "plot_modification", "plot_shift_limits"],
        "labels": ["axis_label"],
        "lines": ["plot_line_loads"],
        "measured": ["plot_residuals"],
        "mesh": ["plot_mesh"],
        "pair": ["plot_backlash", "plot_pair", "plot_sliding"],
        "planetary.scheme": ["plot_scheme"],
        "side_by_side": ["plot_beside"],
        "speeds": ["plot_cycle", "plot_factors"],
        "stiffness": ["plot_stiffness"],
        "strength": ["plot_flash", "plot_life", "plot_safeties"],
        "stresses": ["plot_contact_zone", "plot_stress_field"],
        "study": ["plot_contours", "plot_results", "plot_scatter", "require_picture", "save_plot"],
    }
    __getattr__ = lazily(
        __name__, __all__, (), (), {name: f"{home}.{name}" for home, names in _HOMES.items() for name in names}
    )


def __dir__() -> list[str]:
    return __all__
