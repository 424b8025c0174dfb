// The plain look: light on the corners of a surface and what its pixels mirror, by formulas that cost little where a processor draws.

import { Color, ShaderMaterial } from "three";
import { ROOM_SHADER, UNEVEN_SHADER } from "./room.js";

const VERTEX = `
#include <clipping_planes_pars_vertex>
uniform vec3 base;
varying vec3 vLit;
varying vec3 vOut;
varying vec3 vSight;
#ifdef BY_CORNERS
attribute vec3 color;
attribute vec3 rest;
${UNEVEN_SHADER}
#endif
void main() {
  vec4 place = modelMatrix * vec4(position, 1.0);
  vec4 mvPosition = viewMatrix * place;
  vec3 own = base;
  vOut = normalize(mat3(modelMatrix) * normal);
  #ifdef BY_CORNERS
  own = color;
  vOut += unevenAt(rest);
  #endif
  vSight = cameraPosition - place.xyz;
  // The sky, what the floor gives back, and a sun that reaches a little around.
  vec3 light = mix(vec3(0.3, 0.26, 0.25), vec3(0.7, 0.71, 0.74), 0.5 + 0.5 * vOut.z);
  vLit = own * (light + 0.52 * max(0.0, (dot(vOut, vec3(-0.303, -0.505, 0.808)) + 0.18) / 1.18));
  #include <clipping_planes_vertex>
  gl_Position = projectionMatrix * mvPosition;
}`;

/// Words for the light of a pixel, from `lit`, the light on it, `aside`, how much it is seen from the side, and `mirrored`.
const SURFACES = {
  wet: "lit * (1.0 + vec3(0.75, 0.14, 0.1) * (0.1 + 0.6 * aside * aside)) + mirrored * (0.03 + 0.26 * aside * aside * aside)",
  metal: "(base * 0.76 * mirrored + 0.34 * lit) * (1.1 - 0.6 * aside)",
  dull: "lit + 0.03 * mirrored",
};

const fragment = (surface) => `
#include <clipping_planes_pars_fragment>
uniform vec3 base;
varying vec3 vLit;
varying vec3 vOut;
varying vec3 vSight;
uniform float opacity;
${ROOM_SHADER}
void main() {
  #include <clipping_planes_fragment>
  vec3 lit = vLit;
  vec3 outward = normalize(gl_FrontFacing ? vOut : -vOut);
  vec3 sight = normalize(vSight);
  float facing = dot(outward, sight);
  float aside = 1.0 - max(facing, 0.0);
  vec3 mirrored = roomAt(2.0 * facing * outward - sight);
  // The root is near to the curve of screens.
  gl_FragColor = vec4(sqrt(min(${SURFACES[surface]}, 1.0)), opacity);
}`;

/// A plain material: "wet", "metal" or "dull", of a colour or, with `vertexColors`, of those of its corners.
export function plainLook(surface, { color, vertexColors, opacity, ...more }) {
  return new ShaderMaterial({
    vertexShader: VERTEX, fragmentShader: fragment(surface), clipping: true, defines: vertexColors ? { BY_CORNERS: "" } : {},
    uniforms: { base: { value: new Color(color ?? 0xffffff) }, opacity: { value: opacity ?? 1 } }, ...more,
  });
}
