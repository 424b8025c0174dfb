// What a hand can do, in words. All sentences of a scene lie on each other, so that the page keeps its height when another one is read.

import { plain } from "./numbers.js";

const get = (id) => document.getElementById(id);

const NAVIGATION = "wheel: zoom · Shift + drag: pan · 1 to 6: sides, V: as at first";

/// Whether fingers are what this device is mainly used with.
const FINGERS = window.matchMedia("(pointer: coarse)");

/// What two and three fingers do in every case.
const TWO = "two fingers: turn and zoom · three: move the view · Views: sides";

function ofFingers({ tools, cuts }, most) {
  const all = { rest: `One finger on tissue: pull it · beside it: turn the view · ${TWO}${most}${cuts ? " · Cut: a blade" : ""}` };
  if (cuts) all.blade = `One finger: cut along your line of sight · ${TWO} · Cut again: done`;
  if (tools.length > 0) all.tool = `One finger: move the tool · Turn: it turns instead · the handle at the left: deeper and nearer · Grasp: hold what it touches, and let go · ${TWO}${most}`;
  return all;
}

function ofMouse({ tools, cuts }, most) {
  const toBlade = cuts ? " · C: a blade" : "";
  const all = {
    rest: `Drag on tissue: pull it · drag beside it or right button: turn the view · ${NAVIGATION} · G: grip the tissue in the middle, arrows pull it, G again: let go${most}${toBlade}`,
  };
  if (cuts) all.blade = `Drag: cut along your line of sight · right button: turn the view · ${NAVIGATION} · arrows move the blade, Enter lowers and lifts it · C: done`;
  if (tools.length > 0) {
    all.tool = `Drag: move the tool · Alt + drag, or T and drag: turn it · E and Q, or the handle at the left: deeper and nearer · Shift in a drag: lift it off · G: grasp what it touches, and let go · right button: turn the view · ${NAVIGATION} · arrows and Page keys move it, too${most}${toBlade}`;
  }
  return all;
}

const sentences = (scenery) => (FINGERS.matches ? ofFingers : ofMouse)(scenery, ` · at most ${plain(scenery.hand_speed, 2)} m/s (--hand-speed)`);

/// What keys do on the canvas, for those who do not see it.
const KEYS = {
  blade: "Arrow keys move the blade, Enter lowers and lifts it, Escape puts it away;",
  tool: "Arrow keys move the tool, or turn it after T; E and Q press it away from you and back, Page Up and Page Down lift and press it;",
  rest: "Arrow keys turn the view, G grips the tissue in the middle, then arrow keys, Page Up and Page Down pull it, and G or Escape lets go;",
};

/// Tells what can be done in a scene with what is in the hand: `blade`, `tool`, or nothing (`rest`).
export function showHint(scenery, now) {
  get("hint").replaceChildren(...Object.entries(sentences(scenery)).map(([name, words]) => {
    const sentence = document.createElement("span");
    sentence.textContent = words;
    sentence.classList.toggle("waits", name !== now);
    return sentence;
  }));
  get("canvas").setAttribute("aria-label", `Tissue. ${KEYS[now]} the keys [ and ] turn the view, plus and minus zoom, Control with arrows pans, 1 to 6 show the sides.`);
}
