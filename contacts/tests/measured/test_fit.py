"""Contact laws fitted to measured impacts: trial numbers, intervals that hold, and mistakes."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad, solve_ivp

import bouncing_ball_contacts
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.models.laws.hertzian import KuwabaraKono
from bouncing_ball_contacts import Table, assess_contact, fit_contact, write_contact
from bouncing_ball_contacts.contact.question import EngineSetup, Question
from bouncing_ball_contacts.measured.curves import CURVES, curve_named
from bouncing_ball_contacts.measured.experiment import experiment
from bouncing_ball_contacts.measured.law_fit import MeasuredPoints, fit_law

TABLE = Table(frequency="20 Hz", acceleration="1 g")
SPEEDS = np.geomspace(0.5, 6.0, 8)
NOISE = 0.004
# Laws that depend on the speed in different ways; the others have the r(v) of one of these.
DIFFERENT = ("tsuji", "kuwabara-kono", "hunt-crossley")


def simulated(name, restitution, generator, speeds=SPEEDS, noise=NOISE):
    """Restitution coefficients of a law with noise, and those without."""
    curve = curve_named(name)
    theta = fit_law(curve, MeasuredPoints(np.ones(1), np.array([restitution]))).theta
    exact = curve.restitution(theta, speeds / np.exp(np.mean(np.log(speeds))))
    return exact + noise * generator.standard_normal(speeds.size), exact


@pytest.mark.parametrize(
    ("law", "rms"), [("kuwabara-kono", 0.0042), ("tsuji", 0.019), ("hunt-crossley", 0.074)]
)
def test_one_point_of_gugans_table_predicts_the_others(law, rms):
    # The numbers of the trial that this room began with, to their two digits.
    croquet = experiment("croquet")
    one = croquet.speeds == 2.83
    fit = fit_contact(croquet.speeds[one], croquet.restitutions[one], laws=[law])
    errors = croquet.restitutions - fit.best.restitution_at(croquet.speeds)
    assert float(f"{np.sqrt(np.mean(errors**2)):.2g}") == rms


@pytest.mark.parametrize("law", [name for name in CURVES if name != "restitution"])
def test_a_fit_has_the_impact_of_an_integration_that_shares_no_code(law):
    """r and T of the fitted parameters in SI units, by an integrator of scipy."""
    mass, time = 0.2, 1e-3
    fit = fit_contact([2.0], [0.8], time, mass=mass, laws=[law]).best
    assert float(fit.restitution_at(2.0)) == pytest.approx(0.8, abs=1e-9)
    numbers = fit.parameters()
    forces = {
        "hunt-crossley": lambda x, u: numbers["stiffness"] * x**1.5 * (1 + numbers["damping"] * u),
        "hunt-crossley-linear": lambda x, u: (
            numbers["stiffness"] * x * (1 + numbers["damping"] * u)
        ),
        "kuwabara-kono": lambda x, u: (
            numbers["stiffness"] * (x**1.5 + numbers["damping"] * np.sqrt(x) * u)
        ),
        "tsuji": lambda x, u: (
            numbers["stiffness"] * x**1.5
            + numbers["damping"] * np.sqrt(mass * numbers["stiffness"]) * x**0.25 * u
        ),
    }
    if law not in forces:
        omega = numbers["frequency_ratio"]
        zeta = numbers["damping_ratio"]
        is_limited = law == "elasto-backlash"

        def damped(x, u):
            pushed = 2 * zeta * u
            return mass * omega * (omega * x + (min(pushed, omega * x) if is_limited else pushed))

        forces[law] = damped
    force = forces[law]
    at_force = law in ("kuwabara-kono", "elasto-backlash")

    def grip(t, y):
        return (force(max(y[0], 0.0), y[1]) if at_force else y[0]) if t > time / 4 else 1.0

    grip.terminal = True
    path = solve_ivp(
        lambda t, y: (y[1], -force(max(y[0], 0.0), y[1]) / mass),
        (0, 3 * time),
        (0.0, 2.0),
        events=grip,
        rtol=1e-10,
        atol=1e-14,
        max_step=time / 50,
    )
    # The integrator has no steps at the ends of the contact, where the force is not smooth.
    assert path.t[-1] == pytest.approx(time, rel=1e-5)
    assert -path.y[1, -1] == pytest.approx(0.8 * 2.0, rel=1e-5)


def covered(law, known, count, seed=50):
    """How many of some simulated experiments have the exact r(v₀) in their 95 % interval."""
    generator = np.random.default_rng(seed)
    found = 0
    for _ in range(count):
        measured, exact = simulated(law, 0.75, generator)
        points = MeasuredPoints(SPEEDS, measured, np.eye(SPEEDS.size) * NOISE**2 if known else None)
        low, high = fit_law(curve_named(law), points).interval
        middle = float(np.interp(0.0, np.log(SPEEDS / points.reference), exact))
        if law != "tsuji":
            theta = fit_law(curve_named(law), MeasuredPoints(np.ones(1), np.array([0.75]))).theta
            middle = float(curve_named(law).restitution(theta, 1.0))
        found += low <= middle <= high
    return found


def binomial_limits(count, share=0.95, tail=5e-4):
    """Numbers of hits that are exceeded on either side with the probability ``tail``."""
    return stats.binom.ppf(tail, count, share), stats.binom.isf(tail, count, share)


# Weekly all of them hold in a thousand experiments.
OFTEN = [("tsuji", True), ("tsuji", False)]


@pytest.mark.slow
@pytest.mark.parametrize(("law", "known"), OFTEN)
def test_intervals_hold_the_parameter_of_simulated_experiments(law, known):
    low, high = binomial_limits(60)
    assert low <= covered(law, known, 60) <= high


@pytest.mark.long
@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("law", DIFFERENT)
def test_intervals_hold_in_93_to_97_percent_of_a_thousand(law, known):
    # Of exact intervals, 930 to 970 of 1,000 fail with a probability of 0.4 %.
    assert 930 <= covered(law, known, 1000) <= 970


@pytest.mark.parametrize("law", DIFFERENT)
def test_the_law_behind_precise_data_is_the_best(law):
    measured, exact = simulated(law, 0.75, np.random.default_rng(7), noise=1e-4)
    fit = fit_contact(SPEEDS, measured, uncertainties=1e-4)
    assert fit.best.rms == pytest.approx(fit.law(law).rms)
    # χ² has seven degrees of freedom.
    assert 1e-4 < fit.law(law).p_value < 1 - 1e-4
    others = {"tsuji", "kuwabara-kono", "hunt-crossley"} - {law}
    assert all(fit.law(other).p_value < 1e-6 for other in others)
    np.testing.assert_allclose(fit.law(law).restitution_at(SPEEDS), exact, atol=5e-4)


def test_the_error_of_a_point_left_out_is_that_of_a_fit_without_it():
    croquet = experiment("croquet")
    for law, tolerance in (("tsuji", 1e-12), ("kuwabara-kono", 1e-3)):
        points = MeasuredPoints(croquet.speeds, croquet.restitutions)
        errors = []
        for k in range(points.size):
            rest = fit_law(curve_named(law), points.take(np.arange(points.size) != k))
            at = rest.restitution_at(points.speeds[k])
            errors.append(float(points.restitutions[k] - at))
        refitted = np.sqrt(np.mean(np.square(errors)))
        # The formula is exact where r is linear in θ.
        found = fit_law(curve_named(law), points).left_out
        assert found == pytest.approx(refitted, rel=tolerance)


def test_a_constant_r_is_the_weighted_mean():
    e = np.array([0.8, 0.82, 0.85])
    u = np.array([0.01, 0.02, 0.04])
    fit = fit_contact([1.0, 2.0, 3.0], e, uncertainties=u, laws=["linear"]).best
    mean = np.sum(e / u**2) / np.sum(1 / u**2)
    assert fit.restitution == pytest.approx(mean, abs=1e-12)
    half = 1.959963984540054 / np.sqrt(np.sum(1 / u**2))
    np.testing.assert_allclose(fit.interval, (mean - half, mean + half), atol=1e-12)
    assert fit.chi_square == pytest.approx(np.sum(((e - mean) / u) ** 2))
    # χ² with two degrees of freedom has the density exp(-x/2)/2.
    tail = quad(lambda x: np.exp(-x / 2) / 2, fit.chi_square, np.inf)[0]
    assert fit.p_value == pytest.approx(tail, rel=1e-9)


def test_correlated_errors_count_as_their_covariance_says():
    spread = np.array([[1.0, 0.9], [0.9, 1.0]]) * 1e-4
    fit = fit_contact([1.0, 2.0], [0.8, 0.7], uncertainties=spread, laws=["tsuji"]).best
    # Two errors with the correlation 0.9 hardly average out.
    half = 1.959963984540054 * np.sqrt(1e-4 * 1.9 / 2)
    np.testing.assert_allclose(fit.interval, (0.75 - half, 0.75 + half), atol=1e-12)


def test_contact_times_give_the_power_of_hertz():
    fit = fit_contact([1.0, 4.0], [0.8, 0.8], [1e-3, np.nan], laws=["tsuji", "linear"])
    assert float(fit.law("tsuji").duration_at(4.0)) == pytest.approx(1e-3 * 4**-0.2)
    assert float(fit.law("linear").duration_at(4.0)) == pytest.approx(1e-3)


def test_a_mean_contact_time_has_its_interval():
    times = np.array([1.0e-3, 1.1e-3, 0.9e-3, 1.2e-3])
    errors = np.full(4, 1e-4)
    fit = fit_contact(
        [1.0, 2.0, 3.0, 4.0],
        [0.8] * 4,
        times,
        duration_uncertainties=errors,
        laws=["linear"],
    ).best
    half = 1.959963984540054 * 1e-4 / 2
    np.testing.assert_allclose(fit.time_interval, (1.05e-3 - half, 1.05e-3 + half), rtol=1e-12)
    scattered = fit_contact([1.0, 2.0, 3.0, 4.0], [0.8] * 4, times, laws=["linear"]).best
    half = stats.t.ppf(0.975, 3) * np.std(times, ddof=1) / 2
    np.testing.assert_allclose(
        scattered.time_interval, (1.05e-3 - half, 1.05e-3 + half), rtol=1e-12
    )


def test_a_stiffness_needs_a_contact_time(refusal):
    fit = fit_contact([1.0, 2.0], [0.8, 0.7], mass=0.1)
    assert any("stiffness is not identified" in note for note in fit.notes)
    with refusal(ModelError, "stiffness is not identified", "contact time"):
        fit.best.parameters()
    with refusal(ModelError, "not identified"):
        fit.best.duration_at(1.0)
    with refusal(ModelError, "no contact time"):
        CURVES["restitution"].duration(0.8, 1.0)
    # Its contact is still to be chosen.
    contact = fit.best.contact(1.5)
    assert contact.contact_time is None and not contact.is_stiff
    assert bouncing_ball_contacts.choose_contact(TABLE, contact).stiffness > 0


@pytest.mark.usefixtures("short_runs")
def test_the_contact_has_the_impact_of_the_law_on_a_table():
    fit = experiment("croquet").fit().best
    contact = fit.contact_on(TABLE)
    case = assess_contact(TABLE, contact, Question(n=1)).case
    speed = fit.speed_on(TABLE)
    assert isinstance(case.law, KuwabaraKono)
    # The speed of the orbit is 2π/(1 + r) g/Ω with the r at this speed.
    motion = TABLE.motion
    unit = motion.gravity / motion.angular_frequency
    r = float(fit.restitution_at(speed))
    assert speed == pytest.approx(2 * np.pi / (1 + r) * unit, rel=1e-12)
    impact = case.law.signature(speed / unit)
    assert float(impact.restitution) == pytest.approx(r, abs=1e-9)
    assert float(impact.duration) * motion.time == pytest.approx(float(fit.duration_at(speed)))
    # At another speed, too, because the law is the same.
    later = case.law.signature(10 * speed / unit)
    assert float(later.restitution) == pytest.approx(float(fit.restitution_at(10 * speed)))


def test_from_measured_impacts_to_the_solref_of_mujoco():
    fit = experiment("croquet").fit(("linear",)).best
    contact = fit.contact_on(TABLE)
    written = write_contact(contact, EngineSetup(engine="mujoco"), TABLE)
    assert "solref" in str(written)


@pytest.mark.parametrize("name", ["croquet", "membrane_heavy", "thin_drop"])
def test_the_linear_contact_of_each_law_is_written_with_its_restitution(name, refusal):
    """MuJoCo's contact, integrated without our formulas, has the e of the fit at this speed."""
    best = experiment(name).fit().best
    contact = best.linear_contact(speed=0.4, mass="2 g")
    setting = EngineSetup(engine="mujoco")
    written = write_contact(contact, setting)
    k, b = (-float(x) for x in written.parameters["solref"])

    def pushes(_, y):
        return -k * y[0] - b * y[1]

    pushes.terminal = True
    pushes.direction = 1
    path = solve_ivp(
        lambda t, y: (y[1], pushes(t, y)), (0, 1), (0, 0.4), events=pushes, rtol=1e-10, atol=1e-14
    )
    assert path.t[-1] == pytest.approx(float(best.duration_at(0.4)), rel=1e-6)
    assert -path.y[1, -1] / 0.4 == pytest.approx(float(best.restitution_at(0.4)), rel=1e-6)
    if best.law != "linear":
        with refusal(ModelError, f"{best.law} is not written for mujoco"):
            write_contact(best.contact(mass="2 g"), setting)


