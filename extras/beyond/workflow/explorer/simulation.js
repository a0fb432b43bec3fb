// One ball from impact to impact, with a restitution coefficient or a spring-damper contact. δ is
// the height above the table. A contact that ends by its force leaves the ball below the table's
// level, where it may resume.
"use strict";

const TURN = 2 * Math.PI;
const reduced = angle => angle - TURN * Math.round(angle / TURN);
// Λ cos and Λ sin of a phase.
const tableAt = (phase, amplitude) => [amplitude * Math.cos(phase), amplitude * Math.sin(phase)];

// ---- The first upward zero of y after a time at which y ≤ 0, by steps that cannot pass over a
// zero: numerics.first_zero. `at` gives y, y′, y″, y‴, bounds of y″, |y‴|, |y⁗| from then on, and whether
// to stop without a zero: then there is none, and the time is infinite. NaN after too many steps.
const MOST_STEPS = 20000;
let stepsTaken = 0;
const zeroOfParabola = (bound, v, square, twice) => {
  const root = Math.sqrt(Math.max(square + bound * twice, 0));
  return v > 0 ? twice / (v + root) : (root - v) / bound;
};

function firstZero(at, start, skip = time => time) {
  let time = start;
  for (let k = 0; ; k++, stepsTaken++) {
    if (k === MOST_STEPS) return NaN;
    const {y, v, a, j, most, ended} = at(time), [second, third, fourth] = most;
    if (y >= 0 && (v > 0 || (v === 0 && a >= 0))) break;
    const twice = -2 * Math.min(y, 0), square = v * v;
    const first = zeroOfParabola(second, v, square, twice);
    let step = first;
    for (let reach = 4 * step; ; reach *= 4) {
      const growth = Math.max(j, 0) + fourth * reach / 4;
      const bound = Math.min(a + reach * growth / 3, second);
      const longer = Math.min(zeroOfParabola(Math.max(bound, 1e-300), v, square, twice), reach);
      const further = longer === reach && longer > step && reach < Infinity;
      step = Math.max(step, longer);
      if (!further) break;
    }
    if (!(v > 0)) step = Math.max(step, -3 * a / (third + 1e-300));
    const bend = (Math.abs(j) + fourth * first) * first * first;
    const near = v > 0 && second * twice <= square / 4 && bend <= 3e-4 * v;
    if (ended && !near) return Infinity;
    const later = skip(time + step);
    if (near || later === time) {
      time = later;
      break;
    }
    time = later;
  }
  // One more step of the parabola, if the zero is certainly simple.
  const {y, v, a, most} = at(time), twice = -2 * y, square = v * v;
  return v > 0 && most[0] * Math.abs(twice) <= square
    ? Math.max(start, time + twice / (v + Math.sqrt(Math.max(square + a * twice, 0)))) : time;
}

// ---- Free flight from the table: δ and its derivatives after a time (models.flight).
function flightAt({v, x, y, d = 0}, s) {
  const sine = Math.sin(s), half = Math.sin(s / 2), versine = 2 * half * half;
  return {
    gap: d + s * (v - s / 2) + y * versine + x * (s - sine), speed: v - s + y * sine + x * versine,
    pull: y + x * sine - y * versine - 1, push: x - y * sine - x * versine,
  };
}

// Where a ball that was released by its force falls back before it is above the table's level: then
// the contact resumes (models.resumption). Otherwise a time at which it is not below that level.
function resumes(left, amplitude, lag) {
  const {v, d} = left, gravity = 1 + amplitude, square = v * v + 2 * gravity * d;
  if (square > 0 && v >= 0 && Math.sqrt(square) >= lag * gravity)
    return {time: (v + Math.sqrt(square)) / gravity, back: false};
  let reached = 0;
  const forcing = amplitude * Math.hypot(1, lag);
  const at = s => {
    const {gap, speed, pull, push} = flightAt(left, s), ended = gap >= 0;
    if (ended) reached = s;
    // At the release δ + κ δ′ = 0 but for rounding; this zero is not the one that is searched for.
    return {y: s === 0 ? 0 : -(gap + lag * speed), v: -(speed + lag * pull), a: -(pull + lag * push),
      j: -(push - lag * (1 + pull)), most: [1 + forcing, forcing, forcing], ended};
  };
  const time = firstZero(at, 0);
  return Number.isFinite(time) && flightAt(left, time).gap < 0 ? {time, back: true}
    : {time: Number.isFinite(time) ? time : reached, back: false};
}

