// The page: reads the flights, builds stages, plots and controls, and shows a time.

const FARTHEST_FIXED = 5; // flights longer than so many ships are followed by the camera

const describe = (flights) => {
  const same = flights[0].words.filter((part) => flights.every((flight) => flight.words.includes(part)));
  const words = flights.length > 1 ? same : [...same, flights[0].verdict];
  document.getElementById("title").textContent = [...new Set(flights.map((flight) => flight.title))].join(" | ");
  document.getElementById("words").textContent = words.join(" · ");
  return same;
};

const notesOf = (flight) => [
  ...flight.warnings.map((warning) => warning.split(/[;:]/)[0]),
  ...(flight.missing.length ? [`not in this file: ${flight.missing.join(", ")}`] : []),
  ...(flight.ground_modelled
    ? []
    : [`no ground in this scenario: the plane is at ${flight.cables.length ? "the anchor’s level" : "altitude 0"}`]),
];

// The boxes of the flights; what is the same of all is not said twice.
const makeStageBoxes = (flights, same) =>
  flights.map((flight, i) => {
    const box = document.getElementById("stage").content.firstElementChild.cloneNode(true);
    document.getElementById("stages").append(box);
    const caption = box.querySelector("figcaption");
    caption.hidden = flights.length === 1;
    caption.querySelector("b").textContent = `${LETTERS[i]} · ${flight.name}`;
    const own = [...flight.words.filter((part) => !same.includes(part)), flight.verdict];
    caption.querySelector("span").textContent = own.join(" · ");
    const later = flights.slice(i + 1).flatMap(notesOf);
    const scale = i > 0 && limitsDiffer(flights) ? ["cables coloured by A’s limits, not B’s"] : [];
    box.querySelector(".note").title = flight.warnings.join("\n");
    box.querySelector(".note").textContent = [...scale, ...notesOf(flight)]
      .filter((note) => !later.includes(note))
      .join(" · ");
    return box;
  });

const shareAmong = (flights, tracks, moved) => {
  const points = flights.flatMap((flight, i) => flightPoints(flight, tracks[i]));
  const box = new THREE.Box3().setFromPoints(points);
  const length = Math.max(...flights.map((flight) => flight.ship.length));
  const strongest = Math.max(...tracks.map(strongestWind));
  const highest = Math.max(
    ...flights.map(
      (flight, i) => flight.ground - tracks[i].column("centre", 2).reduce((a, b) => Math.min(a, b), flight.ground),
    ),
  );
  const follow = box.getSize(new THREE.Vector3()).length() > FARTHEST_FIXED * length;
  if (follow) {
    const start = flights.flatMap((flight, i) => shipPoints(flight, tracks[i].at(0)));
    box.setFromPoints(start).expandByScalar(length);
    for (const flight of flights)
      for (const cable of flight.cables) box.expandByPoint(new THREE.Vector3(...cable.anchor));
  }
  return {
    points,
    box,
    follow,
    highest,
    scale: new TensionScale(flights[0].limits),
    perSpeed: strongest > 0 ? (LONGEST_WIND * length) / strongest : 0,
    moved,
  };
};

class Page {
  constructor() {
    const { flights } = DATA;
    this.tracks = flights.map((flight) => new Tracks(flight.tracks));
    this.clock = new Clock(Math.max(...this.tracks.map((tracks) => tracks.end), 1e-3));
    this.dirty = true;
    this.copying = false;
    this.work = 0; // of the scripts for a frame, a running mean [ms]
    const same = describe(flights);
    const shared = shareAmong(flights, this.tracks, (stage, rig) => this.moved(stage, rig));
    fillKey(document.getElementById("key"), flights, shared.scale);
    const boxes = makeStageBoxes(flights, same);
    document.body.classList.toggle("two", flights.length > 1);
    this.stages = [];
    const Kind = canDrawInSpace() ? Stage : NoStage;
    for (const name of ["cameras", "key"]) document.getElementById(name).hidden = Kind === NoStage;
    flights.forEach((flight, i) =>
      this.stages.push(new Kind(boxes[i].querySelector(".view"), flight, this.tracks[i], shared)),
    );
    this.readouts = flights.map((flight, i) => new Readout(boxes[i], flight, this.tracks[i], shared.scale));
    this.plots = new Plots(document.getElementById("plots"), flights, this.tracks, this.clock);
    this.controls = new Controls(this.clock, (name) => this.chooseCamera(name));
    this.clock.listen(() => {
      this.dirty = true;
    });
    new ResizeObserver(() => this.resize()).observe(document.getElementById("stages"));
    this.placeAll();
    this.resize();
    this.chooseCamera("three-quarter");
    this.last = null;
    requestAnimationFrame((now) => this.frame(now));
  }

  resize() {
    for (const stage of this.stages) stage.resize();
    this.plots.resize();
    this.dirty = true;
  }

  chooseCamera(name) {
    for (const stage of this.stages) stage.rig.choose(name);
    this.dirty = true;
  }

  // A reader has turned one scene: turn the other.
  moved(stage, rig) {
    this.dirty = true;
    if (this.copying || rig.name !== "orbit" || !this.stages) return;
    this.copying = true;
    for (const other of this.stages) if (other !== stage) other.rig.copy(rig);
    this.copying = false;
  }

  placeAll() {
    for (const stage of this.stages) stage.place(this.clock.time);
  }

  frame(now) {
    const passed = this.last === null ? 0 : Math.min((now - this.last) / 1000, 0.25);
    this.last = now;
    this.clock.pass(passed);
    if (this.dirty) this.show();
    requestAnimationFrame((next) => this.frame(next));
  }

  show() {
    const begun = performance.now();
    this.placeAll();
    this.stages.forEach((stage, i) => {
      stage.render();
      this.readouts[i].place(stage.now);
      const ended = this.clock.time > this.tracks[i].end + 1e-6;
      stage.parent.classList.toggle("ended", ended);
    });
    this.plots.place(this.clock.time);
    this.plots.tell(this.stages.map((stage) => stage.now));
    this.controls.place(this.stages[0].rig.name);
    this.dirty = false; // what this very call moved is shown
    this.work += 0.1 * (performance.now() - begun - this.work);
  }

  // What is seen, for tests: read from the scene and the plots themselves.
  state() {
    return {
      time: this.clock.time,
      end: this.clock.end,
      playing: this.clock.playing,
      speed: this.clock.speed,
      camera: this.stages[0].rig.name,
      work: this.work,
      frames: this.stages.map((stage) => stage.frames),
      flights: this.stages.map(stageState),
      plots: this.plots.panels.map((panel) => ({
        title: panel.title,
        range: panel.range,
        time: panel.plot.posToVal(panel.left, "x"),
        shown: panel.entries.map(({ one, value }) => [one.label, value.textContent]),
      })),
    };
  }
}

const start = () => {
  try {
    const page = new Page();
    window.tethership = Object.freeze({ state: () => page.state() });
  } catch (error) {
    const message = document.createElement("p");
    message.id = "failed";
    message.textContent = `This page cannot be shown: ${error.message}. A current Firefox, Chromium or Safari shows it.`;
    document.body.replaceChildren(message);
    throw error;
  }
};

start();
