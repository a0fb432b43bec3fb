"""The command ``bounce``: design, diagnose, fit and engines."""

import dataclasses
import json
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from bouncing_ball_contacts.designs import TOLERANCE, Bounce, Design, design
from bouncing_ball_contacts.engines import ENGINES, engine_named
from bouncing_ball_contacts.scripts import drop_script
from bouncing_ball_contacts.units import (
    STANDARD_GRAVITY,
    Refused,
    in_si,
    positive,
    show,
    step_in_si,
)

if TYPE_CHECKING:
    from bouncing_ball_contacts.rebounds import Rebound

_DENSITY = click.Option(["--density"], help="In place of the size; also steel, rubber, wood, …")
_BODY = [
    click.Option(["--mass"], help="Mass of the body, such as '50 g'."),
    click.Option(["--restitution"], help="√(h′/h) that is wanted, 0 to 1."),
    click.Option(["--drop-height"], help="Height of the drop; 1 m if no speed is given."),
    click.Option(["--speed"], help="Impact speed, in place of the height."),
    click.Option(["--radius"], help="Radius, or half the height of a box."),
    _DENSITY,
    click.Option(
        ["--points"], type=int, default=1, help="Contact points: 4 for the face of a box."
    ),
    click.Option(["--other-mass"], help="Mass of a second free body; needs the speed of approach."),
    click.Option(
        ["--gravity"],
        default=str(STANDARD_GRAVITY),
        help=f"{STANDARD_GRAVITY} m/s² if not given; 0 with a speed.",
    ),
]
_FRICTION = click.Option(["--friction"], help="Coefficient of friction.")
_CONTACT = [
    click.Option(["--penetration"], help="Depth that must not be exceeded."),
    click.Option(["--stiffness"], help="Of the contact, in place of the penetration."),
    click.Option(["--contact-time"], help="Of a contact without damping, in place of these."),
    _FRICTION,
    click.Option(["--tolerance"], help="Largest deviation of r; 0.02 if not given."),
    click.Option(["--pick"], help="Row that is written, such as 'what you want' or impulse."),
    click.Option(["--script"], type=click.Path(dir_okay=False), help="File for a script to run."),
]
_STEP = click.Option(["--time-step"], help="Of the engine, such as '2 ms', 1/240 or '240 Hz'.")


def _engines(_: click.Context, __: click.Parameter, typed: str) -> list[str]:
    from bouncing_ball_contacts.rebounds import BY_NUMBER

    return [name for name in [*ENGINES, *BY_NUMBER] if name.startswith(typed)]


_ENGINE = click.Option(
    ["--engine"], default="generic", help="One of 'bounce engines'.", shell_complete=_engines
)
_ONE_BODY = click.Option(["--one-body"], is_flag=True, help="The other body keeps its defaults.")
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


def _values(found: Any) -> dict[str, Any]:
    from bouncing_ball_contacts.rebounds import Rebound

    if isinstance(found, dict):
        return {name: _values(each) for name, each in found.items()}
    values = dataclasses.asdict(found)
    if isinstance(found, Rebound):
        values |= {"snippet": found.snippet, "notes": found.notes}
    if isinstance(found, Design):
        values |= {"parameters": found.parameters, "snippet": found.snippet}
    values.pop("source", None)
    return values


def _print(found: Any, as_json: bool, written: "Design | Rebound | None" = None) -> None:
    if not as_json:
        if isinstance(found, dict):
            found = "\n\n".join(f"{name}\n{each}" for name, each in found.items())
        click.echo("\n\n".join(str(each) for each in (found, written) if each is not None))
        return
    values = _values(found)
    if written is not None:
        values["design"] = _values(written)
    # Arrays become lists, and numbers that JSON does not have, NaN and Infinity, become null.
    text = json.dumps(values, default=lambda array: array.tolist())
    plain = json.loads(text, parse_constant=lambda _: None)
    click.echo(json.dumps(plain, indent=1, ensure_ascii=False))


def _write_script(found: Design, path: str | None) -> None:
    if path is None:
        return
    text = drop_script(found)
    imports = re.findall(r"^(?:import|from) .*", text, re.MULTILINE)
    if Path(path).stem in re.findall(r"\w+", " ".join([found.engine, *imports])):
        raise Refused(f"a script named {Path(path).name} hides the module of the engine: rename it")
    if Path(path).exists():
        raise Refused(f"{path} exists, and is not overwritten")
    Path(path).write_text(text, "utf-8")


