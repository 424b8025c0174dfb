// The tissue and the tools of all panes, by one camera.

import {
  AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, DirectionalLight, DoubleSide, DynamicDrawUsage, Group, HemisphereLight,
  LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, PerspectiveCamera, PlaneGeometry, Ray, Scene, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import { NOT_KNOWN, colourOf } from "./colours.js";

const TABLE = 512;

/// Colours of shares in light as the renderer reckons with it; then that of what is inside out, and of what is not known.
function linearTable() {
  const table = new Float32Array(3 * (TABLE + 2));
  for (let k = 0; k < TABLE; k += 1) colourOf(k / (TABLE - 1), table, 3 * k);
  colourOf(NaN, table, 3 * TABLE);
  colourOf(NOT_KNOWN, table, 3 * (TABLE + 1));
  return table.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
}

function lit(scene) {
  scene.add(new AmbientLight(0xffffff, 1.5));
  scene.add(new HemisphereLight(0xffffff, 0x8a95a0, 0.9));
  const sun = new DirectionalLight(0xffffff, 1.5);
  sun.position.set(-0.6, -1, 1.6);
  scene.add(sun);
  return scene;
}

function geometryOf({ kind, sizes }, extent) {
  if (kind === "sphere") return new SphereGeometry(sizes[0], 40, 28);
  // The edge of a blade has no radius.
  if (kind === "capsule") return new CapsuleGeometry(sizes[0] || 0.005 * extent, sizes[1], 12, 28).rotateX(Math.PI / 2);
  if (kind === "box") return new BoxGeometry(...sizes);
  return new PlaneGeometry(1.6 * extent, 1.6 * extent);
}

function turn(object, vector) {
  const angle = Math.hypot(...vector);
  if (angle === 0) object.quaternion.identity();
  else object.quaternion.setFromAxisAngle(new Vector3(vector[0] / angle, vector[1] / angle, vector[2] / angle), angle);
}

/// One pane: a scene with a body and tools.
class Pane {
  constructor(surface, tools, extent) {
    this.scene = lit(new Scene());
    this.geometry = new BufferGeometry();
    const material = new MeshLambertMaterial({ vertexColors: true, flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.body = new Mesh(this.geometry, material);
    this.body.frustumCulled = false;
    this.edges = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.22 }));
    this.edges.frustumCulled = false;
    this.edges.visible = false;
    this.rim = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0x2b1a12 }));
    this.rim.frustumCulled = false;
    this.scene.add(this.body, this.edges, this.rim);
    this.setSurface(surface);
    this.tools = [];
    this.setTools(tools, extent);
    this.pull = new LineSegments(new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6), 3)), new LineBasicMaterial({ color: 0xd1495b }));
    this.grip = new Mesh(new SphereGeometry(0.028 * extent, 28, 20), new MeshLambertMaterial({ color: 0xd1495b }));
    this.pull.frustumCulled = false;
    this.pull.visible = false;
    this.grip.visible = false;
    this.scene.add(this.pull, this.grip);
  }

  setTools(tools, extent) {
    this.scene.remove(...this.tools);
    for (const { children } of this.tools) children.forEach(({ geometry, material }) => [geometry, material].forEach((own) => own.dispose()));
    this.tools = tools.map((tool) => {
      const group = new Group();
      for (const part of tool.parts) {
        const flat = part.kind === "plane";
        const mesh = new Mesh(geometryOf(part, extent), new MeshLambertMaterial({ color: 0xc9d3dd, side: flat ? DoubleSide : 0, transparent: flat, opacity: flat ? 0.4 : 1 }));
        mesh.position.set(...part.position);
        turn(mesh, part.rotation);
        group.add(mesh);
      }
      this.scene.add(group);
      return group;
    });
  }

  /// Takes the surface of a body that became another one.
  setSurface(surface) {
    const { points, triangles } = surface;
    // The renderer's copies of the one before are forgotten.
    for (const { geometry } of [this.body, this.edges, this.rim]) geometry.dispose();
    this.triangles = triangles;
    this.outer = surface.outer;
    this.positions = new BufferAttribute(new Float32Array(points), 3).setUsage(DynamicDrawUsage);
    this.colours = new BufferAttribute(new Float32Array(points.length), 3).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("position", this.positions);
    this.geometry.setAttribute("color", this.colours);
    this.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.edges.geometry.setAttribute("position", this.positions);
    this.edges.geometry.setIndex(null);
    this.rim.geometry.setAttribute("position", this.positions);
    this.rim.geometry.setIndex(new BufferAttribute(rimOf(surface), 1));
  }

  showEdges(on) {
    if (on && !this.edges.geometry.index) this.edges.geometry.setIndex(new BufferAttribute(edgesOf(this.triangles), 1));
    this.edges.visible = on;
  }
}

