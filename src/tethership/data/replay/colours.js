// What has which colour. The figures' colours come with the data; these are the scene's own.

const SCENE_COLOURS = {
  hull: "#e9e8e3",
  seam: "#bcbab2",
  fin: "#b9c6d2",
  edge: "#5d6b78",
  thruster: "#3a3a3a",
  grid: "#cfc4b0",
  shadow: "#cbbfa8",
  staff: "#8a8272",
};

// Whether two flights watch different tensions.
const limitsDiffer = (flights) => new Set(flights.map((flight) => JSON.stringify(flight.limits))).size > 1;

// Colours of tension: the last ones at the watched limits, the first two at a thirtieth and a third of the lowest; in
// between by the logarithm of the tension.
class TensionScale {
  constructor(limits) {
    const values = limits.map((limit) => limit.value).sort((a, b) => a - b);
    this.stops = [values[0] / 30, values[0] / 3, ...values];
    this.limits = values;
    const { tension } = DATA.colours;
    this.colours = this.stops.map((_, i) => new THREE.Color(tension[Math.min(i, tension.length - 1)]));
  }

  colour(tension) {
    const { stops, colours } = this;
    const last = stops.length - 1;
    if (!(tension > stops[0])) return colours[0].clone();
    if (tension >= stops[last]) return colours[last].clone();
    const i = stops.findIndex((stop) => stop > tension) - 1;
    const part = Math.log(tension / stops[i]) / Math.log(stops[i + 1] / stops[i]);
    return colours[i].clone().lerp(colours[i + 1], part);
  }

  // Where a tension stands on the scale, 0 to 1.
  place(tension) {
    const { stops } = this;
    return Math.log(tension / stops[0]) / Math.log(stops[stops.length - 1] / stops[0]);
  }
}
