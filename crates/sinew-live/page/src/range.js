// The range of colours: automatic, typed, that of what is shown, or logarithmic; and the map of colours.

import { unitOf } from "./colours.js";
import { short } from "./numbers.js";
import { Scale } from "./scale.js";

const get = (id) => document.getElementById(id);

/// Least values of logarithmic scales, as parts of the largest, where the range begins at 0 or below.
const DECADES = 1e-3;

/// Fields whose scale is fixed.
const FIXED = ["saturated", "step_limit"];

export class Range {
  /// `changed` is called when colours became others; `extremes` tells the least and the largest value that is shown.
  constructor({ changed, extremes }) {
    this.changed = changed;
    this.extremes = extremes;
    this.own = new Map();
    this.logarithmic = new Set();
    this.map = "brown";
    this.field = null;
    for (const id of ["range-low", "range-high"]) get(id).addEventListener("change", () => this.type());
    get("range-auto").addEventListener("click", () => this.take(null));
    get("range-fit").addEventListener("click", () => this.fit());
    get("range-log").addEventListener("change", () => {
      if (get("range-log").checked) this.logarithmic.add(this.field);
      else this.logarithmic.delete(this.field);
      this.changed();
    });
    get("map").addEventListener("change", () => {
      this.map = get("map").value;
      this.changed();
    });
  }

  /// The scale of a field with these values, of which the server's scenery gives a round largest one.
  scaleOf(field, largest) {
    const { low, high } = this.own.get(field) ?? { low: 0, high: largest };
    const isLogarithmic = this.logarithmic.has(field) && high > 0;
    return new Scale(isLogarithmic && low <= 0 ? high * DECADES : low, high, isLogarithmic, this.map);
  }

  /// Takes a range of its own for the field that is shown, or none.
  take(range) {
    if (range) this.own.set(this.field, range);
    else this.own.delete(this.field);
    this.say("");
    this.changed();
  }

  type() {
    const { factor } = this.unit;
    const [low, high] = ["range-low", "range-high"].map((id) => (get(id).value === "" ? NaN : Number(get(id).value) / factor));
    const isGood = low < high;
    for (const id of ["range-low", "range-high"]) get(id).setAttribute("aria-invalid", String(!isGood));
    if (isGood) this.take({ low, high });
    else this.say("The least value must be below the largest.");
  }

  fit() {
    const { low, high } = this.extremes();
    if (low < high) this.take({ low: Number(low.toPrecision(3)), high: Number(high.toPrecision(3)) });
    else this.say("All that is shown has one value.");
  }

  say(words) {
    get("range-note").textContent = words;
  }

  /// Shows the range of a field with its scale; of none where tissue is shown.
  show(field, scale, largest) {
    const isOther = field !== this.field;
    this.field = field;
    const isFixed = !field || FIXED.includes(field);
    for (const id of ["range-low", "range-high", "range-auto", "range-fit", "range-log"]) get(id).disabled = isFixed;
    get("range-auto").setAttribute("aria-pressed", String(!isFixed && !this.own.has(field)));
    get("map").disabled = !field;
    get("range-log").checked = !isFixed && this.logarithmic.has(field);
    if (isOther) this.say("");
    if (!isFixed) this.unit = unitOf(field, largest);
    for (const [id, end] of [["range-low", "low"], ["range-high", "high"]]) {
      const input = get(id);
      if (isFixed) input.value = "";
      else if (document.activeElement !== input || isOther) input.value = String(Number((scale[end] * this.unit.factor).toPrecision(6)));
      if (!isFixed && scale.low < scale.high && document.activeElement !== input) input.removeAttribute("aria-invalid");
    }
    for (const unit of document.querySelectorAll(".range-unit")) unit.textContent = isFixed ? "" : this.unit.unit;
  }
}

/// A value of a scale for people.
export const inWords = (value, { unit, factor }) => `${short(value * factor)} ${unit}`.trim();
