"use strict";
const scene = JSON.parse(document.getElementById("description").textContent);
const packed = atob(document.getElementById("frames").textContent);
const columns = new Map(scene.channels.map((channel, i) => [channel.name, { ...channel, offset: 2 * i * scene.frames }]));
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const ALARM = "#b00020", SLIP = "#d55e00", STEEL = "#5b6773", INK = "#222b36";
const byId = id => document.getElementById(id);
window.addEventListener("error", event => { document.body.dataset.error = event.message; });

// ---- The record: values at a frame number, which may lie between two frames.

function stored(column, frame) {
  const at = column.offset + 2 * frame;
  const bits = packed.charCodeAt(at) | packed.charCodeAt(at + 1) << 8;
  return column.least + (column.greatest - column.least) * bits / 65535;
}

function value(name, frame, missing = 0) {
  const column = columns.get(name);
  if (!column) return missing;
  const low = Math.floor(frame), part = frame - low, a = stored(column, low);
  return part > 0 && low + 1 < scene.frames ? a + part * (stored(column, low + 1) - a) : a;
}

const flag = (name, frame, missing) => value(name, Math.floor(frame), missing) > 0.5;
const vector = (name, frame) => [value(name + ".x", frame), value(name + ".y", frame), value(name + ".z", frame)];

