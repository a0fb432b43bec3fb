// Orbits with one impact on a linear contact, in the restitution model and in the corrected one, in
// closed form. Everything is dimensionless; docs/closed-form.md of the replication has the
// derivation. "NaN" stands for what does not exist.
"use strict";

// ---- Complex numbers [re, im], for short and resonant contacts only.
const add = (a, b) => [a[0] + b[0], a[1] + b[1]];
const times = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
const over = (a, b) => {
  const square = b[0] * b[0] + b[1] * b[1];
  return [(a[0] * b[0] + a[1] * b[1]) / square, (a[1] * b[0] - a[0] * b[1]) / square];
};

// The response to e^{νs} from rest where its quotient loses digits: the mean over a circle of 40
// points around ν (Cauchy), of the radius that stays farthest from both poles.
function circleMean(nu, s, omega, zeta, g, rate) {
  const a = zeta * omega, q = omega * omega, damped = omega * Math.sqrt((1 - zeta) * (1 + zeta));
  const poles = [[-a, damped], [-a, -damped]];
  let radius = NaN, best = -1;
  for (const factor of [1, 2, 4]) {
    const r = factor / Math.abs(s);
    const clearance = Math.min(
      ...poles.map(p => Math.abs(r - Math.hypot(nu[0] - p[0], nu[1] - p[1])) / r));
    if (clearance > best) [best, radius] = [clearance, r];
  }
  let sum = [0, 0];
  for (let k = 0; k < 40; k++) {
    const angle = 2 * Math.PI * (k + 0.5) / 40;
    const x = add(nu, [radius * Math.cos(angle), radius * Math.sin(angle)]);
    const size = Math.exp(x[0] * s), turn = x[1] * s;
    const above = add(
      [size * Math.cos(turn) - rate - (x[0] + 2 * a) * g, size * Math.sin(turn)], [0, -x[1] * g]);
    sum = add(sum, over(above, add(add(times(x, x), [2 * a * x[0], 2 * a * x[1]]), [q, 0])));
  }
  return [sum[0] / 40, sum[1] / 40];
}

// g, g′, G, Q = Re h and P = Im h a time s after the contact's start.
function responses(s, sinAngle, cosAngle, sinS, cosS, decay, omega, zeta, root) {
  const stiffness = omega * omega, loss = 2 * zeta * omega, detuning = stiffness - 1;
  const g = decay * sinAngle / (omega * root);
  const rate = decay * (cosAngle - zeta / root * sinAngle);
  const rest = rate + loss * g, gamma = detuning * detuning + loss * loss, square = s * s;
  const size = Math.min(gamma * square, stiffness * stiffness * square) * square;
  if (s === 0) return {g, rate, gravity: 0, q: 0, p: 0};
  if (size < 0.25) {
    const gravity = circleMean([0, 0], s, omega, zeta, g, rate)[0];
    const [q, p] = circleMean([0, 1], s, omega, zeta, g, rate);
    return {g, rate, gravity, q, p};
  }
  const real = cosS - rest, imaginary = sinS - g;
  return {
    g, rate, gravity: (1 - rest) / stiffness,
    q: (real * detuning + imaginary * loss) / gamma,
    p: (imaginary * detuning - real * loss) / gamma,
  };
}

function solver([a, b, c]) {
  const bc = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
  const ca = [c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0]];
  const ab = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const determinant = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
  const inverse = 1 / (determinant === 0 ? NaN : determinant);
  return (s, t, v) => [0, 1, 2].map(k => (s * bc[k] + t * ca[k] + v * ab[k]) * inverse);
}

