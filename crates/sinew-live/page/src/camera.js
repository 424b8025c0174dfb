// The camera: it turns about a place, goes near and far, and shows the body from its sides.

import { PerspectiveCamera, Ray, Vector3 } from "three";

/// Standard views: azimuth and elevation (rad). Front is from where y is least, right from where x is largest.
const QUARTER = Math.PI / 2;
export const SIDES = {
  front: [-QUARTER, 0], back: [QUARTER, 0], left: [2 * QUARTER, 0], right: [0, 0], top: [-QUARTER, QUARTER], bottom: [-QUARTER, -QUARTER],
};

export class Camera {
  constructor(canvas) {
    this.canvas = canvas;
    this.lens = new PerspectiveCamera(32, 1, 0.001, 100);
    this.count = 1;
    this.version = 0;
  }

  /// Looks at a body of this place and size, as at the beginning; `room` is how much is left for tools above it, as a share of its size.
  begin(centre, extent, room) {
    Object.assign(this, { centre, extent, room });
    this.reset();
  }

  /// Leaves more or less room for tools, in the view of now.
  makeRoom(room) {
    this.target.z += 0.4 * (room - this.room) * this.extent;
    this.distance *= (3.3 + 1.6 * room) / (3.3 + 1.6 * this.room);
    this.room = room;
    this.place();
  }

  reset() {
    this.turnTo([-0.95, 0.42]);
    this.target.z += (0.06 + 0.4 * this.room) * this.extent;
    this.place();
  }

  /// Shows the body from one of its sides.
  showSide(name) {
    this.turnTo(SIDES[name]);
    this.place();
  }

  turnTo([azimuth, elevation]) {
    this.azimuth = azimuth;
    this.elevation = elevation;
    this.distance = (3.3 + 1.6 * this.room) * this.extent;
    this.target = this.centre.clone();
  }

  orbit(dx, dy) {
    this.azimuth -= 0.008 * dx;
    this.elevation = Math.min(QUARTER, Math.max(-QUARTER, this.elevation + 0.008 * dy));
    this.place();
  }

  zoom(factor) {
    this.distance = Math.min(12 * this.extent, Math.max(0.45 * this.extent, this.distance * factor));
    this.place();
  }

  /// Moves what is seen by so many pixels, at most a few sizes of the body away.
  pan(dx, dy) {
    const scale = this.metresPerPixel(this.target);
    const { right, up } = this.axes();
    this.target.addScaledVector(right, -dx * scale).addScaledVector(up, dy * scale);
    const away = this.target.clone().sub(this.centre).clampLength(0, 3 * this.extent);
    this.target.copy(this.centre).add(away);
    this.place();
  }

  place() {
    const [c, s] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    const { position } = this.lens;
    position.set(Math.cos(this.azimuth) * c, Math.sin(this.azimuth) * c, s).multiplyScalar(this.distance * this.wide()).add(this.target);
    // Above the body, too, this is at right angles to the line of sight.
    this.lens.up.set(-Math.cos(this.azimuth) * s, -Math.sin(this.azimuth) * s, c);
    this.lens.near = 0.02 * this.distance;
    this.lens.far = 20 * this.distance + 4 * this.extent;
    this.lens.lookAt(this.target);
    this.lens.updateMatrixWorld();
    this.version += 1;
  }

  /// How much further the camera stands where a pane is narrow.
  wide() {
    const aspect = this.canvas.clientWidth / this.count / Math.max(1, this.canvas.clientHeight);
    return Math.max(1, 1.05 / Math.max(0.2, aspect));
  }

  setAspect() {
    this.lens.aspect = this.canvas.clientWidth / this.count / Math.max(1, this.canvas.clientHeight);
    this.lens.updateProjectionMatrix();
    this.lens.updateMatrixWorld();
  }

  /// Directions on the screen, in the world: right and up.
  axes() {
    const [right, up] = [new Vector3(), new Vector3()];
    this.lens.matrixWorld.extractBasis(right, up, new Vector3());
    return { right, up };
  }

  /// Directions in which a hand moves: right, up, away.
  directions() {
    const right = new Vector3(-Math.sin(this.azimuth), Math.cos(this.azimuth), 0);
    const away = new Vector3(-Math.cos(this.azimuth), -Math.sin(this.azimuth), 0);
    const up = new Vector3(0, 0, 1);
    return Math.abs(this.elevation) > 1.1 ? { right, up: away.multiplyScalar(Math.sign(this.elevation)), away: up.multiplyScalar(-Math.sign(this.elevation)) } : { right, up, away };
  }

  /// The direction in which it looks.
  forward() {
    return this.lens.getWorldDirection(new Vector3());
  }

  /// The line of sight at a place of the page (CSS pixels), in a pane.
  rayAt(x, y, pane) {
    this.setAspect();
    const box = this.canvas.getBoundingClientRect();
    const width = this.canvas.clientWidth / this.count;
    const across = (2 * (x - box.left - width * pane)) / width - 1;
    const up = 1 - (2 * (y - box.top)) / this.canvas.clientHeight;
    const { position } = this.lens;
    return new Ray(position.clone(), new Vector3(across, up, 0.5).unproject(this.lens).sub(position).normalize());
  }

  /// Metres for a pixel at a place.
  metresPerPixel(place) {
    const away = this.lens.position.distanceTo(place);
    return (2 * away * Math.tan((this.lens.fov * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
  }

  /// Where a place is on the page (CSS pixels), in a pane.
  project(place, pane = 0) {
    const width = this.canvas.clientWidth / this.count;
    this.setAspect();
    const at = place.clone().project(this.lens);
    const box = this.canvas.getBoundingClientRect();
    return [box.left + width * pane + ((at.x + 1) / 2) * width, box.top + ((1 - at.y) / 2) * this.canvas.clientHeight];
  }
}
