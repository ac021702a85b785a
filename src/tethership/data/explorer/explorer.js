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
