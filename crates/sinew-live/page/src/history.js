// The last seconds of a pane, as plots show them.

export const SPAN = 5;
const NAMES = ["t", "force", "depth", "kinetic", "elastic", "balance"];

// Most samples: steps that are short and shown one by one bring more than a plot can show.
const MOST = 2000;

export class History {
  constructor() {
    this.clear();
  }

  clear() {
    for (const name of NAMES) this[name] = [];
  }

  /// Takes a pane of a picture, with the force (N) of the tool or the pull, and its depth or way (m).
  take(pane, force, depth) {
    if (this.t.length > 0 && pane.t <= this.t.at(-1)) {
      if (pane.t < this.t.at(-1)) this.clear();
      else return;
    }
    const { t, kinetic, elastic, balance } = pane;
    const values = { t, force, depth, kinetic, elastic, balance };
    for (const name of NAMES) this[name].push(values[name]);
    let old = 0;
    while (this.t[old] < pane.t - SPAN) old += 1;
    if (this.t.length > MOST) for (const name of NAMES) this[name] = this[name].filter((_, index) => index % 2 === 0);
    else if (old > 40) for (const name of NAMES) this[name].splice(0, old);
  }
}
