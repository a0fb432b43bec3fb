// The page around the model: state in the address, controls, tables and drawings. Nothing is
// fetched and nothing is stored; every view is a hash, which can be cited.
"use strict";

const $ = id => document.getElementById(id);
const NAMES = ["spring-damper", "restitution", "corrected"];
// Of their dots: each is seen where they lie upon each other.
const SIZES = [8, 5.5, 3.5];
// Points of a branch between two of the scan for its bifurcations.
const FINE = 24;
const TOLERANCE = 0.01;
// Differences above this turn the badge red: a hundred times the largest that was seen.
const BOUND = Number(document.body.dataset.bound);

// ---- State: what each value may be.
const DEFAULTS = {
  tab: "orbit", r: 0.85, w: 10, a: 0.8, n: 1, release: "displacement", side: "stable",
  m: 20, f: 50, acc: 0.8, k: 1e7, engine: "none", e: 0.001,
};
const RANGES = {
  r: [0.001, 1], w: [0.1, 1e6], a: [0.001, 100], n: [1, 20],
  m: [1e-9, 1e9], f: [1e-6, 1e9], acc: [0.001, 100], k: [1e-9, 1e18], e: [1e-6, 0.5],
};
const REFERENCES = Object.fromEntries(["references", "engines"].map(
  name => [name, JSON.parse($(name).textContent)]));
const {engines: ENGINES} = REFERENCES.engines;
const CHOICES = {
  tab: ["orbit", "design"], release: ["displacement", "force"], side: ["stable", "unstable"],
  engine: ["none", ...Object.keys(ENGINES)],
};
const GRAVITY = 9.80665;

// The state of a hash, and what in it was no value: that keeps its default.
function parse(hash) {
  const state = {...DEFAULTS}, refused = [];
  for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ""))) {
    const value = Number(text), range = RANGES[name];
    if (name in CHOICES ? CHOICES[name].includes(text)
      : range && text.trim() !== "" && value >= range[0] && value <= range[1]
        && (name !== "n" || Number.isInteger(value)))
      state[name] = name in CHOICES ? text : value;
    else refused.push(`${name} = ${text}`
      + (name in DEFAULTS ? ` (in its place ${DEFAULTS[name]})` : ""));
  }
  if (state.tab === "design" && state.engine !== "none") {
    // The engine's own rule, where it has not the one that is chosen.
    const rules = Object.keys(ENGINES[state.engine].snippets);
    if (!rules.includes(state.release)) [state.release] = rules;
  }
  return {state, refused};
}

// Why a state has no answer: an r that no contact of the engine has.
function impossible(state) {
  const least = Math.exp(-2);
  return state.tab === "design" && state.engine !== "none" && state.release === "force"
    && state.r <= least ? `r = ${state.r} is not above e⁻² = ${shown(least, 4)}, the least of an `
      + `underdamped contact of ${state.engine}, which ends by its force.` : "";
}

function hashOf(state) {
  const own = state.tab === "design" ? ["tab", "m", "f", "acc", "k", "r", "n", "release",
    ...(state.engine === "none" ? [] : ["engine", "e"])]
    : ["r", "w", "a", "n", "release", "side"];
  return "#" + own.map(name => `${name}=${encodeURIComponent(state[name])}`).join("&");
}

// What the model is asked: of the physical tab, its dimensionless groups.
function asked(state) {
  const {r, n, release, side} = state;
  if (state.tab === "orbit") return {r, n, release, side, omega: state.w, amplitude: state.a};
  const omega = Math.sqrt(state.k / (state.m / 1000)) / (2 * Math.PI * state.f);
  // The calculator asks for the orbit that is stable next to the saddle-node.
  return {r, n, release, side: "stable", omega, amplitude: state.acc,
    measured: state.engine !== "none"};
}

function commandOf(state) {
  const family = `--n ${state.n} --release ${state.release}`;
  if (state.tab === "design")
    return `bouncing-ball design --mass "${state.m} g" --frequency "${state.f} Hz" `
      + `--acceleration "${state.acc} g" --stiffness "${state.k} N/m" --restitution ${state.r} `
      + family + (state.engine === "none" ? ""
        : ` --engine ${state.engine} --restitution-error ${state.e}`);
  return `bouncing-ball orbit --restitution ${state.r} --frequency-ratio ${state.w} `
    + `--amplitude ${state.a} ${family} --side ${state.side}`;
}

