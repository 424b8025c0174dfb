// The scale of colours: from a value to a colour.

import { NOT_KNOWN, colourOf } from "./colours.js";

const TABLE = 512;

/// Colours of shares in light as the renderer reckons with it; then that of what is inside out, and of what is not known.
function linearTable(map) {
  const table = new Float32Array(3 * (TABLE + 2));
  for (let k = 0; k < TABLE; k += 1) colourOf(k / (TABLE - 1), table, 3 * k, map);
  colourOf(NaN, table, 3 * TABLE, map);
  colourOf(NOT_KNOWN, table, 3 * (TABLE + 1), map);
  return table.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
}

const tables = new Map();

export class Scale {
  /// From the least to the largest value, each with its colour in a map. A logarithmic one begins above 0.
  constructor(low, high, isLogarithmic, map) {
    if (!tables.has(map)) tables.set(map, linearTable(map));
    Object.assign(this, { low, high, isLogarithmic, map, table: tables.get(map) });
    this.offset = isLogarithmic ? Math.log(low) : low;
    this.factor = 1 / ((isLogarithmic ? Math.log(high) : high) - this.offset);
  }

  /// The value at a share of the way.
  valueAt(share) {
    return this.isLogarithmic ? this.low * (this.high / this.low) ** share : this.low + share * (this.high - this.low);
  }

  /// Writes the colour of a value.
  paint(value, out, at) {
    let place = TABLE + 1;
    if (value !== NOT_KNOWN) {
      const share = ((this.isLogarithmic ? Math.log(Math.max(value, 1e-300)) : value) - this.offset) * this.factor;
      place = Number.isNaN(value) ? TABLE : Math.max(0, Math.min(TABLE - 1, Math.round(share * (TABLE - 1))));
    }
    out[at] = this.table[3 * place];
    out[at + 1] = this.table[3 * place + 1];
    out[at + 2] = this.table[3 * place + 2];
  }
}
