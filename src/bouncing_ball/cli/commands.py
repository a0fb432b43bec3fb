"""The subcommands: purpose, explanation and examples in their ``--help``, and their program."""

import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from bouncing_ball.cli.options import Parser

_WIDTH = 80
_SYMBOLS = {
    "n": "index of the family: its orbits repeat after n periods of the table, with one impact",
    "Λ": "excitation amplitude: the greatest acceleration of the table over gravity",
    "r": "restitution coefficient: relative speed after an impact over that before it",
    "ϖ": "frequency ratio: natural frequency of the contact over that of the table",
    "ζ": "damping ratio of the contact: r = exp(-πζ/√(1 - ζ²)) for the displacement release",
}

# What makes a single orbit cheaper.
_SIMPLER = "a spring and a damper in place of a law"
_OF_DESIGN = (
    "the orbits of eight families and the ends of many starts are computed, and each impact on a "
    "contact law is integrated: a single family n, or a spring and a damper in place of a law"
)


def _as_it_is(answer: Any) -> Any:
    return answer


class Program(NamedTuple):
    """What a subcommand does: its options, its answer, and how the answer is printed.

    ``answer`` takes the options by name. ``lines`` has the answer as text, and is None if the
    program prints its answer itself. ``document`` has the answer as values for JSON.
    """

    add_options: Callable[["Parser"], None]
    answer: Callable[..., Any]
    lines: Callable[[Any], list[str]] | None
    document: Callable[[Any], Any] = _as_it_is


@dataclass(frozen=True)
class Command:
    """A subcommand.

    ``examples`` are without the name of the program. ``program`` imports what the subcommand
    needs, because the list of subcommands needs no numpy. ``cheaper`` is what makes its answer
    cheaper.
    """

    purpose: str
    text: str
    examples: tuple[str, ...]
    program: Callable[[], Program]
    has_symbols: bool = True
    cheaper: str = ""

    def explanation(self) -> str:
        """The end of the help of the subcommand: explanation, symbols and examples."""
        lines = [*textwrap.wrap(self.text, _WIDTH), ""]
        if self.has_symbols:
            for symbol, meaning in _SYMBOLS.items():
                lines += textwrap.wrap(f"{symbol}  {meaning}", _WIDTH, subsequent_indent="   ")
            lines += [""]
        examples = (f"  bouncing-ball {each}" for each in self.examples)
        return "\n".join([*lines, "examples:", *examples])


def _orbit() -> Program:
    from bouncing_ball.cli import periodic
    from bouncing_ball.cli.output import lines

    return Program(periodic.orbit_options, periodic.orbit, lines)


def _limits() -> Program:
    from bouncing_ball.cli import periodic
    from bouncing_ball.cli.output import lines

    return Program(periodic.limits_options, periodic.limits, lines)


def _error_law() -> Program:
    from bouncing_ball.cli import periodic
    from bouncing_ball.cli.output import lines

    return Program(periodic.error_law_options, periodic.error_law, lines)


def _permanent_contact() -> Program:
    from bouncing_ball.cli import periodic
    from bouncing_ball.cli.output import lines

    return Program(periodic.permanent_contact_options, periodic.permanent_contact, lines)


def _follow() -> Program:
    from bouncing_ball.cli import followed
    from bouncing_ball.cli.output import lines

    return Program(followed.follow_options, followed.follow, lines)


def _curve() -> Program:
    from bouncing_ball.cli import followed
    from bouncing_ball.cli.output import lines

    return Program(followed.curve_options, followed.curve, lines)


def _simulate() -> Program:
    from bouncing_ball.cli import simulate
    from bouncing_ball.cli.output import lines

    return Program(simulate.add_options, simulate.simulate, lines)


def _motion() -> Program:
    from bouncing_ball.cli import long_run
    from bouncing_ball.cli.output import lines

    return Program(long_run.motion_options, long_run.motion, lines)


def _diagram() -> Program:
    from bouncing_ball.cli import long_run

    return Program(long_run.diagram_options, long_run.diagram, long_run.diagram_lines)


def _design() -> Program:
    from bouncing_ball.cli import design
    from bouncing_ball.cli.design_text import design_lines

    return Program(design.add_options, design.design, design_lines, design.design_document)


def _fit() -> Program:
    from bouncing_ball.cli import fit
    from bouncing_ball.cli.options import add_parameters

    return Program(
        add_options=lambda parser: add_parameters(parser, fit.fit),
        answer=lambda file, **options: fit.fit(file, **options),
        lines=fit.fit_lines,
    )


def _explain() -> Program:
    from bouncing_ball.cli.options import add_parameters
    from bouncing_ball.pipeline.provenance import explain, explanation_lines

    return Program(
        add_options=lambda parser: add_parameters(parser, explain),
        answer=lambda file, house: explain(file, house=house),
        lines=explanation_lines,
    )


def _diff() -> Program:
    from bouncing_ball.cli.diff import diff
    from bouncing_ball.cli.options import add_parameters

    return Program(
        add_options=lambda parser: add_parameters(parser, diff),
        answer=lambda names, against, html: diff(tuple(names), against=against, html=html),
        lines=None,
    )


