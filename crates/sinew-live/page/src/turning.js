// Rotation vectors of tools that a hand turns.

import { Quaternion, Vector3 } from "three";

const quaternionOf = ([x, y, z]) => {
  const angle = Math.hypot(x, y, z);
  return angle === 0 ? new Quaternion() : new Quaternion().setFromAxisAngle(new Vector3(x, y, z).divideScalar(angle), angle);
};

/// A rotation vector (rad) turned on about an axis by an angle (rad). Of all vectors of the same rotation it is the one
/// nearest to the former: a tool that is led straight between them does not turn back by a whole turn.
export function turned(vector, axis, angle) {
  const rotation = new Quaternion().setFromAxisAngle(axis, angle).multiply(quaternionOf(vector));
  const half = new Vector3(rotation.x, rotation.y, rotation.z);
  const sine = half.length();
  const before = new Vector3(...vector);
  // No rotation has every axis: that of before, or none.
  const unit = sine > 1e-12 ? half.divideScalar(sine) : before.clone().normalize();
  const least = 2 * Math.atan2(sine, rotation.w);
  const turns = Math.round((before.dot(unit) - least) / (2 * Math.PI));
  return unit.multiplyScalar(least + 2 * Math.PI * turns).toArray();
}
