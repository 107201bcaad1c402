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
  #pose = null; #plan = []; #flown = []; #way = []; #spots = []; #until = 0; #due = false;

  constructor(canvas, onChoose) {
    this.#canvas = canvas;
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.#paint(); this.draw(); });
    canvas.addEventListener("click", (event) => {
      const spot = this.#spotAt(event.offsetX, event.offsetY);
      if (spot) onChoose(spot);
    });
    canvas.addEventListener("mousemove", (event) => {
      canvas.style.cursor = this.#spotAt(event.offsetX, event.offsetY) ? "pointer" : "";
    });
  }

  async setMap(pane, png) {
    const bitmap = await createImageBitmap(png);
    const flat = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d", { willReadFrequently: true });
    flat.drawImage(bitmap, 0, 0);
    const data = flat.getImageData(0, 0, bitmap.width, bitmap.height);
    this.#values = { width: bitmap.width, height: bitmap.height, at: data.data.filter((_, i) => i % 4 === 0) };
    this.#pane = pane;
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
    const [left, bottom, right, top] = this.#pane.box;
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

  #draw() {
    const canvas = this.#canvas, ratio = devicePixelRatio || 1;
    if (!canvas.clientWidth) return;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    const c = canvas.getContext("2d");
    c.scale(ratio, ratio);
    if (!this.#pane) {
      this.#label(c, say("noMap"), canvas.clientWidth / 2, canvas.clientHeight / 2);
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
      if (few || room) this.#label(c, room ? `${say("room")}${thing.state === "searched" ? " ✓" : " ?"}` : thing.words, x, y - h / 2 - 5);
    }
  }

  #regions(c, f) {
    for (const region of this.#pane.regions) {
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
