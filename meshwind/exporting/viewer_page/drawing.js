const canvas = byId("plot");
const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance",
  preserveDrawingBuffer: true });

/** Say that nothing can be drawn, and what to do; the figures beside the view stay. */
function fail(words) {
  byId("failed").hidden = false;
  byId("failed").textContent = words;
  document.body.dataset.failed = "yes";
}
if (!gl) {
  fail("The part cannot be drawn: this browser does not offer WebGL 2. Open the page in a current Firefox, Chrome, "
    + "Edge or Safari, and switch on graphics acceleration in the browser's settings (chrome://gpu or about:support "
    + "tell whether WebGL 2 is on). The figures of the fibres beside are complete without it; "
    + "`meshwind render` draws pictures of the run.");
}
canvas.addEventListener("webglcontextlost", event => {
  event.preventDefault();
  fail("The browser has given up the drawing of the part, as it may when memory or the graphics driver fails. "
    + "Reload the page.");
});

function compiled([vertex, fragment], names, cut) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, cut ? text.replace("\n", "\n#define CUT\n") : text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.attachShader(made, shader);
  }
  names.forEach((name, n) => gl.bindAttribLocation(made, n, name));
  gl.linkProgram(made);
  const at = {};
  for (let n = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); n--;) {
    const { name } = gl.getActiveUniform(made, n);
    at[name.replace("[0]", "")] = gl.getUniformLocation(made, name);
  }
  return { made, at };
}
const INPUTS = { body: ["point", "normal", "share"], band: ["point", "normal", "share"],
  depth: ["point"], line: ["before", "here", "after", "look"] }, programs = {};
/** The program for bodies or lines, with or without the cut, compiled when it is first wanted. */
function shader(name, cut) { return programs[name + cut] ??= compiled(SHADERS[name], INPUTS[name], cut); }

function buffer(values, target = gl.ARRAY_BUFFER) {
  const made = gl.createBuffer();
  gl.bindBuffer(target, made);
  gl.bufferData(target, values, gl.DYNAMIC_DRAW);
  return made;
}
function refill(made, values) {
  gl.bindBuffer(gl.ARRAY_BUFFER, made);
  gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
}
function attribute(index, made, count, { type = gl.FLOAT, offset = 0, whole = false } = {}) {
  gl.bindBuffer(gl.ARRAY_BUFFER, made);
  gl.enableVertexAttribArray(index);
  gl.vertexAttribPointer(index, count, type, whole, 0, offset);
}
/** A body of triangles; shares (2 n): place on the colour scale of each point, and 1 where it has one; like: another
   body, whose points these are. */
function bodyOf(points, triangles, shares, like = null) {
  const body = { points, triangles, count: triangles.length, normals: like ? like.normals : normalsOf(points, triangles) };
  if (!gl) return body;
  body.array = gl.createVertexArray();
  gl.bindVertexArray(body.array);
  body.buffers = like ? like.buffers
    : [points, body.normals, shares || new Float32Array(points.length / 3 * 2)].map(values => buffer(values));
  body.buffers.forEach((made, n) => attribute(n, made, [3, 3, 2][n]));
  buffer(triangles, gl.ELEMENT_ARRAY_BUFFER);
  gl.bindVertexArray(null);
  return body;
}
/** Two of each point, and two more at both ends. */
function doubled(points) {
  const out = new Float32Array(2 * points.length + 12);
  for (let n = 0; n < points.length; n += 3) {
    const point = points.subarray(n, n + 3);
    out.set(point, 2 * n + 6);
    out.set(point, 2 * n + 9);
  }
  return out;
}
function twice(looks) {
  const one = new Uint32Array(looks.buffer, looks.byteOffset, looks.length / 4), out = new Uint32Array(2 * one.length);
  for (let n = 0; n < one.length; n++) out[2 * n] = out[2 * n + 1] = one[n];
  return new Uint8Array(out.buffer);
}
/** Triangles of pieces of a line, each from a point to the one that `ahead` says; the last corner has the piece's
   colour. */
function pieceTriangles(pieces, ahead) {
  const out = new Uint32Array(6 * pieces.length);
  let k = 0;
  for (const n of pieces) {
    const a = 2 * n, b = 2 * (ahead ? ahead[n] : n + 1);
    out[k++] = a + 1; out[k++] = b; out[k++] = a; out[k++] = b; out[k++] = b + 1; out[k++] = a + 1;
  }
  return out;
}
/** Lines between points that follow each other; looks (4 n): colour of the piece from each point to the next, and its
   code. */
