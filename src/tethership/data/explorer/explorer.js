// On a page narrower than this a figure's panels stand one above the other [px].
const NARROW = 700;

const axesOf = (layout, letter) => Object.keys(layout).filter((key) => new RegExp(`^${letter}axis\\d*$`).test(key));

const stacked = (figure) => {
  const { layout } = figure;
  const columns = new Set(axesOf(layout, "x").map((name) => String(layout[name].domain))).size;
  return columns > 1 ? columnsStacked(figure, columns) : legendsAbove(figure);
};

// Panels that stood beside each other; their titles and colour bars go with them.
const columnsStacked = (figure, count) => {
  const { layout } = figure;
  const gap = 0.34 / count;
  const tall = (1 - gap * (count - 1)) / count;
  const tops = Array.from({ length: count }, (_, i) => 1 - i * (tall + gap));
  const bars = figure.data.some((trace) => trace.marker?.showscale);
  axesOf(layout, "x").forEach((name, i) => {
    layout[name].domain = [0, bars ? 0.8 : 1];
    layout[name.replace("x", "y")].domain = [Math.max(tops[i] - tall, 0), tops[i]];
  });
  layout.annotations
    .filter((note) => note.xref === "paper")
    .forEach((title, i) => Object.assign(title, { x: 0, xanchor: "left", y: tops[i] }));
  for (const trace of figure.data) {
    const top = tops[Number((trace.xaxis ?? "x").slice(1) || 1) - 1];
    if (trace.marker?.colorbar) Object.assign(trace.marker.colorbar, { x: 0.82, y: top - tall / 2, len: tall });
  }
  layout.height = 360 * count;
  Object.assign(layout.margin, { l: 60, r: 10 });
  return figure;
};

// Legends that stood beside their panels go above them.
const legendsAbove = (figure) => {
  const { layout } = figure;
  const rows = axesOf(layout, "y");
  const gap = 0.08;
  const share = rows.reduce((sum, name) => sum + layout[name].domain[1] - layout[name].domain[0], 0);
  let top = 1;
  rows.forEach((name, i) => {
    const tall = ((layout[name].domain[1] - layout[name].domain[0]) / share) * (1 - gap * (rows.length - 1));
    layout[name].domain = [Math.max(top - tall, 0), top];
    const place = { orientation: "h", x: 0, xanchor: "left", y: top, yanchor: "bottom", font: { size: 10 } };
    layout[i ? `legend${i + 1}` : "legend"] = place;
    top -= tall + gap;
  });
  layout.height = 1200;
  Object.assign(layout.margin, { l: 50, t: 130 });
  for (const menu of layout.updatemenus ?? []) menu.y = 1.06;
  return figure;
};

// Dash gives no names to its sliders, and to its lists only what is chosen: they get the words of their label.
const named = () => {
  for (const thumb of document.querySelectorAll('[role="slider"]:not([aria-label])')) {
    const words = thumb.closest(".field")?.querySelector(".name")?.textContent;
    if (words) thumb.setAttribute("aria-label", words);
  }
  for (const list of document.querySelectorAll("button.dash-dropdown[id]")) {
    const label = document.querySelector(`label[for="${CSS.escape(list.id)}"]`);
    const wanted = `${list.id}-label ${list.id}-value`;
    if (!label || list.getAttribute("aria-labelledby") === wanted) continue;
    label.id = `${list.id}-label`;
    list.setAttribute("aria-labelledby", wanted);
  }
};
new MutationObserver(named).observe(document.documentElement, { childList: true, subtree: true });

window.dash_clientside = Object.assign({}, window.dash_clientside, {
  explorer: {
    // A slider writes its number into the text; a text that is a plain number moves the slider.
    follow(text, position) {
      const same = window.dash_clientside.no_update;
      const moved = window.dash_clientside.callback_context.triggered.map((one) => one.prop_id).join(" ");
      if (moved.includes('"part":"slider"')) {
        const words = String(Number(Number(position).toPrecision(6)));
        return [Number(text) === Number(words) ? same : words, same];
      }
      const number = String(text).trim() === "" ? NaN : Number(text);
      return [same, Number.isFinite(number) && number !== position ? number : same];
    },
    mark(texts, own) {
      return own.map((text, index) => (String(texts[index] ?? "").trim() === text ? "field" : "field changed"));
    },
    fit: (figure) => (figure && window.innerWidth < NARROW ? stacked(structuredClone(figure)) : figure),
    show(view) {
      return ["trim", "locus", "flight"].map((name) => (name === view ? {} : { display: "none" }));
    },
    download(clicks, text, name) {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text], { type: "application/toml" }));
      link.download = String(name || "scenario.toml").replace(/[^A-Za-z0-9_.-]/g, "_").replace(/^\.+/, "");
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
      return "";
    },
  },
});
