// Histories beside the scene. One cursor goes through all of them; a click or a drag seeks.

const FLIGHT_COLOURS = ["#0072b2", "#d55e00"];
const SIX_COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#000000"];
const CABLE_DASHES = [[], [7, 3], [2, 2], [8, 3, 2, 3]];
const SIDE = 132; // to the right of the axes, for the names of the series [px]
const PLOT_FONT = "11px system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

// What is plotted: panels of series, each series a column of a flight's track.
const makePanels = (flights, tracks) => {
  const two = flights.length > 1;
  const cables = flights.flatMap((flight, f) => flight.cables.map((cable, i) => ({ f, i, cable: cable.name })));
  const several = flights.some((flight) => flight.cables.length > 1);
  const named = (f, words) => [two ? LETTERS[f] : "", words].filter(Boolean).join(": ");
  const perCable = (track, words) =>
    cables.map(({ f, i, cable }) => ({
      f,
      track,
      index: i,
      label: named(f, several ? cable : words),
      colour: two ? FLIGHT_COLOURS[f] : DATA.colours.series[i % DATA.colours.series.length],
      dash: two ? CABLE_DASHES[i % CABLE_DASHES.length] : [],
    }));
  const each = (track, labels, f, dash = []) =>
    labels.map((label, index) => ({ f, track, index, label, colour: SIX_COLOURS[index % SIX_COLOURS.length], dash }));
  const panels = [
    { title: "tension", unit: "N", log: true, tall: 1.5, series: perCable("tension", "") },
    {
      title: two ? "cable length" : "cable length, distance to anchor",
      unit: "m",
      zero: true,
      series: [
        ...perCable("cable_length", two ? "" : "length"),
        ...(two ? [] : perCable("distance", "distance").map((one) => ({ ...one, dash: [3, 3], label: several ? null : one.label }))),
      ],
    },
    { title: "rewind rate", unit: "m/s", zero: true, tall: 0.75, series: perCable("rewind_rate", "") },
    ...flights.map((flight, f) => ({
      title: two ? `throttle ${LETTERS[f]}` : "throttle",
      unit: "–",
      span: [-1, 1],
      series: each("throttle", flight.ship.thrusters.map((one) => one.name.replace("starboard", "stbd")), f),
    })),
    {
      title: two ? "attitude (B dashed)" : "attitude",
      unit: "°",
      least: 1,
      series: flights.flatMap((_, f) => each("attitude", f ? [null, null, null] : ["roll", "pitch", "yaw"], f, f ? [5, 3] : [])),
    },
  ];
  if (!cables.length) {
    const straight = flights.map((flight, f) => ({ f, track: "centre", index: 2, label: named(f, ""), colour: FLIGHT_COLOURS[f], dash: [], of: (down) => flight.ground - down }));
    panels.unshift({ title: "altitude of B", unit: "m", least: 1, series: straight });
  }
  for (const panel of panels) panel.series = panel.series.filter((one) => tracks[one.f].has(one.track));
  return panels.filter((panel) => panel.series.length);
};

// Places from bottom to top [px] moved apart to a least gap, none above a top.
const spread = (places, gap, top) => {
  const found = [...places];
  for (let i = 1; i < found.length; i += 1) found[i] = Math.min(found[i], found[i - 1] - gap);
  for (let i = found.length - 1, least = top; i >= 0; i -= 1, least += gap) found[i] = Math.max(found[i], least);
  return found;
};

const extent = (panel, flights, columns) => {
  const numbers = columns.flat().filter((value) => value !== null && Number.isFinite(value));
  let low = numbers.reduce((a, b) => Math.min(a, b), Infinity);
  let high = numbers.reduce((a, b) => Math.max(a, b), -Infinity);
  if (panel.log) {
    const limits = flights.flatMap((flight) => flight.limits.map((limit) => limit.value));
    const least = numbers.reduce((a, b) => (b > 0.1 ? Math.min(a, b) : a), 100);
    return [10 ** Math.floor(Math.log10(least)), 1.5 * Math.max(high, ...limits)];
  }
  if (panel.span) [low, high] = [Math.min(low, panel.span[0]), Math.max(high, panel.span[1])];
  const lack = (panel.least || 0) - (high - low);
  if (lack > 0) [low, high] = [low - 0.5 * lack, high + 0.5 * lack];
  if (panel.zero) [low, high] = [Math.min(low, 0), Math.max(high, 0)];
  const air = 0.06 * (high - low || Math.abs(high) || 1);
  return [panel.zero && low === 0 ? 0 : low - air, high + air];
};

