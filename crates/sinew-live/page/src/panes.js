// What stands beside the picture about each pane: its method, its step, its lights.

import { element } from "./element.js";
import { COLOURS, LIGHTS, colourOfLight, numberOfReason, reasonOf } from "./lights.js";
import { milliseconds, plain } from "./numbers.js";
import { OptionList } from "./options.js";

const [SHORTEST, LONGEST] = [1e-4, 0.2];
const STEPS = 1000;
const placeOf = (dt) => Math.log(dt / SHORTEST) / Math.log(LONGEST / SHORTEST);
const stepAt = (place) => Number((SHORTEST * (LONGEST / SHORTEST) ** place).toPrecision(3));

/// What is known of the stability of a step, in words; of the methods in the list without a step.
function stabilityInWords({ stability, stable_step: stable }, dt) {
  const words = {
    any: "every step is stable",
    at_rest: "every step is stable at rest; deformed, it is not known",
    cut: "cut into parts as the stiffness asks",
    unknown: "stable step not known",
  }[stability];
  if (words) return words;
  if (stable === 0) return "no step is stable";
  const where = stability === "at_rest_up_to" ? " at rest" : "";
  return dt > 0 ? `${plain(dt / stable, 2)} × the stable step${where}` : `stable to ${milliseconds(stable)}${where}`;
}

export const stepInWords = (facts) => `${milliseconds(facts.dt)} · ${stabilityInWords(facts, facts.dt)}`;

export class PaneCard {
  constructor(number, actions) {
    this.number = number;
    this.integrators = [];
    const label = number === 0 ? "first" : "second";
    this.select = element("select", { "aria-label": `Method of the ${label} pane`, onchange: () => actions.integrator(number, this.select.value) });
    this.slider = element("input", { type: "range", min: 0, max: STEPS, "aria-label": `Step of the ${label} pane` });
    this.slider.addEventListener("input", () => {
      const dt = stepAt(this.slider.value / STEPS);
      this.readout.textContent = stepInWords({ ...this.facts, dt });
      this.slider.setAttribute("aria-valuetext", this.readout.textContent);
      actions.dt(number, dt);
    });
    this.readout = element("output");
    this.marks = element("div", { class: "marks", "aria-hidden": "true" });
    this.lights = LIGHTS.map((name) => {
      const why = element("span", { class: "why" }, "not measured");
      const state = element("span", { class: "lamp", role: "img", "aria-label": COLOURS[0] });
      return { item: element("li", { "data-colour": 0 }, state, element("b", {}, name), why), why, state };
    });
    this.options = new OptionList(label, (order) => actions.option(number, order));
    this.measure = element("button", { type: "button", class: "measure", title: "Beside a trusted run from the beginning", "aria-pressed": "false", onclick: () => actions.trusted() }, "Measure the error");
    this.root = element(
      "section", { class: "card", "aria-label": `The ${label} pane` },
      element("div", { class: "pane-head" }, element("span", { class: "swatch" }), this.select),
      element("div", { class: "step-row" }, element("span", {}, "Step"), this.readout),
      element("div", { class: "slider" }, this.slider, this.marks),
      this.options.root,
      element("ul", { class: "lights" }, ...this.lights.map(({ item }) => item)),
      ...(number === 0 ? [this.measure] : []),
    );
    this.root.querySelector(".swatch").classList.add(label);
  }

  setIntegrators(list) {
    this.integrators = list;
    if (this.facts) this.fill();
  }

  fill() {
    const { integrator } = this.facts;
    const known = this.integrators.length > 0 ? this.integrators : [{ name: integrator }];
    this.select.replaceChildren(...known.map(({ name, refused, summary, ...facts }) => {
      let suffix = "";
      if (refused) suffix = " · not with this scene";
      else if (facts.stability === "any") suffix = " · any step";
      else if (facts.stability && facts.stability !== "unknown") suffix = ` · ${stabilityInWords(facts)}`;
      const option = element("option", { value: name, title: refused ?? summary ?? "" }, name === integrator ? name : name + suffix);
      option.disabled = Boolean(refused) && name !== integrator;
      return option;
    }));
    this.select.value = integrator;
  }

  settings(facts, trusted) {
    const isNew = facts.integrator !== this.facts?.integrator;
    this.facts = facts;
    if (isNew || this.select.value !== facts.integrator) this.fill();
    if (document.activeElement !== this.slider || Math.abs(stepAt(this.slider.value / STEPS) / facts.dt - 1) > 0.02) this.slider.value = Math.round(STEPS * placeOf(facts.dt));
    this.readout.textContent = stepInWords(facts);
    this.slider.setAttribute("aria-valuetext", this.readout.textContent);
    const marks = [];
    if (facts.stable_step > 0) {
      for (const [times, name] of [[1, "stable"], [2, "2×"]]) {
        const place = placeOf(times * facts.stable_step);
        if (place >= 0 && place <= 1) marks.push(element("span", {}, name));
        if (place >= 0 && place <= 1) marks.at(-1).style.left = `${100 * place}%`;
      }
    }
    this.marks.replaceChildren(...marks);
    this.options.show(facts.integrator, facts.options);
    this.measure.setAttribute("aria-pressed", String(trusted));
    this.measure.textContent = trusted ? "Stop measuring the error" : "Measure the error";
  }

  show(pane) {
    this.lights.forEach(({ item, why, state }, light) => {
      const colour = colourOfLight(pane, light);
      const words = reasonOf(light, numberOfReason(pane, light), pane);
      if (item.dataset.colour !== String(colour)) {
        item.dataset.colour = colour;
        state.setAttribute("aria-label", COLOURS[colour]);
      }
      if (why.textContent !== words) why.textContent = words;
    });
  }
}
