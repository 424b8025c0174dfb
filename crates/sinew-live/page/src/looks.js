// Materials: wet tissue, metal, handles, and colours that are read. Each has a fine look, by the room as it is mirrored (PMREM), and a plain one, by
// formulas, for computers that draw slowly.

import { Color, MeshBasicMaterial, MeshLambertMaterial, MeshPhysicalMaterial, MeshStandardMaterial } from "three";
import { plainLook } from "./plain.js";
import { UNEVEN_SHADER } from "./room.js";

/// Tissue from outside and where it is cut.
export const OUTER = new Color(0xb35c54);
export const INNER = new Color(0x8c2e2e);

const METAL = 0xb9c0c7;
const HANDLE = 0x2f3a44;

/// The room as fine looks mirror it.
let room = null;

/// Takes the room, before any look is made.
export function mirror(texture) {
  room = texture;
}

const lifted = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };

/// Light that went through the tissue comes back red, most of all where it is seen from the side.
function red(shader) {
  shader.fragmentShader = shader.fragmentShader.replace(
    "#include <emissivemap_fragment>",
    `float aside = 1.0 - saturate(dot(normal, normalize(vViewPosition)));
     totalEmissiveRadiance += diffuseColor.rgb * vec3(0.55, 0.1, 0.08) * (0.08 + 0.5 * aside * aside);`,
  );
}

/// The same for a surface that is uneven, which knows its place in the body at rest.
function redUneven(shader) {
  red(shader);
  shader.vertexShader = shader.vertexShader.replace("void main() {", "attribute vec3 rest;\nvarying vec3 vRest;\nvoid main() {\n  vRest = rest;");
  shader.fragmentShader = shader.fragmentShader.replace("void main() {", `varying vec3 vRest;\n${UNEVEN_SHADER}\nvoid main() {`).replace(
    "#include <normal_fragment_maps>",
    "normal = normalize(normal + (viewMatrix * vec4(unevenAt(vRest), 0.0)).xyz);",
  ).replace("#include <clearcoat_normal_fragment_begin>", "vec3 clearcoatNormal = normal;");
}

/// Both looks of tissue: of one colour, or by its corners' colours.
export function wetLooks(more) {
  const fine = new MeshPhysicalMaterial({ roughness: 0.58, clearcoat: 0.7, clearcoatRoughness: 0.2, envMap: room, ...more });
  fine.onBeforeCompile = more.vertexColors ? redUneven : red;
  return { fine, plain: plainLook("wet", more) };
}

/// Those of a body, with colours that are read: dull, so that no lamp changes them.
export const bodyLooks = () => ({ ...wetLooks({ vertexColors: true, ...lifted }), read: new MeshLambertMaterial({ vertexColors: true, toneMapped: false, ...lifted }) });

export const metalLooks = (more) => ({
  fine: new MeshStandardMaterial({ color: METAL, metalness: 1, roughness: 0.27, envMap: room, ...more }),
  plain: plainLook("metal", { color: METAL, ...more }),
});

/// Handles, which are held.
export const handleLooks = () => ({
  fine: new MeshStandardMaterial({ color: HANDLE, metalness: 0.1, roughness: 0.55, envMap: room }),
  plain: plainLook("dull", { color: HANDLE }),
});

/// Counts, in the stencil, surfaces that a line of sight crosses: what it leaves marks where it is within the body.
export const countingLook = (side, operation) => new MeshBasicMaterial({
  side, colorWrite: false, depthWrite: false, depthTest: false, stencilWrite: true, stencilFunc: 519, stencilFail: operation, stencilZFail: operation, stencilZPass: operation,
});
