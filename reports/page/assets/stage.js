"use strict";
// A stage: the drawing of a mechanism with what moves it. Play and pause, where the driver stands, a factor
// by which errors are magnified, and what the runs are off by at the moment.

/**
 * Take the elements `${name}-picture`, `-play`, `-slider`, `-angle`, `-factor`, `-visible` and
 * `-readout`. `overlays(mechanism)` gives the runs to be drawn: `{name, rows, paint}`; `drawn` is
 * called after every drawing. A stage that stands still stands at `home(mechanism)`; going round
 * takes `lasts(mechanism)` milliseconds, after which it rests for `rest` times as long. A stage without
 * `-factor`, `-visible` and `-readout` is one of the reference alone, or `magnified()` by the factor of another.
 */
crankcheck.stage = (name, { overlays, drawn = () => {}, home = () => 0, lasts = () => 5000, rest = 0, reach, magnified }) => {
  const { short } = crankcheck;
  const part = (word) => document.getElementById(`${name}-${word}`);
  const [picture, factor, slider, play, readout] = ["picture", "factor", "slider", "play", "readout"].map(part);
  const VISIBLE = 0.06; // of the drawing: what "make it visible" aims at
  let drawing = null;
  let mechanism = null;
  let position = 0;
  let clock = 0; // samples since the start of the round; beyond the last the stage rests
  let playing = false;
  let ticket = 0; // of the next frame
  let before = null; // when the last frame was drawn
  let stopped = false; // by hand: else it moves while it is seen, where motion is welcome

  const degrees = (at) => {
    const rounded = Math.round(mechanism.driver(at));
    return (drawing.turning ? ((rounded % 360) + 360) % 360 : rounded).toFixed(0);
  };

  /** Where the drawing stands, as it is shown and as it is said: the driver's place, or a time. */
  function place(at) {
    if (drawing.until_s === undefined) {
      const { joint, unit } = drawing.told;
      if (unit === "deg") return [`${degrees(at)}°`, `${joint} at ${degrees(at)} degrees`];
      const metres = mechanism.driver(at).toPrecision(3);
      return [`${metres} m`, `${joint} at ${metres} metres`];
    }
    const seconds = ((at / (mechanism.samples - 1)) * drawing.until_s).toPrecision(3);
    return [`${seconds} s`, `at ${seconds} seconds`];
  }

  function draw() {
    const each = overlays(mechanism);
    const cut = mechanism.show(position, each, Number(factor?.value ?? magnified?.() ?? 1));
    slider.value = String(Math.round(position));
    const [shown, said] = place(position);
    slider.setAttribute("aria-valuetext", said);
    part("angle").textContent = shown;
    const off = each.map((run) => `${run.name} ${short(mechanism.farthest(run.rows, position))} m`);
    if (readout) readout.textContent = (off.length ? `Off the reference here by: ${off.join("; ")}.` : "No run is drawn.") +
      (cut ? " Parts outside the drawing are cut off." : "");
    drawn(mechanism, position);
  }

  /** Stand at a position. */
  function stand(at) {
    position = at;
    clock = at;
  }

  function frame(now) {
    const last = mechanism.samples - 1;
    const round = last * (1 + rest);
    const moved = ((now - (before ?? now)) / lasts(mechanism)) * last;
    clock = (clock + moved) % round;
    position = Math.min(clock, last);
    before = now;
    draw();
    if (playing) ticket = requestAnimationFrame(frame);
  }

  /** Play, round after round, or stop. */
  function run(on) {
    if (!mechanism) return;
    if (on && !playing && position === home(mechanism)) stand(0);
    playing = on;
    before = null;
    play.textContent = on ? "Pause" : "Play";
    cancelAnimationFrame(ticket);
    if (on) ticket = requestAnimationFrame(frame);
  }

  /** Move where motion is welcome, unless it was stopped by hand. */
  const greet = () => run(!stopped && !crankcheck.calm.matches);

  /** Show another drawing; `draw` is left to the caller. */
  function set(shown) {
    drawing = shown;
    mechanism = crankcheck.mechanism(picture, drawing, reach);
    slider.max = String(mechanism.samples - 1);
    stand(home(mechanism));
  }

  /** The power of ten that makes the largest error of the moment a small part of the drawing. */
  function makeVisible() {
    const most = Math.max(0, ...overlays(mechanism).map(({ rows }) => mechanism.farthest(rows)));
    const wanted = most > 0 ? Math.round(Math.log10((VISIBLE * mechanism.size) / most)) : 0;
    const powers = [...factor.options].map((each) => Math.log10(Number(each.value)));
    factor.value = String(10 ** Math.max(powers[0], Math.min(powers.at(-1), wanted)));
    draw();
  }

  /** Begin: the controls work, and the drawing follows its size. Call it once, with a drawing set. */
  function start() {
    factor?.addEventListener("change", draw);
    part("visible")?.addEventListener("click", makeVisible);
    play.addEventListener("click", () => {
      stopped = playing;
      run(!playing);
    });
    slider.addEventListener("input", () => {
      stopped = true;
      run(false);
      stand(Number(slider.value));
      draw();
    });
    new ResizeObserver(() => {
      mechanism.refit();
      draw();
    }).observe(picture);
    new IntersectionObserver((entries) => {
      if (!entries.at(-1).isIntersecting) run(false); // nobody looks
      else if (!playing) greet();
    }, { threshold: 0.5 }).observe(picture);
  }

  return { set, draw, run, greet, start, makeVisible };
};
