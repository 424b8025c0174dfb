// The page of sinew live.

import { Vector3 } from "three";
import { Blade } from "./blade.js";
import { FIELDS, NOT_KNOWN, paintBar, roundUp } from "./colours.js";
import { Connection } from "./connection.js";
import { CutPanel } from "./cuts.js";
import { NO_TWIN } from "./frames.js";
import { Hand } from "./hand.js";
import { History, SPAN } from "./history.js";
import { colourOfLight, numberOfReason, reasonOf } from "./lights.js";
import { plain, short, withUnit } from "./numbers.js";
import { PaneCard, stepInWords } from "./panes.js";
import { Plot, around } from "./plots.js";
import { Screen } from "./screen.js";
import { ShapeRow } from "./shape.js";
import { View } from "./view.js";

const get = (id) => document.getElementById(id);
const test = new URLSearchParams(window.location.search).has("test");
const LINES = ["--first", "--second"];
const PLOT_EVERY = 70;

let notice = 0;

function say(text, time = 6000) {
  const message = get("message");
  message.textContent = text;
  message.hidden = false;
  notice = performance.now() + time;
}

/// The view, or a sentence where this browser has no WebGL: without it there is nothing to see, and the page goes no further.
function viewOn(canvas) {
  try {
    return new View(canvas, test);
  } catch (error) {
    get("title").textContent = "Nothing can be shown";
    say("This browser draws nothing in three dimensions (WebGL). Turn on its hardware acceleration, or open the address in another browser.", Infinity);
    throw error;
  }
}

const canvas = get("canvas");
const view = viewOn(canvas);
const histories = [new History(), new History()];
const cards = [];
const plots = Object.fromEntries(["force-time", "force-depth", "energy"].map((id) => [id, new Plot(get(id))]));
let scenery = null;
let settings = null;
let integrators = [];
let picture = null;
let pictures = 0;
/// The largest 1/step (1/s) of an element at the surface.
let largestRate = 1;
let plotted = 0;
let since = { at: performance.now(), pictures: 0 };
let connected = true;
const last = { saved: null, refused: [], stopped: [], rate: 0 };

/// Adds to a list of the latest.
function keep(list, item) {
  list.push(item);
  if (list.length > 50) list.shift();
}

const connection = new Connection({
  scenery: begin,
  settings: configure,
  integrators: ({ list }) => {
    integrators = list;
    cards.forEach((card) => card.setIntegrators(list));
  },
  refused: ({ reason }) => {
    keep(last.refused, reason);
    say(reason);
  },
  stopped: (event) => keep(last.stopped, event),
  reset: () => {
    histories.forEach((history) => history.clear());
    hand.release();
    blade.drop();
  },
  tools: ({ tools }) => {
    scenery.tools = tools;
    hand.begin(tools, scenery.hand);
    view.setTools(tools);
    showShape();
  },
  trusted_ended: ({ reason }) => say(reason),
  saved: (event) => {
    last.saved = event;
    say(`Saved in ${event.folder}. Repeat it with: ${event.replay}`, 15000);
  },
  closed: () => {
    connected = false;
    if (!scenery) {
      get("title").textContent = "Not connected";
      // A refusal has been said.
      if (last.refused.length === 0) say("No connection to the simulation. Reload the page where `sinew live` still runs; its address changes with each start.", Infinity);
      return;
    }
    say("The simulation has ended, or this page was closed from there. Reload it where `sinew live` still runs.", Infinity);
  },
});

const screen = new Screen();
const paneAt = (x) => Math.min(view.count - 1, Math.floor((x - canvas.getBoundingClientRect().left) / (canvas.clientWidth / view.count)));
const cutPanel = new CutPanel(view);
const blade = new Blade(view, {
  paneAt,
  cut: (from, to) => connection.command("cut", { from, to }),
  path: (path) => cutPanel.showPath(path),
});
cutPanel.begin(blade, hint);

const hand = new Hand(canvas, view, {
  blade,
  bladeKey: (event) => cutPanel.key(event),
  paneAt,
  lead: (tool, position, rotation) => connection.command("pose", { tool, position: position.toArray(), rotation }),
  gripAt: () => pointOf(picture?.panes[0], scenery?.hand?.point ?? 0) ?? view.centre,
  pull: (force) => {
    scenery.hand.loads.forEach((load, axis) => {
      connection.command("load", { load: scenery.loads[load].name, factor: force.getComponent(axis) / scenery.hand.unit });
    });
  },
});

const shapeRow = new ShapeRow(get("shape"), (tool, shape) => connection.command("shape", { tool, shape }));
const showShape = () => shapeRow.show(hand.selected, scenery.tools[hand.selected], view.extent);

