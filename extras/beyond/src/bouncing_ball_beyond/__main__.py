"""The command, as ``python -m bouncing_ball_beyond``."""

from bouncing_ball_beyond.cli import main

main()
