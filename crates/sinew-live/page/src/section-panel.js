// Controls of the section: across which axis the picture is cut open, where, and which side is shown.

import { plain } from "./numbers.js";

const get = (id) => document.getElementById(id);

const AXES = { x: 0, y: 1, z: 2 };

export class SectionPanel {
  /// `ask` asks the simulation for the values inside, at an axis and a place (m), or for none (null).
  constructor(view, ask) {
    this.view = view;
    this.ask = ask;
    this.isTurned = false;
    get("section").addEventListener("change", () => this.choose());
    get("section-at").addEventListener("input", () => this.apply());
    get("section-turn").addEventListener("click", () => {
      this.isTurned = !this.isTurned;
      this.apply();
    });
    this.enable();
  }

  get axis() {
    return AXES[get("section").value] ?? null;
  }

  /// The side that is nearer to the camera is taken away.
  choose() {
    if (this.axis !== null && this.view.topology) this.isTurned = this.view.camera.forward().getComponent(this.axis) > 0;
    this.apply();
  }

  apply() {
    if (!this.view.topology) return;
    const share = get("section-at").value / get("section-at").max;
    this.view.setSection(this.axis, share, this.isTurned);
    this.enable();
    const { axis } = this;
    this.ask(axis, axis === null ? 0 : this.view.section.at);
    if (axis === null) return;
    const { low, high } = this.view.box;
    const words = `${get("section").value} = ${plain(1000 * (low[axis] + share * (high[axis] - low[axis])), 3)} mm`;
    get("section-now").textContent = words;
    get("section-at").setAttribute("aria-valuetext", words);
  }

  enable() {
    const isOn = this.axis !== null;
    for (const id of ["section-at", "section-turn"]) get(id).disabled = !isOn;
    get("section-name").textContent = isOn ? `Section ${get("section").value}` : "Section";
    if (!isOn) get("section-now").textContent = "–";
  }
}
