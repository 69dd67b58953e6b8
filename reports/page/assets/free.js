"use strict";
// What was let go, one scene at a time: the mechanism beside the truth, its courses, and its errors.

(() => {
  const { looks, unpacked, freeCourses } = crankcheck;
  const own = crankcheck.embedded("free");
  const part = (name) => document.getElementById(`free-${name}`);
  const [scene, step, course, error, told, table] = ["scene", "step", "course", "error", "told", "cells"].map(part);
  let shown = null; // the scene of the moment
  let legend = null;
  let orders = null;
  let started = false; // the stage has had a drawing
  let last = null; // the mechanism and the position that were drawn last

  /** The runs that are switched on, with their cell of this step. */
  function runs() {
    return shown.lines.filter((line) => legend.on(line.look)).flatMap((line) => {
      const cell = line.cells.find((each) => each.dt === step.value);
      return cell ? [{ look: looks[line.look], cell }] : [];
    });
  }

  const overlays = () => runs().filter(({ cell }) => cell.off).map(({ look, cell }) => {
    cell.rows ??= unpacked(cell.off);
    return { name: look.name, rows: cell.rows, paint: `c${look.colour}` };
  });

  /** The line in the diagram at the time of the drawing. */
  function cursor() {
    const { mechanism, position } = last ?? {};
    const there = last && shown.drawing && course.value !== "portrait";
    crankcheck.putCursor(part("chart"), part("cursor"), there ? (shown.drawing.until_s * position) / (mechanism.samples - 1) : null);
  }

  const stage = crankcheck.stage("free", {
    overlays,
    lasts: () => shown.lasts_ms,
    drawn: (mechanism, position) => {
      last = { mechanism, position };
      cursor();
    },
  });
  const plot = crankcheck.chart(part("chart"), () => freeCourses.overTime(shown, course.value, runs()), cursor);
  const fits = () => own.fits[error.value].filter((fit) => fit.scene === scene.value);
  const against = crankcheck.chart(part("convergence"), () => freeCourses.convergence(fits(), own.units[error.value], orders.on));

  /** The curves over time, with what is said of them. */
  function curves() {
    part("caption").textContent = freeCourses.told(course.value);
    plot();
  }

  /** The errors against the step, with the orders beside the engines. */
  function errors() {
    for (const fit of fits()) orders.note(fit.look, fit.label);
    against();
  }

  function moved() {
    if (shown.drawing) stage.draw();
    curves();
  }

  /** Refill the choice of steps, the finest first chosen, and keep the one that was where it is there. */
  function offerSteps() {
    const every = new Map(shown.lines.flatMap((line) => line.cells.map((cell) => [cell.dt, cell.dt_s])));
    const names = [...every].sort(([, a], [, b]) => a - b).map(([name]) => name);
    const kept = step.value;
    step.replaceChildren(...names.map((name) => crankcheck.html("option", { value: name }, name)));
    step.value = names.includes(kept) ? kept : names[0] ?? "";
  }

  function choose() {
    shown = own.scenes.find((each) => each.name === scene.value);
    const there = new Set(shown.lines.map((line) => line.look));
    const known = new Set(own.judged.filter((look) => there.has(look)));
    const first = (look) => !known.size || known.has(look.number) || look.variant === "as-shipped";
    legend = crankcheck.legend(part("legend"), crankcheck.lookGroups(there, first), moved);
    orders = crankcheck.legend(part("orders"), crankcheck.lookGroups(there), against);
    offerSteps();
    for (const words of told.children) words.hidden = words.dataset.scene !== scene.value;
    for (const row of table.tBodies[0].rows) row.hidden = row.dataset.scene !== scene.value;
    part("picture").closest(".pair").style.display = shown.drawing ? "" : "none"; // no run moved
    if (shown.drawing) stage.set(shown.drawing);
    if (shown.drawing) stage.makeVisible();
    moved();
    errors();
    if (shown.drawing && !started) stage.start();
    started ||= Boolean(shown.drawing);
  }

  scene.addEventListener("change", choose);
  step.addEventListener("change", moved);
  course.addEventListener("change", () => {
    curves();
    cursor();
  });
  error.addEventListener("change", errors);
  choose();
  crankcheck.cellsLead("free", own, (line, { steps }) => {
    scene.value = line.scene;
    choose();
    const drawn = shown.lines.flatMap(({ look, cells }) => (look === line.look ? cells : []));
    step.value = drawn.find(({ dt_s }) => Math.abs(dt_s * steps - 1) < 1e-4)?.dt ?? step.value;
    document.querySelector(`#free-legend [data-item="${line.look}"]`).checked ||= true;
    moved();
  });
})();