/// The edges at which faces of cuts meet the outside of the body.
function rimOf({ triangles, outer }) {
  const keyOf = (k, side) => {
    const [a, b] = [triangles[k + side], triangles[k + ((side + 1) % 3)]];
    return a < b ? a * 4294967296 + b : b * 4294967296 + a;
  };
  const inside = new Set();
  for (let k = 3 * outer; k < triangles.length; k += 3) for (let side = 0; side < 3; side += 1) inside.add(keyOf(k, side));
  const rim = [];
  for (let k = 0; k < 3 * outer && inside.size > 0; k += 3) {
    for (let side = 0; side < 3; side += 1) if (inside.has(keyOf(k, side))) rim.push(triangles[k + side], triangles[k + ((side + 1) % 3)]);
  }
  return new Uint32Array(rim);
}

/// Each edge of triangles once.
function edgesOf(triangles) {
  const seen = new Set();
  const edges = [];
  for (let k = 0; k < triangles.length; k += 3) {
    for (let side = 0; side < 3; side += 1) {
      const a = triangles[k + side];
      const b = triangles[k + ((side + 1) % 3)];
      const key = a < b ? a * 4294967296 + b : b * 4294967296 + a;
      if (!seen.has(key)) {
        seen.add(key);
        edges.push(a, b);
      }
    }
  }
  return new Uint32Array(edges);
}

export class View {
  constructor(canvas, test) {
    this.canvas = canvas;
    this.test = test;
    this.renderer = new WebGLRenderer({ canvas, antialias: !test, alpha: true, preserveDrawingBuffer: test, powerPreference: "high-performance" });
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.autoClear = false;
    this.camera = new PerspectiveCamera(32, 1, 0.001, 100);
    this.camera.up.set(0, 0, 1);
    this.table = linearTable();
    this.panes = [];
    this.count = 1;
    this.showsEdges = false;
    this.dirty = true;
  }

  /// Takes the surfaces of all panes.
  setTopology(topology, tools) {
    const isFirst = !this.topology;
    this.topology = topology;
    this.toolFacts = tools;
    this.panes.forEach((pane, number) => pane.setSurface(topology.surfaces[number] ?? topology.surfaces[0]));
    this.dirty = true;
    if (isFirst) this.begin(topology.surfaces[0]);
  }

  setTools(tools) {
    this.toolFacts = tools;
    this.panes.forEach((pane) => pane.setTools(tools, this.extent));
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
    this.centre = new Vector3(...low.map((value, axis) => (value + high[axis]) / 2));
    this.extent = Math.max(...low.map((value, axis) => high[axis] - value));
    this.setCount(this.count);
    this.resetCamera();
  }

  setCount(count) {
    this.count = count;
    if (!this.topology) return;
    const { surfaces } = this.topology;
    while (this.panes.length < count) this.panes.push(new Pane(surfaces[this.panes.length] ?? surfaces[0], this.toolFacts, this.extent));
    this.dirty = true;
  }

  resetCamera() {
    this.azimuth = -0.95;
    this.elevation = 0.42;
    this.distance = 3.3 * this.extent;
    this.target = this.centre.clone();
    this.target.z += 0.06 * this.extent;
    this.placeCamera();
  }

  orbit(dx, dy) {
    this.azimuth -= 0.008 * dx;
    this.elevation = Math.min(1.5, Math.max(-1.5, this.elevation + 0.008 * dy));
    this.placeCamera();
  }

  zoom(factor) {
    this.distance = Math.min(12 * this.extent, Math.max(0.6 * this.extent, this.distance * factor));
    this.placeCamera();
  }

  placeCamera() {
    const [c, s] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    this.camera.position.set(Math.cos(this.azimuth) * c, Math.sin(this.azimuth) * c, s).multiplyScalar(this.distance * this.wide()).add(this.target);
    this.camera.near = 0.02 * this.distance;
    this.camera.far = 20 * this.distance;
    this.camera.lookAt(this.target);
    this.dirty = true;
  }

  /// How much further the camera stands where a pane is narrow.
  wide() {
    const aspect = this.canvas.clientWidth / this.count / Math.max(1, this.canvas.clientHeight);
    return Math.max(1, 1.05 / Math.max(0.2, aspect));
  }

