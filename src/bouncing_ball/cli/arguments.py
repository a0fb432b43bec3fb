"""Arguments of the command line, checked with one line per mistake."""

import argparse
import math
import re
from pathlib import Path
from typing import Any, NoReturn

from bouncing_ball.cli.output import print_lines
from bouncing_ball.errors import printable

# Of frequency ratio and amplitude: beyond, their squares leave no digits.
_LARGEST = 1e8
# Of the frequency ratio, for the same reason.
_SMALLEST = 1e-8
# One impact takes a third of a millisecond of a processor: half a minute.
_MOST_IMPACTS = 100_000
_DRAWINGS = (".pdf", ".png", ".svg")


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line and exit status 2."""

    laws: Any = None
    """Group of the options about a contact law, which are described when help is asked for."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        # A value such as -1e6 or -5N/m is no option; Python 3.14 reads them so itself.
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {printable(message, None)}\n")

    def format_help(self) -> str:
        if self.laws is not None:
            self.laws.description = _laws()
        return super().format_help()

    def print_help(self, file=None) -> None:
        print_lines(self.format_help().splitlines())


class _Version(argparse.Action):
    """The version of the installed package, looked up only when it is asked for."""

    def __call__(self, parser, namespace, values, option_string=None):
        from importlib.metadata import version

        print_lines([f"{parser.prog} {version('bouncing-ball')}"])
        parser.exit()


