"""What a new user types wrong at ``bouncing-ball design``, and the one line that answers it.

There is one mistake for each way of refusing; ``tests/test_random_mistakes.py`` draws many. In the
table each mistake is followed by the beginning of its answer. ``BALL`` and ``TABLE`` stand
for a contact that is given, and for a table, ``CROSSLEY`` and ``BULLET`` for parameters of engines.
"""

import shlex

import pytest

BALL = '--mass "20 g" --stiffness 1e6 --restitution 0.8'
TABLE = '--frequency "50 Hz" --acceleration "0.8 g"'
CROSSLEY = "--mass 1 --from drake --set point_contact_stiffness=1e5"
CROSSLEY += " --set hunt_crossley_dissipation=1"
BULLET = "--mass 1 --from pybullet --set contactStiffness=1e5 --set contactDamping=1"
SHORT = {"BALL": BALL, "TABLE": TABLE, "CROSSLEY": CROSSLEY, "BULLET": BULLET}
MISTAKES = """
--mass 20
    the frequency of the table is missing: give --frequency, such as 50 Hz
--mass "20g" --frequency "50" --acceleration "0.8" --stiffness 1e6 --restitution 0.85 --n 1
    no 1-T orbit in any model, and a ball laid on the table stays at rest: the table's
--mass "20 grams" --stiffness 1e6 --restitution 1.85
    --restitution = 1.85 is not a number in (0, 1]
--mass "20 gr" --stiffness 1e6 --restitution 0.85
    --mass = 20 gr is in grains, or in no unit of mass: did you mean '20 g'?
--mass "twenty" --stiffness 1e6 --restitution 0.85
    --mass = 'twenty' does not begin with a number: write it as '20 g'
--mass "20 g" --stiffness "1e6 N" --restitution 0.85
    --stiffness = 1e6 N is in newton, not in N/m: did you mean '1e6 N/m'?
--mass "20 g" --stiffness "1e7 N" --restitution 0.85
    --stiffness = 1e7 N is in newton, not in N/m: did you mean '1e7 N/m'?
--mass "20 g" --stiffness 1e6 --damping "10 N s"
    --damping = 10 N s is in newton * second, not in N s/m: did you mean '10 N s/m'?
--mass "20 g" --stiffness "1 MN/M" --restitution 0.85
    --stiffness = 1 MN/M is in meganewton / molar, not in N/m: did you mean '1 MN/m'?
--mass "20 g" --stiffness 1e6 --restitution 85
    --restitution = 85 is not a number in (0, 1]: did you mean 85 %?
--mass "20 g" --stiffness 1e6 --damping-ratio 1.5
    --damping-ratio = 1.5 is too large: near the critical damping 1 and above it the ball does
--mass "20 g" --stiffness 1e6 --drop-height "1 m"
    --rebound-height and --drop-height are needed together
--mass "20 g" --stiffness 1e6 --drop-height "1 m" --rebound-height "1.2 m"
    --rebound-height 1.2 m is above --drop-height 1 m
--mass "20 g" --contact-time 5 --stiffness 100 --restitution 0.8
    --stiffness and --contact-time contradict each other, because each gives the stiffness of the
--mass "20 g" --frequency "50 1/s" --acceleration "0.8 g" --stiffness 1e6 --restitution 0.8
    --frequency = 50 1/s does not say whether it counts turns or radians: write '50 Hz' or
--mass "20 g" --frequency "50 hertz" --acceleration "0.8g's" --stiffness 1e6 --restitution 0.8
    --acceleration = 0.8g's has an unknown unit: write it as '2 g'
--mass "20 g" --frequency "50 Hz" --amplitude "1 mm" --stiffness 1e6 --restitution 0.8
    unrecognized arguments: --amplitude 1 mm; did you mean --table-amplitude?
--mass "20 g" --stiffness "2*10^6 N/m" --restitution 0.8
    --stiffness = 2*10^6 N/m is not one number and a unit: write numbers such as 1500, 0.5 or 1e6
--mass "20 g" --stiffness 1e6 --damping -5
    --damping = -5 N s/m is negative
--mass "20 g" --kn 1e5 --restitution 0.8
    unrecognized arguments: --kn 1e5: it is a parameter of lammps: --from lammps --set kn=NUMBER
--mass "20 g" --from lammps --set Kn=1e5 --set gamma_n=1
    lammps has no 'Kn': its parameters are kn and gamma_n; did you mean kn?
--mass "20 g" --from newton-mujoco --set ke=1e6 --set kd=0
    kd = 0 of newton-mujoco is no contact without damping, but the default of MuJoCo: kd is c/m in
BALL TABLE --release Force
    argument --release: invalid choice: 'Force' (choose from 'displacement', 'force', 'approach');
BALL TABLE --law Hertz
    --law Hertz has no damper: Hertz's spring with a damper is --law tsuji, or give --radius and
BALL TABLE --law Hertz --release force
    --law Hertz has no damper: Hertz's spring with a damper is --law tsuji, or give --radius and
--mass "20 g" TABLE --contact-time "1 ms" --restitution 0.8 --law Tsuji
    unknown contact law 'Tsuji': one of hunt-crossley, hunt-crossley-linear, tsuji,
--mass "20 g" TABLE --radius "5 mm" --restitution 0.8
    --radius of a Hertz contact needs --reduced-modulus, or --youngs-modulus and the other data
--mass "20 g" TABLE --radius "5 mm" --youngs-modulus "210 GPa" --restitution 0.8
    --youngs-modulus needs --poissons-ratio and --table-youngs-modulus and
--mass "20 g" TABLE --radius "5 mm" --reduced-modulus 115 --restitution 0.8
    --reduced-modulus = 115 is in Pa, and no solid is so soft: did you mean 115 GPa?
BALL --frequency "1e-6 Hz" --acceleration "0.8 g"
    ϖ = 1.125e+09, the natural frequency of the contact over that of the table, is not between
--mass "20 g" --from mujoco --solimp "1e-4"
    solref is missing: give it, such as the default of MuJoCo, '0.02 1'
--mass "20 g" --from mujoco --solref "0.02,1"
    solref = '0.02,1' is not 2 numbers: write it without commas, '0.02 1'
--mass "20 g" --from mujoco --solref "0.02 0"
    solref = '0.02 0' is neither two negative numbers, -k/m and -c/m, nor two positive ones, a
--mass "20 g" --from mujoco --solref "0.02 1" --solimp "2 3"
    solimp has the impedance 2, which is not in [0, 1]
--mass "20 g" --solref "0.02 1"
    --solref needs --from, the name of the engine
--mass "20 g" --from lammps --set kn
    argument --set: 'kn' is not NAME=NUMBER, such as stiffness=1000
--mass "20 g" --from lammps --set kn=1e5
    gamma_n is missing: the parameters of lammps are kn and gamma_n
--mass "20 g" --from lammps --set KN=1e5 --set gamma_n=1
    lammps has no 'KN': its parameters are kn and gamma_n
--mass "20 g" --from lammps --set kn=-1e5 --set gamma_n=1
    kn = -100000.0 is not a number of at least 0
BALL --plot page
    'page' does not end in .pdf or .png or .svg
--mass 20 g --stiffness 1e6 --restitution 0.8
    unrecognized arguments: g: a value with a space is one argument in quotes, such as "20 g"
BALL --json --plot
    argument --plot: expected one argument
-m 20
    unrecognized arguments: -m 20; did you mean --mass?
--mass "1/0 kg" --stiffness 1e6 --restitution 0.8
    --mass = 1/0 kg is divided by 0
--mass "1/2/3 kg" --stiffness 1e6 --restitution 0.8
    --mass = 1/2/3 kg is not one number and a unit: write numbers such as 1500, 0.5 or 1e6
CROSSLEY --set relaxation_time=0.01
    relaxation_time and hunt_crossley_dissipation are the dampings of two contacts of drake: give
--mass "20 g" --from isaaclab --set compliantContactStiffness=1e5
    compliantContactDamping is missing: the parameters of physx are compliantContactStiffness and
--mass "20 µg" --frequency "50 Hz" --acceleration "1000000000 g" --stiffness 1e6 --restitution 0.8
    Λ = 1000000000.0 is not below 1e+08
--mass "20 g" --stiffness "1,500 N/m" --restitution 0.8
    --stiffness = 1,500 N/m has a comma: write '1.500 N/m' with a decimal point, or without
mass="20 g" --frequency "50 Hz"
    unrecognized arguments: mass=20 g; did you mean --mass?
--mass "20 g" --stiffness "1 000 000 N/m" --restitution 0.8
    --stiffness = 1 000 000 N/m is not one number and a unit: write numbers such as 1500, 0.5 or 1e6
BALL TABLE --tolerance "1 %%"
    --tolerance = 1 %% has an unknown unit: write it as '1 %'
--mass -1 --stiffness 1e6 --restitution 0.8
    --mass = -1 kg is not a positive number
--mass "20 g" --stiffness 1e6 --restitution 1.5
    --restitution = 1.5 is not a number in (0, 1]
--mass "20 g" --law hunt-crossley --restitution 0.8 --speed "1 m/s"
    --law hunt-crossley needs --contact-time, the duration of a free impact
--mass "20 g" --law hunt-crossley --restitution 0.8 --contact-time "1 ms"
    --law needs a table, such as --frequency and --acceleration, or --speed of an impact: r depends
--mass "20 g" --from pybullet --set restitution=0.9
    restitution of pybullet has no stiffness: if ball and table have it, r = 0.81 with small steps
--mass "20 g" --from mujoco --solref "1000 10"
    solref = '1000 10' is a time constant of 1000 s, which no simulation has: -k/m and -c/m are
--mass "20 g" --stiffness 1e-9 --restitution 0.8
    a contact of 14.09 ks is longer than any that is simulated, up to 1000 s: check the mass
--mass "20 g" --restitution 0.8 TABLE --tolerance 1e-9
    no contact up to ϖ = 1e+06 has its greatest height predicted within 1e-07 % by the restitution
--mass "20 g" --drop-height 1 --rebound-height 70 --stiffness 1e6
    --rebound-height 70 m is above --drop-height 1 m
--mass "20 g" --from lammps --set kn=1e5 --set gamma_n=80 --stiffness 5
    --stiffness is not allowed with --from
--mass "20 g" --law hunt-crossley --contact-time "1 ms" --restitution 0.001 --speed 1
    restitution coefficient r = 0.001 is too small: no hunt-crossley contact with it was found
--mass "20 g" --from mujoco --solref "[-10000, -20]"
    solref = '[-10000, -20]' is not 2 numbers: write it plainly, '-10000 -20'
""".strip().splitlines()
ROWS = [(typed, says.strip()) for typed, says in zip(MISTAKES[::2], MISTAKES[1::2], strict=True)]


