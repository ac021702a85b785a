// The histories of a flight: numbers at rising times, read at any time between them.

// What the page was written with.
const DATA = JSON.parse(document.getElementById("flights").textContent);
const LETTERS = ["A", "B"];

const decoded = (text, Kind) => {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  return new Kind(bytes.buffer);
};

class Tracks {
  constructor(packed) {
    this.found = {};
    for (const [name, { width, data }] of Object.entries(packed)) {
      this.found[name] = { width, data: decoded(data, Float32Array) };
    }
    this.times = this.found.time.data;
    this.end = this.times[this.times.length - 1];
  }

  has(name) {
    return name in this.found;
  }

  width(name) {
    return this.has(name) ? this.found[name].width : 0;
  }

  // One number of a track at all times: for a plot.
  column(name, index = 0) {
    const { width, data } = this.found[name];
    return Array.from(this.times, (_, sample) => data[sample * width + index]);
  }

  // Everything at one time [s]; before the start and after the end it stands still.
  at(time) {
    const { times } = this;
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle;
    }
    const span = times[high] - times[low];
    const part = span > 0 ? Math.min(Math.max((time - times[low]) / span, 0), 1) : 0;
    return new Instant(this, low, high, part);
  }
}

class Instant {
  constructor(tracks, low, high, part) {
    Object.assign(this, { tracks, low, high, part });
  }

  // The numbers of a track, straight between samples; nothing where the file has none.
  values(name) {
    if (!this.tracks.has(name)) return [];
    const { width, data } = this.tracks.found[name];
    const found = new Array(width);
    for (let i = 0; i < width; i += 1) {
      const before = data[this.low * width + i];
      found[i] = before + this.part * (data[this.high * width + i] - before);
    }
    return found;
  }

  // Three numbers of a track as a vector.
  vector(name, first = 0) {
    return new THREE.Vector3(...this.values(name).slice(first, first + 3));
  }

  // Body to ground.
  rotation() {
    return new THREE.Quaternion(...this.values("quaternion")).normalize();
  }
}
