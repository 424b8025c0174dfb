// The three lights in words; the numbers of the reasons are those of crates/sinew-live/src/engine/lights.rs.

import { plain } from "./numbers.js";

export const LIGHTS = ["Bounded", "Settles", "Error"];
export const COLOURS = ["not measured", "good", "with a reservation", "bad"];

const percent = (share) => `${plain(100 * share, 2)} %`;

/// The trusted run is never quite at the time of a pane; from here on (s) its error is said to be old.
const OLD = 0.1;

export function reasonOf(light, reason, pane) {
  const off = `${percent(pane.error)} off the trusted run${pane.lag > OLD ? `, which is ${plain(pane.lag, 2)} s behind` : ""}`;
  const reasons = [
    [
      "not measured",
      "no more energy than was put in",
      `${percent(pane.saturated)} of velocities at their limit: clamped, not stable`,
      "more energy than anybody put in",
      "stopped",
      `${pane.inverted} elements inside out`,
      "parts or surfaces of the body are in each other: nothing keeps them apart",
    ],
    [
      "not measured: loads or tools still move",
      "came to rest",
      "still swings",
      "does not come to rest: a load keeps it moving, or too little damps it; add damping to the scene, or choose a method that damps",
    ],
    [
      "not measured",
      off,
      off,
      off,
    ],
  ];
  const words = reasons[light][reason] ?? "not measured";
  if (light === 1 && reason === 2 && Number.isFinite(pane.settling)) return `${words}: ${percent(pane.settling)} of the energy a quarter of a second before`;
  return words;
}

export const colourOfLight = (pane, light) => (pane.lights >> (2 * light)) & 3;
export const numberOfReason = (pane, light) => (pane.reasons >> (8 * light)) & 255;
