const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
const unit = a => { const length = Math.hypot(...a); return a.map(each => each / length); };
const at = (points, n) => [points[3 * n], points[3 * n + 1], points[3 * n + 2]];

/** A vector turned about a unit axis. */
function turnedAbout(v, axis, angle) {
  const side = cross(axis, v), along = dot(axis, v), c = Math.cos(angle), s = Math.sin(angle);
  return v.map((part, m) => part * c + side[m] * s + axis[m] * along * (1 - c));
}

/** Triangles of a grid of quads; the last corner of both triangles of a quad is its first point, whose class is shown.
   */
function gridTriangles(rows, columns, closed, outward) {
  const strips = closed ? rows : rows - 1, out = new Uint32Array(strips * (columns - 1) * 6);
  let k = 0;
  for (let i = 0; i < strips; i++) for (let j = 0; j < columns - 1; j++) {
    const next = (i + 1) % rows, a = i * columns + j, b = next * columns + j, c = b + 1, d = a + 1;
    out.set(outward > 0 ? [b, c, a, c, d, a] : [c, b, a, d, c, a], k);
    k += 6;
  }
  return out;
}
/** Triangles of strips between the rows of points that are kept, in the order of the rows, and how many end at each row
   or before. */
function stripTriangles(sizes, across, kept = null) {
  const total = sizes.reduce((sum, count) => sum + count, 0), out = [], ends = new Uint32Array(total);
  let row = 0;
  for (const count of sizes) for (let r = 0, last = row; r < count; r++, row++) {
    if (!kept || kept[row]) {
      for (let j = 0; r > 0 && j < across - 1; j++) {
        const a = last * across + j, b = row * across + j, c = b + 1, d = a + 1;
        out.push(a, b, c, a, c, d);
      }
      last = row;
    }
    ends[row] = out.length / 3;
  }
  return { triangles: Uint32Array.from(out), ends };
}
/** Which rows of strips are needed for their edges to be no farther off than `off`; needed: those that are, however
   straight they are. */
function bentRows(points, across, needed, off) {
  const kept = Uint8Array.from(needed), sides = [0, across - 1];
  let before = [], length = 0, bend = 0;
  for (let n = 0; n + 1 < kept.length; n++) {
    const steps = sides.map(side => plus(at(points, (n + 1) * across + side), at(points, n * across + side), -1));
    const ahead = steps.map(unit), long = Math.max(...steps.map(step => Math.hypot(...step)));
    if (!kept[n]) bend += Math.max(...ahead.map((each, m) => Math.hypot(...plus(each, before[m], -1))));
    length += long;
    if (kept[n] || !(length * bend < 8 * off)) [kept[n], length, bend] = [1, long, 0];
    before = ahead;
  }
  return kept;
}
/** Normals of points by the triangles round them. */
function normalsOf(points, triangles) {
  const out = new Float32Array(points.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [i, j, k] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const ax = points[j] - points[i], ay = points[j + 1] - points[i + 1], az = points[j + 2] - points[i + 2];
    const bx = points[k] - points[i], by = points[k + 1] - points[i + 1], bz = points[k + 2] - points[i + 2];
    const x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    for (const n of [i, j, k]) { out[n] += x; out[n + 1] += y; out[n + 2] += z; }
  }
  for (let n = 0; n < out.length; n += 3) {
    const length = Math.hypot(out[n], out[n + 1], out[n + 2]) || 1;
    out[n] /= length; out[n + 1] /= length; out[n + 2] /= length;
  }
  return out;
}
