// The bodies and the tools of all panes, by one camera.

import {
  BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, NeutralToneMapping, PCFShadowMap, Scene, SphereGeometry, Vector3,
  WebGLRenderer,
} from "three";
import { Body } from "./body.js";
import { Camera } from "./camera.js";
import { Floor } from "./floor.js";
import { close, forget, instrument, setLook } from "./instruments.js";
import { Lights, environmentOf } from "./light.js";
import { mirror } from "./looks.js";
import { turn } from "./poses.js";
import { Cap, Section } from "./section.js";

/// A draw that takes longer (ms) in the fine look leaves too little time for others, and the plain one is shown.
const SLOW = 7;

/// Room above the body for tools, as a share of its size.
const roomFor = (tools) => (tools.length > 0 ? 0.3 : 0);

/// One pane: a scene with a body and tools.
class Pane {
  constructor(surface, tools, { centre, extent, box, section }) {
    Object.assign(this, { centre, extent });
    this.scene = new Scene();
    this.lights = new Lights(this.scene, centre, extent);
    this.floor = new Floor(this.scene, box, extent);
    this.body = new Body(this.scene, surface, extent);
    this.cap = new Cap(this.scene, this.body.geometry, section, extent);
    this.tools = [];
    this.setTools(tools);
    this.pull = new LineSegments(new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6), 3)), new LineBasicMaterial({ color: 0xd1495b }));
    this.grip = new Mesh(new SphereGeometry(0.02 * extent, 28, 20), new MeshLambertMaterial({ color: 0xd1495b, emissive: 0x5a1220 }));
    this.pull.frustumCulled = false;
    this.pull.visible = false;
    this.grip.visible = false;
    this.markedPlace = new Mesh(new SphereGeometry(0.025 * extent, 20, 14), new MeshBasicMaterial({ color: 0xff00dc, transparent: true, opacity: 0.75, depthTest: false }));
    this.markedPlace.renderOrder = 9;
    this.markedPlace.visible = false;
    this.scene.add(this.pull, this.grip, this.markedPlace);
  }

  setTools(tools) {
    this.scene.remove(...this.tools);
    this.tools.forEach(forget);
    this.tools = tools.map((tool) => instrument(tool, this.centre, this.extent));
    if (this.tools.length > 0) this.scene.add(...this.tools);
  }
}

export class View {
  constructor(canvas, test) {
    this.canvas = canvas;
    this.test = test;
    this.renderer = new WebGLRenderer({ canvas, antialias: !test, alpha: true, stencil: true, preserveDrawingBuffer: test, powerPreference: "high-performance" });
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.autoClear = false;
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    mirror(environmentOf(this.renderer));
    this.camera = new Camera(canvas);
    this.section = new Section();
    this.panes = [];
    this.count = 1;
    this.showsEdges = false;
    this.isTissue = true;
    this.isFine = true;
    this.dirty = true;
    this.placed = -1;
  }

  /// Takes the surfaces of all panes.
  setTopology(topology, tools) {
    const isFirst = !this.topology;
    this.topology = topology;
    this.toolFacts = tools;
    this.panes.forEach((pane, number) => pane.body.setSurface(topology.surfaces[number] ?? topology.surfaces[0]));
    this.dirty = true;
    if (isFirst) this.begin(topology.surfaces[0]);
  }

  setTools(tools) {
    this.toolFacts = tools;
    this.panes.forEach((pane) => pane.setTools(tools));
    if (this.topology) this.camera.makeRoom(roomFor(tools));
    this.dirty = true;
  }

