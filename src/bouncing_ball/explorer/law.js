// Contacts of any law, as bouncing_ball.contacts.laws has them, and their orbits. A contact is
// integrated, because only the linear one has a closed form. Everything is dimensionless.
"use strict";

// ---- A contact: Gragg's midpoint rule with 2, 4, 6 … substeps, extrapolated to substeps of no
// length as by Bulirsch and Stoer, until something ends it.
const LEVELS = 6;
// The error of a step over the size of what it changes, and the most steps of a contact.
const PRECISE = 1e-11, MOST_PARTS = 2000;

// The state after a step, and the error in it. `rate` writes the slopes of a state to a list.
function stepOf(rate, from, h) {
  const n = from.length, first = new Array(n), slope = new Array(n), table = [];
  rate(from, first);
  for (let level = 1; level <= LEVELS; level++) {
    const small = h / (2 * level);
    let before = from.slice(), here = from.slice();
    for (let i = 0; i < n; i++) here[i] += small * first[i];
    for (let k = 1; k < 2 * level; k++) {
      rate(here, slope);
      for (let i = 0; i < n; i++) before[i] += 2 * small * slope[i];
      [before, here] = [here, before];
    }
    rate(here, slope);
    for (let i = 0; i < n; i++) here[i] = (here[i] + before[i] + small * slope[i]) / 2;
    // Neville's scheme in h², upwards from the new row.
    for (let k = level - 2, last = here; k >= 0; k--) {
      const share = 1 / ((level / (k + 1)) ** 2 - 1), old = table[k];
      for (let i = 0; i < n; i++) old[i] = last[i] + (last[i] - old[i]) * share;
      last = old;
    }
    table.push(here);
  }
  return {at: table[0], off: table[0].map((x, i) => Math.abs(x - table[1][i]))};
}

// The states from a start on, each with the step to the next, up to the zero of `left`. Steps end at
// the zeros of `kinks`, beyond which the rates are another smooth function. Null if it is never left.
function integrated(rate, start, sizes, longest, left, kinks = []) {
  const ends = [left, ...kinks], states = [];
  // A state at a kink has its sign there by rounding only: that just after it counts.
  const signs = state => {
    const slope = [];
    rate(state, slope);
    return ends.map(f => f(state.map((x, i) => x + 1e-6 * longest * slope[i])));
  };
  let h = longest / 4, from = start, before = signs(start);
  for (let count = 0; count < MOST_PARTS; count++) {
    const {at, off} = stepOf(rate, from, h);
    const error = Math.max(...sizes.map((size, i) => off[i] / size)) / PRECISE;
    const next = Math.min(longest, h * Math.min(4, Math.max(0.2, 0.9 * error ** (-1 / (2 * LEVELS - 1)))));
    if (!(error <= 1)) {
      if (!(h > 1e-12 * longest)) return null;
      h = Number.isFinite(error) ? next : h / 4;
      continue;
    }
    const after = ends.map(f => f(at));
    const cuts = ends.map((f, k) => before[k] * after[k] < 0
      ? rootOf(part => f(stepOf(rate, from, part).at), 0, h, before[k], after[k], (k ? 1e-7 : 1e-13) * h)
      : Infinity);
    const part = Math.min(h, ...cuts), to = part < h ? stepOf(rate, from, part).at : at;
    states.push({state: from, step: part});
    if (cuts[0] === part) return [...states, {state: to, step: 0}];
    before = part < h ? signs(to) : after;
    from = to;
    if (part === h) h = next;
  }
  return null;
}

