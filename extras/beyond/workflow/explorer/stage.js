// The stage: balls of both models on one table, as time goes on; what the first of each ends on, and
// where its impacts fall in the orbit diagram.
"use strict";

// The table takes so many seconds for a period; heights are shown over the last periods.
const SECONDS = 2, SHOWN = 6, POINTS = 480;
// The diagram: Λ around the stage's, impacts left out and shown, and milliseconds at a stretch.
const COLUMNS = 160, LEFT_OUT = 200, MARKED = 50, STRETCH = 12;

// A ball, whose impacts are computed when they are needed.
class Performer {
  constructor(name, model, {a, phi, v, dphi, dv}, k) {
    this.name = name;
    this.model = model;
    this.amplitude = a;
    this.run = impactsOf(model, a, phi + k * dphi, v + k * dv);
    this.offset = phi + k * dphi;
    this.past = [this.run.next().value];
    this.coming = this.run.next().value;
  }
  // Time counts from the table's phase 0, and a ball starts at the phase of its first impact.
  since(time) { return time - this.offset; }
  until(time) {
    const last = this.since(time);
    while (this.coming && this.coming.time <= last) {
      this.past.push(this.coming);
      this.coming = this.run.next().value;
    }
    const first = last - (SHOWN + 1) * TURN;
    while (this.past.length > 1 && this.past[1].time < first) this.past.shift();
  }
  next() { return this.coming ? this.coming.time + this.offset : Infinity; }
  impacts(from, to) {
    return this.past.filter(({time}) => time > this.since(from) && time <= this.since(to));
  }
  // Heights at rising times; NaN before the first impact.
  path(times) {
    let k = 0;
    return times.map(time => {
      const now = this.since(time);
      while (k + 1 < this.past.length && this.past[k + 1].time <= now) k++;
      return now < this.past[k].time ? NaN
        : heightSince(this.past[k], this.model, this.amplitude, now - this.past[k].time);
    });
  }
}

const WITH = {restitution: "With a restitution coefficient", "spring-damper": "With a spring-damper contact"};

let stage = null;

function showStage(state) {
  const models = modelsOf(state), {a, phi, v, balls} = state;
  const ends = Object.entries(models).map(
    ([name, model]) => ({name, model, ...endOf(model, a, phi, v)}));
  $("verdict").textContent = ends.map(end =>
    `${WITH[end.name]} ${balls > 1 ? "the first ball" : "the ball"} ${SAID[end.kind](end)}.`).join(" ");
  delete $("verdict").dataset.good;
  $("stage-ends").replaceChildren(...ends.map(({name, kind, periods, impacts}) =>
    Object.assign(document.createElement("data"), {value: JSON.stringify({name, kind, periods, impacts})})));
  const performers = ends.flatMap(({name, model}) =>
    Array.from({length: balls}, (_, k) => new Performer(name, model, state, k)));
  const first = Math.max(...performers.map(({offset}) => offset)), begin = first + state.from * TURN;
  stage = {state, ends, performers, first, begin, now: begin, draw: null};
  drawAround();
}

// All drawings of the stage as it is, in the size that they have now.
function drawAround() {
  const {state, ends, now} = stage, {a} = state;
  const top = Math.max(a, ...ends.map(end => end.top), 0.5), low = -Math.max(a, 0.08 * top);
  stage.draw = drawStage(stage, [low - 0.06 * (top - low), 1.08 * top]);
  place(now);
  drawDiagram(ends, state);
}

// The scales of the stage in SI units, if it is drawn in them.
const scalesOfStage = ({units, f}) => units === "physical" ? scalesOf(f) : null;

function drawStage({performers, state}, heights) {
  const count = performers.length, {a} = state, scales = scalesOfStage(state);
  const size = ([low, high]) => Math.max(Math.abs(low), high);
  const tall = heightAxis("height", "Ω²z/g", scales, size(heights));
  const scene = new Plot("scene", [0.5, count + 0.5], heights.map(z => tall.factor * z),
    state.model === "both" ? "left: restitution, right: spring-damper" : "", tall.name,
    `${many(count, "ball")} on the table`, false);
  const gaps = state.view === "gap", level = gaps ? () => 0 : time => a * Math.sin(time);
  const range = gaps ? gapsOf(state) : heights;
  const rise = gaps ? heightAxis("gap", "Ω²δ/g", scales, size(range)) : tall;
  // The time before now counts in periods of the table, or in SI units.
  const past = scales ? physicalAxis("time before now", TURN * scales.time, "s", SHOWN)
    : {name: "time before now, in periods of the table", factor: 1};
  const trace = new Plot("trace", [-SHOWN * past.factor, 0], range.map(z => rise.factor * z), past.name, rise.name,
    `${gaps ? "Gaps between balls and" : "Heights of the balls and of the"} table over the last periods`);
  const table = scene.add("rect", {class: "dot table", x: scene.box.left, height: 4,
    width: scene.box.right - scene.box.left});
  const radius = Math.min(10, 60 / count + 2);
  const dots = performers.map(({name}, k) =>
    scene.add("circle", {class: `dot ${name}`, r: radius, cx: scene.x(k + 1)}));
  const ground = trace.add("path", {class: "curve table"});
  const curves = performers.map(({name}) => trace.add("path", {class: `curve thin ${name}`}));
  const path = (times, values, now) => times.map((t, k) => Number.isNaN(values[k]) ? ""
    : `${k && !Number.isNaN(values[k - 1]) ? "L" : "M"}${trace.x(past.factor * (t - now) / TURN).toFixed(1)} `
      + trace.y(rise.factor * values[k]).toFixed(1)).join("");
  return now => {
    const times = Array.from({length: POINTS + 1}, (_, k) => now - SHOWN * TURN * (1 - k / POINTS));
    table.setAttribute("y", scene.y(tall.factor * a * Math.sin(now)));
    ground.setAttribute("d", path(times, times.map(level), now));
    performers.forEach((ball, k) => {
      const values = ball.path(times);
      dots[k].setAttribute("cy", scene.y(tall.factor * values.at(-1)) - radius);
      curves[k].setAttribute("d", path(times, values.map((z, i) =>
        z - (gaps ? a * Math.sin(times[i]) : 0)), now));
    });
  };
}

