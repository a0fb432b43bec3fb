// A knock at each impact, once it is switched on; its loudness grows with the speed of the impact.
"use strict";

let audio = null;
const switchSound = on => { audio = on ? new AudioContext() : (audio?.close(), null); };
const PITCH = {restitution: 900, "spring-damper": 500};

function knock(model, loudness, delay = 0) {
  if (!audio || !(loudness > 0.01)) return;
  const start = audio.currentTime + delay, tone = audio.createOscillator(), gain = audio.createGain();
  tone.frequency.value = PITCH[model];
  gain.gain.setValueAtTime(0.3 * Math.min(loudness, 1), start);
  gain.gain.exponentialRampToValueAtTime(1e-4, start + 0.08);
  tone.connect(gain).connect(audio.destination);
  tone.start(start);
  tone.stop(start + 0.1);
}
