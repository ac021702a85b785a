// The air at B as arrows above the ship: the mean wind, and what gusts and turbulence add to it, head to tail.

const LONGEST_WIND = 0.42; // length of the arrow of the strongest wind, over the hull's length

const POINTS = ["N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"];

// The point of the compass from which air of a velocity (north, east) comes.
const comesFrom = (velocity) => {
  const azimuth = (Math.atan2(-velocity.y, -velocity.x) * 180) / Math.PI;
  return POINTS[(Math.round(azimuth / 22.5) + 16) % 16];
};

const strongestWind = (tracks) => {
  if (!tracks.has("wind")) return 0;
  const { data } = tracks.found.wind;
  let strongest = 0;
  for (let i = 0; i < data.length; i += 3)
    strongest = Math.max(strongest, Math.hypot(data[i], data[i + 1], data[i + 2]));
  return strongest;
};

class Wind {
  // `perSpeed` is the length of an arrow per speed [m per m/s].
  constructor(ship, perSpeed, labels) {
    this.perSpeed = perSpeed;
    this.height = 0.5 * ship.diameter + 0.14 * ship.length;
    this.length = ship.length;
    this.mean = new Arrow(DATA.colours.arrows.wind, 0.008 * ship.length);
    this.gust = new Arrow(DATA.colours.arrows.gust, 0.008 * ship.length);
    this.group = new THREE.Group();
    this.group.add(this.mean.group, this.gust.group);
    this.meanLabel = labels.add("", "wind");
    this.gustLabel = labels.add("", "gust");
  }

  place(now, centre) {
    const gust = now.vector("gust");
    const mean = now.vector("wind").sub(gust);
    const arrow = mean.clone().multiplyScalar(this.perSpeed);
    const start = centre.clone().addScaledVector(UP, this.height).addScaledVector(arrow, -0.5);
    this.mean.set(start, arrow);
    this.gust.set(this.mean.to, gust.clone().multiplyScalar(this.perSpeed));
    this.tell(this.meanLabel, start, mean, "wind");
    this.tell(this.gustLabel, this.gust.to, gust, "gust");
  }

  tell(label, point, velocity, name) {
    const speed = velocity.length();
    label.shown = speed > 0.05;
    label.point.copy(point);
    const level = Math.hypot(velocity.x, velocity.y) > 0.3 * speed;
    const where = level ? ` from ${comesFrom(velocity)}` : velocity.z < 0 ? " upward" : " downward";
    label.text(`${name} ${speed.toFixed(1)} m/s${where}`);
  }
}
