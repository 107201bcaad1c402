// Runs on the browser's sound thread: one channel at 16 kHz, 16 bits, a tenth of a second at a time, with its level.

const RATE = 16000, PIECE = 1600;

class Sender extends AudioWorkletProcessor {
  #piece = new Int16Array(PIECE); #filled = 0; #power = 0; #sum = 0; #count = 0; #phase = 0;

  process([[samples]]) {
    for (const sample of samples ?? []) {
      this.#sum += sample;
      this.#count++;
      for (this.#phase += RATE / sampleRate; this.#phase >= 1; this.#phase--) this.#put(this.#count ? this.#sum / this.#count : sample);
    }
    return true;
  }

  #put(value) { // the mean of the samples since the last one
    this.#sum = this.#count = 0;
    const clipped = Math.max(-1, Math.min(1, value));
    this.#power += clipped * clipped;
    this.#piece[this.#filled++] = Math.round(clipped * 32767);
    if (this.#filled < PIECE) return;
    const sound = this.#piece.slice().buffer;
    this.port.postMessage({ sound, level: 10 * Math.log10(Math.max(1e-6, this.#power / PIECE)) }, [sound]);
    this.#filled = this.#power = 0;
  }
}

registerProcessor("sender", Sender);
