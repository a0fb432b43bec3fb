"""What a ball does in the end: labels, greatest heights and the verdict on them."""

import numpy as np
import pytest
from asked_contacts import assessed

from bouncing_ball_beyond.inherited.contacts.contact import effort
from bouncing_ball_beyond.inherited.contacts.contact.judgement import MotionJudgement
from bouncing_ball_beyond.inherited.contacts.contact.motion import FinalMotion
from bouncing_ball_beyond.inherited.contacts.contact.verdict import aside, said_of_motion
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

UNIT = {"mass": 1.0, "frequency": "1 rad/s", "gravity": 1.0, "restitution": 0.85, "n": 1}


@pytest.fixture
def few_impacts(monkeypatch):
    """An answer that follows the ball for fewer impacts, after which these motions are known."""
    monkeypatch.setattr(effort, "LINEAR", effort.LINEAR._replace(impacts=200))


@pytest.fixture
def few_starts(monkeypatch):
    """An answer with nine other starts and few impacts, where their shares are not asserted.

    ``test_the_headline_is_about_the_motion_on_which_most_balls_end`` has all of them.
    """
    monkeypatch.setattr(effort, "LINEAR", effort.LINEAR._replace(starts=3))
    monkeypatch.setattr("bouncing_ball_beyond.inherited.contacts.contact.starts._IMPACTS", 100)


@pytest.mark.parametrize(
    ("amplitude", "kind", "says"),
    [
        (0.8, "orbit", "The 1-T orbit is stable: a ball on it stays on it. A ball laid on the"),
        (
            1.1,
            "subharmonic",
            "subharmonic orbit, which repeats after 2 periods of the table and 2 impacts.",
        ),
        (2.0, "chaotic", "A ball that starts near it ends in chaotic motion."),
    ],
)
def test_the_headline_says_what_the_ball_does(
    amplitude, kind, says, few_starts, few_impacts, monkeypatch
):
    # Where balls come to an orbit, they need more impacts to be known on it.
    monkeypatch.setattr(
        "bouncing_ball_beyond.inherited.contacts.contact.starts._IMPACTS",
        300 if kind == "orbit" else 100,
    )
    found = assessed(**UNIT, acceleration=amplitude, stiffness=5000.0, tolerance="20 %")
    assert found.motion.kind == kind and says in found.headline
    assert found.headline != found.verdict
    if kind == "orbit":
        assert found.motion.laid == "permanent contact"
        # A ball laid on this table is thrown onto the orbit.
        thrown = assessed(**UNIT | {"restitution": 0.2}, acceleration=2.43, stiffness=4900.0)
        assert thrown.motion.laid is None
        return
    assert found.motion.restitution_kind == kind
    # An orbit that no ball has is not judged.
    assert "1-T orbit" not in found.verdict
    if kind == "chaotic":
        assert found.verdict.endswith("good enough for this motion is not known.")
        assert "not known to repeat in both models" in found.reason


@pytest.mark.parametrize(
    ("amplitude", "restitution", "kind", "says"),
    [(0.2, 0.85, "permanent contact", "stays at rest."), (1.1, 0.2, "locked", "sticks to the")],
)
def test_where_there_is_no_orbit_the_ball_is_laid_on_the_table(
    amplitude, restitution, kind, says, few_starts
):
    given = UNIT | {"n": None, "restitution": restitution, "stiffness": 5000.0}
    found = assessed(**given, acceleration=f"{amplitude} m/s^2", tolerance="5 %")
    assert found.headline.startswith("No model has an n-T orbit.") and says in found.headline
    assert found.motion.kind == found.motion.restitution_kind == kind and found.is_good_enough
    assert "no n-T orbit in any model" in found.reason and not found.judged.exists
    if kind == "locked":
        # The greatest heights of a locked motion are those of a long simulation.
        contact = SpringDamper.from_restitution(restitution, np.sqrt(5000.0))
        models = ContactModel(contact), RestitutionModel(restitution)
        for model, shown in zip(models, found.motion.greatest.values(), strict=True):
            run = model.simulate(amplitude, np.pi, -amplitude, 400)
            lift = run.release_displacement + amplitude * np.sin(run.release_phase)
            tops = lift + np.maximum(run.bounce_velocity, 0.0) ** 2 / 2
            assert shown == pytest.approx(np.nanmax(tops[200:]), rel=1e-6)


def test_a_verdict_on_an_orbit_says_that_it_leaves_out_a_ball_laid_on_the_table(
    few_starts, few_impacts
):
    found = assessed(**UNIT | {"n": 7, "stiffness": 1e5}, acceleration=2.0, tolerance="20 %")
    assert found.motion.kind == "orbit" and found.motion.laid not in (None, "permanent contact")
    assert found.verdict.endswith(", and is not judged.") and "; a ball laid" in found.verdict


