// The blade's controls, its way on the page, and what was cut.

import { element } from "./element.js";
import { plain, withUnit } from "./numbers.js";

const get = (id) => document.getElementById(id);

/// The longest blade, in terms of the body's size.
const LONGEST = 1.2;

/// Steps of the arrow keys over the height of the view, and with Shift.
const [STEP, FINE] = [0.02, 0.005];

/// What is told of the cuts of a pane.
const FACTS = [
  ["Area", ({ cutArea }) => (Number.isNaN(cutArea) ? "–" : `${plain(1e6 * cutArea, 3)} mm²`)],
  ["New nodes", ({ newNodes }) => String(newNodes)],
  ["Pieces", ({ pieces }) => String(pieces)],
  ["Energy at the cut", ({ cutEnergy }) => withUnit(cutEnergy, "J")],
  ["Blade's work", ({ bladeWork }) => withUnit(bladeWork, "J")],
  ["Taken away", ({ removed }) => `${removed} tets`],
];

export class CutPanel {
  constructor(view) {
    this.view = view;
    this.values = FACTS.map(([name]) => {
      const value = element("dd", {}, "–");
      get("cuts").append(element("div", {}, element("dt", {}, name), value));
      return value;
    });
  }

  begin(blade, changed) {
    this.blade = blade;
    this.changed = changed;
    get("cut").addEventListener("click", () => this.take(!blade.isOn));
    get("depth").addEventListener("input", () => this.resize());
  }

  /// Offers a blade where the body may be cut.
  offer(on) {
    get("blade").hidden = !on;
    get("cuts-card").hidden = !on;
    if (!on) this.take(false);
  }

  /// Takes the blade into the hand, or puts it away.
  take(on) {
    const { blade } = this;
    blade.end();
    blade.isOn = on;
    get("cut").setAttribute("aria-pressed", String(on));
    get("depth").disabled = !on;
    get("views").classList.toggle("cutting", on);
    this.cursor = null;
    this.showPath([]);
    this.resize();
    this.changed();
  }

  /// The depth of the slider, which depends on the size of the body.
  resize() {
    if (!this.view.extent) return;
    this.blade.depth = (LONGEST * this.view.extent * get("depth").value) / get("depth").max;
    get("depth-now").textContent = `${plain(1000 * this.blade.depth, 2)} mm`;
    get("depth").setAttribute("aria-valuetext", get("depth-now").textContent);
  }

  /// Keys that move, lower and lift the blade; whether this is one.
  key({ key, shiftKey }) {
    const box = get("canvas").getBoundingClientRect();
    const { blade } = this;
    const step = (shiftKey ? FINE : STEP) * box.height;
    const way = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[key];
    this.cursor ??= this.view.camera.project(this.view.centre);
    if (way) {
      this.cursor = [
        Math.min(box.right - 1, Math.max(box.left, this.cursor[0] + way[0])),
        Math.min(box.bottom - 1, Math.max(box.top, this.cursor[1] + way[1])),
      ];
      if (blade.isDown) blade.to(...this.cursor);
      else this.showPath([this.cursor]);
    } else if (key === "Enter") {
      if (blade.isDown) {
        blade.end();
        this.showPath([this.cursor]);
      } else {
        blade.begin(...this.cursor);
      }
    } else if (key === "Escape") {
      this.take(false);
    } else {
      return false;
    }
    return true;
  }

  /// Draws the way of the blade in all panes, which are seen by one camera.
  showPath(path) {
    const { left, top, width } = get("canvas").getBoundingClientRect();
    const each = width / this.view.count;
    const first = path.length > 0 ? Math.floor((path[0][0] - left) / each) : 0;
    const lines = [];
    for (let pane = 0; pane < (path.length > 0 ? this.view.count : 0); pane += 1) {
      const points = path.map(([x, y]) => `${(x - left + (pane - first) * each).toFixed(1)},${(y - top).toFixed(1)}`);
      // A single place is a dot.
      if (points.length === 1) points.push(points[0]);
      for (const name of ["under", "over"]) {
        const line = document.createElementNS(get("strokes").namespaceURI, "polyline");
        line.setAttribute("class", name);
        line.setAttribute("points", points.join(" "));
        lines.push(line);
      }
    }
    get("strokes").replaceChildren(...lines);
  }

  /// What was cut in each pane.
  show(panes) {
    if (get("cuts-card").hidden) return;
    FACTS.forEach(([, words], index) => {
      const all = panes.map(words);
      const value = this.values[index];
      value.textContent = [...new Set(all)].join(" · ");
      value.classList.toggle("unknown", all.every((one) => one === "–"));
    });
    const [a, b] = panes;
    const differs = b && (a.newNodes !== b.newNodes || a.pieces !== b.pieces);
    get("cuts-note").textContent = differs ? "The same blade met two bodies that lie differently: they are cut differently." : "";
    get("cuts-note").hidden = !differs;
  }
}
