"use strict";
// Diagrams of free runs: their courses over time beside the truth, and their errors against the step.

crankcheck.freeCourses = (() => {
  const { colour, escaped, folded, short, unpacked } = crankcheck;
  const COURSES = {
    phase_judged: { title: "error of phase / G [rad]", log: true, told: "Error of the driver's angle at the same time, over the sensitivity of the motion. Thin: its size at the moment; thick: the largest so far." },
    phase: { title: "error of phase [rad]", log: true, told: "Error of the driver's angle at the same time. Thin: its size at the moment; thick: the largest so far." },
    energy: { title: "change of energy [of largest kinetic energy]", told: "Change of the engine's energy since the start, less the work of loads and dampers. Thin: as it is; thick: means over windows, of which the last less the first is the drift." },
    speed: { title: "angular velocity of the driver [rad/s]", truth: 1, told: "Grey and wide: the reference." },
    angle: { title: "angle of the driver [turns]", truth: 0, told: "Grey and wide: the reference." },
    portrait: { title: "angular velocity of the driver [rad/s]", told: "Angular velocity over the angle of the driver. Grey and wide: the reference." },
  };

  /** The curves of a run by name, unpacked once. */
  function curvesOf(cell) {
    cell.curve ??= Object.fromEntries(unpacked(cell.curves).map((row, i) => [cell.names[i], [...row]]));
    return cell.curve;
  }

  /** The largest size of a series up to each of its samples; none where it is still 0. */
  function largestSoFar(series) {
    let largest = 0;
    return series?.map((v) => (largest = Math.max(largest, Math.abs(v) || 0)) || null);
  }

  const line = (x, y, name, paint, width, dash = "solid") => ({
    x, y, name: escaped(name), mode: "lines", line: { color: paint, width, dash },
    hovertemplate: `${escaped(name)}: %{y:.4~g}<extra></extra>`,
  });

  function truthOf(scene, course) {
    if (!scene.truth) return [];
    scene.truth.rows ??= unpacked(scene.truth.curves).map((row) => [...row]);
    const [angle, speed] = scene.truth.rows;
    const paint = colour("rule");
    if (course === "portrait") return [line(angle, speed, "truth", paint, 6)];
    const which = COURSES[course].truth;
    return which === undefined ? [] : [line(scene.truth.time_s, scene.truth.rows[which], "truth", paint, 6)];
  }

  /** The figure of a scene: what is called `course` of the runs `{look, cell}`. */
  function overTime(scene, course, runs) {
    const { title, log } = COURSES[course];
    const data = truthOf(scene, course);
    for (const { look, cell } of runs) {
      const curve = curvesOf(cell);
      const own = (x, y, width, opacity = 1, shape = "linear") => {
        if (!x || !y) return;
        const drawn = line(x, y, look.name, colour(`c${look.colour}`), width, look.dash);
        data.push({ ...drawn, opacity, line: { ...drawn.line, shape } });
      };
      if (course === "portrait") own(curve.angle, curve.speed, 1.2, 1, "spline");
      else if (course === "energy") {
        own(cell.time_s, curve.energy, 1, 0.55);
        own(cell.time_s, curve.energy_mean, 2.6);
      } else if (log) {
        own(cell.time_s, curve[course]?.map((v) => (v ? Math.abs(v) : null)), 1, 0.35);
        own(cell.time_s, largestSoFar(curve[course]), 2.2);
      } else own(cell.time_s, curve[course], 1.6);
    }
    return {
      data,
      layout: {
        xaxis: { title: { text: course === "portrait" ? "angle of the driver [turns]" : "time [s]" }, zeroline: false },
        yaxis: log ? crankcheck.logAxis(title, true) : { title: { text: title }, exponentformat: "power", zeroline: true },
      },
    };
  }

  /** The traces of a line against the step: measured, fitted, and its floor. */
  function against(fit, visible) {
    const look = crankcheck.looks[fit.look];
    const paint = colour(`c${look.colour}`);
    const steps = fit.steps.map((n) => fit.lasts_s / n);
    const name = escaped(look.name);
    const text = steps.map((dt, i) => `<b>${name}</b><br>dt ${crankcheck.duration(dt)}: ${short(fit.error[i])}<br>${folded(fit.words)}`);
    const end = Math.max(...steps);
    const floor = fit.floor === null ? [] : [fit.floor, fit.floor];
    return [
      { x: fit.curve.map(([n]) => fit.lasts_s / n), y: fit.curve.map(([, e]) => e), visible, mode: "lines", hoverinfo: "skip", line: { color: paint, width: 1.8, dash: look.dash } },
      { x: steps, y: fit.error, visible, mode: "lines+markers", name, text, hovertemplate: "%{text}<extra></extra>", line: { color: paint, width: 0.5 }, marker: { color: paint, size: look.size, symbol: look.symbol } },
      { x: floor.length ? [Math.min(...steps) / 1.25, end] : [], y: floor, visible, mode: "lines", hoverinfo: "skip", line: { color: paint, width: 1.2, dash: "2px,4px" } },
    ];
  }

  /** The figure of errors against steps of some fits; `on(look)` says which are shown. */
  function convergence(fits, unit, on) {
    const steps = [...new Set(fits.flatMap((fit) => fit.steps.map((n) => Number((fit.lasts_s / n).toPrecision(6)))))];
    const ticks = steps.length < 9 ? { tickvals: steps, ticktext: steps.map(crankcheck.duration) } : crankcheck.ticks(steps);
    return {
      data: fits.flatMap((fit) => against(fit, on(fit.look))),
      layout: {
        xaxis: { ...crankcheck.logAxis(steps.length < 9 ? "step" : "step [s]", false), ...ticks },
        yaxis: crankcheck.logAxis(`error [${unit}]`, true),
      },
    };
  }

  return { overTime, convergence, told: (course) => COURSES[course].told };
})();
