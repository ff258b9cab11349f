/* Fibre as it is laid: along the filament, fibre by fibre, or block by block of a program. */
const SECONDS = 30;  // for all of the fibre

function atRow(n) {
  const layer = wound.layers > 1 ? [["layer", `${wound.layer[n] + 1} of ${wound.layers}`]] : [];
  const path = wound.path[n] < 0 ? [] : [["path", String(wound.path[n])]];
  return [["length so far", rounded(wound.laid[n], units)], ...layer, ["circuit", String(wound.circuit[n] + 1)],
          ["pass", `${wound.passed[n] + 1}, ${wound.passed[n] % 2 ? "back" : "out"}`], ...path,
          ["angle", `${wound.angle[n].toFixed(1)}°`], ["slip", rounded(wound.slip[n] < 1e-6 ? 0 : wound.slip[n])],
          ["kind", wound.words[wound.kind[n]]]];
}
/** Show the band up to a length of fibre. */
function windTo(done) {
  const n = lastUpTo(wound.laid, done), next = Math.min(n + 1, wound.laid.length - 1), half = (wound.across - 1) / 2;
  const share = wound.laid[next] > wound.laid[n] ? (done - wound.laid[n]) / (wound.laid[next] - wound.laid[n]) : 0;
  const [a, b] = [n, next].map(row => at(wound.points, row * wound.across + half));
  laid.row = n;
  laid.head = plus(a.map(each => each * (1 - share)), b, share);
  if (!program) filled(byId("here"), atRow(n));
  document.body.dataset.wound = String(n);
  redraw();
}

/** Length of all fibres laid before each, one after the other by their numbers, and of all at the end. */
const before = [0];
for (let k = 0; k < fibres.count; k++) before.push(before[k] + fibres.arc[fibres.first[k + 1] - 1]);
/** Show fibres up to a length of all of them; a fibre that is not continuous is laid fibre by fibre. */
function layTo(done) {
  const k = Math.min(lastUpTo(before, done), fibres.count - 1),
    arc = fibres.arc.subarray(fibres.first[k], fibres.first[k + 1]);
  const n = done >= before[fibres.count] ? fibres.kind.length : fibres.first[k] + lastUpTo(arc, done - before[k]);
  laid.pieces = n;
  filled(byId("here"), [["fibre", `${k}, family ${familyWords(fibres.figures[k].family)}`],
    ["laid of all fibres", rounded(Math.min(done, before[fibres.count]), units)],
    ["laid of this one", rounded(Math.min(done - before[k], arc.at(-1)), units)]]);
  document.body.dataset.wound = String(n);
  redraw();
}

function clock(seconds) {
  const tenths = Math.round(10 * seconds), minutes = Math.floor(tenths / 600);
  return `${minutes}:${((tenths - 600 * minutes) / 10).toFixed(1).padStart(4, "0")}`;
}
/** What is said of a block: where it is, its axes, and what is wrong with it. */
function blockRows(n) {
  const p = program, run = lastUpTo(p.first, n), eye = eyeAt(n), wrong = faultAt(n);
  const values = { mandrel: p.turns[n] * 360 + p.angle[n], carriage: p.scale * p.x[n], cross: p.scale * p.r[n],
    roll: p.roll[n], yaw: p.yaw[n] };
  const layer = wound.layers > 1 ? [["layer", `${p.layer[run] + 1} of ${wound.layers}`]] : [];
  return [["block", `${p.index[n]} / ${p.blocks - 1}`],
          ["time", `${clock(p.time[n])} of ${clock(p.time.at(-1))}`], ...layer,
          ["circuit", String(p.circuit[run] + 1)],
          ["pass", `${p.passed[run] + 1}, ${p.passed[run] % 2 ? "back" : "out"}`],
          ["kind", p.does[p.kind[run]]], ["fibre laid", rounded(p.laid[n], units)],
          ["free span", p.kind[run] === p.does.length - 1 ? "none"
            : rounded(Math.hypot(...plus(eye, at(p.point, n), -1)), units)],
          ...p.axes.map(axis => [axis.words,
            `${values[axis.moves].toFixed(2).replace("-", "−")}${axis.unit === "deg" ? "°" : " " + axis.unit}`]),
          ...(wrong ? [["fault", wrong]] : [])];
}
let block = 0;
/** Show a block of the program: span and eye, the band up to it, and its axes. */
function goTo(n) {
  const turned = program.angle[block] + 360 * program.turns[block];
  block = Math.min(Math.max(n, 0), program.time.length - 1);
  const lines = blockRows(block);
  laid.wrong = faultAt(block);
  laid.eye = eyeAt(block);
  filled(byId("here"), lines);
  if (laid.wrong) byId("here").rows[lines.length - 1].className = "fault";
  if (gl) refill(span.places, doubled(new Float32Array([...at(program.point, block), ...laid.eye])));
  windTo(program.laid[block]);
  if (byId("follow").checked) camera.turnAbout(program.frame[0],
    (turned - program.angle[block] - 360 * program.turns[block]) * Math.PI / 180);
  document.body.dataset.block = String(block);
}

