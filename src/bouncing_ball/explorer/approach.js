// A damper that acts on approach only: a spring and a damper while δ′ < 0, and the spring alone while
// the ball rises. Both are linear, so that a contact is a sequence of parts in closed form.
"use strict";

const isApproach = contact => contact.release === "approach";

// The two linear contacts, of the parts with δ′ < 0 and with δ′ ≥ 0.
const partOf = ({omega, zeta}, rising) =>
  ({omega, zeta: rising ? 0 : zeta, release: "displacement", sine: 0});

// ---- Orbits. δ and δ′ are affine in u, Λ cos φ and Λ sin φ: rows of their factors and a constant.
const sumOf = (...terms) => [0, 1, 2, 3].map(k => terms.reduce((sum, [factor, row]) => sum + factor * row[k], 0));
const TABLE_ROWS = {x: [0, 1, 0, 0], y: [0, 0, 1, 0]};
function turnedBy(s) {
  const {x, y} = TABLE_ROWS, sine = Math.sin(s), cosine = Math.cos(s);
  return {x: sumOf([cosine, x], [-sine, y]), y: sumOf([cosine, y], [sine, x])};
}

// The rows a time s after a part begins with the rows d and v of δ and δ′.
function partRows({omega, zeta}, s, {d, v, x, y}) {
  const root = Math.sqrt((1 - zeta) * (1 + zeta)), angle = omega * root * s, loss = 2 * zeta * omega;
  const {g, rate, gravity, p, q} = responses(s, Math.sin(angle), Math.cos(angle), Math.sin(s), Math.cos(s),
    Math.exp(-zeta * omega * s), omega, zeta, root);
  const one = [0, 0, 0, 1];
  return {
    d: sumOf([rate + loss * g, d], [g, v], [p, x], [q, y], [-gravity, one]),
    v: sumOf([rate, v], [q, x], [g - p, y], [-omega * omega * g, d], [-g, one]),
    // How δ and δ′ follow a disturbance of both.
    matrix: [[rate + loss * g, g], [-omega * omega * g, rate]],
  };
}

const product = (a, b) => [0, 1].map(i => [0, 1].map(j => a[i][0] * b[0][j] + a[i][1] * b[1][j]));

// The equations of a cycle with a contact that turns at a time and ends at a later one: δ′ = 0 at the
// turn, δ = 0 at the end, and δ = 0 and δ′ = u after the flight.
function cycleOf(contact, n, turn, duration) {
  const flight = 2 * Math.PI * n - duration, rest = duration - turn, still = [0, 0, 0, 0], one = [0, 0, 0, 1];
  const turned = partRows(partOf(contact, false), turn, {d: still, v: [1, 0, 0, 0], ...TABLE_ROWS});
  const left = partRows(partOf(contact, true), rest, {d: turned.d, v: turned.v, ...turnedBy(turn)});
  const {x, y} = turnedBy(duration), sine = Math.sin(flight), versine = 2 * Math.sin(flight / 2) ** 2;
  const landed = sumOf([flight, left.v], [flight - sine, x], [versine, y], [-flight * flight / 2, one]);
  const struck = sumOf([1, left.v], [versine, x], [sine, y], [-flight, one], [-1, [1, 0, 0, 0]]);
  return {turned, left, flight, rows: [left.d, landed, struck]};
}

// u, Λ cos φ and Λ sin φ by three of the four equations.
const solved = rows => solver(rows.map(row => row.slice(0, 3)))(...rows.map(row => -row[3]));
const valueOf = (row, [u, x, y]) => row[0] * u + row[1] * x + row[2] * y + row[3];
const minor = (rows, columns) => {
  const [[a, b, c], [d, e, f], [g, h, i]] = rows.map(row => columns.map(k => row[k]));
  return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
};
// The determinant of all four, which has no poles, vanishes where they agree.
function disagreement(contact, n, turn, duration) {
  const {turned: {v}, rows} = cycleOf(contact, n, turn, duration);
  return v[0] * minor(rows, [1, 2, 3]) - v[1] * minor(rows, [0, 2, 3]) + v[2] * minor(rows, [0, 1, 3])
    - v[3] * minor(rows, [0, 1, 2]);
}

