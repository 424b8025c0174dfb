// Shafts and handles of tools, which are drawn only.

import { CylinderGeometry, Group, LatheGeometry, Mesh, SphereGeometry, Vector2, Vector3 } from "three";
import { AXIS, acrossOf, turn } from "./poses.js";

const UP = new Vector3(0, 1, 0);

/// Sizes of shafts and handles, in terms of the body's size.
const [SHAFT, HANDLE] = [0.5, 0.36];

/// A mesh with a fine and a plain look.
export function made(geometry, looks) {
  const mesh = new Mesh(geometry, looks.fine);
  mesh.userData.looks = looks;
  return mesh;
}

/// A round bar along an axis, from a place on, with radii at both ends.
function bar(place, axis, length, [from, to], material) {
  const mesh = made(new CylinderGeometry(to, from, length, 28), material);
  mesh.position.copy(place).addScaledVector(axis, length / 2);
  mesh.quaternion.setFromUnitVectors(UP, axis);
  return mesh;
}

/// A handle with a waist and rings.
function handle(place, axis, radius, length, material) {
  const profile = [[0, 0], [0.7, 0], [0.95, 0.03], [0.72, 0.08], [0.72, 0.1], [0.95, 0.14], [0.72, 0.19], [0.82, 0.3], [1, 0.55], [0.96, 0.85], [0.7, 0.97], [0, 1]];
  const mesh = made(new LatheGeometry(profile.map(([x, y]) => new Vector2(radius * x, length * y)), 32), material);
  mesh.position.copy(place);
  mesh.quaternion.setFromUnitVectors(UP, axis);
  return mesh;
}

/// A bar with a handle at its end, which is so wide.
function gripped(place, axis, length, radii, wide, { extent, metal, grip }) {
  const end = place.clone().addScaledVector(axis, length);
  return [bar(place, axis, length, radii, metal), handle(end, axis, wide, HANDLE * extent, grip)];
}

/// Arms from the ends of several parts to one shaft, as jaws have them.
function fork(parts, away, kit) {
  const { extent, metal } = kit;
  const posed = new Group();
  const ends = parts.map((part) => {
    turn(posed, part.rotation);
    const axis = AXIS.clone().applyQuaternion(posed.quaternion);
    const length = part.kind === "capsule" ? part.sizes[1] : 0;
    return new Vector3(...part.position).addScaledVector(axis, 0.5 * length * (axis.dot(away.straight) < 0 ? -1 : 1));
  });
  const { kind, sizes } = parts[0];
  const radius = Math.max(0.7 * (kind === "box" ? 0.4 * Math.min(...sizes) : sizes[0] || 0), 0.012 * extent);
  const middle = ends.reduce((sum, end) => sum.add(end), new Vector3()).divideScalar(ends.length);
  const yoke = middle.addScaledVector(away.straight, 0.16 * extent);
  const arms = ends.map((end) => {
    const way = yoke.clone().sub(end);
    const length = way.length();
    return bar(end, way.divideScalar(length), length, [radius, 0.8 * radius], metal);
  });
  const joint = made(new SphereGeometry(1.35 * radius, 20, 14), metal);
  joint.position.copy(yoke);
  const wide = Math.max(1.9 * radius, 0.034 * extent);
  return [...arms, joint, ...gripped(yoke, away.straight, 0.6 * SHAFT * extent, [radius, radius], wide, kit)];
}

/// Behind a part that is alone, or behind several; `kit` has the size of the body and the looks of metal and handles.
export function behind(parts, away, kit) {
  if (parts.length > 1) return fork(parts, away, kit);
  const { extent, metal } = kit;
  const [{ kind, sizes, position, rotation }] = parts;
  const middle = new Vector3(...position);
  const posed = new Group();
  turn(posed, rotation);
  const axis = AXIS.clone().applyQuaternion(posed.quaternion);
  // The inside of a plate is below it.
  if (kind === "plane") return gripped(middle, axis.negate(), 0.3 * extent, [0.035 * extent, 0.03 * extent], 0.06 * extent, kit);
  if (kind === "capsule") {
    const [radius, length] = sizes;
    if (axis.dot(away.straight) < 0) axis.negate();
    const end = middle.addScaledVector(axis, 0.5 * length);
    // A rod is its own shaft.
    if (radius > 0) return gripped(end, axis, 0.45 * SHAFT * extent, [radius, radius], Math.max(1.35 * radius, 0.022 * extent), kit);
    const spine = end.addScaledVector(axis, -0.05 * length).addScaledVector(acrossOf(axis, away.straight), Math.min(0.2 * length, 0.045 * extent));
    return gripped(spine, axis, 0.2 * extent, [0.012 * extent, 0.018 * extent], 0.03 * extent, kit);
  }
  // A seat on a block, or on a ball.
  const size = kind === "sphere" ? sizes[0] : 0.5 * Math.min(...sizes);
  const thin = Math.min(Math.max(0.26 * size, 0.008 * extent), 0.03 * extent);
  const seat = bar(middle, away.leaning, 1.28 * size * (kind === "box" ? Math.SQRT2 : 1), [1.9 * thin, 1.15 * thin], metal);
  return [seat, ...gripped(middle, away.leaning, SHAFT * extent, [thin, thin], Math.max(1.9 * thin, 0.034 * extent), kit)];
}