// A law has its root m, of which q = p^(1/m) its force f(q, p′) is smooth, the share d(q) of the
// load that acts on the ball besides, and its grip, which is positive until the ball is released.
// With dt = m q^(m-1) ds, the state (q, p′, t) is smooth in s.
const LINEAR = {root: 1, share: () => 0, kinks: [], power: 1};
const HERTZ = {...LINEAR, root: 2, power: 1.5, grip: q => q};
const LAWS = {
  "hunt-crossley": (k, c) => ({...HERTZ, numbers: {stiffness: k, damping: c},
    force: (q, u) => k * q * q * q * (1 + c * u)}),
  "hunt-crossley-linear": (k, c) => ({...LINEAR, numbers: {stiffness: k, damping: c},
    force: (q, u) => k * q * (1 + c * u), grip: q => q}),
  "tsuji": (k, c) => ({...HERTZ, numbers: {stiffness: k, damping: c}, root: 4,
    force: (q, u) => k * q * q * q * q * q * q + c * Math.sqrt(k) * q * u}),
  "kuwabara-kono": (k, c) => ({...HERTZ, numbers: {stiffness: k, damping: c},
    force: (q, u) => k * q * (q * q + c * u), grip: (q, u) => Math.min(q, q * q + c * u), touches: [(p, u) => p + c * u]}),
  "elasto-backlash": (w, zeta) => {
    const lag = 2 * zeta / w;
    return {...LINEAR, numbers: {"frequency ratio": w, "damping ratio": zeta},
      force: (q, u) => w * w * (q + Math.min(lag * u, q)), grip: (q, u) => q + lag * u,
      kinks: lag ? [([q, u]) => q - lag * u] : []};
  },
};
// MuJoCo's: the impedance d grows from `least` at the surface to `most` at the depth `width`.
function impedanceLaw(w, zeta, most, least = most, width = 1, midpoint = 0.5, power = 2) {
  const lag = 2 * zeta / w, varies = most !== least;
  const share = q => {
    const x = Math.min(1, Math.max(0, q / width));
    return least + (most - least) * (x < midpoint ? x * (x / midpoint) ** (power - 1)
      : 1 - (1 - x) * ((1 - x) / (1 - midpoint)) ** (power - 1));
  };
  const part = q => varies ? share(q) / most : 1;
  return {...LINEAR, share: varies ? share : () => most,
    numbers: {"frequency ratio": w, "damping ratio": zeta, share: most, "at surface": least,
      width, midpoint, power},
    force: (q, u) => part(q) * (w * w * part(q) * q + 2 * zeta * w * u),
    grip: (q, u, load) => Math.min(q, part(q) * q + lag * u + most * load / (w * w)),
    touches: [p => p, (p, u, load) => part(p) * p + lag * u + most * load / (w * w)],
    kinks: varies ? [midpoint * width, width].map(depth => ([q]) => q - depth) : []};
}
LAWS.impedance = (w, zeta) => impedanceLaw(w, zeta, 0.95);

// The same law with a contact s times as long at every speed.
function scaled(law, s) {
  const inside = s ** (1 / law.root);
  return {...law, force: (q, u) => law.force(q / inside, u) / s, share: q => law.share(q / inside),
    grip: (q, u, load) => law.grip(q / inside, u, s * load),
    kinks: law.kinks.map(kink => ([q, u]) => kink([q / inside, u]))};
}

// The penetration P at which the force of a speed v would stop the ball, f(P, v) P = v².
function depthOf(law, v) {
  return Math.exp(rootOf(x => {
    const p = Math.exp(x);
    return Math.log(law.force(p ** (1 / law.root), v)) + x - 2 * Math.log(v);
  }, -60, 60));
}

// One contact from a touch with the closing speed v, under a load that depends on the time.
const NO_CONTACT = {duration: NaN, depth: NaN, rate: NaN};
function contactUnder(law, v, load) {
  if (!(v > 0)) return NO_CONTACT;
  const {root} = law, depth = depthOf(law, v), size = depth ** (1 / root);
  const rate = (state, slope) => {
    const q = state[0], u = state[1], a = load(state[2]);
    let turn = root;
    for (let k = 1; k < root; k++) turn *= q;
    slope[0] = u;
    slope[1] = turn * (a - law.force(q, u) - law.share(q) * a);
    slope[2] = turn;
  };
  const states = integrated(rate, [0, v, 0], [size, v, depth / v], size / v,
    ([q, u, t]) => law.grip(q, u, load(t)), law.kinks);
  if (!states) return NO_CONTACT;
  const [q, u, t] = states[states.length - 1].state;
  // The state at a time in contact, by a part of the step that passes it.
  const at = time => {
    const k = states.findIndex((each, j) => j + 1 === states.length || states[j + 1].state[2] >= time);
    const {state, step} = states[k];
    if (!step || time <= state[2]) return state;
    return stepOf(rate, state,
      rootOf(part => stepOf(rate, state, part).at[2] - time, 0, step)).at;
  };
  return {duration: t, depth: q ** root, rate: u, at};
}

