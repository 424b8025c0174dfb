// Lips of cuts: the edges at which faces of cuts meet the outside of the body, and how they are drawn without the steps of the mesh.

/// Passes of smoothing, which take away steps of about one edge.
const PASSES = 3;

const keyOf = (a, b) => (a < b ? a * 4294967296 + b : b * 4294967296 + a);

/// The edges at which faces of cuts meet the outside of the body.
export function rimOf({ triangles, outer }) {
  const inside = new Set();
  const each = (begin, end, act) => {
    for (let k = begin; k < end; k += 3) for (let side = 0; side < 3; side += 1) act(triangles[k + side], triangles[k + ((side + 1) % 3)]);
  };
  each(3 * outer, triangles.length, (a, b) => inside.add(keyOf(a, b)));
  const rim = [];
  if (inside.size > 0) each(0, 3 * outer, (a, b) => inside.has(keyOf(a, b)) && rim.push(a, b));
  return new Uint32Array(rim);
}

export class Lips {
  /// Those of a surface with this rim; `isFixed` tells of a point that the outside of the body keeps where it is.
  constructor({ points, triangles, outer }, rim, isFixed) {
    const along = new Map();
    const within = new Map();
    const join = (map, a, b) => {
      for (const [one, other] of [[a, b], [b, a]]) map.has(one) ? map.get(one).add(other) : map.set(one, new Set([other]));
    };
    for (let k = 0; k < rim.length; k += 2) join(along, rim[k], rim[k + 1]);
    for (let k = 3 * outer; k < triangles.length; k += 3) for (let side = 0; side < 3; side += 1) join(within, triangles[k + side], triangles[k + ((side + 1) % 3)]);
    // What a cut divided is there twice; what is there once is its end.
    const placeOf = (point) => points.subarray(3 * point, 3 * point + 3).join(" ");
    const times = new Map();
    for (const point of within.keys()) times.set(placeOf(point), (times.get(placeOf(point)) ?? 0) + 1);
    // A point of a lip follows the two beside it, one within a face of a cut all around it.
    const moved = [];
    for (const [point, around] of within) {
      if (isFixed(point) || times.get(placeOf(point)) < 2) continue;
      const beside = along.get(point);
      if (!beside) moved.push([point, [...around]]);
      else if (beside.size === 2) moved.push([point, [...beside]]);
    }
    this.points = Uint32Array.from(moved, ([point]) => point);
    this.starts = new Uint32Array(moved.length + 1);
    moved.forEach(([, around], index) => { this.starts[index + 1] = this.starts[index] + around.length; });
    this.around = Uint32Array.from(moved.flatMap(([, around]) => around));
    this.next = new Float32Array(3 * moved.length);
  }

  /// Smooths places of points in their array.
  smooth(places) {
    const { points, starts, around, next } = this;
    for (let pass = 0; pass < PASSES; pass += 1) {
      for (let index = 0; index < points.length; index += 1) {
        const share = 0.5 / (starts[index + 1] - starts[index]);
        for (let axis = 0; axis < 3; axis += 1) {
          let sum = 0;
          for (let k = starts[index]; k < starts[index + 1]; k += 1) sum += places[3 * around[k] + axis];
          next[3 * index + axis] = 0.5 * places[3 * points[index] + axis] + share * sum;
        }
      }
      for (let index = 0; index < points.length; index += 1) {
        for (let axis = 0; axis < 3; axis += 1) places[3 * points[index] + axis] = next[3 * index + axis];
      }
    }
  }
}
