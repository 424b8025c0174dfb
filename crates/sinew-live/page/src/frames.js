// Binary messages, little-endian, as crates/sinew-live/src/protocol/frame.rs writes them.

const HEAD = 32;
const PANE = 240;
const TOOL = 136;

/// Fields in the order of their numbers.
const FIELDS = ["stress", "strain", "displacement", "energy_density", "saturated", "pressure", "step_limit"];

/// Stands for a point that the other pane's surface does not have.
export const NO_TWIN = 0xffffffff;

/// The kind of a message: 0 a topology, 1 a picture.
export const kindOf = (buffer) => (buffer.byteLength >= 4 ? new DataView(buffer).getUint32(0, true) : -1);

export function readTopology(buffer) {
  const view = new DataView(buffer);
  const topology = { epoch: view.getUint32(4, true), surfaces: [] };
  let at = 16;
  for (let pane = 0; pane < view.getUint32(8, true); pane += 1) {
    const points = view.getUint32(at, true);
    const triangles = view.getUint32(at + 4, true);
    const outer = view.getUint32(at + 8, true);
    at += 16;
    topology.surfaces.push({
      points: new Float32Array(buffer, at, 3 * points),
      triangles: new Uint32Array(buffer, at + 12 * points, 3 * triangles),
      // Those behind are faces of cuts.
      outer,
      twins: new Uint32Array(buffer, at + 12 * (points + triangles), points),
    });
    at = Math.ceil((at + 16 * points + 12 * triangles) / 8) * 8;
  }
  return topology;
}

export function readPicture(buffer) {
  const view = new DataView(buffer);
  const u32 = (at) => view.getUint32(at, true);
  const f64 = (at) => view.getFloat64(at, true);
  const picture = { bytes: buffer.byteLength, frame: u32(4), applied: u32(8), epoch: u32(12), field: FIELDS[u32(20)], pace: f64(24), panes: [] };
  let at = HEAD;
  for (let pane = 0; pane < u32(16); pane += 1) {
    const names = ["t", "dt", "kinetic", "elastic", "toolWork", "loadWork", "msPerStep", "error", "lag", "saturated", "settling"];
    const numbers = { step: Number(view.getBigUint64(at, true)) };
    names.forEach((name, index) => { numbers[name] = f64(at + 8 + 8 * index); });
    const counts = ["lights", "reasons", "inverted", "contacts", "points", "tools"];
    counts.forEach((name, index) => { numbers[name] = u32(at + 96 + 4 * index); });
    ["balance", "cutArea", "cutEnergy", "bladeWork"].forEach((name, index) => { numbers[name] = f64(at + 120 + 8 * index); });
    ["nodes", "tets", "newNodes", "pieces", "removed", "changes"].forEach((name, index) => { numbers[name] = u32(at + 152 + 4 * index); });
    // Force of the pull and place of the tissue that is pulled, which is NaN without a grip.
    numbers.pull = new Float64Array(buffer, at + 176, 3);
    numbers.grip = new Float64Array(buffer, at + 200, 3);
    // The axis of a section (3 without one), where it is, and its triangles.
    numbers.section = { axis: u32(at + 224), triangles: u32(at + 228), at: f64(at + 232) };
    const points = numbers.points;
    const count = numbers.tools;
    at += PANE;
    numbers.tools = [];
    for (let tool = 0; tool < count; tool += 1, at += TOOL) {
      const values = new Float64Array(buffer, at, 17);
      numbers.tools.push({
        position: values.subarray(0, 3),
        rotation: values.subarray(3, 6),
        force: values.subarray(6, 9),
        depth: values[9],
        gap: values[10],
        // Where it is led.
        hand: { position: values.subarray(11, 14), rotation: values.subarray(14, 17) },
      });
    }
    numbers.positions = new Float32Array(buffer, at, 3 * points);
    numbers.colours = new Float32Array(buffer, at + 12 * points, points);
    at += Math.ceil((16 * points) / 8) * 8;
    const corners = 3 * numbers.section.triangles;
    numbers.section.positions = new Float32Array(buffer, at, 3 * corners);
    numbers.section.colours = new Float32Array(buffer, at + 12 * corners, corners);
    at += Math.ceil((16 * corners) / 8) * 8;
    picture.panes.push(numbers);
  }
  return picture;
}
