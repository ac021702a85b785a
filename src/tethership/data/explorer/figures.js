// Figures fitted to the page: stacked where it is narrow, in colours for dark where it is dark.

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

// Lightness of ink and of paper in the dark; what is between keeps its order, turned round.
const [INK_IN_DARK, PAPER_IN_DARK] = [1, 0.28];

const pen = document.createElement("canvas").getContext("2d");

// A colour as red, green, blue [0 … 1] and opacity.
const channels = (colour) => {
  pen.fillStyle = colour;
  const [, hex, list] = pen.fillStyle.match(/^(?:#(\w+)|rgba?\((.*)\))$/);
  const parts = hex ? hex.match(/../g).map((two) => parseInt(two, 16)) : list.split(",").map(Number);
  return [...parts.slice(0, 3).map((part) => part / 255), parts[3] ?? 1];
};

const linear = (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
const coded = (part) => (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055);

// The same hue with its lightness turned round, in OKLab (B. Ottosson, 2020): ink becomes light, paper dark.
const inDark = (colour) => {
  const [r, g, b, opacity] = channels(colour);
  const [l, m, s] = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
  ].map((row) => Math.cbrt(row[0] * linear(r) + row[1] * linear(g) + row[2] * linear(b)));
  const lightness = 0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s;
  const green = 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s;
  const blue = 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s;
  const turned = INK_IN_DARK - (INK_IN_DARK - PAPER_IN_DARK) * lightness;
  const [x, y, z] = [
    turned + 0.3963377774 * green + 0.2158037573 * blue,
    turned - 0.1055613458 * green - 0.0638541728 * blue,
    turned - 0.0894841775 * green - 1.291485548 * blue,
  ].map((root) => root ** 3);
  const mixed = [
    4.0767416621 * x - 3.3077115913 * y + 0.2309699292 * z,
    -1.2684380046 * x + 2.6097574011 * y - 0.3413193965 * z,
    -0.0041960863 * x - 0.7034186147 * y + 1.707614701 * z,
  ].map((part) => Math.round(255 * Math.min(1, Math.max(0, coded(Math.max(0, part))))));
  return `rgba(${mixed.join(", ")}, ${opacity})`;
};

// Colour scales begin with colours that the dark would swallow: their first third is left out.
const SWALLOWED = 1 / 3;
const lightScale = (scale) =>
  scale.filter(([at]) => at >= SWALLOWED).map(([at, colour]) => [(at - SWALLOWED) / (1 - SWALLOWED), colour]);

const darkened = (value, key = "") => {
  if (key === "colorscale") return Array.isArray(value) ? lightScale(value) : value;
  if (typeof value === "string") return /color$/.test(key) && CSS.supports("color", value) ? inDark(value) : value;
  if (Array.isArray(value)) return typeof value[0] === "number" ? value : value.map((one) => darkened(one, key));
  if (!value || typeof value !== "object" || ArrayBuffer.isView(value)) return value;
  return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, darkened(one, name)]));
};

// Plotly paints the button that is pressed in a light colour of its own, so the others are light too.
const lightButtons = (layout) => {
  for (const menu of layout.updatemenus ?? []) Object.assign(menu, { bgcolor: "#aab4bf", font: { color: "#111111" } });
};

const fitted = (figure, theme) => {
  const found = theme === "dark" ? darkened(figure) : structuredClone(figure);
  const style = getComputedStyle(document.documentElement);
  const [paper, ink] = ["--page", "--ink"].map((name) => style.getPropertyValue(name).trim());
  Object.assign(found.layout, { paper_bgcolor: paper, plot_bgcolor: paper, font: { ...found.layout.font, color: ink } });
  if (theme === "dark") lightButtons(found.layout);
  return window.innerWidth < NARROW && found.data.length ? stacked(found) : found;
};
