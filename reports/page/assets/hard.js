"use strict";
// Hard cases: the run that was chosen in the map opens below its row, with what happened in motion.

(() => {
  const { html, short, unpacked } = crankcheck;
  const own = crankcheck.embedded("hard");
  const part = (name) => document.getElementById(`hard-${name}`);
  const [table, row, figure, failures] = ["map", "row", "figure", "failures"].map(part);
  const ROOM = 0.6; // how far beyond the reference a run is kept in the picture, over the truth's size
  const FARTHEST = 40; // far out of the picture, over the size of the drawing
  const ROUND_MS = 5000; // a turn of the crank on the screen; more turns take longer, but not for ever
  const order = own.pictures.map((picture) => picture.run);
  let chosen = null; // the number of a run
  let picture = null; // and its moving picture
  let started = false;

  const cellOf = (number) => table.querySelector(`button[data-run="${number}"]`);
  const name = (run) => `${run.engine} ${run.profile}`;

  /** The position at which a run is farthest off while it is still in the picture. */
  function farthest(mechanism) {
    const rows = picture.rows.slice(0, 2 * picture.shape.points.length);
    let [most, found] = [0, mechanism.samples - 1];
    for (let at = 1; at < mechanism.samples; at += 1) {
      const off = Math.max(0, ...rows.map((each) => Math.abs(each[at])));
      if (off > most && off <= ROOM * mechanism.size) [most, found] = [off, at];
    }
    return found;
  }

  /** How long a picture lasts, by the turns of its driver, of a slider as of one. */
  function lasts() {
    const degrees = picture.shape.told.unit === "deg" ? picture.shape.told.at : [0, 360];
    const turned = degrees.slice(1).reduce((sum, each, i) => sum + Math.abs(each - degrees[i]), 0);
    return ROUND_MS * Math.min(Math.max(turned / 360, 0.7), 2.5);
  }

  const stage = crankcheck.stage("hard", {
    overlays: () => !picture ? [] : [{ name: name(own.runs[picture.run]), rows: picture.rows, paint: "failed", trail: true }],
    home: farthest, lasts, rest: 0.2, reach: FARTHEST,
  });

  /** The drawing with room for the run as well: its box is that of both, as far as there is room. */
  function roomy(drawing, rows) {
    const places = unpacked(drawing.places);
    const size = Math.max(drawing.box[2] - drawing.box[0], drawing.box[3] - drawing.box[1]);
    const box = [...drawing.box];
    places.forEach((exact, i) => {
      const axis = i % 2;
      exact.forEach((value, at) => {
        const there = value + rows[i][at];
        if (!Number.isFinite(there)) return;
        box[axis] = Math.max(Math.min(box[axis], there), drawing.box[axis] - ROOM * size);
        box[axis + 2] = Math.min(Math.max(box[axis + 2], there), drawing.box[axis + 2] + ROOM * size);
      });
    });
    return { ...drawing, box };
  }

  /** A picture with its rows unpacked, once. */
  function opened(number) {
    const found = own.pictures.find((each) => each.run === number);
    if (found && !found.shape) {
      found.rows = unpacked(found.rows);
      found.shape = roomy(own.drawings[found.drawing], found.rows);
    }
    return found ?? null;
  }

  /** Pairs of what a run was measured by. */
  function numbers(run) {
    const known = own.cases[run.case];
    const steps = run.steps ? ` × ${run.steps} steps` : "";
    const at = run.at_s === null ? "" : `${Number(run.at_s.toPrecision(4))} s`;
    const driver = run.at_driver === null ? "" : `, ${run.at_driver}`;
    return [
      [`worst error of ${known?.error_of ?? "place"}`, `${short(run.error)} (held below ${short(known?.within ?? null)})`],
      ["widest gap of a pin", short(run.gap)],
      ...(run.drive === null ? [] : [["error of the driver", short(run.drive)]]), // nothing drives it
      ["distance from singular, 0 to 1", run.sine >= 0.01 ? run.sine.toFixed(2) : short(run.sine)],
      ["happens at", at ? at + driver : "–"],
      ["step", run.dt_s === null ? "–" : `${short(run.dt_s, 3)} s${steps}`],
      ["took", run.wall_s === null ? "–" : crankcheck.duration(run.wall_s)],
    ];
  }

  /** A run in a few letters, to be chosen: what the bisection looked at is in no cell of the map. */
  function chip(number) {
    const run = own.runs[number];
    const shade = run.shade < 0 ? "blank" : `s${run.shade}`;
    const button = html(
      "button",
      {
        type: "button", "data-near": String(number), "aria-pressed": String(number === chosen),
        class: `cell o-${run.kind} ${shade} ${run.held ? "held" : "failed"}${opened(number) ? " pictured" : ""}`,
        "aria-label": `${run.value_told}: ${run.outcome}, ${run.held ? "holds" : "fails"}`,
      },
      html("b", {}, run.sign), html("span", { class: "at" }, run.label),
    );
    button.addEventListener("click", () => {
      choose(number);
      part("between").querySelector(`[data-near="${number}"]`)?.focus();
    });
    return button;
  }

  function between(run) {
    const near = own.runs.flatMap((each, number) =>
      !each.grid && each.case === run.case && each.engine === run.engine && each.profile === run.profile ? [number] : []);
    near.sort((a, b) => own.runs[a].value - own.runs[b].value);
    const words = near.length ? [html("p", { class: "note" }, "Tried by the bisection, in between:")] : [];
    part("between").replaceChildren(...words, html("div", { class: "strip" }, ...near.map(chip)));
  }

  function noPicture(run) {
    if (picture) return "";
    return run.held ? "Pictures are kept of failures only." : "There is no moving picture of this run.";
  }

  function tell() {
    const run = own.runs[chosen];
    const known = own.cases[run.case];
    part("told").replaceChildren(
      html("span", { class: `cell small o-${run.kind} s3 ${run.held ? "held" : "failed"}`, "aria-hidden": "true" }, html("b", {}, run.sign)),
      html("strong", {}, `${known?.title ?? run.case}: ${run.outcome}`),
      html("span", { class: "quietly" }, `${name(run)}, ${known?.parameter ?? "value"} = ${run.value_told}`),
    );
    part("reason").textContent = run.reason || (run.held ? "Within the class throughout." : "");
    part("numbers").replaceChildren(...numbers(run).map(([term, told]) =>
      html("div", {}, html("dt", {}, term), html("dd", {}, told))));
    // Each option stays in one line; what is copied is the text.
    part("command").replaceChildren(...run.command.split(/(?= --)/).map((each) => html("span", {}, each)));
    part("note").textContent = noPicture(run);
    part("engine").textContent = name(run);
    if (picture) part("picture").setAttribute("aria-label", `${picture.title}: the reference, and ${name(run)} over it`);
    between(run);
    const place = order.indexOf(chosen);
    part("before").disabled = !order.length || place === 0;
    part("after").disabled = !order.length || place === order.length - 1;
  }

  /** The row of a run: that of its cell, or, for what a bisection looked at, of its case. */
  function home(number) {
    const run = own.runs[number];
    const like = own.runs.findIndex((each) => each.grid && each.case === run.case && each.engine === run.engine && each.profile === run.profile);
    return (cellOf(number) ?? cellOf(like))?.closest("tr");
  }

  function mark(number) {
    for (const each of table.querySelectorAll("button[data-run]")) {
      each.setAttribute("aria-expanded", String(each.dataset.run === String(number)));
    }
    if (failures) failures.value = order.includes(number) ? String(number) : "";
  }

  /** Show a run below its row. */
  function choose(number) {
    const place = home(number);
    if (!place) return;
    chosen = number;
    picture = opened(number);
    if (place.nextElementSibling !== row) place.after(row);
    row.hidden = false;
    row.classList.remove("waiting");
    figure.hidden = !picture;
    mark(number);
    tell();
    stage.run(false);
    if (!picture) return;
    stage.set(picture.shape);
    stage.draw();
    if (!started) stage.start();
    started = true;
  }

  /** Choose with something that stays where it is on the screen. */
  function steadily(still, change) {
    const before = still().getBoundingClientRect().top;
    change();
    scrollBy({ top: still().getBoundingClientRect().top - before, behavior: "instant" });
  }

  /** Bring what was opened into the window, without losing its row. */
  function reveal() {
    const under = row.getBoundingClientRect().bottom - innerHeight;
    const above = row.previousElementSibling.getBoundingClientRect().top;
    if (under > 0) scrollBy({ top: Math.min(under + 8, above - 8), behavior: "instant" });
    if (above < 0) scrollBy({ top: above - 8, behavior: "instant" });
  }

  function close() {
    const from = cellOf(chosen);
    stage.run(false);
    row.hidden = true;
    chosen = null;
    mark(null);
    from?.focus();
  }

  /** The next failure that has a picture, from wherever the choice stands. */
  function step(way) {
    const place = order.indexOf(chosen);
    const next = place >= 0 ? place + way : way > 0 ? order.findIndex((number) => number > chosen) : order.findLastIndex((number) => number < chosen);
    if (order[next] === undefined) return;
    steadily(() => row, () => choose(order[next]));
    stage.greet();
  }

  const arrows = crankcheck.arrows(table, "button[data-run]");
  table.addEventListener("click", (event) => {
    const button = event.target.closest("button[data-run]");
    if (!button) return;
    const number = Number(button.dataset.run);
    arrows.enter(button);
    if (number === chosen) {
      close();
      return;
    }
    steadily(() => button, () => choose(number));
    reveal();
    if (picture) stage.greet();
  });
  failures?.addEventListener("change", () => {
    if (failures.value === "") return;
    choose(Number(failures.value));
    reveal();
    stage.greet();
  });
  part("before").addEventListener("click", () => step(-1));
  part("after").addEventListener("click", () => step(1));
  part("close").addEventListener("click", close);
  part("panel").addEventListener("keydown", (event) => {
    if (event.key === "Escape") close();
  });
  if (order.length) choose(order[0]);
})();