// ---- Small vectors.

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => { const n = Math.hypot(...a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };
const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** From ship axes to the world: R_z(yaw) R_y(pitch) R_x(roll). */
function pose(frame) {
  const origin = vector("ship", frame);
  const [r, p, y] = ["roll", "pitch", "yaw"].map(name => value("ship." + name, frame));
  const [cr, sr, cp, sp, cy, sy] = [Math.cos(r), Math.sin(r), Math.cos(p), Math.sin(p), Math.cos(y), Math.sin(y)];
  const turned = v => [
    cy * cp * v[0] + (cy * sp * sr - sy * cr) * v[1] + (cy * sp * cr + sy * sr) * v[2],
    sy * cp * v[0] + (sy * sp * sr + cy * cr) * v[1] + (sy * sp * cr - cy * sr) * v[2],
    -sp * v[0] + cp * sr * v[1] + cp * cr * v[2],
  ];
  return { origin, turned, place: v => add(origin, turned(v)) };
}

/** A drum or sheave in the world; angles about its axis count from the ship's "up", or its x where the axis is vertical. */
function placed(wheel, ship) {
  const a = unit(wheel.axis);
  const from = Math.abs(a[2]) < 0.999 ? [0, 0, 1] : [1, 0, 0];
  const up = unit(add(from, a, -dot(from, a)));
  const [axis, zero, quarter] = [a, up, cross(a, up)].map(ship.turned);
  const centre = ship.place(wheel.position), radius = wheel.radius;
  const at = (angle, r = radius) => add(add(centre, zero, r * Math.cos(angle)), quarter, r * Math.sin(angle));
  const angleOf = p => { const d = add(p, centre, -1); return Math.atan2(dot(d, quarter), dot(d, zero)); };
  const out = p => { const d = add(p, centre, -1); return Math.hypot(dot(d, quarter), dot(d, zero)); };
  const arc = (from, to) => {
    const n = Math.max(2, Math.ceil(Math.abs(to - from) / 0.1));
    return Array.from({ length: n + 1 }, (_, i) => at(from + (to - from) * i / n));
  };
  return { wheel, axis, centre, radius, at, angleOf, out, arc };
}

// ---- The cable: its points, and the arcs on drum and sheaves between them.

/** Where the cable leaves the drum: from its first point round to the tangent towards the first point that is clear of the drum. */
function drumArc(drum, points) {
  const sense = drum.wheel.direction || -1;
  const clear = points.findIndex(p => drum.out(p) > 1.02 * drum.radius);
  if (clear < 1) return null;
  const half = Math.acos(Math.min(1, drum.radius / drum.out(points[clear])));
  const begin = drum.angleOf(points[0]), end = drum.angleOf(points[clear]) - sense * half;
  const turn = 2 * Math.PI;
  let sweep = ((sense * (end - begin)) % turn + turn) % turn;
  if (sweep > turn - 0.1) sweep = 0;
  return { from: 0, to: clear, arc: drum.arc(begin, begin + sense * sweep) };
}

function sheaveArc(sheave, i, points, frame) {
  if (!flag(`sheave[${i}].in_contact`, frame, 0)) return null;
  const low = Math.floor(frame);
  // While the cable lifts off or comes down, one of the two frames has no arc.
  const whole = low + 1 >= scene.frames || flag(`sheave[${i}].in_contact`, low + 1, 0);
  const at = whole ? frame : low;
  let arc = sheave.arc(value(`sheave[${i}].contact_begin`, at), value(`sheave[${i}].contact_end`, at));
  const middle = arc[arc.length >> 1];
  // The span of the cable that is nearest to the arc's middle, less the points that lie on the sheave.
  let best = 0, least = Infinity;
  for (let k = 0; k + 1 < points.length; k++) {
    const d = add(points[k + 1], points[k], -1), t = Math.min(1, Math.max(0, dot(add(middle, points[k], -1), d) / (dot(d, d) || 1)));
    const gap = distance(middle, add(points[k], d, t));
    if (gap < least) { least = gap; best = k; }
  }
  const on = p => distance(p, sheave.centre) < 1.1 * sheave.radius;
  let from = best, to = best + 1;
  while (from > 0 && on(points[from])) from--;
  while (to + 1 < points.length && on(points[to])) to++;
  if (distance(points[from], arc[0]) > distance(points[from], arc[arc.length - 1])) arc = arc.reverse();
  return { from: from + 1, to, arc };
}

function state(number) {
  const frame = Math.min(Math.max(number, 0), scene.frames - 1);
  const ship = pose(frame);
  const points = Array.from({ length: scene.points }, (_, k) => vector("p" + k, frame));
  const drum = scene.drum && placed(scene.drum, ship);
  const sheaves = scene.sheaves.map(sheave => placed(sheave, ship));
  const arcs = sheaves.map((sheave, i) => sheaveArc(sheave, i + 1, points, frame));
  const wraps = [drum && drumArc(drum, points), ...arcs].filter(Boolean).sort((a, b) => a.from - b.from);
  const cable = [];
  let next = 0;
  for (const wrap of wraps) {
    while (next < wrap.from) cable.push(points[next++]);
    cable.push(...wrap.arc);
    next = Math.max(next, wrap.to);
  }
  cable.push(...points.slice(next));
  return { frame, ship, points, drum, sheaves, arcs, cable, tip: scene.tip && vector("tip", frame) };
}

// ---- Cameras: orthographic, from an azimuth about z and an elevation.

class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.angles = [0, 0];
    this.reset();
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      this.zoom = Math.min(1e4, Math.max(0.1, this.zoom * Math.exp(-0.0015 * event.deltaY)));
      draw();
    }, { passive: false });
    canvas.addEventListener("pointerdown", event => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", event => {
      if (!canvas.hasPointerCapture(event.pointerId)) return;
      if (projection === "orbit" && !event.shiftKey) {
        angles[0] -= 0.008 * event.movementX;
        angles[1] = Math.min(1.5, Math.max(-1.5, angles[1] + 0.008 * event.movementY));
      } else {
        this.shift = add(add(this.shift, this.right, -event.movementX / this.scale), this.up, event.movementY / this.scale);
      }
      draw();
    });
  }

  reset() { this.zoom = 1; this.shift = [0, 0, 0]; }

  /** Looks at a box, centre and half sizes, in the common direction. */
  aim(centre, half) {
    const [pen, width, height] = fresh(this.canvas);
    const [ca, sa, ce, se] = [Math.cos(angles[0]), Math.sin(angles[0]), Math.cos(angles[1]), Math.sin(angles[1])];
    this.right = [ca, sa, 0];
    this.up = [-sa * se, ca * se, ce];
    const reach = axis => Math.abs(axis[0]) * half[0] + Math.abs(axis[1]) * half[1] + Math.abs(axis[2]) * half[2] || 1;
    this.scale = this.zoom * 0.42 * Math.min(width / reach(this.right), height / reach(this.up));
    this.centre = add(centre, this.shift);
    Object.assign(this, { pen, width, height });
  }

  at(p) {
    const d = add(p, this.centre, -1);
    return [this.width / 2 + this.scale * dot(d, this.right), this.height / 2 - this.scale * dot(d, this.up)];
  }

  path(points, closed) {
    this.pen.beginPath();
    points.forEach((p, i) => { const q = this.at(p); if (i) this.pen.lineTo(...q); else this.pen.moveTo(...q); });
    if (closed) this.pen.closePath();
  }

  line(points, colour, width = 1, dash = []) {
    Object.assign(this.pen, { strokeStyle: colour, lineWidth: width });
    this.pen.setLineDash(dash);
    this.path(points);
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  dot(p, radius, colour) {
    this.pen.fillStyle = colour;
    this.pen.beginPath();
    this.pen.arc(...this.at(p), radius, 0, 2 * Math.PI);
    this.pen.fill();
  }

  text(p, text, colour = STEEL, dx = 6, dy = -6) {
    const q = this.at(p);
    this.pen.fillStyle = colour;
    this.pen.fillText(text, q[0] + dx, q[1] + dy);
  }

  sea(middle) {
    if (scene.waterline === null) return;
    const z = scene.waterline;
    if (Math.abs(angles[1]) < 0.02) {
      const y = this.at([this.centre[0], this.centre[1], z])[1];
      this.pen.fillStyle = "#3b8ec21f";
      this.pen.fillRect(0, y, this.width, Math.max(0, this.height - y));
      Object.assign(this.pen, { strokeStyle: "#3b8ec2", lineWidth: 1 });
      this.pen.beginPath();
      this.pen.moveTo(0, y);
      this.pen.lineTo(this.width, y);
      this.pen.stroke();
      return;
    }
    const size = 0.45 * Math.min(this.width, this.height) / this.scale, step = 10 ** Math.round(Math.log10(size / 5));
    const [cx, cy] = [middle[0], middle[1]].map(c => step * Math.round(c / step));
    const n = Math.ceil(size / step), corner = (i, j) => [cx + i * step, cy + j * step, z];
    this.path([corner(-n, -n), corner(n, -n), corner(n, n), corner(-n, n)], true);
    this.pen.fillStyle = "#3b8ec21f";
    this.pen.fill();
    for (let i = -n; i <= n; i++) {
      this.line([corner(i, -n), corner(i, n)], "#3b8ec233");
      this.line([corner(-n, i), corner(n, i)], "#3b8ec233");
    }
  }

  wheel(placed, colour, name, spoke) {
    const rim = placed.arc(0, 2 * Math.PI);
    this.path(rim, true);
    Object.assign(this.pen, { fillStyle: colour + "1c", strokeStyle: colour, lineWidth: 1.3 });
    this.pen.fill();
    this.pen.stroke();
    this.line([placed.centre, placed.at(spoke)], colour);
    this.dot(placed.centre, 1.8, colour);
    if (placed.radius * this.scale > 12) this.text(placed.at(0), name, colour);
  }

  /** A bar of a round length in the lower left corner. */
  ruler() {
    const round = 10 ** Math.floor(Math.log10(0.3 * this.width / this.scale));
    const length = [5, 2, 1].map(k => k * round).find(x => x * this.scale < 0.3 * this.width);
    Object.assign(this.pen, { strokeStyle: INK, fillStyle: INK, lineWidth: 1.5 });
    this.pen.strokeRect(14, this.height - 14, length * this.scale, 0);
    this.pen.fillText(length >= 1 ? `${length} m` : length >= 0.01 ? `${+(100 * length).toFixed(1)} cm` : `${+(1e3 * length).toFixed(2)} mm`, 14, this.height - 20);
  }

  draw(now) {
    this.pen.clearRect(0, 0, this.width, this.height);
    this.pen.font = "12px system-ui, sans-serif";
    this.sea(now.points[0]);
    const size = Math.min(this.width, this.height) / this.scale, held = [now.drum, ...now.sheaves].filter(Boolean).map(wheel => wheel.centre);
    if (scene.anchor) held.push(now.ship.place(scene.anchor));
    held.forEach(p => this.line([now.ship.origin, p], "#a9b3bd", 1, [3, 4]));
    [["x", "#b5483d"], ["y", "#4a8a4f"], ["z", "#4466aa"]].forEach(([name, colour], i) => {
      const end = add(now.ship.origin, now.ship.turned([0, 1, 2].map(k => k === i ? 0.055 * size : 0)));
      this.line([now.ship.origin, end], colour, 1.6);
      this.text(end, name, colour, 3, -3);
    });
    if (now.drum) this.wheel(now.drum, STEEL, "winch", value("winch.angle", now.frame));
    now.sheaves.forEach((sheave, i) => {
      const off = !flag(`sheave[${i + 1}].in_contact`, now.frame, 1), out = flag(`sheave[${i + 1}].out_of_groove`, now.frame, 0);
      const name = sheave.wheel.name + (off ? ": off" : "") + (out ? ": out of groove" : "");
      this.wheel(sheave, off ? ALARM : out ? SLIP : STEEL, name, value(`sheave[${i + 1}].angle`, now.frame));
    });
    if (scene.anchor) { const q = this.at(now.ship.place(scene.anchor)); this.pen.fillStyle = STEEL; this.pen.fillRect(q[0] - 4, q[1] - 4, 8, 8); }
    this.line(now.cable, "#111820", 1.8);
    now.arcs.forEach(wrap => wrap && this.line(wrap.arc, "#009e73", 3.5));
    if (now.tip) {
      this.line([now.points[now.points.length - 1], now.tip], STEEL, 3);
      this.dot(now.tip, 5, "#d55e00");
      this.text(now.tip, scene.tip, "#d55e00", 9, 4);
    }
    this.ruler();
  }
}

