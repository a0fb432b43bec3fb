"""What a ball does in the end: labels, statistics and the verdict on them."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest
from asked_contacts import assessed

from bouncing_ball.contacts import effort
from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.ends import Ending
from bouncing_ball.contacts.engines.impedance import Impedance
from bouncing_ball.contacts.judgement import judged_by_motion
from bouncing_ball.contacts.means import Mean, _changed, _law
from bouncing_ball.contacts.motion import FinalMotion
from bouncing_ball.contacts.resolve import resolve
from bouncing_ball.contacts.table import Table
from bouncing_ball.contacts.verdict_on_motion import aside, said_of_motion
from bouncing_ball.errors import ModelError
from bouncing_ball.long_run.basins import MotionName
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.means import means as means_of
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.long_run.sampled_means import Starts, advance, start
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.laws.force_law import NUMBER
from bouncing_ball.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper

UNIT = {"mass": 1.0, "angular_frequency": 1.0, "gravity": 1.0, "restitution": 0.85, "n": 1}


@pytest.fixture
def without_changes(monkeypatch):
    """An answer without the changes of r, k and g, which take two thirds of its time.

    ``test_a_change_of_a_thousandth_that_decides_leaves_no_percentage`` has them.
    """
    monkeypatch.setattr("bouncing_ball.contacts.means._changes", lambda *_: None)


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
    monkeypatch.setattr("bouncing_ball.contacts.starts._IMPACTS", 100)


# A contact whose mean height is known to half a percent with 256 balls, and to less with 4096: the
# error of the restitution model is that near this tolerance. Changes of r, k and g decide, too.
ON_THE_EDGE = {"mass": "20 g", "frequency": "50 Hz", "acceleration": "2 g", "restitution": 0.5}
ON_THE_EDGE |= {"stiffness": "1e7 N/m", "tolerance": 0.2465}


@pytest.mark.parametrize(
    "law", [RestitutionModel(1.0), SpringDamper(4.0, 0.0), SpringDamper(40.0, 0.0)]
)
def test_an_elastic_ball_has_the_energy_that_the_table_gives_it(law):
    dynamics, first = start(law, 1.7, Starts(np.array([0.4]), np.array([-4.0])))
    first, _ = advance(dynamics, first, 3)
    last, sums = advance(dynamics, first, 36)
    energy = [
        (each.velocity + 1.7 * np.cos(each.phase)) ** 2 / 2 + 1.7 * np.sin(each.phase)
        for each in (first, last)
    ]
    # The nodes of a contact are right to rounding; so is the simulation.
    assert sums[2] == pytest.approx(energy[1] - energy[0], rel=1e-9, abs=1e-9)


def test_an_instant_takes_its_impulse_times_the_speed_of_the_table():
    found = RestitutionModel(0.6).simulate(2.3, 0.4, -4.0, 60)
    impulse = -1.6 * found.relative_velocity[:-1]
    work = np.sum(impulse * 2.3 * np.cos(found.phase[:-1]))
    once = Starts(np.array([0.4]), np.array([-4.0]))
    _, sums = advance(*start(RestitutionModel(0.6), 2.3, once), 59)
    assert sums[2] == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize(
    ("amplitude", "kind", "says"),
    [
        (0.8, "orbit", "The 1-T orbit is stable: a ball on it stays on it. A ball laid on the"),
        (
            1.1,
            "subharmonic",
            "doubled orbit, which repeats after 2 periods of the table and 2 impacts.",
        ),
        (2.0, "chaotic", "A ball that starts near it ends in chaotic motion."),
    ],
)
def test_the_headline_says_what_the_ball_does(
    amplitude, kind, says, without_changes, few_starts, few_impacts, monkeypatch
):
    # Where balls come to an orbit, they need more impacts to be known on it.
    monkeypatch.setattr("bouncing_ball.contacts.starts._IMPACTS", 300 if kind == "orbit" else 100)
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
        for name in ("height", "power"):
            exact, simple = getattr(found.motion, f"mean_{name}").values()
            off, margin = vars(found.motion.mean_error[name]).values()
            assert off == pytest.approx(simple.value / exact.value - 1, rel=1e-9)
            size = abs(off)
            shown = (
                f"at most {100 * (size + margin):.2g} %"
                if margin > size
                else f"{100 * off:+.2g} % ±"
            )
            assert shown in found.verdict
            assert 0 < exact.half_width < 0.1 * exact.value
        # What the table gives, the impacts lose: (1 - r²)/2 of the squared relative speed.
        impacts = RestitutionModel(0.85).simulate(2.0, 1.4, np.linspace(-3.2, -3.0, 64), 500)
        lost = (1 - 0.85**2) / 2 * np.sum(impacts.relative_velocity[100:-1] ** 2, axis=0)
        power = lost / (impacts.time[-1] - impacts.time[100])
        margin = 4 * (power.std() / 8 + simple.half_width / 2)
        assert simple.value == pytest.approx(power.mean(), abs=margin)


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
        # Means over whole repetitions are those of one repetition, which all balls share.
        contact = SpringDamper.from_restitution(restitution, np.sqrt(5000.0))
        models = ContactModel(contact), RestitutionModel(restitution)
        for model, *shown in zip(
            models, found.motion.mean_height.values(), found.motion.mean_power.values(), strict=True
        ):
            motion = final_motions(model, amplitude, np.pi, -amplitude)
            once = means_of(model, amplitude, motion, 1)[1:3]
            assert [x.value for x in shown] == pytest.approx(once.tolist(), rel=1e-9)


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


def means(height, width, other="chaotic"):
    errors = {"height": Mean(height, width), "power": Mean(0.01, 0.0)}
    exact = dict.fromkeys(("spring-damper", "restitution"), Mean(1.0, 0.0))
    given = {"mean_height": exact, "mean_power": exact, "mean_error": errors, "balls": 256}
    return motion("chaotic", other, **given)


LOCKED = ("locked", "locked")


@pytest.mark.parametrize(
    ("found", "good", "says"),
    [
        (motion("permanent contact", "permanent contact"), True, "the ball rests in both models"),
        (motion("locked", "permanent contact"), False, "its motion is permanent contact, and the"),
        (motion("subharmonic", "orbit"), False, "is periodic, and the contact's is doubled"),
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
        (motion("undecided", "permanent contact"), False, "is not known"),
        (
            means(0.02, 0.005),
            True,
            "1 m, +2.0 % ± 0.5 % and a mean power of 1 W in place of 1 W, +1 %, within",
        ),
        (means(-0.02, 0.005), True, "a mean height of 1 m in place of 1 m, -2.0 % ± 0.5 % and"),
        (means(0.0, 0.02), True, "height of 1 m in place of 1 m, at most 2 % off and a mean power"),
        (
            means(0.009, 0.045),
            False,
            "at 5 %: it predicts a mean height of 1 m in place of 1 m, at most 5.4 % off",
        ),
        (
            means(0.04, 0.02),
            False,
            "not decided at 5 %: it predicts a mean height of 1 m in place of 1 m, +4 % ± 2 %",
        ),
        (
            means(-0.12, 0.005),
            False,
            "enough: it predicts a mean height of 1 m in place of 1 m, -12.0 % ± 0.5",
        ),
    ],
)
def test_the_verdict_on_a_motion(found, good, says):
    judged = judged_by_motion(found, 0.05, 1)
    said = said_of_motion(judged).verdict
    assert judged.is_good_enough is good and says in said
    assert judged.is_decided is said.startswith("The restitution model is")


@pytest.mark.parametrize(
    ("found", "advice"),
    [
        # An interval shrinks as the square root of the number: 256 (2/1)² = 1024.
        (means(0.04, 0.02), "256 balls is too small to decide; with balls = 1100 (--balls 1100)"),
        (
            means(0.0499, 0.02),
            "more than 100000 are needed, because the error is next to the tolerance",
        ),
        (means(0.04, 0.02, "locked"), "no larger sample would decide, as rounding errors decide"),
    ],
)
def test_an_undecided_verdict_says_how_many_balls_would_decide(found, advice):
    assert advice in said_of_motion(judged_by_motion(found, 0.05, 1)).reason


def test_a_change_of_a_thousandth_that_decides_leaves_no_percentage(few_starts):
    """Of r = 0.5 and Λ = 2 the mean height changes by tens of percent if r changes by 0.1 %."""
    found = assessed(**ON_THE_EDGE)
    assert "is decided by changes of 0.1 % in r, k or g" in found.verdict
    assert not found.is_good_enough and "± is of sampling alone" in found.reason
    changes = found.motion.changes
    assert [*changes] == ["r -0.1 %", "r +0.1 %", "k +0.1 %", "g +0.1 %"]
    # Without changes the 4096 balls decide what 256 leave open.
    alone = replace(found.motion, changes=None)
    said = said_of_motion(judged_by_motion(alone, ON_THE_EDGE["tolerance"], 1)).verdict
    assert said.startswith("The restitution model is not good enough") and alone.balls == 4096


@pytest.mark.long
def test_a_change_of_a_thousandth_is_as_large_as_that_of_another_contact(few_starts, monkeypatch):
    found = assessed(**ON_THE_EDGE)
    changes = found.motion.changes
    # The change is as large as that of the contact with this r, which starts from its own orbit and
    # so may end on another lap: both are far from the error without the change.
    # It has as many balls as the changes, and needs no changes of its own.
    monkeypatch.setattr("bouncing_ball.contacts.means._changes", lambda *_: None)
    other = assessed(**ON_THE_EDGE | {"restitution": 0.4995}, balls=1024)
    one = changes["r -0.1 %"]["height"]
    two = other.motion.mean_error["height"]
    nominal = found.motion.mean_error["height"]
    assert abs(one.value - two.value) < 0.1 * abs(two.value - nominal.value)


def with_changes(error, **heights):
    """Means of a law with an error of its own, and with errors of the linear contact."""
    both = {"a": Mean(1.0, 0.01), "b": Mean(1 + error, 0.01)}
    changes = {name.replace("_", " "): {"height": Mean(x, 0.001)} for name, x in heights.items()}
    return FinalMotion("chaotic", 0, 0, restitution_kind="chaotic", mean_height=both,
                       mean_power=both, mean_error={"height": Mean(error, 0.001)}, balls=256,
                       changes=changes)  # fmt: skip


def test_for_a_law_the_changes_of_the_linear_contact_are_added_to_its_own_error():
    """The linear contact changes from -4 % to 2 %, and the law so from 3 % to 9 %."""
    found = with_changes(0.03, no_change=-0.04, r=0.02)
    beyond = said_of_motion(judged_by_motion(found, 0.01, 1)).verdict
    assert beyond.startswith("The restitution model is not good")
    decided = said_of_motion(judged_by_motion(found, 0.05, 1))
    assert "at 5 % is decided by changes of 0.1 % in r, k or g" in decided.verdict
    assert "with the changes of the linear contact with this r and duration" in decided.verdict
    assert "-4 % ± 0.1 % with no change, +2 % ± 0.1 % with r" in decided.reason
    # Without a linear contact in its place they are errors of the contact itself.
    own = with_changes(0.03, r=0.02)
    assert "of the linear contact" not in said_of_motion(judged_by_motion(own, 0.025, 1)).verdict
    unknown = said_of_motion(judged_by_motion(replace(found, changes=None), 0.05, 1))
    assert "what changes of 0.1 % in r, k and g do is not known" in unknown.reason


@pytest.mark.long
def test_a_chaotic_mean_of_a_law_has_its_changes():
    given = {"mass": "50 g", "frequency": "25 Hz", "acceleration": "2 g", "n": 1}
    found = assessed(**given, law="tsuji", contact_time="0.7 ms", restitution=0.7)
    changes = found.motion.changes
    assert [*changes] == ["r -0.1 %", "r +0.1 %", "k +0.1 %", "g +0.1 %"]
    # Tsuji's r is the same at every speed, so that this contact is the changed one.
    other = assessed(**given, law="tsuji", contact_time="0.7 ms", restitution=0.7 * 0.999)
    one = changes["r -0.1 %"]["height"]
    two = other.motion.mean_error["height"]
    # The same contact by samples of different sizes.
    assert abs(one.value - two.value) < 1.5 * (one.half_width + two.half_width)


@pytest.mark.parametrize("law", ["hunt-crossley", "tsuji", "kuwabara-kono"])
def test_a_change_of_a_law_is_one_of_its_parameters_in_si_units(law):
    """At the speed of the impacts r changes alone, k is a factor of the force, and g is none."""
    given = {"law": law, "contact_time": "2 ms", "restitution": 0.7, "mass": "4 g"}
    table = Table(frequency="20 Hz", acceleration="2 g").motion
    case = resolve(Contact(**given), table)
    impacts = Starts(np.array([0.5, 1.0]), np.array([-3.0, -4.0]))
    speed = float(np.mean(2 * np.cos(impacts.phase) - impacts.velocity))
    changed = _changed(case, Ending(MotionName(Kind.CHAOTIC, 0, 0), impacts))
    assert [*changed] == ["r -0.1 %", "r +0.1 %", "k +0.1 %", "g +0.1 %"]
    before = case.law.signature(speed)
    for name, factor in {"r -0.1 %": 0.999, "r +0.1 %": 1.001, "k +0.1 %": 1.0}.items():
        after = changed[name].law.signature(speed)
        assert after.restitution == pytest.approx(factor * before.restitution, rel=1e-10)
        of_contact = changed[name].equivalent.restitution / case.equivalent.restitution
        assert of_contact == pytest.approx(factor, rel=1e-12)
    plain = case.law_in_si
    stiffer = changed["k +0.1 %"].law_in_si
    # Where r depends on k too, the damping that restores it takes a part of the duration.
    assert stiffer["stiffness"] / plain["stiffness"] - 1 == pytest.approx(1e-3, rel=0.1)
    heavier = changed["g +0.1 %"]
    same = heavier.law_in_si
    for name in ("stiffness", "damping"):
        assert same[name] == pytest.approx(plain[name], rel=1e-9)
    assert heavier.table.gravity == pytest.approx(1.001 * table.gravity, rel=1e-14)


@dataclass(frozen=True, repr=False)
class Stiffening(LinearHuntCrossley):
    """A law with a third number, which r and the duration of an impact do not determine."""

    more: float = 0.0

    units: ClassVar = LinearHuntCrossley.units | {"more": NUMBER}

    def force(self, penetration, rate):
        return (1 + self.more * penetration**2) * super().force(penetration, rate)


def test_the_linear_contact_stands_for_a_law_that_no_impact_determines():
    plain = Contact(mass=1, stiffness=1e5, restitution=0.7)
    case = resolve(plain, Table(frequency="20 Hz", acceleration="2 g").motion)
    case = replace(case, law=Stiffening(400.0, 0.1, 0.5))
    impacts = Starts(np.array([0.5]), np.array([-3.0]))
    changed = _changed(case, Ending(MotionName(Kind.CHAOTIC, 0, 0), impacts))
    assert "no change" in changed and all(each.is_linear for each in changed.values())


def test_an_impedance_is_changed_as_itself():
    soft = Contact(mass=1, from_engine="mujoco", solref="-1e4 -20")
    case = resolve(soft, Table(frequency="20 Hz", acceleration="2 g").motion)
    impacts = Starts(np.array([0.5]), np.array([-3.0]))
    changed = _changed(case, Ending(MotionName(Kind.CHAOTIC, 0, 0), impacts))
    assert [*changed] == ["r -0.1 %", "r +0.1 %", "k +0.1 %", "g +0.1 %"]
    before = case.law_in_si
    heavier = changed["g +0.1 %"].law_in_si
    assert heavier.pop("name") == before.pop("name") == "impedance"
    assert heavier == pytest.approx(before, rel=1e-8)
    stiffer = changed["k +0.1 %"].law_in_si
    assert stiffer["frequency_ratio"] / before["frequency_ratio"] == pytest.approx(1.0005, abs=5e-5)


def test_the_headline_is_about_the_motion_on_which_most_balls_end(without_changes, few_impacts):
    """The 5-T orbit is stable, and attracts less than one start in a hundred."""
    given = {"mass": "50 g", "frequency": "25 Hz", "acceleration": "2 g", "stiffness": 1e6}
    found = assessed(**given, restitution=0.8, balls=256)
    assert found.n == 5 and found.judged.is_stable and found.motion.kind == "chaotic"
    assert found.headline.startswith("Most balls end otherwise than on the stable 5-T orbit")
    assert found.starts["chaotic"] > 0.95 and sum(found.starts.values()) == pytest.approx(1)
    assert "of the starts end on the stable 5-T" in found.reason or "no start ends" in found.reason
    # The family that is asked for is judged.
    of_five = assessed(**given, restitution=0.8, n=5, balls=256)
    assert of_five.headline.startswith("The 5-T orbit is stable: a ball on it stays on it, but ")
    assert of_five.starts == found.starts


def test_a_small_sample_leaves_open_what_a_larger_one_decides(
    without_changes, few_starts, few_impacts
):
    # The larger one is in the test of changes of a thousandth.
    small = assessed(**ON_THE_EDGE, balls=256)
    assert "not decided" in small.verdict and small.motion.balls == 256


def test_beside_a_lap_that_rounding_errors_decide_on_the_interval_is_that_of_the_lap(
    without_changes, few_starts
):
    """In the restitution model a ball sticks again after 72 impacts, and has lost 14 digits."""
    given = {"mass": "20 g", "frequency": "50 Hz", "acceleration": "4 g", "restitution": 0.5}
    found = assessed(**given, stiffness="1e7 N/m").motion
    assert (found.restitution_kind, found.restitution_periods) == ("locked", 0)
    exact, simple = found.mean_height.values()
    assert exact.half_width == 0 and simple.half_width > 0.05 * simple.value
    # The mean over all laps is that of balls that are thrown after each rest with some digits less.
    model = RestitutionModel(0.5)
    random = np.random.default_rng(3)
    starts = Starts(random.uniform(-3, 3, 300), random.uniform(-20, -5, 300))
    dynamics, first = start(model, 4.0, starts)
    first, _ = advance(dynamics, first, 200)
    _, (time, height, _) = advance(dynamics, first, 800)
    length = 9.80665 / (2 * np.pi * 50) ** 2
    assert abs(simple.value - length * height.sum() / time.sum()) < simple.half_width


@pytest.mark.parametrize("balls", [0, 100_001, 2.5, "x"])
def test_a_number_of_balls_out_of_range_is_refused(balls):
    with pytest.raises(
        ModelError, match=r"\{?balls\}? = .* is not a whole number from 1 to 100000"
    ):
        assessed(**UNIT, stiffness=5000.0, acceleration=2.0, balls=balls)


def test_the_heights_of_a_motion_are_in_metres(few_starts):
    """The same dimensionless case in other units has heights in the ratio of the lengths g/Ω²."""
    given = {"acceleration": 1.1, "stiffness": 5000.0, "tolerance": "20 %"}
    unit = assessed(**UNIT, **given)
    omega = 2 * np.pi * 20
    real = {"mass": 0.3, "angular_frequency": omega, "restitution": 0.85, "n": 1}
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


def test_an_impedance_with_another_r_has_it_at_the_speed_of_its_impacts():
    law = Impedance(20.0, 0.15, 0.95, 0.9, width=0.3)
    impact = law.signature(2.0)
    for factor, longer, unit in ((1.001, 1.0, 1.0), (0.999, 1 / 1.001, 1.0), (1.0, 1.0, 1.001)):
        found = _law(law, 2.0, factor, longer, unit)
        again = found.signature(2.0 / unit)
        assert float(again.restitution / impact.restitution) == pytest.approx(factor, rel=1e-9)
        assert float(again.duration / impact.duration) == pytest.approx(longer, rel=1e-9)
        # The width in metres and the other numbers of solimp are those of the same contact.
        assert found.width == pytest.approx(0.3 / unit, rel=1e-14)
        assert (found.share, found.at_surface) == (0.95, 0.9)
    assert _law(law, 2.0) == law
