// The connection to the simulation: commands out, events and pictures in, credits for pictures that were drawn.

import { kindOf, readPicture, readTopology } from "./frames.js";

const LATENCIES = 400;

export class Connection {
  constructor(listeners) {
    this.listeners = listeners;
    this.number = 0;
    this.sentAt = new Map();
    this.latencies = [];
    this.owed = 0;
    this.picture = null;
    this.topology = null;
    const { host, pathname } = window.location;
    this.socket = new WebSocket(`ws://${host}${pathname}socket`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = ({ data }) => (typeof data === "string" ? this.hear(data) : this.take(data));
    this.socket.onclose = () => listeners.closed();
  }

  hear(text) {
    const event = JSON.parse(text);
    this.listeners[event.event]?.(event);
  }

  take(buffer) {
    if (kindOf(buffer) === 0) {
      this.topology = readTopology(buffer);
      // One that was not drawn yet belongs to other surfaces.
      this.picture = null;
      return;
    }
    this.owed += 1;
    const picture = readPicture(buffer);
    if (picture.epoch === this.topology?.epoch) this.picture = Object.assign(picture, { topology: this.topology });
  }

  /// The latest picture, where there is a new one.
  latest() {
    const picture = this.picture;
    this.picture = null;
    return picture;
  }

  /// To be called when a picture has been drawn, with the time (ms) of the next draw.
  drawn(picture, next) {
    const now = performance.now();
    for (const [number, sent] of this.sentAt) {
      if (number <= picture.applied) {
        this.sentAt.delete(number);
        // Of several commands that one picture brings, the last is the one that it shows.
        if (number === picture.applied) {
          this.latencies.push(now - sent);
          if (this.latencies.length > LATENCIES) this.latencies.shift();
        }
      }
    }
    this.grant(next);
  }

  /// Grants pictures in the place of those that came, with the time (ms) at which the page draws again: from now on, in microseconds.
  grant(next) {
    const wait = Uint32Array.of(1000 * Math.max(0, next - performance.now()));
    for (; this.owed > 0; this.owed -= 1) this.send(wait);
  }

  /// Sends a command; of poses, the time until a picture contains it is taken.
  command(what, order = {}) {
    this.number += 1;
    this.send(JSON.stringify({ id: this.number, do: what, ...order }));
    if (what === "pose" || what === "load") this.sentAt.set(this.number, performance.now());
    if (this.sentAt.size > 1000) this.sentAt.clear();
    return this.number;
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(message);
  }

  latency(share) {
    if (this.latencies.length === 0) return NaN;
    const sorted = [...this.latencies].sort((a, b) => a - b);
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  }
}
