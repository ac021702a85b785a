// The ship in its body axes (forward, starboard, down): hull, fins, thrusters and the forces of these.

const FULL_THRUST = 0.24; // length of an arrow of nominal thrust, over the hull's length

class Ship {
  constructor(ship, cables) {
    this.data = ship;
    this.group = new THREE.Group();
    const vertices = decoded(ship.vertices, Float32Array);
    const faces = decoded(ship.faces, Uint16Array);
    const finCorners = 4 * ship.fins;
    const hullCorners = vertices.length / 3 - finCorners;
    const finFaces = 6 * ship.fins;
    this.hull = this.surface(vertices, faces.subarray(0, faces.length - finFaces), SCENE_COLOURS.hull);
    this.group.add(this.hull, this.seams(vertices, hullCorners));
    if (ship.fins) {
      this.group.add(this.surface(vertices, faces.subarray(faces.length - finFaces), SCENE_COLOURS.fin));
      this.group.add(this.finEdges(vertices.subarray(3 * hullCorners)));
    }
    this.shadow = new THREE.Mesh(this.hull.geometry, new THREE.MeshBasicMaterial({ color: SCENE_COLOURS.shadow }));
    this.shadow.matrixAutoUpdate = false;
    const knob = new THREE.SphereGeometry(0.009 * ship.length, 12, 8);
    const dark = new THREE.MeshLambertMaterial({ color: SCENE_COLOURS.thruster });
    for (const part of [...ship.thrusters.map((one) => one.position), ...cables.map((one) => one.tether_point)]) {
      const mesh = new THREE.Mesh(knob, dark);
      mesh.position.set(...part);
      this.group.add(mesh);
    }
    this.arrows = ship.thrusters.map(() => new Arrow(DATA.colours.arrows.thrust, 0.006 * ship.length));
    for (const arrow of this.arrows) this.group.add(arrow.group);
  }

  surface(vertices, faces, colour) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    geometry.computeVertexNormals();
    return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: colour, side: THREE.DoubleSide }));
  }

  lines(points, colour) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour }));
  }

  // Eight lines from nose to tail: without them a roll would not be seen.
  seams(vertices, corners) {
    const { rings, sectors, axis } = this.data;
    const point = (index) => {
      const corner = vertices.subarray(3 * index, 3 * index + 3);
      return [corner[0], axis[1] + 1.004 * (corner[1] - axis[1]), axis[2] + 1.004 * (corner[2] - axis[2])];
    };
    const points = [];
    for (let sector = 0; sector < sectors; sector += sectors / 8) {
      let before = corners - 2; // the nose
      for (let ring = 0; ring < rings; ring += 1) {
        points.push(...point(before), ...point(ring * sectors + sector));
        before = ring * sectors + sector;
      }
      points.push(...point(before), ...point(corners - 1)); // the tail
    }
    return this.lines(points, SCENE_COLOURS.seam);
  }

  finEdges(corners) {
    const points = [];
    for (let fin = 0; fin < corners.length / 12; fin += 1) {
      for (let edge = 0; edge < 4; edge += 1) {
        for (const corner of [edge, (edge + 1) % 4]) {
          points.push(...corners.subarray(12 * fin + 3 * corner, 12 * fin + 3 * corner + 3));
        }
      }
    }
    return this.lines(points, SCENE_COLOURS.edge);
  }

  // Put it where it is at an instant; `level` is the down coordinate of the ground [m].
  place(now, level) {
    this.group.position.copy(now.vector("position"));
    this.group.quaternion.copy(now.rotation());
    const thrust = now.values("thrust");
    this.arrows.forEach((arrow, i) => {
      const { position, direction, nominal } = this.data.thrusters[i];
      const length = ((thrust[i] || 0) / nominal) * FULL_THRUST * this.data.length;
      arrow.set(new THREE.Vector3(...position), new THREE.Vector3(...direction).multiplyScalar(length));
    });
    this.group.updateMatrix();
    this.shadow.matrix.set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, level - 0.002 * this.data.length, 0, 0, 0, 1);
    this.shadow.matrix.multiply(this.group.matrix);
    this.shadow.visible = now.values("centre")[2] < level;
  }

  // A point of body axes in ground axes.
  point(body) {
    return new THREE.Vector3(...body).applyMatrix4(this.group.matrix);
  }
}
