// The page of sinew live.

import { Vector3 } from "three";
import { Beginning } from "./begin.js";
import { Blade } from "./blade.js";
import { FIELDS, NOT_KNOWN, roundUp } from "./colours.js";
import { SIDES } from "./camera.js";
import { Connection } from "./connection.js";
import { CutPanel } from "./cuts.js";
import { element } from "./element.js";
import { DepthHandle } from "./depth.js";
import { NO_TWIN } from "./frames.js";
import { Capture } from "./capture.js";
import { Hand } from "./hand.js";
import { showHint } from "./hints.js";
import { History, SPAN } from "./history.js";
import { showLegend } from "./legend.js";
import { colourOfLight, numberOfReason, reasonOf } from "./lights.js";
import { startMenus } from "./menus.js";
import { plain, withUnit } from "./numbers.js";
import { PaneCard, stepInWords } from "./panes.js";
import { Past } from "./past.js";
import { Plot, around } from "./plots.js";
import { Range } from "./range.js";
import { Screen } from "./screen.js";
import { SectionPanel } from "./section-panel.js";
import { ShapeRow } from "./shape.js";
import { Stage } from "./stage.js";
import { ToolMenu } from "./tool-menu.js";
import { View } from "./view.js";

const get = (id) => document.getElementById(id);
const test = new URLSearchParams(window.location.search).has("test");
const LINES = ["--first", "--second"];
const PLOT_EVERY = 70;

/// Buttons of the sides by their keys.
const SIDE_KEYS = Object.fromEntries(Object.keys(SIDES).map((side, index) => [String(index + 1), `side-${side}`]));

let notice = 0;

/// Shows a sentence for a time (ms); more about it unfolds.
function say(text, time = 6000, more = "") {
  const message = get("message");
  message.replaceChildren(text);
  if (more) message.append(element("details", {}, element("summary", {}, "In detail"), more));
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
const stage = new Stage(view.camera);
const section = new SectionPanel(view, (axis, at) => connection.command("section", { axis, at }));
const range = new Range({ changed: recolour, extremes });
const histories = [new History(), new History()];
const cards = [];
const plots = Object.fromEntries(["force-time", "force-depth", "energy"].map((id) => [id, new Plot(get(id))]));
let scenery = null;
let settings = null;
let integrators = [];
/// The picture that is shown, and the newest one, which differ while the page shows the past.
let picture = null;
let present = null;
let pictures = 0;
/// The largest 1/step (1/s) of an element at the surface.
let largestRate = 1;
let plotted = 0;
let since = { at: performance.now(), pictures: 0 };
let connected = true;
const last = { saved: null, refused: [], stopped: [], wentBack: [], rate: 0 };

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
    adding = null;
    say(reason);
  },
  stopped: (event) => {
    keep(last.stopped, event);
    view.mark(event.place);
  },
  went_back: (event) => {
    keep(last.wentBack, event);
    past.wentBackTo(event.to);
    hand.release();
    blade.drop();
    view.mark(event.place);
    const where = event.place ? "the tissue at the mark was deformed" : "the tissue was moved";
    say(`Back by ${plain(event.by, 2)} s, to where all was well: ${where} beyond what a step can follow. Move more slowly, or take a shorter step.`, 12000, event.reason);
  },
  reset: () => {
    histories.forEach((history) => history.clear());
    past.clear();
    hand.release();
    blade.drop();
  },
  went_on_from: ({ t, back }) => {
    past.wentBackTo(t);
    histories.forEach((history) => history.clear());
    hand.release();
    blade.drop();
    say(`Paused at t = ${plain(t, 3)} s: from here another motion goes on. The log says that ${plain(back, 3)} s were taken back.`, 10000);
  },
  other_method: ({ pane, integrator, reason }) => {
    const before = settings?.panes[pane]?.integrator ?? "The method";
    say(`${before} feels no tools: ${integrator} runs in its place. The list of methods names others.`, 12000, reason);
  },
  scenes: () => {
    beginning.isLeaving = true;
    say("Back to the scenes …", Infinity);
  },
  trusted_ended: ({ reason }) => say(reason),
  saved: (event) => {
    last.saved = event;
    say(`Saved in ${event.folder}. Repeat it with: ${event.replay}`, 15000);
  },
  closed: () => {
    connected = false;
    // What is left is the camera and the picture.
    for (const control of document.querySelectorAll(".transport button, #panes, #grasp, #turn, .tools button, #cut, .past-bar button, .past-bar input, .side button, .side input, .side select")) control.disabled = true;
    if (beginning.isLeaving) {
      beginning.go();
      return;
    }
    if (!scenery) {
      get("title").textContent = "Not connected";
      // A refusal has been said.
      if (last.refused.length === 0) say("No connection to the simulation. Reload the page where `sinew live` still runs; its address changes with each start.", Infinity);
      return;
    }
    say("The simulation has ended, or this page was closed from there. Reload it where `sinew live` still runs.", Infinity);
  },
});