function linesOf(points, looks, pieces, like = null) {
  const line = { points, looks, pieces };  // like: another line, whose points these are
  if (!gl) return line;
  line.array = gl.createVertexArray();
  gl.bindVertexArray(line.array);
  [line.places, line.colours] = like ? [like.places, like.colours] : [buffer(doubled(points)), buffer(twice(looks))];
  for (const n of [0, 1, 2]) attribute(n, line.places, 3, { offset: 24 * n });
  attribute(3, line.colours, 4, { type: gl.UNSIGNED_BYTE, whole: true });
  line.order = buffer(pieceTriangles(pieces), gl.ELEMENT_ARRAY_BUFFER);
  gl.bindVertexArray(null);
  return line;
}
/** Change which pieces of a line are drawn, in their order. */
function choosePieces(line, pieces, ahead) {
  line.pieces = pieces;
  if (!gl) return;
  gl.bindVertexArray(line.array);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, line.order);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, pieceTriangles(pieces, ahead), gl.DYNAMIC_DRAW);
  gl.bindVertexArray(null);
}

/** Rows of colours, one after the other, as a texture, each pixel its own, so that steps have sharp edges. */
function texture(colours, wide = colours.length / 4) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, wide, colours.length / 4 / wide, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
  plainTexture();
  return made;
}
/** Have the pixels of the texture at hand not blended; only its rows begin again after the last. */
function plainTexture() {
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.REPEAT);
}
const fraction = colour => [1, 3, 5].map(k => parseInt(colour.slice(k, k + 2), 16) / 255);

const EVERYWHERE = [0, 0, 0, 1];
function withView(name, cut) {
  const { made, at } = shader(name, cut && clip.axis >= 0);
  gl.useProgram(made);
  const lens = camera.lens();
  gl.uniformMatrix4fv(at.view, false, camera.view());
  gl.uniformMatrix4fv(at.lens, false, lens);
  gl.uniform1i(at.perspective, camera.perspective);
  if (at.plane) gl.uniform4fv(at.plane, clipPlane());
  return at;
}
function drawBody(body, { colour = PART, opacity = 1, coloured = 0, shades = null, sunk = 0, count = body.count,
  cut = true }) {
  if (!count) return;
  const at = withView("body", cut);
  gl.uniform1f(at.sunk, sunk);
  gl.uniform4fv(at.colour, [...fraction(colour), opacity]);
  gl.uniform3fv(at.unknown, fraction(NONE));
  gl.uniform1i(at.coloured, coloured);
  if (shades) gl.bindTexture(gl.TEXTURE_2D, shades);
  gl.bindVertexArray(body.array);
  const draw = () => gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
  if (opacity >= 1) return draw();
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.depthMask(false);
  gl.enable(gl.CULL_FACE);
  for (const side of [gl.FRONT, gl.BACK]) { gl.cullFace(side); draw(); }  // what is behind first
  gl.disable(gl.CULL_FACE);
  gl.depthMask(true);
  gl.disable(gl.BLEND);
}
/** The part's depth, as large as the drawing, by which bands are drawn. */
const sheet = gl && { frame: gl.createFramebuffer(), depth: gl.createTexture(), size: "" };
function drawSheet(body, wide, high, sunk, cut) {
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, sheet.depth);
  gl.bindFramebuffer(gl.FRAMEBUFFER, sheet.frame);
  if (sheet.size !== `${wide} ${high}`) {
    sheet.size = `${wide} ${high}`;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.DEPTH_COMPONENT24, wide, high, 0, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT, null);
    plainTexture();
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, sheet.depth, 0);
  }
  gl.activeTexture(gl.TEXTURE0);
  gl.clear(gl.DEPTH_BUFFER_BIT);
  gl.uniform1f(withView("depth", cut).sunk, sunk);
  gl.bindVertexArray(body.array);
  gl.enable(gl.CULL_FACE);  // nothing is brought to an inside
  gl.cullFace(gl.BACK);
  gl.drawElements(gl.TRIANGLES, body.count, gl.UNSIGNED_INT, 0);
  gl.disable(gl.CULL_FACE);
}
/** Draw so many triangles of the band in the colours of their order: outsides before the part that is in the sheet,
   insides behind it, which is sunk itself. */
