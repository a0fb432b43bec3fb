// On which motions balls end that start from an even grid of impacts on the contact, and with which
// shares: bouncing_ball.contacts.starts. Each verdict has these shares beside it.
"use strict";

// Starts along each axis, also of a contact law, impacts for which a ball is followed, and the share
// below which few balls reach an orbit. A ball this near to a stable orbit ends there.
const STARTS = 12, STARTS_OF_LAW = 6, IMPACTS_OF_START = 300, FEW = 0.1, ON_ORBIT = 1e-4, QUANTILE = 1.96;

// A relative speed above which every impact slows the ball: long_run.basins.
function fastest(contact, amplitude) {
  const r = ownRestitution(contact);
  return (1 + r) * Math.max(amplitude, 1) / Math.max(1 - r, 0.05);
}

// The motion of one end in words.
function endInWords({kind, periods, impacts}) {
  if (kind === "stays") return "at rest on the table";
  if (kind === "sticks") return "on a locked motion";
  if (kind === "goes on") return `in a motion that does not repeat within ${IMPACTS_OF_START} impacts`;
  return impacts === 1 ? `on the ${periods}-T orbit` : `on a motion of ${counted(periods, impacts)}`;
}

// The shares of the starts by the words for their ends, the greatest first. `orbit` is the contact's
// n-T orbit; balls are only said to end on it if it is stable and admissible.
function endsOfStarts(contact, amplitude, orbit) {
  const stays = orbit.exists && orbit.is_stable && sampledAdmissible(orbit);
  const known = stays ? {at: orbit.phase, u: orbit.relative_impact_velocity, periods: orbit.n} : null;
  const fast = fastest(contact, amplitude), counts = new Map(), edge = isApproach(contact) ? STARTS_OF_LAW : STARTS;
  for (let row = 0; row < edge; row++)
    for (let column = 0; column < edge; column++) {
      const phase = TURN * (column + 0.5) / edge - Math.PI, speed = fast * (row + 0.5) / edge;
      const velocity = amplitude * Math.cos(phase) - speed;
      const words = endInWords(followed({contact}, amplitude, phase, velocity, 0, IMPACTS_OF_START, known));
      counts.set(words, (counts.get(words) ?? 0) + 1);
    }
  const all = edge * edge, on = stays ? counts.get(`on the ${orbit.n}-T orbit`) ?? 0 : 0;
  const told = share => all < STARTS * STARTS ? `${percent(share)} (${intervalOf(share * all, all)})` : percent(share);
  const shares = [...counts].map(([words, count]) => [words, count / all]).sort((a, b) => b[1] - a[1]);
  const named = shares.slice(0, 3).map(([words, share], k) => `${told(share)}${k ? "" : " end"} ${words}`);
  const left = shares.slice(3).reduce((sum, [, share]) => sum + share, 0);
  if (left) named.push(`${told(left)} on others`);
  const about = all < STARTS * STARTS ? "; the ranges are intervals of 95 % for so few balls" : "";
  return {stays, share: on / all, shares, sentence: `Of ${all} balls with other starts, ${named.join(", ")}${about}.`};
}

// Wilson's interval of 95 % for the share of a count of balls.
function intervalOf(count, number) {
  const square = QUANTILE * QUANTILE, whole = number + square;
  const spread = QUANTILE * Math.sqrt(count * (number - count) / number + square / 4);
  const [low, high] = [-spread, spread].map(side => (100 * (count + square / 2 + side) / whole).toFixed(0));
  return `${low} to ${high} %`;
}

// The verdict with the shares of starts: one on an orbit that few balls reach is not the headline.
function withStarts([good, sentence], ends, n) {
  if (!ends.stays || ends.share >= FEW) return [good, sentence, ends.sentence];
  const few = ends.share ? `only ${percent(ends.share)} of the starts end` : "no start ends";
  return [false, `Most balls end otherwise than on the stable ${n}-T orbit: ${few} on it.`,
    `${ends.sentence} Of the orbit alone: ${sentence}`];
}