class Plots {
  constructor(parent, flights, tracks, clock) {
    this.parent = parent;
    this.clock = clock;
    this.flights = flights;
    this.panels = makePanels(flights, tracks);
    this.panels.forEach((panel, i) => this.build(panel, tracks, i === this.panels.length - 1));
  }

  build(panel, tracks, last) {
    panel.last = last;
    panel.box = document.createElement("section");
    panel.box.className = "panel";
    panel.box.innerHTML = `<h2></h2><div class="plot"></div><ul></ul>`;
    panel.box.querySelector("h2").textContent = `${panel.title} [${panel.unit}]`;
    panel.box.classList.toggle("log", Boolean(panel.log));
    this.legend(panel);
    this.parent.append(panel.box);
    const tables = this.flights.map((_, f) => {
      const own = panel.series.filter((one) => one.f === f);
      return [tracks[f].column("time"), ...own.map((one) => tracks[f].column(one.track, one.index).map(one.of || ((v) => v)))];
    });
    panel.series.sort((a, b) => a.f - b.f);
    const data = tables.length > 1 ? uPlot.join(tables) : tables[0];
    panel.range = extent(panel, this.flights, data.slice(1));
    if (panel.log) for (let i = 1; i < data.length; i += 1) data[i] = data[i].map((v) => (v === null || v === undefined ? null : Math.max(v, panel.range[0])));
    panel.plot = new uPlot(this.options(panel), data, panel.box.querySelector(".plot"));
    panel.cursor = document.createElement("div");
    panel.cursor.className = "now";
    panel.plot.over.append(panel.cursor);
    this.seekBy(panel.plot);
  }

  legend(panel) {
    const list = panel.box.querySelector("ul");
    panel.entries = [];
    for (const one of panel.series) {
      if (one.label === null) continue;
      const item = document.createElement("li");
      item.innerHTML = `<svg viewBox="0 0 18 4"><path d="M0 2h18" stroke="${one.colour}" stroke-dasharray="${one.dash.join(" ")}"/></svg><span></span> <b></b>`;
      item.querySelector("span").textContent = one.label;
      item.classList.toggle("alone", panel.series.length === 1);
      list.append(item);
      panel.entries.push({ one, value: item.querySelector("b") });
    }
  }

