// A body as it is drawn: its surface, its mesh, the lips of its cuts.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments, Mesh } from "three";
import { Corners } from "./corners.js";
import { Lips, rimOf } from "./lips.js";
import { INNER, OUTER, bodyLooks } from "./looks.js";

/// Magenta, as in the tables of colours, for what is inside out.
const INSIDE_OUT = [1, 0, 0.716];

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

/// Slow waves through the body at rest, from about -1 to 1: tissue is nowhere of one colour.
function mottled(points, point, extent) {
  const [x, y, z] = [0, 1, 2].map((axis) => (11 * points[3 * point + axis]) / extent);
  const wave = (a, b, c, d) => Math.sin(a * x + b * y + c * z + d);
  return 0.4 * wave(1, 0.4, -0.7, 0.3) * wave(-0.3, 1.1, 0.6, 1.9) + 0.35 * wave(2.1, -1.7, 0.9, 4) * wave(0.8, 1.9, -2.3, 2) + 0.25 * wave(4.3, 3.1, -3.7, 1) * wave(-3.3, 4.1, 2.9, 5);
}

const drawnOften = (array, size) => new BufferAttribute(array, size).setUsage(DynamicDrawUsage);

export class Body {
  constructor(scene, surface, extent) {
    this.extent = extent;
    this.geometry = new BufferGeometry();
    this.looks = bodyLooks();
    this.mesh = new Mesh(this.geometry, this.looks.fine);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.mesh.renderOrder = 3;
    this.edges = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.22 }));
    this.edges.visible = false;
    this.rim = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0x4a0f10, transparent: true, opacity: 0.7 }));
    this.edges.renderOrder = 4;
    this.rim.renderOrder = 4;
    for (const part of [this.mesh, this.edges, this.rim]) part.frustumCulled = false;
    scene.add(this.mesh, this.edges, this.rim);
    this.setSurface(surface);
  }

  /// Takes the surface of a body that became another one.
  setSurface(surface) {
    // The renderer's copies of the one before are forgotten.
    for (const { geometry } of [this.mesh, this.edges, this.rim]) geometry.dispose();
    this.triangles = surface.triangles;
    this.outer = surface.outer;
    const count = surface.points.length / 3;
    /// Where the points are.
    this.points = new Float32Array(surface.points);
    this.corners = new Corners(surface);
    const { corners } = this;
    const rim = rimOf(surface);
    const creased = corners.creased(count);
    this.lips = rim.length > 0 ? new Lips(surface, rim, (point) => creased[point] === 1) : null;
    this.tissue = new Float32Array(3 * corners.from.length);
    corners.from.forEach((point, corner) => {
      const { r, g, b } = corners.isInner[corner] ? INNER : OUTER;
      const wave = mottled(surface.points, point, this.extent);
      this.tissue.set([r * (1 + 0.14 * wave), g * (1 + 0.26 * wave), b * (1 + 0.2 * wave)], 3 * corner);
    });
    this.shown = drawnOften(new Float32Array(3 * count), 3);
    this.positions = drawnOften(corners.positions, 3);
    this.normals = drawnOften(corners.normals, 3);
    this.colours = drawnOften(this.tissue.slice(), 3);
    this.isPlain = true;
    this.geometry.setAttribute("position", this.positions);
    this.geometry.setAttribute("normal", this.normals);
    this.geometry.setAttribute("color", this.colours);
    const rest = new Float32Array(3 * corners.from.length);
    corners.from.forEach((point, corner) => { for (let axis = 0; axis < 3; axis += 1) rest[3 * corner + axis] = surface.points[3 * point + axis] / this.extent; });
    this.geometry.setAttribute("rest", new BufferAttribute(rest, 3));
    this.geometry.setIndex(new BufferAttribute(corners.triangles, 1));
    this.edges.geometry.setAttribute("position", this.shown);
    this.edges.geometry.setIndex(null);
    this.rim.geometry.setAttribute("position", this.shown);
    this.rim.geometry.setIndex(new BufferAttribute(rim, 1));
    this.move(this.points);
  }

  /// Takes the places of the points. Where its mesh is shown, cuts are drawn with their steps.
  move(points) {
    this.points.set(points);
    this.shown.array.set(points);
    if (this.lips && !this.edges.visible) this.lips.smooth(this.shown.array);
    this.corners.move(this.shown.array);
    for (const changed of [this.shown, this.positions, this.normals]) changed.needsUpdate = true;
  }

  /// Shows its mesh, or does not.
  showEdges(on) {
    if (on === this.edges.visible) return;
    if (on && !this.edges.geometry.index) this.edges.geometry.setIndex(new BufferAttribute(edgesOf(this.triangles), 1));
    this.edges.visible = on;
    this.move(this.points);
  }

  /// Shows tissue; values that are not numbers mark what is inside out.
  paintTissue(values) {
    const { from } = this.corners;
    let isPlain = true;
    for (let point = 0; isPlain && point < values.length; point += 1) isPlain = !Number.isNaN(values[point]);
    if (isPlain && this.isPlain) return;
    const out = this.colours.array;
    out.set(this.tissue);
    if (!isPlain) for (let corner = 0; corner < from.length; corner += 1) if (Number.isNaN(values[from[corner]])) out.set(INSIDE_OUT, 3 * corner);
    this.isPlain = isPlain;
    this.colours.needsUpdate = true;
  }

  /// Shows values of the points as colours.
  paint(values, scale) {
    const { from } = this.corners;
    const out = this.colours.array;
    for (let corner = 0; corner < from.length; corner += 1) scale.paint(values[from[corner]], out, 3 * corner);
    this.isPlain = false;
    this.colours.needsUpdate = true;
  }

  /// Is cut open by planes.
  open(planes) {
    for (const { material } of [this.edges, this.rim]) material.clippingPlanes = planes;
    for (const look of Object.values(this.looks)) {
      look.clippingPlanes = planes;
      look.clipShadows = true;
    }
  }
}