const slider = byId("wound");
const most = () => program ? program.time.at(-1) : wound ? wound.total : before[fibres.count];
function moveTo(place) {
  if (program) goTo(lastUpTo(program.time, place));
  else if (wound) windTo(place);
  else layTo(place);
  slider.setAttribute("aria-valuetext", program ? `block ${program.index[block]}, ${clock(program.time[block])}`
    : `${rounded(place, units)} of ${rounded(most(), units)} laid`);
}
let playing = 0;
async function play() {
  const mine = ++playing;
  byId("play").textContent = "pause";
  if (+slider.value >= most()) slider.value = 0;
  for (let last = performance.now(), place = +slider.value; mine === playing && place < most();) {
    const now = await new Promise(requestAnimationFrame);
    const pace = program ? +byId("speed").value : most() / SECONDS;
    place = Math.min(place + pace * Math.max(now - last, 0) / 1000, most());
    slider.value = place;
    last = now;
    moveTo(place);
  }
  if (mine === playing) stop();
}
function stop() { playing++; byId("play").textContent = "play"; }
/** Stop playing, and show a block, to which the slider goes too. */
function jumpTo(n) {
  stop();
  slider.value = program.time[Math.min(Math.max(n, 0), program.time.length - 1)];
  moveTo(+slider.value);
  goTo(n);  // blocks may take no time
}
slider.max = most();
slider.value = most();
slider.addEventListener("input", () => { stop(); moveTo(+slider.value); });
byId("play").addEventListener("click", () => byId("play").textContent === "play" ? play() : stop());
if (program) {
  byId("laying").textContent = "Program";
  byId("facts").append(Object.assign(document.createElement("li"), { textContent: program.machine }));
  for (const id of ["pace", "keys"]) byId(id).hidden = false;
  const paces = [1, 4, 16, 64, 256].filter((pace, n) => n < 2 || program.time.at(-1) / pace > 4);
  byId("speed").append(...paces.map(pace => new Option(pace === 1 ? "as the machine" : `${pace} × as fast`, pace)));
  byId("speed").value = paces.find(pace => program.time.at(-1) / pace < 2.5 * SECONDS) || paces.at(-1);
  byId("next").hidden = !program.faulty.length;
  byId("next").textContent = "next at fault";
  byId("next").addEventListener("click", () => jumpTo(program.faulty.find(n => n > block) ?? program.faulty[0]));
  addEventListener("keydown", event => {
    const step = event.shiftKey ? 25 : 1, own = event.target.matches("select, input:not(#wound, [type=checkbox])");
    const to = { ArrowRight: block + step, ArrowLeft: block - step, Home: 0, End: program.time.length - 1 }[event.key];
    if (to === undefined || own || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    jumpTo(to);
  });
}
