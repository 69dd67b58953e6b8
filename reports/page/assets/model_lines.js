"use strict";
// The lines of a model: their error over time, and against the step.

(() => {
  const { colour, looks, short, singles } = crankcheck;
  const own = crankcheck.embedded("lines");
  const what = document.getElementById("lines-what");
  const TITLES = { error: "error [rad, or of longest link]", gap: "gap [of longest link]" };
  const DEEPEST = 1e-5; // of the largest of a line: less is not drawn

  for (const line of own.lines) {
    if (line.course) line.series = Object.fromEntries(Object.entries(line.course).map(([name, row]) => [name, singles(row)]));
  }
  const paint = (line) => colour(`c${looks[line.look].colour}`);
  const shown = () => own.lines.filter((line) => legend.on(line.look));

  /** A course as a logarithmic axis takes it: what is next to nothing has no place there. */
  function drawable(row) {
    const most = row.reduce((a, b) => (b > a ? b : a), 0);
    return [...row].map((v) => (v > DEEPEST * most ? v : null));
  }

  function course() {
    const lines = shown().filter((line) => line.series);
    const times = lines.flatMap((line) => [line.series.time[0], line.series.time.at(-1)]);
    const ends = times.length ? [Math.min(...times), Math.max(...times)] : [0, 1];
    const limit = own.limits[what.value];
    return {
      data: [
        ...lines.map((line) => ({
          x: [...line.series.time], y: drawable(line.series[what.value]), mode: "lines", name: looks[line.look].variant,
          line: { color: paint(line), width: 1.8 },
          text: [...line.series[what.value]].map((v) => short(v)), hovertemplate: `${looks[line.look].variant} %{text}<extra></extra>`,
        })),
        ...(limit === null ? [] : [{
          x: ends, y: [limit, limit], mode: "lines", name: "limit", hovertemplate: `limit ${short(limit)}<extra></extra>`,
          line: { color: colour("soft"), width: 1.5, dash: "dash" },
        }]),
      ],
      layout: {
        hovermode: "x",
        xaxis: { title: { text: "time [s]" }, zeroline: false, range: ends },
        yaxis: crankcheck.logAxis(TITLES[what.value], true),
      },
    };
  }

  /** Ends of a logarithmic axis that shows a decade at least: errors that are the same look so. */
  function decades(values) {
    const known = values.filter((v) => v > 0).map(Math.log10);
    if (!known.length) return {};
    const [least, most] = [Math.min(...known), Math.max(...known)];
    const spare = Math.max(0.15, (1 - (most - least)) / 2);
    return { range: [least - spare, most + spare] };
  }

  function steps() {
    const every = own.lines[0].dt;
    return {
      data: shown().map((line) => ({
        x: line.dt, y: line.error, mode: "lines+markers", name: looks[line.look].variant,
        line: { color: paint(line), width: 1.8, dash: looks[line.look].dash },
        marker: { color: paint(line), size: looks[line.look].size, symbol: looks[line.look].symbol },
        text: line.error.map((v) => short(v)), hovertemplate: `${looks[line.look].variant}, dt %{x:.3~g} s: %{text}<extra></extra>`,
      })),
      layout: {
        xaxis: {
          ...crankcheck.logAxis("step dt [s]", false), tickvals: every, ticktext: every.map((dt) => String(Number(dt.toPrecision(3)))),
          range: [Math.log10(every.at(-1) / 1.3), Math.log10(every[0] * 1.3)],
        },
        yaxis: { ...crankcheck.logAxis(TITLES.error, true), ...decades(shown().flatMap((line) => line.error)) },
      },
    };
  }

  const legend = crankcheck.legend(
    document.getElementById("lines-legend"), crankcheck.lookGroups(new Set(own.lines.map((line) => line.look))), () => draw(),
  );
  // Finer steps are drawn where they were run.
  const charts = [["lines-course", course], ["lines-steps", steps]].flatMap(([id, figure]) => {
    const element = document.getElementById(id);
    return element ? [crankcheck.chart(element, figure)] : [];
  });
  const draw = () => charts.forEach((chart) => chart());
  what.addEventListener("change", draw);
})();
