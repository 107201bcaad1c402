// The microphone of this browser: held to talk, or hands-free. Sound goes over the one link; what it means is decided there.

import { $ } from "./dom.js";
import { say } from "./words.js";

const RATE = 16000;
const STILL_HEARD_MS = 300; // the room's echo
const REASONS = { NotAllowedError: "micRefused", SecurityError: "micRefused", NotFoundError: "micMissing", NotReadableError: "micBusy" };

export class Microphone {
  #link; #context = null; #stream = null; #opening = null; #cancels = false;
  #may = false; #held = false; #free = false; #aloud = true;
  #playing = null; #played = 0; #last = 0; #words = ""; #pane = null;

  constructor(link) {
    this.#link = link;
    const talk = $("talk");
    talk.addEventListener("pointerdown", (event) => { if (event.button === 0) { talk.setPointerCapture(event.pointerId); this.#hold(true); } });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) talk.addEventListener(end, () => this.#hold(false));
    talk.addEventListener("keydown", (event) => { if (event.key === " " || event.key === "Enter") { event.preventDefault(); if (!event.repeat) this.#hold(true); } });
    talk.addEventListener("keyup", (event) => { if (event.key === " " || event.key === "Enter") this.#hold(false); });
    talk.addEventListener("contextmenu", (event) => event.preventDefault());
    $("free").addEventListener("click", () => this.#setFree(!this.#free));
    $("mic-off").addEventListener("click", () => this.#close(""));
    $("loud").addEventListener("click", () => { this.#aloud = !this.#aloud; if (!this.#aloud) this.#silence(); if (this.#stream) this.#tell(true); this.draw(); });
    addEventListener("pagehide", () => this.#close(""));
  }

  setMay(may) {
    if (this.#may && !may) this.#close(this.#stream ? "micOther" : "");
    this.#may = may;
    this.draw();
  }

  linked(up) { if (up && this.#stream) this.#tell(true); else if (!up) this.#silence(); }

  caption(pane) { this.#pane = pane; this.#show(); }

  play(n, sound) {
    const old = n <= this.#last;
    this.#last = Math.max(n, this.#last);
    if (old) return;
    this.#silence();
    if (!sound || !this.#stream || !this.#aloud) return;
    sound.arrayBuffer().then((data) => {
      if (n !== this.#last || !this.#context) return;
      const samples = new Int16Array(data), buffer = this.#context.createBuffer(1, Math.max(1, samples.length), RATE);
      buffer.getChannelData(0).set(Float32Array.from(samples, (s) => s / 32768));
      this.#playing = this.#context.createBufferSource();
      this.#playing.buffer = buffer;
      this.#playing.connect(this.#context.destination);
      this.#playing.onended = () => { this.#playing = null; this.#played = performance.now(); };
      this.#playing.start();
    });
  }

  draw() {
    const on = Boolean(this.#stream);
    for (const id of ["talk", "free", "loud"]) $(id).disabled = !this.#may;
    $("talk").textContent = say(this.#held && on ? "talking" : "talk");
    $("talk").setAttribute("aria-pressed", String(this.#held));
    $("free").textContent = say("handsFree");
    $("free").setAttribute("aria-pressed", String(this.#free));
    $("loud").textContent = say("playVoice");
    $("loud").setAttribute("aria-pressed", String(this.#aloud));
    $("mic-off").textContent = say("micOff");
    $("mic-off").hidden = $("level").hidden = !on;
    $("level").setAttribute("aria-label", say("micLevel"));
    this.#show();
  }

  #show() {
    const p = this.#stream ? this.#pane : null;
    $("mic-said").textContent = p?.problem || (p?.said ? say("micSaid", p.said) : this.#words && say(this.#words));
    $("mic-heard").textContent = p?.heard ? say("micHeard", p.heard) : "";
  }

  #explain(words) { this.#words = words; this.draw(); }

  #tell(on) { this.#link.send({ kind: "microphone", on, aloud: this.#aloud }); }

  async #hold(held) {
    if (held === this.#held || (held && !this.#may)) return;
    this.#held = held;
    if (held) { this.#silence(); await this.#open(); }
    else if (this.#stream && !this.#free) this.#link.sound(new ArrayBuffer(0)); // released: what was said is over
    if (this.#stream && !held && !this.#free) this.#words = "micHold";
    this.draw();
  }

  async #setFree(free) {
    if (free && !(await this.#open())) return;
    if (!free && this.#stream) this.#link.sound(new ArrayBuffer(0));
    this.#free = free;
    this.#explain(free ? "micOpen" : "micHold");
  }

  #open() {
    if (this.#stream) return Promise.resolve(true);
    this.#opening ??= this.#begin().finally(() => { this.#opening = null; });
    return this.#opening;
  }

  async #begin() {
    if (!navigator.mediaDevices?.getUserMedia || !globalThis.AudioWorkletNode) { this.#explain("micInsecure"); return false; }
    this.#explain("micAsking");
    let stream = null;
    try {
      stream = await navigator.mediaDevices.getUserMedia({ audio: { channelCount: 1, echoCancellation: true, noiseSuppression: false, autoGainControl: false } });
      await this.#wire(stream);
    } catch (error) {
      for (const track of stream?.getTracks() ?? []) track.stop();
      this.#explain(REASONS[error.name] ?? "micBusy");
      return false;
    }
    if (!this.#may) { this.#close("micOther"); return false; }
    this.#tell(true);
    this.#explain("micHold");
    return true;
  }

  async #wire(stream) {
    let context = null, source = null;
    for (const options of [{ sampleRate: RATE }, {}]) { // some browsers take a microphone only at its own rate
      try {
        context = new AudioContext(options);
        source = context.createMediaStreamSource(stream);
        break;
      } catch (error) {
        context?.close();
        if (!options.sampleRate) throw error;
      }
    }
    await context.audioWorklet.addModule("/static/microphone-worklet.js");
    const sender = new AudioWorkletNode(context, "sender", { numberOfOutputs: 0 });
    sender.port.onmessage = ({ data }) => this.#send(data);
    source.connect(sender);
    await context.resume();
    const [track] = stream.getAudioTracks();
    track.onended = () => this.#close("micGone");
    this.#cancels = track.getSettings().echoCancellation === true;
    this.#context = context;
    this.#stream = stream;
  }

  #send({ sound, level }) {
    $("level").value = level;
    const speaks = this.#playing || globalThis.speechSynthesis?.speaking || performance.now() - this.#played < STILL_HEARD_MS;
    if (this.#held || (this.#free && (this.#cancels || !speaks))) this.#link.sound(sound);
  }

  #silence() {
    const playing = this.#playing;
    this.#playing = null;
    if (playing) { playing.onended = null; playing.stop(); this.#played = performance.now(); }
  }

  #close(words) {
    this.#silence();
    if (this.#stream) {
      for (const track of this.#stream.getTracks()) { track.onended = null; track.stop(); }
      this.#context.close();
      if (this.#may) this.#tell(false);
    }
    this.#stream = this.#context = null;
    this.#held = this.#free = false;
    this.#explain(words);
  }
}
