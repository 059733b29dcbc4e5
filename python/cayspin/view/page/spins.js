// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Draws spins as colors: films as cells, crystals as discs. The colors are those of
// texture/colors.py.
const WIDTH = 2048; // of the texture that holds the spins one after another

const COLORED = `#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D spins;
uniform bool safe;
const vec3 COOLWARM[7] = vec3[7](
  vec3(0.868, 0.855, 0.861), vec3(0.489, -0.101, -0.618), vec3(-0.464, -0.995, -0.539),
  vec3(-0.355, 0.1, 0.44), vec3(0.054, 0.7, 0.198), vec3(0.106, -0.128, -0.126),
  vec3(0.01, -0.401, -0.071));
vec3 spin(int site) { return texelFetch(spins, ivec2(site % ${WIDTH}, site / ${WIDTH}), 0).xyz; }
vec4 colored(vec3 m) {
  float size = length(m), z = size > 0. ? m.z / size : 0.;
  if (size == 0.) return vec4(0);
  if (safe) { // a fit of matplotlib's coolwarm, to 4 of 255
    vec3 sum = vec3(0);
    for (int i = 6; i >= 0; --i) sum = sum * z + COOLWARM[i];
    return vec4(clamp(sum, 0., 1.), 1);
  }
  float turn = m.x == 0. && m.y == 0. ? 0. : atan(m.y, m.x) * 0.9549296586, s = 1. - abs(z);
  vec3 away = abs(mod(turn - vec3(0, 2, 4) + 3., 6.) - 3.);
  return vec4(clamp(0.5 + 0.4 * z - 0.5 * s + s * clamp(2. - away, 0., 1.), 0., 1.), 1);
}`;
const CELLS = [`${COLORED}
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4. - 1., 0, 1); }`,
`${COLORED}
uniform vec2 pixels;
uniform ivec2 extents;
out vec4 color;
void main() {
  ivec2 at = min(ivec2(gl_FragCoord.xy / pixels * vec2(extents)), extents - 1);
  color = colored(spin(at.y * extents.x + at.x));
}`];
const DISCS = [`${COLORED}
in vec3 position;
uniform float size;
flat out vec4 shade;
void main() {
  shade = colored(spin(gl_VertexID));
  gl_Position = shade.a > 0. ? vec4(position, 1) : vec4(2, 2, 2, 1);
  gl_PointSize = size;
}`, `#version 300 es
precision highp float;
flat in vec4 shade;
out vec4 color;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  color = shade;
}`];

export class Spins {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext("webgl2", {antialias: false});
    if (!gl) throw new Error("this browser shows no WebGL 2; accepted: one that does");
    [this.cells, this.discs] = [CELLS, DISCS].map(([vertex, fragment]) => {
      const program = gl.createProgram();
      for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
      }
      gl.bindAttribLocation(program, 0, "position");
      gl.linkProgram(program);
      if (!gl.getProgramParameter(program, gl.LINK_STATUS))
        throw new Error(gl.getProgramInfoLog(program));
      return program;
    });
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
  }

  // positions: of the discs, between -1 and 1; size: their diameter / the height of the picture.
  place(positions, size) {
    Object.assign(this, {positions, size});
    this.gl.bufferData(this.gl.ARRAY_BUFFER, positions, this.gl.STATIC_DRAW);
  }

  // spins: an Int8Array, three numbers for each site, row by row from the bottom up; extents: the
  // numbers of columns and rows.
  load(spins, extents) {
    const rows = Math.ceil(spins.length / 3 / WIDTH), whole = new Int8Array(3 * WIDTH * rows);
    whole.set(spins);
    const gl = this.gl;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8_SNORM, WIDTH, rows, 0, gl.RGB, gl.BYTE, whole);
    Object.assign(this, {extents, sites: spins.length / 3});
  }

  draw(safe, positions = this.positions) {
    const gl = this.gl, {width, height} = this.canvas;
    const program = positions ? this.discs : this.cells;
    const place = name => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniform1i(place("safe"), safe);
    if (positions) {
      gl.enable(gl.DEPTH_TEST);
      gl.enableVertexAttribArray(0);
      gl.uniform1f(place("size"), this.size * height);
      gl.drawArrays(gl.POINTS, 0, this.sites);
    } else {
      gl.disable(gl.DEPTH_TEST);
      gl.disableVertexAttribArray(0);
      gl.uniform2f(place("pixels"), width, height);
      gl.uniform2i(place("extents"), ...this.extents);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
  }

  // at(): where a site is in the picture, from 0 to 1 to the right and up. nearest(): the site
  // nearest to such a point.
  at(site) {
    const {positions, extents: [columns, rows]} = this;
    if (positions) return [0, 1].map(axis => (positions[3 * site + axis] + 1) / 2);
    return [(site % columns + 0.5) / columns, (Math.floor(site / columns) + 0.5) / rows];
  }
  nearest(x, y) {
    const {width, height} = this.canvas;
    let best = 0, least = Infinity;
    for (let site = 0; site < this.sites; ++site) {
      const [right, up] = this.at(site), depth = this.positions?.[3 * site + 2] ?? 0;
      const away = Math.hypot((right - x) * width, (up - y) * height) + 1e-3 * depth;
      if (away < least) [best, least] = [site, away];
    }
    return best;
  }

  // Draws the key: spins along the normal in the middle, in the plane half way out, against the
  // normal at the rim.
  drawKey(onto, safe) {
    const side = 160, spins = new Int8Array(3 * side * side);
    for (let site = 0; site < side * side; ++site) {
      const [x, y] = [site % side, Math.floor(site / side)].map(at => (2 * at + 1) / side - 1);
      const radius = Math.hypot(x, y), part = 127 * Math.sin(Math.PI * radius) / radius;
      if (radius < 1) spins.set([x * part, y * part, 127 * Math.cos(Math.PI * radius)], 3 * site);
    }
    const before = [this.canvas.width, this.canvas.height];
    this.canvas.width = this.canvas.height = onto.width = onto.height = side;
    this.load(spins, [side, side]);
    this.draw(safe, null);
    onto.getContext("2d").drawImage(this.canvas, 0, 0);
    [this.canvas.width, this.canvas.height] = before;
  }
}