function begin(event) {
  scenery = event;
  document.title = `${event.title} · sinew live`;
  get("title").textContent = event.title;
  get("field").replaceChildren(...event.fields.map((name) => new Option(FIELDS[name].title, name)));
  hand.begin(event.tools, event.hand);
  get("force-title").textContent = event.hand ? "Displacement at the hand" : "Force of the tool";
  get("force-card").hidden = event.tools.length === 0 && !event.hand;
  get("footer").textContent = `sinew ${event.version} · ${event.nodes} nodes · ${event.tets} tetrahedra · this computer only`;
  cutPanel.offer(event.cuts);
  hint();
  const sliders = event.loads.filter((_, index) => !event.hand?.loads.includes(index));
  get("loads-card").hidden = sliders.length === 0;
  get("loads").replaceChildren(...sliders.map(sliderOf));
}

function hint() {
  let words = "Drag to turn the view, wheel to zoom.";
  if (blade.isOn) words = "Drag: cut along your line of sight · right button or two fingers: turn the view · wheel: zoom · arrows move the blade, Enter lowers and lifts it · C: done";
  else if (scenery.tools.length > 0) words = "Drag: move the tool · wheel: near and far · Shift: lift it off · right button: turn the view · Ctrl + wheel: zoom · arrows and Page keys move it, too";
  else if (scenery.hand) words = `Drag: pull at the red point · right button: turn the view · wheel: zoom · arrows pull, Escape lets go. ${scenery.hand.note}`;
  if (scenery.cuts && !blade.isOn) words += " · C: a blade";
  get("hint").textContent = words;
  get("canvas").setAttribute("aria-label", `Tissue. ${keysInWords()} the right mouse button turns the view, and so do the keys [ and ].`);
}

/// What keys do on the canvas, for those who do not see it.
function keysInWords() {
  if (blade.isOn) return "Arrow keys move the blade, Enter lowers and lifts it, Escape puts it away;";
  if (scenery.tools.length > 0) return "Arrow keys move the tool, Page Up and Page Down lift and press it;";
  if (scenery.hand) return "Arrow keys, Page Up and Page Down pull at the red point, Escape lets go;";
  return "Plus and minus zoom;";
}

function sliderOf({ name, what }) {
  const row = document.createElement("div");
  row.className = "load";
  const [words, value, slider] = ["span", "output", "input"].map((tag) => document.createElement(tag));
  words.textContent = what;
  Object.assign(slider, { type: "range", min: -1, max: 3, step: 0.05, value: 1 });
  slider.setAttribute("aria-label", `Factor of ${what}`);
  slider.dataset.load = name;
  slider.addEventListener("input", () => connection.command("load", { load: name, factor: Number(slider.value) }));
  row.append(words, value, slider);
  return row;
}

function configure(event) {
  settings = event;
  const { panes } = event;
  while (cards.length < panes.length) {
    const card = new PaneCard(cards.length, {
      integrator: (pane, name) => connection.command("integrator", { pane, name }),
      dt: (pane, dt) => connection.command("dt", { pane, dt }),
      option: (pane, order) => connection.command("option", { pane, ...order }),
      trusted: () => connection.command("trusted", { on: !settings.trusted }),
    });
    card.setIntegrators(integrators);
    cards.push(card);
  }
  if (cards.length > panes.length) {
    cards.length = panes.length;
    histories[1].clear();
  }
  get("panes-info").replaceChildren(...cards.map((card) => card.root));
  panes.forEach((facts, pane) => cards[pane].settings(facts, event.trusted));
  get("captions").replaceChildren(...panes.map((facts) => {
    const caption = document.createElement("div");
    const [name, step, stopped] = ["b", "span", "span"].map((tag) => document.createElement(tag));
    caption.className = "caption";
    name.textContent = facts.integrator;
    step.textContent = stepInWords(facts);
    stopped.className = "stopped";
    stopped.textContent = facts.stopped ? `Stopped: ${facts.stopped}. Reset, or choose another method or a shorter step.` : "";
    caption.append(name, step, stopped);
    return caption;
  }));
  get("pause").setAttribute("aria-pressed", String(event.paused));
  get("pause").textContent = event.paused ? "Go on" : "Pause";
  get("panes").textContent = panes.length === 1 ? "Compare with a second method" : "One method alone";
  get("difference-box").hidden = panes.length === 1;
  if (panes.length === 1) get("difference").checked = false;
  if (get("field").value !== event.field) {
    get("field").value = event.field;
    legend();
  }
  scenery.loads.forEach(({ name }, index) => {
    const slider = get("loads").querySelector(`input[data-load="${CSS.escape(name)}"]`);
    if (!slider) return;
    if (document.activeElement !== slider) slider.value = event.factors[index];
    slider.parentElement.querySelector("output").textContent = `× ${plain(event.factors[index], 3)}`;
  });
  hand.follow(event.factors);
  // Also where another shape was refused.
  showShape();
  view.setCount(panes.length);
  legend();
}

