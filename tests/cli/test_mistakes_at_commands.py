"""What a user types wrong at any of the commands, and the one line that answers it.

There are other units, options of other commands, words of textbooks and slips of the keyboard. The
ways of refusing a contact are in ``test_mistakes_at_design.py``. In the table each mistake is
followed by the beginning of its answer, and behind ``…`` by its end. ``BALL`` and ``TABLE`` stand
for a contact that is given, and for a table, and ``DOUBLINGS`` for the kind of a curve.
"""

import shlex

import pytest

SHORT = {
    "BALL": '--mass "20 g" --stiffness 1e6 --restitution 0.8',
    "TABLE": '--frequency "50 Hz" --acceleration "0.8 g"',
    "DOUBLINGS": "--kind period-doubling",
}
MISTAKES = """
limits
    one of the arguments --restitution --damping-ratio --measured-restitution is required
limits --restitution 85%
    argument --restitution: '85%' is not a number in (0, 1]: did you mean 0.85?
limits --restitution 0.85 --n 1.5
    argument --n: '1.5' is not a whole number from 1 to 1000
limits --damping-ratio 0.05
    --damping-ratio needs --frequency-ratio; --model restitution takes --restitution
limits --restitution 0.85 --frequency "50 Hz"
    unrecognized arguments: --frequency 50 Hz; did you mean --frequency-ratio?
limits --restitution 0.85 --frequency-ratio 10 Hz
    unrecognized arguments: Hz: numbers of limits have no unit
limits --restitution 0.85 --amplitude 1
    unrecognized arguments: --amplitude 1: it is an option of orbit, error-law, follow,
limits —restitution 0.85
    unrecognized arguments: —restitution 0.85; did you mean --restitution?
limits -r 0.85
    unrecognized arguments: -r 0.85; did you mean --restitution?
limits --restitution 0.85 --json=yes
    argument --json: it takes no value, not 'yes'
limits --law tsuji --restitution 0.85 --duration "1 ms"
    argument --duration: '1 ms' is not a number in [1e-12, 1e+08]: give it without a unit
limits --restitution 0.85 --certify
    --certify needs --frequency-ratio: it is for spring-damper contacts
limit --restitution 0.85
    argument command: invalid choice: 'limit' … did you mean limits?
orbit --amplitude "1 g" --restitution 0.85
    argument --amplitude: '1 g' is not a number in [1e-12, 1e+08]: give it without a unit
orbit --amplitude 0.1 --restitution 0.85
    no 1-T orbit at Λ = 0.1 for r = 0.85: below the saddle-node at Λ = 0.254724
orbit --amplitude 1 --stiffness 1e6 --restitution 0.85
    unrecognized arguments: --stiffness 1e6: it is an option of design
orbit --amplitude 1 --mass "20 g" --restitution 0.85
    unrecognized arguments: --mass 20 g: it is an option of design and fit
orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10 --side left
    argument --side: invalid choice: 'left'
orbit --amplitude 1 --restitution 0.85 --frequency-ratio 10 --model restitution
    --frequency-ratio has no meaning for --model restitution, which has no contact
motion --amplitude 1.1 1.2 --restitution 0.85
    unrecognized arguments: 1.2: --amplitude takes one value
motion --amplitude 1.1 --restitution 0.85 --velocity 4
    a ball that rises from the table has no impact: its velocity z′ = 4 is above that of
motion --amplitude 1.1 --restitution 0.85 --phase 90deg --velocity -4
    argument --phase: '90deg' is not a number in [-1e+08, 1e+08]: give it without a unit
motion --amplitude 1.1 --restitution 0.85 --tolerance 0.1
    unrecognized arguments: --tolerance 0.1: it is an option of design
simulate --amplitude 1 --restitution 0.85 --velocity -3 m/s
    unrecognized arguments: m/s: numbers of simulate have no unit
diagram --amplitude 0.9,1.1 --points 5 --restitution 0.85
    argument --amplitude: expected 2 arguments, FROM and TO, with a space between them
diagram --amplitude 0.9 1.1 1.3 --points 5 --restitution 0.85
    unrecognized arguments: 1.3: --amplitude takes 2 values
diagram --amplitude 1.1 0.9 --points 5 --restitution 0.85
    --amplitude 1.1 0.9: the second must be larger
error-law --amplitude 1 --restitution 0.65 --frequency-ratio 10
    unrecognized arguments: --frequency-ratio 10: it is an option of orbit, limits,
permanent_contact --restitution 0.65 --frequency-ratio 6
    argument command: invalid choice: 'permanent_contact' … did you mean permanent-contact?
follow --amplitude 1 --restitution 0.85 --to 2 --along frequency-ratio
    --along frequency-ratio needs --frequency-ratio of a contact, from which it starts
follow --amplitude 1 --restitution 0.85 --to 1.5 --along restitution
    --to = 1.5 is not a number in (0, 1]
curve --amplitude 1 --restitution 0.85 --frequency-ratio 10 --to 1.3 --across amplitude
    --across amplitude is that of --along: give another parameter
curve --amplitude 1 --restitution 0.85 --to 1.3 --across damping-ratio
    --across damping-ratio needs --frequency-ratio of a contact, from which it starts
curve --amplitude 1 --restitution 0.85 --to 1.3 DOUBLINGS --across restitution --low 0.9 --high 0.1
    the range of restitution = (0.9, 0.1) is not two numbers of which the second is larger
fit ""
    the name of the file is empty
explain ""
    argument FILE: the name is empty
diff "" ""
    argument NAMES: the name is empty
diff . figures --html ""
    argument --html: the name is empty
design BALL --plot ""
    argument --plot: the name is empty
follow --amplitude 1 --restitution 0.85 --to 1.3 --plot ""
    argument --plot: the name is empty
fit croqet
    croqet is neither a file nor an experiment of the package: … did you mean croquet?
fit croquet --frequency 50 Hz
    unrecognized arguments: Hz: a value with a space is one argument in quotes, such as "20 g"
fit croquet --frequency "50 mm"
    --frequency = 50 mm is in millimeter, not in Hz: write it as '50 Hz'
fit croquet --law hertz
    unrecognized arguments: --law hertz: it is an option of orbit, limits, follow, curve,
fit croquet golf_ball
    unrecognized arguments: golf_ball: see bouncing-ball fit --help
--mass "20 g" --stiffness 1e6 --restitution 0.8
    a command is missing before --mass, one of orbit, limits, error-law
version
    argument command: invalid choice: 'version' … did you mean --version?
help design
    argument command: invalid choice: 'help' … did you mean --help?
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
design BALL TABLE --engine mujoco lammps
    unrecognized arguments: lammps: --engine takes one value
design --mass "20 g" --from lammps --set kn=1e5,gamma_n=80
    argument --set: 'kn=1e5,gamma_n=80' is not NAME=NUMBER … repeat the option for each parameter
design --mass "20 g" --from lammps --set kn=100kN --set gamma_n=80
    argument --set: 'kn=100kN' is not NAME=NUMBER, such as stiffness=1000: give it without
design BALL TABLE --table-amplitude "1 mm"
    --table-amplitude and --acceleration contradict each other, because each gives the
""".strip().splitlines()
ROWS = [(typed, says.strip()) for typed, says in zip(MISTAKES[::2], MISTAKES[1::2], strict=True)]


@pytest.mark.parametrize(("typed", "says"), ROWS)
def test_a_mistake_is_answered_by_one_line(refused, typed, says):
    for name, options in SHORT.items():
        typed = typed.replace(name, options)
    status, line = refused(*shlex.split(typed))
    beginning, _, end = says.partition(" … ")
    assert line.startswith(f"bouncing-ball: {beginning}") and line.endswith(end)
    is_without_answer = "no 1-T orbit" in line
    assert status == (1 if is_without_answer else 2)


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        ("fit croquet --contact-time 5", "Contact time 5 was read as 5 s: write a unit"),
        ("fit croquet --mass 0.45 --diameter 92", "Diameter 92 was read as 92 m: write a unit"),
        (
            'fit croquet --mass 0.45 --diameter "92 m"',
            "Diameter 92 m is unusually large: check its unit",
        ),
        (
            "design --mass 1 --stiffness 1e6 --restitution 0.8 --gravity 981",
            "Note: gravity 981 was read as 981 m/s^2: write a unit",
        ),
    ],
)
def test_a_number_that_is_large_in_si_units_is_answered_with_a_note(said, typed, says):
    assert says in said(*shlex.split(typed))
