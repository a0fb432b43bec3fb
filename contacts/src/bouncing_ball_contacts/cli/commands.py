"""The subcommands that contacts adds to ``bouncing-ball``: an entry point of its package."""

from bouncing_ball_beyond.inherited.cli.commands import Command, Program
from bouncing_ball_contacts.cli.advice import advice_of_design, advice_of_fit
from bouncing_ball_contacts.cli.options import NAMES

# Measured at 0.8 and 3 g: 2.2 and 4.4 s of a processor on a spring and a damper, 11 and 16 s on a
# contact law, with a single n as well.
_OF_DESIGN = (
    "balls are followed over hundreds of impacts until their motion repeats, which takes four to "
    "five times as long on a contact law as on a spring and a damper: a lower acceleration, or a "
    "spring and a damper in place of a contact law,"
)


def _design() -> Program:
    from bouncing_ball_contacts.cli import design
    from bouncing_ball_contacts.cli.design_text import design_lines

    return Program(design.add_options, design.design, design_lines, design.design_document)


def _fit() -> Program:
    from bouncing_ball_beyond.inherited.cli.options import add_parameters
    from bouncing_ball_contacts.cli import fit

    return Program(
        add_options=lambda parser: add_parameters(parser, fit.fit),
        answer=lambda file, **options: fit.fit(file, **options),
        lines=fit.fit_lines,
        document=fit.fit_document,
    )


COMMANDS = {
    "design": Command(
        purpose="whether a restitution coefficient is enough, or which contact is needed",
        text=(
            "With a stiffness, the answer says whether a restitution coefficient is good enough "
            "for this contact. Without one, it gives the contact that a simulation needs. Errors "
            "are relative to the contact, positive where a model predicts too much. Give "
            'numbers with units, such as "50 Hz"; a plain number is in SI units.'
        ),
        examples=(
            (
                'design --mass "20 g" --frequency "50 Hz" --acceleration "0.8 g" --stiffness "1e7 '
                'N/m" --restitution 0.85'
            ),
            (
                'design --mass "20 g" --frequency "50 Hz" --acceleration "0.8 g" --drop-height "1 '
                'm" --rebound-height "70 cm" --tolerance "5 %"'
            ),
            (
                'design --mass "4 g" --frequency "50 Hz" --acceleration "0.8 g" --restitution 0.9 '
                '--radius "5 mm" --youngs-modulus "210 GPa" --poissons-ratio 0.3 '
                '--table-youngs-modulus "70 GPa" --table-poissons-ratio 0.33'
            ),
            ('design --engine mujoco --mass "500 g" --stiffness "100 kN/m" --restitution 0.75'),
        ),
        program=_design,
        has_symbols=False,
        cheaper=_OF_DESIGN,
        names=NAMES,
        advice=advice_of_design,
    ),
    "fit": Command(
        purpose="the contact laws that fit measured impacts, ranked and judged",
        text=(
            "The file has columns such as speed [m/s],restitution or drop_height [cm],"
            "rebound_height [cm], see docs/measured.md. Each law is fitted to it, and judged by "
            "points that the fit has not seen. The last line is the command for the contact. The "
            "name of an experiment of the package, such as croquet, stands for its file."
        ),
        examples=(
            "fit croquet",
            'fit croquet --frequency "50 Hz"',
            'fit plastic_ball --contact-time "1 ms" --speed "1.5 m/s"',
            'fit bouncy_ball --mass "20 g" --engine mujoco --time-step "2 ms"',
        ),
        program=_fit,
        has_symbols=False,
        advice=advice_of_fit,
    ),
}
"""The subcommands by name."""
