const SUNK = 2e-3 * size;  // the part's facets lie so much behind its fibres
const KIND = { "1": 0, "-1": 1, bridge: 2, loose: 3, none: 7 };
const FIRST = 8, LAST = 16;  // added to the kind of the first and the last particle of a fibre
const WIDTHS = [2.4, 2.4, 3.6, 1.6, 1, 1, 1, 1];  // half of it to either side, by kind

const part = bodyOf(surface.points, gridTriangles(rows, columns, scene.surface.closed, scene.surface.outward));

/** Kind of the piece after each particle. */
fibres.kind = new Uint8Array(fibres.points.length / 3).fill(KIND.none);
for (let k = 0; k < fibres.count; k++) {
  const { status, family } = fibres.figures[k];
  for (let n = fibres.first[k]; n < fibres.first[k + 1] - 1; n++) {
    fibres.kind[n] = status ? KIND.loose : fibres.off[n] || fibres.off[n + 1] ? KIND.bridge : KIND[family];
  }
}
const fibreLines = linesOf(fibres.points, new Uint8Array(fibres.kind.length * 4), []);
/* Nearly straight runs of particles are drawn as one piece while the view moves: `ahead` says where that ends. */
const STRAIGHT = 1.5e-4 * size;
const coarse = (() => {
  const ahead = new Uint32Array(fibres.kind.length), starts = [], p = fibres.points;
  for (let n = 0; n < fibres.kind.length; n++) {
    if (fibres.kind[n] === KIND.none) continue;
    let m = n + 1, length = 0, bend = 0;
    for (let old = unit(plus(at(p, m), at(p, n), -1)); fibres.kind[m] === fibres.kind[n]; m++) {
      const step = plus(at(p, m + 1), at(p, m), -1), next = unit(step);
      length += Math.hypot(...step);
      bend += Math.hypot(...plus(next, old, -1));
      if (!(length * bend < 8 * STRAIGHT)) break;
      old = next;
    }
    starts.push(n);
    ahead[n] = m;
    n = m - 1;
  }
  return { ahead, starts };
})();
const coarseLines = linesOf(fibres.points, fibreLines.looks, [], fibreLines);
const chosenLine = linesOf(new Float32Array(6), new Uint8Array(8), []);

/* The quad mesh between crossings, side by side. */
const mesh = scene.quads && (() => {
  const corners = interleaved(scene.quads.points, 3, middle), ends = interleaved(scene.quads.ends, 2);
  const points = new Float32Array(3 * ends.length), looks = new Uint8Array(4 * ends.length);
  ends.forEach((corner, n) => {
    points.set(corners.subarray(3 * corner, 3 * corner + 3), 3 * n);
    looks.set([47, 79, 47, n % 2 ? LAST : FIRST], 4 * n);
  });
  return linesOf(points, looks, Array.from({ length: ends.length / 2 }, (_, k) => 2 * k));
})();

const strips = wound && stripTriangles(wound.sizes, wound.across);
const band = wound && bodyOf(wound.points, strips.triangles, Float32Array.from(
  { length: wound.points.length / 3 * 2 },
  (_, n) => {
    const row = Math.floor(n / 2 / wound.across);
    return n % 2 ? wound.over[row] : wound.laid[row] / wound.total;
  }));
/* As of the fibres, fewer triangles of the band while the view moves. */
const coarseStrips = wound && (() => {
  const needed = new Uint8Array(wound.laid.length);
  for (let n = 1; n < needed.length; n++) {
    if (wound.over[n] !== wound.over[n - 1] || wound.kind[n] !== wound.kind[n - 1]) needed[n - 1] = needed[n] = 1;
  }
  let end = 0;
  for (const count of wound.sizes) { needed[end] = 1; end += count; needed[end - 1] = 1; }
  return stripTriangles(wound.sizes, wound.across, bentRows(wound.points, wound.across, needed, STRAIGHT));
})();
const coarseBand = wound && bodyOf(wound.points, coarseStrips.triangles, null, band);
/** How bands lie over the part: so far that facets may hide them, so far above it, and what their order lifts them. */
const over = wound && { sunk: SUNK, tolerance: SUNK + scene.surface.off, reach: SUNK + 4 * wound.highest,
  lifts: wound.lifts };
const gear = [];
if (wound && wound.gear) {
  const points = interleaved(wound.gear.points, 3, middle);
  beside.push(points);
  // pins end flush with what holds them
  for (const [name, colour, sunk] of [["base", "#bcc5ce", 0], ["held", "#3d4852", SUNK]]) {
    const triangles = Uint32Array.from(interleaved(wound.gear[name], 3));
    if (triangles.length) gear.push({ body: bodyOf(points, triangles), colour, sunk });
  }
}

