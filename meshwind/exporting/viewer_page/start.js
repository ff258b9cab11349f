byId("name").textContent = scene.name;
const sides = extent.map(([low, high]) => rounded(high - low)).join(" × ");
for (const words of [`${sides}${units || " (unit unknown)"}`, ...scene.facts]) {
  byId("facts").prepend(Object.assign(document.createElement("li"), { textContent: words }));
}
byId("facts").prepend(...[...byId("facts").children].reverse());
for (const words of scene.notes) {
  byId("notes").append(Object.assign(document.createElement("p"), { textContent: words }));
}
canvas.setAttribute("aria-label", `${scene.name}, ${sides}${units}, with ${fibres.count} fibres`);
if (wound && gl) {
  look.bandShades = texture(pixels(Array.from({ length: 256 }, (_, n) => colourAt(wound.colours, n / 255))));
}
if (wound) slider.style.accentColor = INK;

new ResizeObserver(redraw).observe(canvas);
addEventListener("beforeprint", () => draw(true));
choose(-1);
showFibreColours();
showMeasure();
readOut(null);
camera.from(scene.camera.eye, scene.camera.up);
if (program) goTo(program.time.length - 1);
else moveTo(most());
byId("live").textContent = "";
draw(true);
// in the frame after the one with the first picture in it
requestAnimationFrame(() => requestAnimationFrame(() => {
  document.body.dataset.after = String(Math.round(performance.now()));  // milliseconds to the first picture
  document.body.dataset.ready = "yes";
}));
