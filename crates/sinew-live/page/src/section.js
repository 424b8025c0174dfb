// A plane that cuts the picture open, not the tissue: one side of it is not drawn, and a cap closes the other.

import {
  BackSide, DecrementWrapStencilOp, DoubleSide, FrontSide, IncrementWrapStencilOp, Mesh, MeshLambertMaterial, NotEqualStencilFunc, Plane, PlaneGeometry, Vector3,
  ZeroStencilOp,
} from "three";
import { INNER, countingLook, wetLooks } from "./looks.js";

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
    this.plane.normal.set(0, 0, 0).setComponent(axis, isTurned ? 1 : -1);
    this.plane.constant = isTurned ? -at : at;
  }

  /// Whether a place is not drawn.
  hides(place) {
    return this.isOn && this.plane.distanceToPoint(place) < 0;
  }
}

/// What closes a body that is cut open: the inside in the colour of cut tissue, since values inside are not known to the page.
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
    this.looks = { ...wetLooks({ color: INNER, ...stencil }), read: new MeshLambertMaterial({ color: INNER, ...stencil }) };
    this.cap = new Mesh(new PlaneGeometry(6 * extent, 6 * extent), this.looks.fine);
    this.cap.renderOrder = 2;
    this.cap.frustumCulled = false;
    scene.add(...this.counting, this.cap);
  }

  /// Follows the plane, in one of the looks of a body; `centre` is in its middle.
  follow(centre, look) {
    const { section, cap } = this;
    for (const mesh of this.counting) {
      mesh.visible = section.isOn;
      mesh.material.clippingPlanes = section.planes;
    }
    cap.visible = section.isOn;
    if (!section.isOn) return;
    cap.material = this.looks[look];
    section.plane.projectPoint(centre, cap.position);
    cap.lookAt(cap.position.clone().sub(section.plane.normal));
  }
}
