"use strict";
(function () {
  const SVG = "http://www.w3.org/2000/svg", unpack = window.intermit.unpack;
  const FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
  const SHADES = [0.12, 0.55, 0.2, 0.2, 0.08, 0.08];
  const EYE = [0.62, -0.66, 0.42], RIGHT = [0.729, 0.685, 0], UP = [-0.288, 0.306, 0.907];

  function node(name, parent, attributes) {
    const e = document.createElementNS(SVG, name);
    Object.keys(attributes || {}).forEach(function (k) { e.setAttribute(k, attributes[k]); });
    parent.appendChild(e);
    return e;
  }
  function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
  function turn(q, v) {
    const b = [q[1], q[2], q[3]], t = cross(b, v).map(function (x) { return 2 * x; }), s = cross(b, t);
    return [0, 1, 2].map(function (i) { return v[i] + q[0] * t[i] + s[i]; });
  }
  function flat(v) { return [150 + 66 * dot(v, RIGHT), 112 - 66 * dot(v, UP)]; }
  function path(points) { return points.map(function (p) { return p[0].toFixed(1) + "," + p[1].toFixed(1); }).join(" "); }

  function sample(body, t) {
    const times = body.t;
    let low = 0, high = times.length - 1;
    while (high - low > 1) { const mid = (low + high) >> 1; if (times[mid] <= t) low = mid; else high = mid; }
    const span = times[high] - times[low], f = span > 0 ? Math.min(1, Math.max(0, (t - times[low]) / span)) : 0;
    const a = body.q.subarray(4 * low, 4 * low + 4), b = body.q.subarray(4 * high, 4 * high + 4);
    const sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1, q = [0, 1, 2, 3].map(function (i) { return (1 - f) * a[i] + f * sign * b[i]; });
    const n = Math.hypot(q[0], q[1], q[2], q[3]) || 1;
    const torque = body.u ? [0, 1, 2].map(function (i) { return (1 - f) * body.u[3 * low + i] + f * body.u[3 * high + i]; }) : null;
    return { q: q.map(function (x) { return x / n; }), torque: torque };
  }

  function setUp(element, data) {
    const stage = element.querySelector(".stage"), slider = element.querySelector(".time"), clock = element.querySelector(".clock");
    const play = element.querySelector(".play"), speed = element.querySelector(".speed");
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(function (i) { return [0, 1, 2].map(function (k) { return ((i >> (2 - k)) & 1 ? 1 : -1) * data.box[k]; }); });
    const bodies = data.bodies.map(function (body, index) {
      const figure = document.createElement("figure"), caption = document.createElement("figcaption"), lamp = document.createElement("div");
      const svg = node("svg", figure, { viewBox: "0 0 300 224", role: "img", "aria-label": "Attitude of " + body.label });
      caption.textContent = body.label; lamp.className = "lamp";
      figure.prepend(caption); figure.append(lamp); stage.appendChild(figure);
      const u = body.torque ? unpack(body.torque) : null;
      let most = 0;
      if (u) for (let i = 0; i < u.length; i += 3) most = Math.max(most, Math.hypot(u[i], u[i + 1], u[i + 2]));
      const ghost = FACES.map(function () { return node("polygon", svg, { fill: "none", "stroke-dasharray": "3 4", opacity: "0.55" }); });
      const faces = FACES.map(function () { return node("polygon", svg, { "stroke-width": "1.4", "stroke-linejoin": "round" }); });
      const axes = ["x", "y", "z"].map(function (name) {
        const text = node("text", svg, { "font-size": "12", "text-anchor": "middle" });
        text.textContent = name;
        return { line: node("line", svg, { "stroke-width": "1.6" }), text: text };
      });
      const arrow = node("line", svg, { "stroke-width": "4", "stroke-linecap": "round" });
      const tip = node("circle", svg, { r: "4.5" });
      return { t: unpack(body.time), q: unpack(body.quaternion), u: u, most: most, ghost: ghost, faces: faces, axes: axes, arrow: arrow, tip: tip, lamp: lamp, index: index };
    });
    const strip = node("svg", element.querySelector(".strip"), { viewBox: "0 0 1000 34", preserveAspectRatio: "none" });
    node("line", strip, { x1: 0, x2: 1000, y1: 30, y2: 30, stroke: "currentColor", "stroke-width": 1 });
    data.windows.forEach(function (w) {
      node("rect", strip, { x: 1000 * w[0] / data.end, width: Math.max(0.5, 1000 * (Math.min(w[1], data.end) - w[0]) / data.end), y: 6, height: 24, fill: "var(--c2)", opacity: 0.45 });
    });
    const cursor = node("line", strip, { y1: 0, y2: 34, stroke: "var(--c1)", "stroke-width": 3 });

    function show() {
      const t = data.end * slider.value / 1000;
      const on = data.windows.some(function (w) { return t >= w[0] && t <= w[1]; });
      const words = "t = " + t.toFixed(2) + " s, thruster window " + (on ? "open" : "closed");
      clock.textContent = words;
      slider.setAttribute("aria-valuetext", words);
      cursor.setAttribute("x1", 1000 * t / data.end); cursor.setAttribute("x2", 1000 * t / data.end);
      bodies.forEach(function (body) { pose(body, sample(body, t), on, t > body.t[body.t.length - 1]); });
    }

    function pose(body, state, on, over) {
      const turned = corners.map(function (c) { return turn(state.q, c); }), mine = "var(--c" + body.index % 4 + ")";
      FACES.forEach(function (face, i) {
        const a = turned[face[0]], b = turned[face[1]], c = turned[face[2]];
        const normal = cross([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - b[0], c[1] - b[1], c[2] - b[2]]);
        const middle = face.reduce(function (m, k) { return [m[0] + turned[k][0], m[1] + turned[k][1], m[2] + turned[k][2]]; }, [0, 0, 0]);
        const outward = dot(normal, middle) > 0 ? 1 : -1, seen = outward * dot(normal, EYE) > 0;
        body.faces[i].setAttribute("points", path(face.map(function (k) { return flat(turned[k]); })));
        body.faces[i].setAttribute("fill", seen ? mine : "none");
        body.faces[i].setAttribute("fill-opacity", SHADES[i]);
        body.faces[i].setAttribute("stroke", seen ? mine : "none");
        body.ghost[i].setAttribute("points", path(face.map(function (k) { return flat(corners[k]); })));
        body.ghost[i].setAttribute("stroke", "var(--dim)");
      });
      body.axes.forEach(function (axis, k) {
        const unit = [0, 0, 0]; unit[k] = 1.55;
        const from = flat(turn(state.q, unit.map(function (x) { return x * data.box[k] / 1.55; }))), to = flat(turn(state.q, unit));
        [["x1", from[0]], ["y1", from[1]], ["x2", to[0]], ["y2", to[1]], ["stroke", "var(--ink)"]].forEach(function (p) { axis.line.setAttribute(p[0], p[1]); });
        axis.text.setAttribute("x", to[0]); axis.text.setAttribute("y", to[1] - 3); axis.text.setAttribute("fill", "var(--ink)");
      });
      const size = state.torque && body.most > 0 ? Math.hypot(state.torque[0], state.torque[1], state.torque[2]) / body.most : 0;
      const firing = size > 1e-3 && !over;
      const end = firing ? flat(turn(state.q, state.torque.map(function (x) { return 1.9 * x / body.most; }))) : [150, 112];
      [["x1", 150], ["y1", 112], ["x2", end[0]], ["y2", end[1]], ["stroke", firing ? "var(--c1)" : "none"]].forEach(function (p) { body.arrow.setAttribute(p[0], p[1]); });
      body.tip.setAttribute("cx", end[0]); body.tip.setAttribute("cy", end[1]); body.tip.setAttribute("fill", firing ? "var(--c1)" : "none");
      body.lamp.textContent = over ? "■ ended" : firing ? "● thrusters on, " + Math.round(100 * size) + " % of its peak" : on ? "○ window open, no torque" : "○ thrusters off";
    }

    let last = null, position = 0;
    function frame(now) {
      if (last === null) return;
      position += (now - last) / 1000 * speed.value;
      last = now;
      if (position >= data.end) { position = data.end; stop(); }
      slider.value = Math.round(1000 * position / data.end);
      show();
      if (last !== null) requestAnimationFrame(frame);
    }
    function stop() { last = null; play.textContent = "▶ Play"; }
    play.addEventListener("click", function () {
      if (last !== null) { stop(); return; }
      position = data.end * slider.value / 1000;
      if (position >= data.end) position = 0;
      last = performance.now(); play.textContent = "❚❚ Pause";
      requestAnimationFrame(frame);
    });
    slider.addEventListener("input", function () { position = data.end * slider.value / 1000; show(); });
    show();
  }
  document.querySelectorAll(".replay").forEach(function (e, i) { setUp(e, window.intermit.data.replays[i]); });
})();
