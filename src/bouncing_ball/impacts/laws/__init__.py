"""Contact laws: what pushes the ball, one short module each."""

from bouncing_ball.impacts.laws.contact_law import ContactLaw
from bouncing_ball.impacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.impacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.impacts.laws.linear import Linear
from bouncing_ball.impacts.laws.tsuji import Tsuji

LAWS: dict[str, type[ContactLaw]] = {
    law.name: law for law in (HuntCrossley, Tsuji, KuwabaraKono, Linear)
}
"""The laws by the names that users call them by."""