// ---- The contact.
// ζ with which a free impact has r: by Eq. 16 if it ends at δ = 0, and if it ends where its force is
// zero the root of r = exp[-ζ(π - 2 arcsin ζ)/√(1 - ζ²)], which is below 1 for r > e⁻² only.
function dampingOf(r, release) {
  const decrement = -Math.log(r) + 0;
  if (release !== "force") return decrement / Math.hypot(Math.PI, decrement);
  const surplus = zeta => 2 * zeta * Math.acos(zeta) / Math.sqrt((1 - zeta) * (1 + zeta)) - decrement;
  return decrement < 2 ? rootOf(surplus, 0, 1 - Number.EPSILON) : NaN;
}
// ϖ, ζ < 1, and sin α = κϖ/2 of the release rule.
function contactOf(r, omega, release) {
  const zeta = dampingOf(r, release);
  return {omega, zeta, release, sine: release === "force" ? zeta : 0};
}
// The angle at which a free contact ends: Release.free_angle.
const freeAngle = contact => 2 * Math.acos(contact.sine);
const dampedFrequency = contact =>
  contact.omega * Math.sqrt((1 - contact.zeta) * (1 + contact.zeta));
function ownRestitution(contact) {
  const z = contact.zeta;
  return Math.exp(-freeAngle(contact) * z / Math.sqrt((1 - z) * (1 + z)));
}

// The n-T orbit whose contact lasts (θ₀ + ε)/ϖ_d: branch_point of
// periodic.one_impact.spring_damper_branch.
function branchPoint(eps, contact, n) {
  const {omega, zeta, sine} = contact;
  const root = Math.sqrt((1 - zeta) * (1 + zeta)), perAngle = 1 / (omega * root);
  const duration = (freeAngle(contact) + eps) * perAngle, flight = 2 * Math.PI * n - duration;
  const loss = 2 * zeta * omega, stiffness = omega * omega;
  const twice = 2 * sine, lag = 2 * sine / omega;
  const sinEps = Math.sin(eps), cosEps = Math.cos(eps);
  const sin2a = twice * Math.sqrt((1 - sine) * (1 + sine)), cos2a = 1 - twice * sine;
  const sinHalf = Math.sin(duration / 2), cosHalf = Math.cos(duration / 2);
  const sinD = 2 * sinHalf * cosHalf, versine = -2 * sinHalf * sinHalf, cosD = 1 + versine;
  const decay = Math.exp(-zeta * omega * duration);
  const {g, rate: dg, gravity, q, p} = responses(
    duration, sin2a * cosEps - cos2a * sinEps, -cos2a * cosEps - sin2a * sinEps,
    sinD, cosD, decay, omega, zeta, root);
  const ddg = -loss * dg - stiffness * g, dq = g - p, ddq = dg - q, ddp = g - p;
  const push = -decay / root * sinEps;
  const dPush = decay / root * (zeta * omega * sinEps - omega * root * cosEps);
  const rows = [
    [push, omega * p + twice * q, omega * q + twice * dq],
    [dg - 1, q + versine, dq - sinD],
    [flight - lag * dg, flight + sinD - lag * q, versine - lag * dq],
  ];
  const slopes = [
    [dPush, omega * q + twice * ddp, omega * dq + twice * ddq],
    [ddg, ddp - sinD, ddq - cosD],
    [-1 - lag * ddg, versine - lag * ddp, -sinD - lag * ddq],
  ];
  const solve = solver(rows);
  const right = [omega * gravity + twice * g, g + flight, -flight * flight / 2 - lag * g];
  const dRight = [omega * g + twice * dg, dg - 1, flight - lag * dg];
  const [u, x, y] = solve(...right);
  const [, dX, dY] = solve(
    ...slopes.map((row, k) => dRight[k] - (row[0] * u + row[1] * x + row[2] * y)));
  const amplitude = Math.sqrt(x * x + y * y);
  return {
    duration, x, y, u, amplitude, phase: Math.atan2(y, x), fold: (x * dX + y * dY) * perAngle,
    trace: traceOf(contact, flight, [u, x, y], sinD, cosD, {g, dg, p, q, dq}, push),
    determinant: decay * decay,
  };
}

