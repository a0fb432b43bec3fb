// Drawings: SVG elements with classes, whose colours are the style sheet's.
"use strict";

// ---- Numbers in words.
// The nearest number of so many digits. Of two that are as near, it is the one whose last digit is
// even, as in Python; toPrecision takes the larger one. A hundred more digits show all of a double.
function nearest(x, digits) {
  if (x === 0 || !Number.isFinite(x)) return x;
  const [mantissa, power] = Math.abs(x).toExponential(100).split("e"), all = mantissa.replace(".", "");
  const isTie = /^50*$/.test(all.slice(digits)), isEven = all[digits - 1] % 2 === 0;
  return isTie && isEven ? Math.sign(x) * Number(`${all.slice(0, digits)}e${power - digits + 1}`)
    : Number(x.toPrecision(digits));
}
const shown = (x, digits = 6) => Number.isFinite(x) ? String(nearest(x, digits)) : "none";
// The size of an error in percent, as `on_shaker` prints it; next to the tolerance it has as many digits
// as tell the two apart.
function percent(x, tolerance) {
  const [size, limit] = [x, tolerance].map(share => 100 * Math.abs(share));
  if (!Number.isFinite(size)) return "none";
  let digits = 3;
  while (size !== limit && digits < 15 && nearest(size, digits) === nearest(limit, digits)) digits++;
  return `${nearest(size, digits)}%`;
}
// A height on the contact next to the height of a model, in words of `on_shaker`.
const lowerBy = (x, tolerance) => `${percent(x, tolerance)} ${x < 0 ? "lower" : "higher"} than with`;
const signed = (x, tolerance) => (x && Number.isFinite(x) ? x > 0 ? "+" : "-" : "") + percent(x, tolerance);
// Two values that are compared, in as many digits as show that they differ.
function heightsOf(exact, predicted, unit) {
  const error = exact ? Math.abs(predicted / exact - 1) : 1;
  const digits = error ? Math.min(12, Math.max(4, 2 - Math.floor(Math.log10(error)))) : 4;
  const power = powerOf(Math.max(Math.abs(predicted), Math.abs(exact)), unit);
  return [exact, predicted].map(x => unit ? prefixed(x, unit, digits, power) : shown(x, digits)).join(" instead of ");
}

const prefixPower = x => x === 0 ? 0
  : Math.min(9, Math.max(-9, 3 * Math.floor(Math.log10(Math.abs(nearest(x, 4))) / 3)));
const PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", "-3": "m", "-6": "µ", "-9": "n"};
// Lengths are in mm as long as those have few digits, as on a ruler.
const isMilli = size => size >= 1e-5 && size < 1;
const powerOf = (x, unit) => unit === "m" && isMilli(Math.abs(x)) ? -3 : prefixPower(x);
function prefixed(x, unit, digits = 4, power = powerOf(x, unit)) {
  if (!Number.isFinite(x)) return "none";
  return `${shown(x / 10 ** power, digits)} ${PREFIXES[power]}${unit}`;
}

// ---- Axes: the name with its unit, and the factor of the numbers.
// A length or a time whose unit in SI is `scale`, in mm or ms if they have few digits.
function physicalAxis(name, scale, unit, largest) {
  const size = scale * largest, power = isMilli(size) ? -3 : prefixPower(size);
  return {name: `${name} [${PREFIXES[power]}${unit}]`, factor: scale / 10 ** power};
}
// Axes of a height, a time and a phase: in SI units if there are scales, else dimensionless.
const heightAxis = (name, symbol, scales, largest) =>
  scales ? physicalAxis(name, scales.length, "m", largest) : {name: `${name} ${symbol}`, factor: 1};
const phaseAxis = scales =>
  scales ? {name: "phase of the impact [°]", factor: 180 / Math.PI} : {name: "phase of the impact φ/π", factor: 1 / Math.PI};
const amplitudeName = scales => scales ? "acceleration of the table Λ [g]" : "amplitude of the table Λ";

// ---- Lines and marks.
const SVG = "http://www.w3.org/2000/svg";
function element(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// A drawing whose units are CSS pixels, so that its letters do not shrink with it.
class Plot {
  constructor(id, [x0, x1], [y0, y1], xName, yName, label, lines = true) {
    this.svg = $(id);
    this.svg.replaceChildren(element("title", {}, label));
    const {width, height} = this.svg.getBoundingClientRect();
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.box = {left: 80, right: width - 12, top: 10, bottom: height - (lines || xName ? 42 : 10)};
    const {left, right, top, bottom} = this.box;
    this.x = v => left + (v - x0) / (x1 - x0) * (right - left);
    this.y = v => bottom - (v - y0) / (y1 - y0) * (bottom - top);
    this.limits = [x0, x1, y0, y1];
    this.axes(xName, yName, lines);
  }
  axes(xName, yName, lines) {
    const {left, right, top, bottom} = this.box, [x0, x1, y0, y1] = this.limits;
    for (const v of lines ? ticks(x0, x1) : []) {
      this.add("line", {class: "grid", x1: this.x(v), x2: this.x(v), y1: top, y2: bottom});
      this.add("text", {class: "tick", x: this.x(v), y: bottom + 16, "text-anchor": "middle"}, shown(v, 4));
    }
    for (const v of ticks(y0, y1)) {
      this.add("line", {class: "grid", x1: left, x2: right, y1: this.y(v), y2: this.y(v)});
      this.add("text", {class: "tick", x: left - 11, y: this.y(v) + 5, "text-anchor": "end"}, shown(v, 4));
    }
    this.add("text", {class: "name", x: (left + right) / 2, y: bottom + 36, "text-anchor": "middle"}, xName);
    const middle = (top + bottom) / 2;
    this.add("text", {class: "name", x: 14, y: middle, "text-anchor": "middle",
      transform: `rotate(-90 14 ${middle})`}, yName);
  }
  add(name, attributes, text) {
    return this.svg.appendChild(element(name, attributes, text));
  }
  line(points, kind) {
    const [x0, x1, y0, y1] = this.limits;
    let path = "", pen = false;
    for (const [x, y] of points) {
      const inside = x >= x0 && x <= x1 && y >= y0 && y <= y1;
      if (inside) path += `${pen ? "L" : "M"}${this.x(x).toFixed(2)} ${this.y(y).toFixed(2)}`;
      pen = inside;
    }
    if (path) this.add("path", {class: kind, d: path});
  }
  mark(shape, x, y, kind, size = 4.5) {
    const [x0, x1, y0, y1] = this.limits;
    if (!(x >= x0 && x <= x1 && y >= y0 && y <= y1)) return null;
    return shape === "square"
      ? this.add("rect", {class: kind, x: this.x(x) - 4, y: this.y(y) - 4, width: 8, height: 8})
      : this.add("circle", {class: kind, cx: this.x(x), cy: this.y(y), r: size});
  }
}

function ticks(low, high) {
  const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(k => k * power).find(s => s >= raw);
  const places = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) places.push(k * step);
  return places;
}
