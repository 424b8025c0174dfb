// Tools as instruments: tips in metal, and behind them shafts with handles.

import { DoubleSide, Group } from "three";
import { handleLooks, metalLooks } from "./looks.js";
import { AXIS, acrossOf, awayOf, turn } from "./poses.js";
import { behind, made } from "./shafts.js";
import { bladeOf, tipOf } from "./tips.js";

/// A tool as it is drawn around its own origin.
export function instrument(tool, centre, extent) {
  const group = new Group();
  const away = awayOf(tool, centre);
  const [metal, grip] = [metalLooks(), handleLooks()];
  for (const part of tool.parts) {
    const isFlat = part.kind === "plane";
    const isEdge = part.kind === "capsule" && part.sizes[0] === 0;
    const posed = new Group();
    turn(posed, part.rotation);
    const straight = away.straight.clone().applyQuaternion(posed.quaternion.clone().invert());
    const look = isFlat ? metalLooks({ side: DoubleSide, transparent: true, opacity: 0.4, depthWrite: false }) : metal;
    const blade = () => bladeOf(part.sizes[1], acrossOf(AXIS, straight), straight.z < 0 ? 1 : -1, extent);
    const mesh = isEdge ? made(blade(), metalLooks({ side: DoubleSide })) : made(tipOf(part, extent), look);
    mesh.position.set(...part.position);
    mesh.quaternion.copy(posed.quaternion);
    mesh.castShadow = !isFlat;
    group.add(mesh);
  }
  for (const mesh of behind(tool.parts, away, { extent, metal, grip })) {
    mesh.castShadow = true;
    group.add(mesh);
  }
  return group;
}

/// Shows a tool in its fine or its plain look.
export function setLook(group, isFine) {
  for (const mesh of group.children) mesh.material = mesh.userData.looks[isFine ? "fine" : "plain"];
}

/// Forgets what the renderer keeps of a tool.
export function forget(group) {
  for (const { geometry, userData } of group.children) [geometry, ...Object.values(userData.looks)].forEach((own) => own.dispose());
}
