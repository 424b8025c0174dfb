// What a page of a scene has that was chosen on the start page: a hint of how to begin, and the way back to the scenes.

const get = (id) => document.getElementById(id);

/// Time (ms) between two looks for the start page.
const WAIT = 150;

export class Beginning {
  /// `leave` asks the simulation to end.
  constructor(leave) {
    this.hint = null;
    this.isLeaving = false;
    get("scenes").addEventListener("click", leave);
  }

  /// The scene's hint; `null` for one that was not chosen on a start page.
  offer(hint) {
    this.hint = hint;
    get("scenes").hidden = hint === null;
    get("begin-what").textContent = hint ?? "";
  }

  /// Shows the hint while nothing has moved yet.
  show(isPaused, t) {
    get("begin").hidden = this.hint === null || !isPaused || t !== 0;
  }

  /// Goes to the start page as soon as it is there.
  async go() {
    try {
      const answer = await fetch("state", { cache: "no-store" });
      if ((await answer.json()).page === "start") {
        window.location.reload();
        return;
      }
    } catch {
      // It is not there yet.
    }
    window.setTimeout(() => this.go(), WAIT);
  }
}