// A derivative of a function of one number, or of a list of them, to the fourth order of h.
function slopeOf(f, h) {
  const [a, b, c, d] = [f(-2 * h), f(-h), f(h), f(2 * h)];
  const of = (a, b, c, d) => (a - 8 * b + 8 * c - d) / (12 * h);
  return Array.isArray(a) ? a.map((x, k) => of(x, b[k], c[k], d[k])) : of(a, b, c, d);
}

// The signature of free impacts: delay t_c, restitution r, load σ and duration D.
function impactOf(law, v) {
  const {duration, depth, rate} = contactUnder(law, v, () => 0), r = -rate / v;
  const delay = (depth + duration * r * v) / ((1 + r) * v);
  const bySpeed = slopeOf(x => contactUnder(law, v + x, () => 0).rate, 3e-4 * v);
  const byLoad = slopeOf(x => contactUnder(law, v, () => x).rate, 3e-4 * v / duration);
  return {delay, r, load: -byLoad + (duration - delay) + delay * bySpeed, duration};
}

// The signature at any speed, between a few by a polynomial in ln v, and its slopes along v.
function signatureOver(law) {
  const known = new Map(), width = 0.03, points = [-2, -1, 0, 1, 2, 3];
  const node = k => {
    if (!known.has(k)) known.set(k, impactOf(law, Math.exp(k * width)));
    return known.get(k);
  };
  return v => {
    const x = Math.log(v) / width, k = Math.floor(x), y = x - k;
    const weights = points.map(p => points.reduce((w, o) => o === p ? w : w * (y - o) / (p - o), 1));
    const slopes = points.map(p => points.reduce((sum, out) => out === p ? sum
      : sum + points.reduce((w, o) => o === p || o === out ? w : w * (y - o) / (p - o), 1) / (p - out), 0));
    const nodes = points.map(p => node(k + p));
    const of = (name, by) => nodes.reduce((sum, each, j) => sum + by[j] * each[name], 0);
    const found = {};
    for (const name of ["delay", "r", "load", "duration"]) {
      found[name] = of(name, weights);
      found[`d_${name}`] = of(name, slopes) / (width * v);
    }
    return found;
  };
}

// The law of a kind whose free impact at a speed has r and D (law_choice.py).
function lawOfImpact(kind, r, duration, v) {
  const make = LAWS[kind], hertz = !("frequency ratio" in make(1, 0).numbers);
  const of = group => contactUnder(make(1, group), 1, () => 0);
  const surplus = group => Math.log(-of(group).rate / r);
  let group = 0;
  if (kind === "impedance") group = forceDamping(-Math.log(r) + 0);
  else if (kind === "tsuji") group = Math.sqrt(5) * (-Math.log(r) + 0) / Math.hypot(Math.PI, Math.log(r));
  // For these the equation of motion has an integral: ln((1 + g)/(1 - g r)) = g (1 + r).
  else if (kind.startsWith("hunt") && r < 1)
    group = rootOf(g => (Math.log1p(g) - Math.log1p(-g * r)) / g - 1 - r, 1e-3 * (1 - r), (1 - 1e-12) / r);
  else if (r < 1) {
    const enough = [0.25, 0.5, 1, 2, 4, 8, 16, 32].find(each => surplus(each) <= 0);
    if (enough === undefined) return null;
    group = rootOf(surplus, 0, enough);
  }
  const length = duration * v / of(group).duration;
  if (!hertz) return make(v / length, group);
  const unit = {"tsuji": 1, "kuwabara-kono": length / v}[kind] ?? 1 / v;
  return make(v * v / length ** (1 + make(1, 0).power), group * unit);
}

// The penetration under the weight of a ball at rest; with less of the load, that of a lighter one.
function restOf(law, weight = 1) {
  const held = p => law.force(p ** (1 / law.root), 0) + (law.share(p ** (1 / law.root)) - 1) * weight;
  return Math.exp(rootOf(x => held(Math.exp(x)), -60, 60));
}

