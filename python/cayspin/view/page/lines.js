// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Draws numbers over time, and the path of one spin on the unit sphere.
const ink = name => getComputedStyle(document.body).getPropertyValue(`--${name}`);

function begin(canvas) {
  const {clientWidth: width, clientHeight: height} = canvas;
  // Without a graphics card a canvas is cheaper to draw in ordinary memory.
  const pen = canvas.getContext("2d", {willReadFrequently: true});
  [canvas.width, canvas.height] = [width * devicePixelRatio, height * devicePixelRatio];
  pen.scale(devicePixelRatio, devicePixelRatio);
  pen.font = "11px system-ui, sans-serif";
  pen.lineJoin = "round";
  return [pen, width, height];
}

function stroke(pen, points, color) {
  pen.strokeStyle = color;
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
  pen.stroke();
}

// rows: [time, ...]; columns: {number of the column: color}; `now`: the time that a vertical line
// marks.
export function drawLines(canvas, rows, columns, now, clock) {
  const [pen, width, height] = begin(canvas);
  let [low, high] = [Infinity, -Infinity];
  for (const row of rows)
    for (const column in columns) {
      low = Math.min(low, row[column] ?? low);
      high = Math.max(high, row[column] ?? high);
    }
  if (low > high) return;
  const left = 74, right = width - 6, top = 12, bottom = height - 24;
  const first = rows[0][0], last = rows[rows.length - 1][0];
  const x = time => left + (right - left) * (time - first) / (last - first || 1);
  const y = value => bottom - (bottom - top) * (value - low) / (high - low || 1);
  pen.fillStyle = ink("ink");
  pen.textAlign = "right";
  for (const value of [low, high])
    pen.fillText(Number(value.toPrecision(6)), left - 8, y(value) + 4);
  pen.fillText(`t = ${clock(last)}`, right, height - 4);
  const [above, below] = [top - 5, bottom + 5];
  stroke(pen, [[left, above], [left, below], [right, below]], ink("faint"));
  stroke(pen, [[x(now), above], [x(now), below]], ink("ink"));
  pen.lineWidth = 1.5;
  for (const column in columns) // lineTo() skips NaN
    stroke(pen, rows.map(row => [x(row[0]), y(row[column] ?? NaN)]), ink(columns[column]));
}

const [TURN, RISE] = [-0.7, 0.4]; // azimuth and elevation of the eye, in radians
function seen([x, y, z]) { // right, up and towards the eye
  const towards = x * Math.cos(TURN) + y * Math.sin(TURN);
  return [y * Math.cos(TURN) - x * Math.sin(TURN), z * Math.cos(RISE) - towards * Math.sin(RISE),
    z * Math.sin(RISE) + towards * Math.cos(RISE)];
}

// path: the directions of the spin in successive frames; `now`: the frame whose direction has a
// dot.
export function drawSphere(canvas, path, now) {
  const [pen, width, height] = begin(canvas), radius = Math.min(width, height) / 2 - 16;
  const at = ([right, up]) => [width / 2 + radius * right, height / 2 - radius * up];
  const draw = (points, color) => {
    for (let i = 1; i < points.length; ++i) {
      const [a, b] = [seen(points[i - 1]), seen(points[i])];
      pen.globalAlpha = a[2] + b[2] < 0 ? 0.3 : 1; // the far side
      stroke(pen, [at(a), at(b)], color);
    }
    pen.globalAlpha = 1;
  };
  const circle = Array.from({length: 73}, (_, i) => [Math.cos(i * Math.PI / 36),
    Math.sin(i * Math.PI / 36), 0]);
  stroke(pen, circle.map(at), ink("faint"));
  draw(circle, ink("faint"));
  pen.textAlign = "center";
  for (const [axis, name] of ["x", "y", "z"].entries()) {
    const end = [0, 0, 0];
    end[axis] = 1.1;
    draw([[0, 0, 0], end], ink(name));
    pen.fillStyle = ink(name);
    const [x, y] = at(seen(end));
    pen.fillText(name, x, y - 3);
  }
  pen.lineWidth = 1.5;
  draw(path, ink("ink"));
  if (!path[now]) return;
  pen.fillStyle = ink("x");
  pen.beginPath();
  pen.arc(...at(seen(path[now])), 5, 0, 7);
  pen.fill();
}