// the free span of a program, and spans at fault
const FAULTS_SHOWN = 1000, FEW_FAULTS = 60;
/** Where the eye is beside the part at a block: it goes round by minus the mandrel's angle. */
function eyeAt(n) {
  const phi = -program.angle[n] * Math.PI / 180, [a, zero, third] = program.frame;
  return program.origin.map((o, m) => o + program.x[n] * a[m]
    + program.r[n] * (Math.cos(phi) * zero[m] + Math.sin(phi) * third[m]));
}
/** What is wrong with a block, in words; nothing of most. */
function faultAt(n) {
  const k = lastUpTo(program.faulty, n);
  return program.faulty.length && program.faulty[k] === n ? program.words[program.fault[k]] : "";
}
let span = null, faults = null;
if (program) {
  span = linesOf(new Float32Array(6), new Uint8Array([0, 0, 0, FIRST, 0, 0, 0, LAST]), [0]);
  const step = Math.ceil(program.faulty.length / FAULTS_SHOWN), ends = [], looks = [];
  for (let k = 0; k < program.faulty.length; k += step) {
    ends.push(...at(program.point, program.faulty[k]), ...eyeAt(program.faulty[k]));
    looks.push(224, 33, 138, FIRST, 0, 0, 0, LAST);
  }
  if (ends.length) faults = linesOf(new Float32Array(ends), new Uint8Array(looks),
    Array.from({ length: ends.length / 6 }, (_, k) => 2 * k));
  const thin = Math.ceil(program.time.length / 3000), eyes = [];
  for (let n = 0; n < program.time.length; n += thin) eyes.push(...eyeAt(n));
  beside.push(new Float32Array(eyes));
}
camera.reach = [surface.points, ...beside].reduce((most, points) => {
  for (let n = 0; n < points.length; n += 3) most = Math.max(most, Math.hypot(points[n], points[n + 1], points[n + 2]));
  return most;
}, 0) * 1.05;

/** What is to be seen of the fibres and the band: pieces before one, and rows up to one; all as long as nothing is wound
   back. */
const laid = { pieces: fibres.kind.length, row: wound ? wound.laid.length - 1 : 0, head: null, eye: null, wrong: "" };
const look = { coloured: 0, shades: null, opacity: 1, bandShades: null };
const clip = { axis: -1, share: .5, other: false, fibres: true };

/** The plane beyond which nothing is drawn: its normal, and how far out it lies. */
function clipPlane() {
  if (clip.axis < 0) return EVERYWHERE;
  const [low, high] = extent[clip.axis], sign = clip.other ? -1 : 1, normal = [0, 0, 0];
  normal[clip.axis] = sign;
  return [...normal, sign * (low + clip.share * (high - low) - middle[clip.axis])];
}
function on(id) { const input = byId("show-" + id); return !input || input.checked; }
/** Kinds of fibres in sight, as bits. */
function kindsShown() {
  const switches = { family1: KIND[1], "family-1": KIND[-1], bridges: KIND.bridge, loose: KIND.loose };
  return Object.entries(switches).reduce((bits, [name, kind]) => bits | on(name) << kind, 0);
}
/** Draw the kinds of fibres that are to be seen. */
function showKinds() {
  const shown = kindsShown(), seen = n => shown >> fibres.kind[n] & 1;
  choosePieces(fibreLines, Array.from(fibres.kind.keys()).filter(seen));
  choosePieces(coarseLines, coarse.starts.filter(seen), coarse.ahead);
  const legend = byId("fibreLegend"), bridgesAlone = byId("fibreColour").value === "family";
  if (legend) legend.hidden = !(bridgesAlone ? on("bridges") : shown);
  redraw();
}
/** How many of rising pieces come before one. */
function piecesBefore(pieces, end) {
  return pieces.length && pieces[0] < end ? lastUpTo(pieces, end - 1) + 1 : 0;
}
/** Draw what the drawing needs to know: the part's depth, by which bands are drawn. */
function drawBefore(wide, high) {
  if (band && on("band")) drawSheet(part, wide, high, SUNK, clip.fibres);
}
function drawAll(finely) {
  const lines = finely ? fibreLines : coarseLines;
  const solid = look.opacity >= 1, surfaceLook = { ...look, sunk: SUNK, opacity: look.opacity };
  if (on("part") && solid) drawBody(part, surfaceLook);
  if (band && on("band")) drawBand(finely ? band : coarseBand, { ...over, shades: look.bandShades,
    count: 3 * (finely ? strips : coarseStrips).ends[laid.row], cut: clip.fibres });
  if (on("gear")) for (const { body, colour, sunk } of gear) drawBody(body, { colour, sunk, cut: clip.fibres });
  drawLine(lines, { widths: WIDTHS, count: piecesBefore(lines.pieces, laid.pieces), cut: clip.fibres });
  if (chosen >= 0) {
    const how = { widths: WIDTHS, count: piecesBefore(chosenLine.pieces, laid.pieces - fibres.first[chosen]),
      cut: clip.fibres };
    drawLine(chosenLine, { ...how, colour: INK, more: 4.5, sunk: -3 * SUNK });  // before the band as well
    drawLine(chosenLine, { ...how, colour: CHOSEN, more: .9, sunk: -3.4 * SUNK });
  }
  if (mesh && on("quads")) drawLine(mesh, { widths: [1], sunk: -.2 * SUNK, cut: clip.fibres });
  if (faults && on("faults")) drawLine(faults, { widths: WIDTHS, cut: false });
  if (span && on("span")) drawLine(span, { widths: [3], colour: laid.wrong ? FAULTY : INK, cut: false });
  if (on("part") && !solid) drawBody(part, surfaceLook);
}