function traceOf({omega, zeta, sine}, flight, [u, x, y], sinD, cosD, at, push) {
  const {g, dg, p, q, dq} = at;
  const bounce = u * dg + x * q + y * dq - g;
  const leaving = x * cosD - y * sinD, lifted = y * cosD + x * sinD;
  const byPhase = x * q - y * p, byPhaseRate = x * dq - y * q;
  const acceleration = lifted - 1 - 2 * (zeta - sine) * omega * bounce;
  const slope = omega * bounce + 2 * sine * acceleration;
  const stays = [-(omega * byPhase + 2 * sine * byPhaseRate) / slope, -push / slope];
  const columns = [[stays[0], byPhaseRate, byPhase, 1], [stays[1], dg, g, 0]].map(
    ([stay, direct, displaced, moved]) => {
      const releasePhase = moved + stay;
      const risen = displaced + bounce * stay + leaving * releasePhase;
      const thrown = direct + acceleration * stay - lifted * releasePhase;
      const hang = -(risen + flight * thrown - x * releasePhase) / u;
      const landing = releasePhase + hang;
      return [landing, thrown - hang + y * landing];
    });
  return columns[0][0] + columns[1][1];
}

// ---- Roots, as periodic.one_impact.spring_damper_bifurcations finds them.
// Chandrupatla's method, to four units in the last place of the root.
function rootOf(f, a, b, fa = f(a), fb = f(b)) {
  if (fa === 0) return a;
  if (fb === 0) return b;
  let c = a, fc = fa, t = 0.5;
  for (let k = 0; k < 200; k++) {
    const x = a + t * (b - a), fx = f(x);
    if (Math.sign(fx) === Math.sign(fa)) [c, fc] = [a, fa];
    else [c, b, fc, fb] = [b, a, fb, fa];
    [a, fa] = [x, fx];
    const [m, fm] = Math.abs(fa) < Math.abs(fb) ? [a, fa] : [b, fb];
    const least = 4 * Number.EPSILON * Math.abs(m) + Number.MIN_VALUE;
    const limit = least / Math.abs(b - c);
    if (limit > 0.5 || fm === 0 || Number.isNaN(fx)) return m;
    const xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    t = phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi
      ? fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
      : 0.5;
    t = Math.min(1 - limit, Math.max(limit, t));
  }
  return a;
}

function range(contact, n) {
  const start = freeAngle(contact), full = dampedFrequency(contact) * 2 * Math.PI * n;
  const high = full * (1 - 1e-6) - start;
  return [Math.min(-start * (1 - 1e-3), high), high];
}

const STEPS = Array.from({length: 60}, (_, k) => k / 59);
function scan(contact, n) {
  const [low, high] = range(contact, n), small = Math.min(1e-3 / contact.omega, -low / 2);
  const down = STEPS.map(s => -small * (-low / small) ** (1 - s));
  const up = STEPS.map(s => small * Math.max(high / small, 1) ** s);
  return [...down, 0, ...up].map(x => Math.min(x, high));
}

const changes = values => values.slice(1).map(
  (right, k) => (values[k] < 0 && right >= 0) || (values[k] >= 0 && right < 0));

// First, or last, zero of a test function along a grid; no pole is taken for one.
function zeroOn(test, grid, last = false) {
  const values = grid.map(test), turns = changes(values);
  const k = last ? turns.lastIndexOf(true) : turns.indexOf(true);
  if (k < 0) return NaN;
  const root = rootOf(test, grid[k], grid[k + 1], values[k], values[k + 1]);
  return Math.abs(test(root)) <= Math.min(Math.abs(values[k]), Math.abs(values[k + 1]))
    ? root : NaN;
}

function saddleNode(contact, n) {
  const at = eps => branchPoint(eps, contact, n);
  const root = zeroOn(eps => 1 - at(eps).trace + at(eps).determinant, scan(contact, n));
  const width = 1e-4 * Math.min(Math.abs(root), 1 / contact.omega);
  const left = at(root - width).fold, right = at(root + width).fold;
  return left * right < 0
    ? rootOf(eps => at(eps).fold, root - width, root + width, left, right) : root;
}