COMMANDS = {
    "orbit": Command(
        purpose="the n-T orbit at an excitation amplitude",
        text=(
            "An n-T orbit is a periodic motion. It is stable if balls that start near it approach "
            "it, and admissible if no other impact or release occurs within a period."
        ),
        examples=(
            "orbit --amplitude 1 --restitution 0.85",
            "orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10",
            ("orbit --amplitude 0.9 --restitution 0.85 --frequency-ratio 2 --side all"),
            "orbit --amplitude 1 --law tsuji --restitution 0.85 --duration 0.1",
        ),
        program=_orbit,
        cheaper=_SIMPLER,
    ),
    "limits": Command(
        purpose="saddle-node and period doubling of the n-T orbits",
        text=(
            "An n-T orbit exists above the saddle-node and is stable up to the period doubling, "
            "beyond which the motion repeats only after 2n periods of the table."
        ),
        examples=(
            "limits --restitution 0.85",
            "limits --n 2 --damping-ratio 0.05 --frequency-ratio 10",
            "limits --restitution 0.85 --frequency-ratio 10 --certify",
        ),
        program=_limits,
        cheaper=_SIMPLER,
    ),
    "error-law": Command(
        purpose="the error K/ϖ of the restitution model to first order",
        text=(
            "The difference of the contact from the restitution model, relative to the restitution "
            "model (Eqs. 37-38), is K/ϖ to first order. The deviation of the model relative to the "
            "contact, as in design, is to this order the same with the other sign. To this order "
            "both fall to ε at the frequency ratio ϖ = |K|/ε. This is an estimate and no bound."
        ),
        examples=("error-law --amplitude 1 --restitution 0.65",),
        program=_error_law,
    ),
    "permanent-contact": Command(
        purpose="the amplitude up to which the ball stays on the table",
        text=(
            "Up to this Λ a ball at rest stays in contact with the table, on its spring and "
            "damper. In the restitution model the threshold is Λ = 1."
        ),
        examples=("permanent-contact --restitution 0.65 --frequency-ratio 6",),
        program=_permanent_contact,
    ),
    "follow": Command(
        purpose="any periodic orbit along any parameter, with its bifurcations",
        text=(
            "The orbit is the n-T orbit, or that on which a simulated ball ends. Its branch is "
            "followed along a parameter up to a value; the special orbits on the way and the "
            "reason for the end of the branch are printed."
        ),
        examples=(
            "follow --amplitude 1 --restitution 0.85 --to 1.3",
            "follow --amplitude 1 --restitution 0.85 --to 1.3 --doublings 2",
            (
                "follow --amplitude 1 --restitution 0.85 --frequency-ratio 10 --along "
                "frequency-ratio --to 2"
            ),
            "follow --amplitude 1.6 --restitution 0.5 --phase 1 --velocity -3 --to 1.8",
        ),
        program=_follow,
        cheaper="a nearer value of to or fewer doublings",
    ),
    "curve": Command(
        purpose="a curve of saddle-nodes, period doublings or grazing orbits in two parameters",
        text=(
            "A branch is followed as by follow. The curve in two parameters goes through the first "
            "special orbit of the kind on this branch. Its cusps and resonances are printed."
        ),
        examples=(
            (
                "curve --amplitude 1 --restitution 0.85 --frequency-ratio 10 --to 1.3 --kind "
                "period-doubling --across frequency-ratio --low 2 --high 100"
            ),
        ),
        program=_curve,
        cheaper="narrower ranges or fewer points",
    ),
    "simulate": Command(
        purpose="a sequence of impacts from any initial impact",
        text=(
            "Each line of the answer is an impact. The list ends early if the ball stays on the "
            "table."
        ),
        examples=(
            "simulate --amplitude 1 --restitution 0.85 --impacts 5",
            "simulate --amplitude 0 --restitution 0.5 --velocity -4 --impacts 5",
        ),
        program=_simulate,
        cheaper="fewer impacts",
    ),
    "motion": Command(
        purpose="the motion on which a ball ends",
        text=(
            "The motion is an orbit, if it repeats; subharmonic, if it repeats only after a "
            "multiple of the period of an orbit, as beyond a period doubling; locked, if it "
            "repeats and the ball sticks to the table in between, with 0 periods if rounding "
            "errors decide on their number; permanent contact; chaotic, if it has not repeated as "
            "long as it was followed and its neighbours separate; or undecided. Without --phase "
            "and --velocity the shares of other starts that end on each motion are listed too; "
            "orbit 2/1 is an orbit of two periods of the table with one impact."
        ),
        examples=(
            "motion --amplitude 1.1 --restitution 0.85",
            "motion --amplitude 3 --restitution 0.5 --phase 1 --velocity -4",
        ),
        program=_motion,
        cheaper="fewer impacts",
    ),
    "diagram": Command(
        purpose="the motions on which balls end, over the amplitude",
        text=(
            "Several balls are followed at each amplitude. Each line lists the motions on which "
            "they end, with the periods and impacts after which a motion repeats, and its share "
            "of the balls."
        ),
        examples=("diagram --amplitude 0.9 1.1 --points 5 --restitution 0.85",),
        program=_diagram,
        cheaper="fewer amplitudes, fewer starts or fewer impacts",
    ),
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
        ),
        program=_fit,
        has_symbols=False,
    ),
    "explain": Command(
        purpose="where an artifact comes from, and how to make it again",
        text=(
            "Each figure, table and dataset contains the commit and the parameters from which it "
            "was made."
        ),
        examples=("explain figures/fig14.png",),
        program=_explain,
        has_symbols=False,
    ),
    "diff": Command(
        purpose="the differences between results and the accepted record",
        text=(
            "The exit status is 0 if they agree, 1 if they differ, and 2 if they cannot be "
            "compared."
        ),
        examples=(
            "diff",
            "diff . results fig08",
            "diff --against runs/soft",
        ),
        program=_diff,
        has_symbols=False,
    ),
}
"""The subcommands by name."""
