// Tissue that is pulled without a tool: a spring from the place where it was gripped to the pointer.

import { Vector3 } from "three";

export class Pull {
  constructor(view, actions) {
    this.view = view;
    this.actions = actions;
    /// Whereto it pulls; null without a grip.
    this.target = null;
  }

  get isOn() {
    return this.target !== null;
  }

  /// Grips the tissue that is seen at a place of the page; false where there is none.
  grip(x, y, pane) {
    const ray = this.view.camera.rayAt(x, y, pane);
    const away = this.view.surfaceAt(ray, pane, false);
    if (away === null) return false;
    const place = ray.at(away, new Vector3());
    const { points } = this.view.panes[pane].body;
    let [nearest, least] = [0, Infinity];
    for (let at = 0; at < points.length; at += 3) {
      const distance = (points[at] - place.x) ** 2 + (points[at + 1] - place.y) ** 2 + (points[at + 2] - place.z) ** 2;
      if (distance < least) [nearest, least] = [at / 3, distance];
    }
    this.from = new Vector3().fromArray(points, 3 * nearest);
    this.target = this.from.clone();
    this.actions.grip(pane, nearest);
    return true;
  }

  shift(by) {
    this.target.add(by);
    this.actions.pull(this.target);
  }

  letGo() {
    if (!this.isOn) return;
    this.target = null;
    this.actions.letGo();
  }

  /// The simulation let go, or went back.
  forget() {
    this.target = null;
  }

  /// Shows what is gripped in a pane of a picture; returns the force (N), and how far (m) the tissue was moved.
  show(number, { pull, grip }) {
    const isHeld = !Number.isNaN(grip[0]);
    this.view.showPull(number, isHeld ? grip : null, isHeld ? this.target : null);
    if (!isHeld) return [0, 0];
    return [Math.hypot(...pull), this.isOn ? this.from.distanceTo(new Vector3(...grip)) : 0];
  }
}
