// One flight in space: its canvas, everything on it, and its camera.

class Stage {
  // `points` are to be seen by the set cameras of all stages, `perSpeed` is the length of wind's arrows [m per m/s].
  constructor(parent, flight, tracks, shared) {
    this.flight = flight;
    this.tracks = tracks;
    this.parent = parent;
    this.frames = 0;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    parent.prepend(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.earth = makeEarth();
    this.scene.add(this.earth);
    this.lights();
    this.labels = new Labels(parent.querySelector(".labels"));
    this.ship = new Ship(flight.ship, flight.cables);
    this.cables = new Cables(flight, tracks, shared.scale);
    this.wind = new Wind(flight.ship, shared.perSpeed, this.labels);
    const beside = tracks
      .at(0)
      .vector("centre")
      .add(new THREE.Vector3(0, flight.ship.length, 0));
    const mast = flight.cables.length ? new THREE.Vector3(...flight.cables[0].anchor) : beside;
    this.ground = new Ground(shared.box, flight.ground, shared.highest, mast, this.labels);
    this.earth.add(this.ground.group, this.ship.shadow, this.ship.group, this.cables.group, this.wind.group);
    this.earth.add(makePath(tracks, DATA.colours.path));
    this.rig = new CameraRig(
      this.renderer.domElement,
      shared.follow ? shipPoints(flight, tracks.at(0), true) : shared.points,
      flight.ship.length,
      shared.follow,
      (rig) => shared.moved(this, rig),
    );
  }

  lights() {
    const sun = new THREE.DirectionalLight("#ffffff", 1.5);
    sun.position.set(0.5, 1, 0.35);
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#d9d2c3", 1.9), sun);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (!width || !height) return;
    this.width = width;
    this.height = height;
    this.renderer.setSize(width, height);
    this.rig.camera.aspect = width / height;
    this.rig.camera.updateProjectionMatrix();
    if (CAMERAS.some((one) => one.name === this.rig.name)) this.rig.choose(this.rig.name);
  }

  // Show a time [s].
  place(time) {
    this.now = this.tracks.at(time);
    const centre = this.now.vector("centre");
    this.ship.place(this.now, this.flight.ground);
    this.cables.place(this.now);
    this.wind.place(this.now, centre);
    if (this.rig.follow) this.ground.follow(centre);
    this.rig.track(centre, this.now.rotation());
    this.ground.place(centre, this.rig.steep());
  }

  render() {
    this.renderer.render(this.scene, this.rig.camera);
    this.labels.place(this.rig.camera, this.width, this.height);
    this.frames += 1;
  }
}

// Points on the outside of the ship at an instant, ground axes or from B; room for the wind's arrow included.
const shipPoints = (flight, now, fromCentre = false) => {
  const { length, diameter, axis, nose } = flight.ship;
  const rotation = now.rotation();
  const centre = now.vector("centre");
  const tail = [nose[0] - length, nose[1], nose[2]];
  const found = [nose, tail].map((body) =>
    new THREE.Vector3(...body).applyQuaternion(rotation).add(now.vector("position")),
  );
  for (const [north, east, down] of [
    [0, 0, 0.7],
    [0, 0.6, 0],
    [0, -0.6, 0],
  ]) {
    found.push(new THREE.Vector3(north, east, down).multiplyScalar(diameter).add(centre));
  }
  found.push(centre.clone().addScaledVector(UP, 0.5 * diameter + 0.2 * length));
  return fromCentre ? found.map((point) => point.sub(centre)) : found;
};

// Everything that a flight passes through.
const flightPoints = (flight, tracks) => {
  const size = 0.06 * flight.ship.length;
  const points = flight.cables.flatMap((cable) => {
    const anchor = new THREE.Vector3(...cable.anchor);
    return [anchor, anchor.clone().addScaledVector(NORTH, size), anchor.clone().addScaledVector(UP, -size)];
  });
  const steps = 60;
  for (let i = 0; i <= steps; i += 1) points.push(...shipPoints(flight, tracks.at((i / steps) * tracks.end)));
  return points;
};
