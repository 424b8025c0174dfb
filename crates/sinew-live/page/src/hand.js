// Pointer and keys: a tool is led, or loads pull at a point; the view is turned.

import { Vector3 } from "three";

const CLOSE = 60;

/// Time (ms) after the last pointer or key from which on others may lead what this hand led: what was sent comes back within it.
const OWN = 500;

export class Hand {
  constructor(canvas, view, actions) {
    this.view = view;
    this.actions = actions;
    this.tools = [];
    this.selected = 0;
    this.pull = null;
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

  /// Tools as the scenery has them, or a pull by loads.
  begin(tools, pull) {
    this.tools = tools.map(({ start }) => ({ position: new Vector3(...start.slice(0, 3)), rotation: start.slice(3), led: false }));
    this.pull = pull ? { ...pull, force: new Vector3() } : null;
    this.selected = 0;
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
    this.pull?.force.set(0, 0, 0);
  }

  get drags() {
    return this.mode === "tool" && this.pointers.size > 0;
  }

  get canMove() {
    return this.tools.length > 0 || this.pull !== null;
  }

  down(event) {
    event.target.focus({ preventScroll: true });
    event.target.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const grabs = event.pointerType === "touch" ? this.pointers.size === 1 : event.button === 0;
    const { blade } = this.actions;
    this.mode = "view";
    if (grabs && blade.isOn) this.mode = "blade";
    else if (grabs && this.canMove) this.mode = "tool";
    // A second finger turns the view, and pulls no more.
    if (this.mode !== "tool") this.letGo();
    if (this.mode === "blade") blade.begin(event.clientX, event.clientY);
    else blade.end();
    if (this.mode === "tool" && this.tools.length > 1) this.pick(event);
  }

  /// Selects the tool that is nearest to the pointer.
  pick(event) {
    const pane = this.actions.paneAt(event.clientX);
    const distance = ({ position }) => {
      const [x, y] = this.view.project(position, pane);
      return Math.hypot(x - event.clientX, y - event.clientY);
    };
    const nearest = this.tools.map(distance).reduce((best, away, index) => (away < best[0] ? [away, index] : best), [Infinity, 0]);
    if (nearest[0] < 4 * CLOSE) this.selected = nearest[1];
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
    if (this.pointers.size === 2) {
      const [a, b] = [...this.pointers.keys()];
      const other = this.pointers.get(event.pointerId === a ? b : a);
      const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
      const is = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
      this.view.zoom(was / Math.max(1, is));
      this.view.orbit(dx / 2, dy / 2);
    } else if (this.mode === "blade") {
      this.actions.blade.to(event.clientX, event.clientY);
    } else if (this.mode === "tool") {
      const { right, up } = this.view.directions();
      const scale = this.view.metresPerPixel(this.place());
      this.shift(right.multiplyScalar(dx * scale).addScaledVector(up, -dy * scale));
    } else {
      this.view.orbit(dx, dy);
    }
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  up(event) {
    this.pointers.delete(event.pointerId);
    if (this.mode === "blade") this.actions.blade.end();
    if (this.pointers.size === 0) {
      this.lift(false);
      this.letGo();
    }
  }

  /// Pulls no more.
  letGo() {
    if (!this.pull || this.pull.force.lengthSq() === 0) return;
    this.pull.force.set(0, 0, 0);
    this.sendPull();
  }

  sendPull() {
    this.movedAt = performance.now();
    this.actions.pull(this.pull.force);
  }

  /// The factors of loads as they are, where no pointer changes them: another page may pull, or have pulled.
  follow(factors) {
    if (this.pull && this.isAway) this.pull.force.set(...this.pull.loads.map((load) => this.pull.unit * factors[load]));
  }

  wheel(event) {
    event.preventDefault();
    const amount = event.deltaY * (event.deltaMode === 1 ? 30 : 1);
    if (event.ctrlKey || this.actions.blade.isOn || this.tools.length === 0) this.view.zoom(Math.exp(0.0012 * amount));
    else this.shift(this.view.directions().away.multiplyScalar(-0.0002 * amount * this.view.extent));
  }

  key(event) {
    if (this.actions.blade.isOn && this.actions.bladeKey(event)) {
      event.preventDefault();
      return;
    }
    const step = (event.shiftKey ? 0.002 : 0.01) * this.view.extent;
    const { right, up, away } = this.view.directions();
    const moves = {
      ArrowLeft: right.clone().negate(), ArrowRight: right, ArrowUp: away, ArrowDown: away.clone().negate(),
      PageUp: up, PageDown: up.clone().negate(),
    };
    const move = moves[event.key];
    if (move && this.canMove) {
      event.preventDefault();
      this.shift(move.multiplyScalar(step));
    } else if (event.key === "+" || event.key === "-") {
      this.view.zoom(event.key === "+" ? 0.9 : 1.1);
    } else if (event.key === "[" || event.key === "]") {
      this.view.orbit(event.key === "[" ? 12 : -12, 0);
    } else if (event.key === "Escape") {
      this.letGo();
    }
  }

  /// Where the hand is.
  place() {
    return this.tools[this.selected]?.position ?? this.actions.gripAt();
  }

  shift(by) {
    const tool = this.tools[this.selected];
    if (tool) {
      this.movedAt = performance.now();
      tool.position.add(by);
      tool.led = true;
      this.actions.lead(this.selected, this.target(tool), tool.rotation);
    } else if (this.pull) {
      // A hand on a spring: so many newtons for a pull of the body's size.
      this.pull.force.addScaledVector(by, this.pull.stiffness);
      this.sendPull();
    }
  }

  lift(on) {
    const tool = this.tools[this.selected];
    if (!tool || on === this.lifted || this.view.extent === undefined) return;
    this.lifted = on;
    this.movedAt = performance.now();
    if (tool.led) this.actions.lead(this.selected, this.target(tool), tool.rotation);
  }

  target({ position }) {
    return position.clone().add(new Vector3(0, 0, this.lifted ? 0.3 * this.view.extent : 0));
  }
}
