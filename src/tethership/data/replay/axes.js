// From ground axes (north, east, down) to those of three.js (x right, y up, z to the viewer): x east, y up, z south.
// This is the only place where the two meet. Whatever is in the group `earth` is in ground axes.

const GROUND_TO_SCENE = new THREE.Matrix4().set(0, 1, 0, 0, 0, 0, -1, 0, -1, 0, 0, 0, 0, 0, 0, 1);

const makeEarth = () => {
  const earth = new THREE.Group();
  earth.matrixAutoUpdate = false;
  earth.matrix.copy(GROUND_TO_SCENE);
  return earth;
};

const toScene = (vector) => vector.clone().applyMatrix4(GROUND_TO_SCENE);

const toGround = (vector) => vector.clone().applyMatrix4(GROUND_TO_SCENE.clone().invert());

const NORTH = new THREE.Vector3(1, 0, 0);
const UP = new THREE.Vector3(0, 0, -1);