/** A canvas cleared, at the screen's resolution: pen, width and height in CSS pixels. */
function fresh(canvas) {
  const { width, height } = canvas.parentElement.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  const [w, h] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return [pen, width, height];
}

// ---- The page.

let projection = "xz", angles = [0, 0], frame = 0, playing = false, last = 0;
const whole = new View(byId("scene")), close = new View(byId("close"));
const seconds = () => scene.start + frame * scene.step;

/** The box of the whole run, relative to the ship's reference point where the ship goes farther than the scene is large. */
const box = (() => {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const tracks = [[Infinity, Infinity], [-Infinity, -Infinity]];
  const boxes = follow => {
    low.fill(Infinity);
    high.fill(-Infinity);
    for (let i = 0; i < 60; i++) {
      const now = state(Math.floor(i * (scene.frames - 1) / 59)), o = now.ship.origin;
      o.slice(0, 2).forEach((x, k) => { tracks[0][k] = Math.min(tracks[0][k], x); tracks[1][k] = Math.max(tracks[1][k], x); });
      const held = [now.drum, ...now.sheaves].filter(Boolean).flatMap(w => [add(w.centre, [w.radius, w.radius, w.radius]), add(w.centre, [w.radius, w.radius, w.radius], -1)]);
      const water = scene.waterline === null ? [] : [[now.points[0][0], now.points[0][1], scene.waterline]];
      for (const p of [...now.points, ...held, ...water, o, ...(now.tip ? [now.tip] : [])]) {
        const q = follow ? [p[0] - o[0], p[1] - o[1], p[2]] : p;
        q.forEach((x, k) => { low[k] = Math.min(low[k], x); high[k] = Math.max(high[k], x); });
      }
    }
  };
  boxes(true);
  const size = Math.max(...[0, 1, 2].map(k => high[k] - low[k]));
  const follow = Math.max(tracks[1][0] - tracks[0][0], tracks[1][1] - tracks[0][1]) > size;
  if (!follow) boxes(false);
  const middle = [0, 1, 2].map(k => 0.5 * (low[k] + high[k]));
  return { follow, middle, half: [0, 1, 2].map(k => Math.max(0.5 * (high[k] - low[k]), 0.02 * size)) };
})();

