// The legend: the scale of colours with its numbers.

import { FIELDS, paintBar, unitOf } from "./colours.js";
import { short } from "./numbers.js";
import { inWords } from "./range.js";

const get = (id) => document.getElementById(id);

/// Shows a field with its scale, in the unit that suits its round largest value; nothing where tissue is shown.
export function showLegend(field, scale, largest) {
  get("legend").hidden = !field;
  if (!field) return;
  get("legend-title").textContent = FIELDS[field].title;
  paintBar(get("legend-bar"), scale.map);
  const unit = unitOf(field, largest);
  const wordsAt = (share) => {
    // Its values are those of 1 / step.
    if (field === "step_limit") return share > 0 ? `${short(1000 / (share * largest))} ms` : "longer";
    return inWords(scale.valueAt(share), unit);
  };
  const ticks = field === "saturated" ? [[1, "at limit"], [0, "free"]] : [0, 0.25, 0.5, 0.75, 1].map((share) => [share, wordsAt(share)]);
  get("legend-ticks").replaceChildren(...ticks.map(([share, words]) => {
    const tick = document.createElement("span");
    tick.textContent = words;
    tick.style.top = `${100 * (1 - share)}%`;
    return tick;
  }));
  const mark = document.createElement("i");
  mark.classList.toggle("unknown", field === "difference");
  get("legend-note").replaceChildren(mark, `${field === "difference" ? "cut in one alone" : "inside out"}${scale.isLogarithmic ? " · logarithmic" : ""}`);
}
