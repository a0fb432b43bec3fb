"""Entry point of ``bouncing-ball``, which imports almost nothing before Ctrl-C is taken care of."""

from bouncing_ball_beyond.inherited.cli.interrupt import importing

INTERRUPTED = 130
"""The exit status after Ctrl-C: 128 and the number of the signal."""


def main(arguments: list[str] | None = None) -> None:
    """Answer one subcommand; exit with 1 if there is no answer, with 2 on a mistake, and with 130
    if it is interrupted.

    For ``diff`` see :mod:`bouncing_ball_beyond.inherited.cli.diff`.
    """
    with importing():
        import gc
        import os
        import sys

        # The matrices are small, so that threads for them would only cost their start.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        # What a command imports stays: looking for garbage among it would take a tenth of its time.
        gc.set_threshold(100_000)

        from bouncing_ball_beyond.inherited.cli.answers import answer
        from bouncing_ball_beyond.inherited.cli.output import fail
    try:
        answer(sys.argv[1:] if arguments is None else arguments)
    except KeyboardInterrupt:
        fail("interrupted", status=INTERRUPTED)