function periodDoubling(contact, n, fold = saddleNode(contact, n)) {
  const end = Number.isNaN(fold) ? range(contact, n)[1] : fold;
  const at = eps => branchPoint(eps, contact, n);
  const grid = scan(contact, n).map(x => Math.min(x, end));
  return zeroOn(eps => 1 + at(eps).trace + at(eps).determinant, grid, true);
}

// ε of the n-T orbit at Λ on the side that is stable next to the saddle-node, or the other.
function excessAt(contact, n, amplitude, side, fold) {
  const surplus = eps => branchPoint(eps, contact, n).amplitude - amplitude;
  const [low, high] = range(contact, n);
  if (side === "stable") {
    const end = Number.isNaN(fold) ? high : fold, above = surplus(low), below = surplus(end);
    return above > 0 && below <= 0 ? rootOf(surplus, low, end, above, below) : NaN;
  }
  if (Number.isNaN(fold)) return NaN;
  const step = 1e-3 / contact.omega;
  const outward = STEPS.map(s => Math.min(fold + step * Math.max((high - fold) / step, 1) ** s, high));
  const folds = outward.map(eps => branchPoint(eps, contact, n).fold);
  const turn = changes(folds).indexOf(true);
  const summit = turn < 0 ? high : rootOf(
    eps => branchPoint(eps, contact, n).fold, outward[turn], outward[turn + 1]);
  const grid = [fold, ...outward, summit].sort((a, b) => a - b);
  const values = grid.map(surplus), k = changes(values).indexOf(true);
  return k < 0 ? NaN : rootOf(surplus, grid[k], grid[k + 1], values[k], values[k + 1]);
}

// ---- Orbits: what every model says of one.
function multipliersOf(trace, determinant) {
  const half = trace / 2, inside = half * half - determinant;
  if (inside < 0) {
    const root = Math.sqrt(-inside), sign = half < 0 ? -1 : 1;
    return [[half, sign * root], [half, -sign * root]];
  }
  const first = half + (half < 0 ? -1 : 1) * Math.sqrt(inside);
  return [[first, 0], [first === 0 ? 0 : determinant / first, 0]];
}
// As `is_stable` of the replication: without damping, where the determinant is 1, marginally.
const isStable = (trace, determinant) =>
  Math.abs(trace) < 1 + determinant - 1e-9 && determinant < 1 + 1e-9;
// What an orbit at Λ is, in words for each model.
function stateOf({exists, is_stable, trace, determinant, amplitude, obstacle}, limits) {
  if (!exists) return amplitude < limits.saddle_node ? "below the saddle-node" : "no orbit";
  if (obstacle) return `no ball follows it: ${obstacle}`;
  if (!is_stable) return trace < 0 ? "doubled" : "unstable";
  return determinant > 1 - 1e-9 ? "marginally stable" : "stable";
}

function described(n, amplitude, phase, duration, impact, trace, determinant, more) {
  const flight = 2 * Math.PI * n - duration, bounce = impact + flight;
  const u = impact - amplitude * Math.cos(phase);
  const released = bounce - amplitude * Math.cos(phase + duration);
  const bounceHeight = more.bounceHeight
    ?? amplitude * Math.sin(phase) - (bounce + impact) / 2 * flight;
  const rising = Math.max(bounce, 0);
  return {
    n, amplitude, phase, contact_duration: duration, impact_velocity: impact,
    bounce_velocity: bounce, apparent_restitution: -released / u,
    max_height: bounceHeight + rising * rising / 2, relative_impact_velocity: u, bounceHeight,
    trace, determinant, multipliers: multipliersOf(trace, determinant),
    is_stable: isStable(trace, determinant), exists: Number.isFinite(phase), ...more,
  };
}