/** Marks over the drawing: axes, scale bar, where fibre is laid, the eye, and what is measured. */
function drawOver() {
  const [wide, high] = [canvas.clientWidth, canvas.clientHeight], marks = [];
  const mark = (name, with_, text = "") => {
    const values = Object.entries(with_).map(([key, value]) =>
      `${key}="${typeof value === "number" ? value.toFixed(1) : value}"`);
    marks.push(`<${name} ${values.join(" ")}>${text}</${name}>`);
  };
  const em = parseFloat(getComputedStyle(document.documentElement).fontSize), arm = 2.1 * em,
    corner = [3.3 * em, high - 3.3 * em];
  for (const [m, name] of AXES.entries()) {
    const [x, y] = [camera.right[m], -camera.up[m]], end = [corner[0] + arm * x, corner[1] + arm * y];
    const word = 1 + .65 * em / arm;
    mark("line", { x1: corner[0], y1: corner[1], x2: end[0], y2: end[1], stroke: INK, "stroke-width": "1.6" });
    if (Math.hypot(x, y) > .12) {
      mark("text", { x: corner[0] + word * arm * x, y: corner[1] + word * arm * y, "text-anchor": "middle",
        "dominant-baseline": "central" }, name);
    }
  }
  if (!camera.perspective) {
    const most = .3 * wide * camera.height / high, power = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].find(digit => digit * power <= most) * power, px = length * high / camera.height;
    const [right, y] = [wide - 18, high - 18];
    mark("path", { d: `M${right - px} ${y - 5}v5h${px}v-5`, fill: "none", stroke: INK, "stroke-width": "1.6" });
    mark("text", { x: right - px / 2, y: y - 7, "text-anchor": "middle" }, rounded(length, units));
  }
  if (laid.head && on("band") && !(clip.fibres && clipped(laid.head))) {
    const [x, y] = camera.project(laid.head);
    mark("circle", { cx: x, cy: y, r: 4, fill: INK, stroke: "#fff" });
  }
  if (laid.eye && on("span")) {
    const [x, y] = camera.project(laid.eye);
    mark("path", { d: `M${x} ${y - 7}l6 7l-6 7l-6-7z`, fill: laid.wrong ? FAULTY : EYE, stroke: "#fff" });
  }
  const ends = measure.points.map(p => camera.project(p.place));
  if (ends.length === 2) {
    const along = { x1: ends[0][0], y1: ends[0][1], x2: ends[1][0], y2: ends[1][1] };
    mark("line", { ...along, stroke: "#fff", "stroke-width": "5" });
    mark("line", { ...along, stroke: INK, "stroke-width": "2", "stroke-dasharray": "6 4" });
  }
  ends.forEach(([x, y], n) => {
    mark("circle", { cx: x, cy: y, r: 4.5, fill: "#fff", stroke: INK, "stroke-width": "2" });
    mark("text", { x: x + 8, y: y - 8, "font-weight": "600" }, "AB"[n]);
  });
  if (keyed) {
    const [x, y] = [wide / 2, high / 2];
    mark("path", { d: `M${x - 9} ${y}h18M${x} ${y - 9}v18`, stroke: "#fff", "stroke-width": "4" });
    mark("path", { d: `M${x - 9} ${y}h18M${x} ${y - 9}v18`, stroke: INK, "stroke-width": "1.5" });
  }
  byId("over").setAttribute("viewBox", `0 0 ${wide} ${high}`);
  byId("over").innerHTML = marks.join("");
}
