// The room in which the body lies, as formulas: brightness of its walls, place and size of its lamps, and how unevenly tissue mirrors them.

/// Lamps: place, size, brightness.
export const LAMPS = [
  [[-2.5, -3, 7], [3.2, 3.2], 9],
  [[5, -1.5, 4.5], [2.2, 3.4], 5],
  [[-6, 2, 2.5], [2.6, 4], 2.6],
  [[1.5, 7, 3], [5, 2], 2.2],
];

/// Brightness of the walls at the floor, at the height of the eyes, at the ceiling.
export const WALLS = [[0.2, 0.18, 0.17], [0.52, 0.53, 0.56], [0.86, 0.88, 0.92]];

const vector = (values) => `vec3(${values.map((value) => value.toFixed(4)).join(", ")})`;

/// How a lamp is seen in a direction, with soft edges, where one looks at it by a formula.
function lampInWords([place, size, brightness]) {
  const away = Math.hypot(...place);
  const angle = Math.atan(Math.hypot(...size) / 2.4 / away);
  const to = vector(place.map((value) => value / away));
  return `light += ${(0.8 * brightness).toFixed(2)} * smoothstep(${Math.cos(1.5 * angle).toFixed(4)}, ${Math.cos(0.6 * angle).toFixed(4)}, dot(to, ${to}));`;
}

/// What a direction of the world sees, in the language of shaders.
export const ROOM_SHADER = `
vec3 roomAt(vec3 to) {
  vec3 light = mix(${vector(WALLS[1])}, to.z < 0.0 ? ${vector(WALLS[0])} : ${vector(WALLS[2])}, min(abs(1.5 * to.z), 1.0));
  ${LAMPS.map(lampInWords).join("\n  ")}
  return light;
}
`;

/// By what the direction of a wet surface differs at a place of the body at rest, in parts of the body's size: nothing in a body is quite even.
export const UNEVEN_SHADER = `
vec3 unevenAt(vec3 at) {
  vec3 askew = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6) * at;
  vec3 wide = sin(23.0 * askew + 2.6 * sin(14.0 * at.yzx + 1.0));
  return 0.018 * wide + 0.012 * sin(71.0 * at.zxy + 3.1 * wide + 40.0 * askew);
}
`;
