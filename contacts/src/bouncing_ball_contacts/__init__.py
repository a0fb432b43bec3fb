"""What to write into a physics engine for a bounce, and what bounce a recording shows."""

from bouncing_ball_contacts.designs import Bounce, Design, design
from bouncing_ball_contacts.diagnosis import Diagnosis, diagnose
from bouncing_ball_contacts.engines import ENGINES
from bouncing_ball_contacts.units import Refused

__all__ = ["ENGINES", "Bounce", "Design", "Diagnosis", "Refused", "design", "diagnose"]
