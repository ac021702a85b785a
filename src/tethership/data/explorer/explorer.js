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

// A replay is loaded once it is to be seen, not with every flight.
const played = () => {
  for (const frame of document.querySelectorAll("iframe.space:not([src])")) {
    if (frame.offsetParent) frame.src = frame.dataset.src;
  }
};

const mended = () => {
  named();
  played();
};
new MutationObserver(mended).observe(document.documentElement, { childList: true, subtree: true });

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
    fit: (figure, theme) => (figure ? fitted(figure, theme) : window.dash_clientside.no_update),
    // Ask again how the work stands once it was answered, never while an answer is awaited.
    pulse(next, count) {
      if (next) setTimeout(() => window.dash_clientside.set_props("tick", { n_intervals: (count ?? 0) + 1 }), next[0]);
    },
    theme(clicks) {
      if (clicks) window.theme.turn();
      return window.theme.now();
    },
    show(view) {
      requestAnimationFrame(played);
      return ["trim", "locus", "flight"].map((name) => (name === view ? {} : { display: "none" }));
    },
    shape(chosen) {
      requestAnimationFrame(played);
      return `as-${chosen}`;
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
