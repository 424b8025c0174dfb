// The options of a pane's method: a list of words, a slider of numbers, or both.

import { element } from "./element.js";
import { short } from "./numbers.js";

const STEPS = 200;
const NUMBER = "number";

/// The number at a share of a slider, and back.
function numberAt({ low, high, is_whole: whole, is_logarithmic: logarithmic }, share) {
  const number = logarithmic ? low * (high / low) ** share : low + share * (high - low);
  return whole ? Math.round(number) : Number(number.toPrecision(3));
}

function shareOf({ low, high, is_logarithmic: logarithmic }, number) {
  const share = logarithmic ? Math.log(number / low) / Math.log(high / low) : (number - low) / (high - low);
  return Math.min(1, Math.max(0, share));
}

class OptionRow {
  constructor(label, facts, send) {
    this.facts = facts;
    const { key, help, words, number, has_both: both } = facts;
    this.readout = element("output");
    this.select = element("select", { "aria-label": `${key} of the ${label} pane`, onchange: () => send(this.order()) });
    this.select.append(...words.map((word) => element("option", { value: word }, word)));
    // A word, or else a number.
    if (number && words.length > 0 && !both) {
      this.select.append(element("option", { value: NUMBER }, number.high > number.low ? "a number" : short(number.low)));
    }
    this.slider = element("input", { type: "range", min: 0, max: STEPS, "aria-label": `${key} of the ${label} pane` });
    this.slider.addEventListener("input", () => {
      if (words.length > 0 && !both) this.select.value = NUMBER;
      this.readout.textContent = short(this.number());
      this.slider.setAttribute("aria-valuetext", this.readout.textContent);
      send(this.order());
    });
    this.root = element("div", { class: "option", title: help }, element("span", {}, key), ...(words.length > 0 ? [this.select] : []), this.readout);
    // Where the ends are one, the words say all.
    if (number && number.high > number.low) this.root.append(this.slider);
  }

  number() {
    const { low, high } = this.facts.number;
    return high > low ? numberAt(this.facts.number, this.slider.value / STEPS) : low;
  }

  order() {
    const { key, number, words, has_both: both } = this.facts;
    const isNumber = words.length === 0 || this.select.value === NUMBER;
    return { key, word: isNumber ? null : this.select.value, number: number && (isNumber || both) ? this.number() : null };
  }

  show({ word, value, number, has_both: both }) {
    const holds = value !== null && (both || word === null);
    if (number && holds && document.activeElement !== this.slider) this.slider.value = Math.round(STEPS * shareOf(number, value));
    this.select.value = word ?? NUMBER;
    // A word that takes no number beside it.
    this.slider.hidden = both && !holds;
    this.readout.textContent = holds ? short(value) : "";
    this.slider.setAttribute("aria-valuetext", this.readout.textContent);
  }
}

export class OptionList {
  constructor(label, send) {
    this.label = label;
    this.send = send;
    this.rows = element("div");
    this.root = element("details", { class: "options" }, element("summary", {}, "Options of the method"), this.rows);
  }

  show(integrator, options) {
    if (integrator !== this.integrator) {
      this.integrator = integrator;
      this.list = options.map((facts) => new OptionRow(this.label, facts, this.send));
      this.rows.replaceChildren(...this.list.map(({ root }) => root));
      this.root.hidden = options.length === 0;
    }
    this.list.forEach((row, index) => row.show(options[index]));
  }
}
