// The ground with its grid, a scale of altitude and the foot of the ship.

const niceStep = (wanted) => {
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= wanted);
};

class Ground {
  // `box` holds the flight, ground axes; `level` is the down coordinate of the ground, marks go up to `highest` [m].
  constructor(box, level, highest, place, labels) {
    const size = box.getSize(new THREE.Vector3());
    this.level = level;
    this.step = niceStep(Math.max(size.x, size.y, size.z) / 12);
    this.cells = 20;
    const side = 2 * this.cells * this.step;
    this.group = new THREE.Group();
    const plane = new THREE.Mesh(
      new THREE.PlaneGeometry(side, side),
      new THREE.MeshBasicMaterial({
        color: DATA.colours.ground,
        side: THREE.DoubleSide,
        transparent: true,
        opacity: 0.72,
        depthWrite: false,
      }),
    );
    plane.renderOrder = -1;
    this.tiles = new THREE.Group();
    this.tiles.add(plane, this.grid());
    this.group.add(this.tiles, this.staff(box, highest, place, labels));
    this.foot = this.segments([0, 0, 0, 0, 0, 1], SCENE_COLOURS.staff);
    this.group.add(this.foot);
    this.footLabel = labels.add("", "foot");
    this.northLabel = labels.add("N", "compass");
    this.centre = box.getCenter(new THREE.Vector3());
    this.size = size;
    this.follow(this.centre);
  }

  segments(points, colour) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour }));
    lines.frustumCulled = false;
    return lines;
  }

  grid() {
    const points = [];
    const end = this.cells * this.step;
    for (let i = -this.cells; i <= this.cells; i += 1) {
      points.push(i * this.step, -end, 0, i * this.step, end, 0, -end, i * this.step, 0, end, i * this.step, 0);
    }
    return this.segments(points, SCENE_COLOURS.grid);
  }

  // A staff with marks of altitude above the ground.
  staff(box, highest, place, labels) {
    const step = niceStep(Math.max(highest, 1e-3) / 5);
    const top = step * Math.ceil(highest / step);
    const points = [place.x, place.y, this.level, place.x, place.y, this.level - top];
    const tick = 0.006 * box.getSize(new THREE.Vector3()).length();
    this.marks = [];
    for (let altitude = step; altitude <= top * 1.0001; altitude += step) {
      const down = this.level - altitude;
      points.push(place.x - tick, place.y, down, place.x + tick, place.y, down);
      points.push(place.x, place.y - tick, down, place.x, place.y + tick, down);
      const label = labels.add(`${Number(altitude.toPrecision(6))} m`, "mark");
      label.point.set(place.x, place.y, down);
      this.marks.push(label);
    }
    return this.segments(points, SCENE_COLOURS.staff);
  }

  // Keep the tiles below a point that moves far.
  follow(centre) {
    const snapped = (value) => Math.round(value / this.step) * this.step;
    this.tiles.position.set(snapped(centre.x), snapped(centre.y), this.level);
    this.northLabel.point.set(centre.x + 0.5 * this.size.x + 0.3 * this.step, centre.y, this.level);
  }

  place(centre, steep) {
    this.foot.position.set(centre.x, centre.y, centre.z);
    this.foot.scale.set(1, 1, this.level - centre.z);
    this.footLabel.point.set(centre.x, centre.y, this.level);
    this.footLabel.text(`${(this.level - centre.z).toFixed(1)} m`);
    this.footLabel.shown = !steep;
    for (const mark of this.marks) mark.shown = !steep;
  }
}
