"""Additions to the ``--help`` of a subcommand: an explanation, and examples to run."""

import textwrap

# Symbols of the commands whose quantities are dimensionless.
_SYMBOLS = {
    "n": "index of the orbit: it repeats itself after n periods of the table, with one impact",
    "Λ": "amplitude: the greatest acceleration of the table over gravity",
    "r": "restitution coefficient: speed after an impact over that before it, against the table",
    "ϖ": "frequency ratio: natural frequency of the contact over that of the table",
    "ζ": "damping ratio of the contact: r = exp(-πζ/√(1 - ζ²)) if it ends at the table's level",
}
_WIDTH = 80

EXPLAINED = {
    "orbit": (
        "An n-T orbit is a motion that repeats itself. It is stable if a ball beside it comes back "
        "to it, and admissible if nothing else happens on the way.",
        (
            "orbit --amplitude 1 --restitution 0.85",
            "orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10",
            "orbit --amplitude 0.9 --restitution 0.85 --frequency-ratio 2 --side all",
            "orbit --amplitude 1 --law tsuji --restitution 0.85 --duration 0.1",
        ),
    ),
    "limits": (
        "An n-T orbit exists from the saddle-node on and is stable up to the period doubling, "
        "beyond which the motion repeats itself after twice the time.",
        ("limits --restitution 0.85", "limits --n 2 --damping-ratio 0.05 --frequency-ratio 10"),
    ),
    "error-law": (
        "The relative error of the restitution model against the contact is K/ϖ to first order. "
        "With an error ε that is allowed, ϖ = K/ε says how stiff is stiff enough.",
        ("error-law --amplitude 1 --restitution 0.65",),
    ),
    "permanent-contact": (
        "Up to this Λ a ball that lies on the table stays there, on its spring and damper. In the "
        "restitution model it stays up to Λ = 1.",
        ("permanent-contact --restitution 0.65 --frequency-ratio 6",),
    ),
    "simulate": (
        "Each line of the answer is an impact. After a contact that never ends there are no more.",
        (
            "simulate --amplitude 1 --restitution 0.85 --impacts 5",
            "simulate --amplitude 0 --restitution 0.5 --velocity -4 --impacts 5",
        ),
    ),
    "motion": (
        "In the end a ball repeats itself on an orbit or with a multiple of its period "
        "(subharmonic), repeats itself and sticks to the table on the way (locked), stays on the "
        "table, or never repeats itself (chaotic).",
        (
            "motion --amplitude 1.1 --restitution 0.85",
            "motion --amplitude 3 --restitution 0.5 --phase 1 --velocity -4",
        ),
    ),
    "diagram": (
        "Balls from some starts are followed at each amplitude, and the motions are listed on "
        "which they end.",
        ("diagram --amplitude 0.9 1.1 --points 5 --restitution 0.85",),
    ),
    "design": (
        "With a stiffness: will a restitution coefficient do for this contact? Without one: which "
        'contact does a simulation need? A number has its unit behind it, such as "50 Hz"; a '
        "plain number is in SI units.",
        (
            'design --mass "20 g" --frequency "50 Hz" --acceleration "0.8 g"'
            ' --stiffness "1e7 N/m" --restitution 0.85',
            'design --mass "20 g" --frequency "50 Hz" --acceleration "0.8 g"'
            ' --drop-height "1 m" --rebound-height "70 cm" --tolerance "5 %"',
            'design --mass "4 g" --frequency "50 Hz" --acceleration "0.8 g" --restitution 0.9'
            ' --radius "5 mm" --youngs-modulus "210 GPa" --poissons-ratio 0.3'
            ' --table-youngs-modulus "70 GPa" --table-poissons-ratio 0.33',
            'design --engine mujoco --mass "500 g" --stiffness "100 kN/m" --restitution 0.75',
        ),
    ),
    "explain": (
        "A figure, a table or a dataset carries the commit and the parameters that made it.",
        ("explain figures/fig14.png",),
    ),
    "diff": (
        "The status is 0 if the folders say the same, 1 if they differ, and 2 if they cannot be "
        "compared.",
        ("diff . results", "diff . results fig08"),
    ),
}
"""By subcommand: the explanation, and examples without the name of the program."""


def explained(command: str) -> str:
    """The end of the help of a subcommand: explanation, symbols and examples."""
    text, examples = EXPLAINED[command]
    lines = [*textwrap.wrap(text, _WIDTH), ""]
    if command not in ("design", "explain", "diff"):
        for symbol, meaning in _SYMBOLS.items():
            lines += textwrap.wrap(f"{symbol}  {meaning}", _WIDTH, subsequent_indent="   ")
        lines += [""]
    return "\n".join([*lines, "examples:", *(f"  bouncing-ball {each}" for each in examples)])
