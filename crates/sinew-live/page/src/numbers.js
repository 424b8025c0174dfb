// Numbers for people.

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/// A number with so many digits and a prefix: 0.00123 J is "1.23 mJ".
export function withUnit(value, unit, digits = 3) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : `∞ ${unit}`;
  if (value === 0) return `0 ${unit}`.trim();
  const size = Math.abs(value);
  if (size >= 1e12 || size < 1e-12) return `${value.toExponential(1)} ${unit}`.trim();
  const [scale, prefix] = PREFIXES.find(([scale]) => size >= scale) ?? PREFIXES.at(-1);
  return `${plain(value / scale, digits)} ${prefix}${unit}`.trim();
}

export function plain(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1);
  const after = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(after, 6));
}

export const milliseconds = (seconds) => `${plain(1000 * seconds, 3)} ms`;

/// A round number without zeros that say nothing.
export const short = (value) => (Math.abs(value) >= 1e6 || (value !== 0 && Math.abs(value) < 1e-4) ? value.toExponential(0) : String(Number(value.toPrecision(3))));
