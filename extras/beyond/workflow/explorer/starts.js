// On which motions balls end that start from an even grid of impacts on the contact, and how many on
// each. The sentence stands below the verdict.
"use strict";

// Starts along each axis, and impacts for which a ball is followed. A ball this near to a stable orbit
// ends there.
const STARTS = 12, IMPACTS_OF_START = 300, ON_ORBIT = 1e-4;

// A relative speed above which every impact slows the ball: motions.basins.
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

// How many of the starts end how, in one sentence: first on the contact's n-T orbit, `orbit`, if it is
// stable and admissible, then on the other ends, the most frequent first.
function endsOfStarts(contact, amplitude, orbit) {
  const stays = isMotion(orbit);
  const known = stays ? {at: orbit.phase, u: orbit.relative_impact_velocity, periods: orbit.n} : null;
  const own = `on the ${orbit.n}-T orbit`, counts = new Map(stays ? [[own, 0]] : []);
  const fast = fastest(contact, amplitude);
  for (let row = 0; row < STARTS; row++)
    for (let column = 0; column < STARTS; column++) {
      const phase = TURN * (column + 0.5) / STARTS - Math.PI, speed = fast * (row + 0.5) / STARTS;
      const velocity = amplitude * Math.cos(phase) - speed;
      const words = endInWords(followed({contact}, amplitude, phase, velocity, 0, IMPACTS_OF_START, known));
      counts.set(words, (counts.get(words) ?? 0) + 1);
    }
  const others = [...counts].filter(([words]) => !stays || words !== own).sort((a, b) => b[1] - a[1]);
  const named = [...(stays ? [[own, counts.get(own)]] : []), ...others.slice(0, 3)];
  const left = others.slice(3).reduce((sum, [, count]) => sum + count, 0);
  if (left) named.push(["on others", left]);
  const [[first, count], ...rest] = named;
  const begins = `${count || "none"} ${count > 1 ? "end" : "ends"} ${first}`;
  const sentence = [begins, ...rest.map(([words, number]) => `${number} ${words}`)].join(", ");
  return `Of ${STARTS * STARTS} balls with other starts, ${sentence}.`;
}
