"use strict";
// One channel of a log at a time: the log over the truth, and below it the error with its limit.

(() => {
  const { colour, readable, singles, unpacked } = crankcheck;
  const own = crankcheck.embedded("channels");
  const part = (name) => document.getElementById(`channels-${name}`);
  const [channel, against, scale, chart, told] = ["channel", "against", "scale", "chart", "told"].map(part);
  const stretch = part("part"); // only where rows are left out of the whole
  const NEAR = 0.2; // of its limit: an error below that is a flat line beside it
  const DECADES = 6; // labelled on a logarithmic axis, if there are more
  const DEEPEST = 1e-4; // of the largest error: less is not drawn on such an axis
  const LABELS = { truth: own.truth, logged: "log", limit: "limit of the error" };
  let scaleIsChosen = false;

  /** An axis with its series unpacked, once. */
  function axisOf(one) {
    const axis = own.axes[one.axis];
    axis.t ??= singles(axis.time).map((t) => Number(axis.start) + t);
    axis.at ??= unpacked(axis.phase)[0];
    return axis;
  }

  /** The part of the channel that is chosen, with its series unpacked, once. */
  function shown() {
    const of = own.channels[Number(channel.value)];
    const samples = of[stretch?.value ?? "whole"] ?? of.whole;
    samples.log ??= singles(samples.logged);
    samples.off ??= unpacked(samples.error)[0];
    samples.truth ??= samples.log.map((v, i) => v - samples.off[i]);
    return { ...of, ...samples };
  }

  /** Where a line is broken: at the seam of a wrapped angle, and where the crank begins anew. */
  function seams(one, x) {
    const found = [];
    if (one.thinned) return found;
    for (let i = 1; i < x.length; i += 1) {
      const wraps = one.turn !== null && Math.abs(one.log[i] - one.log[i - 1]) > one.turn / 2;
      const again = against.value === "phase" && Math.abs(x[i] - x[i - 1]) > own.round / 2;
      if (wraps || again) found.push(i);
    }
    return found;
  }

  /** A series with an empty place at each seam. */
  function broken(series, breaks) {
    const parts = [];
    let first = 0;
    for (const at of [...breaks, series.length]) {
      if (parts.length) parts.push(null);
      for (let i = first; i < at; i += 1) parts.push(Number.isFinite(series[i]) ? series[i] : null);
      first = at;
    }
    return parts;
  }

  const paintOf = (name) => colour({ truth: "bar-driver", logged: "link", limit: "p2" }[name]);

  /** The lines of the limit, on both sides where the error has a sign. */
  function limits(one, ends, logarithmic) {
    if (one.limit === null) return [];
    return (logarithmic ? [one.limit] : [one.limit, -one.limit]).map((y) => ({
      x: ends, y: [y, y], yaxis: "y2", mode: "lines", name: "limit", visible: legend.on("limit"), hoverinfo: "skip",
      line: { color: paintOf("limit"), width: 2, dash: "dash" },
    }));
  }

  /** What is within the limit, as a band behind the error: down to its mirror, or to the axis. */
  function band(one, bottom) {
    if (one.limit === null || !legend.on("limit")) return [];
    return [{
      type: "rect", xref: "x domain", x0: 0, x1: 1, yref: "y2", y0: bottom ?? -one.limit, y1: one.limit,
      fillcolor: colour("good-back"), line: { width: 0 }, layer: "below",
    }];
  }

  /** The largest error in numbers, beside its mark. */
  function label(one, x, y, [first, last], logarithmic) {
    if (!Number.isFinite(y)) return [];
    const right = x > (first + last) / 2;
    return [{
      x, y: logarithmic ? Math.log10(y) : y, yref: "y2", showarrow: false, text: `largest ${readable(one.off[one.worst])}`,
      xanchor: right ? "right" : "left", xshift: right ? -9 : 9, bgcolor: colour("paper"), opacity: 0.85, borderpad: 2,
      font: { color: colour("ink") },
    }];
  }

  /** The ends of a logarithmic axis of the error: where it goes through 0 it leaves the picture. */
  function sizes(one, sized) {
    const known = sized.filter((v) => v > 0);
    const most = known.reduce((a, b) => Math.max(a, b), 0) || one.limit || 1;
    const least = Math.max(known.reduce((a, b) => Math.min(a, b), most), most * DEEPEST);
    return [least / 2, 3 * Math.max(most, one.limit ?? 0)];
  }

  /** Axis of the error: powers of ten, as many as there is room for, or numbers with sign. */
  function errorAxis(one, ends) {
    const title = `error [${crankcheck.escaped(one.unit)}]`;
    if (!ends) return { title: { text: title }, exponentformat: "power", zeroline: true };
    const range = ends.map(Math.log10);
    const dtick = Math.max(1, Math.ceil((range[1] - range[0]) / DECADES));
    return { ...crankcheck.logAxis(title, true), range, dtick };
  }

  function figure() {
    const one = shown();
    const axis = axisOf(one);
    const phase = against.value === "phase";
    const logarithmic = scale.value === "log";
    const x = phase ? axis.at : axis.t;
    const breaks = seams(one, x);
    const dots = phase && one.thinned;
    const sixths = phase && own.round === 360 ? { dtick: 60 } : {};
    const ends = phase ? [0, own.round] : [x[0], x.at(-1)];
    const places = broken(x, breaks);
    const line = (name, series, more = {}) => ({
      x: places, y: broken(series, breaks), name, mode: dots ? "markers" : "lines", visible: legend.on(name),
      line: { color: paintOf(name), width: name === "truth" ? 6 : 1.8 },
      marker: { color: paintOf(name), size: name === "truth" ? 6 : 3 },
      hovertemplate: `${LABELS[name]} %{y:.6~g}<extra></extra>`, ...more,
    });
    const sized = logarithmic ? one.off.map((v) => (v === 0 ? NaN : Math.abs(v))) : one.off;
    const heights = logarithmic ? sizes(one, sized) : null;
    const worst = one.worst;
    const unit = crankcheck.escaped(one.unit);
    return {
      data: [
        line("truth", one.truth),
        line("logged", one.log),
        line("logged", sized, { yaxis: "y2", visible: true, hovertemplate: "error %{y:.3~g}<extra></extra>" }),
        ...limits(one, ends, logarithmic),
        {
          x: [x[worst]], y: [sized[worst]], yaxis: "y2", mode: "markers", name: "largest", hoverinfo: "skip", cliponaxis: false,
          marker: { symbol: "circle-open", size: 11, color: colour("ink"), line: { width: 2 } },
        },
      ],
      layout: {
        hovermode: "x",
        xaxis: { title: { text: phase ? own.phase : "time [s]" }, anchor: "y2", zeroline: false, range: ends, ...sixths },
        yaxis: { title: { text: `${crankcheck.escaped(one.label)} [${unit}]` }, domain: [0.46, 1], zeroline: false },
        yaxis2: { ...errorAxis(one, heights), domain: [0, 0.38], anchor: "x" },
        shapes: band(one, heights?.[0]), annotations: label(one, x[worst], sized[worst], ends, logarithmic),
      },
    };
  }

  /** The scale on which the error and its limit are both seen, until a user has chosen. */
  function suit() {
    if (scaleIsChosen) return;
    const one = shown();
    const most = Math.abs(one.off[one.worst]);
    scale.value = one.limit !== null && most > 0 && most < NEAR * one.limit ? "log" : "linear";
  }

  function choose() {
    suit();
    told.textContent = shown().told.join(" ");
    draw();
  }

  const items = [["truth", "solid"], ["logged", "solid"], ["limit", "dash"]].map(([id, dash]) => (
    { id, label: LABELS[id], paint: { truth: "truth", logged: "logged", limit: "p2" }[id], dash, on: true }));
  const legend = crankcheck.legend(part("legend"), [{ title: "", items }], () => draw());
  const draw = crankcheck.chart(chart, figure);
  channel.addEventListener("change", choose);
  stretch?.addEventListener("change", draw);
  against.addEventListener("change", draw);
  scale.addEventListener("change", () => {
    scaleIsChosen = true;
    draw();
  });
  for (const link of document.querySelectorAll("a[data-channel]")) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      channel.value = link.dataset.channel;
      choose();
      document.getElementById("channels").scrollIntoView({ behavior: "instant" });
      channel.focus({ preventScroll: true });
    });
  }
  choose();
})();
