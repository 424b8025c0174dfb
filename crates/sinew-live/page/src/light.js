// Light: a room with lamps that is made here, and a sun with one soft shadow.

import {
  AmbientLight, BackSide, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PMREMGenerator, PlaneGeometry, Scene, SphereGeometry, BufferAttribute,
} from "three";
import { LAMPS, WALLS } from "./room.js";

function room() {
  const scene = new Scene();
  const walls = new SphereGeometry(12, 32, 24).rotateX(Math.PI / 2);
  const { position } = walls.attributes;
  const colours = new Float32Array(3 * position.count);
  for (let k = 0; k < position.count; k += 1) {
    const height = Math.max(-1, Math.min(1, position.getZ(k) / 8));
    const [from, to, share] = height < 0 ? [WALLS[0], WALLS[1], height + 1] : [WALLS[1], WALLS[2], height];
    for (let part = 0; part < 3; part += 1) colours[3 * k + part] = from[part] + share * (to[part] - from[part]);
  }
  walls.setAttribute("color", new BufferAttribute(colours, 3));
  scene.add(new Mesh(walls, new MeshBasicMaterial({ vertexColors: true, side: BackSide })));
  for (const [place, size, brightness] of LAMPS) {
    const lamp = new Mesh(new PlaneGeometry(...size), new MeshBasicMaterial({ color: new Color().setScalar(brightness), side: 2 }));
    lamp.position.set(...place);
    lamp.lookAt(0, 0, 0);
    scene.add(lamp);
  }
  return scene;
}

/// The room as shiny surfaces mirror it: colours that are read must not, so that it belongs to materials and not to scenes.
export function environmentOf(renderer) {
  const generator = new PMREMGenerator(renderer);
  const made = room();
  const { texture } = generator.fromScene(made, 0.03);
  made.traverse(({ geometry, material }) => [geometry, material].forEach((own) => own?.dispose()));
  generator.dispose();
  return texture;
}

/// The lights of a scene.
export class Lights {
  constructor(scene, centre, extent) {
    this.sun = new DirectionalLight(0xffffff, 1.5);
    this.sun.position.set(-0.6, -1, 1.6).multiplyScalar(1.5 * extent).add(centre);
    this.sun.target.position.copy(centre);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 5;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.005 * extent;
    const reach = 1.25 * extent;
    Object.assign(this.sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.5 * extent, far: 6 * extent });
    // Colours that are read need light from all sides, and together with the sun no more than a screen can show.
    this.even = [new AmbientLight(0xffffff, 1.5), new HemisphereLight(0xffffff, 0x8a95a0, 0.6)];
    this.even[1].position.set(0, 0, 1);
    scene.add(this.sun, this.sun.target, ...this.even);
  }

  /// For tissue, or for colours that are read; with a shadow and the mirrored room, or plain.
  set(isTissue, isFine) {
    const [everywhere, sky] = this.even;
    everywhere.visible = !isTissue;
    sky.visible = !isTissue;
    this.sun.castShadow = isFine;
    this.sun.intensity = isTissue ? 1.45 : 1;
  }
}
