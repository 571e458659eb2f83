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

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
