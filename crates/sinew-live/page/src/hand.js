// Pointer and keys: a tool is led, or tissue is pulled; the view is turned, moved and zoomed.

import { Vector3 } from "three";
import { Pull } from "./pull.js";
import { turned } from "./turning.js";

const CLOSE = 60;

/// Angle (rad) by which a drag of one pixel, and an arrow key, turn a tool.
const [PIXEL, ARROW] = [0.01, 0.1];

/// Time (ms) after the last pointer or key from which on others may lead what this hand led: what was sent comes back within it.
const OWN = 500;

export class Hand {
  constructor(canvas, view, actions) {
    this.view = view;
    this.actions = actions;
    this.tools = [];
    /// The tool in the hand; -1 for the bare hand, which pulls tissue.
    this.selected = -1;
    /// Whether drags and arrow keys turn the tool.
    this.turns = false;
    this.pull = new Pull(view, actions);
    this.pointers = new Map();
    this.lifted = false;
    this.movedAt = -Infinity;
    // Before the first picture nothing is known of places and sizes.
    const whenSeen = (act) => (event) => this.view.extent !== undefined && act(event);
    canvas.addEventListener("pointerdown", whenSeen((event) => this.down(event)));
    // Where the browser tells of a move before its next frame, a hand is that much less late.
    const moved = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
    canvas.addEventListener(moved, (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => this.up(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", whenSeen((event) => this.wheel(event)), { passive: false });
    canvas.addEventListener("keydown", whenSeen((event) => this.key(event)));
    // While it drags: Shift with an arrow key is a fine step, and with Tab the way back.
    window.addEventListener("keydown", (event) => event.key === "Shift" && this.drags && this.lift(true));
    window.addEventListener("keyup", (event) => event.key === "Shift" && this.lift(false));
    window.addEventListener("blur", () => this.lift(false));
  }

  /// Tools as the scenery has them, and which one is in the hand.
  begin(tools, selected) {
    this.tools = tools.map(({ start }) => ({ position: new Vector3(...start.slice(0, 3)), rotation: start.slice(3), led: false }));
    this.take(selected);
  }

  /// Takes a tool into the hand, or none (-1).
  take(number) {
    this.lift(false);
    this.pull.letGo();
    this.selected = number < this.tools.length ? number : -1;
    if (!this.tool) this.turns = false;
  }

  /// The tool in the hand, if there is one.
  get tool() {
    return this.tools[this.selected];
  }

  /// Where tools are led now, as long as this hand does not lead them: another page may, or may have.
  see(tools) {
    if (this.isAway) for (const tool of this.tools) tool.led = false;
    tools.forEach(({ hand: { position, rotation } }, index) => {
      const own = this.tools[index];
      if (own && !own.led) {
        own.position.set(...position);
        own.rotation = [...rotation];
      }
    });
  }

  /// Whether nothing was moved or pulled of late.
  get isAway() {
    return this.pointers.size === 0 && performance.now() - this.movedAt > OWN;
  }

  release() {
    for (const tool of this.tools) tool.led = false;
    this.pull.forget();
  }

  get drags() {
    return this.mode === "tool" && Boolean(this.tool) && this.pointers.size > 0;
  }

  get canMove() {
    return Boolean(this.tool) || this.pull.isOn;
  }

  down(event) {
    event.target.focus({ preventScroll: true });
    event.target.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const { blade } = this.actions;
    this.mode = this.modeOf(event);
    // A second finger turns the view, and pulls no more.
    if (this.mode !== "tool") this.pull.letGo();
    if (this.mode === "blade") blade.begin(event.clientX, event.clientY);
    else blade.end();
    if (this.mode === "tool" && this.tool) this.pick(event);
    if (this.mode === "tool" && !this.tool && !this.grip(event.clientX, event.clientY)) this.mode = "view";
  }

  /// Grips tissue at a place of the page; false where there is none.
  grip(x, y) {
    this.movedAt = performance.now();
    return this.pull.grip(x, y, this.actions.paneAt(x));
  }

  /// What a press does: the first finger or the left button acts, where there is something to act with; others turn and move the view.
  modeOf({ pointerType, button, shiftKey, altKey }) {
    const { blade } = this.actions;
    const isPast = this.actions.isPast();
    const acts = !isPast && (blade.isOn || Boolean(this.tool));
    const isFirst = pointerType === "touch" ? this.pointers.size === 1 : button === 0;
    // Without a tool the tissue under the pointer is pulled.
    if (isFirst && isPast) return shiftKey ? "pan" : "view";
    if (isFirst && !blade.isOn && this.tool && (altKey || this.turns)) return "turn";
    if (isFirst && !shiftKey) return blade.isOn ? "blade" : "tool";
    if (pointerType === "touch") return isFirst || (acts && this.pointers.size === 2) ? "view" : "pan";
    return shiftKey || button === 1 || (button === 2 && !acts) ? "pan" : "view";
  }

  /// Takes the tool into the hand at which the pointer is.
  pick(event) {
    const pane = this.actions.paneAt(event.clientX);
    const distance = ({ position }) => {
      const [x, y] = this.view.camera.project(position, pane);
      return Math.hypot(x - event.clientX, y - event.clientY);
    };
    // The one in the hand stays there unless another one is clearly meant.
    const [away, number] = this.tools.map((tool, index) => [distance(tool), index]).reduce((best, one) => (one[0] < best[0] ? one : best));
    if (number !== this.selected && away < CLOSE && away < 0.5 * distance(this.tool)) this.actions.take(number);
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
    const { camera } = this.view;
    const fingers = this.pointers.size;
    if (fingers >= 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
      const is = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
      if (fingers === 2) camera.zoom(was / Math.max(1, is));
      if (this.mode === "pan") camera.pan(dx / fingers, dy / fingers);
      else camera.orbit(dx / fingers, dy / fingers);
    } else if (this.mode === "blade") {
      this.actions.blade.to(event.clientX, event.clientY);
    } else if (this.mode === "tool") {
      const { right, up } = camera.directions();
      const scale = camera.metresPerPixel(this.place());
      this.shift(right.multiplyScalar(dx * scale).addScaledVector(up, -dy * scale));
    } else if (this.mode === "turn") {
      this.turn(PIXEL * dx, PIXEL * dy);
    } else if (this.mode === "pan") {
      camera.pan(dx, dy);
    } else {
      camera.orbit(dx, dy);
    }
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  up(event) {
    this.pointers.delete(event.pointerId);
    if (this.mode === "blade") this.actions.blade.end();
    if (this.pointers.size === 0) {
      this.lift(false);
      this.pull.letGo();
    }
  }

  wheel(event) {
    event.preventDefault();
    const amount = event.deltaY * (event.deltaMode === 1 ? 30 : 1);
    this.view.camera.zoom(Math.exp(0.0012 * amount));
  }

  key(event) {
    const isPast = this.actions.isPast();
    if (!isPast && this.actions.blade.isOn && this.actions.bladeKey(event)) {
      event.preventDefault();
      return;
    }
    const { camera } = this.view;
    const fine = event.shiftKey ? 0.2 : 1;
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const { right, up, away } = camera.directions();
    const moves = {
      ArrowLeft: right.clone().negate(), ArrowRight: right, ArrowUp: away, ArrowDown: away.clone().negate(),
      PageUp: up, PageDown: up.clone().negate(), e: away, q: away.clone().negate(),
    };
    // Shift makes letters large, and steps fine.
    const move = moves[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (arrow && !isPast && this.turns && this.tool && !event.ctrlKey && !event.altKey) {
      event.preventDefault();
      this.turn(ARROW * fine * arrow[0], ARROW * fine * arrow[1]);
      return;
    }
    const canMove = this.canMove && !isPast;
    if (arrow && (event.ctrlKey || !canMove)) {
      event.preventDefault();
      if (event.ctrlKey) camera.pan(-30 * fine * arrow[0], -30 * fine * arrow[1]);
      else camera.orbit(-12 * fine * arrow[0], -12 * fine * arrow[1]);
    } else if (move && canMove && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      this.shift(move.multiplyScalar(0.01 * fine * this.view.extent));
    } else if (event.key === "+" || event.key === "-") {
      camera.zoom(event.key === "+" ? 0.9 : 1.1);
    } else if (event.key === "[" || event.key === "]") {
      camera.orbit(event.key === "[" ? 12 : -12, 0);
    } else if (event.key === "Escape" && this.pull.isOn) {
      this.pull.letGo();
    } else if (event.key === "g" && !this.tool && !isPast) {
      if (this.pull.isOn) this.pull.letGo();
      else this.grip(...this.actions.middle());
    }
  }

  /// Where the hand is.
  place() {
    return this.tool?.position ?? this.pull.target ?? this.view.centre;
  }

  shift(by) {
    const { tool } = this;
    if (tool) {
      this.movedAt = performance.now();
      tool.position.add(by);
      tool.led = true;
      this.actions.lead(this.selected, this.target(tool), tool.rotation);
    } else if (this.pull.isOn) {
      this.movedAt = performance.now();
      this.pull.shift(by);
    }
  }

  /// Turns the tool about the directions up and to the right of whoever looks (rad).
  turn(aboutUp, aboutRight) {
    const { tool } = this;
    if (!tool) return;
    const { right, up } = this.view.camera.directions();
    this.movedAt = performance.now();
    tool.rotation = turned(turned(tool.rotation, up, aboutUp), right, aboutRight);
    tool.led = true;
    this.actions.lead(this.selected, this.target(tool), tool.rotation);
  }

  lift(on) {
    const { tool } = this;
    if (!tool || on === this.lifted || this.view.extent === undefined) return;
    this.lifted = on;
    this.movedAt = performance.now();
    if (tool.led) this.actions.lead(this.selected, this.target(tool), tool.rotation);
  }

  target({ position }) {
    return position.clone().add(new Vector3(0, 0, this.lifted ? 0.3 * this.view.extent : 0));
  }
}
