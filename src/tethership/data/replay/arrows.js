// An arrow from a point along a vector. Where something is in front of it, it shines through faintly.

const ARROW_AXIS = new THREE.Vector3(0, 1, 0);

class Arrow {
  constructor(colour, thickness) {
    this.thickness = thickness;
    this.group = new THREE.Group();
    this.from = new THREE.Vector3();
    this.to = new THREE.Vector3();
    const shaft = new THREE.CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0);
    const head = new THREE.ConeGeometry(2.6, 1, 16).translate(0, 0.5, 0);
    const solid = new THREE.MeshLambertMaterial({ color: colour });
    const faint = new THREE.MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.22, depthTest: false });
    this.shafts = [new THREE.Mesh(shaft, solid), new THREE.Mesh(shaft, faint)];
    this.heads = [new THREE.Mesh(head, solid), new THREE.Mesh(head, faint)];
    this.shafts[1].renderOrder = this.heads[1].renderOrder = 5;
    this.group.add(...this.shafts, ...this.heads);
  }

  // Start and vector, both in the axes of the group's parent [m].
  set(from, vector) {
    const length = vector.length();
    this.group.visible = length > 2 * this.thickness;
    this.from.copy(from);
    this.to.copy(from).add(vector);
    if (!this.group.visible) return;
    const head = Math.min(7 * this.thickness, 0.6 * length);
    this.group.position.copy(from);
    this.group.quaternion.setFromUnitVectors(ARROW_AXIS, vector.clone().divideScalar(length));
    for (const shaft of this.shafts) shaft.scale.set(this.thickness, length - head, this.thickness);
    for (const point of this.heads) {
      point.position.y = length - head;
      point.scale.set(this.thickness, head, this.thickness);
    }
  }
}
