// A plane that cuts the picture open, not the tissue: one side of it is not drawn, and a cap closes the other.

import {
  BackSide, BufferAttribute, BufferGeometry, DecrementWrapStencilOp, DoubleSide, FrontSide, IncrementWrapStencilOp, Mesh, MeshLambertMaterial, NotEqualStencilFunc, Plane, PlaneGeometry, Vector3,
  ZeroStencilOp,
} from "three";
import { INNER, countingLook, wetLooks } from "./looks.js";

/// The inside where values are not known, the grey of such values.
const NO_VALUES = 0x8a949e;

/// The plane, which all panes have in common.
export class Section {
  constructor() {
    this.plane = new Plane(new Vector3(1, 0, 0), 0);
    this.axis = null;
    this.isTurned = false;
  }

  get isOn() {
    return this.axis !== null;
  }

  /// Planes of materials.
  get planes() {
    return this.isOn ? [this.plane] : [];
  }

  /// Stands across an axis (0, 1, 2), or nowhere (null), at a share of the way through a box; what is on the side of `isTurned` is hidden.
  set(axis, share, isTurned, { low, high }) {
    Object.assign(this, { axis, isTurned });
    if (axis === null) return;
    const at = low[axis] + share * (high[axis] - low[axis]);
    this.at = at;
    this.plane.normal.set(0, 0, 0).setComponent(axis, isTurned ? 1 : -1);
    this.plane.constant = isTurned ? -at : at;
  }

  /// Whether a place is not drawn.
  hides(place) {
    return this.isOn && this.plane.distanceToPoint(place) < 0;
  }
}

/// What closes a body that is cut open: the inside in the colour of cut tissue, or values of the field that is shown, where the simulation sent them.
export class Cap {
  constructor(scene, geometry, section, extent) {
    this.section = section;
    this.counting = [[BackSide, IncrementWrapStencilOp], [FrontSide, DecrementWrapStencilOp]].map(([side, operation]) => {
      const mesh = new Mesh(geometry, countingLook(side, operation));
      mesh.frustumCulled = false;
      mesh.renderOrder = 1;
      return mesh;
    });
    const stencil = {
      side: DoubleSide, stencilWrite: true, stencilRef: 0, stencilFunc: NotEqualStencilFunc, stencilFail: ZeroStencilOp, stencilZFail: ZeroStencilOp, stencilZPass: ZeroStencilOp,
    };
    this.looks = { ...wetLooks({ color: INNER, ...stencil }), read: new MeshLambertMaterial({ color: NO_VALUES, toneMapped: false, ...stencil }) };
    this.cap = new Mesh(new PlaneGeometry(6 * extent, 6 * extent), this.looks.fine);
    this.cap.renderOrder = 2;
    this.cap.frustumCulled = false;
    this.field = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ vertexColors: true, toneMapped: false, side: DoubleSide, flatShading: true }));
    this.field.frustumCulled = false;
    this.field.visible = false;
    scene.add(...this.counting, this.cap, this.field);
  }

  /// Shows the values of a section that a picture brought, if it is the one that is shown here.
  paint({ axis, at, positions, colours }, scale) {
    const { section, field } = this;
    this.hasValues = scale !== null && section.isOn && axis === section.axis && colours.length > 0 && Math.abs(at - section.at) < 1e-9;
    if (!this.hasValues) return;
    const painted = new Float32Array(positions.length);
    colours.forEach((value, corner) => scale.paint(value, painted, 3 * corner));
    field.geometry.dispose();
    field.geometry = new BufferGeometry();
    field.geometry.setAttribute("position", new BufferAttribute(positions, 3));
    field.geometry.setAttribute("color", new BufferAttribute(painted, 3));
  }

  /// Follows the plane, in one of the looks of a body; `centre` is in its middle.
  follow(centre, look) {
    const { section, cap } = this;
    for (const mesh of this.counting) {
      mesh.visible = section.isOn;
      mesh.material.clippingPlanes = section.planes;
    }
    const hasValues = section.isOn && look === "read" && Boolean(this.hasValues);
    cap.visible = section.isOn && !hasValues;
    this.field.visible = hasValues;
    if (!section.isOn) return;
    cap.material = this.looks[look];
    section.plane.projectPoint(centre, cap.position);
    cap.lookAt(cap.position.clone().sub(section.plane.normal));
  }
}
