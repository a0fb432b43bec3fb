// The page around the model: state in the address, controls, tables and drawings. Nothing is
// fetched and nothing is stored; every view is a hash, which can be cited.
"use strict";

// Differences above this turn the badge red: a hundred times the largest that was seen.
const BOUND = Number(document.body.dataset.bound);

// ---- The page.
const SELECTS = ["model", "pace", "view", "units", "moves", "touch"];
// Choices that give the same case otherwise.
const LIKEWISE = ["tab", "moves", "touch"];
// Values whose sliders are logarithmic.
const LOGARITHMIC = ["stiff", "w", "k", "stroke", "time"];
let current = DEFAULTS;
// A state without an answer: why, and nothing of the answer before it.
function refuse(text) {
  clearTimeout(counting);
  count = () => {};
  $("refused").textContent = text;
  document.body.toggleAttribute("data-refused", true);
  for (const id of ["verdict", "position", "others", "starts", "call"]) $(id).textContent = "";
  play(false);
}

// The balls with other starts are followed, and the address is written, a moment, in ms, after the rest
// is shown: browsers limit how often an address changes.
const PATIENCE = 200;
let counting = 0, citing = 0, count = () => {};

// The verdict; what is before its colon stands out.
function say([good, text]) {
  const [headline, ...rest] = text.split(/(?=: )/), strong = document.createElement("strong");
  strong.textContent = headline;
  $("verdict").dataset.good = good;
  $("verdict").replaceChildren(...text ? [strong, rest.join("")] : []);
}

// The scene that is on the stage, or was the last one, is marked, and leads to the next.
let scene = null;
function lead(name) {
  scene = name ?? scene;
  $("look").textContent = SCENES[name]?.look ?? "Balls on one table.";
  const links = [...document.querySelectorAll(".scenes a")];
  for (const link of links) link.setAttribute("aria-current", link.hash === `#scene=${name}`);
  const next = links[links.findIndex(link => link.hash === `#scene=${scene}`) + 1];
  $("next").textContent = next ? `Next: ${next.textContent}` : "Next: your own ball";
  $("next").href = next?.hash ?? "#tab=design";
}

function show(hash, kept = DEFAULTS) {
  clearTimeout(counting);
  clearTimeout(citing);
  count = () => {};
  const {state, refused} = parse(hash, kept), why = impossible(state);
  current = state;
  for (const [name, value] of Object.entries(state)) setControl(name, value);
  for (const control of document.querySelectorAll("[data-given]"))
    control.hidden = !givenOf({...state, tab: "design"}).includes(control.dataset.given);
  for (const tab of CHOICES.tab) {
    const on = tab === state.tab;
    $(`tab-${tab}`).setAttribute("aria-selected", on);
    $(`tab-${tab}`).tabIndex = on ? 0 : -1;
    $(`panel-${tab}`).hidden = !on;
  }
  const onStage = state.tab === "stage", asks = state.tab === "question";
  document.body.dataset.tab = state.tab;
  for (const part of document.querySelectorAll("[data-tabs]"))
    part.hidden = !part.dataset.tabs.split(" ").includes(state.tab);
  $("play").hidden = false;
  $("h-motion").textContent = asks ? "Which ball flies higher?" : "One cycle";
  $("call-name").textContent = "The same with bouncing_ball_beyond in Python:";
  if (why) return refuse(why);
  $("refused").textContent = refused.length ? `Left out: ${refused.join(", ")}.` : "";
  document.body.toggleAttribute("data-refused", false);
  $("call").textContent = callOf(state);
  if (onStage) {
    const {units, f} = state;
    const same = name => hashOf({...parse(`#scene=${name}`).state, units, f}) === hashOf(state);
    lead(Object.keys(SCENES).find(same));
    return showStage(state);
  }
  play(false);
  stage = null;
  if (asks) return showQuestion(state);
  const question = questionOf(state), comparison = answer(question);
  say(verdictOf(comparison, question));
  const others = othersOf(comparison, question);
  $("position").textContent = positionOf(comparison, question, others);
  // The button that was pressed is there still, and keeps the focus.
  const pressed = $("others").contains(document.activeElement);
  $("others").replaceChildren(...others.map(n => {
    const button = document.createElement("button");
    button.textContent = `n = ${n}`;
    button.setAttribute("aria-pressed", n === state.n);
    button.addEventListener("click", () => change("n", n));
    return button;
  }));
  if (pressed) $("others").querySelector("[aria-pressed=true]")?.focus();
  $("starts").textContent = "Following balls with other starts …";
  count = () => {
    $("starts").textContent = endsOfStarts(comparison.contact, question.amplitude, comparison.orbits[0]);
    count = () => {};
  };
  // A slider that is dragged waits for no balls.
  counting = setTimeout(() => count(), PATIENCE);
  fillTables(comparison, question);
  if (state.tab === "design") {
    $("design-rows").replaceChildren(...physical(comparison, question).map(
      ([name, value, unit, key]) => row(name, [[unit ? prefixed(value, unit) : shown(value), value, key ?? name]])));
    $("notes").replaceChildren(...notesOf(comparison, question).map(note => {
      const item = document.createElement("li");
      item.textContent = `${note}.`;
      return item;
    }));
  }
  const speed = state.n * GRAVITY / ((1 + state.r) * state.f);
  $("impact-speed").textContent = "Contact times depend on the impact speed: "
    + `n g/((1 + r) f) = ${shown(speed, 3)} m/s on the ${state.n}-T orbit of the restitution model.`;
  $("table-moves").textContent = question.physical ? "Stroke of the table, from its lowest to its highest point: "
    + `${prefixed(2 * question.amplitude * question.physical.length, "m", 3)}.` : "";
  drawOrbit = () => {
    drawBranch(comparison, question);
    drawMotion(comparison, question);
    drawMultipliers(comparison);
  };
  drawOrbit();
}