// Λ up to which a steady contact never releases the ball: permanent_contact.py. The contact is a
// Fourier polynomial that touches its release at the time 0, where `touch` and its rate vanish.
// It is one only if as many nodes as needed see the same: a weakly damped contact rings.
const COARSE = 72, FINER = 96, ALIKE = 1e-5;
function steadyTouch(law, touch, n) {
  const nodes = Array.from({length: n}, (_, j) => 2 * Math.PI * j / n);
  const weight = (j, i) => (j - i) % 2 ? -1 : 1, half = (j, i) => (nodes[j] - nodes[i]) / 2;
  const first = nodes.map((_, j) => nodes.map((_, i) => i === j ? 0 : weight(j, i) / 2 / Math.tan(half(j, i))));
  const second = nodes.map((_, j) => nodes.map((_, i) => i === j ? -(n * n + 2) / 12
    : -weight(j, i) / 2 / Math.sin(half(j, i)) ** 2));
  const product = (matrix, p) => matrix.map(line => line.reduce((sum, w, i) => sum + w * p[i], 0));
  const rootAt = p => Math.max(p, 0) ** (1 / law.root);
  const pushed = (p, u, a) => a - law.force(rootAt(p), u) - law.share(rootAt(p)) * a;
  const small = 1e-6, unit = restOf(law);
  let p = nodes.map(t => t ? restOf(law, 1 - Math.cos(t)) : 0), phase = Math.PI / 2, top = 1;
  for (let round = 0; round < 25; round++) {
    const u = product(first, p), speed = Math.max(...u.map(Math.abs));
    const load = nodes.map(t => 1 - top * Math.sin(phase + t));
    const defects = p.map((each, j) => product([second[j]], p)[0] - pushed(each, u[j], load[j]));
    const slope = (f, x, h) => (f(x + h) - f(x - h)) / (2 * h);
    const rows = p.map((each, j) => {
      const byDepth = slope(x => pushed(x, u[j], load[j]), each, small * (j ? Math.max(each, 1e-3 * unit) : unit));
      const byRate = slope(x => pushed(each, x, load[j]), u[j], small * speed);
      const byLoad = 1 - law.share(rootAt(each)), sine = Math.sin(phase + nodes[j]);
      return [...p.map((_, i) => second[j][i] - byRate * first[j][i] - (i === j ? byDepth : 0)),
        byLoad * top * Math.cos(phase + nodes[j]), byLoad * sine];
    });
    // The touch and its rate are functions of the first p, its rate, φ and Λ.
    const ends = ([depth, rate, turn, lam]) => {
      const a = x => 1 - lam * Math.sin(turn + x), h = small, at = x => touch(
        depth + x * rate, rate + x * pushed(depth, rate, a(0)), a(x));
      return [at(0), (at(h) - at(-h)) / (2 * h)];
    };
    const here = [p[0], u[0], phase, top], sizes = [unit, speed, 1, 1];
    const now = ends(here), by = here.map((_, k) => ends(
      here.map((each, i) => i === k ? each + small * sizes[k] : each)).map(
      (each, i) => (each - now[i]) / (small * sizes[k])));
    now.forEach((value, i) => {
      defects.push(value);
      rows.push([...p.map((_, j) => by[1][i] * first[0][j] + (j ? 0 : by[0][i])), by[2][i], by[3][i]]);
    });
    const step = eliminated(rows[0].map((_, i) => rows.map(line => line[i])), defects);
    const size = Math.max(...step.slice(-2).map(Math.abs));
    if (!Number.isFinite(size)) return NaN;
    const part = Math.min(1, 0.3 / size);
    p = p.map((each, j) => each - part * step[j]);
    [phase, top] = [phase - part * step[n], top - part * step[n + 1]];
    if (size < 1e-9) {
      const rate = product(first, p), held = p.every((each, j) => each > -1e-3 * unit
        && touch(each, rate[j], 1 - top * Math.sin(phase + nodes[j])) > -1e-3 * unit);
      return held ? Math.abs(top) : NaN;
    }
  }
  return NaN;
}

