// What a stage shows, read back from its scene: for tests.

const stageState = (stage) => {
  if (stage.blind) return { name: stage.flight.name, blind: true, readout: readoutOf(stage) };
  const { ship, cables, wind, rig, flight } = stage;
  stage.scene.updateMatrixWorld(true);
  const world = ship.group.localToWorld(new THREE.Vector3(...flight.ship.nose));
  const list = (vector) => vector.toArray();
  return {
    name: flight.name,
    centre: list(ship.point(flight.ship.axis)),
    nose: list(toGround(world)),
    nose_in_scene: list(world),
    tension: stage.now.values("tension"),
    cable_length: stage.now.values("cable_length"),
    thrusts: ship.arrows.map((arrow) => ({
      from: list(ship.point(arrow.from)),
      to: list(ship.point(arrow.to)),
      shown: arrow.group.visible,
    })),
    cables: cables.ends.map(([anchor, end], i) => ({ anchor, end, colour: cables.colours[i] })),
    wind: { from: list(wind.mean.from), to: list(wind.mean.to) },
    gust: { from: list(wind.gust.from), to: list(wind.gust.to), shown: wind.gust.group.visible },
    camera: { position: list(toGround(rig.camera.position)), target: list(toGround(rig.controls.target)) },
    nose_on_screen: list(toScene(ship.point(flight.ship.nose)).project(rig.camera)),
    readout: readoutOf(stage),
  };
};

const readoutOf = (stage) =>
  Array.from(stage.parent.parentElement.querySelectorAll(".readout tbody tr"), (row) => row.innerText.trim());
