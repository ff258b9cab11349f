const FINE = 1024;
/** The colour of a scale, stops of [share, colour], at a share. */
function colourAt(stops, share) {
  const k = Math.min(lastUpTo(stops.map(stop => stop[0]), share), stops.length - 2), [a, b] = [stops[k], stops[k + 1]];
  const s = Math.min(Math.max((share - a[0]) / (b[0] - a[0]), 0), 1), [one, other] = [fraction(a[1]), fraction(b[1])];
  return one.map((from, m) => Math.round(255 * (from + s * (other[m] - from))));
}
const css = rgb => `rgb(${rgb.join(",")})`;
const pixels = colours => new Uint8Array(colours.flatMap(rgb => [...rgb, 255]));
/** Where the values of a map lie on its scale, 0 to 1, each with 1 where it is known. */
function shares(map) {
  const log = value => Math.log(Math.max(value, map.low) / map.low) / Math.log(map.high / map.low);
  const leasts = map.classes.map(each => each.least), classes = leasts.length;
  const linear = value => (value - map.low) / (map.high - map.low);
  const share = classes ? value => (lastUpTo(leasts, value) + .5) / classes : map.log ? log : linear;
  const out = new Float32Array(2 * map.values.length);
  map.values.forEach((value, n) => {
    if (Number.isFinite(value)) out.set([Math.min(Math.max(share(value), 0), 1), 1], 2 * n);
  });
  return out;
}
/** u and v of the part's points. */
function placesOnCells() {
  return Float32Array.from({ length: 2 * rows * columns }, (_, n) =>
    n % 2 ? surface.v[(n >> 1) % columns] : surface.u[Math.floor((n >> 1) / columns)]);
}
function cellPixels(classes, colours) {
  const out = new Uint8Array(4 * classes.length);
  classes.forEach((each, n) => out.set([...colours[each], 255], 4 * n));
  return out;
}
/** The class of the cell at u and v. */
function cellAt({ columns, rows, classes }, [u, v]) {
  const i = Math.floor((u - Math.floor(u)) * rows) % rows;
  return classes[i * columns + Math.min(Math.max(Math.floor(v * columns), 0), columns - 1)];
}
/** The shares at which a scale in steps changes its colour. */
function edges(map) {
  return [0, ...map.marks.filter(mark => mark > .001 && mark < .999), 1];
}
/** The colour of each share of a scale, from 0 to 1 by FINE. */
function shades(map, stepped) {
  const steps = edges(map);
  return Array.from({ length: FINE }, (_, n) => {
    const share = (n + .5) / FINE, k = Math.min(lastUpTo(steps, share), steps.length - 2);
    return colourAt(map.colours, stepped ? (steps[k] + steps[k + 1]) / 2 : share);
  });
}

/** Colour the part by a map, or plainly. */
function showMap() {
  const map = surface.maps.find(each => each.name === byId("map").value);
  byId("inSteps").hidden = !map || map.classes.length > 0;
  const stepped = map && !map.classes.length && byId("stepped").checked;
  look.coloured = !map ? 0 : map.cells ? 4 : map.classes.length ? 2 : 1;
  if (map && gl) {
    refill(part.buffers[2], map.cells ? placesOnCells() : shares(map));
    if (look.shades) gl.deleteTexture(look.shades);
    const classes = map.classes.map(each => fraction(each.colour).map(part => 255 * part));
    look.shades = map.cells ? texture(cellPixels(map.cells.classes, classes), map.cells.columns)
      : texture(pixels(classes.length ? classes : shades(map, stepped)));
  }
  const old = byId("mapLegend");
  if (old) old.remove();
  if (map) byId("legends").prepend(legendOf("mapLegend", map, stepped));
  redraw();
}
/** The legend of a scale, or of classes. */
function legendOf(id, map, stepped) {
  const box = document.createElement("section"), head = document.createElement("h2");
  Object.assign(box, { id, className: "legend" });
  const above = map.words.join(" "), known = map.values && map.values.every(Number.isFinite);
  head.textContent = !above || above.startsWith(map.title) ? above || map.title : `${map.title}: ${above}`;
  head.id = id + "Head";
  box.setAttribute("aria-labelledby", head.id);
  box.append(head);
  const items = map.classes.map(each => [each.colour, each.words]).reverse();
  if (!map.classes.length) {
    const scale = document.createElement("div"), bar = document.createElement("i");
    scale.className = "scale";
    const stops = stepped
      ? edges(map).slice(1).flatMap((end, k) => {
        const from = edges(map)[k], colour = css(colourAt(map.colours, (from + end) / 2));
        return [`${colour} ${100 * from}%`, `${colour} ${100 * end}%`];
      })
      : map.colours.map(([share, colour]) => `${colour} ${100 * share}%`);
    bar.style.background = `linear-gradient(0deg,${stops.join(",")})`;
    scale.append(bar);
    map.marks.forEach((mark, n) => {
      const words = document.createElement("span");
      words.textContent = map.mark_words[n];
      words.style.bottom = `${100 * mark}%`;
      scale.append(words);
    });
    box.append(scale);
  }
  if (map.values && !known) items.push([NONE, "no value"]);
  if (items.length) {
    const list = document.createElement("ul");
    for (const [colour, words] of items) list.append(swatch(document.createElement("li"), colour, words));
    box.append(list);
  }
  return box;
}
/** An element with a patch of colour and words. */
function swatch(element, colour, words) {
  const patch = document.createElement("i");
  patch.style.background = colour;
  element.append(patch, words);
  return element;
}
byId("map").append(new Option("plain", ""), ...surface.maps.map(map => new Option(map.title, map.name)));
byId("map").addEventListener("change", () => {
  const map = surface.maps.find(each => each.name === byId("map").value);
  if (map) byId("stepped").checked = map.stepped;
  showMap();
});
byId("stepped").addEventListener("change", showMap);
