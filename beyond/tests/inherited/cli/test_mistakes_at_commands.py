"""What a user types wrong at any of the commands, and the one line that answers it.

In the table each mistake is followed by a part of its answer.
"""

import shlex

import pytest
from mistakes_at_commands import rows

MISTAKES = """
""
    a command is missing, one of orbit, limits, branch
--restitution 0.8
    a command is missing before --restitution, one of orbit, limits
version
    argument command: invalid choice: 'version'
help
    ; did you mean --help?
orbit --amplitude 1
    --restitution --damping-ratio --measured-restitution is required
orbit --restitution 0.85
    required: --amplitude
orbit --damping-ratio 0.1 --amplitude 1
    --damping-ratio needs --frequency-ratio; --model restitution takes --restitution
ORBIT --damping-ratio 0.1
    --damping-ratio: not allowed with argument --restitution
ORBIT --model spring-damper
    --model spring-damper needs --frequency-ratio
ORBIT --model restitution --frequency-ratio 3
    --frequency-ratio has no meaning for --model restitution, which has no contact
ORBIT --release force
    --release has no meaning for --model restitution
ORBIT --model corrected
    invalid choice: 'corrected' (choose from 'restitution', 'spring-damper')
ORBIT --side all --index 2
    not allowed with argument --side
ORBIT --tension 1
    unrecognized arguments: --tension 1: see bouncing-ball orbit --help
ORBIT --frequency 50
    arguments: --frequency 50; did you mean --frequency-ratio?
ORBIT --impacts 3
    unrecognized arguments: --impacts 3: it is an option of simulate
ORBIT 2
    unrecognized arguments: 2: --amplitude takes one value
ORBIT --frequency-ratio 9 --release Force
    invalid choice: 'Force' (choose from 'displacement', 'force'); did you mean force?
orbit --amplitude 1g --restitution 0.5
    '1g' is not a number in [1e-12, 1e+08]: give it without a unit
orbit --amplitude 1 --restitution 85
    not a number in [0, 1]: did you mean 0.85?
limits --restitution 85%
    not a number in [0, 1]: did you mean 0.85?
limits --restitution 0.85 --n 1.5
    '1.5' is not a whole number from 1 to 1000
ORBIT --n 2.0
    '2.0' is not a whole number from 1 to 1000: did you mean 2?
limits --cor 0.85
    unrecognized arguments: --cor 0.85; did you mean --restitution?
limits --zeta 0.1 --omega 10
    ; did you mean --damping-ratio?
orbit --amplitude 9 --frequency-ratio 10 --measured-restitution 0.1 --release force
    r = 0.1 is not in (e⁻², 1]
simulate --restitution 0.5 --amplitude 1 --velocity 9
    rises from the table has no impact: its velocity z′ = 9 is above that of the table, w′ = 1
simulate --restitution 0.5 --amplitude 1 --impacts 0
    argument --impacts: '0' is not a whole number from 1
permanent-contact --restitution 0.5
    required: --frequency-ratio
thresholds --amplitude 1
    required: --restitution
thresholds --restitution 0.5 --amplitude 1 --tolerance 1%
    argument --tolerance: '1%' is not a number
branch --restitution 0.5 --amplitude-max -1
    argument --amplitude-max: '-1' is not a number
ORBIT --json page.json
    unrecognized arguments: page.json: --json takes no value
explain fig99
    fig99 cannot be read: no such file
diff figures
    nothing to compare in figures/results: neither figures/ nor a text
"""


@pytest.mark.parametrize(("typed", "says"), rows(MISTAKES))
def test_a_mistake_is_answered_by_one_line(refused, typed, says):
    typed = typed.strip('"').replace("ORBIT", "orbit --restitution 0.85 --amplitude 1")
    status, line = refused(*shlex.split(typed))
    assert line.startswith("bouncing-ball: ") and says in line
    assert status == 2
