"use strict";
// The mechanism as the closed form has it, and over it the lines of a model.

(() => {
  const own = crankcheck.embedded("motion");
  const FARTHEST = 40; // far out of the picture, over the size of the drawing

  const overlays = () => own.lines.filter((line) => legend.on(line.look)).map((line) => {
    line.rows ??= crankcheck.unpacked(line.off);
    const look = crankcheck.looks[line.look];
    return { name: look.variant, rows: line.rows, paint: `c${look.colour}` };
  });

  const stage = crankcheck.stage("motion", {
    overlays, reach: FARTHEST,
    home: (mechanism) => mechanism.worst(overlays().map((each) => each.rows)),
  });
  const legend = crankcheck.legend(
    document.getElementById("motion-legend"), crankcheck.lookGroups(new Set(own.lines.map((line) => line.look))), stage.draw,
  );
  stage.set(own.drawing);
  stage.makeVisible();
  stage.start();
})();
