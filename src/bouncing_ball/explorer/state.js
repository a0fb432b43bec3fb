// The state of the page, which is its address: what each value may be, and the command that
// computes the same.
"use strict";

const $ = id => document.getElementById(id);
// The stage's: phase and velocity of the first impact, number of balls, by how much each of them
// differs from the one before, the periods that have passed, and how many times slower it plays.
const DEFAULTS = {
  tab: "orbit", r: 0.85, w: 10, a: 0.8, n: 1, release: "displacement", side: "stable",
  m: 20, f: 50, acc: 0.8, k: 1e7, engine: "none", e: 0.001, t: 1, given: "stiffness",
  one: "", two: "", three: "",
  model: "both", phi: 0, v: -3, balls: 1, dv: 0, dphi: 0, from: 0, pace: "1", view: "height",
};
const RANGES = {
  r: [0.001, 1], w: [0.1, 1e6], a: [0.001, 100], n: [1, 20],
  m: [1e-9, 1e9], f: [1e-6, 1e9], acc: [0.001, 100], k: [1e-9, 1e18], e: [1e-6, 0.5], t: [1e-4, 99],
  phi: [-10, 10], v: [-1000, 1000], balls: [1, 9], dv: [-10, 10], dphi: [-10, 10], from: [0, 1000],
};
// The parameters of an engine, as they are written in it.
const TEXTS = ["one", "two", "three"];
const WHOLE = ["n", "balls", "from"];
// On the stage the table may be at rest.
const rangeOf = (name, tab) => name === "a" && tab === "stage" ? [0, 100] : RANGES[name];
const REFERENCES = Object.fromEntries(["references", "engines", "quantities", "scenes"].map(
  name => [name, JSON.parse($(name).textContent)]));
const {engines: {engines: ENGINES}, quantities: QUANTITIES, scenes: SCENES} = REFERENCES;
const CHOICES = {
  tab: ["orbit", "design", "stage"], release: ["displacement", "force", "approach"], side: ["stable", "unstable"],
  engine: ["none", ...Object.keys(ENGINES)], given: ["stiffness", ...Object.keys(ENGINES)],
  model: ["both", "restitution", "spring-damper"], pace: ["1", "4", "16"], view: ["height", "gap"],
};
const GRAVITY = 9.80665;

// The models whose balls are on the stage.
const modelsOf = ({model, r, w}) => Object.fromEntries(
  [["restitution", {r}], ["spring-damper", {contact: contactOf(r, w, "displacement")}]]
    .filter(([name]) => model === "both" || model === name));

// The state of a hash, and what in it was no value: that keeps its default. A scene is a state of
// the stage by its name.
function parse(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, "")), scene = SCENES[given.get("scene")];
  const state = {...DEFAULTS, ...(scene && {tab: "stage", ...scene.state})}, refused = [];
  const tab = given.get("tab") ?? state.tab;
  if (given.has("scene") && !scene)
    refused.push(`scene = ${given.get("scene")} (the scenes are ${Object.keys(SCENES).join(", ")})`);
  given.delete("scene");
  for (const [name, text] of given) {
    const value = Number(text), range = rangeOf(name, tab);
    if (TEXTS.includes(name) || (name === "engine" && !CHOICES.engine.includes(text))) state[name] = text;
    else if (name in CHOICES ? CHOICES[name].includes(text)
      : range && text.trim() !== "" && value >= range[0] && value <= range[1]
        && (!WHOLE.includes(name) || Number.isInteger(value)))
      state[name] = name in CHOICES ? text : value;
    else refused.push(`${name} = ${text}`
      + (name in DEFAULTS ? ` (in its place ${DEFAULTS[name]})` : ""));
  }
  // Without a release in the address it is the engine's.
  if (!given.has("release")) withRelease(state);
  return {state, refused};
}

// The releases that a state of the physical tab may have: those of its engine, or of the one whose
// parameters are given.
function releasesOf({tab, engine, given}) {
  const name = engine === "none" ? given : engine;
  // Of a damper that acts on approach only there are no closed forms in dimensionless numbers.
  if (tab !== "design") return CHOICES.release.filter(rule => rule !== "approach");
  return CHOICES.release.filter(rule => !(name in ENGINES) || rule in ENGINES[name].snippets);
}
function withRelease(state) {
  const rules = releasesOf(state);
  if (!rules.includes(state.release)) [state.release] = rules;
  return state;
}

// A clause that suggests the known name that a wrong one resembles, as in bouncing_ball.errors.
function matched(a, b) {
  let best = 0, at = 0, there = 0;
  for (let i = 0; i < a.length; i++)
    for (let j = 0; j < b.length; j++) {
      let k = 0;
      while (i + k < a.length && j + k < b.length && a[i + k] === b[j + k]) k++;
      if (k > best) [best, at, there] = [k, i, j];
    }
  return best && best + matched(a.slice(0, at), b.slice(0, there)) + matched(a.slice(at + best), b.slice(there + best));
}
function didYouMean(name, known) {
  const typed = name.toLowerCase().replaceAll("_", "-");
  const alike = known.map(other => 2 * matched(other, typed) / (other.length + typed.length));
  const best = Math.max(...alike);
  return best >= 0.8 ? `; did you mean ${known[alike.indexOf(best)]}?` : "";
}

