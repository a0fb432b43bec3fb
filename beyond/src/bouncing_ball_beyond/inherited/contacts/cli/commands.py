"""The subcommand of contacts on a table in ``bouncing-ball``: an entry point of the package."""

from bouncing_ball_beyond.inherited.cli.commands import Command, Program
from bouncing_ball_beyond.inherited.contacts.cli.advice import advice_of_design
from bouncing_ball_beyond.inherited.contacts.cli.options import NAMES

# Measured at 0.8 and 3 g: 2.2 and 4.4 s of a processor on a spring and a damper, 11 and 16 s on a
# contact law, with a single n as well.
_OF_DESIGN = (
    "balls are followed over hundreds of impacts until their motion repeats, which takes four to "
    "five times as long on a contact law as on a spring and a damper: a lower acceleration, or a "
    "spring and a damper in place of a contact law,"
)


def _design() -> Program:
    from bouncing_ball_beyond.inherited.contacts.cli import design
    from bouncing_ball_beyond.inherited.contacts.cli.design_text import design_lines

    return Program(design.add_options, design.design, design_lines, design.design_document)


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
        ),
        program=_design,
        has_symbols=False,
        cheaper=_OF_DESIGN,
        names=NAMES,
        advice=advice_of_design,
    ),
}
"""The subcommands by name."""