@main.command("design", params=[*_BODY, *_CONTACT, _ENGINE, _STEP, _ONE_BODY, _JSON])
def design_command(
    engine: str,
    time_step: str | None,
    tolerance: str | None,
    one_body: bool,
    pick: str | None,
    script: str | None,
    as_json: bool,
    **bounce: Any,
) -> None:
    """Write the contact of an engine, or its restitution number, for the bounce that you want."""
    # Other names than those of springs may be known where the restitution is a number.
    if engine not in ENGINES:
        from bouncing_ball_contacts.rebounds import engine_by_number, falling, number_for

        row = engine_by_number(engine)
        if row is not None and row.name not in ENGINES:
            options = {"--one-body": one_body, "--pick": pick, "--script": script}
            for option, value in options.items():
                if value:
                    raise Refused(f"{option} has no place where the restitution is a number")
            _print(number_for(falling(**bounce), row, time_step), as_json)
            return
        engine = row.name if row else engine
    found = design(
        Bounce(**bounce),
        engine_named(engine),
        time_step,
        tolerance=tolerance or TOLERANCE,
        one_body=one_body,
        pick=pick,
    )
    _write_script(found, script)
    _print(found, as_json)


def _assigned(pairs: tuple[str, ...]) -> dict[str, str]:
    """Return the values of texts NAME=VALUE."""
    found: dict[str, str] = {}
    for text in pairs:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise Refused(f"{text!r} is not NAME=VALUE, such as solref='0.02 1' or kn=1e5")
        if name.strip() in found:
            raise Refused(f"{name.strip()} is given twice")
        found[name.strip()] = value.strip()
    return found


def _own_of_ode(spring: dict[str, str], time_step: str | None) -> dict[str, Any]:
    """Return ODE's numbers of a spring and a damper: ERP = h k/(h k + c), CFM = 1/(h k + c)."""
    if time_step is None:
        raise Refused("the time step is missing: ODE's soft_erp and soft_cfm depend on it")
    pull = step_in_si(time_step) * positive("kp", spring["kp"], "N/m")
    both = pull + in_si("kd", spring["kd"], "N s/m")
    return {"soft_erp": pull / both, "soft_cfm": 1 / both}