  options(panel) {
    const axis = { font: PLOT_FONT, stroke: "#595959", grid: { stroke: "#e6e6e3", width: 1 }, ticks: { stroke: "#c9c9c9", size: 4, width: 1 } };
    const plain = (_, values) => values.map((value) => (value === null ? "" : String(Number(value.toPrecision(6)))));
    const decades = (_, splits) => splits.map((value) => (/^1e/.test(value.toExponential()) ? value : null));
    const sparse = panel.log ? { filter: decades, grid: { ...axis.grid, filter: decades }, ticks: { ...axis.ticks, filter: decades } } : {};
    return {
      width: 300,
      height: 100,
      padding: [6, SIDE, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false }, sync: { key: "time" } },
      scales: { x: { time: false, range: [0, this.clock.end] }, y: { distr: panel.log ? 3 : 1, range: panel.range } },
      axes: [
        { ...axis, size: panel.last ? 22 : 8, label: panel.last ? "time [s]" : undefined, labelFont: PLOT_FONT, labelSize: 15, labelGap: 0, gap: 2, values: panel.last ? plain : () => [] },
        { ...axis, size: 46, gap: 3, space: 22, values: plain, ...sparse },
      ],
      series: [{}, ...panel.series.map((one) => ({ stroke: one.colour, width: 1.25, dash: one.dash, points: { show: false }, spanGaps: true }))],
      hooks: { drawClear: [(plot) => this.shade(plot)], draw: panel.log ? [(plot) => this.limits(plot)] : [] },
    };
  }

  // Gusts, in the background.
  shade(plot) {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = DATA.colours.gust;
    for (const [start, end] of this.flights.flatMap((flight) => flight.gusts)) {
      const [left, right] = [start, end].map((time) => Math.min(Math.max(plot.valToPos(time, "x", true), bbox.left), bbox.left + bbox.width));
      ctx.fillRect(left, bbox.top, right - left, bbox.height);
    }
    ctx.restore();
  }

  // Watched tensions: dashed lines with their names on the right.
  limits(plot) {
    const { ctx, bbox } = plot;
    const ratio = devicePixelRatio;
    const found = this.flights[0].limits.map((limit, i) => ({ ...limit, colour: DATA.colours.limits[i % 4], y: plot.valToPos(limit.value, "y", true) }));
    ctx.save();
    ctx.font = PLOT_FONT.replace("11px", `${10 * ratio}px`);
    ctx.textBaseline = "middle";
    ctx.textAlign = "left";
    ctx.lineWidth = ratio;
    ctx.setLineDash([6 * ratio, 3 * ratio]);
    const place = spread(found.sort((a, b) => b.y - a.y).map((limit) => limit.y), 11 * ratio, bbox.top + ratio);
    found.forEach((limit, i) => {
      ctx.strokeStyle = ctx.fillStyle = limit.colour;
      ctx.beginPath();
      ctx.moveTo(bbox.left, limit.y);
      ctx.lineTo(bbox.left + bbox.width, limit.y);
      ctx.stroke();
      const words = `${limit.name.replace("control ", "").replace("envelope ", "")} ${Number(limit.value.toPrecision(4))}`;
      ctx.fillText(words, bbox.left + bbox.width + 5 * ratio, place[i]);
    });
    ctx.restore();
  }

  seekBy(plot) {
    const seek = (event) => {
      const { left } = plot.over.getBoundingClientRect();
      this.clock.seek(plot.posToVal(event.clientX - left, "x"));
    };
    plot.over.addEventListener("pointerdown", (event) => {
      plot.over.setPointerCapture(event.pointerId);
      seek(event);
    });
    plot.over.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) seek(event);
    });
  }

  resize() {
    const styles = getComputedStyle(this.parent);
    const stacked = styles.overflowY === "visible";
    const foot = 29; // the time axis
    const heads = this.panels.reduce((sum, panel) => sum + panel.box.querySelector("h2").offsetHeight, 0);
    const free = this.parent.clientHeight - parseFloat(styles.paddingTop) - parseFloat(styles.paddingBottom) - heads - foot;
    const share = this.panels.reduce((sum, panel) => sum + (panel.tall || 1), 0);
    for (const panel of this.panels) {
      const tall = panel.tall || 1;
      const names = 16 * panel.entries.length + 12;
      const height = Math.max(stacked ? 120 * tall : (free * tall) / share, panel.log ? 130 : names, 60);
      const width = panel.box.clientWidth;
      if (width > 0) panel.plot.setSize({ width, height: Math.floor(height + (panel.last ? foot : 0)) });
    }
    this.place(this.clock.time);
  }

  // Move the cursors to a time [s].
  place(time) {
    for (const panel of this.panels) {
      panel.left = panel.plot.valToPos(time, "x");
      panel.cursor.style.transform = `translateX(${panel.left.toFixed(2)}px)`;
    }
  }

  // Write the values into the legends.
  tell(instants) {
    for (const panel of this.panels) {
      for (const { one, value } of panel.entries) {
        const number = (one.of || ((v) => v))(instants[one.f].values(one.track)[one.index]);
        const digits = panel.unit === "N" ? 0 : panel.unit === "°" ? 1 : 2;
        const text = number.toFixed(digits).replace(/^-(0(\.0+)?)$/, "$1").replace("-", "−");
        if (value.textContent !== text) value.textContent = text;
      }
    }
  }
}