def _number(low: float, high: float, *, low_open: bool = True, high_open: bool = True):
    """A parser of finite numbers in an interval, for ``type=``."""
    left, right = "(" if low_open else "[", ")" if high_open else "]"
    if math.isinf(high):
        allowed = f"a finite number {'>' if low_open else '≥'} {low:g}"
    else:
        allowed = f"a number in {left}{low:g}, {high:g}{right}"
    if math.isinf(low):
        allowed = "a finite number"

    def parse(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        above = value > low if low_open else value >= low
        below = value < high if high_open else value <= high
        if not (math.isfinite(value) and above and below):
            raise argparse.ArgumentTypeError(f"{text!r} is not {allowed}")
        return value

    return parse


def _count(largest: int):
    """A parser of whole numbers from 1, for ``type=``."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = 0
        if not 1 <= value <= largest:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1 to {largest}")
        return value

    return parse


def _assignment(text: str) -> tuple[str, float]:
    """A parser of NAME=NUMBER, for ``type=``."""
    name, equals, value = text.partition("=")
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not (name and equals and math.isfinite(number)):
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=NUMBER, as stiffness=1000")
    return name, number


def _laws() -> str:
    """The contact laws, with the force and the parameters of each."""
    # Imported here: the laws need numpy.
    from bouncing_ball.cli.contact_law import options
    from bouncing_ball.contacts.laws import LAWS

    listed = (f"{law.name} {law.formula} ({', '.join(options(law))})" for law in LAWS.values())
    return "with the penetration p and a force over the weight of the ball: " + "; ".join(listed)


def _add_law(parser: Parser) -> None:
    group = parser.laws = parser.add_argument_group("a contact of another law")
    group.add_argument("--law", metavar="NAME", help="in place of the spring-damper")
    group.add_argument(
        "--set",
        type=_assignment,
        action="append",
        metavar="NAME=NUMBER",
        help="one of the law's parameters, as stiffness=1000; once for each",
    )
    group.add_argument(
        "--duration",
        type=_number(0, math.inf),
        metavar="D",
        help="in place of --set, with --restitution: duration of the free impact",
    )
    group.add_argument(
        "--speed",
        type=_number(0, math.inf),
        metavar="V",
        help="impact speed of that free impact (default: the orbit's own; for limits that of the "
        "restitution model, 2πn/(1 + r); for simulate the first impact's)",
    )


def _settle_law(top: "Parser", args: argparse.Namespace) -> None:
    """Refuse what does not go with a contact law, or without one."""
    if args.law is None:
        for name in ("set", "duration", "speed"):
            if getattr(args, name) is not None:
                top.error(f"--{name} needs --law")
        if args.restitution is args.damping_ratio is args.measured_restitution is None:
            top.error(
                "one of the arguments --restitution --damping-ratio --measured-restitution "
                "is required"
            )
        return
    if args.model in ("restitution", "spring-damper"):
        top.error(f"--model {args.model} has no --law: corrected, or none, for the law itself")
    for name in ("frequency_ratio", "damping_ratio", "measured_restitution"):
        if getattr(args, name) is not None:
            option = f"--{name.replace('_', '-')}"
            top.error(f"{option} does not go with --law {args.law}: --set, or --restitution "
                      "and --duration")  # fmt: skip


def _add_damping(parser: argparse.ArgumentParser, *, required: bool) -> None:
    group = parser.add_mutually_exclusive_group(required=required)
    group.add_argument(
        "--restitution",
        type=_number(0, 1, high_open=False),
        metavar="R",
        help="restitution coefficient r in (0, 1]; gives the damping by Eq. 16",
    )
    group.add_argument(
        "--damping-ratio",
        type=_number(0, 1, low_open=False),
        metavar="Z",
        help="damping ratio ζ in [0, 1) of the contact, in place of --restitution",
    )
    group.add_argument(
        "--measured-restitution",
        type=_number(0, 1, high_open=False),
        metavar="R",
        help="restitution coefficient that a free impact really has, in place of --restitution, "
        "whose r is that of the displacement release: with --release force it is higher",
    )


def _add_contact(parser: argparse.ArgumentParser, *, required: bool) -> None:
    parser.add_argument(
        "--frequency-ratio",
        type=_number(_SMALLEST, _LARGEST, low_open=False, high_open=False),
        required=required,
        metavar="W",
        help="frequency ratio ϖ > 0 of the spring-damper contact",
    )
    _add_release(parser)


def _add_release(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--release",
        choices=["displacement", "force"],
        help="what ends a contact (default: displacement, the paper's)",
    )


def _add_model(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--model",
        choices=["restitution", "spring-damper", "corrected"],
        help="default: spring-damper if --frequency-ratio is given, else restitution",
    )


def _add_family(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--n", type=_count(1000), default=1, help="index of the family (default: 1)"
    )


def _add_amplitude(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--amplitude",
        type=_number(0, _LARGEST, high_open=False),
        required=True,
        metavar="L",
        help="excitation amplitude Λ > 0",
    )


def _add_orbit(sub: Parser) -> None:
    _add_model(sub)
    _add_family(sub)
    _add_amplitude(sub)
    _add_contact(sub, required=False)
    which = sub.add_mutually_exclusive_group()
    which.add_argument(
        "--side",
        choices=["stable", "unstable", "all"],
        default="stable",
        help="side of the saddle-node: the one that is stable next to it (default), or the other; "
        "all: every orbit at this amplitude, in order of contact duration",
    )
    which.add_argument(
        "--index", type=_count(1000), metavar="K", help="the K-th of --side all, from 1"
    )


def _add_limits(sub: Parser) -> None:
    _add_model(sub)
    _add_family(sub)
    _add_contact(sub, required=False)


def _add_error_law(sub: Parser) -> None:
    _add_family(sub)
    _add_amplitude(sub)
    _add_release(sub)
    # K is the error at ϖ = 1, continued by its law.
    sub.set_defaults(frequency_ratio=1.0)


def _add_permanent_contact(sub: Parser) -> None:
    _add_model(sub)
    _add_contact(sub, required=True)


def _add_simulate(sub: Parser) -> None:
    _add_model(sub)
    _add_amplitude(sub)
    _add_contact(sub, required=False)
    sub.add_argument("--impacts", type=_count(_MOST_IMPACTS), default=100, help="default: 100")
    sub.add_argument(
        "--phase",
        type=_number(-math.inf, math.inf),
        default=0.0,
        help="phase of the table at the first impact (default: 0)",
    )
    sub.add_argument(
        "--velocity",
        type=_number(-math.inf, math.inf),
        help="absolute velocity of the ball before the first impact (default: -π)",
    )


def _add_diff(sub: Parser) -> None:
    sub.add_argument("record", metavar="RECORD", help="folder with the accepted artifacts")
    sub.add_argument("results", metavar="RESULTS", help="folder with the new artifacts")
    sub.add_argument(
        "artifacts",
        metavar="ARTIFACT",
        nargs="*",
        default=[],  # or argparse calls it required
        help="as fig08 or table1; default: all",
    )
    sub.add_argument("--html", metavar="FILE", help="one page with all pictures")


def _drawing(text: str) -> Path:
    """A parser of the name of a drawing, for ``type=``."""
    path = Path(text)
    # Of the text too: a path forgets the slash that makes it a folder's.
    if path.suffix not in _DRAWINGS or not text.endswith(path.suffix):
        raise argparse.ArgumentTypeError(f"{text!r} does not end in {' or '.join(_DRAWINGS)}")
    return path


# The calculator's parameters, with an example of each: what is read with its unit.
_DESIGN = {
    "the table": {
        "frequency": "50 Hz; in cycles, or with its unit in rad/s or rpm",
        "angular-frequency": "314 rad/s, in place of --frequency",
        "period": "20 ms, in place of --frequency",
        "amplitude": "0.1 mm",
        "acceleration": "0.8 g, in place of --amplitude",
        "gravity": "9.80665 m/s^2, the default",
    },
    "the ball, and how stiff its contact is; without it one is chosen": {
        "mass": "20 g",
        "stiffness": "1e7 N/m",
        "contact-time": "0.1 ms, of a free impact, in place of --stiffness",
        "reduced-modulus": "115 GPa, E* of a Hertz contact, with --radius",
        "radius": "5 mm, of a Hertz contact",
    },
    "how much the contact loses": {
        "damping": "10 N s/m, with --stiffness",
        "damping-ratio": "0.05",
        "restitution": "0.85, by Eq. 16",
        "measured-restitution": "0.85, of a free impact under --release",
        "drop-height": "1 m, of a drop test, with --rebound-height",
        "rebound-height": "72 cm",
    },
}


def _add_design(sub: Parser) -> None:
    """Texts: what they mean is the calculator's to say."""
    for title, options in _DESIGN.items():
        group = sub.add_argument_group(title)
        for name, example in options.items():
            group.add_argument(f"--{name}", metavar="X", help=f"such as {example}")
    group = sub.add_argument_group("the question")
    group.add_argument(
        "--n",
        type=_count(1000),
        help="index of the family (default: the first 8, and a verdict on the first stable one)",
    )
    group.add_argument(
        "--release",
        choices=["displacement", "force"],
        default="displacement",
        help="what ends a contact (default: displacement, the paper's)",
    )
    group.add_argument(
        "--quantity",
        default="max_height",
        metavar="NAME",
        help="what must be right: max_height (default), bounce_velocity, phase, "
        "apparent_restitution, saddle_node, period_doubling or permanent_contact",
    )
    group.add_argument(
        "--tolerance", default="0.01", metavar="X", help="how far it may be off (default: 1 %%)"
    )
    sub.add_argument("--json", action="store_true", help="one JSON object, full precision")
    sub.add_argument(
        "--plot", type=_drawing, metavar="FILE", help="a page to print: .pdf, .png or .svg"
    )


# The questions to a model: what each is for, and its own arguments.
_QUESTIONS = {
    "orbit": ("the n-T orbit at an amplitude", _add_orbit),
    "limits": ("saddle-node and period doubling of the n-T orbits", _add_limits),
    "error-law": ("error of the restitution model to first order, K/ϖ", _add_error_law),
    "permanent-contact": ("the amplitude up to which the ball stays down", _add_permanent_contact),
    "simulate": ("a sequence of impacts from any initial impact", _add_simulate),
}


# Those that take a contact law as well.
_LAWFUL = ("orbit", "limits", "simulate")


def parser() -> Parser:
    """The parser of all subcommands."""
    top = Parser(
        prog="bouncing-ball",
        description="Periodic orbits of a ball on a vibrating table. All quantities are "
        "dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g.",
    )
    top.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = top.add_subparsers(dest="command", parser_class=Parser)
    for name, (text, add_arguments) in _QUESTIONS.items():
        sub = commands.add_parser(name, help=text, description=text)
        sub.add_argument("--json", action="store_true", help="one JSON object, full precision")
        lawful = name in _LAWFUL
        _add_damping(sub, required=not lawful)
        add_arguments(sub)
        if lawful:
            _add_law(sub)

    design = commands.add_parser(
        "design",
        help="a contact with units: is a restitution coefficient enough, or which contact is",
        description="A contact in physical units. With a stiffness: is the restitution model good "
        "enough for it, and what does it get wrong? Without one: which stiffness, contact time and "
        "damping does a simulation need? A plain number is in SI units. Exit status: 0, 1 if there "
        "is no such orbit, 2 on a mistake.",
    )
    _add_design(design)

    text = "where a figure, dataset or table comes from, and the command that makes it again"
    explain = commands.add_parser("explain", help=text, description=text)
    explain.add_argument("file", type=Path, metavar="FILE", help="an artifact, or a copy of one")
    explain.add_argument("--json", action="store_true", help="one JSON object, whole checksums")

    diff = commands.add_parser(
        "diff",
        help="whether two folders of artifacts say the same",
        description="Compare figures/ and paper.md of two folders, variable by variable, within "
        "the budgets of the tolerance file. Exit status: 0 the same, 1 differs, 2 something could "
        "not be compared.",
    )
    _add_diff(diff)
    return top


def _refuse_still_models(top: Parser, model: str | None) -> None:
    """Only the contact has a threshold of permanent contact that depends on it."""
    if model == "corrected":
        top.error(
            "permanent-contact has no corrected form: there is no impact to correct, and the "
            "restitution model's Λ = 1 is right to second order in 1/ϖ already"
        )
    if model == "restitution":
        top.error("permanent-contact is Λ = 1 for --model restitution, whatever its r (Eq. 9)")


def parse(arguments: list[str] | None = None) -> argparse.Namespace:
    """Parsed arguments, with the model settled.

    Exits with status 2 and one line on a mistake.
    """
    top = parser()
    args = top.parse_args(arguments)
    if args.command is None:
        names = ", ".join([*_QUESTIONS, "design", "explain", "diff"])
        top.error(f"a command is missing, one of {names}")
    if not hasattr(args, "model"):
        return args
    if args.command == "permanent-contact":
        _refuse_still_models(top, args.model)
        return args
    _settle_law(top, args)
    if args.law is not None:
        return args
    if args.model is None:
        args.model = "restitution" if args.frequency_ratio is None else "spring-damper"
    if args.model == "restitution":
        if args.damping_ratio is not None:
            top.error(
                "--damping-ratio needs --frequency-ratio; --model restitution takes --restitution"
            )
        for name in ("frequency_ratio", "release"):
            if getattr(args, name) is not None:
                option = f"--{name.replace('_', '-')}"
                top.error(f"{option} has no meaning for --model restitution, which has no contact")
    elif args.frequency_ratio is None:
        top.error(f"--model {args.model} needs --frequency-ratio")
    return args