// The motion a time s after the contact's start at δ = d, which is 0 unless a contact resumes.
function contactState(contact, point, s) {
  const {omega, zeta} = contact, {d = 0} = point, root = Math.sqrt((1 - zeta) * (1 + zeta));
  const angle = omega * root * s, loss = 2 * zeta * omega;
  const at = responses(s, Math.sin(angle), Math.cos(angle), Math.sin(s), Math.cos(s),
    Math.exp(-zeta * omega * s), omega, zeta, root);
  const gap = point.u * at.g - at.gravity + point.x * at.p + point.y * at.q + d * (at.rate + loss * at.g);
  const speed = point.u * at.rate - at.g + point.x * at.q + point.y * (at.g - at.p) - d * omega * omega * at.g;
  const table = point.x * Math.sin(s) + point.y * Math.cos(s);
  return {gap, speed, height: gap + table,
    velocity: speed + point.x * Math.cos(s) - point.y * Math.sin(s),
    force: -(loss * speed + omega * omega * gap),
    grip: -gap - 2 * contact.sine / omega * speed};
}

function contactOrbit(point, contact, n) {
  const {amplitude, phase, duration, u, x, trace, determinant} = point;
  const orbit = described(n, amplitude, phase, duration, u + x, trace, determinant, {contact});
  orbit.inContact = s => contactState(contact, point, s).height;
  orbit.state = s => contactState(contact, point, s);
  if (orbit.max_height < amplitude) orbit.max_height = Math.max(orbit.max_height, highest(orbit));
  return orbit;
}

// Greatest height in a long contact, which may carry the ball above its flight.
function highest({contact_duration: end, state}) {
  let best = 0, top = -Infinity;
  for (let k = 0; k <= 32; k++) {
    const {height} = state(k * end / 32);
    if (height > top) [top, best] = [height, k];
  }
  let low = Math.max(0, best - 1) * end / 32, high = Math.min(32, best + 1) * end / 32;
  if (state(low).velocity > 0 && state(high).velocity < 0)
    return state(rootOf(s => state(s).velocity, low, high)).height;
  return top;
}

const spaced = (sign, amplitude, level) =>
  Math.atan2(sign * Math.sqrt((amplitude - level) * (amplitude + level)), level);

const restitutionModel = r => ({
  name: "restitution",
  saddleNode: n => n * Math.PI * (1 - r) / (1 + r),
  periodDoubling(n) { return Math.hypot(2 * (1 + r * r) / (1 + r) ** 2, this.saddleNode(n)); },
  orbit(n, amplitude, side) {
    const fold = this.saddleNode(n);
    const phase = amplitude >= fold ? spaced(side === "stable" ? 1 : -1, amplitude, fold) : NaN;
    const trace = 1 + r * r - (1 + r) ** 2 * amplitude * Math.sin(phase);
    return described(n, amplitude, phase, 0, -n * Math.PI, trace, r * r, {});
  },
});

// Of the contact's signature: delay t_c, restitution r, load σ and duration D.
function signatureOf(contact) {
  const r = ownRestitution(contact), duration = freeAngle(contact) / dampedFrequency(contact);
  const through = duration + 2 * contact.sine / contact.omega;
  const loss = 2 * contact.zeta / contact.omega;
  return {delay: r * through / (1 + r), r, load: (1 - r) * through - loss * (1 + r), duration};
}

const correctedModel = ({delay, r, load, duration}) => ({
  name: "corrected",
  level: n => n * Math.PI * (1 - r) - load,
  saddleNode(n) { return this.level(n) >= 0 ? this.level(n) / Math.hypot(1 + r, load) : NaN; },
  periodDoubling(n) {
    const half = n * Math.PI, rest = half - delay, a = 1 + r, b = -load, s = this.level(n);
    const c = rest * load - (1 - r), d = rest * (1 + r) - (1 - r) * delay;
    const t = half * (1 + r) - 2 * delay, determinant = a * d - b * c;
    const x = (s * d - b * t) / determinant, y = (a * t - s * c) / determinant;
    return (1 + r) * y + load * x > 0 && rest > 0 ? Math.hypot(x, y) : NaN;
  },
  orbit(n, amplitude, side) {
    const radius = Math.hypot(1 + r, load), across = radius * amplitude, level = this.level(n);
    const sign = side === "stable" ? 1 : -1, half = n * Math.PI;
    const psi = across >= Math.abs(level)
      ? spaced(sign, across, level) - Math.atan2(load, 1 + r) : NaN;
    const x = amplitude * Math.cos(psi), y = amplitude * Math.sin(psi);
    const byPhase = -(1 + r) * y - load * x, speed = half + x - delay * (1 - y);
    const rest = 2 * half - delay;
    const trace = 1 - r + (rest * (byPhase + r) - delay) / speed;
    const determinant = (rest * r - delay - delay * byPhase) / speed - r;
    const after = duration - delay, height = y - (half + x) * delay;
    const bounce = half - after, bounceHeight = height + (bounce + after / 2) * after;
    const orbit = described(
      n, amplitude, psi - delay, duration, delay - half, trace, determinant, {bounceHeight});
    orbit.inContact = s => {
      const since = s - delay;
      return height + ((since < 0 ? -half : half) - since / 2) * since;
    };
    return orbit;
  },
});