const beginning = new Beginning(() => connection.command("scenes"));
const showBeginning = () => settings && beginning.show(settings.paused, picture?.panes[0].t ?? 0);
const screen = new Screen();
const paneAt = (x) => Math.min(view.count - 1, Math.floor((x - canvas.getBoundingClientRect().left) / (canvas.clientWidth / view.count)));
const cutPanel = new CutPanel(view);
const blade = new Blade(view, {
  paneAt,
  cut: (from, to) => connection.command("cut", { from, to }),
  path: (path) => cutPanel.showPath(path),
});
const hint = () => {
  const held = hand.tool ? "tool" : "rest";
  if (scenery) showHint(scenery, blade.isOn ? "blade" : held);
};
cutPanel.begin(blade, hint);

const past = new Past({
  pause: () => settings && !settings.paused && connection.command("pause", { on: true }),
  goOn: (t) => connection.command("go_on_from", { t }),
  left: () => {
    if (!present) return;
    picture = present;
    show(false);
  },
});

const hand = new Hand(canvas, view, {
  blade,
  isPast: () => past.isOn,
  bladeKey: (event) => cutPanel.key(event),
  paneAt,
  lead: (tool, position, rotation) => connection.command("pose", { tool, position: position.toArray(), rotation }),
  middle: () => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    return [left + width / (2 * view.count), top + height / 2];
  },
  grip: (pane, point) => connection.command("grip", { pane, point, epoch: view.topology.epoch }),
  pull: (to) => connection.command("pull", { to: to.toArray() }),
  letGo: () => connection.command("let_go"),
  take,
});

/// Time (ms) for which scissors are seen closed.
const SNIP = 260;
let snippedAt = -Infinity;

/// Takes a tool into the hand, or none (-1).
function take(number) {
  hand.take(number);
  const tool = scenery.tools[hand.selected];
  toolMenu.show(scenery.tools, hand.selected);
  get("turn").hidden = !tool;
  get("turn").setAttribute("aria-pressed", "false");
  get("grasp").hidden = !tool || ["blade", "burner"].includes(tool.added);
  get("grasp").textContent = tool?.added === "scissors" ? "Snip" : "Grasp";
  get("grasp").title = tool?.added === "scissors" ? "The blades close, and cut what is between them (G)" : "The tool holds what it touches (G)";
  get("force-title").textContent = tool ? "Force of the tool" : "Force of your pull";
  hint();
  showShape();
}

/// Closes the tool in the hand: jaws until they let go, scissors for a moment.
function grasp() {
  const number = hand.selected;
  if (scenery.tools[number]?.added !== "scissors") {
    connection.command("grasp", { tool: number, on: !settings.grasped[number] });
    return;
  }
  snippedAt = performance.now();
  connection.command("snip", { tool: number });
}

function showClosed(now) {
  scenery.tools.forEach(({ added }, number) => {
    const isSnipping = added === "scissors" && number === hand.selected && now - snippedAt < SNIP;
    view.closeTool(number, isSnipping || settings.grasped[number] ? 1 : 0);
  });
}

/// Kind of the tool that this page asked for, which its hand takes when it is there.
let adding = null;
const toolMenu = new ToolMenu({
  take,
  add: (kind) => {
    adding = kind;
    connection.command("add_tool", { kind });
  },
  remove: (tool) => connection.command("remove_tool", { tool }),
});

const depthHandle = new DepthHandle(view, hand);
const shapeRow = new ShapeRow(get("shape"), (tool, shape) => connection.command("shape", { tool, shape }));
const showShape = () => shapeRow.show(hand.selected, scenery.tools[hand.selected], view.extent);