/// What colours show: the field of the server, or the difference of two panes.
const shown = () => (get("difference").checked && settings?.panes.length === 2 ? "difference" : settings?.field);

/// The fixed scale of a field.
function largestOf(field) {
  const modulus = scenery.youngs_modulus;
  const extent = view.extent ?? 0.1;
  return {
    stress: roundUp(0.2 * modulus), strain: 0.2, displacement: roundUp(0.1 * extent), energy_density: roundUp(0.02 * modulus),
    saturated: 1, pressure: roundUp(0.3 * modulus), step_limit: largestRate, difference: roundUp(0.02 * extent),
  }[field];
}

function legend() {
  const field = shown();
  if (!field || !scenery) return;
  const { title, unit, factor } = FIELDS[field];
  get("legend-title").textContent = title;
  const largest = largestOf(field) * factor;
  const wordsAt = (share) => {
    if (field === "step_limit") return share > 0 ? `${short(1000 / (share * largest))} ${unit}` : "longer";
    return `${short(share * largest)} ${unit}`;
  };
  const ticks = field === "saturated" ? [[1, "at limit"], [0, "free"]] : [0, 0.25, 0.5, 0.75, 1].map((share) => [share, wordsAt(share)]);
  get("legend-ticks").replaceChildren(...ticks.map(([share, words]) => {
    const tick = document.createElement("span");
    tick.textContent = words;
    tick.style.top = `${100 * (1 - share)}%`;
    return tick;
  }));
  const mark = document.createElement("i");
  mark.classList.toggle("unknown", field === "difference");
  get("legend-note").replaceChildren(mark, field === "difference" ? "cut in one alone" : "inside out");
}

const pointOf = (pane, point) => pane && new Vector3(pane.positions[3 * point], pane.positions[3 * point + 1], pane.positions[3 * point + 2]);

function colourValues(number) {
  const { panes } = picture;
  if (shown() !== "difference" || panes.length < 2) return panes[number].colours;
  const [own, other] = [panes[number].positions, panes[1 - number].positions];
  const away = (k, twin) => Math.hypot(own[3 * k] - other[3 * twin], own[3 * k + 1] - other[3 * twin + 1], own[3 * k + 2] - other[3 * twin + 2]);
  return Float32Array.from(picture.topology.surfaces[number].twins, (twin, k) => (twin === NO_TWIN ? NOT_KNOWN : away(k, twin)));
}

function show() {
  if (view.topology !== picture.topology) {
    view.setTopology(picture.topology, scenery.tools);
    if (hand.pull) hand.pull.stiffness = scenery.youngs_modulus * view.extent * 0.1;
    cutPanel.resize();
    showShape();
    legend();
  }
  if (picture.field === "step_limit") {
    const now = Math.max(...picture.panes.map((pane) => pane.colours.reduce((most, value) => (value > most ? value : most), 0))) || 1;
    if (now !== largestRate) {
      largestRate = now;
      legend();
    }
  }
  const largest = largestOf(shown());
  picture.panes.forEach((pane, number) => {
    view.update(number, pane, colourValues(number), largest);
    const tool = pane.tools[hand.selected];
    let force = tool ? Math.hypot(...tool.force) : 0;
    let moved = 0;
    if (scenery.hand) {
      const { point } = scenery.hand;
      const at = pointOf(pane, point);
      moved = at.distanceTo(new Vector3().fromArray(view.topology.surfaces[number].points, 3 * point));
      force = hand.pull.force.length();
      const pulls = force > 0 && number < 2;
      view.showPull(number, point, pulls ? at.clone().addScaledVector(hand.pull.force, 1 / hand.pull.stiffness) : null);
    }
    histories[number].take(pane, force, tool ? tool.depth : moved, moved);
  });
  hand.see(picture.panes[0].tools);
}