// A drawing is as wide as the page: when that changes, it is drawn again.
let drawOrbit = () => {}, width = document.body.clientWidth;
addEventListener("resize", () => {
  if (document.body.clientWidth === width) return;
  width = document.body.clientWidth;
  if (document.body.hasAttribute("data-refused")) return;
  if (current.tab === "stage") drawAround();
  else drawOrbit();
});

function setControl(name, value) {
  if (SELECTS.includes(name)) {
    $(name).value = value;
    return;
  }
  if (name in CHOICES) {
    const chosen = document.querySelector(`input[name=${name}][value=${value}]`);
    if (chosen) chosen.checked = true;
    return;
  }
  document.querySelectorAll(`input[inputmode][data-name=${name}]`).forEach(typed => {
    if (document.activeElement !== typed) typed.value = value;
    typed.removeAttribute("aria-invalid");
  });
  document.querySelectorAll(`input[type=range][data-name=${name}]`).forEach(slider => {
    slider.value = LOGARITHMIC.includes(name) ? Math.log10(value) : value;
    slider.setAttribute("aria-valuetext", shown(value));
  });
}

function change(name, value) {
  const next = LIKEWISE.includes(name) ? likewise(current, {[name]: value}) : {...current, [name]: value};
  const hash = hashOf(next);
  show(hash, next);
  citing = setTimeout(() => history.replaceState(null, "", hash), PATIENCE);
}

document.querySelectorAll("input[inputmode]").forEach(typed => typed.addEventListener("input", () => {
  const {refused} = parse(`#tab=${current.tab}&${typed.dataset.name}=${encodeURIComponent(typed.value)}`);
  if (refused.length) {
    typed.setAttribute("aria-invalid", "true");
    const [low, high] = rangeOf(typed.dataset.name, current.tab);
    const whole = WHOLE.includes(typed.dataset.name) ? "whole " : "";
    const label = document.querySelector(`label[for=${typed.id}]`).textContent;
    const units = Object.keys(UNITS[typed.dataset.name] ?? {}).join(", "), ways = otherwise(typed.value);
    refuse(`${label}: ` + (ways.length ? `instead of ${typed.value.trim()} write ${ways.join(" or ")}.`
      : `${typed.value || "this"} is not a ${whole}number from ${low} to ${high}`
        + `${units && `, alone or with a unit: ${units}`}.`));
  } else change(typed.dataset.name, numberOf(typed.value, typed.dataset.name));
}));
document.querySelectorAll("input[type=range]").forEach(slider => slider.addEventListener("input", () => {
  const {name} = slider.dataset, value = Number(slider.value);
  change(name, LOGARITHMIC.includes(name) ? nearest(10 ** value, 4) : value);
}));
for (const name of SELECTS) $(name).addEventListener("change", () => change(name, $(name).value));
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

// ---- The badge: the page against Python.
function check() {
  const {orbits, balls} = REFERENCES.references;
  const parts = [compareRows(orbits, orbitAgain), compareRows(balls, ballAgain)];
  const {worst, where} = parts.reduce((one, other) => other.worst <= one.worst ? one : other);
  const good = worst <= BOUND;
  const says = `${parts[0].count} orbits and ${parts[1].count} balls of the Python package, computed again here: `
    + `largest difference ${worst.toExponential(1)} (${where}), ${good ? "within" : "above"} ${BOUND.toExponential(0)}.`;
  $("badge").className = good ? "good" : "bad";
  $("badge").firstElementChild.textContent = `Self-check ${good ? "passed" : "FAILED"}`;
  $("checked").textContent = says;
  // Numbers that are wrong are not only said at the end of the page.
  $("warning").hidden = good;
  $("warning").textContent = good ? "" : `WRONG: ${says}`;
  $("badge").dataset.worst = String(worst);
}

window.explorer = Object.freeze({show, parse, answer, check, count: () => count(), hash: () => hashOf(current), scenes: SCENES, stage: () => stage, place});
check();
show(location.hash);
