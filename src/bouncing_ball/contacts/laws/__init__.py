"""Contact laws, one short module for each."""

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.laws.elasto_backlash import ElastoBacklash
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley, LinearHuntCrossley
from bouncing_ball.contacts.laws.impedance import Impedance
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.tsuji import Tsuji
from bouncing_ball.contacts.spring_damper import SpringDamper

_HERTZ = (HuntCrossley, LinearHuntCrossley, Tsuji, KuwabaraKono)

LAWS: dict[str, type[ContactLaw]] = {
    law.name: law for law in (*_HERTZ, SpringDamper, ElastoBacklash, Impedance)
}
"""The laws by their names on the command line and in calls."""
