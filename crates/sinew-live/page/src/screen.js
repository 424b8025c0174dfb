// The clock of the screen.

/// Share by which the time between two draws follows a longer one: a draw that is left out now and then delays nothing.
const SLOWLY = 0.05;

export class Screen {
  constructor() {
    this.last = -Infinity;
    this.between = 1000 / 60;
  }

  /// To be called at each draw, with its time (ms).
  drew(now) {
    const gap = now - this.last;
    this.last = now;
    if (gap < this.between) this.between = gap;
    else if (gap < 1000) this.between += SLOWLY * (gap - this.between);
  }

  /// Time (ms) of the next draw.
  get next() {
    return this.last + this.between;
  }
}
