// The numbers of the time shown, in the corner of a stage.

const READOUT = [
  { name: "tension", track: "tension", unit: "N", digits: 0, each: "cable" },
  { name: "cable length", track: "cable_length", unit: "m", digits: 2, each: "cable" },
  { name: "distance to anchor", track: "distance", unit: "m", digits: 2, each: "cable" },
  { name: "rewind rate", track: "rewind_rate", unit: "m/s", digits: 3, each: "cable" },
];

const windFrom = (velocity) => (velocity.length() < 0.005 ? "" : ` from ${comesFrom(velocity)}`);

class Readout {
  constructor(parent, flight, tracks, scale) {
    this.flight = flight;
    this.tracks = tracks;
    this.scale = scale;
    this.table = parent.querySelector(".readout");
    this.rows = [];
    if (flight.cables.length > 1) this.heading(flight.cables.map((cable) => cable.name));
    for (const row of READOUT) {
      if (tracks.has(row.track) && flight.cables.length)
        this.row(
          row.name,
          row.unit,
          flight.cables.length,
          (now) => now.values(row.track).map((v) => v.toFixed(row.digits)),
          row.track,
        );
    }
    this.row("altitude", "m", 1, (now) => [(flight.ground - now.values("centre")[2]).toFixed(2)]);
    if (tracks.has("wind"))
      this.row(
        "wind",
        "m/s",
        1,
        (now) => [now.vector("wind").length().toFixed(2)],
        "wind",
        (now) => `m/s${windFrom(now.vector("wind"))}`,
      );
    if (tracks.has("air_velocity") && !flight.cables.length) {
      this.row("airspeed", "m/s", 1, (now) => [now.vector("air_velocity").length().toFixed(2)]);
    }
  }

  heading(names) {
    const line = this.table.createTHead().insertRow();
    for (const name of ["", ...names, ""]) {
      const cell = document.createElement("th");
      cell.textContent = name;
      line.append(cell);
    }
  }

  row(name, unit, count, numbers, track = name, units = null) {
    const line = this.table.tBodies[0].insertRow();
    line.dataset.track = track;
    const head = document.createElement("th");
    head.textContent = name;
    line.append(head);
    const cells = Array.from({ length: count }, () => line.insertCell());
    cells[0].colSpan = Math.max(this.flight.cables.length, 1) / count;
    const last = line.insertCell();
    last.className = "unit";
    last.textContent = unit;
    this.rows.push({ cells, numbers, track, last, units });
  }

  place(now) {
    for (const { cells, numbers, track, last, units } of this.rows) {
      if (units) last.textContent = units(now);
      const found = numbers(now);
      cells.forEach((cell, i) => {
        if (cell.textContent !== found[i]) cell.textContent = found[i];
        if (track === "tension")
          cell.style.setProperty("--tension", `#${this.scale.colour(Number(found[i])).getHexString()}`);
      });
    }
  }
}

// What the colours and arrows mean.
const fillKey = (element, flights, scale) => {
  const { stops } = scale;
  const cables = flights.some((flight) => flight.cables.length);
  const thrusters = flights.flatMap((flight) => flight.ship.thrusters);
  const parts = [];
  if (cables) {
    const steps = scale.colours.map(
      (colour, i) => `#${colour.getHexString()} ${(100 * scale.place(stops[i])).toFixed(1)}%`,
    );
    const marks = scale.limits.map(
      (stop) => `<span style="left:${(100 * scale.place(stop)).toFixed(1)}%">${Number(stop.toPrecision(4))}</span>`,
    );
    parts.push(
      `<div class="scale"><b>tension [N]</b><i style="background:linear-gradient(to right,${steps.join()})"></i>` +
        `<div>${marks.join("")}</div></div>`,
    );
  }
  const arrow = (colour, words) =>
    `<div><svg viewBox="0 0 26 8"><path fill="${colour}" d="M0 3h17V.5L26 4l-9 3.5V5H0z"/></svg>${words}</div>`;
  if (thrusters.length) {
    const nominal = new Set(thrusters.map((one) => one.nominal));
    const full = nominal.size === 1 ? `, ${[...nominal][0]} N at full throttle` : "";
    parts.push(arrow(DATA.colours.arrows.thrust, `thrust on the ship${full}`));
  }
  element.innerHTML = parts.join("");
};
