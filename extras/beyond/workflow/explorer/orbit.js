// One orbit in the three models: the verdict on it, its drawings and its tables.
"use strict";

const NAMES = ["spring-damper", "restitution", "corrected"];
// Of their dots: each is seen where they lie upon each other.
const SIZES = [8, 5.5, 3.5];

// What a ball does that starts next to an orbit on which no ball stays, as far as the page follows contacts.
const BESIDE = 1e-3;
function insteadOf(orbit, {contact}) {
  const {amplitude, phase, impact_velocity, relative_impact_velocity: u} = orbit;
  if (!(u < 0) || isMotion(orbit)) return "";
  const end = endOf({contact}, amplitude, phase, impact_velocity * (1 + BESIDE));
  return ` A ball that starts next to it ${SAID[end.kind](end)}.`;
}

// Whether the restitution model is good enough, and the verdict as text.
function verdictOf(comparison, question) {
  const {n, side, physical, tolerance} = question, {states: [ofContact, ofSimple, ofCorrected]} = comparison;
  const [exact, simple] = comparison.orbits, error = comparison.errors.max_height, other = comparison.corrected.max_height;
  const heights = [exact, simple].map(orbit => orbit.max_height * (physical?.length ?? 1));
  const instead = insteadOf(exact, comparison);
  const alike = ofContact === ofSimple || Boolean(exact.obstacle && simple.obstacle);
  if (side === "unstable" || (alike && !isMotion(exact)))
    return ["none", `No verdict: no ball stays on the ${n}-T orbit of either model (${
      ofContact === ofSimple ? ofContact : `restitution: ${ofSimple}; contact: ${ofContact}`}).${instead}`];
  const within = Math.abs(error) <= tolerance;
  const compared = `on the ${ofContact} ${n}-T orbit the maximum height is ${lowerBy(error, tolerance)} a restitution `
    + `coefficient, ${within ? "within" : "beyond"} the tolerance of ${shown(100 * tolerance)}% `
    + `(${heightsOf(...heights, physical && "m")})`;
  if (alike && within) return [true, `The restitution model is good enough: ${compared}.`];
  const corrected = ofContact !== ofCorrected || !(Math.abs(other) <= tolerance)
    ? ". The corrected model is not good enough, either: simulate the contact."
    : exact.is_stable ? `. The height is ${lowerBy(other, tolerance)} the corrected model, which is good enough.`
      : ". The corrected model agrees with the contact.";
  return [false, "The restitution model is not good enough: " + (alike ? compared
    : `the ${n}-T orbit in this model: ${ofSimple}, on the contact: ${ofContact}`) + corrected + instead];
}

// Full lines are for balls: an orbit that is stable, and that a ball follows.
const isFull = orbit => isMotion({...orbit, obstacle: orbit.is_stable ? obstacleOf(orbit) : ""});
function drawBranch(comparison, {n, amplitude, physical: scales}) {
  const [contact, simple, corrected] = comparison.models;
  const top = 1.15 * Math.max(amplitude, 1.2,
    ...comparison.limits.map(l => Number.isFinite(l.period_doubling) ? l.period_doubling : 0));
  const {name, factor} = phaseAxis(scales), quarter = factor * Math.PI / 2;
  const plot = new Plot("branch", [0, top], [-quarter, quarter], amplitudeName(scales), name,
    `Branches of ${n}-T orbits: phase against amplitude. Saddle-node of the contact: `
    + `${shown(comparison.limits[0].saddle_node)}, period doubling: ${shown(comparison.limits[0].period_doubling)}.`);
  for (const [model, kind] of [[simple, "restitution"], [corrected, "corrected"]])
    for (const side of ["unstable", "stable"]) {
      const start = model.saddleNode(n), turned = {true: [], false: []};
      for (let k = 0; k <= 160; k++) {
        const lam = start + (top - start) * (k / 160) ** 2, at = model.orbit(n, lam, side), isOn = isFull(at);
        for (const stable of [true, false])
          turned[stable].push(isOn === stable ? [lam, factor * at.phase] : [NaN, NaN]);
      }
      plot.line(turned[true], `curve ${kind}`);
      plot.line(turned[false], `curve unstable ${kind}`);
    }
  const points = contact.drawn(n), place = at => [at.amplitude, factor * at.phase];
  const isOn = points.map(at => at.amplitude <= top && isFull(contactOrbit(at, comparison.contact, n)));
  for (const stable of [true, false])
    plot.line(points.map((at, k) => isOn[k] === stable ? place(at) : [NaN, NaN]),
      `curve ${stable ? "" : "unstable "}spring-damper`);
  contact.bifurcations(n).forEach((at, k) => plot.mark(["circle", "square"][k], ...place(at), "bifurcation"));
  comparison.orbits.forEach((orbit, k) => plot.mark("dot", amplitude, factor * orbit.phase, `dot ${NAMES[k]}`, SIZES[k]));
}