def test_a_ball_laid_on_the_table_is_left_out_without_a_word_where_it_rests_in_both_models():
    # A ball with restitution alone rests up to Λ = 1.
    for laid, amplitude in (("permanent contact", 1.01), ("chaotic", 0.9)):
        assert aside(FinalMotion("orbit", 1, 1, laid), amplitude).endswith("and is not judged")
    assert aside(FinalMotion("orbit", 1, 1, "permanent contact"), 1.0) == ""


def test_without_loss_a_ball_stays_beside_the_orbit(short_runs):
    lossless = UNIT | {"restitution": 1.0, "stiffness": 1e4, "tolerance": "5 %"}
    found = assessed(**lossless, acceleration=0.5)
    assert "loses no energy" in found.headline and found.is_good_enough
    assert not any("no ball stays" in note for note in found.notes)
    # Beyond the period doubling at Λ = 1 neighbours leave it even so.
    beyond = assessed(**lossless, acceleration=1.2)
    assert "not stable" in beyond.headline and "1-T orbit" not in beyond.verdict


def motion(kind, other, **more):
    return FinalMotion(
        kind=kind,
        periods=0,
        impacts=0,
        restitution_kind=other,
        restitution_periods=0,
        restitution_impacts=0,
        **more,
    )


LOCKED = ("locked", "locked")


@pytest.mark.parametrize(
    ("found", "good", "says"),
    [
        (motion("permanent contact", "permanent contact"), True, "the ball rests in both models"),
        (motion("locked", "permanent contact"), False, "its motion is permanent contact, and the"),
        (motion("subharmonic", "orbit"), False, "is periodic, and the contact's is subharmonic"),
        (
            motion(*LOCKED, greatest={"a": 1.0, "b": 1.04}),
            True,
            "1.04 m in place of 1 m, +4 %, within",
        ),
        (
            motion(*LOCKED, greatest={"a": 1.0, "b": 0.94}),
            False,
            "m in place of 1 m, -6 %, beyond 5 %",
        ),
        (motion("chaotic", "chaotic"), False, "is not known"),
        (motion("locked", "chaotic"), False, "is not known"),
        (motion("undecided", "permanent contact"), False, "is not known"),
    ],
)
def test_the_verdict_on_a_motion(found, good, says):
    judged = MotionJudgement(found, 0.05, 1)
    said = said_of_motion(judged).verdict
    assert judged.is_good_enough is good and says in said
    assert judged.is_decided is said.startswith("The restitution model is")


def test_the_headline_is_about_the_motion_on_which_most_balls_end(few_impacts):
    """The 5-T orbit is stable, and attracts less than one start in a hundred."""
    given = {"mass": "50 g", "frequency": "25 Hz", "acceleration": "2 g", "stiffness": 1e6}
    found = assessed(**given, restitution=0.8)
    assert found.n == 5 and found.judged.is_stable and found.motion.kind == "chaotic"
    assert found.headline.startswith("Most balls end otherwise than on the stable 5-T orbit")
    assert found.starts["chaotic"] > 0.95 and sum(found.starts.values()) == pytest.approx(1)
    assert "of the starts end on the stable 5-T" in found.reason or "no start ends" in found.reason
    # The family that is asked for is judged.
    of_five = assessed(**given, restitution=0.8, n=5)
    assert of_five.headline.startswith("The 5-T orbit is stable: a ball on it stays on it, but ")
    assert of_five.starts == found.starts


def test_the_heights_of_a_motion_are_in_metres(few_starts):
    """The same dimensionless case in other units has heights in the ratio of the lengths g/Ω²."""
    given = {"acceleration": 1.1, "stiffness": 5000.0, "tolerance": "20 %"}
    unit = assessed(**UNIT, **given)
    omega = 2 * np.pi * 20
    real = {"mass": 0.3, "frequency": f"{omega!r} rad/s", "restitution": 0.85, "n": 1}
    found = assessed(
        **real, acceleration="1.1 g", stiffness=0.3 * 5000 * omega**2, tolerance="20 %"
    )
    assert found.motion.kind == unit.motion.kind == "subharmonic"
    length = 9.80665 / omega**2
    for name, height in found.motion.greatest.items():
        assert height == pytest.approx(length * unit.motion.greatest[name], rel=1e-6)
    # Greatest heights by a simulation of the restitution model, over both impacts of the motion.
    model = RestitutionModel(0.85)
    run = model.simulate(1.1, 1.2, -3.0, 1500)
    late = slice(-4, None)
    tops = 1.1 * np.sin(run.phase[late]) + run.bounce_velocity[late] ** 2 / 2
    assert unit.motion.greatest["restitution"] == pytest.approx(tops.max(), rel=1e-6)