// Points of a branch between two of the scan for its bifurcations.
const FINE = 24;
function contactModel(contact) {
  const folds = new Map(), flips = new Map();
  const of = (cache, n, find) => cache.has(n) ? cache.get(n) : cache.set(n, find()).get(n);
  return {
    name: "spring-damper",
    fold: n => of(folds, n, () => saddleNode(contact, n)),
    // The branch as it is drawn, with a gap where the ball would rise at the touch.
    drawn(n) {
      const grid = scan(contact, n), points = [];
      for (const [k, right] of grid.slice(1).entries())
        for (let j = 0; j < FINE; j++) {
          const eps = grid[k] + (right - grid[k]) * j / FINE, point = branchPoint(eps, contact, n);
          // Beyond, the ball would cross the table in contact: solutions, but of no ball.
          if (eps > 0 && !(point.u < 0)) return points;
          points.push(point.u < 0 ? point : {...point, amplitude: NaN});
        }
      return points;
    },
    bifurcations(n) { return [this.fold(n), this.flip(n)].map(eps => branchPoint(eps, contact, n)); },
    flip(n) { return of(flips, n, () => periodDoubling(contact, n, this.fold(n))); },
    // Without damping the orbits begin at Λ = 0, without a bifurcation.
    saddleNode(n) { return contact.zeta ? branchPoint(this.fold(n), contact, n).amplitude : 0; },
    periodDoubling(n) { return branchPoint(this.flip(n), contact, n).amplitude; },
    // Below the saddle-node there is none, even if a branch of long contacts comes down so far.
    orbit(n, amplitude, side) {
      const eps = amplitude < this.saddleNode(n) ? NaN : excessAt(contact, n, amplitude, side, this.fold(n));
      const orbit = contactOrbit(branchPoint(eps, contact, n), contact, n);
      return {...orbit, n, amplitude};
    },
  };
}

// Height of the ball a time since its impact, in any of the models.
function heightAt(orbit, since) {
  const period = 2 * Math.PI * orbit.n, s = ((since % period) + period) % period;
  if (s < orbit.contact_duration) return orbit.inContact(s);
  const t = s - orbit.contact_duration;
  return orbit.bounceHeight + (orbit.bounce_velocity - t / 2) * t;
}

// Λ up to which the ball stays down: Λ_SD (Eq. 33), or Λ_F.
function permanentContact(contact) {
  const {omega, zeta, sine} = contact;
  const loss = 2 * zeta / omega, lag = 2 * sine / omega;
  return Math.hypot((1 - 1 / omega) * (1 + 1 / omega), loss) / Math.hypot(1, lag);
}

