// Dark or light: as the system says, or as it was chosen here, which the browser remembers. Read before the page is
// painted.
window.theme = (() => {
  const NAME = "tethership-theme";
  const system = matchMedia("(prefers-color-scheme: dark)");
  const chosen = (change) => {
    try {
      return change(localStorage);
    } catch {
      return null; // a browser that keeps nothing
    }
  };
  const ofSystem = () => (system.matches ? "dark" : "light");
  const now = () => chosen((kept) => kept.getItem(NAME)) ?? ofSystem();
  const show = () => {
    document.documentElement.dataset.theme = now();
    window.dash_clientside?.set_props?.("theme", { data: now() });
  };
  const turn = () => {
    const other = now() === "dark" ? "light" : "dark";
    chosen((kept) => (other === ofSystem() ? kept.removeItem(NAME) : kept.setItem(NAME, other)));
    show();
  };
  system.addEventListener("change", show);
  document.documentElement.dataset.theme = now();
  return { now, turn };
})();