// The limits of r for ζ → 1, where it has one that is not 0.
const LEAST = {
  force: [Math.exp(-2), "e⁻²", "which ends by its force"],
  approach: [Math.exp(-1), "e⁻¹", "whose damper acts on approach only"],
};
// Why a state has no answer: an r that no contact of the engine has, or a ball that rises.
function impossible(state) {
  const {a, r, w, phi, v, dv, dphi} = state;
  const physical = state.tab === "design", {engine, given} = state;
  if (physical && !CHOICES.engine.includes(engine))
    return `unknown engine '${engine}': one of ${CHOICES.engine.slice(1).join(", ")}`
      + didYouMean(engine, CHOICES.engine.slice(1));
  if (physical && !releasesOf(state).includes(state.release)) {
    const name = engine === "none" ? given : engine;
    return `${name} has no ${state.release} release: its contacts end by ${releasesOf(state).join(" and ")}`;
  }
  if (state.tab === "orbit" && !releasesOf(state).includes(state.release))
    return `release = '${state.release}' is not one of ${releasesOf(state).join(", ")}`;
  const [least, power, ends] = LEAST[state.release] ?? [0];
  const hasLeast = engine !== "none" || state.release === "approach", of = engine === "none" ? "" : ` of ${engine}`;
  if (physical && !(given in ENGINES) && hasLeast && r <= least)
    return `r = ${r} is not above ${power} = ${shown(least, 4)}, the least of an `
      + `underdamped contact${of}, ${ends}.`;
  if (state.tab !== "stage") return "";
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

// The numbers, or the texts, by which the contact of the physical tab is given.
const givenBy = given => given in ENGINES ? TEXTS.slice(0, ENGINE_NAMES[given].length) : ["k", "r"];
const TABS = {
  orbit: ({t}) => ["r", "w", "a", "n", "release", "side", ...(t === DEFAULTS.t ? [] : ["t"])],
  design: ({engine, given, t}) => ["tab", "m", "f", "acc", ...givenBy(given), "n", "release",
    ...(t === DEFAULTS.t ? [] : ["t"]), ...(given === "stiffness" ? [] : ["given"]), ...(engine === "none" ? [] : ["engine", "e"])],
  stage: ({model}) => ["tab", "model", "r", ...(model === "restitution" ? [] : ["w"]), "a", "phi",
    "v", "balls", "dv", "dphi", "from", "pace", "view"],
};
const hashOf = state => "#" + TABS[state.tab](state).map(
  name => `${name}=${encodeURIComponent(state[name])}`).join("&");

// What the model is asked: of the physical tab, its dimensionless groups.
function asked(state) {
  const {r, n, release, side} = state;
  // The tolerance is given in percent.
  if (state.tab === "orbit")
    return {r, n, release, side, omega: state.w, amplitude: state.a, tolerance: state.t / 100};
  const one = caseOf(state);
  // `bouncing-ball design` asks for the orbit that is stable next to the saddle-node.
  return {n, side: "stable", amplitude: state.acc, contact: one.contact, physical: one,
    tolerance: state.t / 100};
}

function commandOf(state) {
  if (state.tab === "stage")
    return Object.keys(modelsOf(state)).map(model => `bouncing-ball motion --amplitude ${state.a} `
      + `--restitution ${state.r}${model === "restitution" ? "" : ` --frequency-ratio ${state.w}`} `
      + `--phase ${state.phi} --velocity ${state.v}`).join("\n");
  const {given, engine, release, r} = state;
  if (state.tab === "orbit")
    return `bouncing-ball orbit --restitution ${r} --frequency-ratio ${state.w} `
      + `--amplitude ${state.a} --n ${state.n} --release ${release} --side ${state.side}`;
  const texts = givenBy(given).filter(key => TEXTS.includes(key)).map((key, k) => [ENGINE_NAMES[given]?.[k], state[key].trim()]).filter(([, text]) => text);
  const contact = given === "stiffness" ? [`--stiffness "${state.k} N/m" --restitution ${r}`]
    : [`--from ${given}`, ...texts.map(([name, text]) =>
      given === "mujoco" ? `--${name} "${text}"` : `--set ${name}=${text}`)];
  return [`bouncing-ball design --mass "${state.m} g" --frequency "${state.f} Hz"`,
    `--acceleration "${state.acc} g"`, ...contact, `--n ${state.n}`, `--release ${release}`,
    ...(state.t === DEFAULTS.t ? [] : [`--tolerance "${state.t} %"`]),
    ...(engine === "none" ? [] : [`--engine ${engine} --restitution-error ${state.e}`])].join(" ");
}
