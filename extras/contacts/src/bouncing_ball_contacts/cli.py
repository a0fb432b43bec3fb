"""The command ``bounce``: design, diagnose, fit and engines."""

import dataclasses
import io
import json
import re
import sys
from pathlib import Path
from typing import Any

import click

from bouncing_ball_contacts.answers import Answer
from bouncing_ball_contacts.bounces import Bounce
from bouncing_ball_contacts.engines import PAIR, ran_in
from bouncing_ball_contacts.questions import design, diagnose, rows_of
from bouncing_ball_contacts.rows import BY_NUMBER, ENGINES
from bouncing_ball_contacts.units import (
    STANDARD_GRAVITY,
    Refused,
    in_si,
    refuse,
)

_BODY = [
    click.Option(["--mass"], help="Mass of the body, such as '50 g'."),
    click.Option(["--restitution"], help="√(h′/h) that is wanted, 0 to 1."),
    click.Option(["--drop-height"], help="Height of the drop; 1 m if no speed is given."),
    click.Option(["--speed"], help="Impact speed, in place of the height."),
    click.Option(["--radius"], help="Radius, or half the height of a box."),
    click.Option(["--density"], help="In place of the size or the mass; also steel, rubber, …"),
    click.Option(
        ["--points"], type=int, default=1, help="4 for the face of a box, in engines with springs."
    ),
    click.Option(
        ["--gravity"],
        default=str(STANDARD_GRAVITY),
        help=f"{STANDARD_GRAVITY} m/s² if not given; 0 needs the speed.",
    ),
]
_STEP = click.Option(["--time-step"], help="Of the engine, such as '2 ms', 1/240 or '240 Hz'.")


_ENGINE = click.Option(["--engine"], default="generic", help="One of 'bounce engines'.")
_EXPLAIN = click.Option(["--explain"], is_flag=True, help="All remarks.")
_JSON = click.Option(["--json", "as_json"], is_flag=True, help="All numbers, in SI units.")


_EXAMPLES = """\b
Examples:
  bounce design --mass "50 g" --restitution 0.8 --time-step "2 ms" --engine mujoco
  bounce diagnose --engine mujoco solref="0.02 1" --mass "50 g" --time-step "2 ms" --restitution 0.8
  bounce fit golf_ball --engine mujoco --time-step "1 ms"
  bounce engines
"""


