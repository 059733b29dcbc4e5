// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
import {drawLines, drawSphere} from "./lines.js";
import {Spins} from "./spins.js";

const $ = id => document.getElementById(id);
const number = id => Number($(id).value);
const sleep = time => new Promise(done => setTimeout(done, time));
const token = new URLSearchParams(location.search).get("token") ?? "";
const times = [], problems = {}; // times of the frames
const rows = []; // of the samples: [t, energy, mx, my, mz]
window.onerror = text => say("page", text);
const spins = new Spins($("spins"));
let news, about, laidOut, playing = 0, place = null, path = [];

// Writes a text only if it has changed: redrawing takes time that a run may need.
function write(id, text) {
  if ($(id).textContent !== text) $(id).textContent = text;
}

function say(who, text) {
  problems[who] = text;
  write("message", Object.values(problems).filter(Boolean).join(" "));
}

async function ask(what, parameters, method = "GET") {
  const answer = await fetch(`${what}?${new URLSearchParams({...parameters, token})}`, {method})
    .catch(() => { throw new Error("cayspin view has ended; accepted: start it again"); });
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return answer;
}
const bytes = async (what, parameters) => (await ask(what, parameters)).arrayBuffer();

// Returns a function that runs `work`. A call while `work` runs makes it run once more afterwards.
function lastOf(name, work) {
  let running = null, again = false;
  const run = async () => {
    try {
      for (; again; say(name)) {
        again = false;
        await work();
      }
    } catch (error) {
      say(name, error.message);
    }
    running = null;
  };
  return () => {
    again = true;
    return running ??= run();
  };
}

const normal = () => "xyz"[number("normal")];
const plane = () => `${normal()}=${number("plane")}`;
const across = () => [0, 1, 2].filter(axis => axis !== number("normal")); // right and up
const extents = () => across().map(axis => about.extents[axis]);

function fit(width, height) {
  const aspect = Math.min(Math.max(width / height, 0.1), 12), {style, parentElement} = $("stage");
  style.width = `${Math.min(parentElement.clientWidth, 0.7 * innerHeight * aspect)}px`;
  style.aspectRatio = aspect;
  const {clientWidth, clientHeight} = $("spins"); // a pixel for a cell is enough
  const most = about.crystal ? [Infinity, Infinity] : extents();
  $("spins").width = Math.min(clientWidth * devicePixelRatio, most[0]);
  $("spins").height = Math.min(clientHeight * devicePixelRatio, most[1]);
}

async function layOutCrystal() {
  const at = new Float32Array(await bytes("positions", {plane: plane()}));
  const low = [Infinity, Infinity, Infinity], high = low.map(end => -end);
  at.forEach((end, i) => {
    low[i % 3] = Math.min(low[i % 3], end);
    high[i % 3] = Math.max(high[i % 3], end);
  });
  const [width, height, depth] = high.map((end, i) => end - low[i]);
  const [columns, lines] = extents(), edge = to => [at[3 * to] - at[0], at[3 * to + 1] - at[1]];
  const a = edge(columns > 1 ? 1 : 0), b = edge(lines > 1 ? columns : 0);
  const area = Math.abs(a[0] * b[1] - a[1] * b[0]) * columns * lines / (at.length / 3); // of a site
  const apart = Math.sqrt(area) || Math.max(Math.hypot(...a), Math.hypot(...b)) || 1;
  const half = [width / 2 + 0.7 * apart, height / 2 + 0.7 * apart, -(depth || 1)];
  spins.place(at.map((end, i) => (end - (low[i % 3] + high[i % 3]) / 2) / half[i % 3]),
              0.43 * apart / half[1]);
  fit(half[0], half[1]);
}

// Lays out cells by their spacing, and the sites of a crystal by their positions.
async function layOut() {
  const [right, up] = across().map(axis => "xyz"[axis]), of = about.extents[number("normal")];
  $("plane").max = of - 1;
  $("plane").hidden = of === 1;
  $("number").textContent = `${plane()} of ${of}`;
  $("directions").textContent = `right: +${right}, up: +${up}, middle: +${normal()}, `
    + `rim: \u2212${normal()}`;
  spins.drawKey($("key"), $("colors").value === "safe");
  if (about.crystal) return layOutCrystal();
  fit(...across().map(axis => about.extents[axis] * about.spacing[axis]));
}

const clock = time => `${Number(time.toPrecision(6))}${about.si ? " s" : ""}`;

function drawGraphs() {
  const now = times[number("frame")];
  drawLines($("energy"), rows, {1: "z"}, now, clock);
  drawLines($("magnetization"), rows, {2: "x", 3: "y", 4: "z"}, now, clock);
  $("mark").hidden = $("sphere").hidden = place === null;
  if (place === null) return;
  drawSphere($("sphere"), path, number("frame"));
  const [x, y] = spins.at(place);
  $("mark").style.left = `${100 * x}%`;
  $("mark").style.bottom = `${100 * y}%`;
  const m = path[number("frame")]?.map(part => part.toFixed(3)).join(", ");
  $("spin").textContent = `Site ${place} of ${plane()}${m ? `: m = (${m})` : ""}`;
}