// ---- Words.
const shown = (x, digits = 6) => Number.isFinite(x) ? String(Number(x.toPrecision(digits))) : "none";
const percent = x => !Number.isFinite(x) ? "none"
  : x > 0 && x < 1e-5 ? "less than 0.001 %" : `${x < 0.995 ? Number((100 * x).toPrecision(2)) : (100 * x).toFixed(0)} %`;

function prefixed(x, unit) {
  if (!Number.isFinite(x)) return "none";
  const prefixes = {9: "G", 6: "M", 3: "k", 0: "", "-3": "m", "-6": "µ", "-9": "n"};
  const power = x === 0 ? 0
    : Math.min(9, Math.max(-9, 3 * Math.floor(Math.log10(Math.abs(Number(x.toPrecision(4)))) / 3)));
  return `${shown(x / 10 ** power, 4)} ${prefixes[power]}${unit}`;
}

function verdictOf(found, {n}) {
  const [exact, simple, corrected] = found.orbits, error = found.errors.max_height;
  const wrong = exact.exists !== simple.exists
    ? (exact.exists ? `it misses the ${n}-T orbit, which the contact has`
      : `it has the ${n}-T orbit, which the contact has not`)
    : exact.is_stable !== simple.is_stable
      ? `its ${n}-T orbit ` + (simple.is_stable ? "is stable, and the contact's is not"
        : "is not stable, and the contact's is") : "";
  const same = exact.exists === corrected.exists && exact.is_stable === corrected.is_stable;
  const subject = `the greatest height of the ${n}-T orbit`;
  if (!exact.exists && !simple.exists)
    return [false, `There is no ${n}-T orbit here: the saddle-node is at Λ = `
      + `${shown(found.limits[0].saddle_node, 4)}.`];
  if (exact.exists && !exact.is_stable)
    return [false, `No ball stays on the ${n}-T orbit, because it is unstable: `
      + "bouncing-ball design says what the ball does instead."];
  if (!wrong && error <= TOLERANCE)
    return [true, `The restitution model is good enough: ${subject} is ${percent(error)} off, `
      + `within ${percent(TOLERANCE)}.`];
  return [false, `The restitution model is not good enough: `
    + `${wrong || `${subject} is ${percent(error)} off, beyond ${percent(TOLERANCE)}`}`
    + (same && found.corrected.max_height <= TOLERANCE
      ? `; the corrected restitution model is, with ${percent(found.corrected.max_height)}.`
      : "; nor is the corrected one: simulate the contact.")];
}

