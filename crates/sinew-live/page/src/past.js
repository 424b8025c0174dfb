// What happened: pictures of the last minutes within a stated memory, to look back at, to play again, and to go on from.

import { plain } from "./numbers.js";

const get = (id) => document.getElementById(id);

/// Most bytes that pictures may take.
const MEMORY = 96e6;

/// Time (ms) between two updates of the slider while pictures come: each lays the page out anew.
const TELL_EVERY = 200;

export class Past {
  /// `pause` stops time, as a past that goes on could not be looked at; `goOn` asks for another motion from a time (s) on; `left` is called when the page
  /// shows the present again.
  constructor({ pause, goOn, left }) {
    this.actions = { pause, goOn, left };
    this.slider = get("past");
    this.clear();
    this.slider.addEventListener("input", () => this.lookAt(Number(this.slider.value)));
    get("past-play").addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    get("past-now").addEventListener("click", () => this.leave());
    get("past-go").addEventListener("click", () => this.isOn && this.actions.goOn(this.list[this.at].panes[0].t));
  }

  /// Whether the page shows the past.
  get isOn() {
    return this.at !== null;
  }

  clear() {
    Object.assign(this, { list: [], bytes: 0, toldAt: -Infinity });
    this.end();
  }

  /// Keeps a picture that came. Where the memory is full, every second one of the older half goes.
  take(picture) {
    const { t } = picture.panes[0];
    // While time stops, the newest one is of the present.
    if (this.list.length > 0 && t <= this.list.at(-1).panes[0].t) this.drop(t, true);
    this.list.push(picture);
    this.bytes += picture.bytes;
    if (this.bytes > MEMORY && this.list.length > 16) {
      const older = Math.floor(this.list.length / 2);
      this.list = this.list.filter((kept, index) => index >= older || index % 2 === 0 || kept === this.shown);
      // What is looked at stays where it is, also where another page lets time go on.
      if (this.isOn) this.at = Math.max(0, this.list.indexOf(this.shown));
      this.bytes = this.list.reduce((sum, { bytes }) => sum + bytes, 0);
    }
    const now = performance.now();
    if (this.isOn || now - this.toldAt < TELL_EVERY) return;
    this.toldAt = now;
    this.tell();
  }

  /// Forgets what came after a time (s), or at it, too.
  drop(t, itself) {
    while (this.list.length > 0 && (itself ? this.list.at(-1).panes[0].t >= t : this.list.at(-1).panes[0].t > t)) this.bytes -= this.list.pop().bytes;
  }

  /// The motion went back to a time (s): what came after it did not happen.
  wentBackTo(t) {
    this.drop(t, false);
    this.end();
  }

  /// Ends the look back.
  end() {
    Object.assign(this, { at: null, playing: null, shown: null });
    this.tell();
  }

  lookAt(index) {
    if (this.list.length === 0) return;
    this.actions.pause();
    this.playing = null;
    this.at = Math.min(index, this.list.length - 1);
    this.tell();
  }

  play() {
    if (this.list.length < 2) return;
    this.actions.pause();
    const last = this.list.length - 1;
    if (!this.isOn || this.at === last) this.at = 0;
    this.playing = { from: this.list[this.at].panes[0].t, since: performance.now() };
    this.tell();
  }

  stop() {
    this.playing = null;
    this.tell();
  }

  /// Back to the present.
  leave() {
    if (!this.isOn) return;
    this.end();
    this.actions.left();
  }

  /// The picture of the past that has to be shown now, if there is another one.
  next(now) {
    if (!this.isOn) return null;
    if (this.playing) {
      const t = this.playing.from + (now - this.playing.since) / 1000;
      while (this.at < this.list.length - 1 && this.list[this.at + 1].panes[0].t <= t) this.at += 1;
      if (this.at === this.list.length - 1) this.playing = null;
      this.tell();
    }
    const picture = this.list[this.at];
    if (picture === this.shown) return null;
    this.shown = picture;
    return picture;
  }

  tell() {
    const { list, slider } = this;
    const last = Math.max(0, list.length - 1);
    slider.max = last;
    slider.value = this.at ?? last;
    slider.disabled = list.length < 2;
    get("past-play").disabled = list.length < 2;
    get("past-play").textContent = this.playing ? "Stop" : "Play again";
    for (const id of ["past-now", "past-go"]) get(id).disabled = !this.isOn;
    const t = list[this.at ?? last]?.panes[0].t ?? 0;
    const words = this.isOn ? `${plain(t, 3)} s of ${plain(list[last].panes[0].t, 3)} s` : "now";
    if (get("past-time").textContent !== words) get("past-time").textContent = words;
    slider.setAttribute("aria-valuetext", words);
    get("views").classList.toggle("past", this.isOn);
  }
}
