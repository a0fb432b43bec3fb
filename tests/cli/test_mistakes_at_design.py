"""What a new user types wrong at ``bouncing-ball design``, and the one line that answers it.

In the table each mistake is followed by the beginning of its answer. ``BALL`` and ``TABLE`` stand
for a contact that is given, and for a table.
"""

import shlex

import pytest

BALL = '--mass "20 g" --stiffness 1e6 --restitution 0.8'
TABLE = '--frequency "50 Hz" --acceleration "0.8 g"'
MISTAKES = """
--mass 20
    the frequency of the table is missing: give --frequency, such as 50 Hz
--mass "20 g" --frequency "50 Hz"
    the amplitude of the table is missing: give --acceleration, such as 2 g, or
--mass "20 g" TABLE
    the loss of the contact is missing: give one of --damping, --damping-ratio, --restitution,
--mass "20g" --frequency "50" --acceleration "0.8" --stiffness 1e6 --restitution 0.85 --n 1
    no 1-T orbit in any model, and a ball laid on the table stays at rest: the table's
--mass "20 grams" --stiffness 1e6 --restitution 1.85
    --restitution = 1.85 is not a number in (0, 1]
--mass "20 gr" --stiffness 1e6 --restitution 0.85
    --mass = 20 gr is in grains, or in no unit of mass: did you mean '20 g'?
--mass "twenty" --stiffness 1e6 --restitution 0.85
    --mass = 'twenty' does not begin with a number: write it as '20 g'
--mass "" --stiffness 1e6 --restitution 0.85
    --mass = '' does not begin with a number: write it as '20 g'
--mass "20 g" --stiffness "1e6 N" --restitution 0.85
    --stiffness = 1e6 N is in newton, not in N/m: write it as '1e6 N/m'
--mass "20 g" --stiffness "1e6 N/mm2" --restitution 0.85
    --stiffness = 1e6 N/mm2 is in newton / millimeter ** 2, not in N/m: write it as '1e6 N/m'
--mass "20 g" --stiffness "1 MN/M" --restitution 0.85
    --stiffness = 1 MN/M is in meganewton / molar, not in N/m: did you mean '1 MN/m'?
--mass "20 g" --stiffness "-1e6" --restitution 0.85
    --stiffness = -1e+06 N/m is not a positive number
--mass "20 g" --stiffness 0 --restitution 0.85
    --stiffness = 0 N/m is not a positive number
--mass "20 g" --stiffness 1e6 --restitution 0
    --restitution = 0 is not a number in (0, 1]
--mass "20 g" --stiffness 1e6 --restitution 1.2
    --restitution = 1.2 is not a number in (0, 1]
--mass "20 g" --stiffness 1e6 --restitution 85
    --restitution = 85 is not a number in (0, 1]: did you mean 85 %?
--mass "20 g" --stiffness 1e6 --restitution -0.5
    --restitution = -0.5 is not a number in (0, 1]
--mass "20 g" --stiffness 1e6 --restitution nan
    --restitution = 'nan' does not begin with a number: write it as '0.85'
--mass "20 g" --stiffness 1e6 --damping-ratio 1.5
    --damping-ratio = 1.5 is too large: near the critical damping 1 and above it the ball does
--mass "20 g" --stiffness 1e6 --damping 1e9
    damping ratio ζ of the contact = 3535533.90593 is too large: near the critical damping 1 and
--mass "20 g" --stiffness 1e6 --damping "8 N/m"
    --damping = 8 N/m is in newton / meter, not in N s/m: write it as '10 N s/m'
--mass "20 g" --stiffness 1e6 --drop-height "1 m"
    --rebound-height and --drop-height are needed together
--mass "20 g" --stiffness 1e6 --drop-height "1 m" --rebound-height "1.2 m"
    --rebound-height 1.2 m is above --drop-height 1 m
--mass "20 g" --stiffness 1e6 --drop-height "1" --rebound-height "70"
    --rebound-height 70 m is above --drop-height 1 m
--mass "20 g" --contact-time "5 MS" --restitution 0.8 --engine lammps
    --contact-time = 5 MS is in megasiemens, not in s: did you mean '5 ms'?
--mass "20 g" --contact-time 5 --stiffness 100 --restitution 0.8
    --stiffness and --contact-time contradict each other, because each gives the stiffness of the
--mass "20 g" --frequency "50 1/s" --acceleration "0.8 g" --stiffness 1e6 --restitution 0.8
    --frequency = 50 1/s does not say whether it counts turns or radians: write '50 Hz' or
--mass "20 g" --frequency "50 hertz" --acceleration "0.8g's" --stiffness 1e6 --restitution 0.8
    --acceleration = 0.8g's has an unknown unit: write it as '2 g'
--mass "20 g" --frequency "-50 Hz" --acceleration "0.8 g" --stiffness 1e6 --restitution 0.8
    --frequency = -50 Hz is not a positive number
--mass "20 g" TABLE --table-amplitude "1 mm" --stiffness 1e6 --restitution 0.8
    --table-amplitude and --acceleration contradict each other, because each gives the amplitude
--mass "20 g" --frequency "50 Hz" --amplitude "1 mm" --stiffness 1e6 --restitution 0.8
    unrecognized arguments: --amplitude 1 mm; did you mean --table-amplitude?
BALL TABLE --n 0
    argument --n: '0' is not a whole number from 1 to 1000
BALL TABLE --n two
    argument --n: 'two' is not a whole number from 1 to 1000
BALL TABLE --n 1.5
    argument --n: '1.5' is not a whole number from 1 to 1000
BALL TABLE --tolerance 5
    --tolerance = 5 is not a number in (0, 1): did you mean 5 %?
BALL TABLE --tolerance "0 %"
    --tolerance = 0 is not a number in (0, 1)
BALL TABLE --quantity height
    argument --quantity: invalid choice: 'height' (choose from 'max_height', 'bounce_velocity',
BALL TABLE --release Force
    argument --release: invalid choice: 'Force' (choose from 'displacement', 'force'); did you
BALL TABLE --law Hertz
    --law Hertz has no damper: Hertz's spring with a damper is --law tsuji, or give --radius and
--mass "20 g" TABLE --contact-time "1 ms" --restitution 0.8 --law Tsuji
    unknown contact law 'Tsuji': one of hunt-crossley, hunt-crossley-linear, tsuji,
--mass "20 g" TABLE --radius "5 mm" --restitution 0.8
    --radius of a Hertz contact needs --reduced-modulus, or --youngs-modulus and the other data
--mass "20 g" TABLE --radius "5 mm" --youngs-modulus "210 GPa" --restitution 0.8
    --youngs-modulus needs --poissons-ratio and --table-youngs-modulus and
--mass "20 g" TABLE --radius "5 mm" --reduced-modulus "115 Gpa" --restitution 0.8
    --reduced-modulus = 115 Gpa has an unknown unit: did you mean '115 GPa'?
--mass "20 g" TABLE --radius "5 mm" --reduced-modulus 115 --restitution 0.8
    --reduced-modulus = 115 is in Pa, and no solid is so soft: did you mean 115 GPa?
BALL --engine Bullet
    unknown engine 'Bullet': one of generic, mujoco, lammps, liggghts, pybullet, drake,
BALL --engine isaac
    unknown engine 'isaac': one of generic, mujoco, lammps, liggghts, pybullet, drake, mercurydpm
BALL --engine mujoco --release displacement
    mujoco has no displacement release: its contacts end by force
--mass "20 g" --stiffness 1e6 --restitution 0.1 --engine mujoco
    restitution coefficient r = 0.1 is not in (e⁻², 1], the range of the force release with ζ < 1
BALL --engine mujoco --restitution-error 2
    --restitution-error = 2 is not a number in (0, 1): did you mean 2 %?
BALL --time-step "1 ms"
    --time-step needs --engine or --from, such as generic: engines step in different ways
BALL --engine mujoco --timestep "1 ms"
    unrecognized arguments: --timestep 1 ms; did you mean --time-step?
BALL --engine mujoco --time-step "1 kHz"
    --time-step = 1 kHz is in kilohertz, not in s: write it as '1 ms'
BALL --engine mujoco --time-step 0
    --time-step = 0 s is not a positive number
--mass "20 g" --restitution 0.8 --engine mujoco
    no stiffness: give --stiffness, or --contact-time
--mass "20 g" --restitution 0.8 --engine mujoco --time-step "1 ms" --restitution-error 1e-12
    no contact shorter than 1000 s has its r within --restitution-error 1e-12 at --time-step
--mass "20 g" --from mujoco
    solref is missing: give it, such as '-10000 -20'
--mass "20 g" --from mujoco --solref "0.02"
    solref = '0.02' is not 2 numbers
--mass "20 g" --from mujoco --solref "0.02,1"
    solref = '0.02,1' is not 2 numbers: write it without commas, '0.02 1'
--mass "20 g" --from mujoco --solref "-0.02 1"
    solref = '-0.02 1' is neither two negative numbers, -k/m and -c/m, nor two positive ones, a
--mass "20 g" --from mujoco --solref "0 0"
    solref = '0 0' is neither two negative numbers, -k/m and -c/m, nor two positive ones, a time
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
BALL --speed 0
    --speed = 0 m/s is not a positive number
BALL --speed "1 m"
    --speed = 1 m is in meter, not in m/s: write it as '1 m/s'
BALL --speed "1 ms"
    --speed = 1 ms is in millisecond, not in m/s: write it as '1 m/s'
--mass 20 g --stiffness 1e6 --restitution 0.8
    unrecognized arguments: g: a value with a space is one argument in quotes, such as "20 g"
BALL --json --plot
    argument --plot: expected one argument
-m 20
    unrecognized arguments: -m 20: see bouncing-ball design --help
--mass "20 g" --stifness 1e6 --restitution 0.8
    unrecognized arguments: --stifness 1e6; did you mean --stiffness?
--gravity 0 BALL
    --gravity = 0 m/s^2 is not a positive number
--gravity "9,81" BALL
    --gravity = 9,81 has a comma: write '9.81', with a decimal point
--gravity "9.81 m/s" BALL
    --gravity = 9.81 m/s is in meter / second, not in m/s^2: write it as '9.81 m/s^2'
--mass "20 g" --stiffness "1,000,000" --restitution 0.8
    --stiffness = 1,000,000 has a comma: write '1000000'
--mass "1/2 kg" --stiffness 1e6 --restitution 0.8
    --mass = 1/2 kg is a fraction: write '0.5 kg'
--mass "20 g" --stiffness "10^6 N/m" --restitution 0.8
    --stiffness = 10^6 N/m has an unknown unit: write it as '1e6 N/m'
--mass "20 g" --stiffness "5e6 N/m" --restitution "80 %" --damping-ratio 0.05
    --damping-ratio and --restitution contradict each other, because each gives the loss of the
--mass "20 µg" --frequency "50 Hz" --acceleration "1000000000 g" --stiffness 1e6 --restitution 0.8
    Λ = 1000000000.0 is not below 1e+08
--mass "20 g" --frequency "0 Hz" --acceleration "1 g" --stiffness 1e6 --restitution 0.8
    --frequency = 0 Hz is not a positive number
--mass "20 g" --stiffness "1,500 N/m" --restitution 0.8
    --stiffness = 1,500 N/m has a comma: write '1.500 N/m' or '1500 N/m'
--mass "20 gm" --stiffness "1500 N/m" --restitution 0.8
    --mass = 20 gm is in grains, or in no unit of mass: did you mean '20 g'?
--mass "20 g" --modulus 5
    unrecognized arguments: --modulus 5; did you mean --reduced-modulus?
mass="20 g" --frequency "50 Hz"
    unrecognized arguments: mass=20 g; did you mean --mass?
--help-me
    unrecognized arguments: --help-me: see bouncing-ball design --help
BALL TABLE --rest 0.8
    unrecognized arguments: --rest 0.8; did you mean --restitution?
--mass "20 g" --stiffness "1 000 000 N/m" --restitution 0.8
    --stiffness = 1 000 000 N/m has separated thousands: write '1000000 N/m'
--mass "20 g" --stiffness "1_000_000" --restitution 0.8
    --stiffness = 1_000_000 has separated thousands: write '1000000'
--mass "20 g" --stiffness 1e6 --restitution "4/5"
    --restitution = 4/5 is a fraction: write '0.8'
BALL TABLE --tolerance "1 %%"
    --tolerance = 1 %% has an unknown unit: write it as '1 %'
--mass "20 g" --frequency "50 Hz" --acceleration "80 %" --stiffness 1e6 --restitution 0.8
    --acceleration = 80 % is in percent, not in m/s^2: write it as '2 g'
--mass "20 g" --frequency "3000 U/min" --acceleration "0.8 g" --stiffness 1e6 --restitution 0.8
    --frequency = 3000 U/min is in enzyme unit / minute, not in Hz: write it as '50 Hz'
--mass "20 g" --stiffness "1e7 Pa" --restitution 0.8
    --stiffness = 1e7 Pa is in pascal, not in N/m: write it as '1e6 N/m'
--mass "20 g" --stiffness 1e7k --restitution 0.8
    --stiffness = 1e7k is in boltzmann constant, not in N/m: write it as '1e6 N/m'
--mass "20 g" --stiffness 1e6 --restitution "0.85 m"
    --restitution = 0.85 m is in meter, and not a plain number: write it as '0.85'
--mass "20 g" --from mujoco --solref "[-10000, -20]"
    solref = '[-10000, -20]' is not 2 numbers: write it plainly, '-10000 -20'
--mass "20 g" --from mujoco --solref "-10000;-20"
    solref = '-10000;-20' is not 2 numbers: write it plainly, '-10000 -20'
--mass "20 g" --from mujoco --solref -10000 -20
    unrecognized arguments: -20: a value with a space is one argument in quotes, such as "20 g"
""".strip().splitlines()
ROWS = [(typed, says.strip()) for typed, says in zip(MISTAKES[::2], MISTAKES[1::2], strict=True)]


def test_there_are_more_than_fifty_of_them():
    assert len(dict(ROWS)) > 50


@pytest.mark.parametrize(("typed", "says"), ROWS)
def test_a_mistake_is_answered_by_one_line(refused, typed, says):
    typed = typed.replace("BALL", BALL).replace("TABLE", TABLE)
    status, line = refused("design", *shlex.split(typed))
    assert line.startswith(f"bouncing-ball: {says}")
    assert status == (1 if "no 1-T orbit" in line else 2)