const show = lastOf("frame", async () => {
  if (!times.length) return;
  const layout = [plane(), $("colors").value, innerWidth, innerHeight, devicePixelRatio].join(" ");
  if (layout !== laidOut) await layOut();
  laidOut = layout;
  const shown = number("frame");
  spins.load(new Int8Array(await bytes("frame", {number: shown, plane: plane()})), extents());
  spins.draw($("colors").value === "safe");
  $("time").textContent = `${shown} of 0 to ${times.length - 1}, t = ${clock(times[shown])}`;
  $("spins").setAttribute("aria-label", `Spins of plane ${plane()}, frame ${shown}`);
  document.body.dataset.shown = `${shown} ${layout}`;
  drawGraphs();
});

const trace = lastOf("path", async () => {
  while (place !== null && path.length < times.length) {
    const asked = path;
    const got = new Float32Array(await bytes("path", {place, plane: plane(), first: path.length}));
    if (asked !== path) continue; // another site has been chosen meanwhile
    if (!got.length) return;
    for (let i = 0; i < got.length; i += 3) path.push([...got.subarray(i, i + 3)]);
    drawGraphs();
  }
});

function choose(site) {
  [place, path] = [site, []];
  trace();
  drawGraphs();
}

const readNews = lastOf("news", async () => {
  const before = news?.file, wasLast = number("frame") >= times.length - 1;
  news = await (await ask("news", {frames: times.length, samples: rows.length})).json();
  if (before && before !== news.file || news.frames < times.length) return location.reload();
  for (const time of news.times) times.push(time);
  for (const row of news.rows) rows.push(row);
  if (!about) {
    about = news.about;
    document.title = $("name").textContent = about.name;
    $("scene").textContent = about.scene;
    $("normal").value = about.normal;
    $("plane").max = about.extents[about.normal] - 1;
    $("plane").value = about.plane;
  }
  if (news.times.length) $("frame").max = times.length - 1;
  if (news.times.length && wasLast) $("frame").value = times.length - 1;
  write("state", news.run === "paused" ? "paused" : news.state);
  $("pause").hidden = $("stop").hidden = !news.run || news.run === "ended";
  write("pause", news.run === "paused" ? "Go on" : "Pause");
  say("run", news.message);
  if (news.times.length && wasLast) await show();
  else if (news.rows.length) drawGraphs();
  trace();
});

// Reads the news repeatedly, every 3 to 10 s, if possible so rarely that a run under way loses only
// about a hundredth of its time to this page. A reading takes the browser and the server about
// twice the time `took`, on a core for which all threads of the run wait.
async function follow() {
  while (!news || news.more || news.state === "under way" || (news.run ?? "ended") !== "ended") {
    const start = about ? performance.now() : Infinity, before = news; // the first one takes long
    if (!document.hidden) await readNews();
    const took = performance.now() - start;
    if (news === before || !news.more) await sleep(Math.min(Math.max(3000, 200 * took), 10000));
  }
}

async function play() {
  const turn = playing = playing ? 0 : performance.now();
  $("play").textContent = playing ? "\u23f8" : "\u25b6";
  $("play").setAttribute("aria-label", playing ? "Stop playing" : "Play");
  if (turn && number("frame") >= times.length - 1) $("frame").value = 0;
  while (turn && playing === turn) {
    await Promise.all([show(), sleep(40)]);
    if (playing !== turn) return;
    if (number("frame") < times.length - 1) $("frame").value = number("frame") + 1;
    else if (news.state === "under way") await sleep(500);
    else play();
  }
}

const steer = action => ask("steer", {action}, "POST").then(
  readNews, error => say("steer", error.message));

$("play").onclick = play;
$("pause").onclick = () => steer(news.run === "paused" ? "resume" : "pause");
$("stop").onclick = () => steer("stop");
$("frame").oninput = show;
$("colors").onchange = window.onresize = show;
matchMedia("(prefers-color-scheme: dark)").onchange = show;
$("normal").onchange = $("plane").oninput = event => {
  $("plane").max = about.extents[number("normal")] - 1;
  if (event.target === $("normal")) $("plane").value = about.extents[number("normal")] >> 1;
  [place, path] = [null, []];
  show();
};
$("spins").onclick = ({offsetX, offsetY, target}) => {
  choose(spins.nearest(offsetX / target.clientWidth, 1 - offsetY / target.clientHeight));
};
$("spins").onkeydown = event => {
  const row = extents()[0];
  const step = {ArrowLeft: -1, ArrowRight: 1, ArrowUp: row, ArrowDown: -row}[event.key];
  if (!step) return;
  event.preventDefault();
  choose(Math.min(Math.max((place ?? 0) + step, 0), spins.sites - 1));
};
document.onkeydown = event => {
  if (event.key !== " " || event.target.matches("button, select, input, summary")) return;
  event.preventDefault();
  play();
};
follow();
