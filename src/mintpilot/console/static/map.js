// The map on a canvas: walls, regions, things, the drone, and the ways that it flew, plans, or would take.

import { say } from "./words.js";

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const still = matchMedia("(prefers-reduced-motion: reduce)");

function rgb(colour) {
  const n = parseInt(colour.slice(1), 16);
  return [n >> 16, (n >> 8) & 255, n & 255];
}

export class MapView {
  #canvas; #pane = null; #values = null; #ground = null;
  #volume = null; #told = []; #done = null; #stroke = []; #cursor = null;
  #pose = null; #plan = []; #flown = []; #way = []; #spots = []; #until = 0; #due = false;

  constructor(canvas, onChoose, onPick) {
    this.#canvas = canvas;
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.#paint(); this.draw(); });
    canvas.addEventListener("click", (event) => {
      if (this.drawing) return;
      const spot = this.#spotAt(event.offsetX, event.offsetY);
      spot ? onChoose(spot) : onPick(this.#foundAt(event.offsetX, event.offsetY));
    });
    canvas.addEventListener("pointermove", (event) => this.#moved(event));
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.drawing) return;
      canvas.setPointerCapture(event.pointerId);
      this.#stroke = [[event.offsetX, event.offsetY]];
      event.preventDefault();
    });
    canvas.addEventListener("pointerup", () => { if (this.drawing && this.#stroke.length) this.#finish(); });
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  async setMap(pane, png) {
    const bitmap = await createImageBitmap(png);
    const flat = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d", { willReadFrequently: true });
    flat.drawImage(bitmap, 0, 0);
    const data = flat.getImageData(0, 0, bitmap.width, bitmap.height);
    this.#values = { width: bitmap.width, height: bitmap.height, at: data.data.filter((_, i) => i % 4 === 0) };
    this.#pane = pane;
    this.#canvas.dataset.box = JSON.stringify(pane.box);
    this.#canvas.style.aspectRatio = `${Math.min(2.2, Math.max(0.8, bitmap.width / bitmap.height))}`;
    this.#paint();
    this.draw();
  }

  setPose(pose) {
    this.#pose = pose;
    const [x, y, z] = pose.position.map((v) => `${v.toFixed(1)} m`);
    this.#canvas.setAttribute("aria-label", say("mapLabel", x, y, z));
    this.draw();
  }

  setVolume(box) { this.#volume = box; this.draw(); }
  setTold(outlines) { this.#told = outlines; this.draw(); }

  get drawing() { return this.#done !== null; }
  startDrawing(done) {
    if (!this.#pane && !this.#volume) return;
    this.#done = done;
    this.#stroke = [];
    this.#cursor = null;
    this.#canvas.classList.add("drawing");
  }
  stopDrawing() {
    this.#done = null;
    this.#stroke = [];
    this.#cursor = null;
    this.#canvas.classList.remove("drawing");
    this.draw();
  }

  #moved(event) {
    const at = [event.offsetX, event.offsetY];
    if (!this.drawing) this.#canvas.style.cursor = this.#spotAt(...at) || this.#foundAt(...at) ? "pointer" : "";
    else if (event.buttons && this.#stroke.length && Math.hypot(at[0] - this.#stroke.at(-1)[0], at[1] - this.#stroke.at(-1)[1]) > 5) {
      this.#stroke.push(at);
      this.draw();
    }
  }

  #key(event) { // drawing without a pointer: arrows move, Enter sets a corner, a second Enter at the same place ends
    if (!this.drawing) return;
    const step = event.shiftKey ? 40 : 10, by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
    this.#cursor ??= [this.#canvas.clientWidth / 2, this.#canvas.clientHeight / 2];
    if (by) this.#cursor = [this.#cursor[0] + by[0], this.#cursor[1] + by[1]];
    else if (event.key === "Enter" && this.#stroke.at(-1)?.join() === this.#cursor.join()) this.#finish();
    else if (event.key === "Enter") this.#stroke.push([...this.#cursor]);
    else if (event.key === "Escape") this.#done(null);
    else return;
    event.preventDefault();
    this.draw();
  }

  #finish() {
    const f = this.#frame(), every = Math.ceil(this.#stroke.length / 60);
    const corners = this.#stroke.filter((_, i) => i % every === 0).map(([x, y]) => [f.left + (x - f.x(f.left)) / f.scale, f.top - (y - f.y(f.top)) / f.scale].map((v) => Math.round(v * 100) / 100));
    this.#stroke = [];
    if (corners.length >= 3) this.#done(corners);
    else this.draw();
  }

  setPlan(points) { this.#plan = points; this.draw(); }
  addFlown(from, points) { this.#flown.length = Math.min(this.#flown.length, from); this.#flown.push(...points); this.draw(); }
  setWay(points) { this.#way = points; this.draw(); }
  setSpots(spots) { this.#spots = spots; this.draw(); }
  blink() { this.#until = performance.now() + 4000; this.draw(); }

  draw() {
    if (this.#due) return;
    this.#due = true;
    requestAnimationFrame(() => { this.#due = false; this.#draw(); });
  }

  #paint() { // grey values to colours; unknown regions are hatched, so that colour is not all that tells them
    if (!this.#values) return;
    const { width, height, at } = this.#values;
    const scale = Math.max(1, Math.min(6, Math.floor(900 / width)));
    const ground = new OffscreenCanvas(width * scale, height * scale);
    const context = ground.getContext("2d");
    const image = context.createImageData(width * scale, height * scale);
    const base = [css("--unseen"), css("--free"), css("--wall")].map(rgb);
    const looks = this.#pane.regions.map((r) => rgb(css(`--${r.passable === "yes" ? "passable" : r.passable === "no" ? "blocked" : "open"}`)));
    const states = this.#pane.regions.map((r) => r.passable);
    for (let y = 0; y < height * scale; y++) {
      for (let x = 0; x < width * scale; x++) {
        const value = at[Math.floor(y / scale) * width + Math.floor(x / scale)];
        let colour = base[value] ?? base[1];
        let strength = 1;
        if (value > 2 && looks[value - 3]) {
          const state = states[value - 3];
          const mark = state === "open" ? (x + y) % 10 < 4 : state === "no" ? (x + y) % 10 < 2 || (x - y + 10000) % 10 < 2 : x % 6 < 2 && y % 6 < 2;
          strength = mark ? 0.85 : 0.38;
          colour = looks[value - 3].map((c, i) => c * strength + base[1][i] * (1 - strength));
        }
        const i = (y * width * scale + x) * 4;
        image.data.set([colour[0], colour[1], colour[2], 255], i);
      }
    }
    context.putImageData(image, 0, 0);
    this.#ground = ground;
  }

  #frame() {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    const [left, bottom, right, top] = this.#pane?.box ?? this.#volume;
    const scale = Math.min(width / (right - left), height / (top - bottom));
    const x0 = (width - scale * (right - left)) / 2, y0 = (height - scale * (top - bottom)) / 2;
    return { scale, x: (x) => x0 + (x - left) * scale, y: (y) => y0 + (top - y) * scale, left, bottom, right, top };
  }

  #spotAt(px, py) {
    if (!this.#pane) return null;
    const f = this.#frame();
    const near = (s) => Math.hypot(f.x(s.position[0]) - px, f.y(s.position[1]) - py);
    const spots = this.#spots.filter((s) => s.choosable && near(s) < 28).sort((a, b) => near(a) - near(b));
    return spots[0] ?? null;
  }

  #foundAt(px, py) { // a thing or room whose mark is there, else the region
    if (!this.#pane || !this.#values) return null;
    const f = this.#frame(), { width, height, at } = this.#values;
    const inside = (t) => px > f.x(t.box[0]) - 9 && px < f.x(t.box[2]) + 9 && py > f.y(t.box[3]) - 9 && py < f.y(t.box[1]) + 9;
    const thing = this.#pane.things.find(inside);
    if (thing) return { kind: thing.label === "room" ? "room" : "thing", id: thing.id, words: thing.words };
    const x = Math.floor(((px - f.x(f.left)) / f.scale / (f.right - f.left)) * width), y = Math.floor(((py - f.y(f.top)) / f.scale / (f.top - f.bottom)) * height);
    const region = x >= 0 && x < width && y >= 0 && y < height ? this.#pane.regions[at[y * width + x] - 3] : null;
    return region && !region.id.startsWith("told-") ? { kind: "region", id: region.id, words: region.words } : null;
  }

  #outline(c, points, colour, closed) {
    c.beginPath();
    points.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
    if (closed) { c.closePath(); c.globalAlpha = 0.28; c.fillStyle = colour; c.fill(); c.globalAlpha = 1; }
    c.lineJoin = "round";
    c.strokeStyle = css("--free"); c.lineWidth = 6; c.stroke();
    c.strokeStyle = colour; c.lineWidth = 3; c.stroke();
  }

  #drawn(c, f) {
    for (const corners of this.#told) {
      const points = corners.map(([x, y]) => [f.x(x), f.y(y)]);
      this.#outline(c, points, css("--blocked"), true);
      const middle = [0, 1].map((i) => points.reduce((sum, p) => sum + p[i], 0) / points.length);
      this.#label(c, "✕", middle[0], middle[1] + 5, true);
    }
    if (this.#stroke.length) this.#outline(c, this.#cursor ? [...this.#stroke, this.#cursor] : this.#stroke, css("--mark"), false);
    if (this.#cursor) this.#label(c, "✛", this.#cursor[0], this.#cursor[1] + 5, true);
  }

  #draw() {
    const canvas = this.#canvas, ratio = devicePixelRatio || 1;
    if (!canvas.clientWidth) return;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    const c = canvas.getContext("2d");
    c.scale(ratio, ratio);
    if (!this.#pane) {
      this.#label(c, say("noMap"), canvas.clientWidth / 2, canvas.clientHeight / 2);
      if (this.#volume) this.#drawn(c, this.#frame());
      return;
    }
    const f = this.#frame();
    c.imageSmoothingEnabled = false;
    if (this.#ground) c.drawImage(this.#ground, f.x(f.left), f.y(f.top), f.scale * (f.right - f.left), f.scale * (f.top - f.bottom));
    this.#things(c, f);
    this.#line(c, f, this.#flown, css("--flown"), 2.5, []);
    this.#line(c, f, this.#plan, css("--ink"), 2, [7, 5]);
    this.#line(c, f, this.#way, css("--way"), 5, []);
    this.#regions(c, f);
    this.#drawn(c, f);
    const go = this.#marks(c, f);
    this.#drone(c, f);
    if (go) this.draw();
  }

  #label(c, text, x, y, strong) {
    c.font = `${strong ? "600 13px" : "12px"} system-ui, sans-serif`;
    c.textAlign = "center";
    const half = c.measureText(text).width / 2 + 2;
    const at = Math.min(Math.max(x, half), this.#canvas.clientWidth - half);
    c.lineWidth = 4;
    c.lineJoin = "round";
    c.strokeStyle = css("--free");
    c.strokeText(text, at, y);
    c.fillStyle = css("--ink");
    c.fillText(text, at, y);
  }

  #things(c, f) {
    const few = this.#pane.things.length <= 14 && f.scale > 12;
    for (const thing of this.#pane.things) {
      const [left, bottom, right, top] = thing.box;
      const w = Math.max(7, (right - left) * f.scale), h = Math.max(7, (top - bottom) * f.scale);
      const x = f.x((left + right) / 2), y = f.y((bottom + top) / 2);
      const room = thing.label === "room";
      c.fillStyle = room ? css("--door") : thing.label === "person" || thing.label === "injured" ? css("--person") : thing.label === "fire" ? css("--fire") : css("--thing");
      c.strokeStyle = css("--ink");
      c.lineWidth = 1;
      c.beginPath();
      if (thing.label === "person") c.arc(x, y, Math.max(5, Math.min(w, h) / 2), 0, 7);
      else c.rect(x - w / 2, y - h / 2, w, h);
      c.fill();
      c.stroke();
      if (few || room) this.#label(c, room ? `${say("room")}${thing.state === "searched" ? " ✓" : " ?"}` : thing.words, x, y - h / 2 - (room ? 14 : 5));
    }
  }

  #regions(c, f) {
    for (const region of this.#pane.regions.filter((r) => !r.id.startsWith("told-"))) {
      const sign = { open: "?", yes: "✓", no: "✕" }[region.passable];
      this.#label(c, sign, f.x(region.centre[0]), f.y(region.centre[1]) + 5, true);
    }
  }

  #line(c, f, points, colour, width, dash) {
    if (points.length < 2) return;
    c.beginPath();
    points.forEach((p, i) => (i ? c.lineTo(f.x(p[0]), f.y(p[1])) : c.moveTo(f.x(p[0]), f.y(p[1]))));
    c.setLineDash([]);
    c.lineJoin = "round";
    c.strokeStyle = css("--free");
    c.lineWidth = width + 3;
    c.stroke();
    c.setLineDash(dash);
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.stroke();
    c.setLineDash([]);
  }

  #marks(c, f) { // the places that the question is about
    const blinking = performance.now() < this.#until;
    const beat = blinking && !still.matches ? 0.5 + 0.5 * Math.sin(performance.now() / 120) : 0.4;
    this.#spots.forEach((spot, i) => {
      const x = f.x(spot.position[0]), y = f.y(spot.position[1]);
      c.beginPath();
      c.arc(x, y, 15 + (blinking ? 8 * beat : 0), 0, 7);
      c.lineWidth = 6;
      c.strokeStyle = css("--free");
      c.stroke();
      c.lineWidth = 3;
      c.strokeStyle = css("--mark");
      c.stroke();
      this.#label(c, this.#spots.length > 1 ? `${i + 1}` : "", x, y + 31, true);
    });
    return blinking && !still.matches;
  }

  #drone(c, f) {
    if (!this.#pose) return;
    const [x, y] = this.#pose.position;
    c.save();
    c.translate(f.x(x), f.y(y));
    c.rotate(-this.#pose.yaw_rad);
    c.beginPath();
    c.moveTo(13, 0); c.lineTo(-9, 8); c.lineTo(-5, 0); c.lineTo(-9, -8); c.closePath();
    c.lineWidth = 5; c.strokeStyle = css("--free"); c.stroke();
    c.fillStyle = css("--drone"); c.fill();
    c.lineWidth = 1.5; c.strokeStyle = css("--ink"); c.stroke();
    c.restore();
  }
}
