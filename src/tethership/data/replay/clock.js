// The one time of the page [s], and who wants to know of it.

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];

class Clock {
  constructor(end) {
    this.end = end;
    this.time = 0;
    this.speed = 1;
    this.playing = false;
    this.listeners = [];
  }

  listen(listener) {
    this.listeners.push(listener);
  }

  changed() {
    for (const listener of this.listeners) listener(this);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.end);
    this.changed();
  }

  play(playing = true) {
    if (playing && this.time >= this.end) this.time = 0;
    this.playing = playing;
    this.changed();
  }

  toggle() {
    this.play(!this.playing);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.changed();
  }

  faster(steps) {
    const place = SPEEDS.indexOf(this.speed) + steps;
    this.setSpeed(SPEEDS[Math.min(Math.max(place, 0), SPEEDS.length - 1)]);
  }

  // Let real time pass [s].
  pass(seconds) {
    if (!this.playing) return;
    this.time = Math.min(this.time + seconds * this.speed, this.end);
    if (this.time >= this.end) this.playing = false;
    this.changed();
  }
}