function permanentContactOf(law) {
  const {numbers} = law, w = numbers["frequency ratio"], zeta = numbers["damping ratio"];
  if (law.kinks.length === 1 || (w && zeta === 0 && !numbers.share))
    return permanentContact({omega: w, zeta, sine: zeta});
  if (numbers.share && !law.kinks.length) {
    const stiffness = w * w, loss = 2 * zeta * w;
    return Math.hypot(stiffness - 1, loss) / Math.max(stiffness, Math.hypot(stiffness - numbers.share, loss));
  }
  const touches = law.touches ?? [p => p];
  const found = touch => {
    const [coarse, fine] = [COARSE, FINER].map(n => steadyTouch(law, touch, n));
    return Math.abs(fine - coarse) < ALIKE ? fine : NaN;
  };
  return touches.map(found).reduce(
    (low, each) => Number.isNaN(low) ? each : Number.isNaN(each) ? low : Math.min(low, each), NaN);
}

// ---- Newton's method, with a Jacobian by differences.
function newton(defects, start, sizes) {
  let x = start;
  for (let round = 0; round < 30; round++) {
    const f = defects(x);
    const columns = x.map((_, k) => {
      const h = 1e-6 * sizes[k], moved = defects(x.map((each, j) => j === k ? each + h : each));
      return moved.map((each, j) => (each - f[j]) / h);
    });
    const step = eliminated(columns, f);
    const size = Math.max(...step.map((each, k) => Math.abs(each) / sizes[k]));
    if (!Number.isFinite(size)) return null;
    x = x.map((each, k) => each - step[k] * Math.min(1, 0.5 / size));
    if (size < 1e-10) return x;
  }
  return null;
}

// The solution of a few linear equations whose matrix has these columns, by elimination.
function eliminated(columns, right) {
  const rows = right.map((value, i) => [...columns.map(column => column[i]), value]);
  const n = rows.length;
  for (let k = 0; k < n; k++) {
    const best = rows.slice(k).reduce((b, row, j) =>
      Math.abs(row[k]) > Math.abs(rows[b][k]) ? k + j : b, k);
    [rows[k], rows[best]] = [rows[best], rows[k]];
    for (let i = 0; i < n; i++)
      if (i !== k) {
        const factor = rows[i][k] / rows[k][k];
        rows[i] = rows[i].map((each, j) => each - factor * rows[k][j]);
      }
  }
  return rows.map((row, k) => row[n] / row[k]);
}

// ---- Orbits: a branch is a curve in the plane of x = Λ cos φ and y = Λ sin φ next to the straight
// line of the corrected model, along which it is followed.
const MARCH = 12, ROOT_ERROR = 1e-10, SHARES = Array.from({length: 12}, (_, k) => k / 12);

// A branch from its points: at(place) gives a point {amplitude, phase, trace, determinant, ...}.
function branchAlong(at, top) {
  const grid = [], step = top / MARCH;
  for (const direction of [1, -1])
    for (let k = direction > 0 ? 0 : 1; k <= MARCH; k++) {
      const place = direction * k * step, point = at(place);
      if (!point) break;
      if (direction > 0) grid.push(point);
      else grid.unshift(point);
    }
  const turn = point => 1 - point.trace + point.determinant;
  const k = grid.findIndex((point, i) => i && turn(grid[i - 1]) < 0 && turn(point) >= 0);
  const node = k < 0 ? NaN : rootOf(
    place => turn(at(place)), grid[k - 1].place, grid[k].place, turn(grid[k - 1]), turn(grid[k]), ROOT_ERROR);
  const flip = point => 1 + point.trace + point.determinant;
  const beyond = [...Number.isFinite(node) ? [at(node)] : [], ...grid.filter(({place}) => !(place <= node))];
  const j = beyond.findIndex((point, i) => i && flip(beyond[i - 1]) > 0 && flip(point) <= 0);
  const doubled = j < 1 ? NaN : rootOf(place => flip(at(place)),
    beyond[j - 1].place, beyond[j].place, flip(beyond[j - 1]), flip(beyond[j]), ROOT_ERROR);
  const lost = {amplitude: NaN, phase: NaN, trace: NaN, determinant: NaN};
  return {
    grid, fold: Number.isFinite(node) ? at(node) : lost,
    flip: Number.isFinite(doubled) ? at(doubled) : lost,
    // The point at Λ on a side of the saddle-node.
    on(amplitude, side) {
      const stable = side === "stable";
      const part = stable ? beyond : [...grid.filter(({place}) => place < node), ...beyond.slice(0, 1)];
      const i = part.findIndex((point, m) => m
        && (part[m - 1].amplitude - amplitude) * (point.amplitude - amplitude) <= 0);
      const above = point => point.amplitude - amplitude;
      return i < 0 ? lost : at(rootOf(place => above(at(place)),
        part[i - 1].place, part[i].place, above(part[i - 1]), above(part[i]), ROOT_ERROR));
    },
  };
}