function drawBand(body, { shades, count, sunk, tolerance, reach, lifts, cut }) {
  if (!count) return;
  const at = withView("band", cut);
  gl.uniform1f(at.sunk, 0);
  gl.uniform1f(at.below, sunk);
  gl.uniform1f(at.tolerance, tolerance);
  gl.uniform1f(at.reach, reach);
  gl.uniform1fv(at.lifts, lifts);
  gl.uniform1i(at.sheet, 1);
  gl.bindTexture(gl.TEXTURE_2D, shades);
  gl.bindVertexArray(body.array);
  gl.enable(gl.CULL_FACE);
  gl.cullFace(gl.BACK);
  gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
  gl.cullFace(gl.FRONT);
  drawBody(body, { shades, count, sunk: 2 * sunk, coloured: 3, cut });
  gl.disable(gl.CULL_FACE);
}
/** Draw so many of a line's pieces; colour: one for all; more: pixels added to their widths. */
function drawLine(line, { widths, count = line.pieces.length, colour = "", more = 0, sunk = 0, cut = true }) {
  if (count <= 0) return;
  const at = withView("line", cut);
  gl.uniform1f(at.sunk, sunk);
  gl.uniform2f(at.pixels, canvas.width, canvas.height);
  gl.uniform1fv(at.widths, widths.map(width => width * density()));
  gl.uniform1f(at.more, more * density());
  gl.uniform1i(at.single, colour !== "");
  gl.uniform3fv(at.colour, fraction(colour || INK));
  gl.bindVertexArray(line.array);
  gl.drawElements(gl.TRIANGLES, 6 * count, gl.UNSIGNED_INT, 0);
}

/** Pixels of the drawing per pixel of the page. */
function density() { return canvas.width / Math.max(canvas.clientWidth, 1); }
/* Smooth edges cost much without a graphics card: there, what moves is drawn without them, and with them when it
   rests. */
const SAMPLES = 4, QUICK = 20, REST = 160;  // milliseconds that a smooth frame may take, and until a picture rests
const TIMED = 4;  // smooth frames that are timed; the first one waits for the shaders
const smooth = gl && { many: gl.createFramebuffer(), one: gl.createFramebuffer(), colour: gl.createRenderbuffer(),
                       depth: gl.createRenderbuffer(), flat: gl.createRenderbuffer(), size: "",
                       timed: 0, time: Infinity };
/** Make room for smooth frames, with several samples a pixel, and for what becomes of them. */
function makeRoom(wide, high) {
  if (smooth.size === `${wide} ${high}`) return;
  smooth.size = `${wide} ${high}`;
  const room = (frame, kind, samples, format, place) => {
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.bindRenderbuffer(gl.RENDERBUFFER, kind);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, wide, high);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, kind);
  };
  room(smooth.many, smooth.colour, SAMPLES, gl.RGBA8, gl.COLOR_ATTACHMENT0);
  room(smooth.many, smooth.depth, SAMPLES, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT);
  room(smooth.one, smooth.flat, 0, gl.RGBA8, gl.COLOR_ATTACHMENT0);
}
/** Bring a smooth frame to the page. */
function resolve(wide, high, start) {
  for (const [from, to] of [[smooth.many, smooth.one], [smooth.one, null]]) {
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
    gl.blitFramebuffer(0, 0, wide, high, 0, 0, wide, high, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  if (smooth.timed++ >= TIMED) return;
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));  // waits for the drawing
  smooth.time = Math.min(performance.now() - start, smooth.time);
}
let waiting = false, resting = 0;
/** Draw once more, when the browser is ready for it. */
function redraw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    const quick = smooth && smooth.time < QUICK;
    draw(quick);
    clearTimeout(resting);
    if (!quick) resting = setTimeout(() => draw(true), REST);
  });
}
/** Draw now; smoothly: with smooth edges. */
function draw(smoothly) {
  const wanted = Math.min(devicePixelRatio || 1, 2), wide = Math.round(canvas.clientWidth * wanted),
    high = Math.round(canvas.clientHeight * wanted);
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  if (gl && wide && high && !gl.isContextLost()) {
    const start = performance.now();
    gl.viewport(0, 0, wide, high);
    gl.clearColor(1, 1, 1, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    drawBefore(wide, high);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (smoothly) {
      makeRoom(wide, high);
      gl.bindFramebuffer(gl.FRAMEBUFFER, smooth.many);
    }
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    drawAll(smoothly);
    if (smoothly) resolve(wide, high, start);
    drawOver();
  }
  document.body.dataset.drawn = smoothly ? "smooth" : "quick";
}
