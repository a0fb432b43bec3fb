"""The subcommands: purpose, explanation and examples in their ``--help``, and their program.

Beyond and contacts add theirs: an entry point of the group ``bouncing_ball_beyond.commands`` names
a mapping from subcommands to :class:`Command`. All that is known of contacts here is which command
is theirs, so that a command that is not installed is answered with how to install it.
"""

import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.cli.options import Parser

_WIDTH = 80
_SYMBOLS = {
    "n": "index of the family: its orbits repeat after n periods of the table, with one impact",
    "Λ": "excitation amplitude: the greatest acceleration of the table over gravity",
    "r": "restitution coefficient: relative speed after an impact over that before it",
    "ϖ": "frequency ratio: natural frequency of the contact over that of the table",
    "ζ": "damping ratio of the contact: r = exp(-πζ/√(1 - ζ²)) for the displacement release",
}


class Program(NamedTuple):
    """What a subcommand does: its options, its answer, and how the answer is printed.

    ``answer`` takes the options by name. ``lines`` has the answer as text, and is None if the
    program prints its answer itself. ``document`` has the answer as values for JSON.
    """

    add_options: Callable[["Parser"], None]
    answer: Callable[..., Any]
    lines: Callable[[Any], list[str]] | None
    document: Callable[[Any], Any] = lambda answer: answer


@dataclass(frozen=True)
class Command:
    """A subcommand.

    ``examples`` are without the name of the program. ``program`` imports what the subcommand
    needs, because the list of subcommands needs no numpy. ``cheaper`` is what makes its answer
    cheaper. ``names`` has the options that are not called as their parameters, and ``advice``
    gives a clause on an argument that the command does not know, from this argument, all arguments
    and all options, or an empty text.
    """

    purpose: str
    text: str
    examples: tuple[str, ...]
    program: Callable[[], Program]
    has_symbols: bool = True
    cheaper: str = ""
    names: Mapping[str, str] = field(default_factory=dict)
    advice: Callable[[str, Sequence[str], Iterable[str]], str] = lambda *_: ""

    def explanation(self) -> str:
        """The end of the help of the subcommand: explanation, symbols and examples."""
        lines = [*textwrap.wrap(self.text, _WIDTH), ""]
        if self.has_symbols:
            for symbol, meaning in _SYMBOLS.items():
                lines += textwrap.wrap(f"{symbol}  {meaning}", _WIDTH, subsequent_indent="   ")
            lines += [""]
        examples = (f"  bouncing-ball {each}" for each in self.examples)
        return "\n".join([*lines, "examples:", *examples])


def _about_balls(name: str) -> Callable[[], Program]:
    """The program of a subcommand about balls, whose functions have its name."""

    def program() -> Program:
        from bouncing_ball_beyond.inherited.cli import balls
        from bouncing_ball_beyond.inherited.cli.output import lines

        return Program(getattr(balls, f"{name}_options"), getattr(balls, name), lines)

    return program


def _explain() -> Program:
    from bouncing_ball_beyond.inherited.cli.options import add_parameters
    from bouncing_ball_beyond.inherited.pipeline.provenance import explain, explanation_lines

    return Program(
        add_options=lambda parser: add_parameters(parser, explain),
        answer=lambda file, house: explain(file, house=house),
        lines=explanation_lines,
    )


def _diff() -> Program:
    from bouncing_ball_beyond.inherited.cli.diff import diff
    from bouncing_ball_beyond.inherited.cli.options import add_parameters

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
            "orbit --amplitude 0.9 --restitution 0.85 --frequency-ratio 2 --side all",
        ),
        program=_about_balls("orbit"),
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
        ),
        program=_about_balls("limits"),
    ),
    "branch": Command(
        purpose="the special orbits on a branch of n-T orbits, and its ends",
        text=(
            "The branch is followed from its unstable to its stable side. Its saddle-nodes, period "
            "doublings and grazing orbits are printed in order, and why it ends."
        ),
        examples=("branch --restitution 0.85 --frequency-ratio 2 --amplitude-max 1.5",),
        program=_about_balls("branch"),
    ),
    "permanent-contact": Command(
        purpose="the amplitude up to which the ball stays on the table",
        text=(
            "Up to this Λ a ball at rest stays in contact with the table, on its spring and "
            "damper. In the restitution model the threshold is Λ = 1."
        ),
        examples=("permanent-contact --restitution 0.65 --frequency-ratio 6",),
        program=_about_balls("permanent_contact"),
    ),
    "thresholds": Command(
        purpose="the frequency ratio from which on a restitution coefficient is accurate enough",
        text=(
            "The error of a quantity is its value on a contact with a spring and a damper minus "
            "that of the restitution model, over the latter (Eqs. 37-38). The answer is the ϖ "
            'above which each error is tolerable; "within" stands for an error that is tolerable '
            'at every ϖ from 1 to 10⁶, and "outside" for one that is not at the largest.'
        ),
        examples=("thresholds --amplitude 1 --restitution 0.65",),
        program=_about_balls("thresholds"),
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
        program=_about_balls("simulate"),
        cheaper="fewer impacts",
    ),
    "explain": Command(
        purpose="where an artifact comes from, and how to make it again",
        text=(
            "Each figure, table and dataset contains the commit and the parameters from which it "
            "was made."
        ),
        examples=("explain figures/ext_map.png",),
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
            "diff . results ext_map",
            "diff --against runs/compliant",
        ),
        program=_diff,
        has_symbols=False,
    ),
}
"""The subcommands of this house by name."""

_GROUP = "bouncing_ball_beyond.commands"
# The subcommands that moved to the package of contacts, which has a command of its own.
_OF_CONTACTS = ("fit",)


def commands() -> dict[str, Command]:
    """All subcommands that are installed, those of the inherited library first."""
    found = dict(COMMANDS)
    for point in sorted(entry_points(group=_GROUP), key=lambda each: each.name):
        found |= point.load()
    return found


def how_to_install(command: str) -> str:
    """A sentence for a subcommand that moved to contacts; empty for another one.

    Examples
    --------
    >>> how_to_install("fit")
    'fit is a command of contacts: make -C contacts setup, then contacts/.venv/bin/bounce fit'
    >>> how_to_install("orbits")
    ''
    """
    if command not in _OF_CONTACTS:
        return ""
    return (
        f"{command} is a command of contacts: make -C contacts setup, then "
        f"contacts/.venv/bin/bounce {command}"
    )