// A model from its branches: those are computed once for each n, up to a Λ.
function modelAlong(name, points, orbitOf, top) {
  const branches = new Map();
  const branch = n => {
    if (!branches.has(n)) branches.set(n, branchAlong(points(n), top));
    return branches.get(n);
  };
  // Between the points of a branch x, y, trace and determinant are cubic.
  const drawn = n => branch(n).grid.flatMap((point, k, grid) => {
    const first = Math.min(Math.max(k - 1, 0), grid.length - 4), near = grid.slice(first, first + 4);
    const between = k + 1 < grid.length && grid.length >= 4 ? SHARES : [0];
    return between.map(share => {
      const place = share ? point.place + share * (grid[k + 1].place - point.place) : point.place;
      const weights = near.map(a => near.reduce(
        (w, b) => a === b ? w : w * (place - b.place) / (a.place - b.place), 1));
      const of = key => near.reduce((sum, a, j) => sum + weights[j] * a[key], 0), [x, y] = [of("x"), of("y")];
      return {amplitude: Math.hypot(x, y), phase: Math.atan2(y, x), trace: of("trace"), determinant: of("determinant")};
    });
  });
  return {
    name, drawn, bifurcations: n => [branch(n).fold, branch(n).flip],
    saddleNode: n => branch(n).fold.amplitude, periodDoubling: n => branch(n).flip.amplitude,
    orbit: (n, amplitude, side) => orbitOf(n, amplitude, branch(n).on(amplitude, side)),
  };
}

// The corrected model of a law whose signature depends on the speed: corrected_branch.py.
function correctedLawModel(signature, top) {
  const points = n => {
    const half = n * Math.PI, cache = new Map();
    const lineUp = y => {
      let x = half * 0.1;
      const defect = x => {
        const v = half + x, {r, load} = signature(v);
        return half - x - r * v - load * (1 - y);
      };
      for (let k = 0; k < 50; k++) {
        const step = defect(x) / slopeOf(d => defect(x + d), 1e-4);
        x -= step;
        if (Math.abs(step) < 1e-13 * half) break;
      }
      return x;
    };
    return place => {
      if (cache.has(place)) return cache.get(place);
      const y = place, x = lineUp(y), v = half + x;
      const here = signature(v), {delay, load} = here;
      const b = here.r + here.d_r * v + here.d_load * (1 - y), e = delay + here.d_delay * v;
      const byPhase = -(1 + b) * y - load * x, speed = half + x - e * (1 - y), rest = 2 * half - e;
      const trace = 1 - b + (rest * (byPhase + b) - e) / speed;
      const determinant = (rest * b - e - e * byPhase) / speed - b;
      const found = {place, x, y, here, amplitude: Math.hypot(x, y),
        phase: Math.atan2(y, x) - delay, trace, determinant};
      cache.set(place, found);
      return found;
    };
  };
  const orbitOf = (n, amplitude, point) => {
    const {x, y, phase, trace, determinant, here: {delay, duration} = {}} = point, half = n * Math.PI;
    const height = y - (half + x) * delay, after = duration - delay;
    const bounceHeight = height + (half - after + after / 2) * after;
    const orbit = described(
      n, amplitude, phase, duration, delay - half, trace, determinant, {bounceHeight});
    orbit.inContact = s => {
      const since = s - delay;
      return height + ((since < 0 ? -half : half) - since / 2) * since;
    };
    return orbit;
  };
  return modelAlong("corrected", points, orbitOf, top);
}