// Time, place and speed of the landing, or of the resumption of a contact.
function land(left, amplitude, lag = 0) {
  const {v, x, y, d = 0} = left, gravity = 1 + amplitude;
  // The ball cannot land while it is above the highest point of the table.
  const thrown = v + x, root = Math.sqrt(Math.max(thrown * thrown + 2 * (y + d - amplitude), 0));
  const skip = s => s >= thrown - root && s < thrown + root ? thrown + root : s;
  // It is in the air at least as long as against the strongest gravity, or, from rest on a table
  // that recedes, as the first terms of its series are positive.
  let sure = 2 * v / gravity;
  if (d < 0) {
    const {time, back} = resumes(left, amplitude, lag), {gap, speed} = flightAt(left, time);
    if (back) return {hang: time, d: gap, u: speed};
    sure = time;
  } else if (v === 0 && y >= 1) {
    const lift = y - 1, top = Math.max(amplitude, 1);
    const steep = Math.min(lift / Math.max(Math.abs(x), 1e-300), Math.sqrt(3 * lift / top));
    sure = Math.max(steep, 4 * x / top);
  }
  const at = s => {
    const {gap, speed, pull, push} = flightAt(left, s);
    return {y: -gap, v: -speed, a: -pull, j: -push, most: [gravity, amplitude, amplitude]};
  };
  const hang = firstZero(at, skip(sure), skip);
  return {hang, d: 0, u: Math.min(flightAt(left, hang).speed, 0)};
}

// ---- An impact with a restitution coefficient (models.restitution). Infinitely many ever smaller
// bounces are summed up in closed form where the next term of the sum is below rounding; the ball
// then rests until Λ sin τ = 1 on the way up, where it leaves; for Λ ≤ 1 it stays.
const pressed = (x, y) => y < 1 || (y === 1 && x <= 0);

function departByRestitution(r, amplitude, phase, u) {
  const v = -r * u, [x, y] = tableAt(phase, amplitude), gravity = 1 - y, down = pressed(x, y);
  const loss = gravity * (1 - r), usable = down && loss > 0, total = usable ? 2 * v / loss : 0;
  const limit = Math.max(1e-5 * gravity / Math.max(amplitude, 1), Number.EPSILON);
  if (!(usable && total <= limit) && !(down && v === 0))
    return {phase, v, x, y, duration: 0, settling: 0, sticks: false, stays: false};
  const settling = usable ? total * (1 + x * total / (3 * gravity)) : 0, rest = phase + settling;
  if (amplitude <= 1) return {phase: rest, settling, duration: Infinity, sticks: true, stays: true};
  const [restX, restY] = tableAt(rest, amplitude);
  if (!pressed(restX, restY))
    return {phase: rest, v: 0, x: restX, y: restY, duration: settling, settling, sticks: true};
  const slope = Math.sqrt((amplitude - 1) * (amplitude + 1)), lift = Math.atan2(1, slope);
  const turned = reduced(lift - rest), wait = turned < 0 ? turned + TURN : turned;
  return {phase: lift, v: 0, x: slope, y: 1, settling, sticks: true, stays: false,
    duration: settling + (wait > TURN - 1e-9 ? 0 : wait)};
}

// ---- A contact, until y = δ + κ δ′ first rises through 0, κ = 0 if it ends at the table's level
// (models.linear_contact). Where transient and response together stay below 1/ϖ², it does so no more.
const lagOf = contact => 2 * contact.sine / contact.omega;