function begin(event) {
  const before = scenery;
  scenery = event;
  document.title = `${event.title} · sinew live`;
  get("title").textContent = event.title;
  const fields = [...event.fields.map((name) => [FIELDS[name].title, name]), [FIELDS.difference.title, "difference"]];
  const colours = get("field").value;
  get("field").replaceChildren(...[["Tissue", "tissue"], ...fields].map(([title, name]) => new Option(title, name)));
  if (before && (colours === "difference" || event.fields.includes(colours))) get("field").value = colours;
  get("footer").textContent = `sinew ${event.version} · ${event.nodes} nodes · ${event.tets} tetrahedra · this computer only`;
  beginning.offer(event.from_start);
  cutPanel.offer(event.cuts);
  const { tools } = event;
  const isAdded = adding !== null && tools.at(-1)?.added === adding;
  const held = hand.selected;
  hand.begin(tools, -1);
  if (before) {
    view.setTools(tools);
    past.clear();
  }
  // The one that was added here, that of before where the tools are the same, or else the first.
  const isSame = before?.tools.length === tools.length;
  const first = Math.min(0, tools.length - 1);
  if (isAdded) take(tools.length - 1);
  else take(isSame ? held : first);
  if (isAdded) {
    say(`Begun anew with ${tools.at(-1).name}: drag it.`);
    adding = null;
  }
  get("loads-card").hidden = event.loads.length === 0;
  get("loads").replaceChildren(...event.loads.map(sliderOf));
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
  if (picture && picture.panes.length !== panes.length) past.clear();
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
    stopped.textContent = facts.stopped ? `Stopped: no next step is possible from here. Reset, look back and go on from before, or choose another method or a shorter step. In detail: ${facts.stopped}.` : "";
    caption.append(name, step, stopped);
    return caption;
  }));
  get("pause").setAttribute("aria-pressed", String(event.paused));
  get("pause").textContent = event.paused ? "Go on" : "Pause";
  showBeginning();
  get("panes").textContent = panes.length === 1 ? "Compare" : "One alone";
  const choice = get("field");
  choice.querySelector("option[value=difference]").disabled = panes.length === 1;
  // A field that another page chose; tissue and differences are this page's own.
  if (choice.value === "difference" ? panes.length === 1 : choice.value !== "tissue") choice.value = event.field;
  scenery.loads.forEach(({ name }, index) => {
    const slider = get("loads").querySelector(`input[data-load="${CSS.escape(name)}"]`);
    if (!slider) return;
    if (document.activeElement !== slider) slider.value = event.factors[index];
    slider.parentElement.querySelector("output").textContent = `× ${plain(event.factors[index], 3)}`;
  });
  // Also where another shape was refused.
  showShape();
  view.setCount(panes.length);
  legend();
}

/// What colours show: the field of the server, the difference of two panes, or nothing, for tissue.
function shown() {
  const choice = get("field").value;
  if (choice === "tissue" || (choice === "difference" && settings?.panes.length === 2)) return choice === "tissue" ? null : choice;
  return settings?.field ?? null;
}

/// The round largest value of a field, from the scene alone: its automatic scale is fixed.
function largestOf(field) {
  const modulus = scenery.youngs_modulus;
  const extent = view.extent ?? 0.1;
  return {
    stress: roundUp(0.2 * modulus), strain: 0.2, displacement: roundUp(0.1 * extent), energy_density: roundUp(0.02 * modulus),
    saturated: 1, pressure: roundUp(0.3 * modulus), step_limit: largestRate, difference: roundUp(0.02 * extent),
  }[field];
}

/// The scale of what is shown; none for tissue.
const scaleNow = () => (shown() ? range.scaleOf(shown(), largestOf(shown())) : null);

function legend() {
  if (!scenery) return;
  const [field, scale] = [shown(), scaleNow()];
  showLegend(field, scale, field && largestOf(field));
  range.show(field, scale, field && largestOf(field));
}

/// Shows the picture in other colours: while time stops no other one comes.
function recolour() {
  legend();
  if (picture) show(false);
}

