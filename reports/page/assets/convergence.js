"use strict";
// Error against step, with the fitted curves and floors.

(() => {
  const { colour, escaped, folded, short } = crankcheck;
  const own = crankcheck.embedded("convergence");
  const scene = document.getElementById("convergence-scene");
  const quantity = document.getElementById("convergence-quantity");
  const table = document.getElementById("fits");
  const per = () => ((own.faceted || []).includes(scene.value) ? "facets" : "steps a turn");
  const lines = () => own.quantities[quantity.value].filter((line) => line.scene === scene.value);

  function traces(line) {
    const look = crankcheck.looks[line.look];
    const paint = colour(`c${look.colour}`);
    const visible = legend.on(line.look);
    const last = line.steps.length ? Math.max(...line.steps) : 0;
    const head = `<b>${escaped(look.name)}</b><br>`;
    const tail = `<br>${folded(line.words)}`;
    return [
      {
        x: line.curve.map(([steps]) => steps), y: line.curve.map(([, error]) => error), visible, mode: "lines",
        name: `${look.name} fit`, hoverinfo: "skip", line: { color: paint, width: 1.8, dash: look.dash },
      },
      {
        x: line.steps, y: line.error, visible, mode: "markers", name: look.name,
        marker: { color: paint, size: look.size, symbol: look.symbol },
        text: line.steps.map((steps, i) => `${head}${steps} ${per()}: ${short(line.error[i])}${tail}`),
        hovertemplate: "%{text}<extra></extra>",
      },
      {
        x: line.floor === null ? [] : [Math.min(...line.steps), 1.25 * last],
        y: line.floor === null ? [] : [line.floor, line.floor],
        visible, mode: "lines", name: `${look.name} floor`, line: { color: paint, width: 1.2, dash: "2px,4px" },
        hovertemplate: `${head}floor ${short(line.floor)}<extra></extra>`,
      },
    ];
  }

  function figure() {
    const shown = lines();
    const steps = [...new Set(shown.flatMap((line) => line.steps))].sort((a, b) => a - b);
    const ticks = steps.length && steps.length < 9 ? { tickvals: steps, ticktext: steps.map(String) } : {};
    return {
      data: shown.flatMap(traces),
      layout: {
        xaxis: { ...crankcheck.logAxis(per(), false), ...ticks },
        yaxis: crankcheck.logAxis(`error [${own.units[quantity.value]}]`, true),
      },
    };
  }

  function notes() {
    for (const line of lines()) legend.note(line.look, line.label);
    for (const row of table.tBodies[0].rows) row.hidden = row.dataset.scene !== scene.value;
  }

  const drawn = new Set(Object.values(own.quantities).flat().map((line) => line.look));
  const legend = crankcheck.legend(
    document.getElementById("convergence-legend"), crankcheck.lookGroups(drawn), () => draw(),
  );
  const draw = crankcheck.chart(document.getElementById("convergence-chart"), figure);
  for (const field of [scene, quantity]) {
    field.addEventListener("change", () => {
      notes();
      draw();
    });
  }
  table.classList.add("of-one-scene");
  notes();
})();
