// The handle for depth: a slider on the stage that leads the tool away from whoever looks, and back.

import { plain } from "./numbers.js";

const get = (id) => document.getElementById(id);

/// Ends of the slider: so many sizes of the body before and behind its middle.
const REACH = 1.2;

export class DepthHandle {
  constructor(view, hand) {
    this.view = view;
    this.hand = hand;
    this.slider = get("reach");
    this.slider.addEventListener("input", () => this.lead());
  }

  /// How far (m) the tool is behind the middle of the body.
  get depth() {
    return this.hand.tool.position.clone().sub(this.view.centre).dot(this.view.camera.directions().away);
  }

  lead() {
    const { away } = this.view.camera.directions();
    const wanted = (REACH * this.view.extent * this.slider.value) / this.slider.max;
    this.hand.shift(away.multiplyScalar(wanted - this.depth));
    this.words(wanted);
  }

  words(depth) {
    const words = `${plain(1000 * Math.abs(depth), 2)} mm ${depth < 0 ? "before" : "behind"} the middle of the body`;
    if (this.slider.getAttribute("aria-valuetext") !== words) this.slider.setAttribute("aria-valuetext", words);
  }

  /// Follows the tool in the hand; there is none with a blade.
  show(isBlade) {
    const hasTool = Boolean(this.hand.tool);
    get("reach-box").hidden = !hasTool;
    this.slider.disabled = isBlade;
    if (!hasTool || this.view.extent === undefined) return;
    const { depth } = this;
    this.slider.value = (depth / (REACH * this.view.extent)) * this.slider.max;
    this.words(depth);
  }
}
