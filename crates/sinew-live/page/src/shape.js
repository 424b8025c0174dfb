// The shape of the tool in the hand: its kind and its size.

import { element } from "./element.js";
import { plain } from "./numbers.js";

const KINDS = { sphere: "Ball", capsule: "Rod", plane: "Plate", box: "Box" };
const STEPS = 200;
// Sizes that are offered, as shares of the body's extent.
const [LEAST, MOST] = [0.01, 1];

/// A shape of a kind about as large as a ball of this radius (m).
function shapeOf(kind, radius, before) {
  const rounded = Number(radius.toPrecision(3));
  return {
    sphere: { sphere: { radius: rounded } },
    capsule: { capsule: { radius: rounded, length: before?.kind === "capsule" ? before.sizes[1] : Number((4 * radius).toPrecision(3)) } },
    plane: { plane: {} },
    box: { box: { size: Array(3).fill(Number((2 * radius).toPrecision(3))) } },
  }[kind];
}

/// The radius (m) of a ball about as large as a part.
function radiusOf({ kind, sizes }, extent) {
  if (kind === "plane") return 0.1 * extent;
  return kind === "box" ? Math.min(...sizes) / 2 : sizes[0];
}

export class ShapeRow {
  constructor(root, send) {
    this.root = root;
    this.send = send;
    this.select = element("select", { "aria-label": "Kind of the tool", onchange: () => this.change() });
    this.select.append(...Object.entries(KINDS).map(([kind, name]) => element("option", { value: kind }, name)));
    this.slider = element("input", { type: "range", min: 0, max: STEPS, "aria-label": "Radius of the tool", onchange: () => this.change(), oninput: () => this.tell() });
    this.readout = element("output");
    root.replaceChildren(this.select, this.slider, this.readout);
  }

  /// The tool in the hand, in a body of this size (m); not while its slider is dragged.
  show(number, tool, extent) {
    if (this.isDragged && number === this.number) return;
    Object.assign(this, { number, extent, part: tool?.parts[0] });
    // The edge of a blade has no radius.
    const isOffered = tool?.parts.length === 1 && !(this.part.kind === "capsule" && this.part.sizes[0] === 0) && extent > 0;
    this.root.hidden = !isOffered;
    if (!isOffered) return;
    this.radius = radiusOf(this.part, extent);
    this.select.value = this.part.kind;
    const share = Math.log(this.radius / (LEAST * extent)) / Math.log(MOST / LEAST);
    this.slider.value = Math.round(STEPS * Math.min(1, Math.max(0, share)));
    this.slider.disabled = this.part.kind === "plane";
    this.words(this.radius);
  }

  words(radius) {
    const kind = this.select.value;
    const name = kind === "box" ? "edge" : "radius";
    this.readout.textContent = kind === "plane" ? "" : `${name} ${plain(1000 * radius * (kind === "box" ? 2 : 1), 3)} mm`;
    this.slider.setAttribute("aria-valuetext", this.readout.textContent);
  }

  tell() {
    this.isDragged = true;
    this.radius = LEAST * this.extent * (MOST / LEAST) ** (this.slider.value / STEPS);
    this.words(this.radius);
  }

  change() {
    this.isDragged = false;
    this.send(this.number, shapeOf(this.select.value, this.radius, this.part));
  }
}
