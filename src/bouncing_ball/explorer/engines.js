// The engines of bouncing_ball.contacts.engines: their parameters of k, c and m, and the time step for an
// error of r. Their texts and schemes come from Python, in the page's element "engines".
"use strict";

// Of ball and wall, as the engines call them; what a list has, with its place.
const ENGINE_NUMBERS = {
  generic: (m, k, c) => ({mass: m, stiffness: k, damping: c}),
  mujoco: (m, k, c) =>
    ({"solref.0": 0 - k / m, "solref.1": 0 - c / m,
      "solimp.0": 1e-4, "solimp.1": 1e-4, "solimp.2": 0.001}),
  lammps: (m, k, c) => ({kn: k, gamma_n: c * (1 / m)}),
  liggghts: (m, k, c) => ({kn: k, gamman: c * (1 / m)}),
  pybullet: (m, k, c) => ({contactStiffness: 2 * k, contactDamping: 0.5 * c}),
  drake: (m, k, c) => ({point_contact_stiffness: 2 * k, relaxation_time: c / k / 2}),
  mercurydpm: (m, k, c) => ({stiffness: k, dissipation: c}),
  "newton-semi-implicit": (m, k, c) => ({ke: k, kd: c}),
  "newton-mujoco": (m, k, c) => ({ke: 1 / m * k, kd: 1 / m * c}),
  genesis: (m, k, c) => ({timeconst: 2 * m / c, dampratio: c / (2 * m * Math.sqrt(k / m))}),
  gazebo: (m, k, c) => ({kp: 2 * k, kd: 0.5 * c}),
};
// Engines that know damping by its time constant only.
const DAMPED_ONLY = ["newton-mujoco", "genesis"];

const COMPENSATED = "compensated implicit Euler";

