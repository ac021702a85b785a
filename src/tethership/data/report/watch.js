(() => {
  const page = document.documentElement.dataset;
  page.errors = "0";
  const count = (what) => {
    page.errors = String(Number(page.errors) + 1);
    page.lastError = String(what);
  };
  addEventListener("error", (event) => count(event.message || `cannot load <${event.target.localName}>`), true);
  addEventListener("unhandledrejection", (event) => count(event.reason));
  addEventListener("securitypolicyviolation", (event) => count(`blocked ${event.blockedURI}`));
})();