function departByContact(contact, amplitude, phase, u, d = 0) {
  const {omega, zeta} = contact, stiffness = omega * omega, loss = 2 * zeta * omega, lag = lagOf(contact);
  const [x, y] = tableAt(phase, amplitude), point = {u, x, y, d};
  const damped = dampedFrequency(contact), detuning = (omega - 1) * (omega + 1);
  const gamma = detuning * detuning + loss * loss, level = 1 / stiffness;
  const along = (detuning + lag * loss) / gamma, across = (lag * detuning - loss) / gamma;
  const sine = along * x - across * y, cosine = along * y + across * x;
  const start = d + lag * u, rate = u + lag * (y - 1 - loss * u - stiffness * d);
  const a = start + (level - cosine), b = (rate - sine + loss / 2 * a) / damped;
  const envelope = Math.hypot(a, b), steady = amplitude * Math.hypot(along, across);
  const at = s => {
    const {gap, speed} = contactState(contact, point, s);
    const [tx, ty] = tableAt(phase + s, amplitude);
    const pull = ty - 1 - loss * speed - stiffness * gap, push = tx - loss * pull - stiffness * speed;
    const jerk = -ty - loss * push - stiffness * pull;
    const free = envelope * Math.exp(-loss / 2 * s), bound = stiffness * free;
    return {y: s === 0 && d < 0 ? 0 : gap + lag * speed, v: speed + lag * pull, a: pull + lag * push,
      j: push + lag * jerk, ended: free + (steady - level) <= 2e-15 * level,
      most: [bound + steady, omega * bound + steady, stiffness * bound + steady]};
  };
  const duration = firstZero(at, 0), stays = !Number.isFinite(duration), end = phase + duration;
  if (stays)
    return {point, duration: Infinity, settling: 0, sticks: true, stays, lost: Number.isNaN(duration)};
  const [leftX, leftY] = tableAt(end, amplitude), {speed} = contactState(contact, point, duration);
  const v = lag > 0 ? speed : Math.max(speed, 0);
  return {point, phase: end, v, d: -lag * v, x: leftX, y: leftY, duration, settling: 0,
    sticks: duration * damped > 2 * freeAngle(contact), stays};
}

// All impacts of a ball, from the first one on, until it stays on the table: when and at which
// phase, δ′ before it, how the ball leaves and how long it then flies. `model` is {r} or {contact}.
// Speeds are wrong by the part `grain` of themselves, to see what rounding errors would do.
function* impactsOf(model, amplitude, phase, velocity, grain = 0) {
  let time = 0, u = Math.min(velocity - amplitude * Math.cos(phase), 0), d = 0;
  for (let k = 0; ; k++) {
    const left = model.contact ? departByContact(model.contact, amplitude, phase, u, d)
      : departByRestitution(model.r, amplitude, phase, u);
    if (left.stays) {
      yield {time, at: phase, u, left, hang: Infinity};
      return;
    }
    const landed = land(left, amplitude, model.contact ? lagOf(model.contact) : 0);
    yield {time, at: phase, u, left, hang: landed.hang};
    time += left.duration + landed.hang;
    phase = reduced(left.phase + landed.hang);
    u = landed.u * (1 + (k % 2 ? grain : -grain));
    d = landed.d;
  }
}

// Height of a ball a time after one of its impacts, before the next.
function heightSince({at, left, hang}, model, amplitude, since) {
  const s = since - left.duration;
  if (s > 0) return flightAt(left, Math.min(s, hang)).gap + amplitude * Math.sin(left.phase + s);
  return (model.contact ? contactState(model.contact, left.point, since).gap : 0)
    + amplitude * Math.sin(at + since);
}

