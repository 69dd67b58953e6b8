"use strict";
// The law of each cam, and the pressure angle round its profile.

(() => {
  const { colour } = crankcheck;
  const own = crankcheck.embedded("cams");
  const cam = document.getElementById("cams-cam");
  const curve = document.getElementById("cams-curve");
  const chosen = () => own.cams[cam.selectedIndex];
  const names = ["lift", "velocity", "acceleration", "jerk"];

  function law() {
    const { curves, unit } = chosen();
    const y = curves[curve.value];
    const by = ["", "/rad", "/rad²", "/rad³"][curve.value];
    const label = curve.value < 4 ? `${names[curve.value]} [${unit}${by}]` : "pressure angle [deg]";
    return {
      data: [{ x: y.map((_, i) => (360 * i) / y.length), y, mode: "lines", line: { color: colour("c0"), width: 1.8 } }],
      layout: { xaxis: { title: { text: "angle of the cam [deg]" }, range: [0, 360], dtick: 60 }, yaxis: { title: { text: label } } },
    };
  }

  function profile() {
    const { x, y, curves } = chosen();
    return {
      data: [{
        x, y, mode: "markers", text: curves[4].map((angle) => `${angle.toFixed(1)} deg`), hoverinfo: "text",
        marker: { color: curves[4], colorscale: "Viridis", reversescale: true, size: 6, showscale: true,
          colorbar: { title: { text: "pressure angle [deg]", side: "right" }, len: 0.85, y: 0.45 } },
      }],
      layout: { xaxis: { title: { text: "x [m]" } }, yaxis: { title: { text: "y [m]" }, scaleanchor: "x" } },
    };
  }

  const charts = [["cams-law", law], ["cams-profile", profile]]
    .map(([id, drawn]) => crankcheck.chart(document.getElementById(id), drawn));
  for (const field of [cam, curve]) field.addEventListener("change", () => charts.forEach((draw) => draw()));
})();
