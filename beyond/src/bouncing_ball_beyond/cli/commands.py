"""The subcommands that beyond adds to ``bouncing-ball``: an entry point of its package."""

from bouncing_ball_beyond.cli.options import NAMES
from bouncing_ball_beyond.inherited.cli.commands import Command, Program

# What makes a single orbit cheaper.
_SIMPLER = "a spring and a damper in place of a law"


def _orbit() -> Program:
    from bouncing_ball_beyond.cli import periodic
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(periodic.orbit_options, periodic.orbit, lines)


def _limits() -> Program:
    from bouncing_ball_beyond.cli import periodic
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(periodic.limits_options, periodic.limits, lines)


def _error_law() -> Program:
    from bouncing_ball_beyond.cli import periodic
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(periodic.error_law_options, periodic.error_law, lines)


def _follow() -> Program:
    from bouncing_ball_beyond.cli import followed
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(followed.follow_options, followed.follow, lines)


def _curve() -> Program:
    from bouncing_ball_beyond.cli import followed
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(followed.curve_options, followed.curve, lines)


def _simulate() -> Program:
    from bouncing_ball_beyond.cli import simulate
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(simulate.add_options, simulate.simulate, lines)


def _motion() -> Program:
    from bouncing_ball_beyond.cli import motion
    from bouncing_ball_beyond.inherited.cli.output import lines

    return Program(motion.motion_options, motion.motion, lines)


def _diagram() -> Program:
    from bouncing_ball_beyond.cli import motion

    return Program(motion.diagram_options, motion.diagram, motion.diagram_lines)


COMMANDS = {
    "law-orbit": Command(
        purpose="the n-T orbit on a contact of any law or in the corrected model",
        text=(
            "An n-T orbit is a periodic motion. It is stable if balls that start near it approach "
            "it, and admissible if no other impact or release occurs within a period."
        ),
        examples=(
            "law-orbit --amplitude 1 --law tsuji --restitution 0.85 --duration 0.1",
            "law-orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10 --model corrected",
        ),
        program=_orbit,
        names=NAMES,
        cheaper=_SIMPLER,
    ),
    "law-limits": Command(
        purpose="saddle-node and period doubling, for any law or in the corrected model",
        text=(
            "An n-T orbit exists above the saddle-node and is stable up to the period doubling, "
            "beyond which the motion repeats only after 2n periods of the table."
        ),
        examples=(
            "law-limits --n 2 --damping-ratio 0.05 --frequency-ratio 10 --model corrected",
            "law-limits --law tsuji --restitution 0.85 --duration 0.1",
        ),
        program=_limits,
        names=NAMES,
        cheaper=_SIMPLER,
    ),
    "error-law": Command(
        purpose="the ϖ that the restitution model needs, by the error law",
        text=(
            "The ϖ from which on each error of the restitution model is within the tolerance, by "
            "the error law, which holds from the saddle-node to the period doubling. An error is "
            "the difference of the contact from the restitution model, relative to the restitution "
            "model (Eqs. 37-38). Far above the saddle-node it is K/ϖ to first order, and the "
            "answer has K too. These are estimates and no bounds."
        ),
        examples=("error-law --amplitude 1 --restitution 0.65",),
        program=_error_law,
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
        names=NAMES,
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
        names=NAMES,
        cheaper="narrower ranges or fewer points",
    ),
    "law-simulate": Command(
        purpose="a sequence of impacts, for any law or in the corrected model",
        text=(
            "Each line of the answer is an impact. The list ends early if the ball stays on the "
            "table."
        ),
        examples=(
            "law-simulate --amplitude 1 --law tsuji --restitution 0.85 --duration 0.1 --impacts 5",
        ),
        program=_simulate,
        names=NAMES,
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
        names=NAMES,
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
        names=NAMES,
        cheaper="fewer amplitudes, fewer starts or fewer impacts",
    ),
}
"""The subcommands by name."""