// ---- On what a ball ends: `kind`, the periods of the table and the impacts until it repeats,
// the phases of its impacts, and the greatest height at which it is thrown.
// With instantaneous impacts a ball forgets its past when it sticks, and repeats when it sticks
// again; else its state must return twice in the same number of impacts, and not almost return in
// a part of them, as it does while it slowly comes to an orbit from both sides. What larger rounding
// errors would change does not count: the ball then goes on.
// It also goes on if its long contacts take too many steps.
const SAME = 1e-7, NEAR = 1e-4, GRAIN = 1e-14, MOST_IMPACTS = 4000, MOST_WORK = 200000;
function endOf(...start) {
  const end = followed(...start, 0);
  if (end.kind === "goes on" || end.kind === "stays") return end;
  const other = followed(...start, GRAIN);
  return ["kind", "periods", "impacts"].every(name => end[name] === other[name]) ? end
    : {...end, kind: "goes on", periods: 0, impacts: 0};
}

// A ball that comes near a `known` stable orbit is on it.
function followed(model, amplitude, phase, velocity, grain, most = MOST_IMPACTS, known = null) {
  let k = 0, mark = null, turn = 0, almost = 0, lift = null, stuck = false, top = -Infinity;
  const last = stepsTaken + MOST_WORK, seen = [], end = (kind, periods, impacts, more) => ({kind, periods, impacts, top, seen, ...more});
  for (const {time, at, u, left} of impactsOf(model, amplitude, phase, velocity, grain)) {
    if (left.lost || stepsTaken > last) return end("goes on", 0, 0);
    if (left.stays) return end("stays", 1, 0, {since: time + left.settling});
    seen.push(reduced(at));
    if (known && Math.max(Math.abs(reduced(at - known.at)), Math.abs(u - known.u) / (1 + amplitude)) < ON_ORBIT)
      return end("repeats", known.periods, 1);
    const thrown = Math.max(left.v + left.x, 0);
    top = Math.max(top, left.y + (left.d ?? 0) + thrown * thrown / 2);
    if (!model.contact && left.sticks) {
      const now = time + left.duration;
      if (lift) return end("sticks", Math.round((now - lift.now) / TURN), k - lift.k);
      lift = {now, k};
    }
    const away = mark && Math.max(Math.abs(reduced(at - mark.at)), Math.abs(u - mark.u) / (1 + amplitude));
    const count = mark && k - mark.k, periods = mark && Math.round((time - mark.time) / TURN);
    if (mark && away < SAME && periods && (!almost || count % almost)) {
      if (count === turn) return end(stuck ? "sticks" : "repeats", periods, count);
      [turn, mark, stuck, almost] = [count, {k, at, u, time}, false, 0];
    } else if (!mark || k >= (turn ? mark.k + turn + 1 : 1.5 * mark.k + 8))
      [turn, mark, stuck, almost] = [0, {k, at, u, time}, false, 0];
    else if (away < NEAR && periods) almost ||= count;
    stuck ||= left.sticks;
    if (++k === most) return end("goes on", 0, 0);
  }
}

// The same in words.
const SAID = {
  stays: ({since}) => `comes to rest on the table after ${shown(since / TURN, 4)} periods, and stays`,
  repeats: ({periods, impacts}) => `repeats itself after ${counted(periods, impacts)}`,
  sticks: ({periods, impacts}) =>
    `sticks to the table, is thrown off again, and repeats itself after ${counted(periods, impacts)}`,
  "goes on": ({seen}) => `has not repeated itself within ${seen.length} impacts, or rounding errors `
    + "would decide when it does",
};
const many = (count, what) => `${count} ${what}${count === 1 ? "" : "s"}`;
const counted = (periods, impacts) =>
  `${many(periods, "period")} of the table with ${many(impacts, "impact")}`;

// ---- A ball of the package, followed again to the impact that was written down.
function ballAgain({model: kind, ball_restitution: r, ball_frequency_ratio: omega,
  ball_amplitude: amplitude, start_phase: phase, velocity, end_impact}) {
  const model = kind === "restitution" ? {r} : {contact: contactOf(r, omega, "displacement")};
  const {periods, impacts} = endOf(model, amplitude, phase, velocity);
  let last, count = -1;
  for (last of impactsOf(model, amplitude, phase, velocity)) if (++count === end_impact) break;
  return {periods, impacts, end_impact: count, end_phase: reduced(last.at), end_speed: -last.u,
    end_time: last.time + last.left.settling};
}
