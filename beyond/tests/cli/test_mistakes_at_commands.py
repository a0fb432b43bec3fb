"""What a user types wrong at any of beyond's commands, and the one line that answers it.

There are other units, options of other commands, words of textbooks and slips of the keyboard. In
the table each mistake is followed by the beginning of its answer, and behind ``…`` by its end.
``DOUBLINGS`` stands for the kind of a curve.
"""

import pytest
from mistakes_at_commands import answered, rows

SHORT = {"DOUBLINGS": "--kind period-doubling"}
MISTAKES = """
law-limits
    one of the arguments --restitution --damping-ratio --measured-restitution is required
law-limits --restitution 85%
    argument --restitution: '85%' is not a number in [0, 1]: did you mean 0.85?
law-limits --restitution 0.85 --n 1.5
    argument --n: '1.5' is not a whole number from 1 to 1000
law-limits --damping-ratio 0.05
    --damping-ratio needs --frequency-ratio; --model restitution takes --restitution
law-limits --restitution 0.85 --frequency "50 Hz"
    unrecognized arguments: --frequency 50 Hz; did you mean --frequency-ratio?
law-limits --restitution 0.85 --frequency-ratio 10 Hz
    unrecognized arguments: Hz: numbers of law-limits have no unit
law-limits --restitution 0.85 --amplitude 1
    unrecognized arguments: --amplitude 1: it is an option of
law-limits —restitution 0.85
    unrecognized arguments: —restitution 0.85; did you mean --restitution?
law-limits -r 0.85
    unrecognized arguments: -r 0.85; did you mean --restitution?
law-limits --restitution 0.85 --json=yes
    argument --json: it takes no value, not 'yes'
law-limits --law tsuji --restitution 0.85 --duration "1 ms"
    argument --duration: '1 ms' is not a number in [1e-12, 1e+08]: give it without a unit
law-orbit --amplitude "1 g" --restitution 0.85
    argument --amplitude: '1 g' is not a number in [1e-12, 1e+08]: give it without a unit
law-orbit --amplitude 0.1 --restitution 0.85
    no 1-T orbit at Λ = 0.1 for r = 0.85: below the saddle-node at Λ = 0.254724
law-orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10 --side left
    argument --side: invalid choice: 'left'
law-orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10 --model restitution
    --frequency-ratio has no meaning for --model restitution, which has no contact
motion --amplitude 1.1 1.2 --restitution 0.85
    unrecognized arguments: 1.2: --amplitude takes one value
motion --amplitude 1.1 --restitution 0.85 --velocity 4
    a ball that rises from the table has no impact: its velocity z′ = 4 is above that of
motion --amplitude 1.1 --restitution 0.85 --phase 90deg --velocity -4
    argument --phase: '90deg' is not a number in [-1e+08, 1e+08]: give it without a unit
law-simulate --amplitude 1 --restitution 0.85 --velocity -3 m/s
    unrecognized arguments: m/s: numbers of law-simulate have no unit
diagram --amplitude 0.9,1.1 --points 5 --restitution 0.85
    argument --amplitude: expected 2 arguments, FROM and TO, with a space between them
diagram --amplitude 0.9 1.1 1.3 --points 5 --restitution 0.85
    unrecognized arguments: 1.3: --amplitude takes 2 values
diagram --amplitude 1.1 0.9 --points 5 --restitution 0.85
    --amplitude 1.1 0.9: the second must be larger
error-law --amplitude 1 --restitution 0.65 --frequency-ratio 10
    unrecognized arguments: --frequency-ratio 10: it is an option of
follow --amplitude 1 --restitution 0.85 --to 2 --along frequency-ratio
    --along frequency-ratio needs --frequency-ratio of a contact, from which it starts
follow --amplitude 1 --restitution 0.85 --to 1.5 --along restitution
    --to = 1.5 is not a number in [0, 1]
curve --amplitude 1 --restitution 0.85 --frequency-ratio 10 --to 1.3 --across amplitude
    --across amplitude is that of --along: give another parameter
curve --amplitude 1 --restitution 0.85 --to 1.3 --across damping-ratio
    --across damping-ratio needs --frequency-ratio of a contact, from which it starts
curve --amplitude 1 --restitution 0.85 --to 1.3 DOUBLINGS --across restitution --low 0.9 --high 0.1
    the range of restitution = (0.9, 0.1) is not two numbers of which the second is larger
follow --amplitude 1 --restitution 0.85 --to 1.3 --plot ""
    argument --plot: the name is empty
law-orbit --amplitude 1 --law tsuji --set stiffness=9,c=1
    argument --set: 'stiffness=9,c=1' is not NAME=NUMBER … repeat the option for each parameter
law-orbit --amplitude 1 --law tsuji --set stiffness=9N --set damping=1
    argument --set: 'stiffness=9N' is not NAME=NUMBER, such as stiffness=1000: give it without
law-orbit --amplitude 1 --law tsuji --set stiffness=9 --set stiffness=8
    argument --set: stiffness is given twice
"""


@pytest.mark.parametrize(("typed", "says"), rows(MISTAKES))
def test_a_mistake_is_answered_by_one_line(refused, typed, says):
    status, line = answered(refused, typed, says, SHORT)
    is_without_answer = "no 1-T orbit" in line
    assert status == (1 if is_without_answer else 2)
