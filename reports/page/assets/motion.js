"use strict";
// One scene at a time: the drawing with its controls, and the curves beside it.

(() => {
  const { looks, unpacked } = crankcheck;
  const own = crankcheck.embedded("motion");
  const part = (name) => document.getElementById(`motion-${name}`);
  const [scene, steps, told, settings, scale, floor, body] = ["scene", "steps", "told", "settings", "scale", "floor", "body"].map(part);
  let shown = null; // the scene of the moment
  let legend = null;
  let isMagnified = false; // by a factor that was chosen
  let last = null; // the mechanism and the position that were drawn last

  const cellAt = (line) => line.cells.find((cell) => String(cell.steps) === steps.value);

  /** The runs that are drawn: those switched on that have a motion at this step. */
  function runs() {
    return shown.lines.filter((line) => legend.on(line.look)).flatMap((line) => {
      const cell = cellAt(line);
      if (!cell?.off) return [];
      cell.rows ??= unpacked(cell.off);
      const look = looks[line.look];
      return [{ name: look.name, rows: cell.rows, paint: `c${look.colour}` }];
    });
  }

  /** The line in the diagram where the drawing's driver stands. */
  function cursor() {
    const { mechanism, position } = last ?? {};
    const at = () => (shown.drawing.turning ? mechanism.driver(position) : (100 * position) / (mechanism.samples - 1));
    crankcheck.putCursor(part("chart"), part("cursor"), last && at());
  }

  // The first screen has the same mechanism, with the same engines.
  const answer = crankcheck.stage("answer", { overlays: runs, magnified: () => Number(part("factor").value) });
  const showCell = crankcheck.cellPanel("motion", own);
  const stage = crankcheck.stage("motion", {
    overlays: runs,
    drawn: (mechanism, position) => {
      last = { mechanism, position };
      cursor();
    },
  });
  const every = own.scenes.flatMap((each) => each.lines.flatMap((line) => line.cells.map((cell) => cell.parts)));
  const parts = crankcheck.legend(part("parts"), crankcheck.parts.groups(every), () => curves());
  const lineChosen = () => shown.lines.find((each) => String(each.look) === settings.value);
  const partsChosen = () => (lineChosen() && cellAt(lineChosen())?.parts) ?? null;
  const plot = crankcheck.chart(part("chart"), () => {
    const found = partsChosen();
    const axis = found && shown.axes[found.axis];
    const other = shown.body && body.value !== shown.body.name;
    part("parts").hidden = Boolean(other);
    const drawn = other ? { name: body.value, turns: body.value.startsWith("angle"), other } : shown.body;
    return crankcheck.parts.figure(found, axis, drawn, shown.drawing, scale.value === "log", parts.on);
  }, cursor);

  /** The curves of the run that is chosen, with their legend and what is said of its floor. */
  function curves() {
    const found = partsChosen();
    floor.textContent = found ? lineChosen().floor : "No curve of this run: see Stability.";
    parts.offer(found ? found.names : []);
    plot();
    showCell(lineChosen(), lineChosen() && cellAt(lineChosen()), scene.value);
  }

  function redraw() {
    stage.draw();
    answer.draw();
    const factor = part("factor").selectedOptions[0].textContent;
    document.getElementById("answer-told").textContent = `${scene.value}, ${steps.value} steps a turn, in grey the reference; errors of the engines: ${factor}.`;
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

  /** Of each engine the settings that are drawn at first: as shipped, and the judged ones, else the last. */
  function firstShown() {
    const best = new Map();
    for (const { look } of shown.lines) {
      const engine = looks[look].engine;
      if (!best.has(engine) || own.judged.includes(look) || !own.judged.includes(best.get(engine))) best.set(engine, look);
    }
    const shipped = shown.lines.map(({ look }) => look).filter((look) => looks[look].variant === "as-shipped");
    return new Set([...best.values(), ...shipped]);
  }

  function choose() {
    shown = own.scenes.find((each) => each.drawing.name === scene.value);
    stage.set(shown.drawing);
    answer.set(shown.drawing);
    offerSteps();
    const first = firstShown();
    const there = new Set(shown.lines.map((line) => line.look));
    const was = legend;
    const on = ({ number }) => was?.kept(number) ?? first.has(number);
    legend = crankcheck.legend(part("legend"), crankcheck.lookGroups(there, on), redraw);
    const bodies = shown.lines.flatMap((line) => line.cells.flatMap((cell) => cell.parts?.names ?? []));
    const others = [...new Set([shown.body?.name ?? "", ...bodies.filter((name) => !crankcheck.parts.isPart(name))])];
    body.replaceChildren(...others.map((name, i) => option(name, i ? name : `${name}, the worst`)));
    const kept = settings.value;
    settings.replaceChildren(...[...there].map((n) => option(n, looks[n].name)));
    settings.value = there.has(Number(kept)) && kept !== "" ? kept : String([...first][0] ?? "");
    for (const words of told.children) words.hidden = words.dataset.scene !== scene.value;
    if (!isMagnified) stage.makeVisible(); // until a factor is chosen by hand
    redraw();
    curves();
  }

  scene.addEventListener("change", choose);
  steps.addEventListener("change", () => {
    redraw();
    curves();
  });
  part("factor").addEventListener("change", () => {
    isMagnified = true;
    redraw();
  });
  part("visible").addEventListener("click", redraw);
  settings.addEventListener("change", curves);
  for (const each of [scale, body]) each.addEventListener("change", curves);
  const linesOf = (name) => own.scenes.find((each) => each.drawing.name === name)?.lines ?? [];
  crankcheck.leads("motion-known", (at) => linesOf(at.scene || scene.value).some(({ look }) => String(look) === at.look), (at) => {
    scene.value = at.scene || scene.value;
    choose();
    settings.value = at.look;
    const { cells } = lineChosen();
    steps.value = String(at.steps ? Number(at.steps) : cells.at(-1).steps);
    redraw();
    curves();
  });
  choose();
  for (const each of [answer, stage]) each.start();
})();
