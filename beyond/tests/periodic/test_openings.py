"""Openings of long contacts, the orbits "grazing of a release", by equations of their own."""

import numpy as np
import pytest
from mpmath import mp, mpf
from openings_found import motions, opening, threshold
from sixty_digits import Exact

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches.curves import curve_through
from bouncing_ball_beyond.periodic.orbits.ends import Window
from bouncing_ball_beyond.periodic.orbits.special import Special


@pytest.mark.parametrize(
    ("r", "ratio", "excess", "flights", "multipliers"),
    [
        (0.65, 10.3, [12.5, 25.0], [2, 2], [0.041, 0.330]),
        (0.85, 20.0, [9.5, 20.0], [2, 3], [0.072, 0.245]),
        (0.85, 100.0, [9.5], [2], [0.0]),
    ],
)
def test_the_flights_and_multipliers_are_those_that_another_program_found(
    r, ratio, excess, flights, multipliers
):
    found = motions(r, ratio, excess)
    assert (found.periods == 1).all() and found.impacts.tolist() == flights
    np.testing.assert_allclose(np.exp(found.exponent), multipliers, atol=5e-4)


def missed(exact, amplitude, touch, *impacts):
    """The defects of an orbit whose last contact touches the level of the table at a time.

    The impacts are θ, v and the duration of each contact, one after another.
    """
    found = []
    for i in range(0, len(impacts), 3):
        phase, velocity, duration = impacts[i : i + 3]
        start = velocity, amplitude * mp.cos(phase), amplitude * mp.sin(phase)
        height, rate = exact.state(duration, *start)
        later = (*impacts[i + 3 :], impacts[0] + 2 * mp.pi, *impacts[1:])
        time = later[0] - phase - duration
        leaves = phase + duration
        fallen = mp.sin(leaves) + time * mp.cos(leaves) - mp.sin(leaves + time)
        slowed = mp.cos(leaves) - mp.cos(leaves + time)
        landing = rate * time - time**2 / 2 + amplitude * fallen
        found += [height, landing, rate - time + amplitude * slowed - later[1]]
    return [*found, *exact.state(touch, *start)]


def in_sixty_digits(r, ratio, k, amplitude):
    """Λ at opening k, from a simulated ball shortly below the Λ given.

    The equations are others than those of the package: the touch is a time with δ = δ′ = 0 there,
    and an unknown.
    """
    held = float(threshold(r, ratio))
    below = (1 - 1e-6) * (amplitude - held)
    seen = motions(r, ratio, ratio**2 * below)
    law = SpringDamper(ratio, damping_ratio(r))
    impacts = ContactModel(law).simulate(
        held + below, float(seen.end_phase), float(seen.end_velocity), k
    )
    rows = np.array([impacts.phase[0] + impacts.time, impacts.relative_velocity,
                     impacts.contact_duration])  # fmt: skip
    # The orbit starts with the impact after the longest contact.
    last = int(rows[2].argmax())
    rows[0, : last + 1] += 2 * np.pi
    rows = np.roll(rows, -1 - last, axis=1)
    time = np.linspace(0, 3 * np.pi / ratio, 10_001)
    heights = law.flow(time, 0.0, rows[1, -1], rows[0, -1], amplitude).displacement
    top = time[1:-1][(heights[1:-1] > heights[:-2]) & (heights[1:-1] >= heights[2:])][0]
    with mp.workdps(60):
        exact = Exact(law, 1)
        y = mp.matrix([float(x) for x in (amplitude, top, *rows.T.ravel())])
        step = mpf(10) ** -25
        for _ in range(7):
            here = mp.matrix(missed(exact, *y))
            matrix = mp.matrix(len(y), len(y))
            for column in range(len(y)):
                moved = y.copy()
                moved[column] += step
                matrix[:, column] = (mp.matrix(missed(exact, *moved)) - here) / step
            y -= mp.lu_solve(matrix, here)
        assert mp.norm(mp.matrix(missed(exact, *y))) < 1e-50
    return float(y[0])


@pytest.mark.parametrize(
    ("r", "ratio", "k"), [(0.3, 100.0, 2), (0.65, 31.6, 3), (0.95, 100.0, 2), (0.85, 20.0, 1)]
)
def test_an_opening_is_that_of_its_equations_in_sixty_digits(r, ratio, k):
    amplitude = opening(r, ratio, k).amplitude
    assert amplitude == pytest.approx(in_sixty_digits(r, ratio, k, amplitude), abs=1e-12)


@pytest.mark.parametrize("k", [1, 2])
def test_a_ball_has_one_flight_more_above_an_opening_and_the_multipliers_of_the_opening(k):
    r = 0.85
    ratio = 31.6
    found = opening(r, ratio, k)
    excess = ratio**2 * (found.amplitude - threshold(r, ratio))
    seen = motions(r, ratio, excess * np.array([0.999, 1 - 1e-9, 1.0001]))
    assert seen.periods.tolist() == [1, 1, 1] and seen.impacts.tolist() == [k, k, k + 1]
    largest = abs(found.multipliers()[0])
    assert np.exp(seen.exponent[1]) == pytest.approx(largest, rel=1e-3)
    # The power 3/2 of the new flight changes the multipliers by the root of the excess.
    assert np.abs(np.exp(seen.exponent) - largest).max() < 0.05


def test_openings_are_a_curve_along_the_frequency_ratio():
    start = opening(0.85, 20.0, 1)
    window = Window(18.0, 22.0)
    found = curve_through(
        start, Special.GRAZING_RELEASE, "amplitude", "frequency_ratio", across_window=window
    )
    values = found.problem.values(found.branch.points)
    order = values["frequency_ratio"].argsort()
    ratio = values["frequency_ratio"][order]
    amplitude = values["amplitude"][order]
    assert ratio[[0, -1]] == pytest.approx([18.0, 22.0], abs=1e-12)
    for k in (0, -1):
        exact = in_sixty_digits(0.85, float(ratio[k]), 1, float(amplitude[k]))
        assert amplitude[k] == pytest.approx(exact, abs=1e-10)
