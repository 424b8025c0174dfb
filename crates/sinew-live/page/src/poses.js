// Poses and directions of tools.

import { Group, Vector3 } from "three";

/// The axis of rods and blades, and that of a plate's normal.
export const AXIS = new Vector3(0, 0, 1);

/// Shafts lean so much to the side and to the back: one straight behind its tip would hide it from above.
const LEAN = new Vector3(0.12, 0.3, 0);

/// Turns an object by a rotation vector (rad).
export function turn(object, vector) {
  const angle = Math.hypot(...vector);
  if (angle === 0) object.quaternion.identity();
  else object.quaternion.setFromAxisAngle(new Vector3(vector[0] / angle, vector[1] / angle, vector[2] / angle), angle);
}

/// The direction, in a tool, that leads away from the body.
export function awayOf({ start }, centre) {
  const away = new Vector3(...start.slice(0, 3)).sub(centre);
  if (away.lengthSq() < 1e-20) away.copy(AXIS);
  const pose = new Group();
  turn(pose, start.slice(3));
  const back = pose.quaternion.invert();
  return { straight: away.clone().normalize().applyQuaternion(back), leaning: away.normalize().add(LEAN).normalize().applyQuaternion(back) };
}

/// The part of a direction that is at right angles to an axis.
export function acrossOf(axis, direction) {
  const across = direction.clone().addScaledVector(axis, -direction.dot(axis));
  return across.lengthSq() > 1e-8 ? across.normalize() : new Vector3(1, 0, 0).cross(axis).normalize();
}
