// Small plots on a canvas: axes with round numbers, lines, a name for each.

import { roundUp } from "./colours.js";
import { short } from "./numbers.js";

export const themeColour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function steps(low, high, wanted) {
  const step = roundUp((high - low) / wanted);
  const ticks = [];
  for (let tick = Math.ceil(low / step - 1e-9) * step; tick <= high + 1e-9 * step; tick += step) ticks.push(Math.abs(tick) < 1e-9 * step ? 0 : tick);
  return ticks;
}

export class Plot {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }

  /// Draws lines { name, colour, dash, width, xs, ys } between given ends of the axes.
  draw({ x, y, lines, xUnit, yUnit }) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0) return;
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const c = this.context;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    const [left, right, top, bottom] = [46, width - 8, 16, height - 17];
    const px = (value) => left + ((value - x[0]) / (x[1] - x[0])) * (right - left);
    const py = (value) => bottom - ((value - y[0]) / (y[1] - y[0])) * (bottom - top);
    c.font = "11px system-ui, 'DejaVu Sans', sans-serif";
    c.textBaseline = "middle";
    c.lineWidth = 1;
    const ink = themeColour("--soft");
    for (const tick of steps(y[0], y[1], 3)) {
      c.strokeStyle = themeColour("--line");
      c.beginPath();
      c.moveTo(left, py(tick));
      c.lineTo(right, py(tick));
      c.stroke();
      c.fillStyle = ink;
      c.textAlign = "right";
      c.fillText(short(tick), left - 5, py(tick));
    }
    c.textBaseline = "alphabetic";
    c.textAlign = "center";
    for (const tick of steps(x[0], x[1], width > 260 ? 5 : 3)) {
      const at = px(tick);
      if (at > right - 34) continue;
      c.fillText(short(tick), at, height - 4);
    }
    c.textAlign = "right";
    c.fillText(xUnit, right, height - 4);
    c.fillText(yUnit, left - 5, 10);
    c.save();
    c.beginPath();
    c.rect(left, top - 2, right - left, bottom - top + 4);
    c.clip();
    for (const line of lines) {
      c.strokeStyle = themeColour(line.colour);
      c.lineWidth = line.width ?? 1.8;
      c.setLineDash(line.dash ?? []);
      c.beginPath();
      let pen = false;
      for (let k = 0; k < line.xs.length; k += 1) {
        const [a, b] = [line.xs[k], line.ys[k]];
        if (!Number.isFinite(a) || !Number.isFinite(b)) {
          pen = false;
        } else if (pen) {
          c.lineTo(px(a), Math.max(-1e4, Math.min(1e4, py(b))));
        } else {
          c.moveTo(px(a), Math.max(-1e4, Math.min(1e4, py(b))));
          pen = true;
        }
      }
      c.stroke();
    }
    c.restore();
    c.setLineDash([]);
    c.textAlign = "right";
    let at = right;
    for (const line of [...lines].reverse()) {
      if (!line.name) continue;
      c.fillStyle = themeColour(line.colour);
      c.fillText(line.name, at, 10);
      at -= c.measureText(line.name).width + 12;
    }
  }
}

/// Ends of an axis around values, with 0 on it.
export function around(values, least = 0) {
  let [low, high] = [0, least];
  for (const value of values) {
    if (Number.isFinite(value)) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (high === low) high = low + 1;
  const room = 0.06 * (high - low);
  return [low < 0 ? low - room : 0, high + room];
}
