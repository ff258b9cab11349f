const CHOSEN = "#ffe14d";
const STATUS = ["#4c78a8", "#d55e00", "#cc79a7", "#e0218a", "#7f3c8d", "#8c564b", "#111111"];
let chosen = -1;  // the fibre whose figures are shown

/** A scale for a value of fibres, as of a map. */
function scaleOf(title, words, high, colours, values) {
  const top = high > 0 ? high : 1, power = 10 ** Math.floor(Math.log10(top / 3)),
    step = [5, 2, 1].find(digit => digit * power <= top / 3) * power;
  const marks = Array.from({ length: Math.floor(top / step + 1e-9) + 1 }, (_, n) => n * step);
  return { title, words: [words], classes: [], colours, low: 0, high: top, marks: marks.map(mark => mark / top),
    mark_words: marks.map(mark => rounded(mark)), values };
}
function largest(values) { return values.reduce((most, value) => value > most ? value : most, 0); }
const inUnits = scene.units ? `in ${scene.units}` : "";
const gapScale = scaleOf("gap of bridges", inUnits ? `gap of bridges ${inUnits}` : "", scene.max_gap,
  scene.colours.gap);
const FIBRE_COLOURS = {
  family: { words: "by family" },
  status: { words: "by status" },
  slip: { words: "by required friction", scale: scaleOf("required friction", "",
    Math.max(largest(fibres.slip), scene.fibres.friction), scene.colours.scale), values: fibres.slip },
  angle: { words: "by winding angle", scale: scaleOf("winding angle", "winding angle in °",
    Math.max(largest(fibres.angle), 1), scene.colours.scale), values: fibres.angle },
};
/** Statuses of the fibres, each with their number. */
function statusItems() {
  const count = {};
  for (const { status } of fibres.figures) count[status] = (count[status] || 0) + 1;
  return Object.entries(count).map(([status, many]) => [STATUS[status], `${fibres.statuses[status]}: ${many}`]);
}
function showFibreColours() {
  const by = byId("fibreColour").value, { scale, values } = FIBRE_COLOURS[by], looks = fibreLines.looks;
  const table = scale && Array.from({ length: 256 }, (_, n) => colourAt(scale.colours, n / 255));
  const gaps = Array.from({ length: 256 }, (_, n) => colourAt(scene.colours.gap, n / 255));
  const of = (colours, share) => colours[Math.min(Math.round(255 * share), 255)];
  const bytes = colour => fraction(colour).map(each => 255 * each);
  const plain = { [KIND[1]]: bytes(FAMILY[1]), [KIND[-1]]: bytes(FAMILY[-1]), [KIND.loose]: bytes(LOOSE),
    [KIND.none]: [0, 0, 0] };
  const unknown = bytes(NONE), statuses = STATUS.map(bytes);
  for (let k = 0; k < fibres.count; k++) {
    for (let n = fibres.first[k]; n < fibres.first[k + 1]; n++) {
      const kind = fibres.kind[n];
      let rgb = plain[kind];
      if (by === "status") rgb = statuses[fibres.figures[k].status];
      else if (scale) rgb = Number.isFinite(values[n]) ? of(table, values[n] / scale.high) : unknown;
      else if (kind === KIND.bridge) rgb = of(gaps, Math.max(fibres.gap[n], fibres.gap[n + 1]) / gapScale.high);
      looks.set(rgb, 4 * n);
      looks[4 * n + 3] = kind | (n === fibres.first[k] && FIRST) | (n === fibres.first[k + 1] - 1 && LAST);
    }
  }
  if (gl) refill(fibreLines.colours, twice(looks));
  const old = byId("fibreLegend");
  if (old) old.remove();
  const bridged = fibres.kind.includes(KIND.bridge);
  if (by === "status") byId("legends").append(legendOf("fibreLegend",
    { title: "status", words: [""], classes: statusItems().map(([colour, words]) => ({ colour, words })) }));
  else if (scale || bridged) byId("legends").append(legendOf("fibreLegend", scale ? { ...scale, values } : gapScale));
  showKinds();
}
for (const [name, { words }] of Object.entries(FIBRE_COLOURS)) byId("fibreColour").append(new Option(words, name));
byId("fibreColour").addEventListener("change", showFibreColours);

/** The figures of a fibre, as the results have them. */
function figureRows(k) {
  const f = fibres.figures[k], share = f.length > 0 ? 100 * f.bridged / f.length : 0;
  const [low, mid, high] = f.angle.map(angle => angle === null ? "–" : `${angle.toFixed(2)}°`);
  return [["number", String(k)], ["family", familyWords(f.family)], ["status", fibres.statuses[f.status]],
    ["length", rounded(f.length, units, 6)],
    ["error of length", f.length_error > 0 ? `± ${rounded(f.length_error, units, 1)}` : "–"],
    ["winding angle", `${low} to ${high}`], ["its median", mid],
    ["required friction", rounded(f.slip !== null && f.slip < 1e-6 ? 0 : f.slip)],
    ["friction coefficient", rounded(fibres.friction)],
    ["bridges", String(f.bridges)], ["bridged length", rounded(f.bridged, units)],
    ["bridged share", `${share.toFixed(1)} %`], ["largest gap", rounded(f.gap, units)]];
}
/** Choose a fibre, or none by -1. */
function choose(k) {
  chosen = Math.min(Math.max(k, -1), fibres.count - 1);
  byId("fibreList").value = String(chosen);
  byId("noFibre").hidden = chosen >= 0;
  const lines = chosen < 0 ? [] : figureRows(chosen);
  filled(byId("figures"), lines);
  if (chosen >= 0 && gl) {
    const [from, to] = [fibres.first[chosen], fibres.first[chosen + 1]];
    refill(chosenLine.places, doubled(fibres.points.subarray(3 * from, 3 * to)));
    refill(chosenLine.colours, twice(fibreLines.looks.slice(4 * from, 4 * to)));
    choosePieces(chosenLine, Array.from({ length: to - from - 1 }, (_, n) => n));
  }
  if (chosen >= 0) {
    if (fibres.figures[chosen].status) byId("figures").rows[2].className = "fault";
    byId("figures").scrollIntoView({ block: "nearest" });
    say(`fibre ${lines.slice(0, 4).map(line => line.join(" ")).join(", ").replace("number ", "")}`);
  } else say("no fibre chosen");
  redraw();
}
function chooseNext(step) {
  const from = chosen < 0 && step < 0 ? 0 : chosen;
  choose((from + step + fibres.count) % fibres.count);
}
byId("fibreList").append(new Option("none", "-1"), ...fibres.figures.map((f, k) =>
  new Option(`${k}, family ${familyWords(f.family)}${f.status ? ", not at rest" : ""}`, k)));
byId("fibreList").addEventListener("change", event => choose(+event.target.value));
byId("previous").addEventListener("click", () => chooseNext(-1));
byId("following").addEventListener("click", () => chooseNext(1));
