"""The command ``bouncing-ball``: orbits, branches, motions and errors from a terminal.

Each command makes a ball, calls one public function with it, and prints the answer. The package is
imported when a command runs, so that ``--help`` is fast.
"""

import csv
import math
import re
import sys
from collections.abc import Callable
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import Any

import click

import bouncing_ball_beyond as bb

PICTURES = (".png", ".pdf", ".svg")


class Command(click.Command):
    """A command that names its option where a function of the package finds a mistake."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """The arguments of the command; all options that are missing are named at once."""
        given, _, _ = self.make_parser(ctx).parse_args(list(args))
        missing = [each.opts[0] for each in self.params if each.required and each.name not in given]
        has_ball = any(each.name == "law" for each in self.params)
        no_ball = has_ball and not given.keys() & {"restitution", "damping_ratio", "law"}
        if no_ball:
            missing.append("--restitution or --law")
        if (no_ball or len(missing) > 1) and not {*args} & {*ctx.help_option_names}:
            several = "s" if len(missing) > 1 else ""
            raise click.UsageError(f"Missing option{several} {', '.join(missing)}.")
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        # Mistakes, files that cannot be written, and extras that are not installed.
        except (ValueError, OSError, ImportError) as error:
            options = {parameter.name: parameter.opts[0] for parameter in self.params}
            # Names before the colon, but not where a ball is written in parentheses.
            names, colon, allowed = str(error).partition(":")
            names = re.sub(r"\([^)]*\)|\w+", lambda word: options.get(word[0], word[0]), names)
            raise click.ClickException(names + colon + allowed) from error


class Commands(click.Group):
    """The group of all commands, in the order in which they are written."""

    command_class = Command

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of commands."""
        return list(self.commands)


@click.group(cls=Commands)
@click.version_option(package_name="bouncing-ball-beyond")
def commands() -> None:
    """A ball on a vibrating table.

    Quantities are dimensionless but for the shaker: times Ωt, lengths Ω²y/g.
    """


def main(arguments: list[str] | None = None) -> None:
    """Run a command. A mistake is one line on the standard error, with the exit status 2."""
    given = sys.argv[1:] if arguments is None else arguments
    try:
        status = commands.main(given or ["--help"], "bouncing-ball", standalone_mode=False)
    except click.ClickException as error:
        click.echo(f"bouncing-ball: {error.format_message()}", err=True)
        sys.exit(2)
    except click.Abort:
        sys.exit(130)
    sys.exit(status if isinstance(status, int) else 0)


def made(name: str, make: Callable, *options: Callable) -> Callable:
    """A decorator for options, of which a command gets one argument, made by a function of them."""

    def decorate(function: Callable) -> Callable:
        @wraps(function)
        def command(**given: Any) -> None:
            own = {each: given.pop(each) for each in signature(make).parameters}
            function(**{name: make(**own)}, **given)

        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def output(*suffixes: str) -> Callable:
    """The option of a file, whose name must end with one of some suffixes."""

    def check(ctx: click.Context, parameter: click.Parameter, value: str | None) -> str | None:
        if value is not None and Path(value).suffix not in suffixes:
            raise click.BadParameter(f"{value!r} must end with one of {', '.join(suffixes)}")
        return value

    return click.option(
        "--output",
        callback=check,
        metavar="FILE",
        help=f"Also write a file: {', '.join(suffixes)}; .csv of orbits has rows for multipliers.",
    )


AMPLITUDE = click.option("--amplitude", type=float, required=True, help="Amplitude Λ of the table.")
N = click.option("--n", type=int, default=1, show_default=True, help="Periods of the n-T orbit.")
DATA = output(".nc", ".csv")
DRAWN = output(".nc", ".csv", *PICTURES)


def table_of(harmonics: Any, samples: str | None, highest_harmonic: int | None) -> Any:
    """The table of its harmonics, or of a file of samples; by default a sine."""
    from bouncing_ball_beyond.tables import SINE

    if harmonics and samples:
        raise ValueError("harmonics, samples: at most one of them may be given")
    if samples:
        return _of_samples(samples, highest_harmonic)
    if highest_harmonic is not None:
        raise ValueError("highest_harmonic: is that of the samples of a --table")
    return bb.Table(harmonics) if harmonics else SINE


