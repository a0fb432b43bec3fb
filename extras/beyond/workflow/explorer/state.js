// The state of the page, which is its address: what each value may be, and the call in Python
// that computes the same.
"use strict";

const $ = id => document.getElementById(id);
// The stage's: phase and velocity of the first impact, number of balls, by how much each of them
// differs from the one before, the periods that have passed, and how many times slower it plays.
const DEFAULTS = {
  tab: "design", r: 0.85, w: 10, a: 0.8, n: 1, h: 1, p: -0.87, release: "displacement", side: "stable",
  m: 20, f: 20, acc: 0.8, k: 1e5, t: 1,
  model: "both", phi: 0, v: -3, balls: 1, dv: 0, dphi: 0, from: 0, pace: "1", view: "height",
  units: "physical",
};
const RANGES = {
  r: [0.001, 1], w: [0.1, 1e6], a: [0.001, 100], n: [1, 20], h: [0, 2], p: [-10, 10],
  m: [1e-9, 1e9], f: [1e-6, 1e9], acc: [0.001, 100], k: [1e-9, 1e18], t: [1e-4, 99],
  phi: [-10, 10], v: [-1000, 1000], balls: [1, 9], dv: [-10, 10], dphi: [-10, 10], from: [0, 1000],
};
const WHOLE = ["n", "balls", "from"];
// On the stage the table may be at rest.
const rangeOf = (name, tab) => name === "a" && tab === "stage" ? [0, 100] : RANGES[name];
const REFERENCES = Object.fromEntries(["references", "quantities", "scenes"].map(
  name => [name, JSON.parse($(name).textContent)]));
const {quantities: QUANTITIES, scenes: SCENES} = REFERENCES;
const CHOICES = {
  tab: ["design", "orbit", "stage"], release: ["displacement", "force"], side: ["stable", "unstable"],
  model: ["both", "restitution", "spring-damper"], pace: ["1", "4", "16"], view: ["height", "gap"],
  units: ["physical", "dimensionless"],
};
const GRAVITY = 9.80665;

// The models whose balls are on the stage.
const modelsOf = ({model, r, w}) => Object.fromEntries(
  [["restitution", {r}], ["spring-damper", {contact: contactOf(r, w, "displacement")}]]
    .filter(([name]) => model === "both" || model === name));

