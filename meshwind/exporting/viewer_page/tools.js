/* What is shown, clip plane, opacity, measuring, and how mouse, fingers and keys work the view. */
const gaps = fibres.kind.includes(KIND.bridge), loose = fibres.kind.includes(KIND.loose);
const kinds = [["family1", "family +1", FAMILY[1]], ["family-1", "family −1", FAMILY[-1]]];
if (gaps) kinds.push(["bridges", "bridges", "linear-gradient(90deg,#fcb2ba,#49006a)"]);
if (loose) kinds.push(["loose", "not at rest", LOOSE]);
if (wound) kinds.unshift(["band", "band, in order of winding",
  `linear-gradient(90deg,${wound.colours.map(([share, colour]) => `${colour} ${100 * share}%`).join(",")})`]);
if (gear.length) kinds.push(["gear", "what turns it", "#3d4852"]);
if (program) kinds.push(["span", "free span and eye", INK]);
if (faults) kinds.push(["faults", `all ${program.faulty.length} spans at fault`, FAULTY]);
if (mesh) kinds.push(["quads", `${rounded(scene.quads.count)} quads between crossings`, "#2f4f2f"]);
kinds.push(["part", "part", PART]);
const SHOWN = ["band", "gear", "part", "span", ...(program && program.faulty.length <= FEW_FAULTS ? ["faults"] : [])];
for (const [id, words, colour] of kinds) {
  const label = document.createElement("label"), input = document.createElement("input");
  Object.assign(input, { type: "checkbox", checked: id !== "quads" && (!wound || SHOWN.includes(id)), id: "show-" + id });
  label.append(input);
  byId("shown").append(swatch(label, colour, words));
  input.addEventListener("change", showKinds);
}

byId("opacity").addEventListener("input", event => {
  look.opacity = +event.target.value;
  byId("opacityNow").textContent = `${Math.round(100 * look.opacity)} %`;
  redraw();
});
function showClip() {
  const axis = byId("clipAxis").value;
  clip.axis = axis === "" ? -1 : +axis;
  clip.share = +byId("clipAt").value;
  clip.other = byId("clipOther").checked;
  clip.fibres = byId("clipFibres").checked;
  byId("clipping").hidden = clip.axis < 0;
  if (clip.axis >= 0) {
    const [low, high] = extent[clip.axis],
      words = `${AXES[clip.axis]} ${clip.other ? "≥" : "≤"} ${rounded(low + clip.share * (high - low), units)}`;
    byId("clipNow").textContent = words;
    byId("clipAt").setAttribute("aria-valuetext", `kept: ${words}`);
  }
  redraw();
}
for (const id of ["clipAxis", "clipOther", "clipFibres"]) byId(id).addEventListener("change", showClip);
byId("clipAt").addEventListener("input", showClip);

const measure = { on: false, points: [] };
function showMeasure() {
  const [a, b] = measure.points, lines = measure.points.map(({ place, what }, n) =>
    [`${"AB"[n]} on the ${what}`, placed(place)]);
  if (b) {
    const along = plus(b.place, a.place, -1);
    lines.push(["distance A to B", rounded(Math.hypot(...along), units, 5)],
      ["along x, y, z", along.map(each => rounded(each, "", 4)).join(", ")]);
  }
  filled(byId("measured"), lines);
  byId("measure").setAttribute("aria-pressed", String(measure.on));
  canvas.classList.toggle("measuring", measure.on);
  byId("measureHint").textContent = measure.on
    ? `Click ${["point A", "point B", "a new point A"][measure.points.length]} on the part or a fibre.`
    : measure.points.length ? "" : "Straight, between two points of the part or of fibres.";
  redraw();
}
function setMeasuring(yes) {
  measure.on = yes;
  say(yes ? "measuring: choose point A" : "measuring ended");
  showMeasure();
}
byId("measure").addEventListener("click", () => setMeasuring(!measure.on));
byId("clear").addEventListener("click", () => { measure.points = []; showMeasure(); });