@click.group(
    epilog=_EXAMPLES,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(package_name="bouncing-ball-contacts", prog_name="bounce")
@click.pass_context
def main(context: click.Context) -> None:
    """The bounce of a physics engine: what to write, what numbers do, what a recording shows."""
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


def _plain(answers: Any) -> Any:
    """Return the fields of an answer, or of a dictionary of answers."""
    if isinstance(answers, dict):
        return {name: _plain(answer) for name, answer in answers.items()}
    return dataclasses.asdict(answers)


def _print(
    answers: Any,
    as_json: bool,
    explain: bool,
    written: Answer | None = None,
    heard: Any = None,
) -> None:
    """Print answers: of one ball or of several, what was heard, and what to write for an engine."""
    if as_json:
        beside = {"heard": heard, "design": written}
        values = _plain(answers) | {name: _plain(part) for name, part in beside.items() if part}
        # Arrays become lists, and numbers that JSON does not have, NaN and Infinity, become null.
        text = json.dumps(values, default=lambda array: array.tolist())
        plain = json.loads(text, parse_constant=lambda _: None)
        click.echo(json.dumps(plain, indent=1, ensure_ascii=False))
        return
    named = list(answers.items()) if isinstance(answers, dict) else [("", answers)]
    if written is not None:
        named.append(("", written))
    texts = [f"{name}\n{answer.explained if explain else answer}" for name, answer in named]
    said: set[str] = set()
    for line in "\n\n".join(text.lstrip("\n") for text in texts).split("\n"):
        # A note on each of several balls is printed for the first one.
        note = re.sub(r"[\d.]+", "", line)
        if note not in said or note[:1] != "!":
            click.echo(line)
        said.add(note)


def _status(answer: Answer) -> int:
    """Return the exit status: 1 if r is not kept and nothing is written to paste."""
    return int(not (answer.is_kept or answer.snippet or answer.change or answer.also))


@main.command(
    "design",
    params=[
        *_BODY,
        click.Option(["--penetration"], help="Depth that must not be exceeded."),
        click.Option(["--stiffness"], help="Of the contact, in place of the penetration."),
        click.Option(["--contact-time"], help="Of a contact without damping, in place of these."),
        click.Option(["--friction"], help="Coefficient of friction."),
        _ENGINE,
        _STEP,
        click.Option(["--pixels"], help="In a metre, of matter-js; its gravity sets them if not."),
        _EXPLAIN,
        _JSON,
    ],
)
def design_command(
    engine: str,
    time_step: str | None,
    pixels: str | None,
    explain: bool,
    as_json: bool,
    **bounce: Any,
) -> int:
    """Write the contact of an engine, or its restitution number, for the bounce that you want."""
    answer = design(Bounce(**bounce), engine, time_step, pixels=pixels)
    _print(answer, as_json, explain)
    return _status(answer)


def _assigned(pairs: tuple[str, ...]) -> dict[str, str]:
    """Return names and values of texts NAME=VALUE."""
    assignments: dict[str, str] = {}
    for text in pairs:
        name, equals, value = map(str.strip, text.partition("="))
        refuse(
            [
                (
                    not (equals and name),
                    f"{text!r} is not NAME=VALUE, such as solref='0.02 1' or 'Zeit=t (s)'",
                ),
                (name in assignments, f"{name} is given twice"),
            ]
        )
        assignments[name] = value
    return assignments


@main.command(
    "diagnose",
    params=[
        click.Argument(["parameters"], nargs=-1, metavar="[NAME=VALUE]..."),
        *_BODY,
        _ENGINE,
        _STEP,
        click.Option(["--one-body"], is_flag=True, help="The other body keeps its defaults."),
        _EXPLAIN,
        _JSON,
        click.Option(
            ["--other"], multiple=True, help="NAME=VALUE of the other body, if it differs."
        ),
    ],
)
def diagnose_command(
    parameters: tuple[str, ...],
    other: tuple[str, ...],
    engine: str,
    time_step: str | None,
    one_body: bool,
    explain: bool,
    as_json: bool,
    **bounce: Any,
) -> int:
    """Print what bounce the numbers of an engine give, why, and the least change for yours.

    Without numbers they are the engine's defaults, if it has some.
    """
    beside = _assigned(other) if other or one_body else None
    typed = _assigned(parameters)
    answer = diagnose(Bounce(**bounce), engine, typed, time_step, other=beside)
    _print(answer, as_json, explain)
    return _status(answer)


def _hear(path: Path, begin: str | None, end: str | None) -> tuple[Any, list[Path]]:
    """Write the impacts that are heard in a sound as labels and as a picture.

    Return the impacts, and the paths of both files. A file that a person may have changed is kept.
    """
    from bouncing_ball_contacts.sounds import listen, picture_of, sound_of

    typed = {"--from": begin, "--to": end}
    given = {option: in_si(option, text, "s") for option, text in typed.items() if text is not None}
    sound = sound_of(path, given.get("--from", 0.0), given.get("--to", float("inf")))
    heard = listen(sound)
    stem = "".join([path.stem, *(f"{option[1:]}-{value:g}" for option, value in given.items())])
    texts = {
        path.with_name(f"{stem}.txt"): heard.labels,
        path.with_name(f"{stem}.svg"): picture_of(sound, heard),
    }
    refuse(
        (
            file.exists() and file.read_text("utf-8", errors="replace") != text,
            f"{file.name} is there with other contents, such as labels that were corrected: fit "
            "these, or move the file",
        )
        for file, text in texts.items()
    )
    for file, text in texts.items():
        unfinished = file.with_name(f"{file.name}.unfinished")
        unfinished.write_text(text, "utf-8")
        unfinished.replace(file)
    return heard, list(texts)


@main.command(
    "fit",
    params=[
        click.Argument(["recording"], type=click.Path(allow_dash=True), nargs=-1, required=True),
        click.Option(
            ["--speed"], help="At which r is wanted; the middle of the impacts if not given."
        ),
        click.Option(["--resolution"], help="Standard deviation of a reading, such as '0.7 ms'."),
        click.Option(["--mass"], help="Of the ball, for the drag of the air and the engine."),
        click.Option(["--diameter"], help="Of the ball, for the drag of the air."),
        click.Option(
            ["--leave-out"], type=int, multiple=True, help="A line of the file; may be repeated."
        ),
        click.Option(["--ball"], help="One of several in the file."),
        click.Option(
            ["--columns"],
            multiple=True,
            help="What a column is, by its name or number, as 'Zeit=t (s)'; may be repeated.",
        ),
        click.Option(["--from", "begin"], help="Begin of the fall in a sound, such as '1.4 s'."),
        click.Option(["--to", "end"], help="End of the fall in a sound."),
        click.Option(["--engine"], help="For which the contact is written."),
        _STEP,
        click.Option(["--contact-time"], help="Measured, in place of that of the file."),
        _EXPLAIN,
        _JSON,
    ],
)
def fit_command(
    recording: tuple[str, ...],
    leave_out: tuple[int, ...],
    ball: str | None,
    columns: tuple[str, ...],
    begin: str | None,
    end: str | None,
    engine: str | None,
    time_step: str | None,
    explain: bool,
    as_json: bool,
    **of_fit: Any,
) -> None:
    """Read a recording of bounces: r over the speed, and an engine's contact.

    RECORDING is a file, - for what is piped, a published experiment, such as croquet, or numbers
    and their unit: successive heights such as 1.80 1.21 0.82 m, or times in s or ms. Of a sound,
    drop.wav, the impacts are heard, and written to drop.txt and drop.svg. Several files have an
    answer each.
    """
    from bouncing_ball_contacts.fits import fit
    from bouncing_ball_contacts.recordings import read
    from bouncing_ball_contacts.tables import typed_readings

    are_files = len(recording) > 1 and all(Path(path).is_file() for path in recording)
    is_typed = len(recording) > 1 and not are_files
    source = typed_readings(recording) if is_typed else recording[0]
    heard = None
    if not are_files and isinstance(source, str) and source.lower().endswith(".wav"):
        heard, (labels, picture) = _hear(Path(source), begin, end)
        if not as_json:
            click.echo(f"{source}: {heard}; written to {labels.name} and {picture.name}")
            click.echo("".join(f"! {note}\n" for note in heard.notes), nl=False)
        source = str(labels)
        of_fit["resolution"] = of_fit["resolution"] or f"{heard.resolution:.2g} s"
    elif (begin, end) != (None, None):
        raise Refused("--from and --to are of a sound in a file, such as drop.wav")
    sources = recording if are_files else ["/dev/stdin" if source == "-" else source]
    balls = {
        f"{path} {name}".strip() if are_files else name: one
        for path in sources
        for name, one in read(
            path, leave_out, ball, of_fit["resolution"], _assigned(columns)
        ).items()
    }
    fits = {name: fit(one, **of_fit) for name, one in balls.items()}
    if engine is None:
        if time_step is not None:
            raise Refused("--time-step needs an engine for which the contact is: --engine mujoco")
        _print(fits if len(fits) > 1 else fits[next(iter(fits))], as_json, explain, heard=heard)
        return
    if len(fits) > 1:
        raise Refused(f"there are {', '.join(fits)}: a contact is written for one, --ball")
    (fitted,) = fits.values()
    # The contact time of a recording is for springs.
    bounce = fitted.bounce(is_spring=rows_of(engine)[1] is None)
    _print(fitted, as_json, explain, design(bounce, engine, time_step), heard)


@main.command("engines", params=[click.Argument(["name"], required=False)])
def engines_command(name: str | None) -> None:
    """List the engines, or one, their parameters and the versions in which they were run."""
    named = rows_of(name) if name else ()
    of_springs = [row for row in ENGINES.values() if not name or row in named]
    of_number = [row for row in BY_NUMBER.values() if not name or row in named]
    if of_springs:
        click.echo("With a stiffness; the parameters are of both bodies alike:")
    for row in of_springs:
        both: dict[str, list[str]] = {}
        for parameter in dict.fromkeys((*row.names, *row.beside)):
            both.setdefault(row.rules[parameter].text, []).append(parameter)
        rules = [f"{', '.join(names)} {rule}" for rule, names in both.items() if rule != PAIR.text]
        click.echo(f"{row.name}: {row.meaning}")
        click.echo(f"    {ran_in(row)}")
        click.echo(f"    two bodies: {'; '.join(rules) or PAIR.text}")
    if of_number:
        click.echo("\nWith a restitution by number, which counts above the threshold:")
    for engine in of_number:
        click.echo(f"{engine.name}: {engine.parameter}, threshold {engine.limit(engine.threshold)}")
        click.echo(f"    {ran_in(engine)}")
        click.echo(f"    two bodies: {engine.pair.text}")


_MEANT = {
    "--diameter": "--radius",
    "--radius": "--diameter",
    "--dt": "--time-step",
    "--step": "--time-step",
    "--height": "--drop-height",
    "--velocity": "--speed",
    "--e": "--restitution",
    "--cor": "--restitution",
    "--depth": "--penetration",
}
"""Options by other names that people type."""


def run() -> None:
    """Run the command; a mistake is one line with the exit status 2."""
    try:
        sys.exit(main(standalone_mode=False))
    except (Refused, click.ClickException, OSError, ArithmeticError) as mistake:
        if isinstance(mistake, click.NoSuchOption) and mistake.option_name in _MEANT:
            meant = _MEANT[mistake.option_name]
            mistake = click.UsageError(
                f"No such option '{mistake.option_name}'. Did you mean '{meant}'?"
            )
        text = mistake.format_message() if isinstance(mistake, click.ClickException) else mistake
        is_far = isinstance(mistake, ArithmeticError)
        said = "a quantity is too large or too small to be computed: " if is_far else ""
        click.echo(f"bounce: {said}{' '.join(str(text).split())}", err=True)
        if isinstance(mistake, OSError):
            # At its end Python would write what a full disk left in the buffer, and fail again.
            sys.stdout = io.StringIO()
        sys.exit(2)
    except click.Abort:
        sys.exit(130)
