// The state of the page, which is its address: what each value may be, and the call in Python
// that computes the same.
"use strict";

const $ = id => document.getElementById(id);
// The stage's: phase and velocity of the first impact, number of balls, by how much each of them
// differs from the one before, the periods that have passed, and how many times slower it plays.
const DEFAULTS = {
  tab: "question", stiff: 5, r: 0.85, w: 10, a: 0.8, n: 1, release: "force", side: "stable",
  m: 20, f: 20, moves: "stroke", acc: 0.8, stroke: 1, touch: "time", k: 1e5, time: 1.4, t: 1,
  model: "both", phi: 0, v: -3, balls: 1, dv: 0, dphi: 0, from: 0, pace: "1", view: "height",
  units: "physical",
};
const RANGES = {
  stiff: [2, 1000], r: [0.001, 1], w: [0.1, 1e6], a: [0.001, 100], n: [1, 20],
  m: [1e-9, 1e9], f: [1e-6, 1e9], acc: [0.001, 100], stroke: [1e-9, 1e9], k: [1e-9, 1e18],
  time: [1e-9, 1e9], t: [1e-4, 99],
  phi: [-10, 10], v: [-1000, 1000], balls: [1, 9], dv: [-10, 10], dphi: [-10, 10], from: [0, 1000],
};
const WHOLE = ["n", "balls", "from"];
// On the stage the table may be at rest.
const rangeOf = (name, tab) => name === "a" && tab === "stage" ? [0, 100] : RANGES[name];
const REFERENCES = Object.fromEntries(["references", "quantities", "scenes"].map(
  name => [name, JSON.parse($(name).textContent)]));
const {quantities: QUANTITIES, scenes: SCENES} = REFERENCES;
const CHOICES = {
  tab: ["question", "design", "orbit", "stage"], release: ["displacement", "force"], side: ["stable", "unstable"],
  model: ["both", "restitution", "spring-damper"], pace: ["1", "4", "16"], view: ["height", "gap"],
  units: ["physical", "dimensionless"],
};
// The values of the physical tab by which the table and the contact may be given: an address has one
// of each.
const WAYS = {moves: {acceleration: "acc", stroke: "stroke"}, touch: {stiffness: "k", time: "time"}};
const GRAVITY = 9.80665;

// The models whose balls are on the stage.
const modelsOf = ({model, r, w, release}) => Object.fromEntries(
  [["restitution", {r}], ["spring-damper", {contact: contactOf(r, w, release)}]]
    .filter(([name]) => model === "both" || model === name));

// The units in which a value may be given, in that of the page, which is the first.
const UNITS = {
  f: {Hz: 1, kHz: 1e3}, acc: {g: 1, "m/s²": 1 / GRAVITY, "m/s^2": 1 / GRAVITY},
  stroke: {mm: 1, cm: 10, m: 1e3, "µm": 1e-3, "μm": 1e-3, um: 1e-3},
  k: {"N/m": 1, "N/mm": 1e3, "kN/m": 1e3, "MN/m": 1e6},
  time: {ms: 1, s: 1e3, "µs": 1e-3, "μs": 1e-3, us: 1e-3}, m: {g: 1, kg: 1e3, mg: 1e-3}, t: {"%": 1},
};

// How else to write a number with commas between thousands: 1,500 is 1500 or 1.5.
function otherwise(text) {
  const [, begin, more, rest] = /^\s*([-+−]?[1-9]\d*)((?:,\d{3})+)(\.\d*)?(?!\d)/.exec(text) ?? [];
  if (!begin) return [];
  const whole = begin + more.replaceAll(",", "") + (rest ?? "");
  return rest || more.length > 4 ? [whole] : [whole, String(Number(`${begin.replace("−", "-")}.${more.slice(1)}`))];
}
// A number, maybe with its unit. A decimal comma is read as a point, and the sign − as a hyphen. NaN for
// 1,500, which is 1.5 or 1500, and for another unit.
function numberOf(text, name) {
  const [, digits, unit] = /^\s*([-+]?[\d.,]+(?:e[-+]?\d+)?)\s*(\S*)\s*$/i.exec(text.replaceAll("−", "-")) ?? [];
  if (!digits || otherwise(digits).length) return NaN;
  const value = Number(digits.replace(",", "."));
  return unit ? nearest(value * (UNITS[name]?.[unit] ?? NaN), 12) : value;
}