// A number as Python writes it.
function repr(x) {
  const [digits, power] = x.toExponential().split("e"), exponent = Number(power);
  if (exponent >= -4 && exponent < 16) return Number.isInteger(x) ? `${x}.0` : String(x);
  return `${digits}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
}

// Of a mass of one, and ζ < 1: k and c with which implicit Euler has the positions of the exact
// contact, by exp(-hμ) - 1 for its rate μ (bouncing_ball.contacts.engines.scheme).
function compensated(k, c, step) {
  const growth = Math.expm1(step * c / 2), angle = step * Math.sqrt(k - c * c / 4);
  const real = growth - (growth + 1) * 2 * Math.sin(angle / 2) ** 2, imaginary = (growth + 1) * Math.sin(angle);
  return [(real * real + imaginary * imaginary) / step ** 2, Math.max(0, 2 * real / step)];
}

// The way back, with real rates as well: k and c of the contact that implicit Euler computes.
function represented(k, c, step) {
  const square = k - c * c / 4, root = step * Math.sqrt(Math.abs(square)), middle = 1 + step * c / 2;
  const [a, b] = square < 0 ? [middle - root, middle + root].map(Math.log)
    : [Math.log(Math.hypot(middle, root)), Math.atan2(root, middle)];
  return square < 0 ? [a * b / step ** 2, (a + b) / step] : [(a * a + b * b) / step ** 2, 2 * a / step];
}

// The largest error of r of a free impact in N steps, wherever within a step it begins.
function errorInSteps(scheme, contact, steps) {
  const {zeta, release} = contact, r = ownRestitution(contact);
  const h = freeAngle(contact) / Math.sqrt((1 - zeta) * (1 + zeta)) / steps;
  const [stiff, loss] = scheme === COMPENSATED ? compensated(1, 2 * zeta, h) : [1, 2 * zeta];
  const implicit = scheme !== "semi-implicit Euler", q = 1 + loss * h + stiff * h * h;
  // A damper that acts on approach only is left out of the steps that begin with v ≥ 0.
  const lossAt = v => isApproach(contact) && v >= 0 ? 0 : loss;
  const lag = release === "force" ? (implicit ? loss / stiff + h : loss) : 0;
  let worst = 0;
  for (let place = 0; place < 33; place++) {
    let x = -h * (1e-9 + place * (1 - 1e-9) / 32), v = -1;
    for (let k = 0; k < 2 * steps && x + lag * v < 0; k++) {
      v = implicit ? (v - h * stiff * x) / q : v - h * (x + lossAt(v) * v);
      x += h * v;
    }
    worst = Math.max(worst, Math.abs(v - r));
  }
  return worst;
}

// The least number of steps in a contact from which on r is within an error: it falls like 1/N.
function stepsFor(scheme, contact, error) {
  const most = 4096, fewest = 8, last = errorInSteps(scheme, contact, most);
  if (last > error) return Math.ceil(most * last / error);
  let good = most, bad = fewest - 1;
  while (good - bad > 1) {
    const middle = bad < fewest ? Math.max(Math.floor(good / 2), bad + 1) : Math.floor((good + bad) / 2);
    if (errorInSteps(scheme, contact, middle) <= error) good = middle;
    else bad = middle;
  }
  return good;
}

// The nearest number of so many digits. Of two that are as near, it is the one whose last digit is
// even, as in Python; toPrecision takes the larger one. A hundred more digits show all of a double.
function nearest(x, digits) {
  if (x === 0 || !Number.isFinite(x)) return x;
  const [mantissa, power] = Math.abs(x).toExponential(100).split("e"), all = mantissa.replace(".", "");
  const isTie = /^50*$/.test(all.slice(digits)), isEven = all[digits - 1] % 2 === 0;
  return isTie && isEven ? Math.sign(x) * Number(`${all.slice(0, digits)}e${power - digits + 1}`)
    : Number(x.toPrecision(digits));
}

const rounded = x => nearest(x, 12);

// A number in so many digits, as Python's format g writes it.
function general(x, digits) {
  if (x === 0) return "0";
  const near = nearest(x, digits), [number, power] = near.toExponential().split("e");
  if (power >= -4 && power < digits) return String(near);
  return `${number}e${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
}

// A contact without an answer: why, in the words of the package.
class Refused extends Error {}
const refuseIf = (wrong, why) => { if (wrong) throw new Refused(why); };

// c of the contact between a mass and a wall whose free impact has r by a release.
const dampingOf = (restitution, release, mass, stiffness) =>
  2 * contactOf(restitution, 1, release, true).zeta * mass * Math.sqrt(stiffness / mass);

// ---- The way back: the contact of an engine's parameters.
const ENGINE_NAMES = {
  generic: ["stiffness", "damping"], mujoco: ["solref", "solimp"], lammps: ["kn", "gamma_n"],
  liggghts: ["kn", "gamman"], pybullet: ["contactStiffness", "contactDamping", "time_step"],
  drake: ["point_contact_stiffness", "relaxation_time", "time_step"], mercurydpm: ["stiffness", "dissipation"],
  "newton-semi-implicit": ["ke", "kd"], "newton-mujoco": ["ke", "kd"], genesis: ["timeconst", "dampratio"],
  gazebo: ["kp", "kd", "time_step"],
};
const ENGINE_READS = {
  generic: (m, a, b) => [a, b], lammps: (m, a, b) => [a, b / (1 / m)], liggghts: (m, a, b) => [a, b / (1 / m)],
  pybullet: (m, a, b) => [a / 2, b / 0.5], drake: (m, a, b) => [a / 2, a * b], mercurydpm: (m, a, b) => [a, b],
  "newton-semi-implicit": (m, a, b) => [a, b], "newton-mujoco": (m, a, b) => [a / (1 / m), b / (1 / m)],
  genesis: (m, a, b) => [m / (a * b) ** 2, 2 * m / a],
  gazebo: (m, a, b) => [a / 2, b / 0.5],
};
// What a reader should know of the parameters of an engine: Engine.remarks.
const ENGINE_REMARKS = {
  "newton-mujoco": [
    "ke and kd are per unit of mass in SolverMuJoCo: k/m in 1/s^2 and c/m in 1/s",
    "without mujoco:condim = 1 a friction mu of 0 gives no numbers in Newton 1.8.0",
  ],
};

// Up to this impedance MuJoCo's contact is taken for a spring and a damper.
const FELT = 0.01;
// The longest time constant of MuJoCo, and the longest contact, in s, that are taken for one.
const LONGEST_CONSTANT = 100, LONGEST = 1000;

// The numbers of an attribute, as many as are allowed.
function numbersOf(name, text, least, most) {
  const parts = text.trim().split(/\s+/).filter(Boolean), numbers = parts.map(Number);
  const allowed = least === most ? `${least} numbers` : `${least} to ${most} numbers`;
  const hint = text.includes(",") ? `: write it without commas, '${text.replaceAll(",", " ").trim().split(/\s+/).join(" ")}'` : "";
  refuseIf(numbers.length < least || numbers.length > most || !numbers.every(Number.isFinite),
    `${name} = '${text}' is not ${allowed}${hint}`);
  return numbers;
}

// The largest impedance of a solimp, with MuJoCo's defaults and limits.
function impedanceOf(text) {
  const given = numbersOf("solimp", text, 0, 5);
  for (const d of given.slice(0, 2))
    refuseIf(!(d >= 0 && d <= 1), `solimp has the impedance ${general(d, 6)}, which is not in [0, 1]`);
  const [least, most, width] = [...given, ...[0.9, 0.95, 0.001].slice(given.length)];
  const shares = [least, most].map(d => Math.min(0.9999, Math.max(1e-4, d)));
  // Without a width MuJoCo takes their mean.
  return width > 0 ? Math.max(...shares) : (shares[0] + shares[1]) / 2;
}

// k and c of the parameters of an engine, which are two texts, and perhaps a time step.
function readEngine(engine, mass, [one, two, three]) {
  const names = ENGINE_NAMES[engine].slice(0, 2), stepped = STEPPED.includes(engine) && three.trim();
  const [step] = stepped ? numbersOf("time_step", three, 1, 1) : [1];
  refuseIf(!(step > 0), `time_step = ${repr(step)} is not a positive number of s`);
  if (engine === "mujoco") {
    const impedance = impedanceOf(two);
    refuseIf(!one.trim(), "solref is missing: give it, such as '-10000 -20'");
    const [a, b] = numbersOf("solref", one, 2, 2), [k, c] = [general(a, 6), general(b, 6)];
    refuseIf(a > LONGEST_CONSTANT && b > 0, `solref = '${k} ${c}' is a time constant of ${k} s, which no `
      + `simulation has: -k/m and -c/m are written '-${k} -${c}'`);
    refuseIf(!(a < 0 && b <= 0) && !(a > 0 && b > 0), `solref = '${general(a, 6)} ${general(b, 6)}' is neither `
      + "two negative numbers, -k/m and -c/m, nor two positive ones, a time constant and a damping ratio");
    refuseIf(impedance > FELT, `with the impedance ${general(impedance, 6)} MuJoCo's contact is not linear: write `
      + 'solimp = "1e-4 1e-4 0.001", or ask bouncing-ball design, which follows it');
    return a < 0 ? [-a * mass, Math.abs(b) * mass] : [mass / (a * b) ** 2, 2 * mass / a];
  }
  const values = [one, two].map((text, k) => {
    refuseIf(!text.trim(), `${names[k]} is missing: the parameters of ${engine} are ${names.join(" and ")}`);
    const [value] = numbersOf(names[k], text, 1, 1);
    refuseIf(!(value >= 0), `${names[k]} = ${repr(value)} is not a number of at least 0`);
    return value;
  });
  refuseIf(values[0] === 0, `${names[0]} = 0.0 is not positive`);
  refuseIf(engine === "newton-mujoco" && values[1] === 0, "kd = 0 of newton-mujoco is no contact without damping, but "
    + "the default of MuJoCo: kd is c/m in 1/s");
  refuseIf(engine === "genesis" && values[1] === 0, "dampratio = 0 is no contact of genesis: its time constant is 2 m/c");
  const [k, c] = ENGINE_READS[engine](mass, ...values);
  return stepped ? represented(k / mass, c / mass, step).map(x => x * mass) : [k, c];
}

// ---- The case of the physical tab.
// Engines whose scheme is compensated, so that their parameters belong to a time step.
const STEPPED = ["pybullet", "drake", "gazebo"];
// The contact in SI units, its dimensionless groups, and remarks.
function caseOf(state) {
  const found = anyCaseOf(state), duration = freeAngle(found.contact) / dampedFrequency(found.contact) * found.time;
  refuseIf(duration > LONGEST, `a contact of ${prefixed(duration, "s")} is longer than any that is simulated, up to `
    + `${LONGEST} s: check the mass, the stiffness and their units`);
  const {engine} = state;
  refuseIf(DAMPED_ONLY.includes(engine) && found.damping === 0, `${engine} has no contact without damping: its time constant is 2 m/c`);
  return found;
}

function anyCaseOf({given, engine, release, r, one, two, three, m, k, f}) {
  const mass = m / 1000, time = 1 / (2 * Math.PI * f), length = GRAVITY * time ** 2;
  if (given in ENGINE_NAMES) {
    const [stiffness, damping] = readEngine(given, mass, [one, two, three]);
    const omega = Math.sqrt(stiffness / mass), zeta = damping / (2 * mass * omega);
    refuseIf(!(zeta < 1), `damping ratio ζ = ${repr(zeta)} is not below 1: on a vibrating table only underdamped contacts are computed`);
    const remarks = given in ENGINE_REMARKS ? [...ENGINE_REMARKS[given]] : STEPPED.includes(given) && !three.trim()
      ? ["k, c and r are those in the limit of small time steps, which damp less; with the parameter time_step, in s, "
        + "they are those of this step"] : [];
    const by = rule => withDamping(omega * time, zeta, rule);
    const contact = by(release), [own] = releasesOf({tab: "design", engine: given, given});
    if (engine !== "none" && own !== release && zeta > 0) {
      const [before, after] = [own, release].map(rule => ownRestitution(by(rule)).toFixed(4));
      remarks.push(`r changes from ${before} to ${after}, because contacts end by ${own} in ${given}, and by ${release} in ${engine}`);
    }
    return {mass, time, length, stiffness, damping, contact, remarks};
  }
  const contact = contactOf(r, Math.sqrt(k / mass) * time, release, engine !== "none");
  return {mass, time, length, stiffness: k, damping: 2 * contact.zeta * Math.sqrt(k * mass), contact, remarks: []};
}

// What to write into an engine for a contact of mass, stiffness and damping.
function settingsOf(engines, name, release, {mass, stiffness, damping}, error) {
  const {snippets, scheme} = engines[name];
  const [m, k, c] = [mass, stiffness, damping].map(rounded);
  const omega = Math.sqrt(k / m), zeta = c / (2 * m * omega);
  const of = rule => withDamping(omega, zeta, rule);
  const contact = of(release), steps = stepsFor(scheme, contact, error);
  const time_step = rounded(freeAngle(contact) / dampedFrequency(contact) / steps);
  const written = scheme !== COMPENSATED ? [k, c]
    : compensated(k / m, c / m, time_step).map(x => rounded(x * m));
  const numbers = ENGINE_NUMBERS[name](m, ...written);
  const texts = Object.fromEntries(
    Object.entries({mass: m, stiffness: k, damping: c, time_step, ...numbers}).map(([key, x]) => [key, repr(x)]));
  for (const rule of CHOICES.release) texts[rule] = ownRestitution(of(rule)).toFixed(4);
  return {scheme, steps, time_step, restitution: ownRestitution(contact),
    snippet: snippets[release].replace(/@([\w.]+)@/g, (_, key) => texts[key])};
}

// The settings of the package, computed again: the largest relative difference, and where.
function compareEngines({engines, cases}) {
  let worst = 0, where = "";
  for (const {state: [name, release, mass, stiffness, restitution, error], values, snippet} of cases) {
    const damping = dampingOf(restitution, release, mass, stiffness);
    const found = settingsOf(engines, name, release, {mass, stiffness, damping}, error);
    const differences = [found.time_step, found.steps, found.restitution].map(
      (x, k) => Math.abs(x / values[k] - 1));
    const difference = found.snippet === snippet ? Math.max(...differences) : Infinity;
    if (!(difference <= worst)) [worst, where] = [difference, `settings of ${name}`];
  }
  return {worst, where, count: cases.length};
}