def _of_samples(path: str, highest: int | None) -> Any:
    """The table of a file with a column of heights or of accelerations."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    columns = rows[0].keys() & {"height", "acceleration"} if rows else ()
    if len(columns) != 1:
        raise ValueError(f"samples {path}: must have a first line with height or acceleration")
    (name,) = columns
    values = []
    for line, row in enumerate(rows, 2):
        try:
            values.append(float(row[name]))
        except (TypeError, ValueError):
            raise ValueError(f"samples {path}, line {line}: {row[name]!r} is no number") from None
    return bb.Table.of_samples(values, highest, acceleration=name == "acceleration")


def ball_of(
    restitution: float | None,
    frequency_ratio: float | None,
    damping_ratio: float | None,
    release: str,
    law: str | None,
    settings: tuple[str, ...],
    corrected: bool,
) -> Any:
    """The ball of a restitution coefficient, a spring and damper, or a law by its name."""
    if settings and law is None:
        raise ValueError("settings: --set gives the parameters of a --law, and there is none")
    if law is not None:
        ball = _of_law(law, restitution, settings)
    elif frequency_ratio is None and damping_ratio is None:
        ball = bb.Rigid(restitution)
    else:
        ball = bb.SpringDamper(frequency_ratio, restitution, damping_ratio, release)
    return bb.Corrected(ball) if corrected else ball


def _of_law(law: str, restitution: float | None, settings: tuple[str, ...]) -> Any:
    """The ball of a named law, with its parameters from texts such as "stiffness=1000"."""
    values = {} if restitution is None else {"restitution": restitution}
    for text in settings:
        parameter, _, number = text.partition("=")
        try:
            values[parameter] = float(number)
        except ValueError:
            raise ValueError(f"settings {text!r}: must be NAME=NUMBER") from None
    return bb.named_law(law, **values)


def start_of(phase: float | None, velocity: float | None) -> dict[str, float]:
    """The arguments of a first impact, without those that are not given."""
    start = {"phase": phase, "velocity": velocity}
    return {name: value for name, value in start.items() if value is not None}


def branch_of(
    ball: Any,
    table: Any,
    amplitude: float,
    n: int,
    start: dict,
    along: str,
    to: float,
    doublings: int,
) -> Any:
    """The branch of the n-T orbit, or of that on which a ball ends, or of doubled orbits."""
    known = {"amplitude": amplitude, "table": table}
    one = bb.orbit_of_motion(ball, **known, **start) if start else bb.orbit(ball, **known, n=n)
    goal = {"along": along.replace("-", "_"), "to": to}
    branch = bb.follow(one, **goal)
    for _ in range(doublings):
        branch = bb.follow(branch.first("period doubling"), **goal)
    return branch


with_table = made(
    "table",
    table_of,
    click.option(
        "--harmonic",
        "harmonics",
        type=(int, float, float),
        multiple=True,
        metavar="K SIZE PHASE",
        help="The table is a sum of SIZE sin(Kτ + PHASE); without one, of sin τ.",
    ),
    click.option(
        "--table",
        "samples",
        type=click.Path(exists=True, dir_okay=False),
        metavar="CSV",
        help="The table by samples of one period, in a column height or acceleration.",
    ),
    click.option("--highest-harmonic", type=int, metavar="K", help="Of noisy samples, such as 5."),
)
with_ball = made(
    "ball",
    ball_of,
    click.option("--restitution", type=float, help="Restitution coefficient r."),
    click.option("--frequency-ratio", type=float, help="ϖ; without it impacts are instants."),
    click.option("--damping-ratio", type=float, help="ζ of the contact, in place of r."),
    click.option(
        "--release",
        type=click.Choice(["displacement", "force"]),
        default="displacement",
        help="Contacts end at the level of the table, or where the force vanishes.",
    ),
    click.option("--law", metavar="NAME", help="Contact law, such as tsuji."),
    click.option("--set", "settings", multiple=True, metavar="NAME=NUMBER", help="Of the law."),
    click.option("--corrected", is_flag=True, help="Impacts as instants at the force's centroid."),
    with_table,
)
with_start = made(
    "start",
    start_of,
    click.option("--phase", type=float, help="Phase of the table at the first impact."),
    click.option("--velocity", type=float, help="Absolute velocity of the ball before it."),
)
with_branch = made(
    "branch",
    branch_of,
    with_ball,
    AMPLITUDE,
    N,
    with_start,
    click.option("--along", default="amplitude", show_default=True, help="What changes."),
    click.option("--to", type=float, required=True, help="Its value at which the branch ends."),
    click.option(
        "--doublings", type=int, default=0, help="Follow the orbits after so many doublings."
    ),
)


def write(found: Any, output: str | None) -> None:
    """Write orbits, a branch or a dataset to a file, if one is wanted."""
    if output is None:
        return
    if output.endswith(PICTURES):
        bb.plot(found).savefig(output)
        return
    data = found if hasattr(found, "to_netcdf") else bb.to_dataset(found)
    if output.endswith(".nc"):
        data.to_netcdf(output)
    else:
        data.to_dataframe().to_csv(output)


def in_columns(head: list[str], columns: list[dict[str, str]]) -> str:
    """Columns of texts by the names of quantities, which are the first column."""
    rows = [f"{'':22}" + "".join(f"{title:>19}" for title in head)]
    for name in columns[0]:
        values = "".join(f"{column[name]:>19}" for column in columns)
        rows.append(f"{name.replace('_', ' '):22}{values}")
    return "\n".join(rows)


@commands.command()
@with_ball
@AMPLITUDE
@N
@click.option(
    "--side",
    type=click.Choice(["stable", "unstable"]),
    default="stable",
    help="Side of the saddle-node.",
)
@DATA
def orbit(ball: Any, output: str | None, **known: Any) -> None:
    """The n-T orbit, with one impact in n periods of the table."""
    found = bb.orbit(ball, **known)
    click.echo(found)
    write(found, output)


@commands.command()
@with_ball
@N
@DATA
def limits(ball: Any, table: Any, n: int, output: str | None) -> None:
    """The saddle-node and the period doubling of n-T orbits."""
    found = list(bb.limits(ball, n=n, table=table))
    for special in found:
        click.echo(special)
    write(found, output)


@commands.command()
@with_branch
@DRAWN
def follow(branch: Any, output: str | None) -> None:
    """A branch of orbits along a parameter, with its special orbits."""
    click.echo(branch)
    write(branch, output)


@commands.command("curve")
@with_branch
@click.option("--kind", default="saddle-node", show_default=True, help="Kind of special orbit.")
@click.option("--across", required=True, help="The second parameter.")
@click.option(
    "--range", "ranges", type=(str, float, float), multiple=True, help="NAME LOW HIGH of the curve."
)
@DRAWN
def follow_special(branch: Any, kind: str, across: str, ranges: Any, output: str | None) -> None:
    """The curve in two parameters of the first special orbit of a kind on a branch."""
    found = bb.special_curve(
        branch.first(kind),
        along=(branch.along, across.replace("-", "_")),
        ranges={name.replace("-", "_"): (low, high) for name, low, high in ranges},
    )
    click.echo(found)
    write(found, output)


@commands.command()
@with_ball
@AMPLITUDE
@with_start
@click.option("--impacts", type=int, default=2000, show_default=True, help="Followed at most.")
def motion(ball: Any, start: dict, **known: Any) -> None:
    """The motion on which a ball ends."""
    found = bb.motion_of(ball, **known, **start)
    for name, value in found.items():
        click.echo(f"{name:20}{value.item()}")


@commands.command()
@with_ball
@click.option("--amplitude", type=(float, float), required=True, help="First and last Λ.")
@click.option("--points", type=int, default=300, show_default=True, help="Number of amplitudes.")
@DATA
def diagram(ball: Any, table: Any, amplitude: Any, points: int, output: str | None) -> None:
    """The motions on which balls end, over the amplitude, each with its share of the starts."""
    import numpy as np

    low, high = amplitude
    found = bb.orbit_diagram(ball, amplitude=np.linspace(low, high, points), table=table)
    motions = found[["kind", "periods", "impacts"]].to_dataframe()
    click.echo(motions.groupby("amplitude").value_counts(normalize=True).to_string())
    write(found, output)


@commands.command("simulate")
@with_ball
@AMPLITUDE
@with_start
@click.option("--impacts", type=int, default=20, show_default=True, help="Their number.")
@DATA
def impacts_after(ball: Any, start: dict, output: str | None, **known: Any) -> None:
    """The impacts that follow a given one."""
    found = bb.simulate(ball, **known, **start)
    click.echo(found.to_dataframe().to_string())
    write(found, output)


@commands.command("thresholds")
@with_ball
@AMPLITUDE
@N
@click.option("--tolerance", type=float, default=0.01, show_default=True, help="Largest error.")
def needed_ratios(ball: Any, **known: Any) -> None:
    """From which stiffness on simple models are good enough.

    The answer is ϖ for a contact with a spring and a damper, also if only r is given. For another
    law it is π over the duration of a free impact. With --corrected, also for this model.
    """
    contacts, models = _judged(ball)
    if not contacts.lasts:
        contacts = bb.SpringDamper(1.0, restitution=contacts.restitution)
    columns = [
        {
            name: "no orbit" if math.isnan(ratio) else f"{ratio:.6g}"
            for name, ratio in bb.law_thresholds(contacts, **known).items()
        }
    ]
    for simple in models.values():
        found = bb.error_thresholds(contacts, simple=simple, **known)
        # Where there is no threshold, its status says why.
        columns.append(
            {
                name: f"{ratio:.6g}" if status == "found" else str(status)
                for name, (ratio, status) in found.items()
            }
        )
    click.echo(in_columns(["error law", *models], columns))


def _judged(ball: Any) -> tuple[Any, dict[str, Any]]:
    """The ball with its contact, and the models in its place that are judged, by their names."""
    if ball.sinks:
        return ball.of, {"restitution model": None, "corrected model": bb.Corrected}
    return ball, {"restitution model": None}


@commands.command("error-law")
@with_ball
@AMPLITUDE
@N
def error_law(ball: Any, **known: Any) -> None:
    """Errors of the restitution model on a contact, by the error law and exactly.

    With --corrected, also those of this model.
    """
    contact, models = _judged(ball)
    if not contact.lasts:
        raise ValueError("frequency_ratio: must be given, because the law is that of a contact")
    errors = [bb.law_errors(contact, **known), bb.law_remainders(contact, **known)]
    errors += [bb.exact_errors(contact, simple=simple, **known) for simple in models.values()]
    columns = [{name: f"{error:.4g}" for name, error in each.items()} for each in errors]
    click.echo(in_columns(["error law", "right to", *models], columns))


@commands.command()
@click.option("--frequency", required=True, help='Of the table, such as "50 Hz".')
@click.option("--restitution", type=float, required=True, help="Restitution coefficient r.")
@click.option("--stroke", help='Amplitude of the table, half of peak to peak, such as "0.1 mm".')
@click.option("--acceleration", help='In place of it, such as "0.8 g"; a number is in m/s².')
@click.option("--mass", help='Of the ball, such as "20 g"; or its radius and density.')
@click.option("--radius", help='Of the ball, such as "5 mm".')
@click.option("--density", help='Of the ball, such as "7800 kg/m^3".')
@click.option("--contact-duration", help='Such as "100 us".')
@click.option("--stiffness", help='In place of the duration, such as "1e7 N/m".')
@click.option("--youngs-modulus", help='Of the ball, in place of both, such as "210 GPa".')
@click.option("--poissons-ratio", type=float, default=0.3, help="Of the ball, by default 0.3.")
@click.option("--table-youngs-modulus", help="Without it the table is rigid.")
@click.option("--table-poissons-ratio", type=float, default=0.3, help="By default 0.3.")
@click.option("--gravity", default="9.80665 m/s^2", show_default=True, help="Its acceleration.")
@N
@click.option("--tolerance", default="1 %", show_default=True, help="Of the greatest height.")
@with_table
def shaker(**quantities: Any) -> None:
    """Whether a restitution coefficient is good enough for a ball on a shaker, with units."""
    click.echo(bb.on_shaker(**quantities))
