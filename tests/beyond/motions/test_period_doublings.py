"""Cascades: the orbits that double, Feigenbaum's ratio, and how a contact shifts the cascade."""

import numpy as np
import pytest
from mpmath import mp, mpf

from bouncing_ball.beyond.motions.period_doublings import FEIGENBAUM, cascade
from bouncing_ball.errors import ModelError
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import n_t

R = 0.5
RATIOS = np.array([20.0, 40.0, 80.0, 160.0])
CONTACT = SpringDamper.from_restitution(R, RATIOS)
MODELS = [ContactModel(CONTACT), CorrectedModel.of_contact(CONTACT)]


@pytest.fixture(scope="module")
def restitution():
    return cascade(n_t.period_doubling(RestitutionModel(R), 1), 6)


@pytest.fixture(scope="module", params=MODELS, ids=lambda model: model.name)
def model(request):
    return request.param


@pytest.fixture(scope="module")
def found(model):
    return cascade(n_t.period_doubling(model, 1), 4)


def test_the_ratios_tend_to_feigenbaums(restitution):
    """By the theory their distance falls by a constant factor, which is about -0.12."""
    away = restitution.ratios() - FEIGENBAUM
    assert np.all(np.abs(away[1:]) < np.abs(away[:-1])) and abs(away[-1]) < 0.006


def turned(phase, velocity, lam, flights):
    """φ, δ′ and the time after a turn of the restitution model, in 60 digits; the flight times are
    known in double precision.
    """
    time = mpf(0)
    for flight in flights:
        up = lam * mp.cos(phase) - R * velocity
        s = mpf(float(flight))
        for _ in range(3):
            gap = up * s - s * s / 2 - lam * (mp.sin(phase + s) - mp.sin(phase))
            s -= gap / (up - s - lam * mp.cos(phase + s))
        phase += s
        velocity = up - s - lam * mp.cos(phase)
        time += s
    return phase, velocity, time


def defects(y, flights):
    """The three equations of a doubling in 60 digits, with M by differences."""
    small = mpf(10) ** -20
    phase, velocity, lam = y
    matrix = mp.matrix(2, 2)
    for k, (turn, faster) in enumerate([(small, 0), (0, small)]):
        later = turned(phase + turn, velocity + faster, lam, flights)
        sooner = turned(phase - turn, velocity - faster, lam, flights)
        for row in (0, 1):
            matrix[row, k] = (later[row] - sooner[row]) / (2 * small)
    _, after, time = turned(phase, velocity, lam, flights)
    doubling = 1 + matrix[0, 0] + matrix[1, 1] + mp.det(matrix)
    return mp.matrix([time - 2 * mp.pi * len(flights), after - velocity, doubling])


@pytest.mark.parametrize("k", [1, 4])
def test_doublings_are_right_to_the_last_digits(restitution, k):
    """In 60 digits one step of Newton's method is left; the ratio of distances, which are 1e-3 of Λ
    and less, needs all digits of Λ.
    """
    phase = float(restitution.phase[k])
    relative = float(restitution.velocity[k])
    amplitude = float(restitution.amplitude[k])
    start = relative + amplitude * np.cos(phase)
    impacts = RestitutionModel(R).simulate(amplitude, phase, start, 2**k + 1)
    flights = np.diff(impacts.time)
    with mp.workdps(60):
        y = mp.matrix([phase, relative, amplitude])
        step = mpf(10) ** -12
        matrix = mp.matrix(3, 3)
        for column in range(3):
            moved = mp.matrix(3, 1)
            moved[column] = step
            change = defects(y + moved, flights) - defects(y - moved, flights)
            matrix[:, column] = change / (2 * step)
        missed = mp.lu_solve(matrix, defects(y, flights))
        # A unit in the last place of Λ for each of its 2ᵏ flights, and a few more; with the time of
        # the turn in place of the phase it was 1e-14.
        assert abs(missed[2]) < (4 + 2**k) * np.finfo(float).eps


def test_a_ball_at_a_doubling_returns_after_2_to_the_k_impacts_in_the_simulation(restitution):
    for k, (lam, phase, relative) in enumerate(zip(*restitution, strict=True)):
        impacts = RestitutionModel(R).simulate(lam, phase, relative + lam * np.cos(phase), 2**k + 1)
        # Multipliers of a turn are of order one, but those of its parts are not.
        assert impacts.time[-1] == pytest.approx(2 * np.pi * 2**k, abs=1e-9)
        assert impacts.relative_velocity[-1] == pytest.approx(relative, abs=1e-9)


def test_the_period_of_what_attracts_doubles_there(model, found):
    """Found without the orbit's equations: by where balls end beside each doubling."""
    sides = np.array([[[-0.2]], [[0.2]]])
    lam = found.amplitude[:-1] + sides * np.diff(found.amplitude, axis=0)
    phase = found.phase[:-1]
    relative = found.velocity[:-1]
    motion = final_motions(model, lam, phase, relative + lam * np.cos(phase), impacts=5000)
    expected = 2 ** (np.arange(3)[:, np.newaxis] + np.arange(2)[:, np.newaxis, np.newaxis])
    np.testing.assert_array_equal(motion.impacts, np.broadcast_to(expected, lam.shape))


def test_a_contact_shifts_the_cascade_by_the_first_order_and_corrected_by_the_second(
    found, model, restitution
):
    """Halving 1/ϖ halves the distance from the limit, and quarters it for what is left."""
    if isinstance(model, CorrectedModel):
        exact = cascade(n_t.period_doubling(ContactModel(CONTACT), 1), 4)
        error = found.amplitude / exact.amplitude - 1
        order = 2
    else:
        error = found.amplitude / restitution.amplitude[:4, np.newaxis] - 1
        order = 1
    assert np.all(error != 0)
    falls = np.log2(error[:, :-1] / error[:, 1:])
    # The next order adds C/ϖ to the relative change of the error: it halves as well.
    away = falls - order
    assert np.all(np.abs(away[:, 1:]) < 0.6 * np.abs(away[:, :-1])) and np.max(np.abs(away)) < 0.25


def test_a_cascade_of_no_doublings_or_too_many_is_refused(refusal):
    with refusal(ModelError, "number of period doublings = 9", "from 1 to 8"):
        cascade(n_t.period_doubling(RestitutionModel(R), 1), 9)
