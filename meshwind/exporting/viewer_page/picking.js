const NEAR = 8, EXACT = 3;  // pixels of the page that a fibre may be from the pointer, and when a distance is measured
/** Whether the clip plane takes a point away. */
function clipped(p) { const [a, b, c, d] = clipPlane(); return a * p[0] + b * p[1] + c * p[2] > d; }

/** Visit all of a body's triangles before `count` that a line of sight meets: how far along it, and which. */
function eachMet(body, [from, along], count, cut, visit) {
  const { points: p, triangles } = body, [a, b, c, d] = cut ? clipPlane() : EVERYWHERE;
  for (let k = 0; k < count; k += 3) {
    const i = 3 * triangles[k], j = 3 * triangles[k + 1], l = 3 * triangles[k + 2];
    const ex = p[j] - p[i], ey = p[j + 1] - p[i + 1], ez = p[j + 2] - p[i + 2];
    const fx = p[l] - p[i], fy = p[l + 1] - p[i + 1], fz = p[l + 2] - p[i + 2];
    const hx = along[1] * fz - along[2] * fy, hy = along[2] * fx - along[0] * fz, hz = along[0] * fy - along[1] * fx;
    const det = ex * hx + ey * hy + ez * hz;
    if (det === 0) continue;
    const sx = from[0] - p[i], sy = from[1] - p[i + 1], sz = from[2] - p[i + 2];
    const u = (sx * hx + sy * hy + sz * hz) / det;
    if (u < 0 || u > 1) continue;
    const qx = sy * ez - sz * ey, qy = sz * ex - sx * ez, qz = sx * ey - sy * ex;
    const v = (along[0] * qx + along[1] * qy + along[2] * qz) / det;
    if (v < 0 || u + v > 1) continue;
    const t = (fx * qx + fy * qy + fz * qz) / det;
    if (t <= 0) continue;
    if (a * (from[0] + t * along[0]) + b * (from[1] + t * along[1]) + c * (from[2] + t * along[2]) > d) continue;
    visit(t, k);
  }
}
/** What is met at a place of a body: how far along the line of sight, the nearest corner, and the place. */
function metAt({ points, triangles }, [from, along], t, k) {
  const place = plus(from, along, t), distance = n => Math.hypot(...plus(at(points, n), place, -1));
  const corners = [...triangles.subarray(k, k + 3)].sort((m, n) => distance(m) - distance(n));
  return { t, n: corners[0], place, k };
}
/** u and v at a place in one of the part's triangles. */
function partUv({ k, place }) {
  const corners = [0, 1, 2].map(m => part.triangles[k + m]), p = corners.map(n => at(part.points, n));
  const area = (a, b, c) => Math.hypot(...cross(plus(b, a, -1), plus(c, a, -1)));
  const areas = [0, 1, 2].map(m => area(place, p[(m + 1) % 3], p[(m + 2) % 3])), all = areas[0] + areas[1] + areas[2];
  const us = corners.map(n => surface.u[Math.floor(n / columns)]), most = Math.max(...us);
  const mean = values => values.reduce((sum, value, m) => sum + areas[m] * value, 0) / all;
  return [mean(us.map(u => most - u > .5 ? u + 1 : u)) % 1, mean(corners.map(n => surface.v[n % columns]))];
}
/** The first place of a body that a line of sight meets; null where it meets none. */
function hitBody(body, ray, count = body.count, cut = true) {
  let [best, found] = [Infinity, -1];
  eachMet(body, ray, count, cut, (t, k) => { if (t < best) [best, found] = [t, k]; });
  return found < 0 ? null : metAt(body, ray, best, found);
}
/** The place of the band that is seen on a line of sight, by the rules by which it is drawn; null where there is
   none. */
function hitBand(ray) {
  const under = hitBody(part, ray, part.count, clip.fibres), [low, high] = over.lifts;
  let best = null;
  eachMet(band, ray, 3 * strips.ends[laid.row], clip.fibres, (t, k) => {
    const met = metAt(band, ray, t, k), row = Math.floor(met.n / wound.across);
    const facing = -dot(at(band.normals, met.n), ray[1]);
    const above = under ? (under.t - t) * Math.max(facing, LEAST_FACING) : Infinity;
    if (facing < 0) met.t += 2 * SUNK;
    else if (wound.over[row] && above > -over.tolerance && above < over.reach) {
      met.t = under.t - low - (high - low) * wound.laid[row] / wound.total;
    }
    if (!best || met.t < best.t) best = met;
  });
  return best;
}

