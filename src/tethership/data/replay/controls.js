// Buttons, slider and keys.

const SMALL_STEP = 0.5; // seconds by an arrow key
const LARGE_STEP = 5; // with shift

class Controls {
  constructor(clock, chooseCamera) {
    this.clock = clock;
    this.chooseCamera = chooseCamera;
    this.button = document.getElementById("play");
    this.slider = document.getElementById("time");
    this.clockFace = document.getElementById("clock");
    this.speed = document.getElementById("speed");
    this.cameras = document.getElementById("cameras");
    this.slider.max = clock.end;
    this.slider.step = "any";
    for (const speed of SPEEDS) this.speed.add(new Option(`${speed} ×`, speed, false, speed === 1));
    CAMERAS.forEach((camera, i) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = camera.button || camera.name;
      button.title = `${camera.title} (key ${i + 1})`;
      button.dataset.camera = camera.name;
      button.addEventListener("click", () => chooseCamera(camera.name));
      this.cameras.append(button);
    });
    this.button.addEventListener("click", () => clock.toggle());
    this.slider.addEventListener("input", () => clock.seek(Number(this.slider.value)));
    this.speed.addEventListener("change", () => clock.setSpeed(Number(this.speed.value)));
    addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target === this.speed) return;
    const step = event.shiftKey ? LARGE_STEP : SMALL_STEP;
    const actions = {
      " ": () => this.clock.toggle(),
      ArrowLeft: () => this.clock.seek(this.clock.time - step),
      ArrowRight: () => this.clock.seek(this.clock.time + step),
      ArrowUp: () => this.clock.faster(1),
      ArrowDown: () => this.clock.faster(-1),
      Home: () => this.clock.seek(0),
      End: () => this.clock.seek(this.clock.end),
    };
    CAMERAS.forEach((camera, i) => {
      actions[String(i + 1)] = () => this.chooseCamera(camera.name);
    });
    const presses = event.key === " " && event.target instanceof HTMLButtonElement; // what has the focus is meant
    if (presses || !(event.key in actions)) return;
    event.preventDefault();
    actions[event.key]();
  }

  place(camera) {
    const { clock } = this;
    const name = clock.playing ? "pause" : "play";
    if (this.button.dataset.shows !== name) {
      this.button.dataset.shows = name;
      this.button.title = `${name} (space)`;
      this.button.setAttribute("aria-label", name);
    }
    this.slider.value = clock.time;
    this.slider.style.setProperty("--part", `${(100 * clock.time) / clock.end}%`);
    this.clockFace.textContent = `${clock.time.toFixed(2)} s`;
    this.speed.value = clock.speed;
    for (const button of this.cameras.children) {
      button.setAttribute("aria-pressed", String(button.dataset.camera === camera));
    }
  }
}
