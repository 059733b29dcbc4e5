// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Numbers over time, and the path of one spin on its sphere.
const ink = name => getComputedStyle(document.body).getPropertyValue(`--${name}`);
const text = number => Number(number.toPrecision(4)).toString();

function begin(canvas) {
  const {clientWidth: width, clientHeight: height} = canvas, scale = devicePixelRatio;
  [canvas.width, canvas.height] = [width * scale, height * scale];
  const pen = canvas.getContext("2d");
  pen.scale(scale, scale);
  pen.font = "11px system-ui, sans-serif";
  return [pen, width, height];
}

// rows: [time, ...]; columns: {number of the column: color}. `now`: the time of a line; `clock` writes times.
export function drawLines(canvas, rows, columns, now, clock) {
  const [pen, width, height] = begin(canvas);
  let lowest = Infinity, highest = -Infinity;
  for (const row of rows)
    for (const column in columns)
      if (row[column] !== null) {
        lowest = Math.min(lowest, row[column]);
        highest = Math.max(highest, row[column]);
      }
  if (!(lowest <= highest)) return;
  if (highest - lowest < 1e-12 * Math.abs(highest) || highest === lowest)
    [lowest, highest] = [lowest - Math.abs(lowest) / 2 - 1e-300, highest + Math.abs(highest) / 2 + 1e-300];
  const left = 62, bottom = height - 16, first = rows[0][0], last = rows[rows.length - 1][0];
  const x = time => left + (width - left - 8) * (last > first ? (time - first) / (last - first) : 0);
  const y = value => bottom - (bottom - 6) * (value - lowest) / (highest - lowest);
  pen.strokeStyle = ink("faint");
  pen.strokeRect(left, 6, width - left - 8, bottom - 6);
  pen.fillStyle = ink("ink");
  pen.textAlign = "right";
  pen.fillText(text(highest), left - 4, 14);
  pen.fillText(text(lowest), left - 4, bottom);
  pen.fillText(`t = ${clock(last)}`, width - 8, height - 3);
  for (const column in columns) {
    pen.strokeStyle = ink(columns[column]);
    pen.lineWidth = 1.5;
    pen.beginPath();
    // Of the rows of one pixel the first, the extremes and the last are enough.
    for (let i = 0, j; i < rows.length; i = j) {
      const at = Math.floor(x(rows[i][0]));
      let low = Infinity, high = -Infinity;
      for (j = i; j < rows.length && Math.floor(x(rows[j][0])) === at; ++j) {
        low = Math.min(low, rows[j][column] ?? low);
        high = Math.max(high, rows[j][column] ?? high);
      }
      if (low > high) continue;
      for (const value of j > i + 2 ? [rows[i][column] ?? low, low, high, rows[j - 1][column] ?? high]
        : [rows[i][column] ?? low, rows[j - 1][column] ?? high]) pen.lineTo(x(rows[i][0]), y(value));
    }
    pen.stroke();
  }
  pen.strokeStyle = ink("ink");
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(x(now), 6);
  pen.lineTo(x(now), bottom);
  pen.stroke();
}

const [TURN, RISE] = [-0.7, 0.4]; // of the eye
const flat = ([x, y, z]) => [
  y * Math.cos(TURN) - x * Math.sin(TURN),
  z * Math.cos(RISE) - Math.sin(RISE) * (x * Math.cos(TURN) + y * Math.sin(TURN)),
  z * Math.sin(RISE) + Math.cos(RISE) * (x * Math.cos(TURN) + y * Math.sin(TURN))];

// path: directions one after another; `now`: which one has a dot.
export function drawSphere(canvas, path, now) {
  const [pen, width, height] = begin(canvas), radius = Math.min(width, height) / 2 - 16;
  const at = point => [width / 2 + radius * point[0], height / 2 - radius * point[1]];
  const draw = (points, color) => {
    for (let i = 1; i < points.length; ++i) {
      const a = flat(points[i - 1]), b = flat(points[i]);
      pen.globalAlpha = a[2] + b[2] < 0 ? 0.3 : 1; // the far side
      pen.strokeStyle = color;
      pen.beginPath();
      pen.moveTo(...at(a));
      pen.lineTo(...at(b));
      pen.stroke();
    }
    pen.globalAlpha = 1;
  };
  pen.strokeStyle = ink("faint");
  pen.beginPath();
  pen.arc(width / 2, height / 2, radius, 0, 7);
  pen.stroke();
  const circle = Array.from({length: 73}, (_, i) => [Math.cos(i * Math.PI / 36), Math.sin(i * Math.PI / 36)]);
  draw(circle.map(([c, s]) => [c, s, 0]), ink("faint"));
  pen.textAlign = "center";
  for (const [axis, name] of ["x", "y", "z"].entries()) {
    const end = [0, 0, 0];
    end[axis] = 1;
    draw([[0, 0, 0], end], ink(name));
    pen.fillStyle = ink(name);
    const [x, y] = at(flat(end.map(c => 1.12 * c)));
    pen.fillText(name, x, y + 4);
  }
  pen.lineWidth = 1.5;
  draw(path, ink("ink"));
  if (!path[now]) return;
  pen.fillStyle = ink("x");
  pen.beginPath();
  pen.arc(...at(flat(path[now])), 5, 0, 7);
  pen.fill();
}
