// The first view: two balls on one table, a guess, and its answer. Only the stiffness can be changed.
"use strict";

// The ball of the replication's README: r, Λ, n and what ends a contact.
const OPENING = {r: 0.65, a: 1, n: 1, release: "displacement", side: "stable"};
const questionAt = stiff => ({n: OPENING.n, side: OPENING.side, amplitude: OPENING.a, tolerance: DEFAULTS.t / 100,
  contact: contactOf(OPENING.r, stiff, OPENING.release)});
// The relative error of the maximum height (Eq. 37).
const errorOf = stiff => answer(questionAt(stiff)).errors.max_height;

// What was guessed, and for which stiffness: the ball that flies higher, and where this begins to matter.
const guesses = {higher: null, where: null};
// The stiffness at which the heights differ by the tolerance.
const thresholdOf = () => 10 ** rootOf(power => errorOf(10 ** power) + questionAt(1).tolerance,
  ...RANGES.stiff.map(Math.log10));
const shareOf = stiff => `1/${shown(TURN / answer(questionAt(stiff)).orbits[0].contact_duration, 3)} of the table's period`;

function answered({stiff}) {
  const {higher, where} = guesses, {tolerance} = questionAt(stiff);
  const onContact = at => `${percent(errorOf(at), tolerance)} ${errorOf(at) < 0 ? "lower" : "higher"}`;
  if (!higher) return "";
  if (!where) return `${higher.guess === "rigid" ? "Yes" : "No"}: at ϖ = ${shown(higher.at, 4)} the ball on the spring `
    + `flies ${onContact(higher.at)}, because its contact acts like an impact below the surface of the table.`;
  const begins = thresholdOf(), near = where.at / begins, word = near > 2 ? "Softer" : near < 0.5 ? "Stiffer" : "Close";
  return `${word}: at your guess, ϖ = ${shown(where.at, 4)}, the ball on the spring flies ${onContact(where.at)}. `
    + `The difference is ${shown(100 * tolerance)}% at ϖ = ${shown(begins, 3)}, where a contact takes ${shareOf(begins)}.`
    + (stiff === where.at ? "" : ` At ϖ = ${shown(stiff, 4)} it flies ${onContact(stiff)}.`);
}

function showQuestion(state) {
  const {higher, where} = guesses;
  say(["none", answered(state)]);
  $("play").hidden = !higher;
  $("why").hidden = !higher;
  $("where").hidden = !higher;
  $("onward").hidden = !where;
  $("touches").textContent = "ϖ is the natural frequency of the ball on its spring over that of the table: "
    + `a contact takes ${shareOf(state.stiff)}.`;
  document.querySelectorAll("[data-guess]").forEach(button =>
    button.setAttribute("aria-pressed", button.dataset.guess === higher?.guess));
  $("all-numbers").href = hashOf({...DEFAULTS, ...OPENING, tab: "orbit", w: state.stiff});
  drawOrbit = () => drawBalls(state);
  drawOrbit();
}

// Both balls, on a block and on a spring of a length that is chosen, as in the README. They stand on the
// table until there is a guess, and then bounce; lines show their maximum heights.
const LENGTH = 1.3, RADIUS = 11, TURNS = 7;
function drawBalls({stiff}) {
  const {orbits: [exact, simple]} = answer(questionAt(stiff)), {higher} = guesses;
  const svg = $("motion"), {width, height} = svg.getBoundingClientRect(), floor = height - 26;
  const low = -1.2 * OPENING.a, scale = (floor - 2 * RADIUS - 8) / (simple.max_height + LENGTH - low);
  const y = z => floor - (z - low) * scale, half = Math.min(70, width / 8);
  const made = (...of) => svg.appendChild(element(...of));
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren(element("title", {}, "Two balls on one table: the left one on a rigid block, the right one on a spring. "
    + (higher ? `Maximum heights above the mean position of the table, in g/Ω²: ${shown(simple.max_height, 4)} and `
      + `${shown(exact.max_height, 4)}.` : "They have not been thrown yet.")));
  const balls = [["restitution", simple, "an instant"], ["spring-damper", exact, "a spring"]].map(([name, orbit, says], k) => {
    const x = width * (k ? 0.7 : 0.3), top = y(orbit.max_height + LENGTH) - 2 * RADIUS;
    made("text", {class: "name", x, y: height - 6, "text-anchor": "middle"}, says);
    if (higher) made("path", {class: `curve thin ${name}`, d: `M${x - half} ${top}H${x + half}`});
    const pad = made(k ? "path" : "rect", k ? {class: "spring", "stroke-width": 1 + Math.log10(stiff)}
      : {class: "dot table", x: x - half / 3, width: 2 * half / 3, height: LENGTH * scale});
    return {orbit, x, pad, dot: made("circle", {class: `dot ${name}`, r: RADIUS, cx: x})};
  });
  const table = made("rect", {class: "dot table", x: width * 0.3 - half, width: width * 0.4 + 2 * half, height: 5});
  motion = {end: TURN * OPENING.n, place(t) {
    const level = higher ? OPENING.a * Math.sin(t) : 0;
    table.setAttribute("y", y(level));
    balls.forEach(({orbit, x, pad, dot}, k) => {
      const ball = higher ? heightAt(orbit, t - orbit.phase) : level, rest = Math.min(ball, level) + LENGTH;
      dot.setAttribute("cy", y(ball + LENGTH) - RADIUS);
      if (!k) pad.setAttribute("y", y(level + LENGTH));
      else pad.setAttribute("d", `M${x} ${y(level)}` + Array.from({length: TURNS}, (_, i) =>
        `L${x + (i % 2 ? 9 : -9)} ${y(level + (rest - level) * (i + 0.5) / TURNS)}`).join("") + `L${x} ${y(rest)}m-15 0h30`);
    });
  }};
  motion.place(clock);
}

document.querySelectorAll("[data-guess]").forEach(button => button.addEventListener("click", () => {
  guesses.higher = {guess: button.dataset.guess, at: current.stiff};
  $("why").open = true;
  showQuestion(current);
  if (started === null && !matchMedia("(prefers-reduced-motion: reduce)").matches) $("play").click();
}));
$("there").addEventListener("click", () => {
  guesses.where = {at: current.stiff};
  showQuestion(current);
});
