"use strict";
const scene = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);
const units = scene.units ? " " + scene.units : "";

const INK = "#1c1c1c", PART = "#d9d6cf", NONE = "#9a9a9a", FAULTY = "#e0218a", EYE = "#1f4e79";
const FAMILY = { "1": "#0072b2", "-1": "#e69f00" }, LOOSE = "#6b6b6b";

/** The value of a float16 by its 16 bits. */
function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -14 * (fraction / 1024);
}
/** Numbers from base64. */
function unpack(packed) {
  const bytes = Uint8Array.from(atob(packed.data), c => c.charCodeAt(0));
  const type = { u1: Uint8Array, i2: Int16Array, i4: Int32Array, f2: Uint16Array, f4: Float32Array }[packed.type];
  const values = new type(bytes.buffer);
  return packed.type === "f2" ? Float32Array.from(values, half) : values;
}
/** The classes of cells from their runs. */
function drawnOut({ columns, classes, lengths }) {
  const all = unpack(classes), many = unpack(lengths), out = new Uint8Array(many.reduce((sum, count) => sum + count, 0));
  let end = 0;
  many.forEach((count, n) => { out.fill(all[n], end, end + count); end += count; });
  return { columns, rows: out.length / columns, classes: out };
}
/** The columns of packed rows one after the other, as (x, y, z), (x, y, z), ...; the middle is taken from each. */
function interleaved(packed, rows, middle) {
  const all = unpack(packed), count = all.length / rows, out = new Float32Array(all.length);
  for (let m = 0; m < rows; m++) {
    const less = middle ? middle[m] : 0;
    for (let n = 0; n < count; n++) out[n * rows + m] = all[m * count + n] - less;
  }
  return out;
}
/** Every array of a record that is packed, unpacked; other values as they are. */
function unpackedAll(record) {
  const whole = Object.entries(record).map(([name, value]) =>
    [name, value && value.data !== undefined ? unpack(value) : value]);
  return Object.fromEntries(whole);
}

// points are kept from the middle of the part, where single precision is finest; what is shown has the middle added
const raw = unpack(scene.surface.points), extent = [0, 1, 2].map(m => {
  const count = raw.length / 3, ends = [raw[m * count], raw[m * count]];
  for (let n = m * count; n < (m + 1) * count; n++) {
    if (raw[n] < ends[0]) ends[0] = raw[n];
    if (raw[n] > ends[1]) ends[1] = raw[n];
  }
  return ends;
});
const middle = extent.map(([low, high]) => (low + high) / 2);
const size = Math.hypot(...extent.map(([low, high]) => high - low));

const surface = {
  points: interleaved(scene.surface.points, 3, middle), u: unpack(scene.surface.u), v: unpack(scene.surface.v),
  maps: scene.surface.maps.map(map => ({ ...map, values: unpack(map.values), cells: map.cells && drawnOut(map.cells) })),
};
const [rows, columns] = [surface.u.length, surface.v.length];

const fibres = { ...unpackedAll(scene.fibres), points: interleaved(scene.fibres.points, 3, middle),
  uv: interleaved(scene.fibres.uv, 2) };
/** The first particle of each fibre, and their number at the end. */
fibres.first = [0];
for (const count of fibres.sizes) fibres.first.push(fibres.first.at(-1) + count);
fibres.count = fibres.figures.length;
/** Length along the polyline of each fibre up to each particle. */
fibres.arc = new Float64Array(fibres.points.length / 3);
for (let k = 0; k < fibres.count; k++) {
  for (let n = fibres.first[k] + 1; n < fibres.first[k + 1]; n++) {
    const p = fibres.points, k = 3 * n;
    fibres.arc[n] = fibres.arc[n - 1] + Math.hypot(p[k] - p[k - 3], p[k + 1] - p[k - 2], p[k + 2] - p[k - 1]);
  }
}
/** The fibre of a particle. */
const fibreOf = n => lastUpTo(fibres.first, n);

const wound = scene.filament && { ...unpackedAll(scene.filament),
  points: interleaved(scene.filament.points, 3, middle) };
const program = scene.program && { ...unpackedAll(scene.program), point: interleaved(scene.program.point, 3, middle) };
if (program) program.origin = program.origin.map((o, m) => o - middle[m]);

/** The last place of a rising array whose value is not above the given one; the first where there is none. */
function lastUpTo(values, value) {
  let [low, high] = [0, values.length - 1];
  while (low < high) {
    const between = Math.ceil((low + high) / 2);
    if (values[between] <= value) low = between; else high = between - 1;
  }
  return low;
}
/** A number with four digits that count, or as many as given, and its unit. */
function rounded(value, unit = "", digits = 4) {
  if (!Number.isFinite(value)) return "–";
  const short = Number(value.toPrecision(digits)), tiny = short !== 0 && Math.abs(short) < 1e-4;
  const [whole, ...rest] = (tiny ? short.toExponential() : String(short)).replace("e-", "e−").replace("-", "−").split(".");
  return [whole.replace(/\B(?=(\d{3})+$)/g, ","), ...rest].join(".") + unit;
}
/** Rows of text in a table. */
function filled(table, lines) {
  table.replaceChildren();
  for (const line of lines) {
    const row = table.insertRow();
    for (const cell of line) row.insertCell().textContent = cell;
  }
}
/** Say something to those who hear the page. */
function say(words) { byId("live").textContent = words; }
