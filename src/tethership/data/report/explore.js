(() => {
  const page = document.documentElement.dataset;
  const plots = [...document.querySelectorAll("details.plot")];
  page.plots = "0";

  const library = () => {
    if (!window.Plotly) {
      const script = document.createElement("script");
      script.textContent = document.getElementById("plotly").textContent;
      document.head.append(script);
    }
    return window.Plotly;
  };

  const draw = async (details) => {
    if (details.dataset.drawn) return;
    details.dataset.drawn = "true";
    const { data, layout, frames } = JSON.parse(details.querySelector("script").textContent);
    const canvas = details.querySelector(".canvas");
    const narrow = canvas.clientWidth < 520;
    delete layout.width;
    layout.autosize = true;
    if (narrow) {
      delete layout.title;
      if (layout.legend && layout.legend.x > 1) layout.showlegend = false;
    }
    const config = { responsive: true, displaylogo: false, displayModeBar: narrow ? false : "hover" };
    await library().newPlot(canvas, { data, layout, frames, config });
    page.plots = String(Number(page.plots) + 1);
  };

  for (const details of plots) {
    details.addEventListener("toggle", () => details.open && draw(details));
  }

  const openAll = () => {
    if (location.hash === "#open-all") plots.forEach((details) => (details.open = true));
  };
  addEventListener("hashchange", openAll);
  openAll();

  const contents = document.querySelector("details.contents");
  if (contents && matchMedia("(max-width: 45rem)").matches) contents.open = false;

  addEventListener("load", () => {
    page.images = String([...document.images].filter((image) => image.naturalWidth > 0).length);
  });
})();
