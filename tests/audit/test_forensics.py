"""Readings of Table 1: each alteration against an implementation of its own."""

import numpy as np
import pytest
from scipy.optimize import brentq

from bouncing_ball.audit.forensics.altered_model import Altered, altered_monodromy, altered_orbit
from bouncing_ball.audit.forensics.bifurcations import bifurcations
from bouncing_ball.audit.forensics.ranking import ALL_ROWS, SOFTER_ROWS, forensics
from bouncing_ball.audit.forensics.readings import (
    BASELINE,
    FORMULA,
    HIGH_BOUNCE_STABILITY,
    TRUNCATED,
    at_step,
    readings,
)
from bouncing_ball.audit.forensics.steps import attainable, nearby
from bouncing_ball.configuration.study import typed
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.figures.tables.forensics import rows
from bouncing_ball.orbits.restitution_orbit import ImpactMap
from bouncing_ball.orbits.restitution_orbit import period_doubling as printed_doubling
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_limits import orbit_at, period_doubling, saddle_node
from bouncing_ball.studies.orbit_branches import stability_ranges

R = 0.85
ZETA = float(damping_ratio(R))
TABLE = {
    "restitution": R,
    "release": "displacement",
    "frequency_ratio": [1e4, 10.0, 2.0],
    "n": [1, 2, 3],
    "bound": ["saddle-node", "period doubling"],
    "values": [
        [[0.255, 1.032], [0.509, 1.122], [0.764, 1.259]],
        [[0.238, 1.035], [0.495, 1.126], [0.750, 1.262]],
        [[0.187, 1.082], [0.463, 1.170], [0.733, 1.298]],
    ],
}
PARAMETERS = {
    "printed_damping_ratio": 0.052,
    "other_damping_ratios": [0.0495, 0.0535],
    "stiff_exponents": [2, 5],
    "steps": [0.005, 0.02],
    "step_reach": 0.2,
    "last_digit": 0.001,
    "printed": TABLE,
}
# What each alteration changes, and with which fields.
ALTERATIONS = {
    "baseline": {},
    "force": {"force": 1.0},
    "weightless": {"weight": 0.0},
    "force, weightless": {"force": 1.0, "weight": 0.0},
    "undamped transient": {"damped": 0.0},
    "square lost": {"squared": 0.0},
    "high-bounce flight": {"rise": 0.0, "linear_rise": 0.0},
    "high-bounce stability": {"linear_rise": 0.0},
    "duration not perturbed": {"timed": 0.0},
}


@pytest.fixture(scope="module")
def study():
    return forensics(PARAMETERS, TABLE)


def model(omega, n, **changes):
    return Altered(np.array(float(omega)), np.array(ZETA), np.array(float(n)), **changes)


def contact_path(u, phase, lam, m):
    """(δ, δ′) as functions of time: Eqs. 12-13 in real arithmetic, altered."""
    omega, zeta = float(m.frequency_ratio), float(m.damping_ratio)
    loss = 2 * zeta * omega
    gamma = (omega**2 - 1) ** 2 + (loss**2 if m.squared else loss)
    wave = omega * (np.sqrt(1 - zeta**2) if m.damped else 1.0)

    def steady(s):
        sin, cos = np.sin(s + phase), np.cos(s + phase)
        return (
            lam * ((omega**2 - 1) * sin - loss * cos) / gamma - m.weight / omega**2,
            lam * ((omega**2 - 1) * cos + loss * sin) / gamma,
        )

    level, rate = steady(0.0)
    a, b = -level, (u - rate - zeta * omega * level) / wave

    def path(s):
        sin, cos, decay = np.sin(wave * s), np.cos(wave * s), np.exp(-zeta * omega * s)
        free = decay * (a * cos + b * sin)
        free_rate = decay * wave * (b * cos - a * sin) - zeta * omega * free
        level, rate = steady(s)
        return level + free, rate + free_rate

    return path


