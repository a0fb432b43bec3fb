"""How stiff a contact must be for the restitution model to be right."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.configuration.study import typed
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.permanent_contact import permanent_contact_threshold
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.spring_damper_limits import orbit_at
from bouncing_ball.studies.error_thresholds import (
    error_thresholds,
    height_error,
    permanent_contact_error,
)

PARAMETERS = {
    "n": 1,
    "restitution": 0.65,
    "amplitude": 1.0,
    "quantities": [str(q) for q in Quantity],
    "tolerances": [0.1, 0.01],
    "frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 81},
}


def integrated_height(omega, r, lam):
    """Greatest height of the 1-T orbit, by numerical integration and fsolve."""
    zeta = -np.log(r) / np.hypot(np.pi, np.log(r))

    def cycle(state):
        phase, u = state

        def field(t, y):  # y = (ϖδ, δ′)
            push = -1 + lam * np.sin(t + phase)
            return [omega * y[1], push - 2 * zeta * omega * y[1] - omega * y[0]]

        def back(t, y):
            return y[0]

        back.terminal, back.direction = True, 1
        run = solve_ivp(
            field,
            (0, 4 * np.pi / omega),
            [-1e-300, u],
            method="DOP853",
            events=back,
            rtol=1e-13,
            atol=1e-14,
        )
        t, (_, v) = run.t_events[0][0], run.y_events[0][0]
        z, zdot = lam * np.sin(phase + t), v + lam * np.cos(phase + t)
        flight = brentq(
            lambda s: z + zdot * s - s * s / 2 - lam * np.sin(phase + t + s), 5.0, 7.5, xtol=1e-14
        )
        end = phase + t + flight
        return end, zdot - flight - lam * np.cos(end), z + zdot**2 / 2

    def closing(state):
        end, u, _ = cycle(state)
        return [end - state[0] - 2 * np.pi, u - state[1]]

    phase = np.arccos(np.pi * (1 - r) / (1 + r) / lam)
    start = [phase, -np.pi - lam * np.cos(phase)]
    found, _, status, message = fsolve(closing, start, xtol=1e-12, full_output=True)
    # Without this the reference itself would be unchecked; fsolve may stop for
    # lack of progress at the integrator's rounding.
    assert np.abs(closing(found)).max() < 1e-10, (status, message)
    return cycle(found)[2]


def test_one_percent_height_of_the_paper(described):
    # Eq. 37, Figure 14: n = 1, r = 0.65, Λ = 1; printed "≈ 82".
    data = described(
        typed(height_error)(
            {
                "n": 1,
                "restitution": 0.65,
                "amplitude": 1.0,
                "frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 31},
                "tolerance": 0.01,
            },
            "displacement",
        )
    )
    ratio = float(data.error_threshold.squeeze())
    assert ratio == pytest.approx(82.177, abs=5e-4)
    assert data.threshold_status.values.tolist() == [[str(ThresholdStatus.FOUND)]]
    # The same by integration: the error at that ϖ is one percent. It changes by
    # 1e-4 per unit of ϖ, and the heights are good to 1e-10.
    reference = np.pi**2 / 2 + np.sqrt(1 - (np.pi * 0.35 / 1.65) ** 2)
    error = 1 - integrated_height(ratio, 0.65, 1.0) / reference
    assert error == pytest.approx(0.01, abs=1e-9)
    assert float(data.restitution_max_height) == pytest.approx(reference, rel=1e-14)
    expected = np.abs(data.max_height / data.restitution_max_height - 1).values
    assert data.relative_error.sel(quantity="max_height").values == pytest.approx(
        expected, rel=1e-12
    )


def test_one_percent_permanent_contact(described):
    # Eq. 38, Figure 16; printed "≈ 6".
    data = described(
        typed(permanent_contact_error)(
            {
                "restitution": 0.65,
                "frequency_ratio": {"min": 0.5, "max": 100.0, "samples": 101},
                "tolerance": 0.01,
            },
            "displacement",
        )
    )
    ratio = float(data.error_threshold.squeeze())
    assert ratio == pytest.approx(9.81177, abs=5e-6)
    threshold = permanent_contact_threshold(ratio, damping_ratio(0.65))
    assert threshold == pytest.approx(0.99, rel=1e-12)
    assert data.threshold_amplitude.dims == ("frequency_ratio",)


def test_all_quantities(described):
    data = described(typed(error_thresholds)(PARAMETERS, "displacement"))
    assert data.relative_error.dims == ("quantity", "frequency_ratio")
    assert data.error_threshold.dims == ("quantity", "tolerance")
    assert data["quantity"].values.tolist() == PARAMETERS["quantities"]
    ratios = data.frequency_ratio.values
    for name, k in np.ndindex(len(Quantity), 2):
        tolerance, row = PARAMETERS["tolerances"][k], data.relative_error[name].values
        ratio, status = (float(data.error_threshold[name, k]), data.threshold_status[name, k])
        if status == ThresholdStatus.FOUND:
            assert np.all(row[ratios > ratio] <= tolerance) and row[ratios < ratio][-1] > tolerance
        else:
            assert status == ThresholdStatus.ALWAYS_WITHIN and np.isnan(ratio)
            assert np.all(row <= tolerance)


def test_force_release():
    paper = typed(error_thresholds)(PARAMETERS, "displacement")
    dry = typed(error_thresholds)(PARAMETERS, "force")
    # A contact released at zero force keeps more velocity than Eq. 16 says: r_a
    # never comes within 1 % of r.
    at = {"quantity": "apparent_restitution"}
    assert str(dry.threshold_status.sel(at)[1].values) == ThresholdStatus.NEVER_WITHIN
    assert str(paper.threshold_status.sel(at)[1].values) == ThresholdStatus.FOUND
    contact = SpringDamper(1e4, float(damping_ratio(0.65)), Release.FORCE)
    expected = float(orbit_at(contact, 1, 1.0).apparent_restitution) / 0.65 - 1
    assert float(dry.relative_error.sel(at)[-1]) == pytest.approx(expected, rel=1e-9)