// The curves' animation: the time it started at, and the time τ that it shows.
let motion = null, started = null, clock = 0;
function drawMotion(comparison, {n, amplitude, physical: scales}) {
  const end = 2 * Math.PI * (n + 0.25), times = Array.from({length: 601}, (_, k) => k * end / 600);
  const curves = comparison.orbits.map(orbit => orbit.exists
    ? times.map(t => heightAt(orbit, t - orbit.phase)) : null);
  const heights = [amplitude, -amplitude, ...curves.flatMap(c => c ?? [])];
  const low = Math.min(...heights), high = Math.max(...heights), room = 0.05 * (high - low || 1);
  const clockAxis = scales ? physicalAxis("time", scales.time, "s", end) : {name: "time τ = Ωt", factor: 1};
  const height = heightAxis("height", "Ω²z/g", scales, high - low);
  const across = t => clockAxis.factor * t, up = z => height.factor * z;
  const plot = new Plot("motion", [0, across(end)], [up(low - room), up(high + room)], clockAxis.name, height.name,
    `Height of the ball over one cycle in the models, and of the table. Maximum heights: `
    + NAMES.map((name, k) => `${name} ${shown(up(comparison.orbits[k].max_height), 4)}`).join(", ") + ".");
  plot.line(times.map(t => [across(t), up(amplitude * Math.sin(t))]), "curve table");
  curves.forEach((curve, k) => curve
    && plot.line(times.map((t, i) => [across(t), up(curve[i])]),
      `curve ${isMotion(comparison.orbits[k]) ? "" : "unstable "}${NAMES[k]}`));
  const movers = comparison.orbits.map((orbit, k) => orbit.exists
    ? plot.add("circle", {class: `dot ${NAMES[k]}`, r: SIZES[k], cx: -20, cy: -20}) : null);
  const table = plot.add("rect", {class: "dot table", width: 18, height: 3, x: -40, y: -40});
  motion = {place(t) {
    table.setAttribute("x", plot.x(across(t)) - 9);
    table.setAttribute("y", plot.y(up(amplitude * Math.sin(t))));
    comparison.orbits.forEach((orbit, k) => {
      if (!orbit.exists) return;
      movers[k].setAttribute("cx", plot.x(across(t)));
      movers[k].setAttribute("cy", plot.y(up(heightAt(orbit, t - orbit.phase))));
    });
  }, end};
  motion.place(clock);
}

