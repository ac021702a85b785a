// The cables: the curves that were computed, coloured by the tension at the ship; anchors.

class Cables {
  constructor(flight, tracks, scale) {
    this.scale = scale;
    this.group = new THREE.Group();
    this.points = flight.cables.length ? tracks.width("cable_curve") / 3 / flight.cables.length : 0;
    this.anchors = [];
    this.lines = flight.cables.map((cable) => {
      const line = new THREE.Line2(new THREE.LineGeometry(), new THREE.LineMaterial({ linewidth: 3.2 }));
      line.frustumCulled = false;
      const size = 0.012 * flight.ship.length;
      const anchor = new THREE.Mesh(
        new THREE.ConeGeometry(1.6 * size, 2.4 * size, 4).rotateX(-Math.PI / 2),
        new THREE.MeshLambertMaterial({ color: SCENE_COLOURS.thruster }),
      );
      anchor.position.set(...cable.anchor);
      this.group.add(line, anchor);
      this.anchors.push(anchor);
      return line;
    });
    this.ends = [];
    this.colours = [];
  }

  place(now) {
    const curve = now.values("cable_curve");
    const tension = now.values("tension");
    const width = 3 * this.points;
    this.lines.forEach((line, cable) => {
      const points = curve.slice(cable * width, (cable + 1) * width);
      line.visible = points.length >= 6 && points.every(Number.isFinite);
      if (!line.visible) return;
      line.geometry.setPositions(points);
      this.anchors[cable].position.set(...points.slice(0, 3)); // it may move
      line.material.color.copy(this.scale.colour(tension[cable]));
      this.ends[cable] = [points.slice(0, 3), points.slice(-3)];
      this.colours[cable] = `#${line.material.color.getHexString()}`;
    });
  }
}

// The path of B, drawn once.
const makePath = (tracks, colour) => {
  const { data } = tracks.found.centre;
  const line = new THREE.Line2(
    new THREE.LineGeometry(),
    new THREE.LineMaterial({ color: colour, linewidth: 1.2, transparent: true, opacity: 0.55 }),
  );
  line.geometry.setPositions(data.length >= 6 ? data : new Float32Array([...data, ...data]));
  return line;
};