@main.command(
    "diagnose",
    params=[
        click.Argument(["parameters"], nargs=-1, metavar="[NAME=VALUE]..."),
        *_BODY,
        _FRICTION,
        _ENGINE,
        _STEP,
        _ONE_BODY,
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
    as_json: bool,
    **bounce: Any,
) -> None:
    """Say what bounce the numbers of an engine give, why, and the least change for yours.

    Without numbers they are the engine's defaults, if it has some.
    """
    from bouncing_ball_contacts.diagnosis import diagnose
    from bouncing_ball_contacts.rebounds import engine_by_number, falling, rebound

    typed = _assigned(parameters)
    if engine.lower() == "ode" and typed.keys() == {"kp", "kd"}:
        typed = _own_of_ode(typed, time_step)
    beside = _assigned(other) if other or one_body else None
    row = engine_by_number(engine)
    names = {name.lower() for name in typed}
    if row is not None and row.springs and (not names or names - row.names.keys()):
        engine = row.springs
        row = None
    if row is not None:
        _print(rebound(falling(**bounce), row, typed, time_step, beside), as_json)
        return
    known = engine_named(engine)
    # Where the rebound is by a number, r does not depend on the mass.
    needs_no_mass = known.number in typed and not typed.keys() & set(known.names)
    body = falling(**bounce) if needs_no_mass and not bounce["mass"] else Bounce(**bounce)
    _print(diagnose(body, known, typed, time_step, other=beside), as_json)


def _lines(text: str | None) -> tuple[int, ...]:
    """Return the numbers of a text such as '4,7'."""
    try:
        return tuple(int(part) for part in (text or "").replace(",", " ").split())
    except ValueError:
        raise Refused(f"--leave-out {text!r}: give numbers of lines, such as 4,7") from None


@main.command(
    "fit",
    params=[
        click.Argument(["recording"], type=click.Path(allow_dash=True)),
        click.Option(
            ["--speed"], help="At which r is wanted; the middle of the impacts if not given."
        ),
        click.Option(["--resolution"], help="Standard deviation of a reading, such as '0.7 ms'."),
        click.Option(["--mass"], help="Of the ball, for the drag of the air and the engine."),
        click.Option(["--diameter"], help="Of the ball, for the drag of the air."),
        click.Option(["--leave-out"], help="Lines of the file, such as 4,7."),
        click.Option(["--ball"], help="One of several in the file."),
        click.Option(["--read-at"], help="Of rebound heights, off the ball: bottom or top."),
        click.Option(["--laws"], is_flag=True, help="Judge contact laws by r over the speed."),
        click.Option(
            ["--engine"], help="For which the contact is written.", shell_complete=_engines
        ),
        _STEP,
        _DENSITY,
        *_CONTACT,
        _JSON,
    ],
)
def fit_command(
    recording: str,
    leave_out: str | None,
    ball: str | None,
    engine: str | None,
    time_step: str | None,
    tolerance: str | None,
    pick: str | None,
    script: str | None,
    density: str | None,
    penetration: str | None,
    stiffness: str | None,
    friction: str | None,
    as_json: bool,
    **of_fit: Any,
) -> None:
    """Read a recording of bounces: r over the speed, the laws it allows, and an engine's contact.

    RECORDING is a file, - for what is piped, or a published experiment, such as croquet.
    """
    from bouncing_ball_contacts.fits import fit
    from bouncing_ball_contacts.rebounds import engine_by_number, falling, number_for
    from bouncing_ball_contacts.recordings import read

    balls = read("/dev/stdin" if recording == "-" else recording, _lines(leave_out), ball)
    fits = {name: fit(one, **of_fit) for name, one in balls.items()}
    if len(fits) > 1:
        if engine is not None:
            raise Refused(f"the file has {', '.join(fits)}: a contact is written for one, --ball")
        _print(fits, as_json)
        return
    found = next(iter(fits.values()))
    contact = {
        "density": density,
        "penetration": penetration,
        "stiffness": stiffness,
        "friction": friction,
    }
    of_design = {"time_step": time_step, "tolerance": tolerance, "pick": pick, "script": script}
    given = [name for name, value in (contact | of_design).items() if value is not None]
    written: Design | Rebound | None = None
    row = None if engine is None else engine_by_number(engine)
    if row is not None and row.name not in ENGINES:
        of_ball = {"mass": found.mass, "radius": found.diameter and found.diameter / 2}
        wanted = {"restitution": found.restitution, "speed": found.speed}
        written = number_for(falling(**of_ball, **wanted, **contact), row, time_step)
    elif engine is not None:
        bounce = found.bounce(**contact)
        written = design(bounce, engine, time_step, tolerance=tolerance or TOLERANCE, pick=pick)
        _write_script(written, script)
    elif given:
        option = given[0].replace("_", "-")
        raise Refused(f"--{option} needs an engine for which the contact is: --engine mujoco")
    _print(found, as_json, written)


@main.command("engines")
def engines_command() -> None:
    """List the engines, their parameters and the versions in which they were run."""
    from bouncing_ball_contacts.rebounds import BY_NUMBER

    click.echo("With a stiffness; the parameters are of both bodies alike:")
    for row in ENGINES.values():
        combined = ", ".join(dict.fromkeys(row.rules[name].text for name in row.names))
        click.echo(f"{row.name}: {row.meaning}")
        click.echo(f"    {row.scheme.text}; two bodies: {combined}; run in {row.ran}")
    click.echo("\nWith a restitution by number, which counts from the threshold on:")
    for each in BY_NUMBER.values():
        click.echo(f"{each.name}: {each.parameter}, threshold {show(each.threshold, 'm/s')}")
        click.echo(f"    two bodies: {each.pair.text}; run in {each.ran}")


def run() -> None:
    """Run the command; a mistake is one line, and the exit status is 2."""
    try:
        sys.exit(main(standalone_mode=False))
    except (Refused, click.ClickException, OSError) as mistake:
        text = mistake.format_message() if isinstance(mistake, click.ClickException) else mistake
        click.echo(f"bounce: {' '.join(str(text).split())}", err=True)
        sys.exit(2)
    except ArithmeticError as too_far:
        click.echo(
            f"bounce: a quantity is too large or too small to be computed: {too_far}", err=True
        )
        sys.exit(2)
    except click.Abort:
        sys.exit(130)