/// The least and the largest value that is shown.
function extremes() {
  let [low, high] = [Infinity, -Infinity];
  for (let number = 0; picture && number < picture.panes.length; number += 1) {
    for (const value of colourValues(number)) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  return { low, high };
}


function colourValues(number) {
  const { panes } = picture;
  if (shown() !== "difference" || panes.length < 2) return panes[number].colours;
  const [own, other] = [panes[number].positions, panes[1 - number].positions];
  const away = (k, twin) => Math.hypot(own[3 * k] - other[3 * twin], own[3 * k + 1] - other[3 * twin + 1], own[3 * k + 2] - other[3 * twin + 2]);
  return Float32Array.from(picture.topology.surfaces[number].twins, (twin, k) => (twin === NO_TWIN ? NOT_KNOWN : away(k, twin)));
}

/// Shows the picture; one of the past, or one that was shown before, changes nothing but the view.
function show(isNew = true) {
  if (view.topology !== picture.topology) {
    view.setTopology(picture.topology, scenery.tools);
    get("fine").checked = view.isFine;
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
  const scale = scaleNow();
  picture.panes.forEach((pane, number) => {
    view.update(number, pane, colourValues(number), scale);
    const tool = pane.tools[hand.selected];
    const [pull, moved] = hand.pull.show(number, pane);
    if (isNew) histories[number].take(pane, tool ? Math.hypot(...tool.force) : pull, tool ? tool.depth : moved);
  });
  if (isNew) hand.see(picture.panes[0].tools);
  depthHandle.show(blade.isOn);
}

function panels() {
  const first = picture.panes[0];
  stage.showTime(first.t, settings.paused);
  picture.panes.forEach((pane, number) => cards[number]?.show(pane));
  cutPanel.show(picture.panes);
  const live = histories.slice(0, picture.panes.length);
  const end = Math.max(SPAN, first.t);
  const x = [end - SPAN, end];
  const named = (number, name) => (live.length > 1 ? settings.panes[number]?.integrator : name);
  const lines = live.map((history, number) => ({ name: named(number, ""), colour: LINES[number], xs: history.t, ys: history.force }));
  const calmest = Math.min(...lines.map(({ ys }) => Math.max(0, ...ys.filter(Number.isFinite))));
  const cut = (ends) => (live.length > 1 && calmest > 0 ? [Math.max(ends[0], -4 * calmest), Math.min(ends[1], 4 * calmest)] : ends);
  plots["force-time"].draw({ x, y: cut(around(lines.flatMap(({ ys }) => ys))), lines, xUnit: "s", yUnit: "N" });
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
  get("grasp").setAttribute("aria-pressed", String(settings.grasped[hand.selected] ?? false));
  const tool = first.tools[hand.selected];
  if (tool) get("force-now").textContent = `${withUnit(Math.hypot(...tool.force), "N")} · ${plain(1000 * Math.max(0, tool.depth), 3)} mm deep`;
  else get("force-now").textContent = `${withUnit(histories[0].force.at(-1) ?? 0, "N")} · ${plain(1000 * (histories[0].depth.at(-1) ?? 0), 3)} mm moved`;
  get("pace").textContent = settings.paused ? "paused" : `${plain(picture.pace, 2)} ×`;
  get("pace-note").textContent = paceInWords();
  get("pace").title = `${picture.panes.map((pane) => plain(pane.msPerStep, 3)).join(" and ")} ms a step`;
  const latency = connection.latency(0.5);
  get("latency").textContent = Number.isNaN(latency) ? "–" : `${plain(latency, 2)} ms`;
  const ms = picture.panes.map((pane) => `${plain(pane.msPerStep, 2)} ms a step`).join(" · ");
  get("footer").textContent = `sinew ${scenery.version} · ${first.nodes} nodes, ${first.tets} tetrahedra · ${ms} · t = ${first.t.toFixed(2)} s · seen by this computer alone`;
}

/// Pace and error in a sentence: one is worth nothing without the other.
function paceInWords() {
  const errors = picture.panes.map(({ error }, pane) => (Number.isFinite(error) ? `${plain(100 * error, 2)} %${picture.panes.length > 1 ? ` (${settings.panes[pane]?.integrator})` : ""}` : null));
  const known = errors.filter((error) => error !== null);
  const error = known.length > 0 ? `error ${known.join(", ")} of the largest displacement, beside a trusted run` : "error not measured: Measure the error begins a trusted run";
  if (settings.paused) return `Paused; ${error}.`;
  return picture.pace < 0.95 ? `Slower than real time, in slow motion; ${error}.` : `In real time; ${error}.`;
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
    present = next;
    pictures += 1;
    past.take(next);
    if (!past.isOn) {
      picture = next;
      showBeginning();
      show();
    }
    blade.flush(next.applied);
  }
  const old = past.next(now);
  if (old) {
    picture = old;
    show(false);
  }
  if (scenery && settings) showClosed(now);
  if (view.draw()) {
    stage.follow();
    capture.follow();
  }
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
  const isRead = get("message").querySelector("details")?.open;
  if (connected && now > notice && !get("message").hidden && !isRead) {
    get("message").hidden = true;
    if (!settings?.panes.some(({ stopped }) => stopped)) view.mark(null);
  }
}

get("pause").addEventListener("click", () => {
  if (!settings) return;
  past.leave();
  connection.command("pause", { on: !settings.paused });
});
get("step").addEventListener("click", () => {
  past.leave();
  connection.command("step");
});
get("reset").addEventListener("click", () => connection.command("reset"));
get("save").addEventListener("click", () => connection.command("save"));
get("panes").addEventListener("click", () => settings && connection.command("panes", { count: settings.panes.length === 1 ? 2 : 1 }));
get("view").addEventListener("click", () => view.topology && view.camera.reset());
for (const side of document.querySelectorAll("[data-side]")) side.addEventListener("click", () => view.topology && view.camera.showSide(side.dataset.side));
get("field").addEventListener("change", () => {
  const name = get("field").value;
  if (scenery.fields.includes(name)) connection.command("field", { name });
  recolour();
});
// A scheme that changes brings another ground.
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { view.dirty = true; });
get("fine").addEventListener("change", () => view.setFine(get("fine").checked));
get("grasp").addEventListener("click", grasp);
get("turn").addEventListener("click", () => {
  hand.turns = !hand.turns;
  get("turn").setAttribute("aria-pressed", String(hand.turns));
});
const capture = new Capture(view, () => scenery?.title ?? "");
get("picture").addEventListener("click", async () => capture.save(await capture.picture()));
get("film").disabled = !capture.canFilm;
get("film").addEventListener("click", () => {
  if (capture.films) capture.end();
  else capture.begin((file) => capture.save(file));
  get("film").setAttribute("aria-pressed", String(capture.films));
  get("film").textContent = capture.films ? "End film" : "Film";
});
get("edges").addEventListener("change", () => view.setEdges(get("edges").checked));
window.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT"].includes(event.target.tagName)) return;
  const press = { " ": "pause", ".": "step", r: "reset", v: "view", c: "cut", g: "grasp", t: "turn", ...SIDE_KEYS }[event.key];
  if (!press || get(press).hidden || get(press).closest("[hidden]") || (event.key === " " && event.target.closest("button, summary"))) return;
  event.preventDefault();
  // A key that is held down presses once, but goes on step by step.
  if (!event.repeat || press === "step") get(press).click();
});
startMenus();
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
    const tool = picture.panes[number].tools[hand.selected];
    return view.camera.project(tool ? new Vector3(...tool.position) : new Vector3(view.centre.x, view.centre.y, view.box.high[2]), number);
  },
  get led() { return hand.tools.map((tool) => hand.target(tool).toArray()); },
  lights(pane = 0) { return [0, 1, 2].map((light) => [colourOfLight(picture.panes[pane], light), reasonOf(light, numberOfReason(picture.panes[pane], light), picture.panes[pane])]); },
  /// Where a place (m) is on the page.
  onPage: (place, pane = 0) => view.camera.project(new Vector3(...place), pane),
  /// Points of the surface that a pane draws.
  pointsDrawn: (pane = 0) => view.panes[pane].body.shown.count,
  /// Edges of its cuts.
  rim: (pane = 0) => view.panes[pane].body.rim.geometry.index.count / 2,
  /// Where the camera is, and whereto it looks (m).
  get camera() { return { place: view.camera.lens.position.toArray(), target: view.camera.target.toArray() }; },
  balance: (pane = 0) => histories[pane].balance.at(-1),
  get past() { return { count: past.list.length, bytes: past.bytes, isOn: past.isOn, first: past.list[0]?.panes[0].t, last: past.list.at(-1)?.panes[0].t, shown: picture?.panes[0].t }; },
  /// Triangles of the section with values that a pane draws.
  sectionDrawn: (pane = 0) => (view.panes[pane].cap.field.visible ? view.panes[pane].cap.field.geometry.attributes.position.count / 3 : 0),
  /// Kind and size of a picture, and of a film of a second.
  async captured() {
    const picture = await capture.picture();
    const film = await new Promise((done) => {
      capture.begin(done);
      setTimeout(() => capture.end(), 1000);
    });
    return [picture, film].map(({ type, size }) => [type, size]);
  },
  command: (what, order) => connection.command(what, order),
  colourCount: () => new Set(new Uint32Array(view.pixels().buffer)).size,
  /// Pixels of tissue, which is redder than all else.
  drawnPixels() {
    const pixels = view.pixels();
    let count = 0;
    for (let at = 0; at < pixels.length; at += 4) if (pixels[at + 3] === 255 && pixels[at] > pixels[at + 2] + 40) count += 1;
    return count;
  },
};
