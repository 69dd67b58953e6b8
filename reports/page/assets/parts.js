"use strict";
// The error over the driver's place, split into its parts.

crankcheck.parts = (() => {
  const { colour, short } = crankcheck;
  const PARTS = {
    total: { label: "total", paint: "p0", width: 3.2, dash: "solid" },
    discretisation: { label: "discretisation", paint: "p1", width: 2, dash: "dash" },
    floor: { label: "model floor", paint: "p2", width: 2, dash: "dot" },
    geometric: { label: "floor + discretisation", paint: "p1", width: 2, dash: "dash" },
    drive: { label: "drive", paint: "p3", width: 1.6, dash: "dashdot" },
    gap: { label: "closure: widest gap / L", paint: "p4", width: 1.6, dash: "longdash" },
  };

  /** Whether a drive is off by more than rounding in any of some cells' parts: the largest level of a row is 32767. */
  const drives = (every) => every.some((each) => 32767 * (each?.curves.scales[each.names.indexOf("drive")] ?? 0) > 1e-9);

  /** Groups for a legend of all parts; the drive is on at first where it is off by more than rounding. */
  const groups = (every) => [{
    title: "",
    items: Object.entries(PARTS).map(([id, part]) => ({ id, label: part.label, paint: part.paint, dash: part.dash, on: id !== "drive" || drives(every) })),
  }];

  /** Ticks every 60 degrees of a turn, as angles from 0 to 300. */
  function turns(x) {
    const tickvals = [];
    for (let at = 60 * Math.ceil(Math.min(...x, 0) / 60); at <= Math.max(...x, 0); at += 60) tickvals.push(at);
    return { tickvals, ticktext: tickvals.map((at) => String(((at % 360) + 360) % 360)) };
  }

  /** The figure of one cell: its `parts` and their `axis` as embedded, and which parts to show; of another body its total. */
  function figure(parts, axis, body, { turning, told }, logarithmic, on) {
    const rows = parts ? crankcheck.unpacked(parts.curves) : [];
    const x = axis ? (turning ? axis.angle : axis.part) : [];
    const traces = (parts?.names ?? []).flatMap((name, i) => {
      const part = body.other ? { ...PARTS.total, label: name } : PARTS[name];
      if (body.other ? name !== body.name : !part) return [];
      const signed = [...rows[i]];
      return [{
        x, y: logarithmic ? signed.map((v) => (v === 0 ? null : Math.abs(v))) : signed, name: part.label, mode: "lines",
        visible: body.other || on(name), line: { color: colour(part.paint), width: part.width, dash: part.dash },
        text: signed.map((v) => short(v, 3)), hovertemplate: `${part.label} %{text}<extra></extra>`,
      }];
    });
    const title = body ? `${body.name} [${body.turns ? "rad" : "of longest link"}]` : "error";
    return {
      data: traces,
      layout: {
        hovermode: "x",
        xaxis: {
          title: { text: turning ? crankcheck.escaped(told.axis) : "part of the period [%]" },
          ...(turning ? turns(x) : {}), zeroline: false,
        },
        yaxis: logarithmic
          ? crankcheck.logAxis(crankcheck.escaped(title), true)
          : { title: { text: crankcheck.escaped(title) }, exponentformat: "power", zeroline: true },
      },
    };
  }

  return { figure, groups, isPart: (name) => name in PARTS };
})();
