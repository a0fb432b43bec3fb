"""``python -m bouncing_ball_contacts``."""

from bouncing_ball_contacts.cli import run

run()
