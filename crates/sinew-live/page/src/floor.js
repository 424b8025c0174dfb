// The floor under the body: a pool of light that takes its shadow, which plainly is a soft one right below it.

import { CircleGeometry, Mesh, ShaderMaterial, ShadowMaterial } from "three";

/// How far below the lowest point it lies, in terms of the body's size.
const BELOW = 0.004;

/// Radius of the pool of light, and of the soft shadow, in terms of the body's size.
const [POOL, SOFT] = [1.9, 1];

/// A round spot of one brightness that fades to its rim.
const spot = (brightness, opacity, inner) => new ShaderMaterial({
  transparent: true, depthWrite: false,
  vertexShader: "varying vec2 at; void main() { at = 2.0 * uv - 1.0; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
  fragmentShader: `varying vec2 at; void main() { gl_FragColor = vec4(vec3(${brightness}), ${opacity} * smoothstep(1.0, ${inner}, length(at))); }`,
});

export class Floor {
  constructor(scene, { low, high }, extent) {
    this.extent = extent;
    this.dark = window.matchMedia("(prefers-color-scheme: dark)");
    this.pool = new Mesh(new CircleGeometry(POOL * extent, 48), spot("1.0", "0.16", "0.25"));
    this.shade = new Mesh(new CircleGeometry(POOL * extent, 48), new ShadowMaterial({ opacity: 0.22, depthWrite: false }));
    this.shade.receiveShadow = true;
    this.soft = new Mesh(new CircleGeometry(SOFT, 48), spot("0.0", "0.3", "0.35"));
    this.soft.scale.set(0.82 * (high[0] - low[0]) + 0.06 * extent, 0.82 * (high[1] - low[1]) + 0.06 * extent, 1);
    this.parts = [this.pool, this.shade, this.soft];
    this.parts.forEach((part, index) => { part.renderOrder = index - 3; });
    scene.add(...this.parts);
  }

  set(isFine) {
    // A soft shadow is seen on a light ground only.
    this.pool.visible = isFine || this.dark.matches;
    this.shade.visible = isFine;
    this.soft.visible = !isFine;
  }

  /// Puts it under the points of a body.
  follow(points) {
    let [low, x, y] = [Infinity, 0, 0];
    for (let k = 0; k < points.length; k += 3) {
      if (points[k + 2] < low) low = points[k + 2];
      x += points[k];
      y += points[k + 1];
    }
    if (!Number.isFinite(low + x + y)) return;
    const count = points.length / 3;
    for (const part of this.parts) part.position.set(x / count, y / count, low - BELOW * this.extent);
  }
}
