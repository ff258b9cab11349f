const FIELD = 26 * Math.PI / 180, FILLED = .84, RIGHT_ANGLE = Math.PI / 2;
/** What must be in the picture: the part, what turns a filament, and where the eye of a machine goes. */
const beside = [];

const camera = {
  right: [1, 0, 0], up: [0, 1, 0], eye: [0, 0, 1], target: [0, 0, 0], perspective: false,
  height: 1,  // what is seen from top to bottom at the target, in the mesh's units
  reach: size,  // radius of all that is drawn, from the middle of the part

  distance() { return this.height / (2 * Math.tan(FIELD / 2)); },
  aspect() { return Math.max(canvas.clientWidth, 1) / Math.max(canvas.clientHeight, 1); },
  view() {
    const back = this.perspective ? plus(this.target, this.eye, this.distance()) : this.target;
    const axes = [this.right, this.up, this.eye];
    const turned = [0, 1, 2].flatMap(m => [...axes.map(a => a[m]), 0]);
    return new Float32Array([...turned, ...axes.map(a => -dot(a, back)), 1]);
  },
  lens() {
    const half = this.height / 2, wide = half * this.aspect();
    const deep = this.reach + Math.hypot(...this.target);
    const rows = (x, y, z, w, shift, last) => new Float32Array([x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, w, 0, 0, shift, last]);
    if (!this.perspective) return rows(1 / wide, 1 / half, -1 / (1.1 * deep), 0, 0, 1);
    const d = this.distance(), near = Math.max(d - 1.1 * deep, .02 * d), far = d + 1.1 * deep, t = Math.tan(FIELD / 2);
    return rows(1 / (t * this.aspect()), 1 / t, (near + far) / (near - far), -1, 2 * near * far / (near - far), 0);
  },
  /** Where a point is in the view: x, y in pixels of the page from its top left, and its depth towards the eye. */
  project(p) {
    const q = plus(p, this.target, -1), [x, y, z] = [dot(q, this.right), dot(q, this.up), dot(q, this.eye)];
    const d = this.distance(), nearer = this.perspective ? d / Math.max(d - z, 1e-12) : 1;
    const scale = canvas.clientHeight / this.height * nearer;
    return [canvas.clientWidth / 2 + scale * x, canvas.clientHeight / 2 - scale * y, z];
  },
  /** The line of sight through a place of the view: a point of it, and its unit vector away from the eye. */
  ray(x, y) {
    const scale = this.height / canvas.clientHeight;
    const [right, up] = [scale * (x - canvas.clientWidth / 2), scale * (canvas.clientHeight / 2 - y)];
    const through = plus(plus(this.target, this.right, right), this.up, up);
    const outside = 4 * (this.reach + Math.hypot(...this.target));
    if (!this.perspective) return [plus(through, this.eye, outside), this.eye.map(e => -e)];
    const from = plus(this.target, this.eye, this.distance());
    return [from, unit(plus(through, from, -1))];
  },
  /** Look from a direction, all in the picture. */
  from(eye, up) {
    this.eye = unit(eye);
    this.right = unit(cross(up, this.eye));
    this.up = cross(this.eye, this.right);
    this.fit();
  },
  /** Have all in the picture. */
  fit() {
    const axes = [this.right, this.up, this.eye], ends = axes.map(() => [Infinity, -Infinity]);
    const all = visit => {
      for (const points of [surface.points, ...beside]) {
        for (let n = 0; n < points.length; n += 3) {
          visit(axes.map(axis => points[n] * axis[0] + points[n + 1] * axis[1] + points[n + 2] * axis[2]));
        }
      }
    };
    all(along => along.forEach((value, m) => {
      if (value < ends[m][0]) ends[m][0] = value;
      if (value > ends[m][1]) ends[m][1] = value;
    }));
    const centre = ends.map(([low, high]) => (low + high) / 2), aspect = this.aspect(), near = 2 * Math.tan(FIELD / 2);
    this.target = axes.reduce((sum, axis, m) => plus(sum, axis, centre[m]), [0, 0, 0]);
    this.height = 0;
    // what is nearer than the middle looks larger in perspective
    all(([x, y, z]) => {
      const high = Math.max(Math.abs(y - centre[1]), Math.abs(x - centre[0]) / aspect);
      this.height = Math.max(this.height, 2 * high / FILLED + (this.perspective ? (z - centre[2]) * near : 0));
    });
    redraw();
  },
  /** Turn by angles to the right and up, as if the part were held in front. */
  turn(right, up) {
    this.eye = turnedAbout(turnedAbout(this.eye, this.up, -right), this.right, -up);
    this.up = turnedAbout(this.up, this.right, -up);
    this.right = unit(cross(this.up, this.eye));
    this.up = unit(cross(this.eye, this.right));
    redraw();
  },
  /** Move what is seen by pixels of the page. */
  move(right, down) {
    const scale = this.height / canvas.clientHeight;
    this.target = plus(plus(this.target, this.right, -right * scale), this.up, down * scale);
    redraw();
  },
  zoom(factor) {
    this.height = Math.min(Math.max(this.height * factor, 1e-4 * size), 50 * size);
    redraw();
  },
  turnAbout(axis, angle) {
    for (const name of ["eye", "up", "right", "target"]) this[name] = turnedAbout(this[name], axis, angle);
  },
};

const AXES = ["x", "y", "z"];
/** Look along an axis, from its positive or its negative end. */
function fromAxis(m, sign) {
  const eye = [0, 0, 0];
  eye[m] = sign;
  camera.from(eye, m === 2 ? [0, 1, 0] : [0, 0, 1]);
  say(`seen from ${sign < 0 ? "−" : "+"}${AXES[m]}`);
}
function bestSide() { camera.from(scene.camera.eye, scene.camera.up); say("best side"); }
function alongPart() {
  const { eye, up } = scene.camera;
  if (scene.camera.width > scene.camera.height) camera.from(cross(up, eye), up);
  else camera.from(up, eye.map(e => -e));
  say("along the part");
}
function reset() {
  setPerspective(false);
  bestSide();
}
function setPerspective(on) {
  camera.perspective = on;
  if (on && camera.distance() < camera.reach) camera.fit();  // else the eye would be in the part
  byId("perspective").setAttribute("aria-pressed", String(on));
  say(on ? "perspective" : "parallel projection");
  redraw();
}
for (const [m, name] of AXES.entries()) for (const sign of [1, -1]) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", textContent: `${sign < 0 ? "−" : "+"}${name}`,
    id: `from${sign < 0 ? "-" : "+"}${name}` });
  button.setAttribute("aria-label", `look from ${sign < 0 ? "minus" : "plus"} ${name}`);
  button.addEventListener("click", () => fromAxis(m, sign));
  byId("axisViews").append(button);
}
byId("front").addEventListener("click", bestSide);
byId("top").addEventListener("click", alongPart);
byId("reset").addEventListener("click", reset);
byId("perspective").addEventListener("click", () => setPerspective(!camera.perspective));
