// Rotation vectors of tools that a hand turns.

import { Group, Quaternion, Vector3 } from "three";
import { turn } from "./poses.js";

/// A rotation vector (rad) turned on about an axis by an angle (rad). The simulation turns a tool by the short way.
export function turned(vector, axis, angle) {
  const posed = new Group();
  turn(posed, vector);
  const { x, y, z, w } = new Quaternion().setFromAxisAngle(axis, angle).multiply(posed.quaternion);
  const half = new Vector3(x, y, z);
  const sine = half.length();
  return half.multiplyScalar(sine > 0 ? (2 * Math.atan2(sine, w)) / sine : 0).toArray();
}
