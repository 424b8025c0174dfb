// Pictures and films of the stage, which the browser saves.

/// Kinds of films, the best one first; a browser has one of them.
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

/// Bits of a film in a second: edges of tissue stay sharp.
const BITS = 12e6;

export class Capture {
  constructor(view, title) {
    this.view = view;
    this.title = title;
    this.canvas = document.createElement("canvas");
    this.recorder = null;
  }

  get films() {
    return this.recorder !== null;
  }

  get canFilm() {
    return Boolean(this.kind && this.canvas.captureStream);
  }

  get kind() {
    return globalThis.MediaRecorder && KINDS.find((kind) => MediaRecorder.isTypeSupported(kind));
  }

  /// Draws the stage as it is seen, with its ground, which the view leaves to the page.
  compose() {
    const { width, height } = this.view.canvas;
    // Another size would end a film.
    if (!this.films && (this.canvas.width !== width || this.canvas.height !== height)) Object.assign(this.canvas, { width, height });
    const pen = this.canvas.getContext("2d");
    const colours = getComputedStyle(document.documentElement);
    const ground = pen.createLinearGradient(0, 0, 0, this.canvas.height);
    ["--stage-top", "--stage-bottom"].forEach((name, end) => ground.addColorStop(end, colours.getPropertyValue(name).trim()));
    pen.fillStyle = ground;
    pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.view.canvas, 0, 0, this.canvas.width, this.canvas.height);
  }

  /// The picture of now, as a PNG file.
  picture() {
    // What was drawn is gone after the frame.
    this.view.dirty = true;
    this.view.draw();
    this.compose();
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }

  /// Begins a film; `done` gets the file when it ends.
  begin(done) {
    this.view.dirty = true;
    this.view.draw();
    this.compose();
    const parts = [];
    const recorder = new MediaRecorder(this.canvas.captureStream(), { mimeType: this.kind, videoBitsPerSecond: BITS });
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => done(new Blob(parts, { type: recorder.mimeType.split(";")[0] }));
    recorder.start(1000);
    this.recorder = recorder;
  }

  /// Takes a frame that was drawn just now.
  follow() {
    if (this.films) this.compose();
  }

  end() {
    this.recorder?.stop();
    this.recorder = null;
  }

  /// Lets the browser save a file.
  save(file) {
    const end = file.type.split("/")[1];
    const name = this.title().replaceAll(/[^\p{L}\p{N}]+/gu, "-").replaceAll(/^-|-$/g, "").toLowerCase() || "sinew";
    const link = document.createElement("a");
    link.href = URL.createObjectURL(file);
    link.download = `${name}.${end}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
}