function panels() {
  const first = picture.panes[0];
  picture.panes.forEach((pane, number) => cards[number]?.show(pane));
  cutPanel.show(picture.panes);
  const live = histories.slice(0, picture.panes.length);
  const end = Math.max(SPAN, first.t);
  const x = [end - SPAN, end];
  const named = (number, name) => (live.length > 1 ? settings.panes[number]?.integrator : name);
  const way = scenery.hand ? "moved" : "force";
  const factor = scenery.hand ? 1000 : 1;
  const lines = live.map((history, number) => ({ name: named(number, ""), colour: LINES[number], xs: history.t, ys: history[way].map((value) => factor * value) }));
  const calmest = Math.min(...lines.map(({ ys }) => Math.max(0, ...ys.filter(Number.isFinite))));
  const cut = (ends) => (live.length > 1 && calmest > 0 ? [Math.max(ends[0], -4 * calmest), Math.min(ends[1], 4 * calmest)] : ends);
  plots["force-time"].draw({ x, y: cut(around(lines.flatMap(({ ys }) => ys))), lines, xUnit: "s", yUnit: scenery.hand ? "mm" : "N" });
  drawDepth(live, named);
  const energies = live.flatMap((history, number) => {
    const own = [{ name: live.length > 1 ? named(number) : "E − W", colour: LINES[number], xs: history.t, ys: history.balance }];
    if (live.length === 1) {
      own.unshift({ name: "kinetic", colour: "--thin", dash: [2, 3], width: 1.4, xs: history.t, ys: history.kinetic });
      own.unshift({ name: "elastic", colour: "--second", width: 1.4, xs: history.t, ys: history.elastic });
    }
    return own;
  });
  const widest = Math.min(...live.map((_, number) => Math.max(1e-12, ...energies.filter((line) => live.length === 1 || line.colour === LINES[number]).flatMap(({ ys }) => ys).filter(Number.isFinite).map(Math.abs))));
  const ends = around(energies.flatMap(({ ys }) => ys), 1e-12);
  const clipped = live.length > 1 ? [Math.max(ends[0], -4 * widest), Math.min(ends[1], 4 * widest)] : ends;
  const milli = Math.max(...clipped.map(Math.abs)) < 0.1 ? 1000 : 1;
  for (const line of energies) line.ys = line.ys.map((value) => milli * value);
  plots.energy.draw({ x, y: clipped.map((value) => milli * value), lines: energies, xUnit: "s", yUnit: milli === 1 ? "J" : "mJ" });
  const red = picture.panes.map((pane, number) => (colourOfLight(pane, 0) === 3 && numberOfReason(pane, 0) === 3 ? number : -1)).filter((number) => number >= 0);
  const balance = get("balance");
  balance.classList.toggle("bad", red.length > 0);
  balance.textContent = red.length > 0
    ? `E − W is above 0${live.length > 1 ? ` in ${red.map((number) => settings.panes[number]?.integrator).join(" and ")}` : ""}: energy from nowhere.`
    : "E − W, energy less the work of loads and tools: what damping takes makes it fall. It must not rise above 0.";
  get("energy-now").textContent = `E ${withUnit(first.kinetic + first.elastic, "J")} · W ${withUnit(first.loadWork + first.toolWork, "J")}`;
  if (shapeRow.number !== hand.selected) showShape();
  const tool = first.tools[hand.selected];
  if (tool) get("force-now").textContent = `${withUnit(Math.hypot(...tool.force), "N")} · ${plain(1000 * Math.max(0, tool.depth), 3)} mm deep`;
  else if (scenery.hand) get("force-now").textContent = `${withUnit(hand.pull.force.length(), "N")} · ${plain(1000 * (histories[0].moved.at(-1) ?? 0), 3)} mm`;
  get("pace").textContent = settings.paused ? "paused" : `${plain(picture.pace, 2)} ×`;
  get("pace").title = `${picture.panes.map((pane) => plain(pane.msPerStep, 3)).join(" and ")} ms a step`;
  const latency = connection.latency(0.5);
  get("latency").textContent = Number.isNaN(latency) ? "–" : `${plain(latency, 2)} ms`;
  const ms = picture.panes.map((pane) => `${plain(pane.msPerStep, 2)} ms a step`).join(" · ");
  get("footer").textContent = `sinew ${scenery.version} · ${first.nodes} nodes, ${first.tets} tetrahedra · ${ms} · t = ${first.t.toFixed(2)} s · seen by this computer alone`;
}

