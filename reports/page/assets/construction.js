"use strict";
// The player of a construction: its steps one after the other, then the mechanism through its positions.

(() => {
  const own = crankcheck.embedded("construction");
  const part = (name) => document.getElementById(`construction-${name}`);
  const [picture, slider, play] = ["picture", "slider", "play"].map(part);
  const items = [...part("steps").children];
  const words = items.map((item) => item.textContent.trim());
  // One line of time: UNIT for each step and for the change to the mechanism, MOTION for its way.
  const [UNIT, MOTION, GROWS] = [30, 360, 0.45]; // the share of a step in which its lines grow
  const [LEAST_MS, LETTER_MS, REST_MS, STILL_MS] = [2200, 45, 800, 2500];
  const mechanism = crankcheck.mechanism(picture, own.drawing);
  const figure = crankcheck.constructionFigure(picture, own, mechanism);
  const last = own.steps.length;
  const start = (last + 1) * UNIT; // of the motion
  const end = start + MOTION;
  const samples = mechanism.samples - 1;
  const met = own.at.flatMap((at, n) => (at === null ? [] : [{ n, clock: start + (MOTION * at) / samples }])).sort((a, b) => a.clock - b.clock);
  const stops = [...Array(last + 2).keys()].map((k) => k * UNIT).concat(met.map(({ clock }) => clock))
    .sort((a, b) => a - b).filter((clock, i, all) => i === 0 || clock - all[i - 1] > 1e-6);
  let clock = last * UNIT;
  let playing = false;
  let ticket = 0; // of the next frame, or of the next step of one who wants no motion
  let before = null;
  let rest = 0; // milliseconds to stand still yet
  let stopped = false; // by hand: else the mechanism moves while it is seen, where motion is welcome

  /** The angle of the driver, as it is told. */
  function driver(position) {
    const degrees = Math.round(mechanism.driver(position));
    return `${own.drawing.told.joint} at ${own.drawing.turning ? ((degrees % 360) + 360) % 360 : degrees}°`;
  }

  /** Where it stands: the number of the step, how much of it is drawn, and the sample of the motion. */
  function place() {
    const step = Math.min(Math.ceil(clock / UNIT - 1e-9), last + 1);
    const share = step === 0 ? 1 : Math.min((clock / UNIT - step + 1) / GROWS, 1);
    const position = Math.min(Math.max(((clock - start) / MOTION) * samples, 0), samples);
    return { step, share, position, moves: step > last };
  }

  function told({ step, position, moves }, at) {
    if (!moves) return step === 0 ? "Before the first step" : `Step ${step} of ${last}`;
    return `${driver(position)}${at ? `, position ${at.n + 1} of ${own.at.length}` : ""}`;
  }

  function draw() {
    const here = place();
    const at = here.moves && met.find((one) => Math.abs(one.clock - Math.max(clock, start)) < 0.01);
    picture.classList.toggle("moves", here.moves);
    figure.show(here.moves ? last + 1 : here.step, here.share);
    figure.meet(at ? at.n : -1);
    if (here.moves) mechanism.show(here.position, [], 1);
    slider.value = String(Math.round(clock));
    part("place").textContent = told(here, at);
    part("words").textContent = here.step ? `${here.moves ? "" : `${here.step}. `}${words[here.step - 1]}` : "";
    slider.setAttribute("aria-valuetext", here.moves || !here.step ? told(here, at) : `${told(here)}: ${words[here.step - 1]}`);
    items.forEach((item, k) => {
      item.classList.toggle("drawn", k < here.step);
      item.classList.toggle("now", k === here.step - 1);
      if (k === here.step - 1) item.setAttribute("aria-current", "step");
      else item.removeAttribute("aria-current");
    });
  }

  function stand(at) {
    clock = Math.max(0, Math.min(at, end));
    rest = 0;
    draw();
  }

  /** The next stop of a way, or where it stands. */
  const next = () => stops.find((stop) => stop > clock + 1e-6) ?? clock;
  const previous = () => stops.findLast((stop) => stop < clock - 1e-6) ?? 0;

  /** How long a unit of the line of time takes here: a step as long as one reads its words. */
  function pace() {
    if (clock >= start) return own.lasts_ms / MOTION;
    const step = Math.floor(clock / UNIT);
    return (step >= last ? LEAST_MS : Math.max(LEAST_MS, LETTER_MS * words[step].length)) / UNIT;
  }

  function frame(now) {
    const gone = Math.min(now - (before ?? now), 100);
    before = now;
    if (rest > 0) rest -= gone;
    else {
      const stop = next();
      clock += gone / pace();
      if (stop > clock - gone / pace() && clock >= stop && stop >= start) [clock, rest] = [stop, REST_MS];
    }
    if (clock >= end) clock = start;
    draw();
    if (playing) ticket = requestAnimationFrame(frame);
  }

  /** For those who want no motion: whole steps, then the positions alone. */
  function skip() {
    if (next() === clock) run(false);
    else stand(next());
    if (playing && next() === clock) run(false);
    if (playing) ticket = setTimeout(skip, STILL_MS);
  }

  /** Play or stop; by hand from the first step where the whole drawing stands. */
  function run(on, byHand = false) {
    stopped = byHand && !on;
    if (byHand && on && (next() === clock || clock === last * UNIT)) clock = 0;
    [playing, before] = [on, null];
    play.textContent = on ? "Pause" : "Play";
    cancelAnimationFrame(ticket);
    clearTimeout(ticket);
    if (!on) return;
    if (crankcheck.calm.matches) skip();
    else ticket = requestAnimationFrame(frame);
  }

  /** Stop, and stand there. */
  function go(at) {
    run(false, true);
    stand(at);
  }

  function onKey(event) {
    if (event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const isBusy = event.target.closest("button, a, summary, select, input") !== null;
    if (event.key === "ArrowRight" || (event.target === slider && event.key === "ArrowUp")) go(next());
    else if (event.key === "ArrowLeft" || (event.target === slider && event.key === "ArrowDown")) go(previous());
    else if (event.key === " " && (!isBusy || event.target === slider)) {
      run(!playing, true);
    } else return;
    event.preventDefault();
  }

  function refit() {
    mechanism.refit();
    figure.refit();
    const off = own.far.filter(({ at }) => !figure.isSeen(at)).map((each) => each.words);
    part("far").textContent = off.length ? `Off the picture: ${off.join("; ")}.` : "";
    draw();
  }

  slider.max = String(end);
  slider.addEventListener("input", () => go(Number(slider.value)));
  play.addEventListener("click", () => run(!playing, true));
  part("back").addEventListener("click", () => go(previous()));
  part("forward").addEventListener("click", () => go(next()));
  items.forEach((item, k) => item.firstElementChild.addEventListener("click", () => go((k + 1) * UNIT)));
  document.addEventListener("keydown", onKey);
  new ResizeObserver(refit).observe(picture);
  new IntersectionObserver((entries) => {
    if (stopped) return;
    if (!entries.at(-1).isIntersecting) run(false); // nobody looks
    else if (!playing && !crankcheck.calm.matches) run(true); // on from the finished drawing
  }, { threshold: 0.5 }).observe(picture);
  refit();
})();