/** Take what is at a place of the view: a point to measure from, or a fibre. */
function take(x, y) {
  const found = hit(x, y);
  readOut(found);
  if (!measure.on) {
    const path = !found ? -1 : found.what === "fibre" ? found.path
      : found.what === "band" ? wound.path[Math.floor(found.n / wound.across)] : -1;
    if (path >= 0) choose(path);
    else if (found) say("no fibre here");
    return;
  }
  if (!found) { say("nothing there to measure from"); return; }
  if (measure.points.length === 2) measure.points = [];
  measure.points.push({ place: found.place, what: found.what });
  showMeasure();
  if (measure.points.length === 1) say("point A taken; choose point B");
  else say(`distance ${byId("measured").rows[2].cells[1].textContent}`);
}

const pointers = new Map();
let moved = 0, hovered = null;
function placeIn(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}
/** Say what is under the pointer, once a frame. */
function hover() {
  const [x, y] = hovered;
  hovered = null;
  if (!pointers.size) readOut(hit(x, y));
}
canvas.addEventListener("pointerdown", event => {
  if (!pointers.size) moved = 0;
  pointers.set(event.pointerId, placeIn(event));
  canvas.setPointerCapture(event.pointerId);
});
canvas.addEventListener("pointermove", event => {
  const now = placeIn(event), before = pointers.get(event.pointerId);
  if (!before) {
    if (!hovered) requestAnimationFrame(hover);
    hovered = now;
    return;
  }
  const [dx, dy] = [now[0] - before[0], now[1] - before[1]],
    others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
  moved += Math.hypot(dx, dy);
  pointers.set(event.pointerId, now);
  if (moved < 4) return;
  canvas.classList.add("turning");
  if (others.length) {
    const apart = place => Math.max(Math.hypot(place[0] - others[0][0], place[1] - others[0][1]), 1);
    camera.zoom(apart(before) / apart(now));
    camera.move(dx / 2, dy / 2);
  } else if (event.shiftKey || event.buttons & 6) camera.move(dx, dy);
  else camera.turn(dx * Math.PI / canvas.clientHeight, dy * Math.PI / canvas.clientHeight);
});
for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => {
  const place = pointers.get(event.pointerId);
  pointers.delete(event.pointerId);
  canvas.classList.remove("turning");
  if (name === "pointerup" && place && moved < 4 && event.button === 0) take(...place);
});
canvas.addEventListener("pointerleave", () => { if (!pointers.size && !hovered) readOut(null); });
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  camera.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 120) * .0014));
}, { passive: false });

/** Whether the view is in focus by the keyboard, which gets a cross in its middle. */
let keyed = false;
canvas.addEventListener("focus", () => { keyed = canvas.matches(":focus-visible"); redraw(); });
canvas.addEventListener("blur", () => { keyed = false; redraw(); });
const STEP = 5 * Math.PI / 180;
function nextClip() {
  byId("clipAxis").selectedIndex = (byId("clipAxis").selectedIndex + 1) % 4;
  showClip();
  say(clip.axis < 0 ? "clip plane off" : `clip plane, ${byId("clipNow").textContent}`);
}
/** Turn the view by steps, or with Shift move it. */
const arrow = (x, y) => shift => shift ? camera.move(40 * x, 40 * y) : camera.turn(STEP * x, STEP * y);
const axis = m => shift => fromAxis(m, shift ? -1 : 1);
const [nearer, farther] = [.85, 1 / .85].map(factor => () => camera.zoom(factor));
const VIEW_KEYS = {
  ArrowLeft: arrow(-1, 0), ArrowRight: arrow(1, 0), ArrowUp: arrow(0, -1), ArrowDown: arrow(0, 1),
  "+": nearer, "=": nearer, "-": farther, "−": farther, x: axis(0), y: axis(1), z: axis(2),
  b: bestSide, l: alongPart, r: reset, o: () => setPerspective(!camera.perspective), c: nextClip,
  m: () => setMeasuring(!measure.on), "[": () => chooseNext(-1), "]": () => chooseNext(1),
  Enter: () => take(canvas.clientWidth / 2, canvas.clientHeight / 2),
  Escape: () => measure.on ? setMeasuring(false) : choose(-1),
};
canvas.addEventListener("keydown", event => {
  const act = VIEW_KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  event.stopPropagation();
  keyed = true;
  act(event.shiftKey);
});
