"""``bouncing-ball certify``: both limits of a family with a proof."""

from bouncing_ball.cli.options import Parser, add_number, meanings
from bouncing_ball.datasets.arguments import FAMILY, FREQUENCY_RATIO, RESTITUTION
from bouncing_ball.errors import count
from bouncing_ball.models.spring_damper import spring_damper
from bouncing_ball_beyond.cli.periodic import Answer
from bouncing_ball_beyond.periodic import orbits_of_ball

_DIGITS = count(100, low=10)
_DEFAULT = 30


def add_options(parser: Parser) -> None:
    """Add the options of :func:`certify`."""
    texts = meanings(spring_damper)
    add_number(parser, "n", FAMILY, meanings(orbits_of_ball.limits)["n"], default=1)
    add_number(parser, "restitution", RESTITUTION, texts["restitution"], required=True)
    add_number(parser, "frequency_ratio", FREQUENCY_RATIO, texts["frequency_ratio"], required=True)
    digits = "Number of decimal digits of Λ, with a bound of the error."
    add_number(parser, "digits", _DIGITS, digits, default=_DEFAULT)


def certify(*, n: int, restitution: float, frequency_ratio: float, digits: int) -> Answer:
    """Λ of both limits as decimal texts with bounds of their errors, and what was proved.

    Raises
    ------
    NoOrbitError
        If the branch has no saddle-node or no period doubling.
    ModelError
        If something cannot be certified; the message gives the reason.
    """
    # Imported here, because the library of balls may be missing.
    from bouncing_ball_beyond.proofs import certificates
    from bouncing_ball_beyond.proofs.balls import exactly
    from bouncing_ball_beyond.proofs.problem import RationalProblem

    problem = RationalProblem(exactly(frequency_ratio), exactly(restitution), n)
    proofs = {
        "saddle_node": certificates.saddle_node(problem, digits),
        "period_doubling": certificates.period_doubling(problem, digits),
    }
    answer = {}
    for name, found in proofs.items():
        amplitude, radius = found.texts(digits)
        proved = [str(each) for each in found.proved]
        answer[name] = {"amplitude": amplitude, "radius": radius, "proved": proved}
    return answer


def certify_lines(answer: Answer) -> list[str]:
    """A line for each number, and one for what is proved of it."""
    rows = []
    for limit, found in answer.items():
        name = limit.replace("_", " ")
        shown = found | {"proved": "; ".join(found["proved"])}
        rows += [f"{f'{name}, {key}':<28} {value}" for key, value in shown.items()]
    return rows
