// Corners of the drawn surface: points of the body, several where a crease divides their normals.

/// Cosine of the angle between two triangles from which on the edge between them is a crease: 40 degrees.
const CREASE = Math.cos((40 * Math.PI) / 180);

/// The same within faces of cuts: what a cut leaves there are steps of the mesh, no edges of the tissue.
const CREASE_OF_CUTS = Math.cos((80 * Math.PI) / 180);

/// The normal (unit length) of each triangle.
function flatNormals(points, triangles) {
  const normals = new Float32Array(triangles.length);
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [3 * triangles[k], 3 * triangles[k + 1], 3 * triangles[k + 2]];
    const [ux, uy, uz] = [points[b] - points[a], points[b + 1] - points[a + 1], points[b + 2] - points[a + 2]];
    const [vx, vy, vz] = [points[c] - points[a], points[c + 1] - points[a + 1], points[c + 2] - points[a + 2]];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const size = Math.hypot(x, y, z) || 1;
    normals[k] = x / size;
    normals[k + 1] = y / size;
    normals[k + 2] = z / size;
  }
  return normals;
}

/// The places in `triangles` at which each point stands: those of point p are `places[starts[p]]` to `places[starts[p + 1] - 1]`.
function placesOf(triangles, count) {
  const starts = new Uint32Array(count + 1);
  for (const point of triangles) starts[point + 1] += 1;
  for (let point = 0; point < count; point += 1) starts[point + 1] += starts[point];
  const ends = starts.slice(0, count);
  const places = new Uint32Array(triangles.length);
  for (let at = 0; at < triangles.length; at += 1) {
    places[ends[triangles[at]]] = at;
    ends[triangles[at]] += 1;
  }
  return { starts, places };
}

/// Whether two triangles, by places of theirs at a point, are one smooth surface there: on one side of `cuts`, with an edge in common, at a small angle.
function areSmooth(one, other, triangles, flat, cuts) {
  const isCut = one >= cuts;
  if (isCut !== other >= cuts) return false;
  const a = one - (one % 3);
  const b = other - (other % 3);
  if (flat[a] * flat[b] + flat[a + 1] * flat[b + 1] + flat[a + 2] * flat[b + 2] < (isCut ? CREASE_OF_CUTS : CREASE)) return false;
  const [next, last] = [triangles[a + ((one + 1) % 3)], triangles[a + ((one + 2) % 3)]];
  const [begin, end] = [triangles[b + ((other + 1) % 3)], triangles[b + ((other + 2) % 3)]];
  return next === begin || next === end || last === begin || last === end;
}

export class Corners {
  /// Those of a surface at rest; creases stay where they are while it moves.
  constructor({ points, triangles, outer }) {
    const flat = flatNormals(points, triangles);
    const { starts, places } = placesOf(triangles, points.length / 3);
    const from = new Uint32Array(triangles.length);
    const corner = new Int32Array(triangles.length).fill(-1);
    const waiting = [];
    let count = 0;
    for (let point = 0; point + 1 < starts.length; point += 1) {
      for (let first = starts[point]; first < starts[point + 1]; first += 1) {
        if (corner[places[first]] >= 0) continue;
        corner[places[first]] = count;
        waiting.push(places[first]);
        while (waiting.length > 0) {
          const one = waiting.pop();
          for (let k = starts[point]; k < starts[point + 1]; k += 1) {
            const other = places[k];
            if (corner[other] >= 0 || !areSmooth(one, other, triangles, flat, 3 * outer)) continue;
            corner[other] = count;
            waiting.push(other);
          }
        }
        from[count] = point;
        count += 1;
      }
    }
    /// The corners of each triangle, and the point of each corner.
    this.triangles = new Uint32Array(corner);
    this.from = from.slice(0, count);
    /// 1 at corners of faces of cuts.
    this.isInner = new Uint8Array(count);
    for (let at = 3 * outer; at < triangles.length; at += 1) this.isInner[this.triangles[at]] = 1;
    this.positions = new Float32Array(3 * count);
    this.normals = new Float32Array(3 * count);
  }

  /// Whether each point lies on a crease of the outside.
  creased(count) {
    const corners = new Uint8Array(count);
    this.from.forEach((point, corner) => { if (!this.isInner[corner]) corners[point] += 1; });
    return corners.map((number) => Number(number > 1));
  }

  /// Takes the places of the points, and makes the normals anew.
  move(points) {
    const { from, positions, normals, triangles } = this;
    for (let corner = 0, at = 0; corner < from.length; corner += 1, at += 3) {
      const point = 3 * from[corner];
      positions[at] = points[point];
      positions[at + 1] = points[point + 1];
      positions[at + 2] = points[point + 2];
    }
    normals.fill(0);
    for (let k = 0; k < triangles.length; k += 3) {
      const a = 3 * triangles[k];
      const b = 3 * triangles[k + 1];
      const c = 3 * triangles[k + 2];
      const ux = positions[b] - positions[a];
      const uy = positions[b + 1] - positions[a + 1];
      const uz = positions[b + 2] - positions[a + 2];
      const vx = positions[c] - positions[a];
      const vy = positions[c + 1] - positions[a + 1];
      const vz = positions[c + 2] - positions[a + 2];
      const x = uy * vz - uz * vy;
      const y = uz * vx - ux * vz;
      const z = ux * vy - uy * vx;
      normals[a] += x;
      normals[a + 1] += y;
      normals[a + 2] += z;
      normals[b] += x;
      normals[b + 1] += y;
      normals[b + 2] += z;
      normals[c] += x;
      normals[c + 1] += y;
      normals[c + 2] += z;
    }
    for (let at = 0; at < normals.length; at += 3) {
      const size = Math.sqrt(normals[at] ** 2 + normals[at + 1] ** 2 + normals[at + 2] ** 2) || 1;
      normals[at] /= size;
      normals[at + 1] /= size;
      normals[at + 2] /= size;
    }
  }
}