  /// Size and place of the body, as cameras and blades take them for the whole session.
  begin({ points }) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    points.forEach((value, index) => {
      low[index % 3] = Math.min(low[index % 3], value);
      high[index % 3] = Math.max(high[index % 3], value);
    });
    this.box = { low, high };
    this.centre = new Vector3(...low.map((value, axis) => (value + high[axis]) / 2));
    this.extent = Math.max(...low.map((value, axis) => high[axis] - value));
    this.camera.begin(this.centre, this.extent, roomFor(this.toolFacts));
    this.setCount(this.count);
    this.setFine(this.timeOfDraws() < SLOW);
  }

  setCount(count) {
    this.count = count;
    this.camera.count = count;
    if (!this.topology) return;
    const { surfaces } = this.topology;
    while (this.panes.length < count) {
      this.panes.push(new Pane(surfaces[this.panes.length] ?? surfaces[0], this.toolFacts, this));
      this.panes.at(-1).body.open(this.section.planes);
    }
    this.dirty = true;
  }

  /// How far away (m) a line of sight meets the tissue of a pane that is drawn, or the outside of it alone, without faces of cuts; null where it goes by.
  surfaceAt(ray, number, outsideAlone) {
    const { triangles, points, outer } = this.panes[number].body;
    const end = outsideAlone ? 3 * outer : triangles.length;
    const corners = [new Vector3(), new Vector3(), new Vector3()];
    const at = new Vector3();
    let nearest = null;
    for (let k = 0; k < end; k += 3) {
      corners.forEach((corner, side) => corner.fromArray(points, 3 * triangles[k + side]));
      if (!ray.intersectTriangle(...corners, true, at) || this.section.hides(at)) continue;
      const away = ray.origin.distanceTo(at);
      if (nearest === null || away < nearest) nearest = away;
    }
    return nearest;
  }

  /// Shows a pane of a picture; without a scale as tissue, where values tell only what is inside out.
  update(number, pane, values, scale) {
    const own = this.panes[number];
    if (own?.body.points.length !== pane.positions.length) return;
    own.body.move(pane.positions);
    this.isTissue = scale === null;
    if (scale) own.body.paint(values, scale);
    else own.body.paintTissue(values);
    own.cap.paint(pane.section, scale);
    own.floor.follow(pane.positions);
    pane.tools.forEach((tool, index) => {
      own.tools[index]?.position.set(...tool.position);
      if (own.tools[index]) turn(own.tools[index], tool.rotation);
    });
    this.dirty = true;
  }

  /// Marks a place (m) in all panes, or none (null).
  mark(place) {
    for (const { markedPlace } of this.panes) {
      markedPlace.visible = Boolean(place);
      if (place) markedPlace.position.fromArray(place);
    }
    this.dirty = true;
  }

  /// Shows a tool closed by a share, in all panes.
  closeTool(number, share) {
    for (const { tools } of this.panes) {
      if (tools[number] && tools[number].userData.closed !== share) {
        close(tools[number], share);
        tools[number].userData.closed = share;
        this.dirty = true;
      }
    }
  }

  /// Shows where tissue is gripped, if it is, and whereto it is pulled from this page.
  showPull(number, place, to) {
    const own = this.panes[number];
    if (!own || (!place && !own.grip.visible)) return;
    own.grip.visible = Boolean(place);
    own.pull.visible = Boolean(place && to);
    if (place) own.grip.position.fromArray(place);
    if (own.pull.visible) {
      own.pull.geometry.attributes.position.array.set([...place, to.x, to.y, to.z]);
      own.pull.geometry.attributes.position.needsUpdate = true;
    }
    this.dirty = true;
  }

  /// Time (ms) of a draw in the fine look, the least of three.
  timeOfDraws() {
    const gl = this.renderer.getContext();
    const pixel = new Uint8Array(4);
    let least = Infinity;
    for (let number = 0; number < 4; number += 1) {
      const begun = performance.now();
      this.dirty = true;
      this.draw();
      // What was drawn is known when it is done.
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      // The first one compiles.
      if (number > 0) least = Math.min(least, performance.now() - begun);
    }
    return least;
  }

  /// Shows shadows and the mirrored room, or the plain look.
  setFine(on) {
    this.isFine = on;
    this.dirty = true;
  }

  setEdges(on) {
    this.showsEdges = on;
    this.dirty = true;
  }

  /// Cuts the picture open across an axis, or closes it (null).
  setSection(axis, share, isTurned) {
    this.section.set(axis, share, isTurned, this.box);
    this.renderer.localClippingEnabled = this.section.isOn;
    for (const { body } of this.panes) body.open(this.section.planes);
    this.dirty = true;
  }

  resize() {
    const ratio = this.test ? 1 : Math.min(window.devicePixelRatio || 1, 2);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const size = `${width} ${height} ${ratio} ${this.count}`;
    if (size !== this.size && width > 0 && height > 0) {
      this.size = size;
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      if (this.topology) this.camera.place();
      this.dirty = true;
    }
  }

  /// The picture, four bytes a pixel; only where its buffer is kept, as in tests.
  pixels() {
    const gl = this.renderer.getContext();
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return pixels;
  }

  draw() {
    this.resize();
    if (this.panes.length === 0 || !(this.dirty || this.placed !== this.camera.version)) return false;
    this.dirty = false;
    this.placed = this.camera.version;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const each = width / this.count;
    this.camera.setAspect();
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    for (let k = 0; k < this.count; k += 1) {
      const { scene, body, cap, lights, floor, tools } = this.panes[k];
      const wet = this.isFine ? "fine" : "plain";
      const look = this.isTissue ? wet : "read";
      body.showEdges(this.showsEdges);
      body.mesh.material = body.looks[look];
      body.mesh.receiveShadow = this.isTissue;
      cap.follow(this.centre, look);
      lights.set(this.isTissue, this.isFine);
      floor.set(this.isFine);
      for (const tool of tools) setLook(tool, this.isFine);
      this.renderer.setViewport(k * each, 0, each, height);
      this.renderer.setScissor(k * each, 0, each, height);
      this.renderer.render(scene, this.camera.lens);
    }
    return true;
  }
}
