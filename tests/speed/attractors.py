"""What a label costs: nanoseconds of a processor per impact, and seconds for 10⁵ labels.

Each model is followed with labels, tangents and chattering, over random r, Λ and starts, and
over the simulation alone. Not part of the test suite, as a noisy machine would fail it:

    OMP_NUM_THREADS=1 python tests/speed/attractors.py [balls] [impacts]
"""

import sys
import time

import numpy as np

from bouncing_ball.beyond.corrected.orbits import CorrectedModel
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel


def main(balls: int, impacts: int) -> None:
    rng = np.random.default_rng(0)
    r = rng.uniform(0.1, 0.95, balls)
    lam = rng.uniform(0.9, 5, balls)
    phase = rng.uniform(-np.pi, np.pi, balls)
    velocity = -lam - rng.uniform(0, 12, balls)
    contact = SpringDamper.from_restitution(r, 100.0)
    models = {
        "restitution": RestitutionModel(r),
        "spring-damper": SpringDamperModel(contact),
        "corrected": CorrectedModel.of_contact(contact),
    }
    for name, model in models.items():
        start = time.process_time()
        found = final_motions(model, lam, phase, velocity, impacts=impacts)
        spent = time.process_time() - start
        followed = found.followed.sum()
        print(
            f"{name}: {spent / followed * 1e9:.0f} ns per impact, "
            f"{spent / balls * 1e5:.0f} s for 10⁵ labels of {followed / balls:.0f} impacts"
        )


if __name__ == "__main__":
    given = [int(x) for x in sys.argv[1:]]
    main(*(given + [100_000, 1000][len(given) :]))
