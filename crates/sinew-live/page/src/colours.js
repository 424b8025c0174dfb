// Colours that people with any colour vision can read: ColorBrewer's YlOrBr and RdYlBu (C. Brewer), viridis (S. van der Walt, N. Smith), magenta for
// tetrahedra that are inside out, grey for what is not known.

const MAPS = Object.fromEntries(Object.entries({
  brown: "ffffe5 fff7bc fee391 fec44f fe9929 ec7014 cc4c02 993404 662506",
  viridis: "440154 472d7b 3b528b 2c728e 21918c 28ae80 5ec962 addc30 fde725",
  diverging: "313695 4575b4 74add1 abd9e9 ffffbf fdae61 f46d43 d73027 a50026",
}).map(([name, list]) => [name, list.split(" ").map((hex) => [0, 2, 4].map((at) => Number.parseInt(hex.slice(at, at + 2), 16)))]));
const INSIDE_OUT = [255, 0, 220];
const UNKNOWN = [138, 148, 158];

/// The value of a point at which nothing is known.
export const NOT_KNOWN = -Infinity;

/// Writes the colour of a share from 0 to 1 in a map into an array of numbers from 0 to 1 (sRGB).
export function colourOf(share, out, at, map) {
  const list = MAPS[map];
  const colour = share === NOT_KNOWN ? UNKNOWN : INSIDE_OUT;
  if (!Number.isNaN(share) && share !== NOT_KNOWN) {
    const place = Math.min(Math.max(share, 0), 1) * (list.length - 1);
    const low = Math.min(Math.floor(place), list.length - 2);
    const rest = place - low;
    for (let k = 0; k < 3; k += 1) out[at + k] = (list[low][k] + rest * (list[low + 1][k] - list[low][k])) / 255;
    return;
  }
  for (let k = 0; k < 3; k += 1) out[at + k] = colour[k] / 255;
}

export function paintBar(canvas, map) {
  const context = canvas.getContext("2d");
  const colour = [0, 0, 0];
  for (let y = 0; y < canvas.height; y += 1) {
    colourOf(1 - y / (canvas.height - 1), colour, 0, map);
    context.fillStyle = `rgb(${colour.map((part) => Math.round(255 * part)).join(" ")})`;
    context.fillRect(0, y, canvas.width, 1);
  }
}

/// The next number of the kind 1, 2, 5 times a power of ten.
export function roundUp(value) {
  if (!(value > 0) || !Number.isFinite(value)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((digit) => digit * power).find((round) => round >= value * 0.999999);
}

/// The unit in which values of a field are read, where the largest of them is about this one: name, and what one of the server's is in it.
export function unitOf(field, largest) {
  const { unit, factor } = FIELDS[field];
  return unit === "Pa" && largest >= 5000 ? { unit: "kPa", factor: 1e-3 } : { unit, factor };
}

/// What each field is called, its unit on the page, and what a unit of it is in that of the server.
export const FIELDS = {
  stress: { title: "von Mises stress", unit: "Pa", factor: 1 },
  strain: { title: "von Mises strain", unit: "%", factor: 100 },
  displacement: { title: "Displacement", unit: "mm", factor: 1000 },
  energy_density: { title: "Strain energy", unit: "J/m³", factor: 1 },
  saturated: { title: "Cells at their limit", unit: "", factor: 1 },
  pressure: { title: "Contact pressure", unit: "Pa", factor: 1 },
  step_limit: { title: "Stable step of elements", unit: "ms", factor: 1 },
  difference: { title: "Difference of the two", unit: "mm", factor: 1000 },
};