def cycle(phase, u, orbit, m):
    """One cycle of the altered return map, its events closed by Brent's method."""
    lam, duration = float(orbit.amplitude), float(orbit.contact_duration)
    path = contact_path(u, phase, lam, m)

    def release(s):
        d, v = path(s)
        return m.frequency_ratio * d + m.force * 2 * m.damping_ratio * v

    s = brentq(release, 0.97 * duration, 1.03 * duration, xtol=1e-300, rtol=9e-16)
    s = s if m.timed else duration
    d, v = path(s)
    height, thrown = d + lam * np.sin(phase + s), v + lam * np.cos(phase + s)
    flight = 2 * np.pi * float(m.n) - duration
    # High bounce: the orbit's own value, 0 if the orbit is one of high bounce too.
    closed = (float(orbit.impact + orbit.x) + flight / 2) * flight if m.rise else 0.0

    def gap(t):
        rise = thrown * t - t * t / 2
        if m.linear_rise:
            return height + rise - lam * np.sin(phase + s + t)
        return rise - closed

    t = brentq(gap, 0.97 * flight, 1.03 * flight, xtol=1e-300, rtol=9e-16)
    return phase + s + t, thrown - t - lam * np.cos(phase + s + t)


def test_the_test_contact_obeys_the_equation_of_motion(reference):
    m = model(3.0, 1)
    ours = contact_path(-3.0, 0.4, 0.9, m)(0.8)
    assert ours == pytest.approx(reference.contact_state(0.8, 0.0, -3.0, 0.4, 0.9, 3.0, ZETA))
    # Without gravity the response to it is missing.
    weightless = contact_path(-3.0, 0.4, 0.9, m._replace(weight=0.0))(0.8)
    gravity = reference.contact_state(0.8, 0.0, 0.0, 0.0, 0.0, 3.0, ZETA)
    assert np.array(weightless) == pytest.approx(np.array(ours) - np.array(gravity))


@pytest.mark.parametrize("name", ALTERATIONS)
@pytest.mark.parametrize(("omega", "n"), [(10.0, 1), (2.0, 2)])
def test_orbit_and_monodromy_are_those_of_the_altered_return_map(name, omega, n):
    m = model(omega, n, **ALTERATIONS[name])
    found = bifurcations(m)
    # Between the bifurcations, where nothing is special.
    orbit = altered_orbit(0.6 * found.saddle_node + 0.4 * found.period_doubling, m)
    phase, u = float(orbit.phase), float(orbit.impact)
    # The orbit equations to rounding times the size of the terms, of order 100.
    landing = cycle(phase, u, orbit, m)
    assert landing == pytest.approx((phase + 2 * np.pi * n, u), abs=1e-11)
    # Central differences: 1e-10 of truncation, 1e-11/1e-5 of rounding.
    step = 1e-5
    columns = []
    for nudge in ((step, 0.0), (0.0, step)):
        ends = [cycle(phase + k * nudge[0], u + k * nudge[1], orbit, m) for k in (1, -1)]
        columns.append((np.array(ends[0]) - np.array(ends[1])) / (2 * step))
    expected = np.stack(columns, axis=-1)
    assert altered_monodromy(orbit, m) == pytest.approx(expected, abs=2e-6)


@pytest.mark.parametrize("release", list(Release))
def test_baseline_is_the_closed_form(release):
    omega = np.geomspace(1.5, 1e4, 6)[:, np.newaxis]
    n, contact = np.array([1.0, 2.0, 3.0]), SpringDamper(omega, ZETA, release)
    found = bifurcations(Altered(omega, ZETA, n, force=float(release is Release.FORCE)))
    for excess, find in zip(found, (saddle_node, period_doubling), strict=True):
        m = Altered(omega, ZETA, n, force=float(release is Release.FORCE))
        expected = branch_point(find(contact, n), contact, n).amplitude
        # D carries ε with 1e-16; the branch has a width of 1/ϖ² in ε or more.
        assert altered_orbit(excess, m).amplitude == pytest.approx(expected, abs=1e-9)


@pytest.mark.slow
def test_baseline_is_table_1_by_continuation(study, continuation_settings):
    table = {key: TABLE[key] for key in ("frequency_ratio", "n")}
    table |= {"restitution": R, "amplitude_max": 1.5}
    expected = typed(stability_ranges)(table, "displacement", continuation_settings, TABLE).computed
    found = study.computed.sel(reading=BASELINE)
    assert found.values == pytest.approx(expected.values, abs=1e-9)