// Why no ball follows an orbit, empty if a ball does: it does not land, its contact has an earlier
// release, or its flight an earlier impact. Both are the first zeros that a ball on the stage meets.
const EARLIER = 1e-6;
function obstacleOf({exists, n, amplitude, phase, contact_duration: lasts, bounce_velocity, bounceHeight,
  relative_impact_velocity: u, contact}) {
  if (!exists) return "";
  if (!(u < 0)) return "the ball does not land";
  if (contact && !(departByContact(contact, amplitude, phase, u).duration > lasts * (1 - EARLIER)))
    return "a contact ends earlier";
  const leaves = phase + lasts, [x, y] = tableAt(leaves, amplitude), flight = TURN * n - lasts;
  const d = contact && !contact.sine ? 0 : bounceHeight - y;
  const {hang} = land({v: bounce_velocity - x, x, y, d}, amplitude, contact ? lagOf(contact) : 0);
  // An orbit of the corrected model lands at the level of its own table.
  return hang > flight - EARLIER - (contact ? 0 : lasts) ? "" : "a flight passes below the table";
}

// A ball stays on an orbit that it can follow and that is stable.
const isMotion = ({exists, obstacle, is_stable}) => exists && !obstacle && is_stable;

// All that the page shows of one state.
function answer({contact, amplitude, n, side = "stable"}) {
  const own = ownRestitution(contact), signature = signatureOf(contact);
  const models = [contactModel(contact), restitutionModel(own), correctedModel(signature)];
  const orbits = models.map(model => model.orbit(n, amplitude, side));
  for (const orbit of orbits) orbit.obstacle = obstacleOf(orbit);
  const limits = models.map(m => ({saddle_node: m.saddleNode(n), period_doubling: m.periodDoubling(n)}));
  const thresholds = [permanentContact(contact), 1, 1];
  const value = (name, k) => name === "permanent_contact" ? thresholds[k]
    : name in limits[k] ? limits[k][name] : orbits[k].exists && !orbits[k].obstacle ? orbits[k][name] : NaN;
  // Errors of a simple model (Eqs. 37 and 38): negative where it has too much. That of a phase is a
  // share of a period.
  const errors = k => Object.fromEntries(Object.keys(QUANTITIES).map(name => [name,
    (value(name, 0) - value(name, k)) / (name === "phase" ? 2 * Math.PI : value(name, k))]));
  const states = orbits.map((orbit, k) => stateOf(orbit, limits[k]));
  return {contact, own, models, orbits, limits, states, thresholds, signature, errors: errors(1), corrected: errors(2)};
}

// ---- What the package computed, computed again: the largest difference over the size of each
// quantity, and where. `again` gives a row's quantities; those that are only given are not compared.
function compareRows({names, rows}, again) {
  let worst = 0, where = "";
  rows.forEach((row, k) => {
    const expected = Object.fromEntries(names.map((name, i) => [name, row[i]]));
    for (const [name, computed] of Object.entries(again(expected))) {
      const difference = expected[name] === null ? (Number.isNaN(computed) ? 0 : Infinity)
        : Math.abs(computed - expected[name]) / Math.max(1, Math.abs(expected[name]));
      if (!(difference <= worst)) [worst, where] = [difference, `${name}, row ${k}`];
    }
  });
  return {worst, where, count: rows.length};
}

function orbitAgain({release, restitution: r, frequency_ratio: omega, n, amplitude}) {
  const {orbits, limits} = answer({contact: contactOf(r, omega, release), amplitude, n});
  const [exact, simple, corrected] = orbits, middle = exact.state(exact.contact_duration / 2);
  const {phase, contact_duration, impact_velocity, bounce_velocity, apparent_restitution, max_height,
    trace, determinant} = exact;
  return {
    phase, contact_duration, impact_velocity, bounce_velocity, apparent_restitution, max_height,
    trace, determinant, saddle_node_amplitude: limits[0].saddle_node,
    period_doubling_amplitude: limits[0].period_doubling,
    ball: middle.height, contact_force: middle.force,
    restitution_phase: simple.phase, restitution_trace: simple.trace,
    restitution_period_doubling: limits[1].period_doubling,
    corrected_phase: corrected.phase, corrected_max_height: corrected.max_height,
    corrected_trace: corrected.trace, corrected_saddle_node: limits[2].saddle_node,
    corrected_period_doubling: limits[2].period_doubling,
  };
}