  /// Directions in which a hand moves on the screen: right, up, away.
  directions() {
    const right = new Vector3(-Math.sin(this.azimuth), Math.cos(this.azimuth), 0);
    const away = new Vector3(-Math.cos(this.azimuth), -Math.sin(this.azimuth), 0);
    const up = new Vector3(0, 0, 1);
    return Math.abs(this.elevation) > 1.1 ? { right, up: away.multiplyScalar(Math.sign(this.elevation)), away: up.multiplyScalar(-Math.sign(this.elevation)) } : { right, up, away };
  }

  /// The line of sight at a place of the page (CSS pixels), in a pane.
  rayAt(x, y, pane) {
    this.setAspect();
    const box = this.canvas.getBoundingClientRect();
    const width = this.canvas.clientWidth / this.count;
    const across = (2 * (x - box.left - width * pane)) / width - 1;
    const up = 1 - (2 * (y - box.top)) / this.canvas.clientHeight;
    const { position } = this.camera;
    return new Ray(position.clone(), new Vector3(across, up, 0.5).unproject(this.camera).sub(position).normalize());
  }

  /// The direction in which the camera looks.
  forward() {
    return this.camera.getWorldDirection(new Vector3());
  }

  /// How far away (m) a line of sight meets the tissue of a pane, or the outside of it alone, without faces of cuts; null where it goes by.
  surfaceAt(ray, number, outsideAlone) {
    const { triangles, positions, outer } = this.panes[number];
    const end = outsideAlone ? 3 * outer : triangles.length;
    const corners = [new Vector3(), new Vector3(), new Vector3()];
    const at = new Vector3();
    let nearest = null;
    for (let k = 0; k < end; k += 3) {
      corners.forEach((corner, side) => corner.fromBufferAttribute(positions, triangles[k + side]));
      if (!ray.intersectTriangle(...corners, true, at)) continue;
      const away = ray.origin.distanceTo(at);
      if (nearest === null || away < nearest) nearest = away;
    }
    return nearest;
  }

  /// Metres for a pixel at a place.
  metresPerPixel(place) {
    const away = this.camera.position.distanceTo(place);
    return (2 * away * Math.tan((this.camera.fov * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
  }

  /// Where a place is on the page (CSS pixels), in a pane.
  project(place, pane = 0) {
    const width = this.canvas.clientWidth / this.count;
    this.setAspect();
    const at = place.clone().project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return [box.left + width * pane + ((at.x + 1) / 2) * width, box.top + ((1 - at.y) / 2) * this.canvas.clientHeight];
  }

  setAspect() {
    this.camera.aspect = this.canvas.clientWidth / this.count / Math.max(1, this.canvas.clientHeight);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /// Shows a pane of a picture; `values` are colours from 0 to `largest`.
  update(number, pane, values, largest) {
    const own = this.panes[number];
    if (own?.positions.array.length !== pane.positions.length) return;
    own.positions.array.set(pane.positions);
    own.positions.needsUpdate = true;
    const out = own.colours.array;
    for (let point = 0; point < values.length; point += 1) {
      const share = values[point] / largest;
      let place = Number.isNaN(share) ? TABLE : Math.max(0, Math.min(TABLE - 1, Math.round(share * (TABLE - 1))));
      if (share === NOT_KNOWN) place = TABLE + 1;
      for (let k = 0; k < 3; k += 1) out[3 * point + k] = this.table[3 * place + k];
    }
    own.colours.needsUpdate = true;
    pane.tools.forEach((tool, index) => {
      own.tools[index]?.position.set(...tool.position);
      if (own.tools[index]) turn(own.tools[index], tool.rotation);
    });
    this.dirty = true;
  }

  /// Shows where a hand pulls at a point, and whereto.
  showPull(number, point, to) {
    const own = this.panes[number];
    if (!own) return;
    const at = new Vector3().fromBufferAttribute(own.positions, point);
    own.grip.position.copy(at);
    own.grip.visible = true;
    own.pull.visible = Boolean(to);
    if (to) {
      own.pull.geometry.attributes.position.array.set([at.x, at.y, at.z, to.x, to.y, to.z]);
      own.pull.geometry.attributes.position.needsUpdate = true;
    }
    this.dirty = true;
  }

  setEdges(on) {
    this.showsEdges = on;
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
      if (this.target) this.placeCamera();
      this.dirty = true;
    }
  }

  draw() {
    this.resize();
    if (!this.dirty || this.panes.length === 0) return false;
    this.dirty = false;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const each = width / this.count;
    this.setAspect();
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    for (let k = 0; k < this.count; k += 1) {
      this.panes[k].showEdges(this.showsEdges);
      this.renderer.setViewport(k * each, 0, each, height);
      this.renderer.setScissor(k * each, 0, each, height);
      this.renderer.render(this.panes[k].scene, this.camera);
    }
    return true;
  }
}
