// Tools as instruments: tips in metal, and behind them shafts with handles.

import { DoubleSide, Group, Quaternion, Vector3 } from "three";
import { handleLooks, metalLooks } from "./looks.js";
import { AXIS, acrossOf, awayOf, turn } from "./poses.js";
import { behind, made } from "./shafts.js";
import { bladeOf, tipOf } from "./tips.js";

/// A tool as it is drawn around its own origin.
export function instrument(tool, centre, extent) {
  const group = new Group();
  const away = awayOf(tool, centre);
  const [metal, grip] = [metalLooks(), handleLooks()];
  const closes = closedOf(tool);
  tool.parts.forEach((part, number) => {
    const isFlat = part.kind === "plane";
    const isEdge = part.kind === "capsule" && part.sizes[0] === 0;
    const posed = new Group();
    turn(posed, part.rotation);
    const straight = away.straight.clone().applyQuaternion(posed.quaternion.clone().invert());
    const look = isFlat ? metalLooks({ side: DoubleSide, transparent: true, opacity: 0.4, depthWrite: false }) : tipLooks(tool, metal);
    const blade = () => bladeOf(part.sizes[1], acrossOf(AXIS, straight), straight.z < 0 ? 1 : -1, extent);
    const mesh = isEdge ? made(blade(), metalLooks({ side: DoubleSide })) : made(tipOf(part, extent), look);
    mesh.position.set(...part.position);
    mesh.quaternion.copy(posed.quaternion);
    mesh.castShadow = !isFlat;
    if (closes) mesh.userData.poses = { open: { position: mesh.position.clone(), quaternion: mesh.quaternion.clone() }, closed: closes[number] };
    group.add(mesh);
  });
  for (const mesh of behind(tool.parts, away, { extent, metal, grip })) {
    mesh.castShadow = true;
    group.add(mesh);
  }
  return group;
}

/// Closes the parts of a tool that has several, as drawn: jaws go half of the way to each other, blades of scissors the whole.
function closedOf({ parts, added }) {
  if (parts.length !== 2) return null;
  if (added === "scissors") return parts.map(() => ({ position: new Vector3(), quaternion: new Quaternion() }));
  const middle = parts.reduce((sum, { position }) => sum.add(new Vector3(...position)), new Vector3()).multiplyScalar(0.5);
  const posed = new Group();
  return parts.map(({ position, rotation }) => {
    turn(posed, rotation);
    return { position: new Vector3(...position).lerp(middle, 0.5), quaternion: posed.quaternion.clone() };
  });
}

/// Shows jaws and scissors closed by a share.
export function close(group, share) {
  for (const { userData, position, quaternion } of group.children) {
    if (!userData.poses) continue;
    const { open, closed } = userData.poses;
    position.lerpVectors(open.position, closed.position, share);
    quaternion.slerpQuaternions(open.quaternion, closed.quaternion, share);
  }
}

/// What burns is seen to be hot.
const tipLooks = ({ added }, metal) => (added === "burner" ? metalLooks({ color: 0xd9713c }) : metal);

/// Shows a tool in its fine or its plain look.
export function setLook(group, isFine) {
  for (const mesh of group.children) mesh.material = mesh.userData.looks[isFine ? "fine" : "plain"];
}

/// Forgets what the renderer keeps of a tool.
export function forget(group) {
  for (const { geometry, userData } of group.children) [geometry, ...Object.values(userData.looks)].forEach((own) => own.dispose());
}
