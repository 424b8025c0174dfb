// A blade in the hand: a drag sweeps it through the tissue along the line of sight.

const LEAST = 3;

export class Blade {
  constructor(view, actions) {
    this.view = view;
    this.actions = actions;
    this.isOn = false;
    this.depth = 0.02;
    this.sent = 0;
    this.end();
  }

  /// How far (m) it stands out of the surface, so that it comes through what bulges.
  get out() {
    return 0.25 * this.depth + 0.03 * this.view.extent;
  }

  /// The blade comes down at a place of the page.
  begin(x, y) {
    this.end();
    this.pane = this.actions.paneAt(x);
    this.at = [x, y];
    this.path = [[x, y]];
    this.isDown = true;
    this.actions.path(this.path);
  }

  /// It goes on to another place.
  to(x, y) {
    if (!this.isDown || Math.hypot(x - this.at[0], y - this.at[1]) < LEAST) return;
    const ray = this.view.camera.rayAt(x, y, this.pane);
    // A stroke begins on any part of the tissue, and goes on over its outside: a slit that opens under the blade lets lines of sight through.
    const away = this.view.surfaceAt(ray, this.pane, Boolean(this.from));
    if (away !== null) this.plane = away * ray.direction.dot(this.view.camera.forward());
    // It comes from beside the tissue, or was put on it.
    if (away !== null) this.from ??= this.poseAt(this.view.camera.rayAt(...this.at, this.pane));
    if (this.from) this.onto = this.poseAt(ray);
    this.at = [x, y];
    this.path.push(this.at);
    this.actions.path(this.path);
  }

  /// Both ends on a ray: at the outside of the body or, where it does not meet that, as far away as where the blade was last.
  poseAt(ray) {
    const away = this.view.surfaceAt(ray, this.pane, true) ?? this.plane / ray.direction.dot(this.view.camera.forward());
    return [away - this.out, away + this.depth].map((at) => ray.origin.clone().addScaledVector(ray.direction, at).toArray());
  }

  /// Sends the way since the last stroke where that has been taken: a slow simulation gets fewer and longer ones.
  flush(applied) {
    if (applied >= this.sent) this.send();
  }

  send() {
    if (!this.from || !this.onto) return;
    this.sent = this.actions.cut(this.from, this.onto);
    this.from = this.onto;
    this.onto = null;
  }

  /// It is lifted.
  end() {
    if (this.isDown) this.send();
    this.drop();
  }

  /// It is lifted without a stroke more: the body that it went through is gone.
  drop() {
    if (this.isDown) this.actions.path([]);
    this.isDown = false;
    this.from = null;
    this.onto = null;
    this.plane = this.view.camera.distance;
    this.path = [];
  }
}
