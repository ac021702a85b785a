// Histories beside the scene. One cursor goes through all of them; a click or a drag seeks.

const SIDE = 140; // to the right of the axes, for the names of the series [px]
const PLOT_FONT = "11px system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

// Names that find room beside the title of the tension plot; more go below it.
const MOST_BESIDE_TITLE = 2;

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
    const column = (one) => tracks[one.f].column(one.track, one.index).map(one.of || ((v) => v));
    const tables = this.flights.map((_, f) => [
      tracks[f].column("time"),
      ...panel.series.filter((one) => one.f === f).map(column),
    ]);
    panel.series.sort((a, b) => a.f - b.f);
    const data = tables.length > 1 ? uPlot.join(tables) : tables[0];
    const alike = panel.alike ? this.panels.filter((other) => other.alike === panel.alike) : [];
    panel.range = extent(
      panel,
      this.flights,
      alike.length ? alike.flatMap((other) => other.series.map(column)) : data.slice(1),
    );
    if (panel.log)
      for (let i = 1; i < data.length; i += 1)
        data[i] = data[i].map((v) => (v === null || v === undefined ? null : Math.max(v, panel.range[0])));
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
      item.innerHTML = `<svg viewBox="0 0 26 4"><path d="M0 2h26" stroke="${one.colour}" stroke-width="${one.width * 1.6}" stroke-dasharray="${one.dash.join(" ")}"/></svg><span></span> <b></b>`;
      item.querySelector("span").textContent = one.label;
      item.classList.toggle("alone", panel.series.length === 1);
      list.append(item);
      panel.entries.push({ one, value: item.querySelector("b") });
    }
    panel.box.classList.toggle("many", Boolean(panel.log) && panel.entries.length > MOST_BESIDE_TITLE);
  }

  options(panel) {
    const axis = {
      font: PLOT_FONT,
      stroke: "#595959",
      grid: { stroke: "#e6e6e3", width: 1 },
      ticks: { stroke: "#c9c9c9", size: 4, width: 1 },
    };
    const plain = (_, values) => values.map((value) => (value === null ? "" : String(Number(value.toPrecision(6)))));
    const decades = (_, splits) => splits.map((value) => (/^1e/.test(value.toExponential()) ? value : null));
    const sparse = panel.log
      ? { filter: decades, grid: { ...axis.grid, filter: decades }, ticks: { ...axis.ticks, filter: decades } }
      : {};
    return {
      width: 300,
      height: 100,
      padding: [6, SIDE, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false }, sync: { key: "time" } },
      scales: { x: { time: false, range: [0, this.clock.end] }, y: { distr: panel.log ? 3 : 1, range: panel.range } },
      axes: [
        {
          ...axis,
          size: panel.last ? 22 : 8,
          label: panel.last ? "time [s]" : undefined,
          labelFont: PLOT_FONT,
          labelSize: 15,
          labelGap: 0,
          gap: 2,
          values: panel.last ? plain : () => [],
        },
        { ...axis, size: 46, gap: 3, space: 22, values: plain, ...sparse },
      ],
      series: [
        {},
        ...panel.series.map((one) => ({
          stroke: one.colour,
          width: one.width,
          dash: one.dash,
          points: { show: false },
          spanGaps: true,
        })),
      ],
      hooks: { drawClear: [(plot) => this.shade(plot)], draw: panel.log ? [(plot) => this.limits(plot)] : [] },
    };
  }

  // Gusts, in the background.
  shade(plot) {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = DATA.colours.gust;
    for (const [start, end] of this.flights.flatMap((flight) => flight.gusts)) {
      const [left, right] = [start, end].map((time) =>
        Math.min(Math.max(plot.valToPos(time, "x", true), bbox.left), bbox.left + bbox.width),
      );
      ctx.fillRect(left, bbox.top, right - left, bbox.height);
    }
    ctx.restore();
  }

  // Watched tensions: dashed lines with their names on the right.
  limits(plot) {
    const { ctx, bbox } = plot;
    const ratio = devicePixelRatio;
    const several = limitsDiffer(this.flights);
    const found = (several ? this.flights : this.flights.slice(0, 1)).flatMap((flight, k) =>
      flight.limits.map((limit, i) => ({
        ...limit,
        name: several ? `${LETTERS[k]} ${limit.name}` : limit.name,
        colour: DATA.colours.limits[i % 4],
        y: plot.valToPos(limit.value, "y", true),
      })),
    );
    ctx.save();
    ctx.font = PLOT_FONT.replace("11px", `${10 * ratio}px`);
    ctx.textBaseline = "middle";
    ctx.textAlign = "left";
    ctx.lineWidth = ratio;
    ctx.setLineDash([6 * ratio, 3 * ratio]);
    const place = spread(
      found.sort((a, b) => b.y - a.y).map((limit) => limit.y),
      11 * ratio,
      bbox.top + ratio,
    );
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
    const heads = this.panels.reduce((sum, panel) => {
      const wrapped = panel.box.classList.contains("many") ? panel.box.querySelector("ul").offsetHeight : 0;
      return sum + panel.box.querySelector("h2").offsetHeight + wrapped;
    }, 0);
    const free =
      this.parent.clientHeight - parseFloat(styles.paddingTop) - parseFloat(styles.paddingBottom) - heads - foot;
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
        const text = number
          .toFixed(digits)
          .replace(/^-(0(\.0+)?)$/, "$1")
          .replace("-", "−");
        if (value.textContent !== text) value.textContent = text;
      }
    }
  }
}