def test_one_point_and_equal_speeds_are_said_to_test_nothing():
    one = fit_contact([2.0], [0.8])
    assert any("One point" in note for note in one.notes)
    assert np.isnan(one.best.interval).all() and np.isnan(one.best.band(1.0)).all()
    equal = fit_contact([2.0, 2.0, 2.0], [0.8, 0.81, 0.79])
    assert any("speeds are equal" in note for note in equal.notes)
    np.testing.assert_allclose([each.restitution for each in equal.laws], 0.8, atol=1e-9)


def test_notes_give_the_size_of_gravity_during_contact():
    (note,) = [each for each in fit_contact([2.0, 4.0], [0.8, 0.7], 1e-3).notes if "Grav" in each]
    assert f"{9.80665 * 1e-3 / 2:.2g}" in note


MISTAKES = {
    "no numbers": (([], []), {}, "one length"),
    "two lengths": (([1.0, 2.0], [0.5]), {}, "not 2 and 1"),
    "a word for truth": (
        ([1.0], [0.5]),
        {"absolute_uncertainties": "no"},
        "absolute_uncertainties = 'no' is not True or False",
    ),
    "numbers for truth": (
        ([1.0, 2.0], [0.5, 0.4]),
        {"absolute_uncertainties": np.array([1.0, 2.0])},
        "is not True or False",
    ),
    "a matrix": ((np.ones((2, 2)), np.ones((2, 2))), {}, "one length"),
    "a speed of 0": (([0.0], [0.5]), {}, "impact speed = 0.0"),
    "NaN": (([1.0], [np.nan]), {}, "restitution coefficient = nan"),
    "r above 1": (([1.0, 2.0], [0.5, 1.1]), {}, "1.1 is not in (0, 1]"),
    "an uncertainty of 0": (([1.0], [0.5]), {"uncertainties": [0.0]}, "uncertainty = 0.0"),
    "few uncertainties": (([1.0, 2.0, 3.0], [0.5] * 3), {"uncertainties": [0.1, 0.2]}, "3 points"),
    "no contact time": (([1.0], [0.5], [-1.0]), {}, "contact time = -1.0"),
    "few contact times": (([1.0, 2.0], [0.5] * 2, [1.0]), {}, "2 points"),
    "an error of a time": (([1.0], [0.5], 1.0), {"duration_uncertainties": 0.0}, "contact time"),
    "a mass in s": (([1.0], [0.5]), {"mass": "1 s"}, "mass = 1 s"),
    "an unknown law": (([1.0], [0.5]), {"laws": ["hooke"]}, "unknown contact law 'hooke'"),
    "a law without scales": (([1.0], [0.5]), {"laws": ["impedance"]}, "law for a fit"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_get_one_line(refusal, mistake):
    given, options, part = MISTAKES[mistake]
    with refusal(ModelError, part):
        fit_contact(*given, **options)


def test_a_law_that_was_not_fitted_is_named(refusal):
    with refusal(NoOrbitError, "tsuji was not fitted", "linear"):
        fit_contact([1.0], [0.5], laws=["linear"]).law("tsuji")


def test_all_times_missing_is_no_contact_time():
    fit = fit_contact([1.0, 2.0], [0.8, 0.7], [np.nan, np.nan])
    assert not fit.best.has_stiffness


@pytest.mark.parametrize("laws", ["tsuji", 0.5, np.ones((2, 2)), float, [0.5]])
def test_laws_are_a_list_of_names(laws, refusal):
    with refusal(ModelError, "laws = ", "is no list of names of laws"):
        fit_contact([1.0, 2.0], [0.8, 0.7], laws=laws)