// The state of a hash, and what in it was no value: that has its default. Names that are not in the
// hash have the values of `kept`. A scene is a state of the stage by its name. A hash with values and
// without a tab is a dimensionless case.
function parse(hash, kept = DEFAULTS) {
  const given = new URLSearchParams(hash.replace(/^#/, "")), scene = SCENES[given.get("scene")];
  const state = {...kept, ...scene?.state}, refused = [];
  if (scene) state.tab = "stage";
  else if (![...given].every(([name]) => name === "scene")) state.tab = "orbit";
  const tab = given.get("tab") ?? state.tab;
  if (given.has("scene") && !scene)
    refused.push(`scene = ${given.get("scene")} (the scenes are ${Object.keys(SCENES).join(", ")})`);
  given.delete("scene");
  for (const [name, text] of given) {
    const value = Number(text), range = rangeOf(name, tab);
    if (name in CHOICES ? CHOICES[name].includes(text)
      : range && text.trim() !== "" && value >= range[0] && value <= range[1]
        && (!WHOLE.includes(name) || Number.isInteger(value)))
      state[name] = name in CHOICES ? text : value;
    else {
      refused.push(`${name} = ${text}` + (name in DEFAULTS ? ` (in its place ${DEFAULTS[name]})` : ""));
      if (name in DEFAULTS) state[name] = DEFAULTS[name];
    }
  }
  return {state, refused};
}

// ϖ = √(k/m)/Ω of a mass in g, a frequency in Hz and a stiffness in N/m, and the stiffness of a ϖ.
const frequencyRatioOf = ({m, f, k}) => Math.sqrt(k / (m / 1000)) / (2 * Math.PI * f);
const stiffnessOf = ({m, f, w}) => m / 1000 * (2 * Math.PI * f * w) ** 2;

// The same case on another tab: ϖ and Λ become a stiffness and an acceleration, for the mass and the
// frequency that there were, and back. A value that belongs to the case already keeps its digits.
function onTab(state, tab) {
  if (tab === "design" && state.tab !== "design")
    return {...state, tab, acc: state.a, k: frequencyRatioOf(state) === state.w ? state.k : stiffnessOf(state)};
  if (tab !== "design" && state.tab === "design")
    return {...state, tab, a: state.acc, w: stiffnessOf(state) === state.k ? state.w : frequencyRatioOf(state)};
  return {...state, tab};
}

// The units of time, 1/Ω in s, and of length, g/Ω² in m, of a table of f Hz.
function scalesOf(f) {
  const time = 1 / (2 * Math.PI * f);
  return {time, length: GRAVITY * time ** 2};
}

// The contact of the physical tab in SI units, and its dimensionless groups.
function caseOf(state) {
  const {release, r, m, k, f} = state, {time, length} = scalesOf(f);
  const mass = m / 1000;
  const contact = contactOf(r, frequencyRatioOf(state), release);
  return {mass, time, length, stiffness: k, damping: 2 * contact.zeta * Math.sqrt(k * mass), contact};
}

// The longest contact, in s, of the physical tab.
const LONGEST = 1000;
// Why a state has no answer: a contact that is too long, or a ball that rises.
function impossible(state) {
  const {tab, a, r, w, phi, v, dv, dphi} = state;
  if (tab === "design") {
    const {contact, time} = caseOf(state), duration = freeAngle(contact) / dampedFrequency(contact) * time;
    return duration > LONGEST ? `a contact of ${prefixed(duration, "s")} is longer than any that is simulated, `
      + `up to ${LONGEST} s: check the mass, the stiffness and their units` : "";
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

const TABS = {
  orbit: state => ["tab", "r", "w", "a", "n", "release", "side",
    ...["t", "h", "p"].filter(name => state[name] !== DEFAULTS[name])],
  design: ({t}) => ["tab", "m", "f", "acc", "k", "r", "n", "release", ...(t === DEFAULTS.t ? [] : ["t"])],
  stage: ({model}) => ["tab", "model", "r", ...(model === "restitution" ? [] : ["w"]), "a", "phi",
    "v", "balls", "dv", "dphi", "from", "pace", "view", "units", "f"],
};
const hashOf = state => "#" + TABS[state.tab](state).map(
  name => `${name}=${encodeURIComponent(state[name])}`).join("&");

// The arguments of the models: of the physical tab, its dimensionless groups.
function questionOf(state) {
  const {r, n, release, side} = state;
  // The tolerance and the third harmonic are given in percent.
  if (state.tab === "orbit")
    return {r, n, release, side, omega: state.w, amplitude: state.a, tolerance: state.t / 100,
      harmonic: {h: state.h / 100, p: state.p}};
  const one = caseOf(state);
  // The orbit is that which is stable next to the saddle-node.
  return {n, side: "stable", amplitude: state.acc, contact: one.contact, physical: one,
    tolerance: state.t / 100};
}

function callOf(state) {
  const {r, n, a} = state;
  const spring = `SpringDamper(${state.w}, restitution=${r}, release="${state.release}")`;
  if (state.tab === "stage") {
    const balls = {restitution: `Rigid(${r})`, "spring-damper": `SpringDamper(${state.w}, restitution=${r})`};
    return Object.keys(modelsOf(state)).map(model =>
      `motion_of(${balls[model]}, amplitude=${a}, phase=${state.phi}, velocity=${state.v})`).join("\n");
  }
  if (state.tab === "orbit")
    return `orbit(${spring}, amplitude=${a}, n=${n}, side="${state.side}")`;
  return `on_shaker(mass=${state.m} / 1000, frequency=${state.f}, acceleration=${state.acc} * 9.80665, `
    + `stiffness=${state.k}, restitution=${r}, n=${n}, tolerance=${state.t} / 100)`;
}
