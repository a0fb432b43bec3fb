"""The options of the model of the impact, and the ball that they describe."""

from typing import Any

from bouncing_ball_beyond.cli.options import add_assignments, option
from bouncing_ball_beyond.inherited.cli import balls
from bouncing_ball_beyond.inherited.cli.balls import add_loss
from bouncing_ball_beyond.inherited.cli.options import Parser, add_choice, add_number, meanings
from bouncing_ball_beyond.inherited.datasets.arguments import FREQUENCY_RATIO, POSITIVE, ReleaseName
from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError
from bouncing_ball_beyond.inherited.models.spring_damper import LOSSES, spring_damper, the_loss
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.models.makers import corrected
from bouncing_ball_beyond.models.named_laws import LAWS, law_named
from bouncing_ball_beyond.periodic.law_balls import contact_law

MODELS = (*balls.MODELS, "corrected")


def add_ball(parser: Parser) -> None:
    """Add the options of :func:`ball_of`."""
    texts = meanings(spring_damper)
    add_number(parser, "frequency_ratio", FREQUENCY_RATIO, texts["frequency_ratio"])
    add_loss(parser)
    add_choice(parser, "release", Release, texts["release"])
    default = 'By default "spring-damper" if ϖ is given, and otherwise "restitution".'
    add_choice(parser, "model", MODELS, f'"restitution", "spring-damper" or "corrected". {default}')
    names = f"Laws: {', '.join(LAWS)}."
    text = f"Name of a contact law, in place of the linear spring and damper. {names}"
    parser.add_argument(option("law"), metavar="X", help=text)
    by_name = "Parameters of the contact law by name, such as stiffness=1000."
    add_assignments(parser, "parameters", by_name)
    texts = meanings(contact_law)
    add_number(parser, "duration", POSITIVE, texts["duration"])
    add_number(parser, "speed", POSITIVE, texts["speed"])


def ball_of(
    *,
    release: ReleaseName | None,
    model: str | None,
    law: str | None,
    parameters: dict[str, float] | None,
    duration: float | None,
    speed: float | None,
    **linear: float | None,
) -> Ball:
    """The ball that the options describe; ``linear`` are ϖ and the loss of an impact.

    Raises
    ------
    ModelError
        If an option is missing or contradicts another.
    """
    of_law = {"parameters": parameters, "duration": duration, "speed": speed}
    if law is not None:
        return _ball_of_law(law, model, linear, release, of_law)
    _refuse(of_law, "needs {law}")
    if model != "corrected":
        return a_ball(balls.ball_of(release=release, model=model, **linear))
    if linear["frequency_ratio"] is None:
        raise ParameterError("{model} corrected needs {frequency_ratio}")
    return corrected(a_ball(balls.ball_of(release=release, model="spring-damper", **linear)))


def _ball_of_law(
    law: str,
    model: str | None,
    linear: dict[str, float | None],
    release: ReleaseName | None,
    of_law: dict[str, Any],
) -> Ball:
    if any(linear[name] is not None for name in LOSSES):
        # At most one of them is allowed.
        the_loss(*(linear[name] for name in LOSSES))
    of_this_law = law_named(law).parameter_names()
    if model in ("restitution", "spring-damper"):
        instead = "give corrected, or no {model} for the law itself"
        raise ParameterError(f"{{model}} {model} has no {{law}}: {instead}")
    restitution = linear.pop("restitution")
    instead = "give {parameters}, or {restitution} and {duration}"
    _refuse(linear, f"is not allowed with {{law}} {law}: {instead}")
    by_name = of_law.pop("parameters") or {}
    named = {name.replace("-", "_"): value for name, value in by_name.items()}

    def shown(name: str) -> str:
        """The option for an argument of the call; the parameters of the law are set by name."""
        by_name = name in of_this_law or name in named
        return f"{option('parameters')} {name.replace('_', '-')}" if by_name else option(name)

    try:
        ball = contact_law(law, restitution=restitution, release=release, **of_law, **named)
    except ParameterError as error:
        raise ModelError(error.shown(shown)) from None
    return corrected(ball) if model == "corrected" else ball


def _refuse(options: dict[str, Any], why: str) -> None:
    """Raise :class:`ParameterError` for the first of these options that is given."""
    for name, value in options.items():
        if value is not None:
            raise ParameterError(f"{{{name}}} {why}")