// Places at which a turn is looked for, and the largest angle of the damped oscillator before it.
const PLACES = 36, LATEST = 1.5 * Math.PI;

// The turn of the contact that lasts so long: the first one of a ball that strikes and goes down.
function turnOf(contact, n, duration) {
  const latest = Math.min(duration, LATEST / dampedFrequency(contact));
  const test = turn => disagreement(contact, n, turn, duration);
  const grid = Array.from({length: PLACES}, (_, k) => latest * (k + 0.5) / PLACES), values = grid.map(test);
  for (const [k, turns] of changes(values).entries()) {
    if (!turns) continue;
    const turn = rootOf(test, grid[k], grid[k + 1], values[k], values[k + 1]);
    const cycle = cycleOf(contact, n, turn, duration), at = solved(cycle.rows);
    if (at[0] < 0 && valueOf(cycle.turned.d, at) < 0) return {turn, cycle, at};
  }
  return null;
}

// The point of the branch as branchPoint has it. The vector field is continuous at the turn and at the
// release, so that a disturbance passes both as it is; at the impact δ″ jumps by -2ζϖ u.
function approachPoint(eps, contact, n) {
  const {omega, zeta} = contact, duration = (freeAngle(contact) + eps) / dampedFrequency(contact);
  const found = turnOf(contact, n, duration);
  if (!found) return {duration, amplitude: NaN, phase: NaN, u: NaN, x: NaN, y: NaN, fold: NaN, trace: NaN, determinant: NaN};
  const {turn, cycle: {turned, left, flight}, at: [u, x, y], at} = found;
  const struck = [[1, 0], [-2 * zeta * omega, 1]], flown = [[1, flight], [0, 1]];
  const through = product(product(left.matrix, turned.matrix), product(struck, flown));
  const trace = through[0][0] + through[1][1], determinant = Math.exp(-2 * zeta * omega * turn);
  const table = turnedBy(turn), point = {u, x, y};
  const parts = [
    {start: 0, contact: partOf(contact, false), point},
    {start: turn, contact: partOf(contact, true),
      point: {u: 0, d: valueOf(turned.d, at), x: valueOf(table.x, at), y: valueOf(table.y, at)}},
  ];
  // dΛ/dε vanishes with the determinant of the map less one, and has the other sign before a saddle-node.
  return {...point, duration, parts, amplitude: Math.hypot(x, y), phase: Math.atan2(y, x), trace, determinant,
    fold: trace - 1 - determinant};
}

// The part of a contact at a time after its start.
const partAt = (parts, s) => parts.findLast(({start}) => start <= s) ?? parts[0];

// Whether the ball goes down before the turn and up after it, by samples.
function turnsOnce(parts, duration) {
  if (parts.length !== 2) return false;
  for (let k = 1; k < 64; k++) {
    const s = k * duration / 64, {start, contact, point} = partAt(parts, s);
    if ((start ? -1 : 1) * contactState(contact, point, s - start).speed > 0) return false;
  }
  return true;
}

// ---- Motion: a part, and the first time at which a derivative of δ of an order 0 or 1 passes zero in
// the direction of a sign.
function partFrom(contact, rising, amplitude, phase, d, u) {
  const part = partOf(contact, rising), {omega, zeta} = part, stiffness = omega * omega, loss = 2 * zeta * omega;
  const [x, y] = tableAt(phase, amplitude), point = {u, x, y, d}, detuning = (omega - 1) * (omega + 1);
  const gamma = detuning * detuning + loss * loss, along = detuning / gamma, across = -loss / gamma;
  const sine = along * x - across * y, cosine = along * y + across * x;
  const a = d + (1 / stiffness - cosine), b = (u - sine + loss / 2 * a) / dampedFrequency(part);
  const envelope = Math.hypot(a, b), steady = amplitude * Math.hypot(along, across);
  const derivatives = s => {
    const {gap, speed} = contactState(part, point, s), [tx, ty] = tableAt(phase + s, amplitude);
    const pull = ty - 1 - loss * speed - stiffness * gap, push = tx - loss * pull - stiffness * speed;
    return [gap, speed, pull, push, -ty - loss * push - stiffness * pull];
  };
  // A ball that turns before its release is not followed to a release that an undamped spring may not have.
  const first = (order, sign, until = Infinity) => firstZero(s => {
    const [value, v, second, third] = derivatives(s).slice(order).map(z => sign * z);
    const bound = stiffness * omega ** order * envelope * Math.exp(-loss / 2 * s);
    return {y: s === 0 ? Math.min(value, 0) : value, v, a: second, j: third, ended: s >= until,
      most: [bound + steady, omega * bound + steady, stiffness * bound + steady]};
  }, 0);
  return {contact: part, point, turn: () => first(1, rising ? -1 : 1), release: until => first(0, 1, until)};
}

