"use strict";
// Diagrams by Plotly in the colours and type of the page; each is drawn when it comes into view.

/** Text for Plotly, which reads a little HTML of its own in labels. */
crankcheck.escaped = (text) =>
  String(text).replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);

/** Text broken into lines of some characters, for labels. */
crankcheck.folded = (text, width = Math.min(58, innerWidth / 11)) => {
  const lines = [""];
  for (const word of String(text).split(" ")) {
    if (lines.at(-1) && lines.at(-1).length + word.length > width) lines.push("");
    lines[lines.length - 1] += (lines.at(-1) ? " " : "") + word;
  }
  return lines.map(crankcheck.escaped).join("<br>");
};

/** A logarithmic axis; decades as powers of ten, or as plain numbers. */
crankcheck.logAxis = (title, powers) => ({
  title: { text: title },
  type: "log",
  exponentformat: powers ? "power" : "none",
  ...(powers ? { dtick: 1 } : {}),
});

/** Ticks at 1, 2 and 5 of each decade for an axis of some values; decades alone on a long one. */
crankcheck.ticks = (values) => {
  const known = values.filter((value) => value > 0);
  if (!known.length) return {};
  const [least, most] = [Math.log10(Math.min(...known)), Math.log10(Math.max(...known))];
  const tickvals = [];
  for (let decade = Math.floor(least); decade <= Math.ceil(most); decade += 1) {
    for (const first of most - least > 3 ? [1] : [1, 2, 5]) tickvals.push(Number(`${first}e${decade}`));
  }
  return { tickvals, ticktext: tickvals.map(String) };
};

/** Put the line `cursor` over a diagram at `x`; without one, or outside, it is hidden. */
crankcheck.putCursor = (chart, cursor, x) => {
  const { xaxis, yaxis } = chart._fullLayout ?? {};
  const place = xaxis && x !== null ? xaxis.l2p(x) : NaN;
  cursor.hidden = !(place >= 0 && place <= xaxis._length);
  if (!cursor.hidden) Object.assign(cursor.style, { left: `${xaxis._offset + place}px`, top: `${yaxis._offset}px`, height: `${yaxis._length}px` });
};

crankcheck.chart = (() => {
  const PAPER = 680; // width of a diagram on a printed page
  const { colour } = crankcheck;
  // Plotly stands after this script, so that the page is laid out before its megabytes are read.
  const loaded = new Promise((resolve) => {
    if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", resolve, { once: true });
    else resolve();
  });
  const finger = matchMedia("(pointer: coarse)").matches;

  function axis(own) {
    return {
      gridcolor: colour("line"), linecolor: colour("rule"), zerolinecolor: colour("rule"), tickcolor: colour("rule"),
      ticks: "outside", ticklen: 4, ...own,
    };
  }

  /** The least and the largest of some numbers. */
  const span = (numbers) => numbers.reduce(([least, most], each) => [Math.min(least, each), Math.max(most, each)], [Infinity, -Infinity]);

  /** Ticks of an axis of powers of ten, `which` of x and y, where its curves span too few of these. */
  function shortTicks(which, { dtick }, data) {
    const [least, most] = span(data.flatMap(({ visible = true, [which]: each }) => (visible ? Array.from(each) : [])).filter((each) => each > 0));
    return dtick && most < 30 * least ? { dtick: undefined, ...(most > 3 * least ? crankcheck.ticks([least, most]) : {}) } : {};
  }

  function layout(own, data) {
    return {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", showlegend: false, hovermode: "closest",
      font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour("ink") },
      margin: { l: 80, r: 16, t: 12, b: 50 },
      hoverlabel: {
        bgcolor: colour("panel"), bordercolor: colour("rule"), align: "left",
        font: { family: getComputedStyle(document.body).fontFamily, color: colour("ink"), size: 13 },
      },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("soft"), activecolor: colour("ink") },
      dragmode: finger ? false : "zoom", // a finger scrolls the page
      ...own,
      ...Object.fromEntries(Object.entries(own).filter(([name]) => /^[xy]axis/.test(name)).map(([name, each]) => [
        name, axis({ ...each, ...(name.startsWith("y") ? { title: { standoff: 6, ...each.title } } : {}), ...shortTicks(name[0], each, data) }),
      ])),
    };
  }

  /** Labels beside curves that lie on each other, within a line's width: how many lie there. */
  function coinciding(data, { xaxis, yaxis }) {
    const level = (axis, value) => (value === null ? NaN : axis.type === "log" ? Math.log10(value) : Number(value));
    const curves = data.filter(({ visible = true, hoverinfo }) => visible && hoverinfo !== "skip").map(({ name, x, y }) => ({
      name, points: Array.from(x, (each, i) => [level(xaxis, each), level(yaxis, y[i])]).filter((point) => point.every(Number.isFinite)),
    })).filter(({ points }) => points.length > 1);
    const every = curves.flatMap(({ points }) => points);
    const width = [0, 1].map((k) => span(every.map((point) => point[k])).reduce((least, most) => (most - least) / 200));
    const near = (p, q) => width.every((each, k) => Math.abs(p[k] - q[k]) <= each);
    const liesOn = (a, b) => a.every(a.length === b.length ? (p, i) => near(p, b[i]) : (p) => b.some((q) => near(p, q)));
    const groups = [];
    for (const curve of curves.toSorted((a, b) => b.points.length - a.points.length)) {
      const group = groups.find(([first]) => liesOn(curve.points, first.points));
      if (group) group.push(curve);
      else groups.push([curve]);
    }
    const counted = groups.map(([{ points }, ...others]) => ({ at: points[Math.floor(0.6 * points.length)], number: 1 + others.length }));
    return counted.filter(({ number }) => number > 1).map(({ at: [x, y], number }) => ({
      x, y, text: `${number} curves coincide`, showarrow: false, yshift: 14, font: { size: 12 }, bgcolor: colour("paper"),
    }));
  }

  const config = {
    responsive: true, displaylogo: false, showSendToCloud: false, displayModeBar: finger ? false : "hover",
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"], scrollZoom: false,
    toImageButtonOptions: { format: "svg", filename: "crankcheck" },
  };

  /**
   * A diagram in `element`; `figure()` gives its data and layout, and `after` is called when it is
   * drawn. Returns what draws it anew.
   */
  return (element, figure, after = () => {}) => {
    let seen = false;
    let width; // on paper; else that of its place
    const draw = () => {
      if (!seen) return;
      const { data, layout: own } = figure();
      Plotly.react(element, data, layout({ annotations: coinciding(data, own), width, ...own }, data), config).then(after);
    };
    const show = () => loaded.then(() => {
      seen = true;
      draw();
    });
    new IntersectionObserver((entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      show();
    }, { rootMargin: "300px" }).observe(element);
    addEventListener("beforeprint", () => {
      width = PAPER;
      show();
    });
    addEventListener("afterprint", () => {
      width = undefined;
      if (seen) Plotly.purge(element); // else it keeps the width
      draw();
    });
    crankcheck.onTheme(draw);
    return draw;
  };
})();
