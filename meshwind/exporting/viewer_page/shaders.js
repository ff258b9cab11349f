/* Both kinds of things are drawn from the eye's axes: right, up and towards the eye.  "sunk" moves a thing from the eye
   along its line of sight, so that fibres on the part are seen although it is drawn as facets. */
const COMMON = `#version 300 es
precision highp float;
uniform mat4 view, lens;
uniform float sunk;
uniform bool perspective;
vec4 seen(vec3 point) {
  vec4 p = view * vec4(point, 1.);
  if (perspective) p.xyz *= 1. + sunk / max(-p.z, 1e-12);
  else p.z -= sunk;
  return lens * p;
}`;
// a shader that may discard keeps what is hidden from being left out, so there is one with and one without the cut
const CUT = `uniform vec4 plane;
#ifdef CUT
#define CUT_AT(point) if (dot(plane.xyz, point) > plane.w) discard;
#else
#define CUT_AT(point)
#endif`;

// the light is the eye's, from above its left shoulder
const LIGHT = `vec3 lit(vec3 colour, vec3 n) {
  float inside = n.z < 0. ? .82 : 1.;
  return colour * inside * (.6 + .44 * max(dot(n * sign(n.z + 1e-9), normalize(vec3(-.45, .5, .9))), 0.));
}`;
const LEAST_FACING = .2;  // cosine: bands in the air seen aslant are before what lies farther along the part

const SHADERS = {
  body: [`${COMMON}
in vec3 point, normal;
in vec2 share;
out vec3 place, facing;
out vec2 part;
out float beside;
flat out vec2 whole;
void main() {
  place = point; part = share; whole = share;
  beside = share.x > .5 ? share.x - 1. : share.x;
  facing = mat3(view) * normal;
  gl_Position = seen(point);
}`, `#version 300 es
precision highp float;
${CUT}
${LIGHT}
uniform vec4 colour;
uniform vec3 unknown;
uniform sampler2D shades;
// 0 by the one colour, 1 by the share between points, 2 by that of a quad's first point, 3 as 1 though it is unknown,
// 4 by an image over u, which goes once around, and v
uniform int coloured;
in vec3 place, facing;
in vec2 part;
in float beside;
flat in vec2 whole;
out vec4 shown;
void main() {
  CUT_AT(place)
  vec2 share = coloured == 2 ? whole : part;
  float u = fwidth(part.x) < fwidth(beside) ? part.x : beside;  // where u begins again only one of them is even
  vec3 base = coloured == 4 ? texture(shades, vec2(part.y, u)).rgb : coloured == 0 ? colour.rgb : share.y < .999 && coloured < 3 ? unknown : texture(shades, vec2(share.x, .5)).rgb;
  shown = vec4(lit(base, normalize(facing)), colour.a);
}`],
  depth: [`${COMMON}
in vec3 point;
out vec3 place;
void main() {
  place = point;
  gl_Position = seen(point);
}`, `#version 300 es
precision highp float;
${CUT}
in vec3 place;
void main() { CUT_AT(place) }`],
  /* Bands of fibre are computed one by one: where they cross in the air a later one would lie on an earlier one, and
     coarse facets of neighbours cut into each other.  So what lies over the part that is seen, or in the air before it,
     is brought to it in depth, the later the nearer; "sheet" is the part's depth.  Turnarounds and what lies before
     nothing keep their own. */
  band: [`${COMMON}
in vec3 point, normal;
in vec2 share;  // of all fibre laid before, and whether what is laid here lies over the part
out vec3 place, facing, spot;
out vec2 part;
void main() {
  place = point; part = share;
  facing = mat3(view) * normal;
  spot = (view * vec4(point, 1.)).xyz;
  gl_Position = seen(point);
}`, `#version 300 es
precision highp float;
${CUT}
${LIGHT}
uniform mat4 lens;
uniform bool perspective;
uniform float below, tolerance, reach, lifts[2];  // how far bands may lie under the part and over it; that of order
uniform sampler2D shades;
uniform highp sampler2D sheet;
in vec3 place, facing, spot;
in vec2 part;
out vec4 shown;
/** The depth of a distance towards the eye. */
float to(float z) { return .5 + .5 * (lens[2][2] * z + lens[3][2]) / (lens[2][3] * z + lens[3][3]); }
void main() {
  CUT_AT(place)
  vec3 n = normalize(facing);
  shown = vec4(lit(texture(shades, vec2(part.x, .5)).rgb, n), 1.);
  gl_FragDepth = gl_FragCoord.z;
  float depth = texelFetch(sheet, ivec2(gl_FragCoord.xy), 0).r, on = 2. * depth - 1.;
  float under = (lens[3][2] - lens[3][3] * on) / (lens[2][3] * on - lens[2][2]) + below;
  float above = (spot.z - under) * max(dot(n, perspective ? -normalize(spot) : vec3(0., 0., 1.)), ${LEAST_FACING});
  if (depth < 1. && part.y > .999 && above > -tolerance && above < reach) {
    gl_FragDepth = to(under + mix(lifts[0], lifts[1], part.x));
  }
}`],
  // each particle is two points, to either side of it; "before" and "after" are the particles next to it
  line: [`${COMMON}
uniform vec2 pixels;
uniform float widths[8], more;
uniform bool single;
uniform vec3 colour;
in vec3 before, here, after;
in vec4 look;  // colour, and kind with 8 for the first and 16 for the last of its fibre
out vec3 place;
flat out vec3 base;
vec2 flatten(vec4 p) { return p.xy / p.w * pixels; }
void main() {
  int code = int(look.a * 255. + .5);
  base = single ? colour : look.rgb;
  place = here;
  vec4 p = seen(here);
  vec2 at = flatten(p), back = vec2(0.), ahead = vec2(0.);
  if ((code & 8) == 0) back = at - flatten(seen(before));
  if ((code & 16) == 0) ahead = flatten(seen(after)) - at;
  float b = length(back), a = length(ahead);
  vec2 along = (b > 1e-4 ? back / b : vec2(0.)) + (a > 1e-4 ? ahead / a : vec2(0.));
  along = length(along) > 1e-4 ? normalize(along) : vec2(1., 0.);
  p.xy += vec2(-along.y, along.x) * ((gl_VertexID & 1) == 1 ? 1. : -1.) * (widths[code & 7] + more) / pixels * p.w;
  gl_Position = p;
}`, `#version 300 es
precision highp float;
${CUT}
in vec3 place;
flat in vec3 base;
out vec4 shown;
void main() {
  CUT_AT(place)
  shown = vec4(base, 1.);
}`],
};