// A contact that turns so often does not end, or is not known to; one that stays repeats itself.
const MOST_TURNS = 1000, STILL = 1e-10;
function departByApproach(contact, amplitude, phase, u) {
  const parts = [], turns = [];
  const stays = lost => ({point: {parts}, duration: Infinity, settling: 0, sticks: true, stays: true, lost});
  let start = 0, d = 0, v = u;
  for (let k = 0; k < MOST_TURNS; k++) {
    const rising = k % 2 === 1, {turn, release, ...part} = partFrom(contact, rising, amplitude, phase + start, d, v);
    const turned = turn(), released = rising ? release(turned) : Infinity, time = Math.min(turned, released);
    parts.push({start, ...part});
    if (!Number.isFinite(time)) return stays(true);
    const {gap, speed} = contactState(part.contact, part.point, time);
    start += time;
    if (released <= turned) {
      const end = phase + start, [x, y] = tableAt(end, amplitude);
      return {point: {parts}, phase: end, v: Math.max(speed, 0), d: 0, x, y, duration: start, settling: 0,
        sticks: start * dampedFrequency(contact) > TURN, stays: false};
    }
    [d, v] = [gap, 0];
    const before = turns.find(one => Math.abs(start - one.start - TURN) < STILL * TURN);
    if (before && Math.abs(before.gap - gap) < STILL / contact.omega ** 2) return stays(false);
    turns.push({start, gap});
  }
  return stays(true);
}

// ---- Λ up to which the ball stays down. Less its depth at rest, 1/ϖ², the steady motion is
// proportional to Λ, because the damper's force is: the highest place of that at Λ = 1 decides.
const ROUNDS = 60;
function steadyPeriod(contact, d, v) {
  let time = 0, top = -Infinity, through = [[1, 0], [0, 1]];
  for (let k = 0; k < MOST_TURNS; k++) {
    const pull = -1 - contact.omega ** 2 * d, rising = v > 0 || (v === 0 && Math.sin(time) + pull > 0);
    const part = partFrom(contact, rising, 1, time, d, v), turn = part.turn(), rest = TURN - time;
    if (Number.isNaN(turn)) return null;
    const s = Math.min(turn, rest), at = contactState(part.contact, part.point, s);
    through = product(partRows(part.contact, s, {d: [0, 0, 0, 0], v: [0, 0, 0, 0], ...TABLE_ROWS}).matrix, through);
    [d, v, time] = [at.gap, turn <= rest ? 0 : at.speed, time + s];
    if (rising) top = Math.max(top, d);
    if (turn >= rest) return {d, v, top, through};
  }
  return null;
}
function approachThreshold(contact) {
  const level = 1 / contact.omega ** 2;
  // The start is that of a table so slow that the ball moves as the load does.
  let [d, v] = [-level, level], closest = Infinity, found = NaN;
  for (let round = 0; round < ROUNDS; round++) {
    const period = steadyPeriod(contact, d, v);
    if (!period) return NaN;
    const [f, g] = [period.d - d, period.v - v], {through: [[a, b], [c, e]]} = period;
    const moved = Math.hypot(f, g / contact.omega) / level;
    // Rounding is reached where the steps of Newton's method, which are quadratic, no longer shrink.
    if (moved >= closest / 2 && closest < STILL) return found;
    [closest, found] = [Math.min(moved, closest), level / (period.top + level)];
    const determinant = (1 - a) * (1 - e) - b * c;
    [d, v] = [d + ((1 - e) * f + b * g) / determinant, v + ((1 - a) * g + c * f) / determinant];
  }
  return NaN;
}