function drawDepth(live, named) {
  const force = (history) => history.force;
  const depth = (history) => history.depth.map((value) => 1000 * value);
  const lines = live.map((history, number) => ({ name: named(number, ""), colour: LINES[number], xs: depth(history), ys: force(history) }));
  const deepest = Math.max(1, ...lines.flatMap(({ xs }) => xs.filter(Number.isFinite)));
  const part = scenery.tools[hand.selected]?.parts;
  if (scenery.hertz && part?.length === 1 && part[0].kind === "sphere") {
    const { youngs_modulus: modulus, poissons_ratio: ratio } = scenery.hertz;
    const xs = Array.from({ length: 60 }, (_, k) => (deepest * k) / 59);
    const ys = xs.map((mm) => ((4 / 3) * modulus * Math.sqrt(part[0].sizes[0]) * (mm / 1000) ** 1.5) / (1 - ratio * ratio));
    lines.push({ name: "Hertz, half-space", colour: "--thin", width: 1, dash: [4, 3], xs, ys });
  }
  const strongest = Math.max(0, ...live.flatMap((history) => history.force.filter(Number.isFinite)));
  const least = Math.min(0, ...lines.slice(0, live.length).flatMap(({ xs }) => xs.filter(Number.isFinite)));
  plots["force-depth"].draw({ x: [Math.max(least, -0.2 * deepest), 1.02 * deepest], y: around([strongest], 1e-3), lines, xUnit: "mm", yUnit: "N" });
}

function frame(now) {
  window.requestAnimationFrame(frame);
  const next = scenery && settings ? connection.latest() : null;
  if (next && next.panes.length === settings.panes.length) {
    picture = next;
    pictures += 1;
    show();
    blade.flush(picture.applied);
  }
  view.draw();
  screen.drew(now);
  if (next) connection.drawn(next, screen.next);
  else if (connection.owed > 0 && !connection.picture) connection.grant(screen.next);
  if (picture && now - plotted > PLOT_EVERY) {
    plotted = now;
    panels();
  }
  if (now - since.at > 1000) {
    last.rate = ((pictures - since.pictures) * 1000) / (now - since.at);
    get("rate").textContent = `${plain(last.rate, 2)} /s`;
    since = { at: now, pictures };
  }
  if (connected && now > notice) get("message").hidden = true;
}

get("pause").addEventListener("click", () => settings && connection.command("pause", { on: !settings.paused }));
get("step").addEventListener("click", () => connection.command("step"));
get("reset").addEventListener("click", () => connection.command("reset"));
get("save").addEventListener("click", () => connection.command("save"));
get("panes").addEventListener("click", () => settings && connection.command("panes", { count: settings.panes.length === 1 ? 2 : 1 }));
get("view").addEventListener("click", () => view.topology && view.resetCamera());
get("field").addEventListener("change", () => connection.command("field", { name: get("field").value }));
get("edges").addEventListener("change", () => view.setEdges(get("edges").checked));
get("difference").addEventListener("change", () => {
  legend();
  // While time stops no other picture comes.
  if (picture) show();
});
window.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT"].includes(event.target.tagName)) return;
  const press = { " ": "pause", ".": "step", r: "reset", v: "view", c: "cut" }[event.key];
  if (!press || get(press).hidden || get(press).closest("[hidden]") || (event.key === " " && event.target.closest("button, summary"))) return;
  event.preventDefault();
  // A key that is held down presses once, but goes on step by step.
  if (!event.repeat || press === "step") get(press).click();
});
paintBar(get("legend-bar"));
window.requestAnimationFrame(frame);

// What the end-to-end test asks.
window.sinew = {
  get ready() { return pictures >= 5; },
  get pictures() { return pictures; },
  get picture() { return picture; },
  get settings() { return settings; },
  get scenery() { return scenery; },
  get integrators() { return integrators; },
  get last() { return last; },
  get connected() { return connected; },
  get latencies() { return connection.latencies; },
  clearLatencies() { connection.latencies.length = 0; },
  /// In the last pane: the first may show a method that throws its body off the page.
  gripOnPage() {
    const number = picture.panes.length - 1;
    const pane = picture.panes[number];
    const tool = pane.tools[hand.selected];
    return view.project(tool ? new Vector3(...tool.position) : pointOf(pane, scenery.hand?.point ?? 0), number);
  },
  get led() { return hand.tools.map((tool) => hand.target(tool).toArray()); },
  lights(pane = 0) { return [0, 1, 2].map((light) => [colourOfLight(picture.panes[pane], light), reasonOf(light, numberOfReason(picture.panes[pane], light), picture.panes[pane])]); },
  /// Where a place (m) is on the page.
  onPage: (place, pane = 0) => view.project(new Vector3(...place), pane),
  /// Points of the surface that a pane draws.
  pointsDrawn: (pane = 0) => view.panes[pane].positions.count,
  /// Edges of its cuts.
  rim: (pane = 0) => view.panes[pane].rim.geometry.index.count / 2,
  balance: (pane = 0) => histories[pane].balance.at(-1),
  command: (what, order) => connection.command(what, order),
  colourCount() {
    const gl = view.renderer.getContext();
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return new Set(new Uint32Array(pixels.buffer)).size;
  },
};
