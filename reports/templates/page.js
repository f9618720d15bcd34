"use strict";
(function () {
  const DATA = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const CONFIG = { displaylogo: false, showSendToCloud: false, plotlyServerURL: "", responsive: true,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "sendChartToCloud", "sendDataToCloud", "autoScale2d"] };
  const plots = Array.from(document.querySelectorAll(".plot"));
  let printing = false;

  function unpack(text) {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    return new Float32Array(bytes.buffer);
  }
  function colour(name) { return getComputedStyle(root).getPropertyValue(name).trim(); }
  function palette() { return [0, 1, 2, 3].map(function (i) { return colour("--c" + i); }); }
  function clear(hex, alpha) {
    const n = parseInt(hex.slice(1), 16);
    return "rgba(" + (n >> 16) + "," + ((n >> 8) & 255) + "," + (n & 255) + "," + alpha + ")";
  }

  function trace(t, arrays, colours) {
    const c = colours[t.colour], x = arrays[+t.x], y = arrays[+t.y];
    const out = { name: t.name, x: x, y: y, type: "scatter", mode: t.kind, line: { color: c, dash: t.dash, width: 1.6 } };
    if (t.shape) out.line.shape = t.shape;
    if (t.kind.indexOf("markers") >= 0) out.marker = { color: c, size: t.kind === "markers" ? 4 : 7 };
    if (t.kind === "edge") { out.mode = "lines"; out.line.width = 0; out.showlegend = false; }
    if (t.kind === "band") { out.mode = "lines"; out.line.width = 0; out.fill = "tonexty"; out.fillcolor = clear(c, 0.28); }
    if (t.kind === "bars") {
      const n = y.length, mid = new Float32Array(n), width = new Float32Array(n);
      for (let i = 0; i < n; i++) { mid[i] = (x[i] + x[i + 1]) / 2; width[i] = x[i + 1] - x[i]; }
      return { name: t.name, type: "bar", x: mid, y: y, width: width, marker: { color: c } };
    }
    return out;
  }

  function axis(extra, ink, line) {
    return Object.assign({ gridcolor: line, zerolinecolor: line, linecolor: ink, tickcolor: ink, ticks: "outside",
      automargin: true, exponentformat: "power" }, extra, { title: { text: extra.title.text, standoff: 8 } });
  }

  function draw(element) {
    const chart = DATA.charts[+element.dataset.chart];
    if (!chart.arrays) chart.arrays = chart.data.map(unpack);
    const colours = palette(), ink = colour("--ink"), line = colour("--line"), shade = clear(colour("--c2"), 0.13);
    const traces = chart.traces.map(function (t) { return trace(t, chart.arrays, colours); });
    const lines = traces.filter(function (t) { return t.showlegend !== false; });
    const layout = { paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", uirevision: chart.key,
      font: { color: ink, family: "system-ui, sans-serif", size: 12 }, hovermode: chart.timed ? "x unified" : "closest",
      hoverlabel: { bgcolor: colour("--bg"), font: { color: ink } }, margin: { l: 56, r: 10, t: 8, b: 44 },
      showlegend: lines.length > 1, legend: { orientation: "h", y: -0.24, x: 0 }, bargap: 0.02,
      modebar: { color: colour("--dim"), activecolor: ink, bgcolor: "rgba(0,0,0,0)" },
      xaxis: axis(chart.layout.xaxis, ink, line), yaxis: axis(chart.layout.yaxis, ink, line),
      shapes: chart.windows.map(function (w) {
        return { type: "rect", xref: "x", yref: "paper", x0: w[0], x1: w[1], y0: 0, y1: 1, fillcolor: shade, line: { width: 0 }, layer: "below" };
      }) };
    if (lines.length > 4) element.style.height = 300 + 19 * (lines.length - 3) + "px";
    if (printing) layout.width = 660;
    if (!printing && chart.timed && element.closest(".charts").range) layout.xaxis.range = element.closest(".charts").range.slice();
    const first = !element.dataset.drawn;
    element.dataset.drawn = "1";
    const done = Plotly.react(element, traces, layout, CONFIG);
    if (first && chart.timed) element.on("plotly_relayout", function (change) { link(element, change); });
    return done;
  }

  let linking = false;
  function link(element, change) {
    if (linking) return;
    const group = element.closest(".charts");
    const reset = change["xaxis.autorange"], low = change["xaxis.range[0]"], high = change["xaxis.range[1]"];
    if (!reset && low === undefined) return;
    group.range = reset ? null : [low, high];
    linking = true;
    const others = Array.from(group.querySelectorAll(".plot[data-drawn]")).filter(function (e) {
      return e !== element && DATA.charts[+e.dataset.chart].timed;
    });
    Promise.all(others.map(function (e) {
      return Plotly.relayout(e, reset ? { "xaxis.autorange": true } : { "xaxis.range": [low, high] });
    })).then(function () { linking = false; }, function () { linking = false; });
  }

  const HINT = "Keys: arrows left and right move, plus and minus zoom, zero shows all.";
  function press(element, event) {
    if (!element.dataset.drawn || event.altKey || event.ctrlKey || event.metaKey) return;
    const range = element._fullLayout.xaxis.range, low = range[0], high = range[1], span = high - low;
    const changes = { ArrowLeft: [-0.2, -0.2], ArrowRight: [0.2, 0.2], "+": [0.2, -0.2], "=": [0.2, -0.2], "-": [-1 / 3, 1 / 3] };
    const change = changes[event.key];
    if (event.key === "0") Plotly.relayout(element, { "xaxis.autorange": true });
    else if (change) Plotly.relayout(element, { "xaxis.range[0]": low + change[0] * span, "xaxis.range[1]": high + change[1] * span });
    else return;
    event.preventDefault();
  }
  plots.forEach(function (e) {
    e.tabIndex = 0;
    e.setAttribute("aria-description", HINT);
    e.title = HINT;
    e.addEventListener("keydown", function (event) { if (event.target === e) press(e, event); });
  });

  function redraw() {
    plots.filter(function (e) { return e.dataset.drawn; }).forEach(draw);
    document.dispatchEvent(new CustomEvent("themechange"));
  }

  const button = document.getElementById("theme"), words = { "": "as the system", light: "light", dark: "dark" };
  function setTheme(name) {
    if (name) root.dataset.theme = name; else delete root.dataset.theme;
    button.setAttribute("aria-label", "Colour theme: " + words[name]);
    button.textContent = "◐ Theme: " + words[name];
    redraw();
  }
  button.addEventListener("click", function () {
    const order = ["", "light", "dark"];
    setTheme(order[(order.indexOf(root.dataset.theme || "") + 1) % 3]);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

  function reach() {
    document.querySelectorAll("h1,.origin,tr.group bdi,.card h3 bdi,dt bdi,pre,.scroll").forEach(function (e) {
      if (e.scrollHeight > e.clientHeight + 1) e.tabIndex = 0;
    });
  }
  reach();
  window.addEventListener("resize", reach);

  let before = "", opened = [];
  window.addEventListener("beforeprint", function () {
    if (printing) return;
    before = root.dataset.theme || ""; printing = true; root.dataset.theme = "light";
    opened = Array.from(document.querySelectorAll("details:not([open])"));
    opened.forEach(function (d) { d.open = true; });
    plots.forEach(draw);
  });
  window.addEventListener("afterprint", function () {
    if (!printing) return;
    printing = false;
    opened.forEach(function (d) { d.open = false; });
    setTheme(before);
  });
  function openTarget() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (target && target.tagName === "DETAILS") target.open = true;
  }
  window.addEventListener("hashchange", openTarget);
  openTarget();

  const seen = new IntersectionObserver(function (entries) {
    entries.forEach(function (e) { if (e.isIntersecting) { seen.unobserve(e.target); draw(e.target); } });
  }, { rootMargin: "500px" });
  plots.forEach(function (e) { seen.observe(e); });
  window.intermit = { data: DATA, unpack: unpack, drawAll: function () { return Promise.all(plots.map(draw)); } };
})();