def test_the_jump_of_the_damping_force_does_not_move_the_bifurcations():
    """Fixed-time fundamental matrices, without the jumps at impact and release.

    Their product has the trace of the return map, 2g′ + 2ζϖg - ϖ²gT: the two
    jumps cancel in it. That reading is the baseline.
    """
    m = model(2.0, 2)
    found = bifurcations(m)
    orbit = altered_orbit(0.6 * found.saddle_node + 0.4 * found.period_doubling, m)
    path = contact_path(1.0, 0.0, 0.0, m._replace(weight=0.0))
    g, rate = path(float(orbit.contact_duration))
    flight = 4 * np.pi - float(orbit.contact_duration)
    trace = 2 * rate + 2 * ZETA * 2.0 * g - 4.0 * g * flight
    assert np.trace(altered_monodromy(orbit, m)) == pytest.approx(trace, abs=1e-11)


@pytest.mark.parametrize(("share", "where"), [(0.0, "start"), (0.5, "middle"), (1.0, "end")])
def test_criteria_of_the_restitution_model(study, share, where):
    contact = SpringDamper(10.0, ZETA)

    def lifted(name):
        cell = {"frequency_ratio": 10.0, "n": 2, "bound": "period doubling"}
        lam = float(study.computed.sel(reading=name, **cell))
        orbit = orbit_at(contact, 2, lam)
        return lam * np.sin(
            orbit.phase + share * orbit.contact_duration
        ), orbit.apparent_restitution

    # The root is closed to the last digit; its slope is of order one.
    assert lifted(f"Holmes' criterion, {where} of contact")[0] == pytest.approx(1, abs=1e-9)
    lift, r_a = lifted(f"restitution criterion, {where} of contact")
    assert lift == pytest.approx(2 * (1 + r_a**2) / (1 + r_a) ** 2, abs=1e-9)


def test_high_bounce_stability_is_holmes_map_for_a_stiff_contact(study):
    at = {"frequency_ratio": 1e4, "bound": "period doubling"}
    found = study.computed.sel(reading=HIGH_BOUNCE_STABILITY, **at)
    n = np.array([1, 2, 3])
    # The finite contact duration changes Λ by a term of order n/ϖ.
    assert found.values == pytest.approx(printed_doubling(n, R, ImpactMap.HOLMES), abs=1e-4)
    exact = study.computed.sel(reading=BASELINE, **at)
    assert exact.values == pytest.approx(printed_doubling(n, R), abs=1e-4)


def test_a_step_is_counted_along_the_papers_unknowns():
    m = model(10.0, 1)
    excess = bifurcations(m).period_doubling
    arc, amplitude = nearby(excess, m, 0.05)
    assert arc[0] < -0.04 and arc[-1] > 0.04
    contact, half = SpringDamper(10.0, ZETA), 0.01

    def unknowns(lam):
        orbit = orbit_at(contact, 1, lam)
        omega, gamma = 10.0, 99.0**2 + (20 * ZETA) ** 2
        x, y = lam * np.cos(orbit.phase), lam * np.sin(orbit.phase)
        a = 1 / omega**2 - (99 * y - 20 * ZETA * x) / gamma
        rate = orbit.relative_impact_velocity - (99 * x + 20 * ZETA * y) / gamma
        b = (rate + ZETA * omega * a) / (omega * np.sqrt(1 - ZETA**2))
        return np.array(
            [
                orbit.impact_velocity,
                orbit.bounce_velocity,
                orbit.contact_duration,
                orbit.phase,
                a,
                b,
                lam,
            ]
        )

    centre = unknowns(float(altered_orbit(excess, m).amplitude))
    for end in attainable(arc, amplitude, 2 * half):
        # A chord is shorter than its arc by κ²h³/24, κ of order 1.
        assert np.linalg.norm(unknowns(float(end)) - centre) == pytest.approx(half, abs=1e-6)