// The range of the gaps over the periods that are shown first, or would be.
function gapsOf(state) {
  const begin = TURN * (Math.max(state.from, SHOWN) - SHOWN) + state.phi;
  const times = Array.from({length: 20 * POINTS}, (_, k) => begin + SHOWN * TURN * k / (20 * POINTS));
  const gaps = Object.entries(modelsOf(state)).flatMap(([name, model]) => {
    const ball = new Performer(name, model, state, 0);
    ball.until(times.at(-1));
    return ball.path(times).map((z, k) => z - state.a * Math.sin(times[k]));
  }).filter(gap => !Number.isNaN(gap));
  const [low, high] = [Math.min(...gaps), Math.max(...gaps)], room = 0.06 * (high - low) || 1;
  return [low - room, high + room];
}

// All that is seen at a time; later ones come after earlier ones.
function place(now) {
  const {performers, state} = stage, before = stage.now;
  performers.forEach(ball => {
    ball.until(now);
    const struck = ball.impacts(before, now);
    if (struck.length && stage.lights) stage.lights(ball, struck.at(-1));
  });
  stage.now = now;
  stage.draw(now);
  const passed = (now - stage.first) / TURN, scales = scalesOfStage(state);
  $("stage-time").textContent = scales
    ? `time since the first impact: ${(passed / state.f).toPrecision(3)} s, ${passed.toFixed(2)} periods; `
      + `${shown(SECONDS * state.f * Number(state.pace), 3)} times slower than on the table`
    : `time: ${passed.toFixed(2)} periods of the table since the first impact`;
}

// ---- The orbit diagram around the stage's Λ, from the start of the first ball, and its slice there.
let diagram = 0;
function drawDiagram(ends, state) {
  const {a, phi, v} = state, scales = scalesOfStage(state), {name: phaseName, factor} = phaseAxis(scales);
  const half = 0.3 * Math.max(a, 0.5), low = Math.max(0, a - half);
  const plot = new Plot("slice", [low, a + half], [-factor * Math.PI, factor * Math.PI],
    amplitudeName(scales), phaseName,
    "Orbit diagram around the amplitude of the stage: phases of the impacts in the long run");
  plot.line([[a, -factor * Math.PI], [a, factor * Math.PI]], "curve table");
  const mark = ++diagram, dots = (phases, lam) =>
    phases.map(phase => `M${plot.x(lam).toFixed(1)} ${plot.y(factor * phase).toFixed(1)}h0`).join("");
  for (const {name, impacts, kind, seen} of ends) {
    const phases = kind === "stays" ? [] : seen.slice(-(impacts || 300));
    plot.add("path", {class: `points slice ${name}`, d: dots(phases, a)});
  }
  const last = new Map(stage.performers.map(ball =>
    [ball, plot.add("circle", {class: `struck ${ball.name}`, r: 5, cx: plot.x(a), cy: -20})]));
  stage.lights = (ball, {at}) => last.get(ball).setAttribute("cy", plot.y(factor * reduced(at)));
  $("slice-says").textContent = `Small dots: impacts of the first ball from number ${LEFT_OUT} on, at other `
    + "amplitudes. On the line: its impacts at this one. Rings: the last impact of each ball.";
  let k = 0;
  (function columns() {
    if (mark !== diagram) return;
    for (const stop = performance.now() + STRETCH; k <= COLUMNS && performance.now() < stop; k++) {
      const lam = low + (a + half - low) * k / COLUMNS;
      for (const {name, model} of ends) {
        const phases = [];
        let count = 0;
        for (const {at, left} of impactsOf(model, lam, phi, v)) {
          if (left.stays || count++ === LEFT_OUT + MARKED) break;
          if (count > LEFT_OUT) phases.push(reduced(at));
        }
        if (phases.length) plot.add("path", {class: `points ${name}`, d: dots(phases, lam)});
      }
    }
    if (k <= COLUMNS) setTimeout(columns);
  })();
}

// ---- Play, pause, step: nothing moves before a button is pressed.
let playing = null;
function beat(at) {
  if (playing === null || !stage) return;
  // The first frame may have begun before the button was pressed.
  const passed = Math.min(Math.max(at - playing, 0) / 1000, 0.1);
  playing = at;
  place(stage.now + passed * TURN / SECONDS / Number(stage.state.pace));
  requestAnimationFrame(beat);
}
function play(on) {
  playing = on ? performance.now() : null;
  $("stage-play").textContent = on ? "Pause" : "Play";
  $("stage-play").setAttribute("aria-pressed", on);
  if (on) requestAnimationFrame(beat);
}
$("stage-play").addEventListener("click", () => play(playing === null));
$("stage-step").addEventListener("click", () => {
  play(false);
  const next = Math.min(...stage.performers.map(ball => ball.next()));
  place(Number.isFinite(next) ? next : stage.now + TURN);
});
$("stage-again").addEventListener("click", () => showStage(stage.state));