const wheels = [...scene.sheaves.map((sheave, i) => [sheave.name, now => now.sheaves[i]]), ...(scene.drum ? [[scene.drum.name, now => now.drum]] : [])];
wheels.forEach(([name], i) => byId("focus").add(new Option(`close-up: ${name}`, i)));
if (!wheels.length) { document.querySelector(".views").classList.add("single"); byId("close").parentElement.remove(); }

function draw() {
  const now = state(frame);
  const o = now.ship.origin;
  whole.aim(box.follow ? add(box.middle, [o[0], o[1], 0]) : box.middle, box.half);
  whole.draw(now);
  if (wheels.length) {
    const wheel = wheels[byId("focus").value][1](now), reach = 2.2 * wheel.radius;
    close.aim(wheel.centre, [reach, reach, reach]);
    close.draw(now);
  }
  trace();
  const alarms = now.sheaves.flatMap((sheave, i) => [
    flag(`sheave[${i + 1}].in_contact`, now.frame, 1) ? "" : `off the ${sheave.wheel.name}`,
    flag(`sheave[${i + 1}].out_of_groove`, now.frame, 0) ? `out of the groove of the ${sheave.wheel.name}` : "",
  ]);
  if (flag("cable.slack", now.frame, 0)) alarms.push("some of the cable is slack");
  byId("alarm").textContent = alarms.filter(Boolean).join(", ");
  byId("time").textContent = `t = ${seconds().toFixed(2)} s`;
  if (+byId("slider").value !== frame) byId("slider").value = frame;
  document.body.dataset.frames = scene.frames;
}