def test_steps(study):
    name = at_step(0.02)
    exact, found = (study.computed.sel(reading=x) for x in (BASELINE, name))
    needed = study.step_needed.sel(reading=name)
    folds, doublings = (
        {"bound": bound, "frequency_ratio": [10.0, 2.0]} for bound in TABLE["bound"]
    )
    # A continued point lies on the branch, so never below the fold.
    assert (found.sel(folds) >= exact.sel(folds) - 1e-12).all()
    below = study.printed.sel(folds) + 0.0005 < exact.sel(folds)
    assert np.isinf(needed.sel(folds).values[below.values]).all()
    assert int(study.unreachable.sel(reading=BASELINE)) == below.sum() == 3
    # An entry is reproduced where the step is as long as needed.
    for step in PARAMETERS["steps"]:
        reproduced = np.abs(study.difference.sel(reading=at_step(step))) <= 0.5
        assert (reproduced == (needed <= step)).all()
    assert (needed.sel(doublings) > 0).all()
    # A longer step needs no more and gives no less.
    shorter = study.sel(reading=at_step(0.005))
    assert np.array_equal(shorter.step_needed, needed)
    rms = study.rms_difference.sel(rows=ALL_ROWS)
    assert rms.sel(reading=name) <= rms.sel(reading=at_step(0.005))


def test_ranks(study, described):
    described(study)
    assert study["rank"].values.tolist() == list(range(1, study.sizes["reading"] + 1))
    assert len(set(study.reading.values)) == study.sizes["reading"]
    # The softer rows decide, all rows among readings that are equal in those.
    softer, every = (study.rms_difference.sel(rows=x).values for x in (SOFTER_ROWS, ALL_ROWS))
    rms = softer.round(9) + 1e-12 * every
    chosen, missing = study.chosen_in_range.values, np.isnan(rms)
    for group in (~chosen & ~missing, chosen & ~missing, missing):
        assert np.array_equal(np.sort(rms[group]), rms[group], equal_nan=True)
    # Definite values first, then those chosen from a range, then no orbits.
    assert (np.diff(chosen * 1 + missing * 2) >= 0).all()


def test_distances(study):
    difference = study.difference.sel(reading=FORMULA)
    expected = (study.computed.sel(reading=FORMULA) - study.printed) / 0.001
    assert difference.values == pytest.approx(expected.values, abs=1e-9)
    soft = difference.sel(frequency_ratio=[10.0, 2.0])
    at = {"reading": FORMULA, "rows": SOFTER_ROWS}
    assert float(study.largest_difference.sel(at)) == np.abs(soft).max()
    assert float(study.rms_difference.sel(at)) == pytest.approx(np.sqrt((soft**2).mean()))
    assert int(study.reproduced.sel(at)) == (np.abs(soft) <= 0.5).sum()
    assert int(study.entries.sel(rows=SOFTER_ROWS)) == 12
    # The formula is Eqs. 7 and 8, which reproduce the stiffest row to the digit.
    assert int(study.reproduced.sel(reading=FORMULA, rows="ϖ = 10000")) == 6


@pytest.mark.parametrize(("name", "written"), [(BASELINE, np.round), (TRUNCATED, np.floor)])
def test_a_table_printed_under_a_reading_is_recognised(study, name, written):
    exact = study.computed.sel(reading=BASELINE).values
    table = TABLE | {"values": (written(exact / 0.001) * 0.001).tolist()}
    found = forensics(PARAMETERS, table)
    best = found.isel(reading=0)
    assert str(best.reading.values) == name
    assert int(best.reproduced.sel(rows=ALL_ROWS)) == 18 and int(best.unreachable) == 0


def test_a_table_with_other_bounds_is_refused(one_line):
    with pytest.raises(ModelError) as error:
        forensics(PARAMETERS, TABLE | {"bound": ["from", "to"]})
    one_line(error, "printed.bound", "saddle-node", "period doubling")


def test_rows_of_the_table(study):
    header, body = rows(study)
    assert len(body) == study.sizes["reading"] and {len(line) for line in body} == {len(header)}
    assert [line[0] for line in body] == [str(k + 1) for k in range(len(body))]
    line = next(line for line in body if line[1] == BASELINE)
    rms = float(study.rms_difference.sel(reading=BASELINE, rows=ALL_ROWS))
    assert line[header.index("rms, all rows")] == f"{rms:.2f}"
    assert line[header.index("reproduced, softer rows")] == "1 of 12"
    last = body[-1]
    assert last[1] == "ratio upside down" and last[header.index("rms, all rows")] == "–"


def test_names_are_plain_text_for_latex():
    for reading in readings(PARAMETERS):
        assert reading.name.isascii() and not set(reading.name) & set("_^%&$#")
        assert reading.description
