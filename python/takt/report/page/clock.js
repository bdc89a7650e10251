// The time that the whole page shows, and the bar that moves it.

import { byId, el } from "../../view/page/dom.js";

const SPEEDS = [0.01, 0.1, 0.25, 0.5, 1, 2, 5, 10, 60];

export class Clock extends EventTarget {
  // From when to when, and how far a step goes.
  constructor([from, to], step) {
    super();
    Object.assign(this, { from, to, step, time: from, speed: 1, playing: false });
  }

  set(time) {
    this.time = Math.min(Math.max(time, this.from), this.to);
    this.dispatchEvent(new Event("change"));
  }

  play(on = !this.playing) {
    this.playing = on;
    if (on && this.time >= this.to) this.time = this.from;
    this.dispatchEvent(new Event("change"));
    let last = performance.now();
    const turn = (now) => {
      if (!this.playing) return;
      const next = this.time + ((now - last) / 1000) * this.speed;
      last = now;
      if (next >= this.to) this.playing = false;
      this.set(next);
      requestAnimationFrame(turn);
    };
    if (on) requestAnimationFrame((now) => { last = now; requestAnimationFrame(turn); });
  }
}

export function showPlayer(clock) {
  const [slider, play, speed] = ["slider", "play", "speed"].map(byId);
  const decimals = Math.min(6, Math.max(3, Math.ceil(-Math.log10(clock.step))));
  byId("player").hidden = false;
  Object.assign(slider, { min: clock.from, max: clock.to });
  speed.replaceChildren(...SPEEDS.map((value) => el("option", { value, textContent: `${value}×`, selected: value === 1 })));
  speed.onchange = () => { clock.speed = Number(speed.value); };
  slider.oninput = () => clock.set(Number(slider.value));
  play.onclick = () => clock.play();
  const show = () => {
    slider.value = clock.time;
    byId("time").textContent = `${clock.time.toFixed(decimals)} s`;
    play.textContent = clock.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", clock.playing ? "Pause" : "Play");
  };
  clock.addEventListener("change", show);
  show();
  const keys = {
    ArrowRight: (event) => clock.set(clock.time + (event.shiftKey ? 0.1 : clock.step)),
    ArrowLeft: (event) => clock.set(clock.time - (event.shiftKey ? 0.1 : clock.step)),
    PageUp: () => clock.set(clock.time - 1),
    PageDown: () => clock.set(clock.time + 1),
    Home: () => clock.set(clock.from),
    End: () => clock.set(clock.to),
    " ": () => clock.play(),
  };
  addEventListener("keydown", (event) => {
    const { target } = event;
    if (target !== slider && /INPUT|SELECT|TEXTAREA/.test(target.tagName)) return;
    // Pages are scrolled by some of these, and buttons pressed: only at the slider they are all its own.
    if (target !== slider && /^(Page|Home|End)/.test(event.key)) return;
    if (event.key === " " && /BUTTON|SUMMARY/.test(target.tagName)) return;
    if (event.ctrlKey || event.altKey || event.metaKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key](event);
  });
}