// ---- Drawings: SVG elements with classes, whose colours are the style sheet's.
const SVG = "http://www.w3.org/2000/svg";
function element(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

class Plot {
  constructor(id, [x0, x1], [y0, y1], xName, yName, label) {
    this.svg = $(id);
    this.svg.replaceChildren(element("title", {}, label));
    const [, , width, height] = this.svg.getAttribute("viewBox").split(" ").map(Number);
    this.box = {left: 52, right: width - 10, top: 10, bottom: height - 38};
    const {left, right, top, bottom} = this.box;
    this.x = v => left + (v - x0) / (x1 - x0) * (right - left);
    this.y = v => bottom - (v - y0) / (y1 - y0) * (bottom - top);
    this.limits = [x0, x1, y0, y1];
    this.axes(xName, yName);
  }
  axes(xName, yName) {
    const {left, right, top, bottom} = this.box, [x0, x1, y0, y1] = this.limits;
    for (const v of ticks(x0, x1)) {
      this.add("line", {class: "grid", x1: this.x(v), x2: this.x(v), y1: top, y2: bottom});
      this.add("text", {class: "tick", x: this.x(v), y: bottom + 14, "text-anchor": "middle"}, shown(v, 4));
    }
    for (const v of ticks(y0, y1)) {
      this.add("line", {class: "grid", x1: left, x2: right, y1: this.y(v), y2: this.y(v)});
      this.add("text", {class: "tick", x: left - 5, y: this.y(v) + 4, "text-anchor": "end"}, shown(v, 4));
    }
    this.add("text", {class: "name", x: (left + right) / 2, y: bottom + 32, "text-anchor": "middle"}, xName);
    const middle = (top + bottom) / 2;
    this.add("text", {class: "name", x: 13, y: middle, "text-anchor": "middle",
      transform: `rotate(-90 13 ${middle})`}, yName);
  }
  add(name, attributes, text) {
    return this.svg.appendChild(element(name, attributes, text));
  }
  line(points, kind) {
    const [x0, x1, y0, y1] = this.limits;
    let path = "", pen = false;
    for (const [x, y] of points) {
      const inside = x >= x0 && x <= x1 && y >= y0 && y <= y1;
      if (inside) path += `${pen ? "L" : "M"}${this.x(x).toFixed(2)} ${this.y(y).toFixed(2)}`;
      pen = inside;
    }
    if (path) this.add("path", {class: kind, d: path});
  }
  mark(shape, x, y, kind, size = 4.5) {
    const [x0, x1, y0, y1] = this.limits;
    if (!(x >= x0 && x <= x1 && y >= y0 && y <= y1)) return null;
    return shape === "square"
      ? this.add("rect", {class: kind, x: this.x(x) - 4, y: this.y(y) - 4, width: 8, height: 8})
      : this.add("circle", {class: kind, cx: this.x(x), cy: this.y(y), r: size});
  }
}

function ticks(low, high) {
  const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(k => k * power).find(s => s >= raw);
  const found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return found;
}

function drawBranch(found, {n, amplitude}) {
  const [contact, simple, corrected] = found.models;
  const top = 1.15 * Math.max(amplitude, 1.2,
    ...found.limits.map(l => Number.isFinite(l.period_doubling) ? l.period_doubling : 0));
  const plot = new Plot("branch", [0, top], [-0.5, 0.5], "excitation amplitude Λ", "phase φ/π",
    `Branches of ${n}-T orbits: phase against amplitude. The contact's saddle-node is at `
    + `${shown(found.limits[0].saddle_node)}, its period doubling at `
    + `${shown(found.limits[0].period_doubling)}.`);
  for (const [model, kind] of [[simple, "restitution"], [corrected, "corrected"]])
    for (const side of ["unstable", "stable"]) {
      const start = model.saddleNode(n), turned = {true: [], false: []};
      for (let k = 0; k <= 160; k++) {
        const lam = start + (top - start) * (k / 160) ** 2, at = model.orbit(n, lam, side);
        for (const stable of [true, false])
          turned[stable].push(at.is_stable === stable ? [lam, at.phase / Math.PI] : [NaN, NaN]);
      }
      plot.line(turned[true], `curve ${kind}`);
      plot.line(turned[false], `curve unstable ${kind}`);
    }
  const grid = scan(found.contact, n), stable = [], unstable = [];
  const fine = grid.slice(1).flatMap((right, k) =>
    Array.from({length: FINE}, (_, j) => grid[k] + (right - grid[k]) * j / FINE));
  for (const eps of fine) {
    const at = branchPoint(eps, found.contact, n);
    // Beyond, the ball would cross the table in contact: solutions, but of no ball.
    if (eps > 0 && !(at.u < 0)) break;
    const point = at.u < 0 ? [at.amplitude, at.phase / Math.PI] : [NaN, NaN];
    const holds = isStable(at.trace, at.determinant);
    stable.push(holds ? point : [NaN, NaN]);
    unstable.push(holds ? [NaN, NaN] : point);
  }
  plot.line(stable, "curve spring-damper");
  plot.line(unstable, "curve unstable spring-damper");
  for (const [name, shape] of [["fold", "circle"], ["flip", "square"]]) {
    const eps = contact[name](n), at = branchPoint(eps, found.contact, n);
    plot.mark(shape, at.amplitude, at.phase / Math.PI, "bifurcation");
  }
  found.orbits.forEach((orbit, k) => plot.mark("dot", amplitude, orbit.phase / Math.PI, `dot ${NAMES[k]}`, SIZES[k]));
}

let motion = null;
function drawMotion(found, {n, amplitude}) {
  const end = 2 * Math.PI * (n + 0.25), times = Array.from({length: 601}, (_, k) => k * end / 600);
  const curves = found.orbits.map(orbit => orbit.exists
    ? times.map(t => heightAt(orbit, t - orbit.phase)) : null);
  const heights = [amplitude, -amplitude, ...curves.flatMap(c => c ?? [])];
  const low = Math.min(...heights), high = Math.max(...heights), room = 0.05 * (high - low || 1);
  const plot = new Plot("motion", [0, end], [low - room, high + room], "time τ = Ωt", "height Ω²z/g",
    `Height of the ball over one cycle in the models, and of the table. Greatest heights: `
    + NAMES.map((name, k) => `${name} ${shown(found.orbits[k].max_height, 4)}`).join(", ") + ".");
  plot.line(times.map(t => [t, amplitude * Math.sin(t)]), "curve table");
  curves.forEach((curve, k) => curve && plot.line(times.map((t, i) => [t, curve[i]]), `curve ${NAMES[k]}`));
  const movers = found.orbits.map((orbit, k) => orbit.exists
    ? plot.add("circle", {class: `dot ${NAMES[k]}`, r: SIZES[k], cx: -20, cy: -20}) : null);
  const table = plot.add("rect", {class: "dot table", width: 18, height: 3, x: -40, y: -40});
  motion = {place(t) {
    table.setAttribute("x", plot.x(t) - 9);
    table.setAttribute("y", plot.y(amplitude * Math.sin(t)));
    found.orbits.forEach((orbit, k) => {
      if (!orbit.exists) return;
      movers[k].setAttribute("cx", plot.x(t));
      movers[k].setAttribute("cy", plot.y(heightAt(orbit, t - orbit.phase)));
    });
  }, end};
  motion.place(0);
}

function drawMultipliers(found) {
  const plot = new Plot("multipliers", [-1.5, 1.5], [-1.5, 1.5], "real part", "imaginary part",
    "Floquet multipliers in the plane: " + NAMES.map((name, k) =>
      `${name} ${found.orbits[k].multipliers.map(m => `${shown(m[0], 3)} + ${shown(m[1], 3)} i`).join(" and ")}`)
      .join("; ") + ".");
  const circle = Array.from({length: 181}, (_, k) => [Math.cos(k * Math.PI / 90), Math.sin(k * Math.PI / 90)]);
  plot.line(circle, "curve table");
  found.orbits.forEach((orbit, k) => orbit.multipliers.forEach(
    ([re, im]) => plot.mark("dot", re, im, `dot ${NAMES[k]}`, SIZES[k])));
}

// ---- Tables.
function row(name, cells) {
  const made = document.createElement("tr"), head = document.createElement("th");
  head.scope = "row";
  head.textContent = name;
  made.append(head, ...cells.map(([text, value, key]) => {
    const cell = document.createElement("td");
    cell.textContent = text;
    if (key) [cell.dataset.key, cell.dataset.value] = [key, String(value)];
    return cell;
  }));
  return made;
}

const ORBIT_ROWS = {
  phase: "phase of impact φ", contact_duration: "duration of contact τ_b",
  impact_velocity: "velocity before, z′_i", bounce_velocity: "bouncing-off velocity z′_b",
  apparent_restitution: "apparent restitution r_a", max_height: "greatest height max z",
};

function fillTables(found, question) {
  const cells = read => NAMES.map((name, k) => {
    const [text, value, key] = read(found.orbits[k], found.limits[k], k);
    return [text, value, key && `${name} ${key}`];
  });
  const yes = (orbit, value) => !orbit.exists ? "no orbit" : value ? "yes" : "no";
  const {contact} = found;
  $("orbit-rows").replaceChildren(
    row("exists", cells(o => [o.exists ? "yes" : "no", o.exists, "exists"])),
    row("stable", cells(o => [yes(o, o.is_stable), o.is_stable, "is_stable"])),
    row("the ball's own (sampled only)", cells(o => [yes(o, sampledAdmissible(o, contact))])),
    row("saddle-node Λ", cells((o, l) => [shown(l.saddle_node), l.saddle_node, "saddle_node"])),
    row("period doubling Λ", cells((o, l) => [shown(l.period_doubling), l.period_doubling, "period_doubling"])),
    ...Object.entries(ORBIT_ROWS).map(([key, name]) => row(name, cells(o => [shown(o[key]), o[key], key]))),
    row("multipliers", cells(o => [o.exists ? o.multipliers.map(
      ([re, im]) => im ? `${shown(re, 4)} ${im < 0 ? "−" : "+"} ${shown(Math.abs(im), 4)}i` : shown(re, 4))
      .join(", ") : "none", o.multipliers.flat().join(" "), "multipliers"])),
  );
  $("error-rows").replaceChildren(...Object.entries(QUANTITIES).map(([key, name]) => row(name,
    [found.errors[key], found.corrected[key]].map((value, k) =>
      [`${percent(value)}${value <= TOLERANCE ? ", within" : Number.isFinite(value) ? ", beyond" : ""}`,
        value, `${k ? "corrected_errors" : "errors"} ${key}`]))));
}

// Lengths, times and forces of the physical tab, by name.
function physical(found, state) {
  const mass = state.m / 1000, table = 2 * Math.PI * state.f, orbit = found.orbits[0];
  const time = 1 / table, length = GRAVITY / table ** 2, zeta = found.contact.zeta;
  const start = freeAngle(found.contact) / dampedFrequency(found.contact) * time;
  let depth = NaN, force = NaN;
  if (orbit.exists) {
    [depth, force] = [0, 0];
    for (let k = 0; k <= 2000; k++) {
      const at = orbit.state(k * orbit.contact_duration / 2000);
      [depth, force] = [Math.max(depth, -at.gap), Math.max(force, at.force)];
    }
  }
  return [
    ["frequency ratio ϖ", found.contact.omega, ""], ["damping ratio ζ", zeta, ""],
    ["damping c", 2 * zeta * Math.sqrt(state.k * mass), "N s/m"],
    ["amplitude of the table", state.acc * length, "m"],
    ["contact time, free", start, "s"], ["largest time step, a fiftieth of it", start / 50, "s"],
    ["static deflection", mass * GRAVITY / state.k, "m"],
    ["greatest height", orbit.max_height * length, "m"],
    ["duration of contact", orbit.contact_duration * time, "s"],
    ["impact speed", -orbit.relative_impact_velocity * GRAVITY / table, "m/s"],
    ["greatest compression (sampled)", depth * length, "m"],
    ["peak force (sampled)", force * mass * GRAVITY, "N"],
    ["peak force over weight (sampled)", force, ""],
    ["corrected model: delay t_c", found.signature.delay * time, "s"],
    ["corrected model: restitution r", found.signature.r, ""],
    ["corrected model: load σ", found.signature.load * time, "s"],
  ];
}

// What an engine is to be told, and the rows of it.
function showEngine(state) {
  const {engine, release, r, e} = state;
  $("paste").hidden = $("e").parentElement.hidden = engine === "none";
  if (engine === "none") return [];
  const found = settingsOf(ENGINES, engine, release, state.m / 1000, state.k, r, e);
  $("paste-says").textContent = `For ${engine}, whose contacts end by ${release} `
    + `(r = ${shown(found.restitution, 4)}, within ${e} in ${found.steps} steps of ${found.scheme} `
    + "in a contact):";
  $("snippet").textContent = found.snippet;
  return [["restitution of a free impact", found.restitution, ""],
    [`time step for an error of ${e} in r`, found.time_step, "s"]];
}

// ---- The page.
let current = DEFAULTS;
// A state without an answer: why, and nothing of the answer before it.
function refuse(text) {
  $("refused").textContent = text;
  document.body.toggleAttribute("data-refused", true);
  for (const id of ["verdict", "command", "snippet"]) $(id).textContent = "";
}

function show(hash) {
  const {state, refused} = parse(hash), why = impossible(state);
  current = state;
  for (const [name, value] of Object.entries(state)) setControl(name, value);
  for (const tab of CHOICES.tab) {
    const on = tab === state.tab;
    $(`tab-${tab}`).setAttribute("aria-selected", on);
    $(`tab-${tab}`).tabIndex = on ? 0 : -1;
    $(`panel-${tab}`).hidden = !on;
  }
  $("sides").hidden = state.tab === "design";
  const rules = state.tab === "design" && ENGINES[state.engine]?.snippets;
  for (const choice of document.querySelectorAll("input[name=release]"))
    choice.disabled = rules && !(choice.value in rules);
  if (why) return refuse(why);
  const question = asked(state), found = answer(question);
  $("refused").textContent = refused.length ? `Not a value here, and left out: ${refused.join(", ")}.` : "";
  document.body.toggleAttribute("data-refused", false);
  const [good, sentence] = verdictOf(found, question), [exact] = found.orbits;
  $("verdict").textContent = sentence + (exact.exists && !exact.is_stable
    ? ` The ${state.n}-T orbit is unstable, and no ball will keep to it.` : "");
  $("verdict").dataset.good = good;
  $("command").textContent = commandOf(state);
  fillTables(found, question);
  if (state.tab === "design")
    $("design-rows").replaceChildren(...[...showEngine(state), ...physical(found, state)].map(
      ([name, value, unit]) => row(name, [[unit ? prefixed(value, unit) : shown(value), value, name]])));
  drawBranch(found, question);
  drawMotion(found, question);
  drawMultipliers(found);
}

function setControl(name, value) {
  if (name === "engine") {
    $("engine").value = value;
    return;
  }
  if (name in CHOICES) {
    const chosen = document.querySelector(`input[name=${name}][value=${value}]`);
    if (chosen) chosen.checked = true;
    return;
  }
  document.querySelectorAll(`input[data-name=${name}]`).forEach(typed => {
    if (document.activeElement !== typed) typed.value = value;
    typed.removeAttribute("aria-invalid");
  });
  const slider = $(`slide-${name}`);
  if (slider) slider.value = name === "w" ? Math.log10(value) : value;
  if (slider) slider.setAttribute("aria-valuetext", `${name === "w" ? "ϖ = " : ""}${shown(value)}`);
}

function change(name, value) {
  const next = hashOf({...current, [name]: value});
  history.replaceState(null, "", next);
  show(next);
}

document.querySelectorAll("input[data-name]").forEach(typed => typed.addEventListener("input", () => {
  const {refused} = parse(`#${typed.dataset.name}=${encodeURIComponent(typed.value)}`);
  if (refused.length) {
    typed.setAttribute("aria-invalid", "true");
    const [low, high] = RANGES[typed.dataset.name], whole = typed.dataset.name === "n" ? "whole " : "";
    const label = document.querySelector(`label[for=${typed.id}]`).textContent;
    refuse(`${label}: ${typed.value || "this"} is not a ${whole}number from ${low} to ${high}.`);
  } else change(typed.dataset.name, Number(typed.value));
}));
document.querySelectorAll("input[type=range]").forEach(slider => slider.addEventListener("input", () => {
  const name = slider.id.slice("slide-".length), value = Number(slider.value);
  change(name, name === "w" ? Number((10 ** value).toPrecision(4)) : value);
}));
$("engine").addEventListener("change", () => change("engine", $("engine").value));
document.querySelectorAll("input[type=radio]").forEach(choice => choice.addEventListener("change",
  () => change(choice.name, choice.value)));
CHOICES.tab.forEach((tab, k) => {
  $(`tab-${tab}`).addEventListener("click", () => change("tab", tab));
  $(`tab-${tab}`).addEventListener("keydown", event => {
    const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (!step) return;
    const other = CHOICES.tab[(k + step + CHOICES.tab.length) % CHOICES.tab.length];
    change("tab", other);
    $(`tab-${other}`).focus();
  });
});
addEventListener("hashchange", () => show(location.hash));

// ---- The animation: it waits until it is asked, and for those who want no motion stays so.
let started = null, clock = 0;
function frame(now) {
  if (started === null) return;
  clock = (now - started) / 1000 * 2 % motion.end;
  motion.place(clock);
  requestAnimationFrame(frame);
}
$("play").addEventListener("click", () => {
  const on = started === null;
  started = on ? performance.now() - clock * 500 : null;
  $("play").textContent = on ? "Stop the motion" : "Play the motion";
  $("play").setAttribute("aria-pressed", on);
  if (on) requestAnimationFrame(frame);
});

// ---- The badge: the page against Python.
function check() {
  const {references} = REFERENCES, orbits = compareReferences(references);
  const engines = compareEngines(REFERENCES.engines);
  const {worst, where} = orbits.worst >= engines.worst ? orbits : engines, {count} = orbits;
  const good = worst <= BOUND;
  $("badge").className = good ? "good" : "bad";
  $("badge").textContent = `${good ? "Checked" : "WRONG"}: ${count} orbits of the Python package, commit `
    + `${references.commit.slice(0, 10)}, and ${engines.count} settings of engines, computed again here: largest difference `
    + `${worst.toExponential(1)} (${where}), ${good ? "within" : "above"} ${BOUND.toExponential(0)}.`;
  $("badge").dataset.worst = String(worst);
}

window.explorer = Object.freeze({show, parse, answer, check});
show(location.hash);
check();
