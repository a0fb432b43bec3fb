"""The contact laws by their names: those of ``bouncing_ball_beyond``, and MuJoCo's impedance."""

from bouncing_ball_beyond.inherited.contacts.engines.impedance import Impedance
from bouncing_ball_beyond.models import named_laws as named

LAWS = named.LAWS | named.by_name(Impedance)
"""The laws by their names on the command line and in calls."""
