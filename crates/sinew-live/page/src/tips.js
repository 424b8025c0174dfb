// Tips of tools: what touches the tissue, as it is computed with.

import { BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, PlaneGeometry, SphereGeometry, Vector3 } from "three";
import { AXIS } from "./poses.js";

/// The surface of a part in a body of this size (m).
export function tipOf({ kind, sizes }, extent) {
  if (kind === "sphere") return new SphereGeometry(sizes[0], 40, 28);
  if (kind === "capsule") return new CapsuleGeometry(sizes[0], sizes[1], 12, 28).rotateX(Math.PI / 2);
  if (kind === "box") return new BoxGeometry(...sizes);
  return new PlaneGeometry(1.6 * extent, 1.6 * extent);
}

/// A blade behind an edge along z, which has no thickness itself; its point is at the end of `sign`.
export function bladeOf(length, back, sign, extent) {
  const [half, width] = [length / 2, Math.min(0.4 * length, 0.09 * extent)];
  const thick = new Vector3().crossVectors(AXIS, back).multiplyScalar(0.004 * extent);
  // Along the edge and back from it.
  const outline = [[1, 0], [-1, 0], [-1, 1], [0.2, 1], [0.75, 0.55]];
  const sides = [1, -1].map((side) => outline.map(([along, depth]) => new Vector3(0, 0, sign * along * half).addScaledVector(back, depth * width).addScaledVector(thick, depth * side)));
  const faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4]].flat();
  const spine = [1, 2, 3].flatMap((k) => [[0, k], [1, k], [1, k + 1], [0, k], [1, k + 1], [0, k + 1]]);
  const points = [...sides.flatMap((side) => faces.map((index) => side[index])), ...spine.map(([side, index]) => sides[side][index])];
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points.flatMap((point) => point.toArray())), 3));
  geometry.computeVertexNormals();
  return geometry;
}