/** The fibre in sight nearest to a place of the view, if one is near: its nearest particle, and the place on it. */
function hitFibre(x, y, reach) {
  const points = fibres.points, shown = kindsShown(), count = points.length / 3;
  const px = new Float32Array(count), py = new Float32Array(count);
  const { right, up, eye, target } = camera, scale = canvas.clientHeight / camera.height, d = camera.distance();
  const [cx, cy] = [canvas.clientWidth / 2, canvas.clientHeight / 2];
  for (let n = 0, k = 0; n < count; n++, k += 3) {
    const a = points[k] - target[0], b = points[k + 1] - target[1], c = points[k + 2] - target[2];
    const s = camera.perspective ? scale * d / Math.max(d - (a * eye[0] + b * eye[1] + c * eye[2]), 1e-12) : scale;
    px[n] = cx + s * (a * right[0] + b * right[1] + c * right[2]);
    py[n] = cy - s * (a * up[0] + b * up[1] + c * up[2]);
  }
  const near = [];
  for (let n = 0; n < Math.min(count - 1, laid.pieces); n++) {
    if (!(shown >> fibres.kind[n] & 1)) continue;
    const ax = px[n + 1] - px[n], ay = py[n + 1] - py[n], length = ax * ax + ay * ay;
    const s = length ? Math.min(Math.max(((x - px[n]) * ax + (y - py[n]) * ay) / length, 0), 1) : 0;
    const away = Math.hypot(px[n] + s * ax - x, py[n] + s * ay - y);
    if (away < reach) near.push({ n, s, away });
  }
  near.sort((one, other) => one.away - other.away);
  const solid = on("part") && look.opacity > .6;
  for (const { n, s } of near.slice(0, 24)) {
    const place = at(points, n).map((from, m) => from + s * (points[3 * n + 3 + m] - from));
    if (clip.fibres && clipped(place)) continue;
    const hit = solid && hitBody(part, camera.ray(...camera.project(place)));
    if (hit && dot(plus(hit.place, place, -1), camera.eye) > 2.5 * SUNK) continue;  // behind the part
    return { n: s > .5 ? n + 1 : n, path: fibreOf(n), place, off: fibres.kind[n] === KIND.bridge };
  }
  return null;
}
/** What is seen at a place of the view: of a fibre, the band or the part; null where there is nothing. */
function hit(x, y) {
  const fibre = hitFibre(x, y, measure.on ? EXACT : NEAR);
  if (fibre) return { what: "fibre", ...fibre };
  const ray = camera.ray(x, y), found = [];
  const add = (what, one) => { if (one) found.push({ what, ...one }); };
  if (on("part")) add("part", hitBody(part, ray));
  if (band && on("band")) add("band", hitBand(ray));
  if (on("gear")) for (const { body } of gear) add("turnaround", hitBody(body, ray, body.count, clip.fibres));
  return found.sort((one, other) => one.t - other.t)[0] || null;
}

const placed = p => p.map((each, m) => rounded(each + middle[m], "", 5)).join(", ");
/** What is said of a place that was hit: a title, and rows of names and values. */
function saidOf(found) {
  const position = ["x, y, z", placed(found.place) + units];
  if (found.what === "part") {
    const uv = partUv(found), words = map => map.cells ? map.classes[cellAt(map.cells, uv)].words
      : valueWords(map, map.values[found.n]);
    return ["part", [position, ["u, v", uv.map(each => rounded(each)).join(", ")],
      ...surface.maps.map(map => [map.title, words(map)])]];
  }
  if (found.what === "turnaround") return ["what turns it", [position]];
  if (found.what === "band") return ["band", [position, ...atRow(Math.floor(found.n / wound.across))]];
  const { n, path } = found, figures = fibres.figures[path];
  const undefinedSlip = fibres.gap[n] > 0 ? "none off the surface" : "not defined at an end";
  const is = figures.status ? "not at rest" : found.off ? "bridging" : `family ${familyWords(figures.family)}`;
  return [`fibre ${path}`, [["is", is], position,
    ["u, v", [0, 1].map(m => rounded(fibres.uv[2 * n + m])).join(", ")],
    ["length so far", rounded(fibres.arc[n], units)],
    ["gap", rounded(fibres.gap[n], units, 3)], ["winding angle", `${fibres.angle[n].toFixed(1)}°`],
    ["required friction", Number.isFinite(fibres.slip[n]) ? rounded(fibres.slip[n], "", 3) : undefinedSlip]]];
}
/** A value of a map, in words where it has classes. */
function valueWords(map, value) {
  if (!map.classes.length) return rounded(value, map.unit && " " + map.unit);
  return Number.isFinite(value) ? map.classes[lastUpTo(map.classes.map(each => each.least), value)].words : "–";
}
const familyWords = family => family > 0 ? "+1" : "−1";

/** Say under the view what is at a place; nothing where there is nothing. */
function readOut(found) {
  const [title, lines] = found ? saidOf(found) : ["", []], out = byId("readout");
  out.replaceChildren();
  for (const [name, value] of found ? [["", title], ...lines] : [["Values under the pointer are shown here.", ""]]) {
    const row = document.createElement("div"), dt = document.createElement("dt"), dd = document.createElement("dd");
    [dt.textContent, dd.textContent] = [name, value];
    if (!name) dd.style.fontWeight = "600";
    row.append(dt, dd);
    out.append(row);
  }
}
