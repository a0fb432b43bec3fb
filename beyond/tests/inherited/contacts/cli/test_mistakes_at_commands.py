"""What a user types wrong at ``design``, and the one line that answers it.

There are other units, options of other commands, words of textbooks and slips of the keyboard. The
ways of refusing a contact are in ``test_mistakes_at_design.py``. In the table each mistake is
followed by the beginning of its answer, and behind ``…`` by its end. ``BALL`` and ``TABLE`` stand
for a contact that is given, and for a table.
"""

import shlex

import pytest
from mistakes_at_commands import answered, rows

SHORT = {
    "BALL": '--mass "20 g" --stiffness 1e6 --restitution 0.8',
    "TABLE": '--frequency "50 Hz" --acceleration "0.8 g"',
}
MISTAKES = """
design BALL --plot ""
    argument --plot: the name is empty
design BALL TABLE --cor 0.7
    unrecognized arguments: --cor 0.7; did you mean --restitution?
design --mass "20 g" --k 1e6 --restitution 0.8
    unrecognized arguments: --k 1e6; did you mean --stiffness?
design --weight "20 g" --stiffness 1e6 --restitution 0.8
    unrecognized arguments: --weight 20 g; did you mean --mass?
design -mass "20 g" --stiffness 1e6 --restitution 0.8
    unrecognized arguments: -mass 20 g; did you mean --mass?
design --mass "20 g" --diameter "5 mm" --restitution 0.8
    unrecognized arguments: --diameter 5 mm; did you mean --radius, half of it?
design --mass "20 g" --stiffness "1e6 Nm" --restitution 0.8
    --stiffness = 1e6 Nm is in newton times meter: did you mean '1e6 N/m'?
design --mass "20 g" --stiffness "1.000.000 N/m" --restitution 0.8
    --stiffness = 1.000.000 N/m is not one number and a unit: write numbers such as 1500, 0.5 or 1e6
design --mass "20 ± 1 g" --stiffness 1e6 --restitution 0.8
    --mass = 20 ± 1 g is not one number and a unit: write numbers such as 1500, 0.5 or 1e6
design --mass "20 g" --stiffness "1e5-1e6 N/m" --restitution 0.8
    --stiffness = 1e5-1e6 N/m is not one number and a unit: write numbers such as 1500, 0.5 or 1e6
design --mass "20 g" --stiffness 1e6 --damping "10 Ns/m"
    --damping = 10 Ns/m has an unknown unit: did you mean '10 N s/m'?
design --mass 1e6 --stiffness "20 g" --restitution 0.8
    --stiffness = 20 g is in gram, not in N/m: write it as '1e6 N/m'
design BALL --frequency "0.8 g" --acceleration "50 Hz"
    --frequency = 0.8 g is in gram, not in Hz: write it as '50 Hz'
design BALL TABLE --json page.json
    unrecognized arguments: page.json: --json takes no value
design BALL TABLE --all 3
    unrecognized arguments: 3: --all takes no value
design --mass "20 g" --from lammps --set kn=1e5,gamma_n=80
    argument --set: 'kn=1e5,gamma_n=80' is not NAME=NUMBER … repeat the option for each parameter
design --mass "20 g" --from lammps --set kn==1e5
    argument --set: 'kn==1e5' is not NAME=NUMBER, such as stiffness=1000: did you mean kn=1e5?
design --mass "20 g" --from mujoco --set solref=0.02
    --set solref=0.02 gives one number, and solref has two: give --solref, such as '0.02 0.5'
design --mass "20 g" --from mujoco --solref 0.02
    solref = '0.02' is not 2 numbers: '0.02 0.5' (s, damping ratio) or '-1e4 -20' (-k/m, -c/m)
design --mass "20 g" --from lammps --set kn=100kN --set gamma_n=80
    argument --set: 'kn=100kN' is not NAME=NUMBER, such as stiffness=1000: give it without
design BALL TABLE --table-amplitude "1 mm"
    --table-amplitude and --acceleration contradict each other, because each gives the
"""


@pytest.mark.parametrize(("typed", "says"), rows(MISTAKES))
def test_a_mistake_is_answered_by_one_line(refused, typed, says):
    status, _ = answered(refused, typed, says, SHORT)
    assert status == 2


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        (
            "design --mass 1 --stiffness 1e6 --restitution 0.8 --gravity 981",
            "Note: gravity 981 was read as 981 m/s^2: write a unit",
        ),
    ],
)
def test_a_number_that_is_large_in_si_units_is_answered_with_a_note(said, typed, says):
    assert says in said(*shlex.split(typed))
