// What stands around the body: a bar of known length, the directions of the axes, the simulated clock.

import { roundUp } from "./colours.js";

const get = (id) => document.getElementById(id);

/// The longest bar (CSS pixels).
const LONGEST = 130;

/// Radius of the axes, and of their names.
const [ARM, NAME] = [19, 26];

const UNITS = [[1, "m"], [0.01, "cm"], [0.001, "mm"], [1e-6, "µm"]];

/// A length of the kind 1, 2, 5 in words: 0.02 m is "2 cm".
function lengthInWords(metres) {
  const [size, unit] = UNITS.find(([size]) => metres >= 0.999 * size) ?? UNITS.at(-1);
  return `${Number((metres / size).toPrecision(2))} ${unit}`;
}

export class Stage {
  constructor(camera) {
    this.camera = camera;
    this.version = -1;
    this.axes = ["x", "y", "z"].map((name) => {
      const [line, text] = ["line", "text"].map((tag) => document.createElementNS(get("triad").namespaceURI, tag));
      text.textContent = name;
      for (const part of [line, text]) part.setAttribute("class", `axis-${name}`);
      get("triad").append(line, text);
      return { line, text };
    });
  }

  /// Follows the camera.
  follow() {
    const { camera } = this;
    const height = camera.canvas.clientHeight;
    if (!camera.target || (this.version === camera.version && this.height === height)) return;
    Object.assign(this, { version: camera.version, height });
    const scale = camera.metresPerPixel(camera.target);
    // The next round length below the longest.
    let length = roundUp(LONGEST * scale);
    while (length > LONGEST * scale) length = roundUp(0.39 * length);
    get("bar-line").style.width = `${length / scale}px`;
    get("bar-words").textContent = lengthInWords(length);
    get("bar").setAttribute("aria-label", `Scale: the bar is ${lengthInWords(length)} long in the middle of the picture`);
    const { elements } = camera.lens.matrixWorldInverse.copy(camera.lens.matrixWorld).invert();
    this.axes.forEach(({ line, text }, axis) => {
      const [x, y] = [elements[4 * axis], -elements[4 * axis + 1]];
      line.setAttribute("x2", ARM * x);
      line.setAttribute("y2", ARM * y);
      text.setAttribute("x", NAME * x);
      text.setAttribute("y", NAME * y);
      // Those that point away are behind.
      for (const part of [line, text]) part.style.opacity = elements[4 * axis + 2] < -0.2 ? 0.7 : 1;
    });
  }

  /// Shows the simulated time (s).
  showTime(t, isPaused) {
    const words = `${t.toFixed(2)} s${isPaused ? " · paused" : ""}`;
    if (get("clock").textContent !== words) get("clock").textContent = words;
  }
}