// The state of a hash, and what in it was no value: that has its default. Names that are not in the
// hash have the values of `kept`. Without a hash the page begins with its question. A scene is a state
// of the stage by its name. A hash with values and without a tab is a dimensionless case. Its contact
// ends as in the paper, as that of a scene or of a stage without a release does. What the tab does not
// use is left out, too.
function parse(hash, kept = DEFAULTS) {
  const given = new URLSearchParams(hash.replace(/^#/, "")), scene = SCENES[given.get("scene")];
  const begins = kept === DEFAULTS && (hash.length < 2 || given.get("tab") === "question");
  // Behind the question lies the case of the first tab with inputs.
  const state = {...begins ? likewise({...kept, tab: "design"}, {tab: "question"}) : kept, ...scene?.state}, refused = [];
  if (scene) state.tab = "stage";
  else if (![...given].every(([name]) => name === "scene")) state.tab = "orbit";
  const tab = given.get("tab") ?? state.tab;
  if (tab === "stage" || (tab === "orbit" && !given.has("tab"))) state.release = "displacement";
  if (given.has("scene") && !scene)
    refused.push(`scene = ${given.get("scene")} (the scenes are ${Object.keys(SCENES).join(", ")})`);
  given.delete("scene");
  for (const [choice, names] of Object.entries(WAYS)) {
    const named = Object.keys(names).filter(way => given.has(names[way]));
    if (named.length) state[choice] = named.at(-1);
  }
  for (const [name, text] of given) {
    const value = numberOf(text, name), range = rangeOf(name, tab);
    if (name in CHOICES ? CHOICES[name].includes(text)
      : range && text.trim() !== "" && value >= range[0] && value <= range[1]
        && (!WHOLE.includes(name) || Number.isInteger(value)))
      state[name] = name in CHOICES ? text : value;
    else {
      refused.push(`${name} = ${text}` + (name in DEFAULTS ? ` (not a value here; ${DEFAULTS[name]} in its place)` : ""));
      if (name in DEFAULTS) state[name] = DEFAULTS[name];
    }
  }
  const used = TABS[state.tab](state), isDropped = name => name in DEFAULTS && !used.includes(name)
    && (given.has(name) || (state.tab !== "question" && ASKED.includes(name) && state[name] !== DEFAULTS[name]));
  for (const name of Object.keys(DEFAULTS).filter(isDropped)) refused.push(`${name} = ${state[name]} (not used here)`);
  return {state, refused};
}

// The units of time, 1/Ω in s, and of length, g/Ω² in m, of a table of f Hz.
function scalesOf(f) {
  const time = 1 / (2 * Math.PI * f);
  return {time, length: GRAVITY * time ** 2};
}

// The duration of a free impact over the unit of time, for ϖ = 1: π/√(1 - ζ²), and if it ends where its
// force is zero (π - 2 arcsin ζ)/√(1 - ζ²).
const freeTime = ({r, release}) => {
  const contact = contactOf(r, 1, release);
  return freeAngle(contact) / dampedFrequency(contact);
};

// Λ and ϖ. On the physical tab a stroke, from the lowest to the highest point of the table, is in mm,
// a contact time in ms and a mass in g.
const amplitudeOf = ({tab, moves, a, acc, stroke, f}) => tab !== "design" ? a
  : moves === "stroke" ? stroke / 2000 / scalesOf(f).length : acc;
function frequencyRatioOf(state) {
  const {tab, touch, w, k, m, f} = state, {time} = scalesOf(f);
  if (tab !== "design") return w;
  return touch === "time" ? freeTime(state) * time / (state.time / 1000) : Math.sqrt(k / (m / 1000)) * time;
}

// The values of a tab that give its Λ and its ϖ.
const givenOf = ({tab, moves, touch}) => tab === "design" ? [WAYS.moves[moves], WAYS.touch[touch]] : ["a", "w"];
// The inverse of `amplitudeOf` and `frequencyRatioOf`, by the values that may be given.
function givenBy(a, w, state) {
  const {m, f} = state, {time, length} = scalesOf(f);
  return {a, w, acc: a, stroke: 2000 * a * length, k: m / 1000 * (w / time) ** 2,
    time: 1000 * freeTime(state) * time / w};
}

// The same case on another tab, or given by other values, which are filled in with six digits. A value
// that belongs to the case already, within these digits, keeps its own. The stage is drawn in the units
// of the tab before it.
function likewise(state, changed) {
  const units = changed.tab === "stage" && {design: "physical", orbit: "dimensionless"}[state.tab] || state.units;
  const next = {...state, units, ...changed}, [table, contact] = givenOf(next);
  const a = amplitudeOf(state), w = frequencyRatioOf(state), given = givenBy(a, w, next);
  const differs = (value, wanted) => Math.abs(value - wanted) > 5e-6 * wanted;
  if (differs(amplitudeOf(next), a)) next[table] = nearest(given[table], 6);
  if (differs(frequencyRatioOf(next), w)) next[contact] = nearest(given[contact], 6);
  return next;
}

// The contact of the physical tab in SI units, and its dimensionless groups.
function caseOf(state) {
  const {release, r, m, f} = state, {time, length} = scalesOf(f), mass = m / 1000;
  const contact = contactOf(r, frequencyRatioOf(state), release), {omega, zeta} = contact;
  return {mass, time, length, stiffness: mass * (omega / time) ** 2, damping: 2 * zeta * mass * omega / time,
    contact};
}

// Why a state has no answer: no damping gives r, Λ or ϖ is out of range, or a ball rises.
function impossible(state) {
  const {tab, a, r, w, phi, v, dv, dphi, release} = state;
  if (tab === "question") return "";
  if (!(tab === "stage" && state.model === "restitution") && Number.isNaN(dampingOf(r, release)))
    return `r = ${r} is not above e⁻² = ${shown(Math.exp(-2), 3)}: a contact that ends where its force is zero `
      + "then needs a damping ratio of 1 or more, which this page has not. Choose the end at δ = 0.";
  if (tab === "design") {
    const outside = (value, [low, high]) => !(value >= low && value <= high);
    const large = amplitudeOf(state), ratio = frequencyRatioOf(state), limits = ([low, high]) => `${low} to ${high}`;
    if (outside(large, RANGES.a))
      return `The acceleration of the table is Λ = ${shown(large, 4)} g, and this page takes ${limits(RANGES.a)}: `
        + "check the stroke, the frequency and their units.";
    return outside(ratio, RANGES.w) ? `The frequency ratio is ϖ = ${shown(ratio, 4)}, and this page takes `
      + `${limits(RANGES.w)}: check ${state.touch === "time" ? "the contact time" : "the mass, the stiffness"} `
      + "and the frequency, and their units." : "";
  }
  if (tab !== "stage") return "";
  if (r === 1 && w === 1 && state.model !== "restitution")
    return "r = 1 with ϖ = 1 is the resonance of an undamped contact, which is not followed here.";
  for (let k = 0; k < state.balls; k++) {
    const table = a * Math.cos(phi + k * dphi);
    if (v + k * dv > table + 1e-9)
      return `The velocity of ball ${k + 1} at its first impact, ${shown(v + k * dv)}, is above `
        + `that of the table, Λ cos φ = ${shown(table)}: it rises, and there is no impact.`;
  }
  return "";
}

// What each tab uses, in the order of its address, and what an orbit is asked for.
const TABS = {
  question: () => ["tab", "stiff"],
  orbit: () => ["tab", "r", "w", "a", "n", "release", "side", "t"],
  design: state => ["tab", "m", "f", ...givenOf(state), "r", "n", "release", "t"],
  stage: ({model}) => ["tab", "model", "r", ...(model === "restitution" ? [] : ["w"]), "a", "release",
    "phi", "v", "balls", "dv", "dphi", "from", "pace", "view", "units", "f"],
};
const ASKED = ["n", "side", "t"];
const hashOf = state => "#" + TABS[state.tab](state).filter(name => name !== "t" || state.t !== DEFAULTS.t)
  .map(name => `${name}=${encodeURIComponent(state[name])}`).join("&");

// The arguments of the models: of the physical tab, its dimensionless groups. The tolerance is given
// in percent.
function questionOf(state) {
  const {tab, r, n, release, side} = state, amplitude = amplitudeOf(state), tolerance = state.t / 100;
  if (tab === "orbit")
    return {n, side, amplitude, tolerance, contact: contactOf(r, state.w, release)};
  // The orbit is that which is stable next to the saddle-node.
  const physical = caseOf(state);
  return {n, side: "stable", amplitude, tolerance, contact: physical.contact, physical};
}

// The call in Python.
function callOf(state) {
  const {tab, r, n, release, side} = state;
  if (tab === "stage") {
    const balls = {restitution: `Rigid(${r})`, "spring-damper": `SpringDamper(${state.w}, restitution=${r}, `
      + `release="${release}")`};
    return Object.keys(modelsOf(state)).map(model => `motion_of(${balls[model]}, amplitude=${state.a}, `
      + `phase=${state.phi}, velocity=${state.v})`).join("\n");
  }
  if (tab === "orbit")
    return `orbit(SpringDamper(${state.w}, restitution=${r}, release="${release}"), amplitude=${state.a}, n=${n}, `
      + `side="${side}")`;
  const table = state.moves === "stroke" ? `displacement=${state.stroke} / 2000`
    : `acceleration=${state.acc} * 9.80665`;
  const contact = state.touch === "time" ? `contact_duration=${state.time} / 1000`
    : `mass=${state.m} / 1000, stiffness=${state.k}`;
  return `on_shaker(frequency=${state.f}, ${table}, ${contact}, restitution=${r}, n=${n}, `
    + `tolerance=${state.t} / 100, release="${release}")`;
}
