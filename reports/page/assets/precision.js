"use strict";
// Error against cost: one scene at a time, or all of them.

(() => {
  const { colour, duration, escaped, folded, short } = crankcheck;
  const own = crankcheck.embedded("precision");
  const scene = document.getElementById("precision-scene");
  const cost = document.getElementById("precision-cost");
  const filled = document.getElementById("precision-filled");
  const chart = document.getElementById("precision-chart");
  if (!own.timed) cost.closest(".field").hidden = true;
  cost.value = own.timed ? "time" : "steps";

  /** The cost of the points of a line: time a turn [ms], or steps. */
  const costs = (line, kind) => (kind === "time" ? line.s_per_turn.map((s) => s && 1e3 * s) : line.steps);

  /** True if a point is within its tolerance, or within the fixed error that is chosen. */
  const isGood = (good, error) => (filled.value ? error <= Number(filled.value) : good);

  function label(line, look, i) {
    const at = `${line.steps[i]} steps a turn${line.dt_s ? ` (dt ${short(line.dt_s[i], 3)} s)` : ""}`;
    const worst = line.worst ? ` on ${escaped(line.worst[i])}` : "";
    return [
      `<b>${escaped(look.name)}</b> ${escaped(look.version)}`,
      at,
      `error ${short(line.error[i])}${worst}, ${line.within[i] ? "within" : "out of"} tolerance`,
      `${duration(line.s_per_turn[i])} a turn`,
      folded(own.settings[look.number]),
    ].join("<br>");
  }

  function trace(line, kind) {
    const look = crankcheck.looks[line.look];
    const paint = colour(`c${look.colour}`);
    return {
      x: costs(line, kind), y: line.error, name: look.name, mode: "lines+markers", visible: legend.on(line.look),
      line: { color: paint, width: 1.6, dash: look.dash },
      marker: {
        color: paint, size: 9, line: { color: paint, width: 1.6 },
        symbol: line.within.map((good, i) => (isGood(good, line.error[i]) ? look.symbol : `${look.symbol}-open`)),
      },
      text: line.error.map((_, i) => label(line, look, i)), hovertemplate: "%{text}<extra></extra>",
    };
  }

  function figure(shown, kind) {
    const front = {
      x: shown.front.s_per_turn.map((s) => 1e3 * s), y: shown.front.error, name: "front", mode: "lines",
      hoverinfo: "skip", visible: kind === "time", showlegend: false, line: { color: colour("front"), width: 9 },
    };
    const axis = kind === "time" ? "time to compute a turn [ms]" : "steps a turn";
    return {
      data: [front, ...shown.lines.map((line) => trace(line, kind))],
      layout: {
        xaxis: { ...crankcheck.logAxis(axis, false), ...crankcheck.ticks(shown.lines.flatMap((line) => costs(line, kind))) },
        yaxis: crankcheck.logAxis("error [rad, or of longest link]", true),
        shapes: filled.value ? [{
          type: "line", xref: "paper", x0: 0, x1: 1, y0: Number(filled.value), y1: Number(filled.value),
          line: { color: colour("front"), width: 1.5, dash: "dash" },
        }] : [],
      },
    };
  }

  const drawn = new Set(own.scenes.flatMap((each) => each.lines.map((line) => line.look)));
  const legend = crankcheck.legend(
    document.getElementById("precision-legend"), crankcheck.lookGroups(drawn), () => draw(),
  );
  const large = crankcheck.chart(chart, () => figure(own.scenes.find((each) => each.name === scene.value), cost.value));
  // Small, of all scenes, on the first screen; few settings have a legend there.
  const small = crankcheck.chart(document.getElementById("answer-chart"), () => {
    const { data, layout } = figure(own.scenes[0], own.timed ? "time" : "steps");
    const margin = { l: 64, r: 8, t: 6, b: 40 };
    const yaxis = crankcheck.logAxis("error", true);
    return { data, layout: { ...layout, yaxis, margin, showlegend: drawn.size < 7, legend: { orientation: "h", y: 1, yanchor: "bottom", itemclick: false, itemdoubleclick: false } } };
  });
  const draw = () => {
    large();
    small();
  };
  const [target, advice] = ["advice-target", "advice"].map((id) => document.getElementById(id));
  const advise = () => {
    for (const row of advice.tBodies[0].rows) row.hidden = row.dataset.target !== target.value;
  };
  advice.classList.add("of-one-scene");
  target.addEventListener("change", advise);
  advise();
  scene.addEventListener("change", draw);
  cost.addEventListener("change", draw);
  filled.addEventListener("change", draw);
})();