/** Tensions over the run, the present time marked. */
const LEFT = 70, RIGHT = 12;
const traced = scene.tensions.filter(name => !name.startsWith("cable.") && !name.endsWith("tension_in")).slice(0, COLOURS.length);
const bounds = traced.map(name => columns.get(name)).reduce(([a, b], c) => [Math.min(a, c.least), Math.max(b, c.greatest)], [0, 0]);
const [symbol, factor] = bounds[1] >= 300 ? ["kN", 1e-3] : bounds[1] >= 0.3 ? ["N", 1] : ["mN", 1e3];

function trace() {
  const [pen, width, height] = fresh(byId("trace"));
  const span = bounds[1] - bounds[0] || 1, top = 26, bottom = height - 10;
  const x = k => LEFT + (width - LEFT - RIGHT) * k / Math.max(1, scene.frames - 1), y = v => bottom - (bottom - top) * (v - bounds[0]) / span;
  Object.assign(pen, { font: "12px system-ui, sans-serif", strokeStyle: "#e3e7eb", fillStyle: STEEL, lineWidth: 1, textAlign: "right", textBaseline: "middle" });
  for (let i = 0; i <= 2; i++) {
    const v = bounds[0] + span * i / 2;
    pen.strokeRect(LEFT, y(v), width - LEFT - RIGHT, 0);
    pen.fillText(`${(factor * v).toPrecision(3)} ${symbol}`, LEFT - 6, y(v));
  }
  Object.assign(pen, { textAlign: "left", textBaseline: "alphabetic" });
  let legend = LEFT;
  traced.forEach((name, i) => {
    Object.assign(pen, { strokeStyle: COLOURS[i], fillStyle: COLOURS[i], lineWidth: 1.3 });
    pen.beginPath();
    for (let k = 0; k < scene.frames; k++) pen.lineTo(x(k), y(stored(columns.get(name), k)));
    pen.stroke();
    const text = `${name} ${(factor * value(name, frame)).toPrecision(4)} ${symbol}`;
    pen.fillText(text, legend, 16);
    legend += pen.measureText(text).width + 20;
  });
  Object.assign(pen, { strokeStyle: INK, lineWidth: 1 });
  pen.strokeRect(x(frame), top - 4, 0, bottom - top + 8);
}

function look(name) {
  projection = name;
  angles = { xz: [0, 0], yz: [Math.PI / 2, 0], orbit: [-0.6, 0.35] }[name];
  [whole, close].forEach(view => view.reset());
  document.querySelectorAll("[data-view]").forEach(button => button.setAttribute("aria-pressed", button.dataset.view === name));
  draw();
}

function play(on) {
  playing = on;
  byId("play").textContent = on ? "pause" : "play";
  if (on && frame >= scene.frames - 1) frame = 0;
  if (on) { last = performance.now(); requestAnimationFrame(tick); }
}

function tick(clock) {
  if (!playing) return;
  // A tab that was hidden goes on from where it was.
  frame += Math.min(0.2, Math.max(0, clock - last) / 1e3) * byId("speed").value / (scene.step || 1);
  last = clock;
  if (frame >= scene.frames - 1) { frame = scene.frames - 1; play(false); }
  draw();
  requestAnimationFrame(tick);
}

byId("slider").max = scene.frames - 1;
byId("slider").addEventListener("input", () => { frame = +byId("slider").value; draw(); });
byId("play").addEventListener("click", () => play(!playing));
byId("whole").addEventListener("click", () => look(projection));
byId("focus").addEventListener("change", () => { close.reset(); draw(); });
byId("trace").addEventListener("click", event => {
  const area = byId("trace").getBoundingClientRect(), part = (event.clientX - area.left - LEFT) / (area.width - LEFT - RIGHT);
  frame = Math.min(1, Math.max(0, part)) * (scene.frames - 1);
  draw();
});
document.querySelectorAll("[data-view]").forEach(button => button.addEventListener("click", () => look(button.dataset.view)));
document.addEventListener("keydown", event => {
  if (event.code !== "Space" || event.target.matches("button, select")) return;
  event.preventDefault();
  play(!playing);
});
window.addEventListener("resize", draw);
// animation.html#t=12.5&view=orbit opens at that time in that view.
const wanted = new URLSearchParams(location.hash.slice(1));
if (wanted.has("t")) frame = Math.min(scene.frames - 1, Math.max(0, (+wanted.get("t") - scene.start) / (scene.step || 1) || 0));
look(["xz", "yz", "orbit"].includes(wanted.get("view")) ? wanted.get("view") : "xz");
