// The engines of bouncing_ball.engines: their parameters of k, c and m, and the time step for an
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
};

// A number as Python writes it.
function repr(x) {
  const [digits, power] = x.toExponential().split("e"), exponent = Number(power);
  if (exponent >= -4 && exponent < 16) return Number.isInteger(x) ? `${x}.0` : String(x);
  return `${digits}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
}

// The largest error of r of a free impact in N steps, wherever within a step it begins.
function errorInSteps(scheme, contact, steps) {
  const {zeta, release} = contact, loss = 2 * zeta, r = ownRestitution(contact);
  const h = freeAngle(contact) / Math.sqrt((1 - zeta) * (1 + zeta)) / steps;
  const implicit = scheme === "implicit Euler", q = 1 + loss * h + h * h;
  const lag = release === "force" ? (implicit ? loss + h : loss) : 0;
  let worst = 0;
  for (let place = 0; place < 33; place++) {
    let x = -h * (1e-9 + place * (1 - 1e-9) / 32), v = -1;
    for (let k = 0; k < 2 * steps && x + lag * v < 0; k++) {
      v = implicit ? (v - h * x) / q : v - h * (x + loss * v);
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

// What to write into an engine for a ball of m and k whose free impact has r by a release.
function settingsOf(engines, name, release, mass, stiffness, restitution, error) {
  const {scheme, snippets} = engines[name], round = x => Number(x.toPrecision(12));
  const asked = contactOf(restitution, 1, release, true);
  const [m, k] = [round(mass), round(stiffness)];
  const c = round(2 * asked.zeta * mass * Math.sqrt(stiffness / mass)), omega = Math.sqrt(k / m);
  const zeta = c / (2 * m * omega);
  const of = rule => ({omega, zeta, release: rule, sine: rule === "force" ? zeta : 0});
  const contact = of(release), steps = stepsFor(scheme, contact, error);
  const time_step = round(freeAngle(contact) / dampedFrequency(contact) / steps);
  const texts = Object.fromEntries(
    Object.entries({mass: m, time_step, ...ENGINE_NUMBERS[name](m, k, c)})
      .map(([key, x]) => [key, repr(x)]));
  for (const rule of ["displacement", "force"]) texts[rule] = ownRestitution(of(rule)).toFixed(4);
  return {scheme, steps, time_step, restitution: ownRestitution(contact),
    snippet: snippets[release].replace(/@([\w.]+)@/g, (_, key) => texts[key])};
}

// The settings of the package, computed again: the largest relative difference, and where.
function compareEngines({engines, cases}) {
  let worst = 0, where = "";
  for (const {state, values, snippet} of cases) {
    const found = settingsOf(engines, ...state);
    const differences = [found.time_step, found.steps, found.restitution].map(
      (x, k) => Math.abs(x / values[k] - 1));
    const difference = found.snippet === snippet ? Math.max(...differences) : Infinity;
    if (!(difference <= worst)) [worst, where] = [difference, `settings of ${state[0]}`];
  }
  return {worst, where, count: cases.length};
}
