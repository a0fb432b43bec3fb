"""A user's own contact law, with nothing but its force and its release: f = K p + H p³ + C p′."""

from dataclasses import dataclass
from typing import ClassVar

from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw


@dataclass(frozen=True, repr=False)
class HardeningSpring(ContactLaw):
    """A spring whose stiffness K + 3H p² grows with the depth, and a damper."""

    stiffness: float
    hardening: float
    damping: float

    name: ClassVar[str] = "hardening-spring"
    root: ClassVar[int] = 1
    release = Release.DISPLACEMENT

    def force(self, penetration, rate):
        """K p + H p³ + C p′."""
        elastic = self.stiffness * penetration + self.hardening * penetration**3
        return elastic + self.damping * rate


LAW = HardeningSpring(100.0, 1e6, 0.5)