// The exact model: contact and flight, closed after n periods.
function lawModel(law, name, signature, r, top) {
  const cycle = (of, n, x, y, v) => {
    const table = s => x * Math.sin(s) + y * Math.cos(s), moved = s => x * Math.cos(s) - y * Math.sin(s);
    const {duration, depth, rate, at} = contactUnder(of, v, s => 1 - table(s));
    return {duration, at, height: table(duration) - depth, velocity: moved(duration) - rate,
      flight: 2 * Math.PI * n - duration};
  };
  const defects = (of, n, x, y, v) => {
    const {height, velocity, flight} = cycle(of, n, x, y, v);
    return [height + (velocity - flight / 2) * flight - y, velocity - flight - x + v];
  };
  // Where the next contact begins, if this one begins a bit later, or a bit faster.
  const returned = (n, x, y, v, dPhase, dSpeed) => {
    const turn = [Math.cos(dPhase), Math.sin(dPhase)];
    const [c, s] = [x * turn[0] - y * turn[1], y * turn[0] + x * turn[1]];
    // Velocities are absolute: the relative one changes with the table's.
    const {height, velocity, duration, flight} = cycle(law, n, c, s, v + dSpeed + c - x);
    const above = t => height + (velocity - t / 2) * t - (c * Math.sin(duration + t) + s * Math.cos(duration + t));
    let t = flight;
    for (let k = 0; k < 30; k++) {
      const step = above(t) / (velocity - t - (c * Math.cos(duration + t) - s * Math.sin(duration + t)));
      t -= step;
      if (Math.abs(step) < 1e-14 * flight) break;
    }
    return [dPhase + duration + t, -(velocity - t)];
  };
  const points = n => {
    const cache = new Map(), speed = 2 * Math.PI * n / (1 + r), plain = signature(speed);
    const {delay, load} = plain, radius = Math.hypot(1 + plain.r, load);
    const [a, b] = [(1 + plain.r) / radius, -load / radius];
    const level = (n * Math.PI * (1 - plain.r) - load) / radius;
    // The line of the contact scaled by s, its instant turned back to the touch.
    const at = (place, off, s) => {
      const [u, w] = [(level + off) * a - place * b, (level + off) * b + place * a];
      const [c, d] = [Math.cos(delay * s), Math.sin(delay * s)];
      return [u * c + w * d, w * c - u * d];
    };
    const solved = (place, of, s, start) =>
      newton(([off, v]) => defects(of, n, ...at(place, off, s), v), start, [0.1, speed]);
    return place => {
      if (cache.has(place)) return cache.get(place);
      // From the nearest point that is known, or from shorter contacts, which are instants.
      const near = [...cache.values()].filter(Boolean).reduce((best, each) =>
        !best || Math.abs(each.place - place) < Math.abs(best.place - place) ? each : best, null);
      const start = near && Math.abs(near.place - place) < 0.1 * top ? near.found : null;
      let found = start && solved(place, law, 1, start);
      if (!found) {
        found = [0, speed];
        for (const s of [0.02, 0.1, 0.25, 0.5, 0.75, 1])
          found = found && solved(place, s < 1 ? scaled(law, s) : law, s, found);
      }
      if (!found || !(found[1] > 0)) return cache.set(place, null).get(place);
      const [x, y] = at(place, found[0], 1), v = found[1];
      const [m11, m21] = slopeOf(h => returned(n, x, y, v, h, 0), 3e-4);
      const [m12, m22] = slopeOf(h => returned(n, x, y, v, 0, h), 3e-4 * v);
      const product = m11 * m22 - m12 * m21;
      const point = {place, found, x, y, v, amplitude: Math.hypot(x, y), phase: Math.atan2(y, x),
        trace: m11 + m22, determinant: Math.abs(product - 1) < 1e-7 ? 1 : product};
      cache.set(place, point);
      return point;
    };
  };
  const orbitOf = (n, amplitude, {x, y, v, phase, trace, determinant}) => {
    const {at, duration} = Number.isFinite(phase) ? cycle(law, n, x, y, v) : NO_CONTACT;
    const orbit = described(n, amplitude, phase, duration, x - v, trace, determinant, {});
    orbit.state = s => {
      const [q, u] = at(s), table = x * Math.sin(s) + y * Math.cos(s), load = 1 - table;
      const depth = q ** law.root;
      return {gap: -depth, speed: -u, height: table - depth, velocity: x * Math.cos(s) - y * Math.sin(s) - u,
        force: law.force(q, u) + law.share(q) * load, grip: law.grip(q, u, load)};
    };
    orbit.inContact = s => orbit.state(s).height;
    if (orbit.max_height < amplitude) orbit.max_height = Math.max(orbit.max_height, highest(orbit));
    return orbit;
  };
  return modelAlong(name, points, orbitOf, top);
}
