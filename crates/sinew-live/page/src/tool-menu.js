// The menu of tools: which one is in the hand, others to add, and the end of those that were added.

import { element } from "./element.js";

const get = (id) => document.getElementById(id);

/// The kinds that can be added, with what each does.
const KINDS = {
  ball: ["Ball", "presses"],
  rod: ["Rod", "presses and pushes aside"],
  plate: ["Plate", "presses the whole face"],
  jaws: ["Jaws", "grasp what they touch"],
  blade: ["Blade", "cuts wherever it goes"],
  scissors: ["Scissors", "cut what is between them"],
  burner: ["Burner", "takes tissue away"],
};

export class ToolMenu {
  /// `take` gets the number of a tool for the hand, -1 for the bare hand; `add` a kind; `remove` a number.
  constructor({ take, add, remove }) {
    const menu = get("tool-list").closest("details");
    const closing = (act) => (what) => {
      menu.open = false;
      // Keys act on the stage from now on.
      get("canvas").focus({ preventScroll: true });
      act(what);
    };
    this.actions = { take: closing(take), remove: closing(remove), add: closing(add) };
    get("tool-kinds").replaceChildren(...Object.entries(KINDS).map(([kind, [name, does]]) => (
      element("button", { type: "button", "data-kind": kind, title: `${name}: ${does}; all begins anew`, onclick: () => this.actions.add(kind) }, name)
    )));
  }

  /// Shows the tools of the scene, and which is in the hand.
  show(tools, selected) {
    const key = JSON.stringify([tools.map(({ name, added }) => [name, added]), selected]);
    if (key === this.shown) return;
    this.shown = key;
    const choice = (number, name) => element("button", {
      type: "button", class: "choice", "aria-pressed": String(number === selected), "data-tool": number, onclick: () => this.actions.take(number),
    }, name);
    const row = (tool, number) => {
      const parts = [choice(number, tool.name)];
      if (tool.added) parts.push(element("button", { type: "button", class: "remove", "data-remove": number, title: "All begins anew", "aria-label": `Remove ${tool.name}`, onclick: () => this.actions.remove(number) }, "Remove"));
      return element("div", { class: "tool" }, ...parts);
    };
    get("tool-list").replaceChildren(element("div", { class: "tool" }, choice(-1, "Bare hand, pulls tissue")), ...tools.map(row));
    get("tool-name").textContent = selected < 0 ? "Hand" : tools[selected].name;
  }
}
