"use strict";
// One scene at a time: the drawing with its controls, and the curves beside it.

(() => {
  const { looks, short, unpacked } = crankcheck;
  const own = crankcheck.embedded("motion");
  const part = (name) => document.getElementById(`motion-${name}`);
  const [scene, steps, factor, slider, play] = ["scene", "steps", "factor", "slider", "play"].map(part);
  const [picture, readout, told, settings, scale, floor] = ["picture", "readout", "told", "settings", "scale", "floor"].map(part);
  const TURN_MS = 5000; // one turn of the crank on the screen
  const VISIBLE = 0.06; // of the drawing: what "make it visible" aims at
  let shown = null; // the scene of the moment
  let mechanism = null;
  let legend = null;
  let position = 0;
  let playing = false;
  let before = null; // when the last frame was drawn
  let left = Infinity; // samples to go
  let greeted = false; // it has moved by itself once

  const cellAt = (line) => line.cells.find((cell) => String(cell.steps) === steps.value);

  /** The runs that are drawn: those switched on that have a motion at this step. */
  function runs() {
    return shown.lines.filter((line) => legend.on(line.look)).flatMap((line) => {
      const cell = cellAt(line);
      if (!cell?.off) return [];
      cell.rows ??= unpacked(cell.off);
      const look = looks[line.look];
      return [{ look, rows: cell.rows, paint: `c${look.colour}` }];
    });
  }

  function draw() {
    const each = runs();
    const cut = mechanism.show(position, each, Number(factor.value));
    const degrees = mechanism.degrees(position);
    slider.value = String(Math.round(position));
    const turned = shown.drawing.turning ? ((Math.round(degrees) % 360) + 360) % 360 : Math.round(degrees);
    const told = turned.toFixed(0);
    slider.setAttribute("aria-valuetext", `crank at ${told} degrees`);
    part("angle").textContent = `${told}°`;
    const off = each.map(({ look, rows }) => `${look.name} ${short(mechanism.farthest(rows, position))} m`);
    readout.textContent = (off.length ? `Off the reference here by: ${off.join("; ")}.` : "No run is drawn.") +
      (cut ? " What would leave the drawing is cut off." : "");
    cursor();
  }

  /** The line in the diagram at the drawing's crank angle. */
  function cursor() {
    const chart = part("chart");
    const axes = chart._fullLayout;
    const line = part("cursor");
    line.hidden = true;
    if (!axes?.xaxis) return;
    const turning = shown.drawing.turning;
    const x = turning ? mechanism.degrees(position) : (100 * position) / (mechanism.samples - 1);
    const place = axes.xaxis.l2p(x);
    if (!(place >= 0 && place <= axes.xaxis._length)) return;
    line.hidden = false;
    line.style.left = `${axes.xaxis._offset + place}px`;
    line.style.top = `${axes.yaxis._offset}px`;
    line.style.height = `${axes.yaxis._length}px`;
  }

  function frame(now) {
    if (!playing) return;
    const last = mechanism.samples - 1;
    const moved = ((now - (before ?? now)) / TURN_MS) * last;
    left -= moved;
    position = (position + moved) % last;
    before = now;
    if (left <= 0) {
      position = 0;
      run(false);
    }
    draw();
    requestAnimationFrame(frame);
  }

  /** Play or stop; `turns` is how often the crank goes round. */
  function run(on, turns = Infinity) {
    playing = on;
    before = null;
    left = turns * (mechanism.samples - 1);
    play.textContent = on ? "Pause" : "Play";
    if (on) requestAnimationFrame(frame);
  }

  const parts = crankcheck.legend(part("parts"), crankcheck.parts.groups(), () => curves());
  const lineChosen = () => shown.lines.find((each) => String(each.look) === settings.value);
  const partsChosen = () => (lineChosen() && cellAt(lineChosen())?.parts) ?? null;
  const plot = crankcheck.chart(part("chart"), () => {
    const found = partsChosen();
    const axis = found && shown.axes[found.axis];
    return crankcheck.parts.figure(found, axis, shown.body, shown.drawing.turning, scale.value === "log", parts.on);
  }, cursor);

  /** The curves of the run that is chosen, with their legend and what is said of its floor. */
  function curves() {
    const found = partsChosen();
    floor.textContent = found ? lineChosen().floor : "No curve of this run: see Stability.";
    parts.offer(found ? found.names : []);
    plot();
  }

  const option = (value, text) => crankcheck.html("option", { value: String(value) }, text);

  /** Refill the choice of steps, and keep the one that was chosen where it is there. */
  function offerSteps() {
    const every = [...new Set(shown.lines.flatMap((line) => line.cells.map((cell) => cell.steps)))].sort((a, b) => a - b);
    const kept = steps.value;
    steps.replaceChildren(...every.map((n) => option(n, String(n))));
    const wanted = every.map(String).includes(kept) ? kept : every[Math.min(1, every.length - 1)];
    steps.value = String(wanted ?? "");
  }

  /** Of each engine the settings that are drawn at first: the judged ones, else the last. */
  function firstShown() {
    const best = new Map();
    for (const { look } of shown.lines) {
      const engine = looks[look].engine;
      if (!best.has(engine) || own.judged.includes(look) || !own.judged.includes(best.get(engine))) best.set(engine, look);
    }
    return new Set(best.values());
  }

  function choose() {
    shown = own.scenes.find((each) => each.drawing.name === scene.value);
    mechanism = crankcheck.mechanism(picture, shown.drawing);
    position = 0;
    slider.max = String(mechanism.samples - 1);
    offerSteps();
    const first = firstShown();
    const there = new Set(shown.lines.map((line) => line.look));
    legend = crankcheck.legend(part("legend"), crankcheck.lookGroups(there, (look) => first.has(look.number)), draw);
    const kept = settings.value;
    settings.replaceChildren(...[...there].map((n) => option(n, looks[n].name)));
    settings.value = there.has(Number(kept)) && kept !== "" ? kept : String([...first][0] ?? "");
    for (const words of told.children) words.hidden = words.dataset.scene !== scene.value;
    draw();
    curves();
  }

  /** The power of ten that makes the largest error of the moment a small part of the drawing. */
  function makeVisible() {
    const most = Math.max(0, ...runs().map(({ rows }) => mechanism.farthest(rows)));
    const wanted = most > 0 ? Math.round(Math.log10((VISIBLE * mechanism.size) / most)) : 0;
    const powers = [...factor.options].map((each) => Math.log10(Number(each.value)));
    factor.value = String(10 ** Math.max(powers[0], Math.min(powers.at(-1), wanted)));
    draw();
  }

  scene.addEventListener("change", choose);
  steps.addEventListener("change", () => {
    draw();
    curves();
  });
  factor.addEventListener("change", draw);
  part("visible").addEventListener("click", makeVisible);
  settings.addEventListener("change", curves);
  scale.addEventListener("change", curves);
  play.addEventListener("click", () => run(!playing));
  slider.addEventListener("input", () => {
    run(false);
    position = Number(slider.value);
    draw();
  });
  choose();
  new ResizeObserver(() => {
    mechanism.refit();
    draw();
  }).observe(picture);
  new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) {
      run(false); // nobody looks
    } else if (!greeted && !crankcheck.calm.matches) {
      greeted = true;
      run(true, 1); // one turn, to show that it moves
    }
  }, { threshold: 0.5 }).observe(picture);
})();
