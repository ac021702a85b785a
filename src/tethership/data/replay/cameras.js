// Where the scene is seen from: five set views and one's own.

const CAMERAS = [
  { name: "north", title: "from north", from: [1, 0, -0.07] },
  { name: "east", title: "from east", from: [0, 1, -0.07] },
  { name: "top", title: "from above, north up", from: [-1e-4, 0, -1] },
  { name: "three-quarter", button: "¾ view", title: "from east-northeast, above", from: [0.62, 1, -0.42] },
  { name: "chase", title: "behind the ship", from: null },
];

const FIELD_OF_VIEW = 28; // degrees, upright
const MARGIN = 1.12;
const BEHIND = [-2.0, 0.55, 0.5]; // of the eye of a chase: ahead, to starboard, up, over the ship's length

class CameraRig {
  // `points` are to be seen, ground axes; `reach` is the ship's length; `follow` says that the flight is too long.
  constructor(element, points, reach, follow, onMove) {
    this.points = points;
    this.reach = reach;
    this.follow = follow;
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01 * reach, 1000 * reach);
    this.controls = new THREE.OrbitControls(this.camera, element);
    this.controls.rotateSpeed = 0.7;
    this.name = "";
    this.centre = new THREE.Vector3();
    this.controls.addEventListener("start", () => {
      this.name = "orbit";
    });
    this.controls.addEventListener("change", () => onMove(this));
  }

  choose(name) {
    this.name = name;
    const preset = CAMERAS.find((one) => one.name === name);
    if (!preset.from) return;
    this.fit(toScene(new THREE.Vector3(...preset.from)).normalize());
  }

  // Stand so far off in a direction that all points are seen.
  fit(direction) {
    const { camera, controls } = this;
    camera.position.copy(direction);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    const turn = camera.quaternion.clone().invert();
    const seen = this.points.map((point) => toScene(point).applyQuaternion(turn));
    const low = new THREE.Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    for (const point of seen) {
      low.min(point);
      high.max(point);
    }
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const upright = Math.tan((camera.fov * Math.PI) / 360);
    const across = upright * camera.aspect;
    let distance = this.reach;
    for (const point of seen) {
      const { x, y, z } = point.clone().sub(middle);
      distance = Math.max(distance, MARGIN * Math.max(Math.abs(x) / across, Math.abs(y) / upright) + z);
    }
    const target = middle.applyQuaternion(camera.quaternion);
    if (this.follow) target.add(toScene(this.centre));
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(direction, distance);
    controls.update();
  }

  // The ship has moved: follow it if that is wanted.
  track(centre, rotation) {
    const moved = toScene(centre).sub(toScene(this.centre));
    this.centre.copy(centre);
    if (this.name === "chase") {
      const ahead = NORTH.clone().applyQuaternion(rotation).setZ(0).normalize();
      const [forward, aside, above] = BEHIND.map((part) => part * this.reach * Math.max(1, 1.1 / this.camera.aspect));
      const starboard = UP.clone().negate().cross(ahead);
      const eye = centre.clone().addScaledVector(ahead, forward).addScaledVector(starboard, aside);
      this.camera.position.copy(toScene(eye.addScaledVector(UP, above)));
      this.controls.target.copy(toScene(centre.clone().addScaledVector(ahead, 0.1 * this.reach)));
      this.controls.update();
    } else if (this.follow) {
      this.camera.position.add(moved);
      this.controls.target.add(moved);
      this.controls.update();
    }
  }

  // See what another rig sees, about one's own ship where the flights are followed.
  copy(other) {
    this.name = other.name;
    const shift = this.follow ? toScene(this.centre).sub(toScene(other.centre)) : new THREE.Vector3();
    this.camera.position.copy(other.camera.position).add(shift);
    this.controls.target.copy(other.controls.target).add(shift);
    this.controls.update();
  }

  steep() {
    return this.camera.getWorldDirection(new THREE.Vector3()).y < -0.9;
  }
}