function drawMultipliers(comparison) {
  const sizes = comparison.orbits.filter(orbit => orbit.exists).flatMap(orbit => orbit.multipliers.map(m => Math.hypot(...m)));
  const span = 1.1 * Math.max(1.4, ...sizes);
  const plot = new Plot("multipliers", [-span, span], [-span, span], "real part", "imaginary part",
    "Floquet multipliers in the plane: " + NAMES.map((name, k) =>
      `${name} ${comparison.orbits[k].multipliers.map(m => `${shown(m[0], 3)} + ${shown(m[1], 3)} i`).join(" and ")}`)
      .join("; ") + ".");
  const circle = Array.from({length: 181}, (_, k) => [Math.cos(k * Math.PI / 90), Math.sin(k * Math.PI / 90)]);
  plot.line(circle, "curve table");
  comparison.orbits.forEach((orbit, k) => orbit.multipliers.forEach(
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
  phase: "phase of the impact φ", contact_duration: "duration of contact τ_b",
  impact_velocity: "velocity as the contact starts z′_i", bounce_velocity: "bouncing-off velocity z′_b",
  apparent_restitution: "apparent restitution r_a", max_height: "maximum height max z",
};
// The same quantities in the units of the physical tab.
const IN_UNITS = {
  phase: x => Number.isFinite(x) ? `${shown(x * 180 / Math.PI)}°` : "none",
  contact_duration: (x, {time}) => prefixed(x * time, "s", 6),
  impact_velocity: (x, {time}) => prefixed(x * GRAVITY * time, "m/s", 6),
  bounce_velocity: (x, {time}) => prefixed(x * GRAVITY * time, "m/s", 6),
  apparent_restitution: x => shown(x),
  max_height: (x, {length}) => prefixed(x * length, "m", 6),
};

function fillTables(comparison, question) {
  const cells = read => NAMES.map((name, k) => {
    const [text, value, key] = read(comparison.orbits[k], comparison.limits[k], k);
    return [text, value, key && `${name} ${key}`];
  });
  const scales = question.physical;
  const written = (key, x) => scales ? IN_UNITS[key](x, scales) : shown(x);
  $("orbit-units").textContent = scales ? "Λ is the acceleration of the table over g"
    : "Times Ωt, lengths Ω²z/g, velocities Ωż/g";
  $("orbit-rows").replaceChildren(
    row("stability", cells((o, l, k) => [comparison.states[k], comparison.states[k], "state"])),
    row("admissible", cells(o => [!o.exists ? "no orbit" : o.obstacle ? `no: ${o.obstacle}` : "yes"])),
    row("saddle-node Λ", cells((o, l) => [shown(l.saddle_node), l.saddle_node, "saddle_node"])),
    row("period doubling Λ", cells((o, l) => [shown(l.period_doubling), l.period_doubling, "period_doubling"])),
    ...Object.entries(ORBIT_ROWS).map(([key, name]) => row(name, cells(o => [written(key, o[key]), o[key], key]))),
    row("multipliers", cells(o => [o.exists ? o.multipliers.map(
      ([re, im]) => im ? `${shown(re, 4)} ${im < 0 ? "−" : "+"} ${shown(Math.abs(im), 4)}i` : shown(re, 4))
      .join(", ") : "none", o.multipliers.flat().join(" "), "multipliers"])),
  );
  $("error-rows").replaceChildren(...Object.entries(QUANTITIES).map(([key, name]) => row(name,
    [comparison.errors[key], comparison.corrected[key]].map((value, k) =>
      [`${signed(value, question.tolerance)}${Math.abs(value) <= question.tolerance ? ", within" : Number.isFinite(value) ? ", beyond" : ""}`,
        value, `${k ? "corrected_errors" : "errors"} ${key}`]))));
}

// Lengths, times and forces of the physical tab: words, value, unit and name.
function physical(comparison, {amplitude, physical: {mass, time, length, stiffness, damping}}) {
  const orbit = comparison.orbits[0], {omega, zeta} = comparison.contact, weight = mass * GRAVITY;
  const start = freeAngle(comparison.contact) / dampedFrequency(comparison.contact) * time;
  const {depth, force} = loadsOf(orbit);
  return [
    ["frequency ratio ϖ", omega, "", "frequency_ratio"], ["damping ratio ζ", zeta, "", "damping_ratio"],
    ["stiffness k", stiffness, "N/m", "stiffness"], ["damping c", damping, "N s/m", "damping"],
    ["natural frequency ω", omega / time, "rad/s"],
    ["restitution of a free impact", comparison.own, "", "measured_restitution"],
    ["acceleration of the table Λ", amplitude, "", "amplitude"],
    ["stroke of the table", 2 * amplitude * length, "m", "stroke"],
    ["contact time, free", start, "s", "contact_time"],
    ["largest time step, a fiftieth of it", start / 50, "s", "largest"],
    ["static deflection", weight / stiffness, "m", "static_deflection"],
    ["permanent contact up to Λ", comparison.thresholds[0], "", "permanent_contact"],
    ["maximum height", orbit.max_height * length, "m", "max_height"],
    ["duration of contact", orbit.contact_duration * time, "s", "contact_duration"],
    ["impact speed on the contact", -orbit.relative_impact_velocity * GRAVITY * time, "m/s", "impact_speed"],
    ["maximum compression (sampled)", depth * length, "m", "greatest_compression"],
    ["peak force (sampled)", force * weight, "N", "peak_force"],
    ["peak force over weight (sampled)", force, "", "peak_force_over_weight"],
    ["corrected model: delay t_c", comparison.signature.delay * time, "s", "delay"],
    ["corrected model: restitution r", comparison.signature.r, "", "restitution"],
    ["corrected model: load σ", comparison.signature.load * time, "s", "load"],
  ];
}

// Greatest compression and force of a contact, sampled.
function loadsOf(orbit) {
  let depth = orbit.exists ? 0 : NaN, force = depth;
  for (let k = 0; orbit.exists && k <= 2000; k++) {
    const at = orbit.state(k * orbit.contact_duration / 2000);
    [depth, force] = [Math.max(depth, -at.gap), Math.max(force, at.force)];
  }
  return {depth, force};
}

// Numbers n of periods for which the restitution model has an n-T orbit at this Λ on which a ball stays.
const othersOf = ({models: [, simple]}, {amplitude}) => Array.from({length: RANGES.n[1]}, (_, k) => k + 1)
  .filter(n => isFull(simple.orbit(n, amplitude, "stable")));

// The position of Λ on the range of stable n-T orbits of the restitution model, and what to ask outside.
function positionOf({models: [, simple], states}, {n, amplitude}, others) {
  const low = simple.saddleNode(n), high = simple.periodDoubling(n);
  const says = `Position of Λ = ${shown(amplitude, 4)}: ${shown((amplitude - low) / (high - low), 3)}, where 0 is the `
    + `saddle-node of the restitution model, Λ = ${shown(low, 4)}, and 1 its period doubling, Λ = ${shown(high, 4)}.`;
  if (others.includes(n)) return `${says} The n with a stable orbit at this Λ:`;
  return `${says} Here this model has no ${n}-T orbit on which a ball stays (${states[1]}; the contact: ${states[0]}). `
    + (others.length ? "Ask for an n with a stable orbit at this Λ:" : "At this Λ it has no stable orbit with n up to "
      + `${RANGES.n[1]}: the tab Stage follows balls.`);
}

// What the reader should know of the contact besides.
const notesOf = ({orbits: [orbit], contact: {zeta, omega, release}}, {n}) => [
  ...orbit.obstacle ? [`the ${n}-T orbit is inadmissible (${orbit.obstacle}), so that no ball stays on it`] : [],
  ...omega < 1 ? ["the contact is slower than the table: the ball oscillates on a spring"] : [],
  ...release === "displacement" && zeta > 0
    ? ["before its release at δ = 0 this contact pulls the ball; a measured contact ends where its force is zero"] : [],
];

// ---- The animation: it starts by its button alone.
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
