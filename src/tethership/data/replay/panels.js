// What is plotted: panels of series, each series a column of a flight's track.

const THIN = 1.25; // of lines [px]; those of a second flight are thick
const THICK = 2.4;
const DISTANCE_DASH = [3, 3];

const turned = (list, index) => list[index % list.length];

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
      colour: two ? DATA.colours.flights[f] : turned(DATA.colours.series, i),
      dash: turned(DATA.colours.dashes, i),
      width: f ? THICK : THIN,
    }));
  const each = (track, labels, f) =>
    labels.map((label, index) => ({
      f,
      track,
      index,
      label,
      colour: turned(DATA.colours.series, index),
      dash: turned(DATA.colours.dashes, index),
      width: THIN,
    }));
  const panels = [
    { title: "tension", unit: "N", log: true, tall: 1.5, series: perCable("tension", "") },
    {
      title: "cable length, distance to anchor",
      unit: "m",
      zero: true,
      series: [
        ...perCable("cable_length", "length"),
        ...perCable("distance", "distance").map((one) => ({
          ...one,
          dash: DISTANCE_DASH,
          label: several ? null : one.label,
        })),
      ],
    },
    { title: "rewind rate", unit: "m/s", zero: true, tall: 0.75, series: perCable("rewind_rate", "") },
    ...flights.map((flight, f) => ({
      title: two ? `throttle ${LETTERS[f]}` : "throttle",
      unit: "–",
      span: [-1, 1],
      series: each(
        "throttle",
        flight.ship.thrusters.map((one) => one.name.replace("starboard", "stbd")),
        f,
      ),
    })),
    ...flights.map((_, f) => ({
      title: two ? `attitude ${LETTERS[f]}` : "attitude",
      unit: "°",
      least: 1,
      alike: "attitude",
      series: each("attitude", ["roll", "pitch", "yaw"], f),
    })),
  ];
  if (!cables.length) {
    const straight = flights.map((flight, f) => ({
      f,
      track: "centre",
      index: 2,
      label: named(f, ""),
      colour: DATA.colours.flights[f],
      dash: turned(DATA.colours.dashes, f),
      width: f ? THICK : THIN,
      of: (down) => flight.ground - down,
    }));
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