@pytest.mark.parametrize(("typed", "says"), ROWS)
def test_a_mistake_is_answered_by_one_line(refused, typed, says):
    for name, options in SHORT.items():
        typed = typed.replace(name, options)
    status, line = refused("design", *shlex.split(typed))
    assert line.startswith(f"bouncing-ball: {says}")
    is_without_answer = "no 1-T orbit" in line or "no contact up to" in line
    assert status == (1 if is_without_answer else 2)


UNUSUAL = """
--mass "20 g" --contact-time 7 --restitution 0.8
    contact time 7 was read as 7 s: write a unit, such as '50 us', if another one was meant
--mass "20 g" --radius 5 --stiffness 1e6 --restitution 0.8
    radius 5 was read as 5 m: write a unit, such as '5 mm', if another one was meant
BALL --frequency 50 --table-amplitude 0.1 --n 1
    table amplitude 0.1 was read as 0.1 m: write a unit, such as '0.1 mm', if another one was
BALL --speed 1000
    speed 1000 was read as 1000 m/s: write a unit, such as '1 m/s', if another one was meant
--mass 20000 --stiffness 1e6 --restitution 0.8
    mass 20000 was read as 20000 kg: write a unit, such as '20 g', if another one was meant
--mass "20 g" --radius "5 m" --stiffness 1e6 --restitution 0.8
    radius 5 m is unusually large: check its unit, as in '5 mm'
BALL --frequency "0.3 Hz" --table-amplitude "5 m" --n 1
    table amplitude 5 m is unusually large: check its unit, as in '0.1 mm'
--mass "20 g" --contact-time "1 ms" --drop-height "200 km" --rebound-height "100 km"
    drop height 200 km is unusually large: check its unit, as in '1 m'
BALL --frequency "50 Hz" --table-amplitude "100 mm" --n 1
    the table accelerates with Λ = 1006 times gravity, which no shaker reaches: check its frequency
--mass "20 g" --stiffness 10 --restitution 0.8 --radius "5 mm"
    at rest the ball sinks in by 19.61 mm, 392 % of its radius: its centre passes the table, where
--mass "20 g" --stiffness 50 --restitution 0.5 --speed "0.1 m/s"
    gravity rules this contact: the ball does not rebound, it rests 3.923 mm deep
--mass "20 g" --stiffness 1000 --restitution 0.5 --speed "0.3 m/s"
    gravity rules this contact: √(h′/h) is 23 % below the r of a free impact, 0.5, and the ball
""".strip().splitlines()
DOUBTS = [(typed, says.strip()) for typed, says in zip(UNUSUAL[::2], UNUSUAL[1::2], strict=True)]


@pytest.mark.usefixtures("short_runs")
@pytest.mark.parametrize(("typed", "says"), DOUBTS)
def test_what_is_unusual_is_answered_with_a_note(said, typed, says):
    for name, options in SHORT.items():
        typed = typed.replace(name, options)
    assert f"Note: {says}" in said("design", *shlex.split(typed))
